//! Drives the block in the `fmi` crate and prints the outputs after each step. A program of its own: the two
//! importers define one symbol twice.

use fmi::fmi2::{import::Fmi2Import, instance::CoSimulation, instance::Common};
use rust_masters::{given, print, Plan};
use std::error::Error;

/// The `fmi` crate of rust-fmi.
fn with_fmi(fmu: &str, plan: &Plan) -> Result<(), Box<dyn Error>> {
    let import: Fmi2Import = fmi::import::from_path(fmu)?;
    let mut block = import.instantiate_cs("block", false, true)?;
    for (_, vr, value) in &plan.integers {
        block.set_integer(&[*vr], &[*value])?;
    }
    for (_, vr, value) in &plan.reals {
        block.set_real(&[*vr], &[*value])?;
    }
    block.setup_experiment(None, 0.0, None)?;
    block.enter_initialization_mode()?;
    block.exit_initialization_mode()?;
    let references: Vec<u32> = plan.outputs.iter().map(|(_, vr)| *vr).collect();
    let mut row = vec![0.0; references.len()];
    for pair in plan.points.windows(2) {
        let ((t, x), (next, _)) = (pair[0], pair[1]);
        block.set_real(&[plan.belt.1], &[x])?;
        block.do_step(t, next - t, true)?;
        block.get_real(&references, &mut row)?;
        print(&row);
    }
    let state = block.get_fmu_state()?;
    assert!(block.serialize_fmu_state(&state)?.len() > 1000);
    block.terminate()?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (fmu, plan) = given()?;
    with_fmi(&fmu, &plan)
}
