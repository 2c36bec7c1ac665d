//! `tread identify`: fit friction, contact and damping to Table 1 of the paper.

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use super::study::progress;
use crate::block::Reductions;
use crate::error::Fault;
use crate::params::{load, Params};
use crate::scenario::config;
use crate::study::identify::objective::Fineness;
use crate::study::identify::residual::{self, Explained, Question};
use crate::study::identify::run::{identify, Progress, Task};
use crate::study::identify::{laws, report, space};
use crate::study::paper::{Column, TABLE_1};
use crate::threads;

const EXAMPLES: &str = "\
Examples:
  tread identify --out out/identify
  tread identify --columns h10l15,h6l45 --out out/cross
  tread identify --law rational --evaluations 4000 --out out/rational
  tread identify --start compounds/paper.toml --evaluations 0 --hops 40 --rounds 14 --out out/hops
  tread identify --start compounds/paper.toml --evaluations 0 --out out/polish
  tread identify --start compounds/paper.toml --evaluations 0 --walk 200 --rounds 0 --out out/walk
  tread identify --start compounds/paper.toml --evaluations 0 --walk 80 --rounds 0 --laws --out out/laws";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// Folder for the parameter set and the report
    #[arg(long)]
    out: PathBuf,
    /// Columns of Table 1 to fit; all if not given
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    columns: Vec<String>,
    /// Friction law; that of the start if not given
    #[arg(long)]
    law: Option<String>,
    /// Parameters to fit; all unknowns of the law if not given
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    free: Vec<String>,
    /// Parameter file to start from
    #[arg(long)]
    start: Option<PathBuf>,
    /// Set a parameter of the start; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Simulated tables in the global search; 0: local search only
    #[arg(long, default_value_t = 1500)]
    evaluations: usize,
    /// Spread of the global search at its start, as a share of the ranges
    #[arg(long, default_value_t = 0.15)]
    spread: f64,
    /// Candidates per generation of the global search; 0: by the number of unknowns
    #[arg(long, default_value_t = 0)]
    population: usize,
    /// Hops along what the table hardly pins down, each followed by a local search
    #[arg(long, default_value_t = 0)]
    hops: usize,
    /// Steps of a walk downhill that looks at the worst cells, the median and what one per cent of friction changes
    #[arg(long, default_value_t = 0, value_name = "STEPS")]
    walk: usize,
    /// Rounds of a local search
    #[arg(long, default_value_t = 8)]
    rounds: usize,
    /// Solve the local search as coarsely as the global one
    #[arg(long)]
    coarse: bool,
    /// Solve the global search as finely as the local one: where a coarse table is silent and a fine one
    /// is not
    #[arg(long)]
    fine: bool,
    /// Seed of the global search
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Fit every effect to what is left, with the same effort each, and say what it explains
    #[arg(long)]
    effects: bool,
    /// Try every friction law: each begins at its least-squares fit to the curve of the start and gets the same search
    #[arg(long)]
    laws: bool,
    /// Threads; all cores if not given
    #[arg(long)]
    threads: Option<usize>,
    /// Print parameters, their uncertainty, what is not told apart, laws and effects that were tried as JSON
    #[arg(long)]
    json: bool,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let task = task(arguments)?;
    let pool = threads::pool(arguments.threads.unwrap_or(0))?;
    let best = arguments.out.join("best.toml");
    let found = pool.install(|| {
        identify(&task, &Reductions::default(), |progress| {
            eprintln!("{:6} {:6}, cost {:.4}", progress.stage, progress.evaluations, progress.cost);
            keep(&best, progress);
        })
    })?;
    write(&best, &found.params)?;
    let mut report = report::markdown(&task, &found);
    let mut document = report::document(&task, &found);
    for (name, text) in [
        ("parameters.csv", report::parameters_csv(&task, &found)),
        ("directions.csv", report::directions_csv(&task, &found)),
    ] {
        output::to(Some(&arguments.out.join(name)), text.as_bytes())?;
    }
    if arguments.laws {
        let tried = pool.install(|| {
            laws::compare(&task, &found, &Reductions::default(), |law| eprintln!("law {law}"))
        })?;
        output::to(Some(&arguments.out.join("laws.csv")), laws::csv(&tried).as_bytes())?;
        report.push_str(&laws::markdown(&tried));
        document["laws"] = laws::json(&tried);
    }
    output::to(Some(&arguments.out.join("report.md")), report.as_bytes())?;
    if !arguments.json {
        eprint!("{report}");
    }
    if arguments.effects {
        let answers = pool.install(|| explain(&task, &found.params));
        let table = residual::markdown(&answers);
        output::to(Some(&arguments.out.join("residual.md")), table.as_bytes())?;
        document["effects"] = residual::json(&answers);
        if !arguments.json {
            eprint!("{table}");
        }
    }
    if arguments.json {
        output::json_to_stdout(&document)?;
    }
    Ok(Done::Fine)
}

