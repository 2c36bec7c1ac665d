//! What a sliding run is watched for: whether its vibration has died or settled, and what it then is.

use crate::metrics;

/// What a run amounts to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observed {
    /// Stick-slip frequency \[Hz\], 0 where the block is silent.
    pub frequency: f64,
    /// Rate \[1/s\] at which a vibration grows, or dies where it is negative, between the swing at which
    /// sticking begins and a tenth of it.
    pub growth: f64,
}

/// Share of the road's speed by which the velocity swings when a block begins to stick.
const STICKS: f64 = 0.8;
/// Silence is certain, and the run over, when the velocity swings by less than this share of the
/// road speed over [`WINDOW`].
const DEAD: f64 = 2e-4;
/// Share of the road's speed below which a vibration that is still there at the end counts as silence.
pub const SILENCE: f64 = 0.05;
/// Time over which amplitudes are taken \[s\]; one period of 500 Hz. Two of them hold one of the paper's slowest.
const WINDOW: f64 = 2e-3;
/// Windows after which a run may be over: a vibration that grows slowly must have the time to.
const PATIENCE: f64 = 4.0;
/// Relative change of the swing between pairs of windows below which a vibration is settled: three pairs alike.
const SETTLED: f64 = 0.02;
/// Time over which amplitudes are taken while a vibration grows or dies \[s\]; one period of 2 kHz, below which blocks
/// of the paper stick.
const SHORT_WINDOW: f64 = 0.5e-3;
/// Relative difference from which on a period counts several snaps.
const SEVERAL: f64 = 0.03;

/// A run as it is watched.
pub struct Watch {
    /// Speed of the road \[m/s\].
    speed: f64,
    /// How long a settled vibration is looked at \[s\].
    seen: f64,
    /// Times of the rows \[s\].
    time: Vec<f64>,
    /// Velocity of the run-in edge \[m/s\].
    velocity: Vec<f64>,
    swings: Swings,
    short: Swings,
    /// When the vibration has settled \[s\].
    settled: Option<f64>,
    died: bool,
}

impl Watch {
    /// Watches rows every `step` \[s\] of a run at `speed` \[m/s\] until a settled vibration was seen for `seen` \[s\].
    pub fn new(speed: f64, step: f64, seen: f64) -> Self {
        Self {
            speed: speed.abs(),
            seen,
            time: Vec::new(),
            velocity: Vec::new(),
            swings: Swings::new(WINDOW, step),
            short: Swings::new(SHORT_WINDOW, step),
            settled: None,
            died: false,
        }
    }

    /// One row; true when the run may end.
    pub fn push(&mut self, time: f64, velocity: f64) -> bool {
        self.time.push(time);
        self.velocity.push(velocity);
        self.short.push(velocity);
        if !self.swings.push(velocity) {
            return false;
        }
        self.died =
            time > PATIENCE * WINDOW && self.swings.last().is_some_and(|s| s < DEAD * self.speed);
        let settled = self.swings.settled(STICKS * self.speed);
        self.settled = settled.then(|| self.settled.unwrap_or(time - 6.0 * WINDOW));
        self.died || self.settled.is_some_and(|from| time - from >= self.seen)
    }

    /// What the run amounts to: of a vibration that never settled, the second half.
    pub fn observed(&self) -> Observed {
        Observed { frequency: self.frequency(), growth: growth(&self.short.swings, self.speed) }
    }

    fn frequency(&self) -> f64 {
        let end = self.time.last().copied().unwrap_or(0.0);
        let from = self.settled.unwrap_or(0.5 * end);
        let first = self.time.partition_point(|t| *t < from);
        let (time, velocity) = (&self.time[first..], &self.velocity[first..]);
        if self.died || metrics::peak_to_peak(velocity) <= SILENCE * self.speed {
            return 0.0;
        }
        stick_slip(time, velocity)
    }
}

/// Stick-slip frequency \[Hz\] of a vibration: that of its period, or, where a period counts several snaps that differ a
/// little or nothing repeats, the rate of snaps.
pub fn stick_slip(time: &[f64], velocity: &[f64]) -> f64 {
    let snaps = snaps(time, velocity);
    match metrics::frequency(time, velocity).map(|p| p.frequency) {
        Some(hz) if (hz / snaps - 1.0).abs() < SEVERAL => hz,
        _ => snaps,
    }
}

/// Snaps per time \[Hz\]: the velocity falls from its upper quarter, where the block sticks, below the middle; 0 for fewer
/// than two.
fn snaps(time: &[f64], velocity: &[f64]) -> f64 {
    let high = velocity.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let swing = metrics::peak_to_peak(velocity);
    let (upper, middle) = (high - 0.25 * swing, high - 0.5 * swing);
    let (mut stuck, mut first, mut last, mut count) = (false, 0.0, 0.0, 0.0);
    for (t, v) in time.windows(2).zip(velocity.windows(2)) {
        if stuck && v[1] < middle {
            stuck = false;
            last = t[0] + (t[1] - t[0]) * (v[0] - middle) / (v[0] - v[1]);
            first = if count == 0.0 { last } else { first };
            count += 1.0;
        } else if v[1] > upper {
            stuck = true;
        }
    }
    if count > 1.0 {
        (count - 1.0) / (last - first)
    } else {
        0.0
    }
}

