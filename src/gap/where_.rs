//! Where the gap lies: run × channel × contact phase × band.

use super::campaign::CHANNELS;
use super::features::Aspect;
use super::problem::{Bench, Residuals};
use std::collections::BTreeMap;

/// Rate of false discoveries among the cells shown as significant.
const FALSE_DISCOVERIES: f64 = 0.05;

/// One cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// File of the run.
    pub run: String,
    /// Channel.
    pub channel: &'static str,
    /// Contact phase.
    pub phase: &'static str,
    /// Band \[Hz\].
    pub band: [f64; 2],
    /// G: root mean square in units of noise and floor.
    pub gap: f64,
    /// Beyond chance (Benjamini and Hochberg at 5 %)?
    pub significant: bool,
}

/// The map of the residuals of a model.
pub fn map(bench: &Bench, residuals: &Residuals) -> Vec<Cell> {
    let nyquist = 0.5 * bench.plan.sampling_rate;
    let mut cells: BTreeMap<(usize, usize, Aspect), Vec<f64>> = BTreeMap::new();
    let mut pitch: BTreeMap<usize, f64> = BTreeMap::new();
    for (features, run) in bench.measured.iter().zip(residuals) {
        for (feature, r) in features.iter().zip(run) {
            let key = feature.key;
            cells.entry((key.run, key.channel, key.aspect)).or_default().push(*r);
            if key.aspect == Aspect::Frequency {
                pitch.insert(key.run, feature.value.exp());
            }
        }
    }
    let mut out = Vec::new();
    let mut chances = Vec::new();
    for ((run, channel, aspect), values) in cells {
        let square = values.iter().map(|r| r * r).sum::<f64>() / values.len() as f64;
        let f0 = pitch.get(&run).copied().unwrap_or(0.1 * nyquist);
        let band = match aspect {
            Aspect::Mean => [0.0, 0.5 * f0],
            Aspect::Frequency => [0.8 * f0, 1.2 * f0],
            Aspect::Cycle => [0.8 * f0, (4.5 * f0).min(nyquist)],
            Aspect::Onset | Aspect::Snap => [0.0, 3000.0],
            Aspect::Broadband | Aspect::Stick | Aspect::Ringdown => [0.0, nyquist],
        };
        chances.push(chance(square, (values.len() as f64).sqrt()));
        out.push(Cell {
            run: bench.runs[run].file.clone(),
            channel: CHANNELS[channel],
            phase: aspect.phase(),
            band: band.map(f64::round),
            gap: square.sqrt(),
            significant: false,
        });
    }
    let limit = discovery_limit(&chances);
    for (cell, p) in out.iter_mut().zip(&chances) {
        cell.significant = *p <= limit && cell.gap > 1.5;
    }
    out
}

/// Chance of a mean square that large with `n` independent values: χ² by Wilson and Hilferty.
fn chance(square: f64, n: f64) -> f64 {
    let spread = 2.0 / (9.0 * n);
    let z = (square.cbrt() - (1.0 - spread)) / spread.sqrt();
    0.5 * erfc(z / std::f64::consts::SQRT_2)
}

/// Complementary error function, 1e-7 (Abramowitz and Stegun 7.1.26).
fn erfc(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let poly = t
        * (0.254_829_592
            + t * (-0.284_496_736
                + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    let tail = poly * (-x * x).exp();
    if x >= 0.0 {
        tail
    } else {
        2.0 - tail
    }
}

/// Probability up to which cells are discoveries of which at most [`FALSE_DISCOVERIES`] are false (Benjamini and
/// Hochberg, J. R. Stat. Soc. B 57, 1995, 289); below 0 where there are none.
fn discovery_limit(chances: &[f64]) -> f64 {
    let mut sorted = chances.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    sorted
        .iter()
        .enumerate()
        .filter(|(k, p)| **p <= FALSE_DISCOVERIES * (*k as f64 + 1.0) / n)
        .map(|(_, p)| *p)
        .fold(-1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_square_of_one_is_no_surprise() {
        assert!(chance(1.0, 10.0) > 0.3);
        // χ² of 10 degrees of freedom exceeds 18.31 with 5 % (tables).
        assert!((chance(1.831, 10.0) - 0.05).abs() < 0.002);
    }

    #[test]
    fn no_discovery_among_even_chances() {
        let even: Vec<f64> = (1..100).map(|k| f64::from(k) / 100.0).collect();
        assert!(discovery_limit(&even) < 0.0);
    }
}
