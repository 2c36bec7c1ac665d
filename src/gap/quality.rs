//! What can be wrong with measured data: told, worked around where that is possible.

use super::campaign::{
    BlockSize, Campaign, Plan, Record, Rig, Run, RunKind, RunSpec, APPROACH, CHANNELS, FRICTION,
    NORMAL, VELOCITY,
};
use crate::error::{Fault, Problem};

/// Fewest sliding runs from which anything can be decided.
const FEWEST_RUNS: usize = 4;
/// Smallest share of distinct values in a channel that is not held.
const FEWEST_LEVELS: usize = 3;
/// Share of samples at the very same extreme value beyond which a channel is clipped.
const CLIPPED_SHARE: f64 = 0.03;
/// Share of unusable cells that may be bridged.
const BRIDGED_SHARE: f64 = 0.02;

/// Problems of the campaign's settings.
pub fn of_plan(block: &BlockSize, rig: &Rig, runs: &[RunSpec]) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut need = |what: &str, value: f64, good: bool, allowed: &str| {
        if !good {
            let remedy = "give SI units in campaign.toml";
            problems.push(Problem::new(what, value.to_string(), allowed, remedy));
        }
    };
    for (name, value) in [
        ("block.length_m", block.length_m),
        ("block.height_m", block.height_m),
        ("block.width_m", block.width_m),
    ] {
        need(name, value, value > 5e-4 && value < 0.5, "0.5 mm to 0.5 m");
    }
    need("rig.start_ramp_s", rig.start_ramp_s, rig.start_ramp_s >= 0.0, "0 or more");
    let mass = rig.load_carriage_mass_kg;
    need("rig.load_carriage_mass_kg", mass, mass > 0.0, "more than 0");
    for run in runs {
        let length = run.duration_s;
        need(
            &format!("{} duration_s", run.file),
            length,
            length > 0.0 && length < 10.0,
            "0 to 10 s",
        );
        if run.kind != RunKind::Ringdown {
            let p = run.mean_pressure_pa;
            let allowed = "1 kPa to 100 MPa";
            need(&format!("{} mean_pressure_pa", run.file), p, p > 1e3 && p < 1e8, allowed);
        }
    }
    problems
}

/// Checks a record; unusable channels are dropped with a warning.
///
/// # Errors
/// The problem for which the whole run cannot be used.
pub fn of_record(
    record: &mut Record,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let tell = |what: &str, value: String, allowed: &str, remedy: &str| {
        Problem::new(format!("{}: {what}", spec.file), value, allowed, remedy)
    };
    check_time(record, plan, spec, warnings)?;
    for (c, name) in CHANNELS.iter().enumerate() {
        let Some(values) = record.channel[c].as_mut() else {
            if spec.kind != RunKind::Ringdown && plan.noise[c].is_some() {
                let remedy = "the diagnosis goes on without the channel";
                warnings.push(tell(name, "missing".into(), "a column of that name", remedy));
            }
            continue;
        };
        let fault = channel_fault(c, values, spec, plan.noise[c].unwrap_or(0.0));
        if let Some((value, allowed)) = fault {
            let remedy = "the diagnosis goes on without it; measure it again or mend the column";
            warnings.push(tell(name, value, allowed, remedy));
            record.channel[c] = None;
        }
    }
    if let Some(problem) = wrong_scale(record, plan, spec, warnings) {
        warnings.push(problem);
    }
    let useful = record.channel.iter().take(3).flatten().count();
    if useful == 0 || (spec.kind == RunKind::Ringdown && record.channel[VELOCITY].is_none()) {
        let remedy = "the run is left out; measure it again";
        return Err(tell("channels", "none usable".into(), "force or edge velocity", remedy));
    }
    Ok(())
}

/// A clock that is off by up to this share is told, and the rows are taken by their number.
const WRONG_CLOCK: f64 = 0.15;

fn check_time(
    record: &mut Record,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let tell = |value: String, allowed: &str, remedy: &str| {
        Err(Problem::new(format!("{}: time_s", spec.file), value, allowed, remedy))
    };
    let time = &mut record.time;
    if time.len() < 50 {
        return tell(format!("{} rows", time.len()), "50 rows or more", "the run is left out");
    }
    if time.iter().any(|t| !t.is_finite()) || time.windows(2).any(|w| w[1] <= w[0]) {
        let remedy = "the run is left out; sort it, or mend the time column";
        return tell("not increasing".into(), "finite and increasing", remedy);
    }
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let expected = 1.0 / plan.sampling_rate;
    record.clock = step / expected;
    if (record.clock - 1.0).abs() > 0.005 && (record.clock - 1.0).abs() <= WRONG_CLOCK {
        let what = "time_s against channels.sampling_rate_hz";
        if !warnings.iter().any(|w| w.what == what) {
            warnings.push(Problem::new(
                what,
                format!("{step:.7} s per sample ({} and perhaps others)", spec.file),
                format!("{expected:.7} s"),
                "rows are taken at the sampling rate, and no effect is named: find out which of the two is right",
            ));
        }
        for (row, t) in time.iter_mut().enumerate() {
            *t = row as f64 * expected;
        }
    } else if (record.clock - 1.0).abs() > WRONG_CLOCK {
        return tell(
            format!("{:.6} s per sample", step),
            &format!("{expected:.6} s, as channels.sampling_rate_hz says"),
            "the run is left out: rate and time column contradict each other, correct one of them",
        );
    }
    let shift = 2.0 * expected;
    if time[0].abs() > shift {
        return tell(
            format!("starts at {:.6} s", time[0]),
            "starts at 0 s, when the road starts",
            "the run is left out; shift the time so that the road starts at 0",
        );
    }
    let end = time[time.len() - 1];
    if end < 0.6 * spec.duration_s {
        return tell(
            format!("ends at {end:.6} s"),
            &format!("{:.6} s as duration_s says", spec.duration_s),
            "the run is left out; it is cut off",
        );
    }
    Ok(())
}

