//! `tread plot`: the result of a run as one SVG of several panels.

mod panels;
mod spectrum;
mod table;

use std::path::PathBuf;

use super::output::{self, Done, Stop};

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV that `tread simulate` wrote
    result: PathBuf,
    /// File to write; the result's name with .svg if not given, - for the standard output
    #[arg(long, short)]
    out: Option<PathBuf>,
}

/// Draws the file.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let result = table::read(&arguments.result)?;
    let svg = panels::draw(&result)?;
    let out = arguments.out.clone().unwrap_or_else(|| arguments.result.with_extension("svg"));
    if out.as_os_str() == "-" {
        output::to_stdout(svg.as_bytes())?;
    } else {
        output::to(Some(&out), svg.as_bytes())?;
        eprintln!("{}", out.display());
    }
    Ok(Done::Fine)
}
