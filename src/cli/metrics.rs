//! `tread metrics`: what a sliding run amounts to, from its CSV.

use std::path::PathBuf;

use super::output::{self, Done, Stop};
use super::summary;
use crate::columns;
use crate::metrics::Trace;

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV with the FMU's outputs, as `tread simulate` or fmpy write it
    result: PathBuf,
    /// Road speed of the run [m/s]: what is slow against it counts as silence
    #[arg(long, allow_negative_numbers = true, value_parser = road_speed)]
    speed: f64,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// A speed that something can be slow against.
fn road_speed(text: &str) -> Result<f64, String> {
    let speed = text.parse::<f64>().ok().filter(|v| v.is_finite() && *v != 0.0);
    speed.ok_or_else(|| "allowed is a number in m/s that is not 0; write for example 0.3".into())
}

/// Columns that the metrics need.
const NAMES: [&str; 5] = [
    "time",
    "run_in.displacement.x",
    "run_in.velocity.x",
    "contact.friction_coefficient",
    "contact.stick_fraction",
];

/// Prints the metrics.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let columns = columns::read(&arguments.result, &NAMES, "`tread simulate` writes such a file")?;
    summary::enough_rows(columns[0].len())?;
    let trace = Trace {
        time: &columns[0],
        displacement: &columns[1],
        velocity: &columns[2],
        friction: &columns[3],
        stick: &columns[4],
    };
    let summary = summary::of_sliding(&trace, arguments.speed);
    let text = if arguments.json { format!("{}\n", summary.json()) } else { summary.text() };
    output::to_stdout(text.as_bytes())?;
    Ok(Done::Fine)
}
