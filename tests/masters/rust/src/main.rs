//! Drives the block in an importer written in Rust and prints the outputs after each step.
//!
//!     rust-masters fmi|fmu-runner FMU < PLAN
//!
//! Lines of the plan: `output NAME REFERENCE`, `integer NAME REFERENCE VALUE`, `real NAME REFERENCE
//! VALUE`, `belt NAME REFERENCE`, then for each communication point `at TIME POSITION`.

use fmi::fmi2::{import::Fmi2Import, instance::CoSimulation, instance::Common};
use fmu_runner::{fmi2Type, Fmu, FmuInstance};
use std::collections::HashMap;
use std::error::Error;
use std::io::Read;

/// What is to be done.
#[derive(Default)]
struct Plan {
    outputs: Vec<(String, u32)>,
    integers: Vec<(String, u32, i32)>,
    reals: Vec<(String, u32, f64)>,
    belt: (String, u32),
    points: Vec<(f64, f64)>,
}

fn read(text: &str) -> Result<Plan, Box<dyn Error>> {
    let mut plan = Plan::default();
    for line in text.lines() {
        match line.split_whitespace().collect::<Vec<_>>().as_slice() {
            ["output", name, vr] => plan.outputs.push((name.to_string(), vr.parse()?)),
            ["integer", name, vr, x] => {
                plan.integers.push((name.to_string(), vr.parse()?, x.parse()?));
            }
            ["real", name, vr, x] => plan.reals.push((name.to_string(), vr.parse()?, x.parse()?)),
            ["belt", name, vr] => plan.belt = (name.to_string(), vr.parse()?),
            ["at", t, x] => plan.points.push((t.parse()?, x.parse()?)),
            _ => return Err(format!("not understood: {line}").into()),
        }
    }
    Ok(plan)
}

fn print(row: &[f64]) {
    let cells: Vec<String> = row.iter().map(f64::to_string).collect();
    println!("{}", cells.join(","));
}

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
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let plan = read(&text)?;
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["fmi", fmu] => with_fmi(fmu, &plan),
        ["fmu-runner", fmu] => with_fmu_runner(fmu, &plan),
        _ => Err("usage: rust-masters fmi|fmu-runner FMU < PLAN".into()),
    }
}
