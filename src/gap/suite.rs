//! Campaigns of the own simulator whose effect is known, in the format of measured ones.
//!
//! They are cut finer than the fits' model, carry the noise of the channels, draw the block from the
//! datasheet, and use a functional form other than the one that the first guess of an effect uses;
//! diagnosed `--without families`, no form in them is known to the diagnosis.

use super::campaign::{self, Plan, Record, CHANNELS};
use super::json::changes;
use super::noise::Noise;
use super::predict;
use super::problem::Coordinate;
use super::ripple::Ripple;
use super::simulate::{nominal, set, Simulator, DATASHEET, FINE};
use crate::effects::{fit_specs, Spread};
use crate::error::Fault;
use crate::params::Params;
use rayon::prelude::*;
use serde_json::{json, Map, Value as Json};
use std::path::Path;

/// The campaign that a suite's campaigns are made after, if none is named.
pub const TEMPLATE: &str = include_str!("campaign_template.toml");
/// Severities in standard deviations of the prior of an effect, from weak to strong.
const SEVERITY: [f64; 2] = [-0.5, 1.0];
/// Sizes of blocks in turn: length and height \[m\].
const SIZES: [(f64, f64); 4] = [(0.015, 0.010), (0.015, 0.008), (0.015, 0.006), (0.018, 0.010)];

/// What causes the gap in a made campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Truth {
    /// Nothing.
    None,
    /// An effect of the list in its last form.
    Effect(usize),
    /// Two of them.
    Pair([usize; 2]),
    /// The force channel's amplifier is off by some per cent; no effect of the list.
    Gain,
    /// The clock of the measurement runs at another rate; no effect of the list.
    Clock,
    /// The normal force channel sees some of friction; no effect of the list.
    CrossTalk,
    /// The zero of the friction channel drifts in every run; no effect of the list.
    Drift,
    /// The drive of the road does not hold its speed; no effect of the list.
    SpeedRipple,
    /// The load is not constant; no effect of the list.
    LoadRipple,
}

/// Sensors and drives that are wrong, in turn.
const OUTSIDE: [(Truth, &str); 6] = [
    (Truth::Gain, "x_gain"),
    (Truth::Clock, "x_clock"),
    (Truth::CrossTalk, "x_cross_talk"),
    (Truth::Drift, "x_drift"),
    (Truth::SpeedRipple, "x_speed_ripple"),
    (Truth::LoadRipple, "x_load_ripple"),
];

/// Of eight campaigns one has no effect, one has two, one an effect that is not in the list.
fn truth(number: usize) -> Truth {
    let count = fit_specs().len();
    match number % 8 {
        0 => Truth::None,
        4 => {
            // Another pair every time until all steps are used up.
            let (first, step) = (number / 8 * 3 % count, 1 + number / 8 * 5 % (count - 1));
            Truth::Pair([first, (first + step) % count])
        }
        7 => OUTSIDE[number / 8 % OUTSIDE.len()].0,
        k => {
            let before = number / 8 * 5 + [0, 0, 1, 2, 2, 3, 4][k];
            Truth::Effect(before % count)
        }
    }
}

/// Writes `count` campaigns with labels and held-out runs into `out`; a seed gives the same campaigns
/// always.
///
/// # Errors
/// Files that cannot be written, and what stops the block.
pub fn make(template: Option<&Path>, out: &Path, count: usize, seed: u64) -> Result<(), Fault> {
    let (plan, text) = match template {
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
            (campaign::read_plan(path)?, text)
        }
        None => {
            (campaign::parse_plan(TEMPLATE, "the project's own template")?, TEMPLATE.to_string())
        }
    };
    let labels: Result<Vec<(String, Json)>, Fault> =
        (0..count).into_par_iter().map(|number| one(&plan, &text, out, number, seed)).collect();
    let labels: Map<String, Json> = labels?.into_iter().collect();
    let target = out.join("labels.json");
    let text = serde_json::to_string_pretty(&Json::Object(labels)).unwrap_or_default();
    std::fs::write(&target, text).map_err(|e| Fault::file(&target, &e))
}

/// One campaign with its label: block, parameters and cause drawn from `seed` and `number`.
fn one(
    template: &Plan,
    text: &str,
    out: &Path,
    number: usize,
    seed: u64,
) -> Result<(String, Json), Fault> {
    let mut noise = Noise::new(seed.wrapping_mul(1_000_003).wrapping_add(number as u64));
    let id = format!("own-{:02}", number + 1);
    let mut plan = template.clone();
    (plan.block.length_m, plan.block.height_m) = SIZES[number % SIZES.len()];
    let mut params = drawn(&plan, &mut noise);
    let truth = truth(number);
    let severity = SEVERITY[0] + (SEVERITY[1] - SEVERITY[0]) * noise.uniform();
    let mut label = add(truth, severity, &mut params, &mut noise);
    label["parameters"] = changes(&params, &nominal(&plan));
    let simulator = Simulator::cut(&plan, FINE)?.rippled(ripple(truth, severity));
    let folder = out.join(&id);
    for spec in &plan.runs {
        let mut record = simulator.run(&params, spec, spec.duration_s)?;
        distort(truth, severity, &mut record);
        blur(&plan, &mut record, &mut noise);
        let target = folder.join(&spec.file);
        predict::write(&target, &plan, spec, &record).map_err(|e| Fault::file(&target, &e))?;
    }
    let target = folder.join("campaign.toml");
    std::fs::write(&target, titled(text, &id, &plan)).map_err(|e| Fault::file(&target, &e))?;
    Ok((id, label))
}

