//! Fourier coefficients of a short piece of a signal, Hann-weighted.

use std::f64::consts::TAU;

/// A complex number: real and imaginary part.
pub type Complex = [f64; 2];

/// Lowest and highest fundamental frequency that is looked for \[Hz\].
const SEARCH: [f64; 2] = [120.0, 6000.0];
/// Frequencies per bin of the Fourier transform in the search.
const OVERSAMPLING: f64 = 3.0;

/// Hann weights of `n` samples, sum 1.
pub fn hann(n: usize) -> Vec<f64> {
    let weight = |i: usize| 1.0 - (TAU * (i as f64 + 0.5) / n as f64).cos();
    let total: f64 = (0..n).map(weight).sum();
    (0..n).map(|i| weight(i) / total).collect()
}

/// Weighted mean.
pub fn mean(signal: &[f64], weights: &[f64]) -> f64 {
    signal.iter().zip(weights).map(|(s, w)| s * w).sum()
}

/// Amplitude of the oscillation a·cos(ωt + φ) as a·exp(iφ), at `frequency` \[Hz\] for samples every
/// `step` \[s\]; `offset` is taken off before.
pub fn amplitude(
    signal: &[f64],
    weights: &[f64],
    offset: f64,
    step: f64,
    frequency: f64,
) -> Complex {
    let (turn_cos, turn_sin) = ((TAU * frequency * step).cos(), (TAU * frequency * step).sin());
    let (mut c, mut s) = (1.0, 0.0);
    let mut sum = [0.0; 2];
    for (value, w) in signal.iter().zip(weights) {
        let x = 2.0 * w * (value - offset);
        sum[0] += x * c;
        sum[1] -= x * s;
        (c, s) = (c * turn_cos - s * turn_sin, s * turn_cos + c * turn_sin);
    }
    sum
}

/// |z|².
pub fn power([re, im]: Complex) -> f64 {
    re * re + im * im
}

/// The strongest frequency \[Hz\] of a signal, refined between the bins by a parabola.
pub fn fundamental(signal: &[f64], weights: &[f64], step: f64) -> f64 {
    let offset = mean(signal, weights);
    let bin = 1.0 / (signal.len() as f64 * step * OVERSAMPLING);
    let (first, last) = ((SEARCH[0] / bin) as usize + 1, (SEARCH[1] / bin) as usize);
    let level = |k: f64| power(amplitude(signal, weights, offset, step, k * bin)).max(1e-300).ln();
    let mut best = (first, f64::NEG_INFINITY);
    for k in first..=last {
        let here = level(k as f64);
        if here > best.1 {
            best = (k, here);
        }
    }
    let k = best.0 as f64;
    let (a, b, c) = (level(k - 0.5), level(k), level(k + 0.5));
    let curvature = a - 2.0 * b + c;
    let shift = if curvature < 0.0 { 0.25 * (a - c) / curvature } else { 0.0 };
    (k + shift.clamp(-0.5, 0.5)) * bin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cosine_gives_back_frequency_amplitude_and_phase() {
        let (f, a, phase, step) = (1234.5, 2.5, 0.7, 4e-5);
        let signal: Vec<f64> =
            (0..250).map(|i| 3.0 + a * (TAU * f * i as f64 * step + phase).cos()).collect();
        let weights = hann(signal.len());
        let found = fundamental(&signal, &weights, step);
        assert!((found / f - 1.0).abs() < 2e-4, "{found} Hz of {f}");
        let z = amplitude(&signal, &weights, mean(&signal, &weights), step, f);
        // Leakage of a Hann window twelve bins away is below 1e-4.
        assert!((power(z).sqrt() / a - 1.0).abs() < 1e-3);
        assert!((z[1].atan2(z[0]) - phase).abs() < 1e-3);
    }
}
