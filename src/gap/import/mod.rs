//! `tread gap import`: a campaign's folder from what laboratories have.
//!
//! A plan (a campaign file that also names columns, units and starts) and CSV files → units to SI → time
//! shifted so that the road starts at 0 → rows at the campaign's rate → `campaign.toml` and `runs/*.csv`.
//! Whatever is done to a channel is told; what cannot be told apart is refused. See the book,
//! `own-campaign.md`.

pub mod plan;
pub mod resample;
pub mod table;
pub mod told;
pub mod units;

use std::path::Path;

use plan::{Plan, RunSource, TimeColumn};
use resample::{Sampled, Signal};
use table::Table;
use told::{ChannelTold, Imported, RunTold};
use toml::Value;
use units::Dimension;

use super::campaign::{self, CHANNELS, VELOCITY};
use crate::error::{Fault, Problem};

/// Numbers are written to this many decimals of their SI unit: pm, pm/s, pN; a campaign can be packed.
const DECIMALS: usize = 12;

/// Reads a plan and its files, and writes the campaign below `out` if nothing is wrong with them.
///
/// # Errors
/// All that is wrong with the plan, or all that is wrong with its files; then nothing is written.
pub fn import(plan_file: &Path, out: &Path) -> Result<Imported, Fault> {
    let shown = plan_file.display().to_string();
    let text = std::fs::read_to_string(plan_file).map_err(|e| Fault::file(plan_file, &e))?;
    let plan = plan::parse(&text, &shown)?;
    let folder = plan_file.parent().unwrap_or(Path::new(""));
    let (mut problems, mut files, mut told) = (Vec::new(), Vec::new(), Vec::new());
    let mut campaign_file = plan.campaign.clone();
    for (at, run) in plan.runs.iter().enumerate() {
        match one_run(&plan, run, folder) {
            Ok((csv, duration, run_told)) => {
                let runs = campaign_file.get_mut("runs").and_then(Value::as_array_mut);
                if let Some(Value::Table(entry)) = runs.and_then(|r| r.get_mut(at)) {
                    entry.insert("duration_s".into(), duration.into());
                }
                files.push((run.file.clone(), csv));
                told.push(run_told);
            }
            Err(mut wrong) => problems.append(&mut wrong),
        }
    }
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    let header = format!("# Made by `tread gap import {shown}`; import.json says how.\n");
    let failed = |e: toml::ser::Error| Fault::unusable(plan_file, e);
    let campaign_text = header + &toml::to_string(&campaign_file).map_err(failed)?;
    // Sizes, pressures and the datasheet are judged as those of any campaign.
    campaign::parse_plan(&campaign_text, &shown)?;
    let imported = Imported { rate: plan.rate, runs: told };
    files.push(("campaign.toml".to_string(), campaign_text));
    files.push(("import.json".to_string(), imported.json()));
    for (name, text) in &files {
        write(&out.join(name), text)?;
    }
    Ok(imported)
}

fn write(path: &Path, text: &str) -> Result<(), Fault> {
    let failed = |e: std::io::Error| Fault::file(path, &e);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    std::fs::write(path, text).map_err(failed)
}

/// A channel on its way.
struct Taken {
    channel: usize,
    from: String,
    scale: f64,
    shift: f64,
    signal: Signal,
}

