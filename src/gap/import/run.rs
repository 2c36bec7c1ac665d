//! One run: columns of its table as channels at the campaign's rate, and what was done to them.

use std::path::Path;

use super::column::{both, column, time_column};
use super::plan::{Plan, RunSource, Source};
use super::resample::{Sampled, Signal};
use super::table::{self, Table};
use super::told::{ChannelTold, RunTold};
use super::units::Dimension;
use crate::error::Problem;
use crate::gap::campaign::{CHANNELS, VELOCITY};

/// Numbers are written to this many decimals of their SI unit: pm, pm/s, pN; a campaign can be packed.
const DECIMALS: usize = 12;

/// A channel on its way.
struct Taken {
    /// Index in [`CHANNELS`].
    channel: usize,
    /// Name of the column.
    from: String,
    /// SI units per count.
    scale: f64,
    /// Time of the logger that becomes 0 \[s\].
    shift: f64,
    signal: Signal,
}

/// The CSV of a run, its duration \[s\], and what was done.
pub(super) fn one_run(
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
    each_once(&mut problems);
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

/// Numbers of a column and of its time \[s\], and what one count is worth.
fn take(
    plan: &Plan,
    table: &Table,
    channel: usize,
    source: &Source,
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

/// One file's wrong time column is one problem, however many channels use it.
fn each_once(problems: &mut Vec<Problem>) {
    let mut told: Vec<Problem> = Vec::new();
    for problem in problems.drain(..) {
        if !told.contains(&problem) {
            told.push(problem);
        }
    }
    *problems = told;
}

/// A run that cannot be taken for what stands in `column` of `file`.
fn unclear(file: &str, column: &str, value: String, allowed: &str) -> Problem {
    let remedy = "the run cannot be taken as it is; mend the file or the plan";
    Problem::new(format!("{file}: {column}"), value, allowed, remedy)
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
