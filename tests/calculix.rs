//! The same block in CalculiX: first six eigenfrequencies of an independent finite element program.
//!
//! CalculiX expands its plane stress elements (CPS8) to solids that are free to change their thickness
//! and clamps the nodes of the middle plane for all nodes of the thickness, so that constraining x and z
//! of the top edge is the clamped face of plane stress. The thickness is chosen so small that the
//! inertia of its change does not count.

use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;
use tread_block::block::Shape;
use tread_block::Params;

/// Elements of CalculiX along and up.
const ELEMENTS: (usize, usize) = (36, 24);
/// Ours, graded towards the tread face.
const OURS: (usize, usize) = (20, 14);
const MODES: usize = 6;

/// A plane mesh of 8-node quadrilaterals, the material, the clamp, one frequency step.
fn input(params: &Params) -> String {
    let (along, up) = ELEMENTS;
    let (length, height) = (params.block.length, params.block.height);
    let number = |i: usize, j: usize| 1 + i * (2 * up + 1) + j;
    let (mut nodes, mut elements) = (String::new(), String::new());
    for i in 0..=2 * along {
        // Eight-node elements have no node in their middle.
        for j in (0..=2 * up).filter(|j| i % 2 == 0 || j % 2 == 0) {
            let x = length * i as f64 / (2 * along) as f64;
            let z = height * j as f64 / (2 * up) as f64;
            writeln!(nodes, "{}, {x:.9e}, {z:.9e}, 0.", number(i, j)).unwrap();
        }
    }
    for e in 0..along * up {
        let (i, j) = (2 * (e / up), 2 * (e % up));
        let corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)];
        let list = corners.map(|(a, b)| number(i + a, j + b).to_string()).join(", ");
        writeln!(elements, "{}, {list}", e + 1).unwrap();
    }
    let clamp: String = (0..=2 * along).map(|i| format!("{},\n", number(i, 2 * up))).collect();
    let rubber = &params.rubber;
    format!(
        "*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=CPS8, ELSET=BLOCK\n{elements}*NSET, NSET=TOP\n{clamp}\
         *MATERIAL, NAME=RUBBER\n*ELASTIC\n{:e}, {}\n*DENSITY\n{}\n\
         *SOLID SECTION, ELSET=BLOCK, MATERIAL=RUBBER\n1e-4\n\
         *BOUNDARY\nTOP, 1, 2\n*STEP\n*FREQUENCY\n{MODES}\n*END STEP\n",
        rubber.young_modulus, rubber.poisson_ratio, rubber.density
    )
}

/// Rows "mode, eigenvalue, rad/s, Hz, …" of the first table of a .dat file.
fn frequencies(dat: &str) -> Vec<f64> {
    let rows = dat.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let numbers = rows.filter(|row| row.len() == 5 && row[0].parse::<usize>().is_ok());
    numbers.take(MODES).map(|row| row[3].parse().unwrap()).collect()
}

/// Runs CalculiX in a folder of its own; `None` if it is not installed.
fn calculix(input: &str) -> Option<Vec<f64>> {
    let folder: PathBuf =
        std::env::temp_dir().join(format!("tread-calculix-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("block.inp"), input).unwrap();
    let run = Command::new("ccx").arg("block").current_dir(&folder).output();
    let run = match run {
        Err(missing) if missing.kind() == std::io::ErrorKind::NotFound => return None,
        run => run.unwrap(),
    };
    let dat = std::fs::read_to_string(folder.join("block.dat"));
    let talk = String::from_utf8_lossy(&run.stdout).into_owned();
    std::fs::remove_dir_all(&folder).unwrap();
    let found = frequencies(&dat.unwrap_or_default());
    assert_eq!(found.len(), MODES, "CalculiX says:\n{talk}");
    Some(found)
}

#[test]
fn the_first_six_eigenfrequencies_are_calculixs_within_a_fifth_per_cent() {
    let mut params = Params::default();
    (params.solver.elements_along, params.solver.elements_up) = OURS;
    // Fixed-interface modes far beyond the sixth frequency: what is compared is the elements.
    params.solver.frequency_bound = 20e3;
    let Some(expected) = calculix(&input(&params)) else {
        eprintln!("SKIPPED: CalculiX (ccx) is not installed; packaging/setup.sh test installs it");
        return;
    };
    let e_over_rho = params.rubber.young_modulus / params.rubber.density;
    let fine = Shape::of(&params).reduce().unwrap().frequencies(e_over_rho);
    let defaults = Shape::of(&Params::default()).reduce().unwrap().frequencies(e_over_rho);
    let mut worst: f64 = 0.0;
    for m in 0..MODES {
        let (error, coarse) = (fine[m] / expected[m] - 1.0, defaults[m] / expected[m] - 1.0);
        println!(
            "mode {}: CalculiX {:.2} Hz, ours {:.2} Hz ({:+.3} %), default mesh {:.2} Hz ({:+.3} %)",
            m + 1, expected[m], fine[m], 100.0 * error, defaults[m], 100.0 * coarse
        );
        worst = worst.max(error.abs());
    }
    assert!(worst < 2e-3, "{worst:e}");
}
