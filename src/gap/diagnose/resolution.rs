//! What the data could show: severities that would have been seen, and effects that they do not tell apart.

use crate::gap::calibration::{BLUR, SHARPNESS};
use crate::gap::decide;
use crate::gap::hypotheses::Fits;
use crate::gap::problem::Bench;

/// The severity at which an effect would move ln(G²) by three nats' worth: its loss grows with the
/// square of a small severity.
pub(super) fn detectable(bench: &Bench, fits: &Fits) -> Vec<(String, f64)> {
    let needed = (3.0 / SHARPNESS).exp_m1() * (1.0 + BLUR);
    let specs = bench.specs.iter().zip(&fits.response);
    specs
        .map(|(spec, (severity, caused))| {
            (spec.effect.to_string(), severity * (needed / caused.max(1e-9)).sqrt())
        })
        .collect()
}

/// Pairs of single effects whose evidence is within three nats and that both explain something.
pub(super) fn indistinguishable(bench: &Bench, fits: &Fits) -> Vec<[String; 2]> {
    let base = decide::evidence(fits.base.level);
    let nats: Vec<f64> = fits.singles.iter().map(|s| decide::evidence(s.level)).collect();
    let top = nats.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let good: Vec<usize> =
        (0..nats.len()).filter(|k| nats[*k] > base + 3.0 && nats[*k] > top - 3.0).collect();
    let name = |k: usize| bench.specs[fits.singles[k].fit.added[0].effect].effect.to_string();
    good.iter()
        .enumerate()
        .flat_map(|(i, a)| good[i + 1..].iter().map(move |b| (*a, *b)))
        .map(|(a, b)| [name(a), name(b)])
        .collect()
}
