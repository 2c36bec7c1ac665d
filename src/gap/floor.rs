//! How far a good model may be off: the floor under the noise, per kind of feature.

use super::campaign::CHANNEL_COUNT;
use super::features::{Aspect, Feature};

/// Error of model and mesh relative to the size of the quantity, per aspect and channel (friction
/// force, normal force, velocity, displacement, approach), fitted on the open campaigns without an
/// effect (see `calibration.rs`).
const RELATIVE: [[f64; CHANNEL_COUNT]; 8] = [
    // onset
    [0.03, 0.05, 0.06, 0.03, 0.05],
    // snap-out, logarithms
    [0.02, 0.02, 0.02, 0.02, 0.02],
    // mean
    [0.02, 0.02, 0.03, 0.02, 0.04],
    // ln frequency
    [0.005, 0.005, 0.005, 0.005, 0.005],
    // cycle
    [0.04, 0.06, 0.06, 0.04, 0.08],
    // broadband, logarithms of powers
    [0.40, 0.40, 0.40, 0.40, 0.40],
    // stick and slip; the share is absolute
    [0.04, 0.04, 0.04, 0.04, 0.04],
    // ring-down
    [0.02, 0.02, 0.02, 0.02, 0.02],
];

/// Uncertainty of a feature: noise and floor.
pub fn uncertainty(feature: &Feature) -> f64 {
    let at = Aspect::ALL.iter().position(|a| *a == feature.key.aspect).unwrap_or(0);
    let floor = RELATIVE[at][feature.key.channel] * feature.scale;
    (feature.noise * feature.noise + floor * floor).sqrt().max(1e-15)
}

/// The floor alone, relative.
pub fn relative(aspect: Aspect, channel: usize) -> f64 {
    let at = Aspect::ALL.iter().position(|a| *a == aspect).unwrap_or(0);
    RELATIVE[at][channel]
}
