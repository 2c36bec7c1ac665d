//! How far a good model may be off: noise, what its mesh and steps cost, and a floor under both.

use super::campaign::CHANNEL_COUNT;
use super::features::{Aspect, Feature};
use std::collections::BTreeMap;

/// Error of a good model before anything is measured, relative to the size of the quantity, per
/// aspect and channel (friction force, normal force, velocity, displacement, approach).
const BEFORE: [[f64; CHANNEL_COUNT]; 8] = [
    // onset
    [0.03, 0.05, 0.06, 0.03, 0.05],
    // snap-out, logarithms
    [0.02, 0.02, 0.02, 0.02, 0.02],
    // mean
    [0.02, 0.02, 0.03, 0.02, 0.04],
    // ln frequency
    [0.01, 0.01, 0.01, 0.01, 0.01],
    // cycle
    [0.08, 0.12, 0.12, 0.08, 0.16],
    // broadband, logarithms of powers
    [0.60, 0.60, 0.60, 0.60, 0.60],
    // stick and slip; the share is absolute
    [0.06, 0.06, 0.06, 0.06, 0.06],
    // ring-down
    [0.02, 0.02, 0.02, 0.02, 0.02],
];

/// What the best of models is granted, per aspect: two programs that solve the same equations
/// differ by as much before anything is chaotic (`docs/src/convergence.md`).
const LEAST: [f64; 8] = [0.008, 0.008, 0.006, 0.003, 0.02, 0.2, 0.015, 0.008];
/// Measured errors of mesh and step are taken times this: the measurement's own error is of the
/// same kind.
const SAFETY: f64 = 1.5;

/// Place of an aspect in the tables.
fn place(aspect: Aspect) -> usize {
    Aspect::ALL.iter().position(|a| *a == aspect).unwrap_or(0)
}

/// Uncertainty of a feature before anything is measured.
pub fn uncertainty(feature: &Feature) -> f64 {
    let floor = BEFORE[place(feature.key.aspect)][feature.key.channel] * feature.scale;
    feature.noise.hypot(floor).max(1e-15)
}

/// Uncertainties of the features of a run from the differences that mesh and step make: half of
/// a feature's own, half of its neighbours'.
pub fn measured(features: &[Feature], errors: &[f64]) -> Vec<f64> {
    let mut cells: BTreeMap<_, (f64, f64)> = BTreeMap::new();
    for (feature, error) in features.iter().zip(errors) {
        let sum = cells.entry(feature.key.cell()).or_default();
        sum.0 += error * error;
        sum.1 += 1.0;
    }
    features
        .iter()
        .zip(errors)
        .map(|(feature, error)| {
            let (sum, count) = cells[&feature.key.cell()];
            let mesh = SAFETY * (0.5 * error * error + 0.5 * sum / count).sqrt();
            let least = LEAST[place(feature.key.aspect)] * feature.size;
            feature.noise.hypot(least).hypot(mesh).max(1e-15)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::features::Key;

    #[test]
    fn a_measured_error_of_the_mesh_is_shared_with_the_neighbours() {
        let key = |part| Key { run: 0, channel: 0, aspect: Aspect::Onset, part };
        let feature =
            |part| Feature { key: key(part), value: 0.0, noise: 0.0, scale: 0.0, size: 0.0 };
        let sigma = measured(&[feature(0), feature(0), feature(1)], &[2.0, 0.0, 0.0]);
        // Mean square 2 of the cell: sqrt(0.5·4 + 0.5·2) and sqrt(0.5·2), times 1.5.
        assert!((sigma[0] - 1.5 * 3.0_f64.sqrt()).abs() < 1e-12);
        assert!((sigma[1] - 1.5).abs() < 1e-12 && sigma[2] < 1e-12);
    }
}
