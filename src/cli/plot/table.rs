//! A result of `tread simulate` as columns.

use std::path::Path;

use crate::block::STATIONS;
use crate::error::{Fault, Problem};

/// What the panels need of a result.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Time [s].
    pub time: Vec<f64>,
    /// Displacement of the run-in edge [m].
    pub run_in: Vec<f64>,
    /// Displacement of the run-out edge [m].
    pub run_out: Vec<f64>,
    /// Velocity of the run-in edge [m/s].
    pub velocity: Vec<f64>,
    /// Tangential and normal force of the road [N].
    pub forces: [Vec<f64>; 2],
    /// Pressure at the stations [Pa]: one column each.
    pub pressure: Vec<Vec<f64>>,
}

/// Reads a result; columns may be in any order.
pub fn read(path: &Path) -> Result<Run, Fault> {
    let fault = |reason: String| Fault::File { path: path.display().to_string(), reason };
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| fault(e.to_string()))?;
    let header = reader.headers().map_err(|e| fault(e.to_string()))?.clone();
    let mut names = vec![
        "time".to_string(),
        "run_in.displacement.x".into(),
        "run_out.displacement.x".into(),
        "run_in.velocity.x".into(),
        "contact.force.x".into(),
        "contact.force.z".into(),
    ];
    names.extend((1..=STATIONS).map(|i| format!("contact.pressure[{i}]")));
    let (places, mut problems) = places(&names, &header);
    let mut columns = vec![Vec::new(); names.len()];
    for (row, record) in reader.records().enumerate() {
        if !problems.is_empty() {
            break;
        }
        let record = record.map_err(|e| fault(e.to_string()))?;
        for ((column, &place), name) in columns.iter_mut().zip(&places).zip(&names) {
            let cell = record.get(place).unwrap_or("missing");
            match cell.parse::<f64>() {
                Ok(number) if number.is_finite() => column.push(number),
                _ => problems.push(Problem::new(
                    format!("column {name}, line {}", row + 2),
                    cell,
                    "a finite number",
                    "mend the cell, or run `tread simulate` again",
                )),
            }
        }
    }
    if problems.is_empty() && columns[0].len() < 16 {
        problems.push(Problem::new(
            "rows of the result",
            columns[0].len().to_string(),
            "16 or more",
            "make run.duration longer or run.communication_step shorter",
        ));
    }
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    let pressure = columns.split_off(6);
    let mut columns = columns.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    Ok(Run {
        time: next(),
        run_in: next(),
        run_out: next(),
        velocity: next(),
        forces: [next(), next()],
        pressure,
    })
}

fn places(names: &[String], header: &csv::StringRecord) -> (Vec<usize>, Vec<Problem>) {
    let mut problems = Vec::new();
    let places = names
        .iter()
        .map(|name| {
            header.iter().position(|h| h == name).unwrap_or_else(|| {
                problems.push(Problem::new(
                    format!("column {name}"),
                    "missing",
                    "a column of that name",
                    "`tread simulate` writes such files",
                ));
                0
            })
        })
        .collect();
    (places, problems)
}
