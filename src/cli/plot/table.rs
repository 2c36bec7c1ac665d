//! A result of `tread simulate` as columns.

use std::path::Path;

use crate::block::STATIONS;
use crate::cli::summary;
use crate::columns;
use crate::error::Fault;

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

/// Columns before those of the pressure.
const NAMES: [&str; 6] = [
    "time",
    "run_in.displacement.x",
    "run_out.displacement.x",
    "run_in.velocity.x",
    "contact.force.x",
    "contact.force.z",
];

/// Reads a result; columns may be in any order.
pub fn read(path: &Path) -> Result<Run, Fault> {
    let stations: Vec<String> = (1..=STATIONS).map(|i| format!("contact.pressure[{i}]")).collect();
    let mut names = NAMES.to_vec();
    names.extend(stations.iter().map(String::as_str));
    let mut columns = columns::read(path, &names, "`tread simulate` writes such a file")?;
    summary::enough_rows(columns[0].len())?;
    let pressure = columns.split_off(NAMES.len());
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
