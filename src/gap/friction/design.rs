//! The laws of a friction record as sums: what each coefficient is multiplied with, sample by sample.

use super::law::Law;
use super::record::FrictionRecord;

/// Names of the coefficients, and their factors sample by sample; `memory` \[m or s\] as the law has it, `stretch` \[m\]
/// of the rig.
pub(super) fn design(
    record: &FrictionRecord,
    law: Law,
    memory: Option<f64>,
    stretch: f64,
) -> (Vec<&'static str>, Vec<Vec<f64>>) {
    let samples = &record.samples;
    let pressures: Vec<f64> = samples.iter().filter_map(|s| s.pressure).collect();
    let load = if pressures.is_empty() { 1.0 } else { mean(pressures.into_iter()) };
    let middle = mean(samples.iter().map(|s| s.place));
    let rows = samples
        .iter()
        .zip(arrived(record, stretch))
        .map(|(s, fast)| {
            let sign = s.direction;
            let mut row = vec![sign];
            if record.piston {
                row.push(s.pressure.unwrap_or(0.0));
            }
            if law != Law::Constant {
                row.push(sign * fast);
            }
            // Contacts are as old as the change left them; before a step nothing has changed.
            let old = |kept: f64| {
                if record.piston {
                    kept
                } else if s.stroke == 0 {
                    0.0
                } else {
                    kept * arrival(s.since, stretch)
                }
            };
            let kept = |x: f64| (-x / memory.unwrap_or(1.0)).exp();
            match law {
                Law::Constant | Law::Speed => {}
                Law::RigCompliance => row.push(sign * kept(s.since)),
                Law::FrictionAgeing => row.push(sign * old(kept(s.since))),
                Law::ThermalFriction if !record.piston && s.stroke == 0 => row.push(0.0),
                Law::ThermalFriction => row.push(sign * (1.0 - kept(s.since_time))),
                Law::Adhesion => row.push(sign * (s.pressure.unwrap_or(load) / load - 1.0)),
                Law::Misalignment => row.push(sign * (s.place - middle)),
                Law::Drift => row.push(sign * s.slip),
            }
            row
        })
        .collect();
    (names(record, law), rows)
}

/// Mean of values; 0 of none.
fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// Names of the coefficients, in the order of the factors.
fn names(record: &FrictionRecord, law: Law) -> Vec<&'static str> {
    let mut names = vec!["friction"];
    if record.piston {
        names.push("area [m²]");
    }
    if law != Law::Constant {
        names.push("change per e-fold of speed");
    }
    match law {
        Law::Constant | Law::Speed => {}
        Law::RigCompliance => names.push("change at a reversal"),
        Law::FrictionAgeing => names.push("change where contacts are old"),
        Law::ThermalFriction => names.push("change when warm"),
        Law::Adhesion => names.push("change with the load, relative"),
        Law::Misalignment => names.push("change per metre of the way"),
        Law::Drift => names.push("change per metre of slip"),
    }
    names
}

/// Share of a change that has arrived after the slip `x` \[m\].
fn arrival(x: f64, stretch: f64) -> f64 {
    if stretch > 0.0 {
        1.0 - (-x / stretch).exp()
    } else {
        1.0
    }
}

/// Logarithm of the sliding speed over its mean; where it is stepped, the two speeds' with the rig
/// stretching in between.
fn arrived(record: &FrictionRecord, stretch: f64) -> Vec<f64> {
    let samples = &record.samples;
    let mean = mean(samples.iter().map(|s| s.speed.ln()));
    if record.piston {
        return samples.iter().map(|s| s.speed.ln() - mean).collect();
    }
    let of = |stroke: usize| {
        let mut speeds: Vec<f64> =
            samples.iter().filter(|s| s.stroke == stroke).map(|s| s.speed).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.get(speeds.len() / 2).map_or(mean, |v| v.ln())
    };
    let speeds: Vec<f64> = (0..=record.last_stroke()).map(of).collect();
    samples
        .iter()
        .map(|s| {
            let before = speeds[s.stroke.saturating_sub(1)];
            before + (speeds[s.stroke] - before) * arrival(s.since, stretch) - speeds[0]
        })
        .collect()
}
