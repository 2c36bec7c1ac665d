//! `tread simulate`: run a block on a road.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use super::output::{self, Done, Stop};
use super::{field, summary};
use crate::block::{Outputs, TreadBlock, OUTPUTS};
use crate::error::{number, Fault};
use crate::metrics::Recorder;
use crate::scenario::{self, config};

const EXAMPLES: &str = "\
Examples:
  tread simulate slide.toml > run.csv
  tread simulate slide.toml --out run.csv --set run.slide.speed=0.15 --set rubber.young_modulus=40e6
  tread simulate roll.toml --json --out run.json

The first column is time [s]; the others have the names and SI units of the FMU's outputs
(`tread fmu describe` lists them). A table of the stick-slip metrics goes to the standard error.";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// TOML file with parameters and a [run] table; `tread init` writes one
    config: PathBuf,
    /// Set a parameter, or a key of the [run] table as run.…, over the file's value; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// File to write; the standard output if not given
    #[arg(long, short)]
    out: Option<PathBuf>,
    /// Write JSON (columns, units, parameters, metrics) instead of CSV
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    field: field::Arguments,
    /// No table and no progress on the standard error
    #[arg(long, short)]
    quiet: bool,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let config = config::read(&arguments.config, &arguments.set)?;
    let mut block = TreadBlock::new(&config.params)?;
    let mut sink = Sink::open(arguments)?;
    let start = config.scenario.start();
    let span = (start, start + config.plan.duration);
    let mut field = field::Sink::open(&arguments.field, config.plan.step, span)?;
    let progress = progress(config.plan.rows() as u64, arguments.quiet);
    let mut recorder = Recorder::default();
    let mut stopped = None;
    let result = scenario::run(&mut block, &config.scenario, &config.plan, |time, block| {
        recorder.push(time, block.outputs());
        progress.inc(1);
        let written = sink.row(time, block.outputs()).and_then(|()| field.row(time, block));
        written.map_err(|stop| {
            stopped = Some(stop);
            // Only ends the run: `stopped` says why.
            Fault::unusable("", "stopped")
        })
    });
    progress.finish_and_clear();
    if let Some(stop) = stopped {
        return Err(stop);
    }
    // Rows up to a fault are worth having: they show what led to it.
    let summary = summary::of(&config, &recorder);
    sink.close(&config, &summary)?;
    field.close()?;
    result?;
    if !arguments.quiet {
        eprint!("{}", summary.text());
    }
    Ok(Done::Fine)
}

/// Header of the CSV: `time`, then the dotted names of the outputs, arrays with their index from 1.
pub fn columns() -> Vec<String> {
    let outputs = OUTPUTS.iter().flat_map(|spec| {
        (0..spec.size).map(|i| match spec.size {
            1 => spec.name.to_string(),
            _ => format!("{}[{}]", spec.name, i + 1),
        })
    });
    std::iter::once("time".to_string()).chain(outputs).collect()
}

/// One row: the time and the outputs in the order of [`columns`].
fn cells(time: f64, outputs: &Outputs) -> impl Iterator<Item = f64> + '_ {
    let values =
        OUTPUTS.iter().flat_map(move |spec| (0..spec.size).map(move |i| (spec.get)(outputs, i)));
    std::iter::once(time).chain(values)
}

/// A bar on the standard error, if someone looks at it.
fn progress(rows: u64, quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(rows);
    if let Ok(style) = ProgressStyle::with_template("simulating {wide_bar} {percent}% {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Where rows go: CSV at once, or columns of JSON at the end.
enum Sink {
    Csv { writer: Box<csv::Writer<Box<dyn Write>>>, target: String },
    Json { columns: Vec<Vec<f64>>, out: Box<dyn Write>, target: String },
}

impl Sink {
    fn open(arguments: &Arguments) -> Result<Self, Stop> {
        let out = output::writer(arguments.out.as_deref())?;
        let target = output::target(arguments.out.as_deref());
        if arguments.json {
            return Ok(Self::Json { columns: vec![Vec::new(); columns().len()], out, target });
        }
        let mut writer = Box::new(csv::Writer::from_writer(out));
        writer.write_record(columns()).map_err(|e| failed(&target, e))?;
        Ok(Self::Csv { writer, target })
    }

    fn row(&mut self, time: f64, outputs: &Outputs) -> Result<(), Stop> {
        match self {
            Self::Csv { writer, target } => {
                writer.write_record(cells(time, outputs).map(number)).map_err(|e| failed(target, e))
            }
            Self::Json { columns, .. } => {
                for (column, cell) in columns.iter_mut().zip(cells(time, outputs)) {
                    column.push(cell);
                }
                Ok(())
            }
        }
    }

    fn close(self, config: &config::Config, summary: &summary::Summary) -> Result<(), Stop> {
        match self {
            Self::Csv { mut writer, target } => {
                writer.flush().map_err(|e| output::write_failed(&target, &e))
            }
            Self::Json { columns: cells, mut out, target } => {
                let document = summary::json(config, summary, &columns(), &cells);
                writeln!(out, "{document}")
                    .and_then(|()| out.flush())
                    .map_err(|e| output::write_failed(&target, &e))
            }
        }
    }
}

fn failed(target: &str, error: csv::Error) -> Stop {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => output::write_failed(target, &error),
        other => Stop::Fault(Fault::unusable(target, format!("{other:?}"))),
    }
}
