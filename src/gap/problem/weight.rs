//! How much a residual counts: the loss, and the weight of a feature among the others.

use crate::gap::features::{Aspect, Feature};
use std::collections::BTreeMap;

/// Residuals beyond this many standard deviations count ever less: a bifurcation that comes a little
/// early must not rule out a model that is right everywhere else.
const TAIL: f64 = 4.0;
/// The free block is asked once, but without any doubt about friction: it counts more.
const RINGDOWN_WEIGHT: f64 = 3.0;
/// Three numbers that say as much as a waveform.
const SNAP_WEIGHT: f64 = 4.0;

/// Logarithmic loss c² ln(1 + (r/c)²): r² for small residuals.
pub fn loss(r: f64) -> f64 {
    TAIL * TAIL * (r / TAIL).powi(2).ln_1p()
}

/// Derivative of the loss over 2r: the weight of iteratively reweighted least squares.
pub fn robust_weight(r: f64) -> f64 {
    1.0 / (1.0 + (r / TAIL).powi(2))
}

/// n^(−1/2) for each of the n features of a cell: their errors are correlated.
pub(super) fn weights(features: &[Feature]) -> Vec<f64> {
    let mut count = BTreeMap::new();
    for feature in features {
        *count.entry(feature.key.cell()).or_insert(0_usize) += 1;
    }
    let voice = |f: &Feature| match f.key.aspect {
        Aspect::Ringdown => RINGDOWN_WEIGHT,
        Aspect::Snap if f.key.part == 0 => SNAP_WEIGHT,
        _ => 1.0,
    };
    features.iter().map(|f| voice(f) / (count[&f.key.cell()] as f64).sqrt()).collect()
}
