//! What an importer is to do, as lines on the standard input.
//!
//! Lines of the plan: `output NAME REFERENCE`, `integer NAME REFERENCE VALUE`, `real NAME REFERENCE
//! VALUE`, `belt NAME REFERENCE`, then for each communication point `at TIME POSITION`.

use std::error::Error;
use std::io::Read;

/// What is to be done.
#[derive(Default)]
pub struct Plan {
    pub outputs: Vec<(String, u32)>,
    pub integers: Vec<(String, u32, i32)>,
    pub reals: Vec<(String, u32, f64)>,
    pub belt: (String, u32),
    pub points: Vec<(f64, f64)>,
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

pub fn print(row: &[f64]) {
    let cells: Vec<String> = row.iter().map(f64::to_string).collect();
    println!("{}", cells.join(","));
}

/// The path of the FMU from the command line, and the plan.
pub fn given() -> Result<(String, Plan), Box<dyn Error>> {
    let fmu = std::env::args().nth(1).ok_or("usage: MASTER FMU < PLAN")?;
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    Ok((fmu, read(&text)?))
}