/// The CSV of a run, its duration \[s\], and what was done.
fn one_run(
    plan: &Plan,
    run: &RunSource,
    folder: &Path,
) -> Result<(String, f64, RunTold), Vec<Problem>> {
    let table =
        table::read(&folder.join(&run.from), &run.from, &plan.dialect).map_err(|p| vec![p])?;
    let mut problems = Vec::new();
    let start = start(plan, run, &table).map_err(|mut p| problems.append(&mut p));
    let mut taken = Vec::new();
    for ((channel, source), delay) in plan.channels.iter().zip(&plan.delays) {
        // A struck block hangs free: nothing but its edge velocity says anything.
        if run.ringdown && *channel != VELOCITY {
            continue;
        }
        let shift = start.unwrap_or(0.0) + delay;
        match take(plan, &table, *channel, source, shift) {
            Ok(one) => taken.push(one),
            Err(mut wrong) => problems.append(&mut wrong),
        }
    }
    // One file's wrong time column is one problem, however many channels use it.
    let mut told: Vec<Problem> = Vec::new();
    problems.retain(|p| {
        !told.contains(p) && {
            told.push(p.clone());
            true
        }
    });
    let spans: Vec<(usize, usize)> = taken
        .iter()
        .filter_map(|t| {
            let rows = t.signal.rows(plan.rate, run.duration);
            let unclear = |(value, allowed)| unclear(&table.file, &t.from, value, allowed);
            rows.map_err(|e| problems.push(unclear(e))).ok()
        })
        .collect();
    if !problems.is_empty() || taken.is_empty() {
        return Err(problems);
    }
    let span = spans.iter().fold((0, usize::MAX), |(a, b), s| (a.max(s.0), b.min(s.1)));
    let sampled: Vec<Sampled> = taken.iter().map(|t| t.signal.at_rows(plan.rate, span)).collect();
    let duration = run.duration.unwrap_or(span.1 as f64 / plan.rate);
    let told = RunTold {
        file: run.file.clone(),
        from: run.from.clone(),
        latin_1: table.latin_1,
        first_row: span.0,
        duration: (duration, run.duration.is_none()),
        unused: unused(plan, &table),
        channels: taken.iter().zip(&sampled).map(|(t, s)| tell(t, s)).collect(),
    };
    Ok((csv(plan.rate, span, &taken, &sampled), duration, told))
}

fn unclear(file: &str, column: &str, value: String, allowed: &str) -> Problem {
    let remedy = "the run cannot be taken as it is; mend the file or the plan";
    Problem::new(format!("{file}: {column}"), value, allowed, remedy)
}

/// Numbers of a column and of its time \[s\], and what one count is worth.
fn take(
    plan: &Plan,
    table: &Table,
    channel: usize,
    source: &plan::Source,
    shift: f64,
) -> Result<Taken, Vec<Problem>> {
    let name = format!("channels.{}", CHANNELS[channel]);
    let time = source.time.as_ref().unwrap_or(&plan.time);
    let dimension = Dimension::OF_CHANNELS[channel];
    let (places, scales) = both(
        column(table, &name, &source.column, source.unit.as_deref(), dimension),
        time_column(table, time),
    )?;
    let [seconds, values] = table.pairs([places[1], places[0]])?;
    let seconds = seconds.iter().map(|t| t * scales[1]).collect();
    let values = values.iter().map(|v| v * scales[0]).collect();
    let signal = Signal::new(seconds, values, shift)
        .map_err(|(value, allowed)| vec![unclear(&table.file, &time.column, value, allowed)])?;
    let from = table.header[places[0]].0.clone();
    Ok(Taken { channel, from, scale: scales[0], shift, signal })
}

type Found = Result<(usize, f64), Vec<Problem>>;

/// Places and scales of both columns, or the problems of both.
fn both(value: Found, time: Found) -> Result<([usize; 2], [f64; 2]), Vec<Problem>> {
    match (value, time) {
        (Ok(v), Ok(t)) => Ok(([v.0, t.0], [v.1, t.1])),
        (v, t) => Err([v.err(), t.err()].into_iter().flatten().flatten().collect()),
    }
}

fn time_column(table: &Table, time: &TimeColumn) -> Found {
    column(table, "channels.time", &time.column, time.unit.as_deref(), Dimension::Time)
}

