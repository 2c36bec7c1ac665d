//! Drives the block in `fmu-runner` and prints the outputs after each step. A program of its own: the two
//! importers define one symbol twice.

use fmu_runner::{fmi2Type, Fmu, FmuInstance};
use rust_masters::{given, print, Plan};
use std::collections::HashMap;
use std::error::Error;

/// `fmu-runner`.
fn with_fmu_runner(fmu: &str, plan: &Plan) -> Result<(), Box<dyn Error>> {
    let library = Fmu::unpack(fmu)?.load(fmi2Type::fmi2CoSimulation)?;
    let block = FmuInstance::instantiate(&library, true)?;
    let all = block.lib.variables();
    for (name, _, value) in &plan.integers {
        block.set_integers(&HashMap::from([(&all[name], *value)]))?;
    }
    for (name, _, value) in &plan.reals {
        block.set_reals(&HashMap::from([(&all[name], *value)]))?;
    }
    block.setup_experiment(0.0, None, None)?;
    block.enter_initialization_mode()?;
    block.exit_initialization_mode()?;
    let outputs: Vec<_> = plan.outputs.iter().map(|(name, _)| &all[name]).collect();
    for pair in plan.points.windows(2) {
        let ((t, x), (next, _)) = (pair[0], pair[1]);
        block.set_reals(&HashMap::from([(&all[&plan.belt.0], x)]))?;
        block.do_step(t, next - t, true)?;
        let values = block.get_reals(&outputs)?;
        print(&outputs.iter().map(|variable| values[variable]).collect::<Vec<_>>());
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (fmu, plan) = given()?;
    with_fmu_runner(&fmu, &plan)
}
