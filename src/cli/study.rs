//! `tread study`: the paper's studies on our own model.

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::error::{Fault, Problem};
use crate::params::{load, Params};
use crate::study::identify::objective::Fineness;
use crate::study::paper::TABLE_1;
use crate::study::table_one::TableOne;

const EXAMPLES: &str = "\
Examples:
  tread study table-1 --out out/paper
  tread study all
  tread study fig-6 --compound my-rubber.toml --out out/mine";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// Study to run: table-1
    study: String,
    /// Folder for CSV, SVG and HTML
    #[arg(long, default_value = "out/paper")]
    out: PathBuf,
    /// Parameter file; the compound identified from the paper if not given
    #[arg(long)]
    compound: Option<PathBuf>,
    /// Solve coarsely: faster, frequencies within about 2 %
    #[arg(long)]
    coarse: bool,
    /// Threads; all cores if not given
    #[arg(long)]
    threads: Option<usize>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let params = compound(arguments.compound.as_deref())?;
    let fineness = if arguments.coarse { Fineness::COARSE } else { Fineness::FINE };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads.unwrap_or(0))
        .build()
        .map_err(|e| Fault::File { path: "threads".to_string(), reason: e.to_string() })?;
    pool.install(|| match arguments.study.as_str() {
        "table-1" => table_one(&params, &fineness, &arguments.out),
        other => Err(Fault::one(Problem::new("study", other, "table-1", "name one of them")).into()),
    })
}

fn table_one(params: &Params, fineness: &Fineness, out: &Path) -> Result<Done, Stop> {
    let table = TableOne::simulate(params, &TABLE_1, fineness);
    output::to(Some(&out.join("table-1.csv")), table.csv().as_bytes())?;
    eprint!("{}", table.text());
    Ok(Done::Fine)
}

/// The compound of the file, or the one identified from the paper.
fn compound(path: Option<&Path>) -> Result<Params, Fault> {
    let Some(path) = path else { return Ok(Params::default()) };
    let text = std::fs::read_to_string(path)
        .map_err(|e| Fault::File { path: path.display().to_string(), reason: e.to_string() })?;
    load::from_toml(&text)
}
