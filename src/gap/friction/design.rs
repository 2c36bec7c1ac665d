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
    let mean = |c: &[f64]| c.iter().sum::<f64>() / c.len().max(1) as f64;
    let arrived = arrived(record, stretch);
    let place = mean(&record.place);
    let load = record.pressure.as_ref().map_or(1.0, |p| mean(p));
    let rows = (0..record.value.len())
        .map(|i| {
            let sign = record.direction[i];
            let mut row = vec![sign];
            let pressure = record.pressure.as_ref().map(|p| p[i]);
            if record.piston {
                row.push(pressure.unwrap_or(0.0));
            }
            let fast = arrived[i];
            if law != Law::Constant {
                row.push(sign * fast);
            }
            // Contacts are as old as the change left them; before a step nothing has changed.
            let old = |i: usize, kept: f64| {
                if record.piston {
                    kept
                } else if record.stroke[i] == 0 {
                    0.0
                } else {
                    kept * arrival(record.since[i], stretch)
                }
            };
            let kept = |x: f64| (-x / memory.unwrap_or(1.0)).exp();
            match law {
                Law::Constant | Law::Speed => {}
                Law::RigCompliance => row.push(sign * kept(record.since[i])),
                Law::FrictionAgeing => row.push(sign * old(i, kept(record.since[i]))),
                Law::ThermalFriction if !record.piston && record.stroke[i] == 0 => row.push(0.0),
                Law::ThermalFriction => row.push(sign * (1.0 - kept(record.since_time[i]))),
                Law::Adhesion => row.push(sign * (pressure.unwrap_or(load) / load - 1.0)),
                Law::Misalignment => row.push(sign * (record.place[i] - place)),
                Law::Drift => row.push(sign * record.slip[i]),
            }
            row
        })
        .collect();
    (names(record, law), rows)
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
    let count = record.speed.len();
    let mean = record.speed.iter().map(|v| v.ln()).sum::<f64>() / count.max(1) as f64;
    if record.piston {
        return record.speed.iter().map(|v| v.ln() - mean).collect();
    }
    let of = |stroke: usize| {
        let mut speeds: Vec<f64> =
            (0..count).filter(|i| record.stroke[*i] == stroke).map(|i| record.speed[i]).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.get(speeds.len() / 2).map_or(mean, |v| v.ln())
    };
    let last = record.stroke.last().copied().unwrap_or(0);
    let speeds: Vec<f64> = (0..=last).map(of).collect();
    (0..count)
        .map(|i| {
            let k = record.stroke[i];
            let before = speeds[k.saturating_sub(1)];
            before + (speeds[k] - before) * arrival(record.since[i], stretch) - speeds[0]
        })
        .collect()
}
