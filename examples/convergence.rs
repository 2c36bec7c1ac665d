//! How far the defaults are from the converged solution: internal step, tolerance and mesh.
//!
//! `make convergence` writes out/convergence/convergence.csv and convergence.svg. The case is slide-1
//! of the independent solutions: h 10, l 15 mm, 0.25 N/mm², 0.3 m/s, 30 ms.

use std::fs;

use tread_block::metrics::{self, Recorder, StickSlip};
use tread_block::scenario::{self, Scenario, Slide};
use tread_block::study::plot::{svg, Panel, Series};
use tread_block::{Fault, Params, TreadBlock};

/// Internal steps [s]; the first is the reference of the others.
const STEPS: [f64; 6] = [0.3e-6, 0.6e-6, 1.25e-6, 2.5e-6, 5e-6, 10e-6];
/// Elements along the face and up; the first is the reference of the others.
const MESHES: [[usize; 2]; 5] = [[20, 14], [14, 10], [10, 7], [8, 6], [6, 4]];

fn run(change: impl Fn(&mut Params)) -> Result<StickSlip, Fault> {
    let mut params = Params::default();
    params.wear.coefficient = 0.0;
    change(&mut params);
    let scenario = Scenario::Slide(Slide::constant(0.3, 56.25));
    let mut block = TreadBlock::new(&scenario.fit(&params))?;
    let mut recorder = Recorder::default();
    scenario::simulate(&mut block, &scenario, 10e-6, 0.03, |t, o| recorder.push(t, o))?;
    Ok(metrics::stick_slip(&recorder.trace(), 0.3))
}

/// Rows of x, frequency error and friction error [%] against the first result.
fn errors(results: &[(f64, StickSlip)]) -> Vec<[f64; 3]> {
    let best = &results[0].1;
    let percent = |value: f64, reference: f64| 100.0 * (value / reference - 1.0);
    results[1..]
        .iter()
        .map(|(x, r)| {
            let frequency = percent(r.frequency, best.frequency);
            [*x, frequency, percent(r.mean_friction, best.mean_friction)]
        })
        .collect()
}

fn panel(title: &str, x: &'static str, rows: &[[f64; 3]]) -> Panel {
    let points = |column: usize| rows.iter().map(|r| (r[0], r[column])).collect();
    let series = vec![
        Series::line("stick-slip frequency", 0, points(1)),
        Series::line("mean friction", 1, points(2)),
    ];
    Panel::new(title, [x, "error in %"], series)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut by_step = Vec::new();
    for step in STEPS {
        eprintln!("internal step {} us", step * 1e6);
        by_step.push((step * 1e6, run(|p| p.solver.max_step = step)?));
    }
    let mut by_mesh = Vec::new();
    for [along, up] in MESHES {
        eprintln!("{along} x {up} elements");
        let result = run(|p| (p.solver.elements_along, p.solver.elements_up) = (along, up))?;
        by_mesh.push((along as f64, result));
    }
    let (steps, meshes) = (errors(&by_step), errors(&by_mesh));
    let mut csv = String::from("varied,value,frequency_error_percent,friction_error_percent\n");
    for (name, rows) in [("max_step_us", &steps), ("elements_along", &meshes)] {
        for [x, frequency, friction] in rows {
            csv += &format!("{name},{x},{frequency:.4},{friction:.4}\n");
        }
    }
    fs::create_dir_all("out/convergence")?;
    fs::write("out/convergence/convergence.csv", &csv)?;
    let panels = [
        panel("Internal step", "solver.max_step in us", &steps),
        panel("Mesh", "elements along the face", &meshes),
    ];
    fs::write("out/convergence/convergence.svg", svg(&panels, 2)?)?;
    print!("{csv}");
    Ok(())
}