/// What is wrong with a channel: the value found and what would be accepted.
fn channel_fault(
    c: usize,
    values: &mut [f64],
    spec: &RunSpec,
    noise: f64,
) -> Option<(String, &'static str)> {
    let bad = values.iter().filter(|v| !v.is_finite()).count();
    if bad as f64 > BRIDGED_SHARE * values.len() as f64 {
        return Some((format!("{bad} cells are no numbers"), "finite numbers"));
    }
    bridge(values);
    if spec.kind == RunKind::Ringdown && c != VELOCITY {
        return None;
    }
    let (low, high) = extremes(values);
    let mut levels: Vec<f64> = values.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if levels.len() <= FEWEST_LEVELS || high - low < 0.5 * noise {
        return Some((format!("constant at {low}"), "a signal that moves"));
    }
    // Noise alone never hits the same extreme often: a clipped channel does.
    for extreme in [low, high] {
        let hits = values.iter().filter(|v| **v == extreme).count();
        if noise > 0.0 && hits as f64 > CLIPPED_SHARE * values.len() as f64 {
            return Some((
                format!("{hits} samples at {extreme}"),
                "a range that the signal fits in",
            ));
        }
    }
    None
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)))
}

/// Replaces single bad cells by their neighbours' mean.
fn bridge(values: &mut [f64]) {
    for i in 0..values.len() {
        if !values[i].is_finite() {
            let before = values[..i].iter().rev().find(|v| v.is_finite()).copied();
            let after = values[i + 1..].iter().find(|v| v.is_finite()).copied();
            values[i] = match (before, after) {
                (Some(a), Some(b)) => 0.5 * (a + b),
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => 0.0,
            };
        }
    }
}

/// A normal force far from the dead load, an approach or a velocity far from any sense: wrong unit.
fn wrong_scale(
    record: &mut Record,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Option<Problem> {
    if spec.kind == RunKind::Ringdown {
        return None;
    }
    let load = spec.mean_pressure_pa * plan.block.length_m * plan.block.width_m;
    let speed = spec.road_speed_m_s.abs().max(spec.road_speed_end_m_s.unwrap_or(0.0).abs());
    let scale = |values: &Vec<f64>| {
        let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes[sizes.len() * 9 / 10]
    };
    for (c, low, high, allowed) in [
        (NORMAL, 0.4 * load, 2.5 * load, "of the size of pressure x area"),
        (FRICTION, 0.05 * load, 5.0 * load, "of the size of 0.05 to 5 times pressure x area"),
        (VELOCITY, 0.05 * speed, 60.0 * speed + 0.2, "of the size of the road speed"),
        (APPROACH, 1e-6, 1e-3, "of the size of 1 um to 1 mm"),
    ] {
        let Some(size) = record.channel[c].as_ref().map(scale) else { continue };
        if !(low..=high).contains(&size) {
            let name = format!("{}: {}", spec.file, CHANNELS[c]);
            let remedy = "the channel is left out; look at its unit, sign and scale";
            warnings.push(Problem::new(name, format!("{size:.3e}"), allowed, remedy));
            record.channel[c] = None;
        }
    }
    None
}

/// Runs that are the same file, twice: only the first is kept.
pub fn across_runs(runs: &mut Vec<Run>, warnings: &mut Vec<Problem>) {
    let mut kept: Vec<Run> = Vec::new();
    for run in runs.drain(..) {
        match kept.iter().find(|k| k.hash == run.hash || k.record.channel == run.record.channel) {
            Some(same) => warnings.push(Problem::new(
                &run.spec.file,
                format!("the same data as {}", same.spec.file),
                "a measurement of its own",
                "the run is left out; restore its file",
            )),
            None => kept.push(run),
        }
    }
    *runs = kept;
}

/// Is there enough to decide anything?
///
/// # Errors
/// What is missing.
pub fn enough(campaign: &Campaign) -> Result<(), Fault> {
    let sliding = campaign.runs.iter().filter(|r| r.spec.kind != RunKind::Ringdown).count();
    let mut problems = Vec::new();
    if sliding < FEWEST_RUNS {
        problems.push(Problem::new(
            "usable sliding runs",
            sliding.to_string(),
            format!("{FEWEST_RUNS} or more"),
            "measure at more speeds and pressures, or mend the runs told above",
        ));
    }
    let told = campaign.warnings.len() as f64;
    let cells = (campaign.runs.len().max(1) * 3) as f64;
    if told > 0.7 * cells {
        problems.push(Problem::new(
            "faults of the data",
            told.to_string(),
            "few against the number of runs",
            "mend the columns told above",
        ));
    }
    if problems.is_empty() {
        return Ok(());
    }
    let mut all = campaign.warnings.clone();
    all.extend(problems);
    Err(Fault::Invalid(all))
}
