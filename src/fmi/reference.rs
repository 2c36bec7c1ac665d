//! The reference result in the FMU's `extra/`: default parameters, a block that is dragged over the
//! road for 5 ms. An importer that gives these inputs must get these outputs.

use crate::block::{TreadBlock, INPUTS, OUTPUTS};
use crate::drive::{Pose, Predictor};
use crate::error::Fault;
use crate::params::Params;

/// Communication step \[s\].
const STEP: f64 = 1e-5;
/// Number of steps; every tenth communication point is written.
const STEPS: usize = 500;

/// Inputs at all communication points and outputs at every tenth, as CSV.
///
/// # Errors
/// Those of the model; none is expected of its own defaults.
pub fn run() -> Result<(String, String), Fault> {
    let mut block = TreadBlock::new(&Params::default())?;
    block.initialize(0.0, pose(0.0))?;
    let mut predictor = Predictor::default();
    let mut inputs = header(INPUTS.iter().map(|spec| spec.name.to_string()));
    let mut outputs = header(OUTPUTS.iter().flat_map(|spec| {
        (0..spec.size).map(|i| match spec.size {
            1 => spec.name.to_string(),
            _ => format!("{}[{}]", spec.name, i + 1),
        })
    }));
    for k in 0..=STEPS {
        let time = k as f64 * STEP;
        let pose = pose(time);
        inputs += &row(time, INPUTS.iter().map(|spec| (spec.get)(&pose)));
        if k % 10 == 0 {
            let now = block.outputs();
            let values = OUTPUTS.iter();
            outputs +=
                &row(time, values.flat_map(|spec| (0..spec.size).map(|i| (spec.get)(now, i))));
        }
        block.advance(STEP, &predictor.segment(time, STEP, Predictor::known(pose)))?;
    }
    Ok((inputs, outputs))
}

/// 0.25 N/mm² on the default block; −x with a linear start over 0.5 ms to 0.3 m/s.
fn pose(time: f64) -> Pose {
    let (speed, start) = (0.3, 0.5e-3);
    let x = if time < start {
        -speed * time * time / (2.0 * start)
    } else {
        -speed * (time - 0.5 * start)
    };
    Pose { x, load: 56.25, ..Pose::default() }
}

fn header(names: impl Iterator<Item = String>) -> String {
    let names: Vec<_> = std::iter::once("time".to_string()).chain(names).collect();
    names.join(",") + "\n"
}

fn row(time: f64, values: impl Iterator<Item = f64>) -> String {
    let cells: Vec<_> = std::iter::once(time).chain(values).map(|x| format!("{x:?}")).collect();
    cells.join(",") + "\n"
}
