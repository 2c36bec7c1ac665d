//! `tread plot`: the result of a run as one picture of several panels, or of several runs as a waterfall.

mod panels;
mod png;
mod spectrum;
mod table;
mod waterfall;

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::error::{Fault, Problem};

const EXAMPLES: &str = "\
Examples:
  tread plot run.csv                           draws run.svg: displacement, forces, limit cycle, ...
  tread plot run.csv --out run.png             the same as PNG
  tread plot v100.csv v200.csv v300.csv        draws waterfall.svg: spectra above each other
  tread plot v100.csv v200.csv v300.csv --speeds 0.1,0.2,0.3     the same over the road speed";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// CSV that `tread simulate` wrote; several give a waterfall of their spectra, first at the bottom
    #[arg(required = true)]
    results: Vec<PathBuf>,
    /// File to write, SVG or PNG by its ending; the result's name with .svg (or waterfall.svg) if not
    /// given, - for SVG on the standard output
    #[arg(long, short)]
    out: Option<PathBuf>,
    /// Road speeds [m/s] of the results, rising: the waterfall's axis
    #[arg(long, value_delimiter = ',', value_name = "SPEEDS")]
    speeds: Vec<f64>,
    /// Width of a PNG [pixels]
    #[arg(long, default_value_t = 1600, value_parser = clap::value_parser!(u32).range(100..=10_000))]
    width: u32,
}

/// Draws the file or files.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    check_speeds(&arguments.speeds, arguments.results.len())?;
    let mut runs = Vec::new();
    for file in &arguments.results {
        runs.push((name(file), table::read(file)?));
    }
    let (svg, out) = match runs.as_slice() {
        [(_, run)] => (panels::draw(run)?, arguments.results[0].with_extension("svg")),
        several => (waterfall::draw(several, &arguments.speeds)?, PathBuf::from("waterfall.svg")),
    };
    let out = arguments.out.clone().unwrap_or(out);
    if out.as_os_str() == "-" {
        output::to_stdout(svg.as_bytes())?;
        return Ok(Done::Fine);
    }
    let ending = out.extension().map_or_else(String::new, |e| e.to_string_lossy().to_lowercase());
    let bytes = match ending.as_str() {
        "png" => png::of(&svg, arguments.width)?,
        "svg" => svg.into_bytes(),
        _ => {
            let remedy = "end the file's name with one of them";
            let shown = out.display().to_string();
            return Err(Fault::one(Problem::new("--out", shown, ".svg or .png", remedy)).into());
        }
    };
    output::to(Some(&out), &bytes)?;
    eprintln!("{}", out.display());
    Ok(Done::Fine)
}

/// One speed per result, rising, or none.
fn check_speeds(speeds: &[f64], results: usize) -> Result<(), Fault> {
    let rising = speeds.windows(2).all(|w| w[1] > w[0]) && speeds.iter().all(|v| v.is_finite());
    if speeds.is_empty() || (rising && speeds.len() == results && results > 1) {
        return Ok(());
    }
    let shown = speeds.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let allowed = format!("{results} rising speeds, one for each of two or more results");
    Err(Fault::one(Problem::new("--speeds", shown, allowed, "order the results by speed")))
}

fn name(file: &Path) -> String {
    file.file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned())
}
