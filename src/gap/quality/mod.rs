//! What can be wrong with measured data: told, worked around where that is possible.

mod channel;
mod time;

use super::campaign::{
    BlockSize, Campaign, Plan, Record, Rig, Run, RunKind, RunSpec, APPROACH, CHANNELS, FRICTION,
    NORMAL, VELOCITY,
};
use crate::error::{Fault, Problem};
use channel::channel_fault;
use time::check_time;

/// Fewest sliding runs from which anything can be decided.
const FEWEST_RUNS: usize = 4;

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
