//! Inputs known only at communication points, made into a smooth motion.
//!
//! A master sets inputs at the start of a step and says nothing about its end. Rule per signal:
//!
//! 1. The rate at the start of the step is the derivative that the master set, or else the slope of
//!    the parabola through the last three values (two: of the line).
//! 2. The value expected at the end follows by Taylor's formula from the value just set.
//! 3. Within the step the motion is the cubic that starts where the last step's motion ended, with
//!    the rate that it had, and ends at the expected value with the expected rate: no jump of
//!    position or velocity, and velocity is always the derivative of position.
//! 4. Nothing is known of the past at the first communication point. When the second brings the
//!    first increment, the motion is taken to have had that rate all along: position and rate are
//!    set without inertia, so that a belt that runs at 15 m/s from the start kicks nothing.

use super::{Cubic, Pose, Segment};

/// A value that the master set at a communication point, with what derivatives it gave.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Known {
    /// Value.
    pub value: f64,
    /// First derivative, if set for this step.
    pub rate: Option<f64>,
    /// Second derivative, if set for this step.
    pub curvature: Option<f64>,
}

impl Known {
    /// A value without derivatives.
    pub fn value(value: f64) -> Self {
        Self { value, rate: None, curvature: None }
    }
}

/// One signal's history and where its motion stands.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Signal {
    /// Last values at communication points, newest first, with their times \[s\].
    past: [(f64, f64); 2],
    /// How many of them are known.
    known: usize,
    /// Value and rate where the last step's motion ended.
    end: (f64, f64),
}

impl Signal {
    fn cubic(&mut self, time: f64, h: f64, now: Known) -> Cubic {
        let (rate, curvature) = self.rates(time, now);
        let first_rate = self.known == 0 || (self.known == 1 && now.rate.is_none());
        let start = if first_rate { (now.value, rate) } else { self.end };
        let end = (now.value + h * (rate + 0.5 * h * curvature), rate + h * curvature);
        self.past = [(time, now.value), self.past[0]];
        self.known = (self.known + 1).min(2);
        self.end = end;
        Cubic::hermite(h, start, end)
    }

    /// Rate and curvature at the start of the step, rule 1.
    fn rates(&self, time: f64, now: Known) -> (f64, f64) {
        if let Some(rate) = now.rate {
            return (rate, now.curvature.unwrap_or(0.0));
        }
        let [(t1, x1), (t2, x2)] = self.past;
        match self.known {
            0 => (0.0, 0.0),
            1 => ((now.value - x1) / (time - t1), 0.0),
            _ => {
                let (d1, d2) = (time - t1, t1 - t2);
                let (s1, s2) = ((now.value - x1) / d1, (x1 - x2) / d2);
                let curvature = 2.0 * (s1 - s2) / (d1 + d2);
                (s1 + 0.5 * d1 * curvature, curvature)
            }
        }
    }
}

/// Makes segments from values at communication points.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Predictor {
    signals: [Signal; 4],
}

impl Predictor {
    /// The motion over the step of `h` \[s\] that starts at `time` \[s\], from what the master set for
    /// its start, in the order x, z, angle, load.
    pub fn segment(&mut self, time: f64, h: f64, now: [Known; 4]) -> Segment {
        let mut cubics = [Cubic::default(); 4];
        for ((cubic, signal), known) in cubics.iter_mut().zip(&mut self.signals).zip(now) {
            *cubic = signal.cubic(time, h, known);
        }
        let [x, z, angle, load] = cubics;
        Segment { x, z, angle, load }
    }

    /// The histories of all signals as plain numbers, [`Self::SAVED`] of them.
    pub fn save(&self, state: &mut Vec<f64>) {
        for Signal { past: [(t1, x1), (t2, x2)], known, end: (x, v) } in self.signals {
            state.extend([t1, x1, t2, x2, known as f64, x, v]);
        }
    }

    /// How many numbers [`Self::save`] appends.
    pub const SAVED: usize = 28;

    /// Restores what [`Self::save`] wrote; `None` if the count does not fit.
    pub fn restore(state: &[f64]) -> Option<Self> {
        let mut restored = Self::default();
        let (chunks, []) = state.as_chunks::<7>() else { return None };
        if chunks.len() != restored.signals.len() {
            return None;
        }
        for (signal, [t1, x1, t2, x2, known, x, v]) in restored.signals.iter_mut().zip(chunks) {
            let known = (known.clamp(0.0, 2.0)) as usize;
            *signal = Signal { past: [(*t1, *x1), (*t2, *x2)], known, end: (*x, *v) };
        }
        Some(restored)
    }

    /// Values as the master sets them without derivatives.
    pub fn known(pose: Pose) -> [Known; 4] {
        [pose.x, pose.z, pose.angle, pose.load].map(Known::value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_predicted_exactly_from_the_third_point_on() {
        // Closed form: x = 2 + 3 t - 4 t²; a quadratic rule must reproduce it to rounding.
        let x = |t: f64| 2.0 + 3.0 * t - 4.0 * t * t;
        let mut predictor = Predictor::default();
        let h = 0.01;
        for k in 0..10 {
            let t = k as f64 * h;
            let pose = Pose { x: x(t), ..Pose::default() };
            let segment = predictor.segment(t, h, Predictor::known(pose));
            if k >= 4 {
                let middle = segment.x.at(0.5 * h) - x(t + 0.5 * h);
                assert!(middle.abs() < 1e-12, "step {k}: {middle}");
            }
        }
    }

    #[test]
    fn position_and_velocity_never_jump_after_the_second_point() {
        let mut predictor = Predictor::default();
        let mut last: Option<Segment> = None;
        let mut t = 0.0_f64;
        for k in 0..50 {
            let h = 1e-5 * (1.0 + (k % 3) as f64);
            let pose = Pose { x: (300.0 * t).sin(), ..Pose::default() };
            let segment = predictor.segment(t, h, Predictor::known(pose));
            if let (Some((last, last_h)), true) = (last.map(|l| (l, t)), k > 1) {
                let _ = last_h;
                let previous_h = 1e-5 * (1.0 + ((k - 1) % 3) as f64);
                assert!((segment.x.at(0.0) - last.x.at(previous_h)).abs() < 1e-12);
                assert!((segment.x.rate(0.0) - last.x.rate(previous_h)).abs() < 1e-7);
            }
            last = Some(segment);
            t += h;
        }
    }
}
