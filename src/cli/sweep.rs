//! `tread sweep`: many runs over any parameters.

use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::output::{self, Done, Stop};
use crate::sweep::{run, serve, table, Journal, Plan};

const EXAMPLES: &str = "\
A plan is a run's file with a [sweep] table:

  [sweep]
  method = \"grid\"                  # grid, one_at_a_time, latin_hypercube, sobol
  [sweep.vary]
  \"run.slide.speed\" = [0.1, 0.2, 0.3]
  \"friction.mu_inf\" = { from = 0.4, to = 0.6, count = 5 }

Examples:
  tread sweep plan.toml --out out/sweep
  tread sweep plan.toml --out out/sweep --resume    goes on after a stop
  tread sweep plan.toml --points-only               the points, as CSV

The folder gets sweep.csv and sweep.parquet, and journal.jsonl, which a resume reads. A point that fails
is a row with its reason; the exit code is then 1.";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// The plan: TOML with parameters, a [run] table and a [sweep] table
    plan: PathBuf,
    /// Folder for the results
    #[arg(long, short, default_value = "out/sweep")]
    out: PathBuf,
    /// Threads; 0: all cores. The results do not depend on it
    #[arg(long, short, default_value_t = 0)]
    jobs: usize,
    /// Go on with the sweep that the folder holds
    #[arg(long)]
    resume: bool,
    /// Print the points as CSV and run none
    #[arg(long, conflicts_with_all = ["resume", "serve"])]
    points_only: bool,
    /// Answer a driver that runs the FMU, line by line on the standard input and output
    #[arg(long, conflicts_with = "resume")]
    serve: bool,
    /// No progress on the standard error
    #[arg(long, short)]
    quiet: bool,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let plan = Plan::read(&arguments.plan)?;
    if arguments.points_only {
        output::to_stdout(&table::points_csv(&plan)?)?;
        return Ok(Done::Fine);
    }
    if arguments.serve {
        serve::serve(&plan, io::stdin().lock(), io::stdout().lock())?;
        return Ok(Done::Fine);
    }
    let path = arguments.out.join("journal.jsonl");
    let (journal, done) = Journal::open(&path, &plan, arguments.resume)?;
    if !arguments.quiet && !done.is_empty() {
        eprintln!("{} of {} points are done already", done.len(), plan.points.len());
    }
    let bar = progress(plan.points.len() as u64, done.len() as u64, arguments.quiet);
    let records = run::run(&plan, done, arguments.jobs, journal, |_| bar.inc(1))?;
    bar.finish_and_clear();
    let files = table::write(&plan, &records, &arguments.out)?;
    let failed = records.iter().filter(|record| record.outcome.is_err()).count();
    if !arguments.quiet {
        eprintln!("{} points, {failed} failed", records.len());
        files.iter().for_each(|file| eprintln!("{}", file.display()));
    }
    Ok(if failed == 0 { Done::Fine } else { Done::Problems })
}

/// Points done, rate and remaining time on the standard error: a bar for people, else a line now and
/// then would only fill a log.
fn progress(points: u64, done: u64, quiet: bool) -> ProgressBar {
    if quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(points);
    let template = "{wide_bar} {pos}/{len} points, {per_sec}, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_position(done);
    // The rate is that of this session, not of the points done before.
    bar.reset_eta();
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
