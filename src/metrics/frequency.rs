//! Fundamental frequency of a periodic record of any shape.

use crate::scenario::Spline;

/// What repeats, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodicity {
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Correlation at a lag of one period \[-\].
    pub regularity: f64,
}

/// Points of the uniform grid on which correlations are taken.
const GRID: usize = 4096;
/// A first peak this high, relative to the highest, is the period; less is a subdivision of it. Cycles
/// that alternate between a strong and a weaker snap (0.77 in the reference case slide-3) count singly.
const FIRST: f64 = 0.6;
/// Correlation over many periods below which they no longer count.
const FAR: f64 = 0.4;

/// Fundamental frequency of `signal` at `time` (rising, not necessarily equidistant) by its
/// autocorrelation: the first high peak gives the period, all later ones refine it, each with a
/// parabola through its top. `None` where nothing repeats within half the record.
pub fn frequency(time: &[f64], signal: &[f64]) -> Option<Periodicity> {
    let span = time.last()? - time.first()?;
    if time.len() < 8 || span <= 0.0 {
        return None;
    }
    let step = span / (GRID - 1) as f64;
    let grid = uniform(time, signal, step);
    let correlation: Vec<f64> = (0..=GRID / 2).map(|lag| correlate(&grid, lag)).collect();
    let falls = correlation.iter().position(|r| *r < 0.0)?;
    let highest = correlation[falls..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if highest < FAR {
        return None;
    }
    let first = (falls + 1..GRID / 2).find(|&lag| {
        correlation[lag] >= FIRST * highest
            && correlation[lag] >= correlation[lag - 1]
            && correlation[lag] >= correlation[lag + 1]
    })?;
    let period = refined(&correlation, top(&correlation, first));
    Some(Periodicity { frequency: 1.0 / (period * step), regularity: correlation[first] })
}

/// The period that fits the lags of all peaks best: T = Σ k lag_k / Σ k², over k = 1, 2, 3 … as long as
/// periods are alike.
fn refined(correlation: &[f64], first: f64) -> f64 {
    let (mut lags, mut squares) = (first, 1.0);
    let mut count = 2.0;
    while let Some(lag) = peak_near(correlation, count * lags / squares, 0.25 * first) {
        lags += count * top(correlation, lag);
        squares += count * count;
        count += 1.0;
    }
    lags / squares
}

/// The signal less its mean on a grid of [`GRID`] points.
fn uniform(time: &[f64], signal: &[f64], step: f64) -> Vec<f64> {
    let spline = Spline::natural(time, signal);
    let mut grid: Vec<f64> = (0..GRID).map(|i| spline.at(time[0] + i as f64 * step).0).collect();
    let mean = grid.iter().sum::<f64>() / GRID as f64;
    grid.iter_mut().for_each(|x| *x -= mean);
    grid
}

/// Correlation of the signal with itself `lag` points later, over what overlaps, within ±1.
fn correlate(grid: &[f64], lag: usize) -> f64 {
    let (early, late) = (&grid[..grid.len() - lag], &grid[lag..]);
    let (mut both, mut first, mut second) = (0.0, 0.0, 0.0);
    for (a, b) in early.iter().zip(late) {
        both += a * b;
        first += a * a;
        second += b * b;
    }
    let norm = (first * second).sqrt();
    if norm > 0.0 {
        both / norm
    } else {
        0.0
    }
}

/// Lag of the highest correlation around `lag`, if it is inside the record and still alike.
fn peak_near(correlation: &[f64], lag: f64, around: f64) -> Option<usize> {
    let to = (lag + around).ceil() as usize;
    if to + 1 >= correlation.len() {
        return None;
    }
    let from = ((lag - around).floor() as usize).max(1);
    (from..=to)
        .max_by(|a, b| correlation[*a].total_cmp(&correlation[*b]))
        .filter(|&best| correlation[best] > FAR && best > from && best < to)
}

/// Abscissa of the parabola through the correlation at `lag` and its neighbours.
fn top(correlation: &[f64], lag: usize) -> f64 {
    let (left, middle, right) = (correlation[lag - 1], correlation[lag], correlation[lag + 1]);
    let bend = left - 2.0 * middle + right;
    if bend < 0.0 {
        lag as f64 + 0.5 * (left - right) / bend
    } else {
        lag as f64
    }
}