/// Where a column stands and what one count is worth: the plan's unit, or the header's.
fn column(
    table: &Table,
    what: &str,
    name: &str,
    unit: Option<&str>,
    dimension: Dimension,
) -> Found {
    let place = table.place(what, name).map_err(|p| vec![p])?;
    let header = table.header[place].1.as_deref();
    let problem = |value: String, allowed: &str, remedy: &str| {
        Err(vec![Problem::new(format!("{}: unit of {name}", table.file), value, allowed, remedy)])
    };
    let Some(text) = unit.or(header) else {
        let remedy = "give unit = … in the plan";
        return problem(
            "neither in the plan nor in the header".into(),
            dimension.allowed(),
            remedy,
        );
    };
    let Some(scale) = units::si(dimension, text) else {
        return problem(format!("{text:?}"), dimension.allowed(), "name the column's unit");
    };
    // A header whose unit is known and another one than the plan's: one of the two is wrong.
    let said = header.and_then(|h| units::si(dimension, h));
    if let Some(said) = said.filter(|said| (said.abs() / scale.abs() - 1.0).abs() > 1e-9) {
        let value = format!("{text:?} in the plan, worth {scale}, against {said} in the header");
        return problem(value, "the same in both", "find out which is right, and mend the other");
    }
    Ok((place, scale))
}

/// When the road starts, in the logger's time \[s\]: as the run says, or where the trigger is crossed.
fn start(plan: &Plan, run: &RunSource, table: &Table) -> Result<f64, Vec<Problem>> {
    let (Some(trigger), None) = (&plan.trigger, run.start) else {
        return Ok(run.start.unwrap_or(0.0));
    };
    let value = table.place("start.column", &trigger.column).map(|p| (p, 1.0));
    let (places, scales) = both(value.map_err(|p| vec![p]), time_column(table, &plan.time))?;
    let [time, level] = table.pairs([places[1], places[0]])?;
    let crossing = level.iter().position(|v| v.abs() >= trigger.above);
    match crossing {
        Some(at) if at > 0 => {
            let (before, after) = (level[at - 1].abs(), level[at].abs());
            let share = (trigger.above - before) / (after - before);
            Ok(scales[1] * (time[at - 1] + share * (time[at] - time[at - 1])))
        }
        Some(_) => Err(vec![unclear(
            &table.file,
            &trigger.column,
            format!("{} at the first row", level[0]),
            "a record that begins below start.above",
        )]),
        None => Err(vec![unclear(
            &table.file,
            &trigger.column,
            format!("never reaches {}", trigger.above),
            "a column that crosses start.above when the road starts",
        )]),
    }
}

/// Columns of the file that the plan does not name.
fn unused(plan: &Plan, table: &Table) -> Vec<String> {
    let mut used = vec![plan.time.column.as_str()];
    used.extend(plan.trigger.as_ref().map(|t| t.column.as_str()));
    for (_, source) in &plan.channels {
        used.push(&source.column);
        used.extend(source.time.as_ref().map(|t| t.column.as_str()));
    }
    let names = table.header.iter().map(|h| h.0.clone());
    names.filter(|n| !used.contains(&n.as_str())).collect()
}

fn tell(taken: &Taken, sampled: &Sampled) -> ChannelTold {
    ChannelTold {
        channel: CHANNELS[taken.channel],
        from: taken.from.clone(),
        scale: taken.scale,
        rate: 1.0 / taken.signal.step,
        shift: taken.shift,
        copied: sampled.copied,
        distance: sampled.distance,
        lost: sampled.lost,
        rows: sampled.values.len(),
    }
}

/// The run as a campaign has it.
fn csv(rate: f64, span: (usize, usize), taken: &[Taken], sampled: &[Sampled]) -> String {
    let mut out = String::from("time_s");
    for one in taken {
        out.push(',');
        out.push_str(CHANNELS[one.channel]);
    }
    for row in span.0..=span.1 {
        out.push('\n');
        out.push_str(&decimal(row as f64 / rate));
        for channel in sampled {
            out.push(',');
            out.push_str(&decimal(channel.values[row - span.0]));
        }
    }
    out.push('\n');
    out
}

/// A plain decimal number without zeros at its end.
fn decimal(x: f64) -> String {
    let text = format!("{x:.DECIMALS$}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_string(),
        short => short.to_string(),
    }
}
