//! Campaigns of the own simulator whose effect is known, in the format of measured ones.
//!
//! They are cut finer than the fits' model, carry the noise of the channels, draw the block from the
//! datasheet, and use a functional form other than the one that the first guess of an effect uses;
//! diagnosed `--without families`, no form in them is known to the diagnosis.

mod further;
mod measured;

use super::campaign::{self, Plan};
use super::json::changes;
use super::noise::Noise;
use super::predict;
use super::problem::Coordinate;
use super::ripple::Ripple;
use super::simulate::{nominal, set, Simulator, DATASHEET, FINE};
use crate::effects::{fit_specs, Spread};
use crate::error::Fault;
use crate::params::Params;
use measured::{blur, distort};
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

/// Where a suite goes.
#[derive(Clone, Copy, Debug)]
pub struct Folders<'a> {
    /// Campaigns and labels.
    pub out: &'a Path,
    /// Further runs of the same blocks, if they are asked for.
    pub further: Option<&'a Path>,
}

/// Writes `count` campaigns with labels and further runs of the same blocks into `folders`; a seed gives the same
/// campaigns always.
///
/// # Errors
/// Files that cannot be written, and what stops the block.
pub fn make(
    template: Option<&Path>,
    folders: Folders<'_>,
    count: usize,
    seed: u64,
) -> Result<(), Fault> {
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
        (0..count).into_par_iter().map(|number| one(&plan, &text, folders, number, seed)).collect();
    let labels: Map<String, Json> = labels?.into_iter().collect();
    let target = folders.out.join("labels.json");
    let text = serde_json::to_string_pretty(&Json::Object(labels)).unwrap_or_default();
    std::fs::write(&target, text).map_err(|e| Fault::file(&target, &e))
}

/// One campaign with its label: block, parameters and cause drawn from `seed` and `number`.
fn one(
    template: &Plan,
    text: &str,
    folders: Folders<'_>,
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
    let mut write = |folder: &Path, plan: &Plan, text: String| -> Result<(), Fault> {
        for spec in &plan.runs {
            let mut record = simulator.run(&params, spec, spec.duration_s)?;
            distort(truth, severity, &mut record);
            blur(plan, &mut record, &mut noise);
            let target = folder.join(&spec.file);
            predict::write(&target, plan, spec, &record).map_err(|e| Fault::file(&target, &e))?;
        }
        let target = folder.join("campaign.toml");
        std::fs::write(&target, text).map_err(|e| Fault::file(&target, &e))
    };
    let text = titled(text, &id, &plan);
    write(&folders.out.join(&id), &plan, text.clone())?;
    if let Some(further) = folders.further {
        let (plan, text) = further::of(&plan, &text);
        write(&further.join(&id), &plan, text)?;
    }
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
