//! `tread study`: the paper's studies on our own model.

use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::output::{self, Done, Stop};
use crate::error::Fault;
use crate::params::{load, Params};
use crate::scenario::config;
use crate::study;
use crate::study::identify::objective::Fineness;
use crate::study::measured::Measurements;
use crate::study::report::{html, Study};
use crate::threads;

const EXAMPLES: &str = "\
Examples:
  tread study table-1 --out out/paper
  tread study all
  tread study fig-6 --compound my-rubber.toml --out out/mine";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// Study to run: fig-2 to fig-9, table-1, or all
    study: String,
    /// Folder for CSV, SVG and HTML
    #[arg(long, default_value = "out/paper")]
    out: PathBuf,
    /// Parameter file; the compound identified from the paper if not given
    #[arg(long)]
    compound: Option<PathBuf>,
    /// Measured friction beside fig-2: CSV with the columns pressure_pa, speed_m_s, mu
    #[arg(long, value_name = "CSV")]
    friction: Option<PathBuf>,
    /// Measured wear beside fig-3: CSV with the columns pressure_pa, speed_m_s, rate_kg_m3
    #[arg(long, value_name = "CSV")]
    wear: Option<PathBuf>,
    /// Measured contact stiffness beside fig-2: CSV with the columns approach_m, force_n
    #[arg(long, value_name = "CSV")]
    stiffness: Option<PathBuf>,
    /// Solve coarsely: faster, frequencies within about 2 %
    #[arg(long)]
    coarse: bool,
    /// Threads; all cores if not given
    #[arg(long)]
    threads: Option<usize>,
    /// Verdicts, notes and names of the files as JSON on the standard output
    #[arg(long)]
    json: bool,
}

/// Runs it.
pub fn study(arguments: &Arguments) -> Result<Done, Stop> {
    let params = compound(arguments.compound.as_deref())?;
    let fineness = Fineness::choose(arguments.coarse);
    let measured = Measurements::new(
        arguments.friction.as_deref(),
        arguments.wear.as_deref(),
        arguments.stiffness.as_deref(),
    )?;
    let pool = threads::pool(arguments.threads.unwrap_or(0))?;
    let bar = progress();
    let studies = pool.install(|| {
        study::run(&arguments.study, &params, &fineness, &measured, |name, done, count| {
            bar.set_length(count as u64);
            bar.set_position(done as u64);
            bar.set_message(name.to_string());
        })
    })?;
    bar.finish_and_clear();
    for study in &studies {
        write(study, &arguments.out)?;
        if !arguments.json {
            tell(study);
        }
    }
    if arguments.study == "all" {
        let page = html(&studies, &load::to_toml(&params));
        output::to(Some(&arguments.out.join("index.html")), page.as_bytes())?;
        eprintln!("{}", arguments.out.join("index.html").display());
    }
    if arguments.json {
        output::json_to_stdout(&studies.iter().map(Study::document).collect())?;
    }
    Ok(Done::Fine)
}

/// A bar on terminals over studies, or effects, with the one that runs and the time so far.
pub(super) fn progress() -> ProgressBar {
    let bar = ProgressBar::new(1);
    if let Ok(style) = ProgressStyle::with_template("{msg:8} {bar:24} {pos}/{len} {elapsed}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(250));
    bar
}

/// Writes tables and pictures.
fn write(study: &Study, out: &Path) -> Result<(), Stop> {
    for (name, text) in study.tables.iter().chain(&study.pictures) {
        output::to(Some(&out.join(name)), text.as_bytes())?;
    }
    Ok(())
}

/// Tells tables made for people, notes and verdicts.
fn tell(study: &Study) {
    eprintln!("{}: {}", study.name, study.title);
    for (_, text) in study.tables.iter().filter(|(name, _)| name.ends_with(".txt")) {
        eprint!("{text}");
    }
    eprintln!("{}", study.notes);
    for verdict in &study.verdicts {
        eprintln!("  {}", verdict.line());
    }
}

/// The compound of the file, or the one identified from the paper.
fn compound(path: Option<&Path>) -> Result<Params, Fault> {
    let Some(path) = path else { return study::identified::paper() };
    load::from_toml(&config::read_text(path)?)
}
