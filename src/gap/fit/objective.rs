//! What a fit makes small: weighted loss and prior, looked at as coarsely as the way to the optimum asks.

use crate::gap::features::{Aspect, Key};
use crate::gap::problem::{loss, robust_weight, Bench, Residuals};
use nalgebra::DVector;

/// How the residuals are looked at: coarsely far from the optimum, as they are close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Residuals are divided by this.
    pub heat: f64,
    /// Only ring-down and the onset up to this part, which follow the parameters without jumps.
    pub onset_parts: Option<usize>,
}

impl View {
    /// Everything at its own uncertainty.
    pub const PLAIN: Self = Self { heat: 1.0, onset_parts: None };

    fn counts(&self, key: &Key) -> bool {
        match self.onset_parts {
            None => true,
            Some(parts) => {
                key.aspect == Aspect::Ringdown
                    || key.aspect == Aspect::Snap && key.part == 0
                    || key.aspect == Aspect::Onset && key.part < parts
            }
        }
    }

    /// Weight of the prior: it cools with the data.
    fn prior(&self) -> f64 {
        1.0 / (self.heat * self.heat)
    }
}

/// Weighted loss + |x|², the latter as much cooler as the view.
pub(super) fn objective(bench: &Bench, x: &[f64], residuals: &Residuals, view: View) -> f64 {
    let weights = of_weights(bench, residuals, view);
    let data: f64 =
        residuals.iter().flatten().zip(weights).map(|(r, w)| w * loss(*r / view.heat)).sum();
    data + view.prior() * x.iter().map(|v| v * v).sum::<f64>()
}

/// Residuals as one vector.
pub(super) fn flat(residuals: &Residuals) -> DVector<f64> {
    DVector::from_iterator(
        residuals.iter().map(Vec::len).sum(),
        residuals.iter().flatten().copied(),
    )
}

/// Weights in the order of [`flat`].
fn of_weights<'a>(
    bench: &'a Bench,
    residuals: &'a Residuals,
    view: View,
) -> impl Iterator<Item = f64> + 'a {
    let present = residuals.iter().zip(bench.weight.iter().zip(&bench.measured));
    present.filter(|(r, _)| !r.is_empty()).flat_map(move |(_, (weights, features))| {
        weights.iter().zip(features).map(
            move |(w, feature)| {
                if view.counts(&feature.key) {
                    *w
                } else {
                    0.0
                }
            },
        )
    })
}

/// Residuals with their weights, robust ones included.
pub(super) fn weighted(
    bench: &Bench,
    residuals: &Residuals,
    view: View,
) -> (DVector<f64>, DVector<f64>) {
    let r = flat(residuals);
    let weights = of_weights(bench, residuals, view);
    let w = DVector::from_iterator(
        r.len(),
        r.iter().zip(weights).map(|(r, w)| w * robust_weight(*r / view.heat)),
    );
    (r, w)
}
