//! A block that is pressed on the road and dragged over it.

use crate::drive::Pose;

/// Sliding under a constant load: rest for `dwell`, then the road starts with a linear ramp.
///
/// The road speed v > 0 drags the block from its run-in edge (local −x) to its run-out edge. The road
/// of the model is at rest, so the clamped face moves with −v: x = −∫v dt.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// Road speed after the start \[m/s\]; negative: the other way round.
    pub speed: f64,
    /// Road speed at the end, reached linearly over `sweep` \[m/s\]; as `speed` where it is constant.
    pub speed_end: f64,
    /// Duration over which the speed goes from `speed` to `speed_end` \[s\]; 0: constant speed.
    pub sweep: f64,
    /// Duration of the linear start \[s\].
    pub start_ramp: f64,
    /// Rest under load before the road starts \[s\].
    pub dwell: f64,
    /// Normal load \[N\].
    pub load: f64,
}

impl Slide {
    /// Constant speed under `load`, started within 0.5 ms as in the measurements.
    pub fn constant(speed: f64, load: f64) -> Self {
        Self { speed, speed_end: speed, sweep: 0.0, start_ramp: 0.5e-3, dwell: 0.0, load }
    }

    /// Road speed \[m/s\] at time `t` \[s\].
    pub fn road_speed(&self, t: f64) -> f64 {
        let s = t - self.dwell;
        if s <= 0.0 {
            return 0.0;
        }
        let start = if s < self.start_ramp { s / self.start_ramp } else { 1.0 };
        start * (self.speed + self.sweep_rate() * self.swept(s))
    }

    /// Distance \[m\] that the road has moved at time `t` \[s\]: the integral of [`Self::road_speed`].
    pub fn road_distance(&self, t: f64) -> f64 {
        let s = (t - self.dwell).max(0.0);
        let (ramp, rate) = (self.start_ramp, self.sweep_rate());
        let started = s.min(ramp);
        // In the ramp v = (s/r)(v₀ + a s); a sweep shorter than the ramp is refused.
        let in_ramp = if ramp > 0.0 {
            started * started / ramp * (0.5 * self.speed + rate * started / 3.0)
        } else {
            0.0
        };
        let (from, to) = (self.swept(started), self.swept(s));
        let swept = (to - from) * (self.speed + 0.5 * rate * (from + to));
        let rest = (s - started - (to - from)).max(0.0);
        in_ramp + swept + rest * (self.speed + rate * self.sweep)
    }

    pub(super) fn pose(&self, t: f64) -> Pose {
        Pose { x: -self.road_distance(t), load: self.load, ..Pose::default() }
    }

    pub(super) fn rates(&self, t: f64) -> Pose {
        Pose { x: -self.road_speed(t), ..Pose::default() }
    }

    /// Next time after `t` at which the motion goes over into another polynomial.
    pub(super) fn piece_end(&self, t: f64) -> f64 {
        [self.dwell, self.dwell + self.start_ramp, self.dwell + self.sweep]
            .into_iter()
            .filter(|&kink| kink > t)
            .fold(f64::INFINITY, f64::min)
    }

    fn sweep_rate(&self) -> f64 {
        if self.sweep > 0.0 {
            (self.speed_end - self.speed) / self.sweep
        } else {
            0.0
        }
    }

    /// Time spent in the sweep \[s\] when `s` \[s\] have gone since the start.
    fn swept(&self, s: f64) -> f64 {
        s.min(self.sweep)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_is_the_integral_of_speed() {
        let slide = Slide {
            speed: 0.05,
            speed_end: 0.6,
            sweep: 0.02,
            start_ramp: 0.5e-3,
            dwell: 1e-3,
            load: 50.0,
        };
        // Midpoint rule with 1e5 points: error of order 1e-11 of the distance.
        let n = 100_000;
        let h = 0.03 / f64::from(n);
        let sum: f64 = (0..n).map(|i| h * slide.road_speed((f64::from(i) + 0.5) * h)).sum();
        assert!((sum - slide.road_distance(0.03)).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn the_linear_start_covers_half_the_distance_of_a_sudden_one() {
        // Closed form: ∫ v t/r dt from 0 to r is v r / 2.
        let slide = Slide::constant(0.3, 56.25);
        assert!((slide.road_distance(0.5e-3) - 0.3 * 0.5e-3 / 2.0).abs() < 1e-18);
        assert!((slide.road_distance(1.5e-3) - 0.3 * 1.25e-3).abs() < 1e-18);
    }
}
