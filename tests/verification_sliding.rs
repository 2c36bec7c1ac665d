//! Sliding against the independent solutions of tests/data/verification: same case, same metrics.

use std::collections::HashMap;

use tread_block::metrics::{self, Recorder, StickSlip, Trace};
use tread_block::scenario::{self, Scenario, Slide};
use tread_block::{Params, TreadBlock};

/// A case as its README states it.
struct Case {
    file: &'static str,
    height: f64,
    length: f64,
    pressure: f64,
    speed: f64,
}

const CASES: [Case; 4] = [
    Case { file: "slide-1.csv", height: 0.010, length: 0.015, pressure: 250e3, speed: 0.30 },
    Case { file: "slide-2.csv", height: 0.010, length: 0.015, pressure: 400e3, speed: 0.15 },
    Case { file: "slide-3.csv", height: 0.006, length: 0.015, pressure: 250e3, speed: 0.20 },
    Case { file: "slide-4.csv", height: 0.010, length: 0.045, pressure: 250e3, speed: 0.30 },
];

fn columns(file: &str) -> HashMap<String, Vec<f64>> {
    let path = format!("{}/tests/data/verification/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: HashMap<String, Vec<f64>> = HashMap::new();
    for line in lines {
        for (name, cell) in names.iter().zip(line.split(',')) {
            columns.entry((*name).to_string()).or_default().push(cell.parse().unwrap());
        }
    }
    columns
}

/// Metrics of the reference, and the time at which it ends [s].
fn reference(case: &Case) -> (StickSlip, f64) {
    let columns = columns(case.file);
    let friction: Vec<f64> = columns["Fx"].iter().zip(&columns["Fz"]).map(|(x, z)| x / z).collect();
    let trace = Trace {
        time: &columns["t"],
        displacement: &columns["edge_in_x"],
        velocity: &columns["edge_in_vx"],
        friction: &friction,
        // The reference has no such column; it is not compared.
        stick: &friction,
    };
    (metrics::stick_slip(&trace, case.speed), *columns["t"].last().unwrap())
}

fn model(case: &Case, duration: f64, step: f64, points: usize) -> StickSlip {
    let mut params = Params::default();
    params.solver.contact_points = points;
    params.block.height = case.height;
    params.block.length = case.length;
    // The reference is without wear.
    params.wear.coefficient = 0.0;
    let load = case.pressure * case.length * params.block.width;
    let scenario = Scenario::Slide(Slide::constant(case.speed, load));
    let mut block = TreadBlock::new(&scenario.fit(&params)).unwrap();
    let mut recorder = Recorder::default();
    scenario::simulate(&mut block, &scenario, step, duration, |t, o| recorder.push(t, o)).unwrap();
    metrics::stick_slip(&recorder.trace(), case.speed)
}

#[test]
fn sliding_is_the_independent_solution_within_the_tolerances_of_the_project() {
    // Frequency 1 %, peak-to-peak displacement 3 %, mean friction 1 %; the reference itself is good
    // to 0.2 %, 1 % and 0.6 % (its README).
    let mut wrong = Vec::new();
    for case in &CASES {
        let (expected, end) = reference(case);
        let found = model(case, end, 20e-6, 0);
        for (name, found, expected, tolerance) in [
            ("frequency", found.frequency, expected.frequency, 0.01),
            ("displacement", found.displacement_amplitude, expected.displacement_amplitude, 0.03),
            ("friction", found.mean_friction, expected.mean_friction, 0.01),
        ] {
            let error = found / expected - 1.0;
            println!("{} {name}: {found:.6e}, {:+.2} %", case.file, 100.0 * error);
            if error.abs() > tolerance {
                wrong.push(format!("{} {name}: {found} for {expected}", case.file));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn few_contact_points_keep_the_frequency_and_friction_of_the_reference_case() {
    // Both within 1 % of the independent solution. Polynomials through 24 points need a finer mesh than a long block has
    // by default; fine meshes are 0.6 to 1.2 % below the independent frequency of the long block, so 1.5 % there.
    for (case, points, limit) in [(&CASES[0], 8, 0.01), (&CASES[3], 24, 0.015)] {
        let (expected, end) = reference(case);
        let found = model(case, end, 20e-6, points);
        let errors =
            [found.frequency / expected.frequency, found.mean_friction / expected.mean_friction]
                .map(|ratio| ratio - 1.0);
        assert!(errors.iter().all(|error| error.abs() < limit), "{}: {errors:?}", case.file);
    }
}
