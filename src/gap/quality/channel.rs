//! What can be wrong with a channel of a record: cells that are no numbers, a sensor that is held or clipped.

use crate::gap::campaign::{RunKind, RunSpec, VELOCITY};

/// A channel with no more distinct values is held.
const FEWEST_LEVELS: usize = 3;
/// Share of samples at the very same extreme value beyond which a channel is clipped.
const CLIPPED_SHARE: f64 = 0.03;
/// Share of unusable cells that may be bridged.
const BRIDGED_SHARE: f64 = 0.02;

/// What is wrong with channel number `c`, whose noise has the standard deviation `noise` in the channel's unit: the value
/// found and what would be accepted.
pub(super) fn channel_fault(
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

/// Smallest and largest value.
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