/// Every effect on what the fit leaves.
fn explain(task: &Task, fit: &Params) -> Vec<Explained> {
    let (unknowns, columns) = (&task.unknowns, &task.columns);
    let fineness = Fineness::choose(task.coarse);
    let question = Question { fit, unknowns, columns, fineness, rounds: task.rounds };
    let bar = progress();
    let answers = question.ask(&Reductions::default(), |name, done, of| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        bar.set_message(name.to_string());
    });
    bar.finish_and_clear();
    answers
}

/// Keeps the best so far, so that an interrupted search loses nothing; the final set is written
/// again, with errors told.
fn keep(path: &Path, progress: &Progress<'_>) {
    if write(path, progress.best).is_err() {
        eprintln!("cannot write {}", path.display());
    }
}

fn write(path: &Path, params: &Params) -> Result<(), Stop> {
    output::to(Some(path), load::to_toml(params).as_bytes())
}

/// What was typed as a task, or all that is wrong with it.
fn task(arguments: &Arguments) -> Result<Task, Fault> {
    let mut start = match &arguments.start {
        Some(path) => load::from_toml(&config::read_text(path)?)?,
        None => start(),
    };
    let mut problems = Vec::new();
    for assignment in &arguments.set {
        problems.extend(load::assign_text(assignment, &mut start));
    }
    if let Some(law) = &arguments.law {
        problems.extend(load::assign_text(&format!("friction.form={law}"), &mut start));
    }
    let mut unknowns = space::unknowns(start.friction.form);
    if !arguments.free.is_empty() {
        match space::select(&unknowns, &arguments.free) {
            Ok(selected) => unknowns = selected,
            Err(more) => problems.extend(more),
        }
    }
    let columns = columns(&arguments.columns, &mut problems);
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    Ok(Task {
        start,
        unknowns,
        columns,
        evaluations: arguments.evaluations,
        spread: arguments.spread,
        population: arguments.population,
        hops: arguments.hops,
        walk: arguments.walk,
        rounds: arguments.rounds,
        coarse: arguments.coarse,
        fine: arguments.fine,
        seed: arguments.seed,
    })
}

/// Columns by name.
fn columns(names: &[String], problems: &mut Vec<crate::error::Problem>) -> Vec<Column> {
    if names.is_empty() {
        return TABLE_1.to_vec();
    }
    let mut out = Vec::new();
    for name in names {
        match TABLE_1.iter().find(|c| c.name == name) {
            Some(column) => out.push(*column),
            None => problems.push(crate::error::Problem::new(
                "--columns",
                name.as_str(),
                TABLE_1.map(|c| c.name).join(", "),
                "correct the name of the column",
            )),
        }
    }
    out
}

/// A start from which a coarse search reached a median error of 6 %.
fn start() -> Params {
    let mut params = Params::default();
    params.rubber.stiffness_damping = 6.7e-5;
    params.friction.mu_inf = 0.32;
    params.friction.mu_drop = 0.87;
    params.friction.decay_speed = 2.0;
    params.friction.decay_exponent = 0.60;
    params.friction.rational_exponent = 0.8;
    params.friction.bell_steepness = 0.5;
    params.friction.smoothing_speed = 2.1e-3;
    params.friction.pressure_exponent = -0.01;
    params.contact.reference_pressure = 30e3;
    params.contact.depth = 25e-6;
    params
}