/// Rate \[1/s\] at which the swings (one per [`SHORT_WINDOW`]) grow from a tenth of the road's speed to
/// [`STICKS`] of it, or, negative, fall from there to a tenth: what is left then is the carriage, which settles in
/// its own time whatever friction does.
fn growth(swings: &[f64], road_speed: f64) -> f64 {
    let large = |s: &f64| *s >= STICKS * road_speed;
    let small = |s: &f64| *s <= 0.1 * road_speed;
    let (from, to) = if swings.last().is_some_and(large) {
        let to = swings.iter().position(large).unwrap_or(0);
        (swings[..to].iter().rposition(small).unwrap_or(0), to)
    } else {
        let from = swings.iter().rposition(large).unwrap_or(0);
        let fallen = swings.iter().skip(from).position(small);
        (from, fallen.map_or(swings.len().saturating_sub(1), |windows| from + windows))
    };
    if from == to {
        return 0.0;
    }
    (swings[to] / swings[from]).ln() / ((to - from) as f64 * SHORT_WINDOW)
}

/// Peak-to-peak velocity window by window.
struct Swings {
    /// Rows of a window.
    length: usize,
    /// Velocities of the window that is not full \[m/s\].
    current: Vec<f64>,
    /// Peak to peak of the full ones \[m/s\].
    swings: Vec<f64>,
}

impl Swings {
    fn new(window: f64, step: f64) -> Self {
        let length = (window / step).round().max(4.0) as usize;
        Self { length, current: Vec::with_capacity(length), swings: Vec::new() }
    }

    /// One row; true when it ends a window.
    fn push(&mut self, velocity: f64) -> bool {
        self.current.push(velocity);
        let full = self.current.len() == self.length;
        if full {
            self.swings.push(metrics::peak_to_peak(&self.current));
            self.current.clear();
        }
        full
    }

    fn last(&self) -> Option<f64> {
        self.swings.last().copied()
    }

    /// Are the last three pairs of windows alike, and larger than `least` \[m/s\]?
    fn settled(&self, least: f64) -> bool {
        let Some(from) = self.swings.len().checked_sub(6) else { return false };
        let pairs: Vec<f64> = self.swings[from..].chunks(2).map(|w| w[0].max(w[1])).collect();
        let last = pairs[2];
        last > least && pairs.iter().all(|p| (p - last).abs() < SETTLED * last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_rate_of_a_vibration_is_found_above_what_the_carriage_leaves() {
        // exp(-4000 t) for 10 ms over a slow rest, and the same backwards up to a limit cycle.
        let swing = |k: usize| (2.0 * (-4000.0 * SHORT_WINDOW * k as f64).exp() + 0.001).min(0.7);
        let dying: Vec<f64> = (0..20).map(swing).collect();
        let growing: Vec<f64> = dying.iter().rev().copied().collect();
        for (swings, rate) in [(dying, -4000.0), (growing, 4000.0)] {
            let found = growth(&swings, 0.3);
            assert!((found / rate - 1.0).abs() < 0.1, "{found}");
        }
        assert_eq!(growth(&[0.7; 9], 0.3), 0.0);
    }

    /// Rows of a velocity \[m/s\] over time \[s\] for 60 ms.
    fn rows(velocity: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..3000).map(|i| 2e-5 * f64::from(i)).map(|t| (t, velocity(t))).collect()
    }

    #[test]
    fn snaps_that_alternate_a_little_count_singly() {
        // 1000 Hz whose every second swing is a tenth stronger: the period is 2 ms, the snaps come every 1 ms.
        let wave = rows(|t| (1.0 + 0.1 * (TAU * 500.0 * t).sin()) * (TAU * 1000.0 * t).sin());
        let (time, velocity): (Vec<f64>, Vec<f64>) = wave.into_iter().unzip();
        assert!((stick_slip(&time, &velocity) / 1000.0 - 1.0).abs() < 5e-3);
    }

    #[test]
    fn a_vibration_that_grows_slowly_is_watched_until_it_has_settled() {
        // It grows until 30 ms at 2000 Hz and stays there at 2200 Hz: settled from the pair of windows on in which it
        // got there, from 28 ms, and seen for 12 ms more, to the end of a window.
        let swing = |t: f64| (0.01 * (t / 6e-3).exp()).min(0.01 * 5.0_f64.exp());
        let hz = |t: f64| if t < 30e-3 { 2000.0 } else { 2200.0 };
        let mut watch = Watch::new(0.5, 2e-5, 12e-3);
        let end = rows(|t| swing(t) * (TAU * hz(t) * t).sin())
            .into_iter()
            .find(|(t, v)| watch.push(*t, *v));
        assert!(end.is_some_and(|(t, _)| (39.9e-3..42.1e-3).contains(&t)), "{end:?}");
        assert!((watch.observed().frequency / 2200.0 - 1.0).abs() < 1e-2);
    }

    #[test]
    fn a_vibration_that_dies_is_silence() {
        let mut watch = Watch::new(0.3, 2e-5, 12e-3);
        let over = rows(|t| (-t / 1e-3).exp() * (TAU * 2000.0 * t).sin())
            .into_iter()
            .any(|(t, v)| watch.push(t, v));
        assert!(over);
        assert_eq!(watch.observed().frequency, 0.0);
    }
}
