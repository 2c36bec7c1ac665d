//! `tread plot`: the result of a run as one SVG of several panels, or of several runs as a waterfall.

mod panels;
mod spectrum;
mod table;
mod waterfall;

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};

const EXAMPLES: &str = "\
Examples:
  tread plot run.csv                           draws run.svg: displacement, forces, limit cycle, ...
  tread plot v100.csv v200.csv v300.csv        draws waterfall.svg: spectra above each other";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// CSV that `tread simulate` wrote; several give a waterfall of their spectra, first at the bottom
    #[arg(required = true)]
    results: Vec<PathBuf>,
    /// File to write; the result's name with .svg (or waterfall.svg) if not given, - for the standard
    /// output
    #[arg(long, short)]
    out: Option<PathBuf>,
}

/// Draws the file or files.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let mut runs = Vec::new();
    for file in &arguments.results {
        runs.push((name(file), table::read(file)?));
    }
    let (svg, out) = match runs.as_slice() {
        [(_, run)] => (panels::draw(run)?, arguments.results[0].with_extension("svg")),
        several => (waterfall::draw(several)?, PathBuf::from("waterfall.svg")),
    };
    let out = arguments.out.clone().unwrap_or(out);
    if out.as_os_str() == "-" {
        output::to_stdout(svg.as_bytes())?;
    } else {
        output::to(Some(&out), svg.as_bytes())?;
        eprintln!("{}", out.display());
    }
    Ok(Done::Fine)
}

fn name(file: &Path) -> String {
    file.file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned())
}