/// The template with another name and another block.
fn titled(text: &str, id: &str, plan: &Plan) -> String {
    let line = |line: &str| match line.split('=').next().map(str::trim) {
        Some("id") => format!("id = \"{id}\""),
        Some("length_m") => format!("length_m = {}", plan.block.length_m),
        Some("height_m") => format!("height_m = {}", plan.block.height_m),
        _ => line.to_string(),
    };
    text.lines().map(|l| line(l) + "\n").collect()
}

/// One block from the datasheet.
fn drawn(plan: &Plan, noise: &mut Noise) -> Params {
    let mut params = nominal(plan);
    for (key, name) in DATASHEET {
        if let Some(datum) = plan.nominal.get(key) {
            set(&mut params, name, datum.value * (datum.relative_std * noise.normal()).exp());
        }
    }
    params
}

/// Adds what causes the gap; returns its label.
fn add(truth: Truth, severity: f64, params: &mut Params, noise: &mut Noise) -> Json {
    let effects = match truth {
        Truth::Effect(effect) => vec![effect],
        Truth::Pair(effects) => effects.to_vec(),
        _ => {
            let effects: Vec<&str> = OUTSIDE.iter().filter(|o| o.0 == truth).map(|o| o.1).collect();
            return json!({"effects": effects, "severity": 1.0 + severity});
        }
    };
    for effect in &effects {
        add_effect(*effect, severity, params, noise);
    }
    let specs = || effects.iter().map(|effect| &fit_specs()[*effect]);
    let names: Vec<&str> = specs().map(|spec| spec.effect).collect();
    let forms: Vec<&str> = specs().map(|spec| spec.forms[spec.forms.len() - 1].name).collect();
    json!({"effects": names, "severity": 1.0 + severity, "form": forms.join(", ")})
}

/// Adds an effect of the list.
fn add_effect(effect: usize, severity: f64, params: &mut Params, noise: &mut Noise) {
    let spec = &fit_specs()[effect];
    let form = spec.forms.len() - 1;
    let at = |(k, p): (usize, &crate::effects::FitParam)| {
        let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
        let x = match (k, p.spread) {
            (0, Spread::Absolute(_)) => sign * (0.6 + 0.5 * (severity + 0.5)),
            (0, Spread::Log(_)) => severity,
            _ => 0.6 * noise.normal(),
        };
        Coordinate { name: p.name, centre: p.centre, spread: p.spread }.value(x)
    };
    let values: Vec<f64> = spec.forms[form].params.iter().enumerate().map(at).collect();
    spec.apply(form, &values, params);
}

/// How far something outside the list is off, as a share.
fn share_off(severity: f64) -> f64 {
    0.04 * (1.0 + severity)
}

/// What is wrong with the drives.
fn ripple(truth: Truth, severity: f64) -> Option<Ripple> {
    match truth {
        Truth::SpeedRipple => Some(Ripple { speed: share_off(severity), load: 0.0 }),
        Truth::LoadRipple => Some(Ripple { speed: 0.0, load: share_off(severity) }),
        _ => None,
    }
}

/// What is wrong with the measurement itself.
fn distort(truth: Truth, severity: f64, record: &mut Record) {
    let share = 1.0 + share_off(severity);
    match truth {
        Truth::Gain => {
            if let Some(force) = record.channel[campaign::FRICTION].as_mut() {
                force.iter_mut().for_each(|f| *f *= share);
            }
        }
        Truth::Clock => {
            for column in record.channel.iter_mut().flatten() {
                *column = slowed(column, share);
            }
        }
        Truth::CrossTalk => {
            let [friction, normal, ..] = &mut record.channel;
            let pairs = friction.iter().flatten().zip(normal.iter_mut().flatten());
            pairs.for_each(|(f, n)| *n += (share - 1.0) * f);
        }
        Truth::Drift => {
            let count = record.time.len() as f64;
            let full = DRIFT * (1.0 + severity);
            for column in record.channel[campaign::FRICTION].iter_mut() {
                column.iter_mut().enumerate().for_each(|(i, f)| *f += full * i as f64 / count);
            }
        }
        Truth::None | Truth::Effect(_) | Truth::Pair(_) => {}
        Truth::SpeedRipple | Truth::LoadRipple => {}
    }
}

/// Drift of the zero of the friction channel over a run at severity 1 \[N\].
const DRIFT: f64 = 3.0;

/// The column as a clock sees it that is slow by the factor `share`; the end stands still.
fn slowed(column: &[f64], share: f64) -> Vec<f64> {
    let value = |i: usize| {
        let at = i as f64 * share;
        let k = (at as usize).min(column.len() - 1);
        let next = (k + 1).min(column.len() - 1);
        column[k] + (at - k as f64).min(1.0) * (column[next] - column[k])
    };
    (0..column.len()).map(value).collect()
}

/// Adds the noise of the channels.
fn blur(plan: &Plan, record: &mut Record, noise: &mut Noise) {
    for (column, std) in record.channel.iter_mut().zip(plan.noise) {
        let (Some(column), Some(std)) = (column, std) else { continue };
        column.iter_mut().for_each(|v| *v += std * noise.normal());
    }
    debug_assert_eq!(CHANNELS.len(), record.channel.len());
}
