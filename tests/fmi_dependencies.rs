//! `InitialUnknowns`: what is said not to matter does not matter. Every known is changed, and every
//! output that does not name it among its dependencies stays the same.

#[path = "common/fmi.rs"]
mod fmi;

use fmi::*;
use std::collections::HashMap;
use tread_block::fmi::exports::*;
use tread_block::fmi::variables::{self, Source};
use tread_block::params::Kind;

/// Dependencies in initialization mode of each unknown, by index from 0, as the XML states them.
fn stated() -> HashMap<usize, Vec<usize>> {
    let xml = tread_block::fmi::model_description::xml();
    let section = xml.split("<InitialUnknowns>").nth(1).unwrap();
    let section = section.split("</InitialUnknowns>").next().unwrap();
    let attribute = |line: &str, name: &str| {
        let rest = line.split(&format!("{name}=\"")).nth(1).unwrap().to_string();
        rest.split('"').next().unwrap().to_string()
    };
    let lines = section.lines().filter(|line| line.contains("<Unknown"));
    let number = |text: &str| text.parse::<usize>().unwrap() - 1;
    lines
        .map(|line| {
            let known = attribute(line, "dependencies");
            (number(&attribute(line, "index")), known.split_whitespace().map(number).collect())
        })
        .collect()
}

/// All real values in initialization mode after `change`.
fn initial(drive: i32, change: impl Fn(&Fmu)) -> Vec<f64> {
    let fmu = Fmu::new();
    fmu.coarse();
    fmu.set_integer("drive.normal", drive);
    // Pressed by 50 µm and tilted a little in trajectory drive, by 30 N in load drive.
    fmu.set("belt.z", 0.01 - 50e-6);
    fmu.set("belt.angle", 1e-4);
    fmu.set("normal_load", 30.0);
    change(&fmu);
    fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
    let unknowns = variables::all();
    unknowns
        .iter()
        .filter(|v| v.initial() == Some("calculated"))
        .map(|v| fmu.get(&v.name))
        .collect()
}

#[test]
fn what_is_not_named_as_a_dependency_has_no_influence_at_the_start() {
    let variables = variables::all();
    let stated = stated();
    let unknowns: Vec<usize> =
        (0..variables.len()).filter(|i| variables[*i].initial() == Some("calculated")).collect();
    for drive in [1, 2] {
        let base = initial(drive, |_| ());
        for (index, known) in variables.iter().enumerate() {
            let changed = match known.source {
                Source::Input(_, spec) if spec.name == "normal_load" => initial(drive, |f| {
                    f.set(spec.name, 31.0);
                }),
                Source::Input(_, spec) => initial(drive, |f| {
                    f.set(spec.name, if spec.name == "belt.z" { 0.00996 } else { 2e-4 });
                }),
                Source::Parameter(_, spec) if spec.name != "drive.normal" => match spec.kind {
                    Kind::Real { min, max, .. } => initial(drive, |f| {
                        let value: f64 = known.start().unwrap().parse().unwrap();
                        f.set(
                            spec.name,
                            (value * 1.01 + 1e-3 * f64::from(value == 0.0)).clamp(min, max),
                        );
                    }),
                    Kind::Enumeration { items, .. } if items.len() == 2 => initial(drive, |f| {
                        f.set_integer(spec.name, 2);
                    }),
                    _ => continue,
                },
                _ => continue,
            };
            for ((unknown, before), after) in unknowns.iter().zip(&base).zip(&changed) {
                // Where a number only passes through the reduction, it leaves its rounding.
                let rounding = match variables[*unknown].source {
                    Source::Output(spec, _) => 1e-9 * spec.nominal,
                    _ => 0.0,
                };
                assert!(
                    (before - after).abs() <= rounding || stated[unknown].contains(&index),
                    "{} goes from {before} to {after} with {}, drive {drive}",
                    variables[*unknown].name,
                    known.name
                );
            }
        }
    }
}
