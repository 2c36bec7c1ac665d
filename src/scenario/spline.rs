//! Natural cubic spline through samples.

/// Natural cubic spline (zero curvature at both ends) through samples at rising times.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    times: Vec<f64>,
    values: Vec<f64>,
    /// Second derivative at each sample.
    curvatures: Vec<f64>,
}

impl Spline {
    /// The spline through `values` at `times` (strictly rising, at least two); solved with the
    /// tridiagonal algorithm.
    pub fn natural(times: &[f64], values: &[f64]) -> Self {
        let n = times.len();
        let mut curvatures = vec![0.0; n];
        let mut sweep = vec![0.0; n];
        for i in 1..n.saturating_sub(1) {
            let (left, right) = (times[i] - times[i - 1], times[i + 1] - times[i]);
            let bend = (values[i + 1] - values[i]) / right - (values[i] - values[i - 1]) / left;
            let pivot = 2.0 * (left + right) - left * sweep[i - 1];
            sweep[i] = right / pivot;
            curvatures[i] = (6.0 * bend - left * curvatures[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            curvatures[i] -= sweep[i] * curvatures[i + 1];
        }
        Self { times: times.to_vec(), values: values.to_vec(), curvatures }
    }

    /// Times of the samples.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Value and rate at `t`; beyond the ends the motion goes on in a straight line.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let last = self.times.len() - 1;
        let clamped = t.clamp(self.times[0], self.times[last]);
        let (value, rate) = self.inside(clamped);
        (value + (t - clamped) * rate, rate)
    }

    /// Number of the sample interval in which `t` lies.
    pub fn interval(&self, t: f64) -> usize {
        self.times.partition_point(|&x| x <= t).clamp(1, self.times.len() - 1) - 1
    }

    fn inside(&self, t: f64) -> (f64, f64) {
        let i = self.interval(t);
        let h = self.times[i + 1] - self.times[i];
        let (a, b) = ((self.times[i + 1] - t) / h, (t - self.times[i]) / h);
        let (m0, m1) = (self.curvatures[i], self.curvatures[i + 1]);
        let value = a * self.values[i]
            + b * self.values[i + 1]
            + (a * (a * a - 1.0) * m0 + b * (b * b - 1.0) * m1) * h * h / 6.0;
        let rate = (self.values[i + 1] - self.values[i]) / h
            + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0;
        (value, rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_stays_straight_also_beyond_its_ends() {
        let times = [0.0, 0.1, 0.25, 0.3];
        let values = times.map(|t| 2.0 - 3.0 * t);
        let spline = Spline::natural(&times, &values);
        for t in [-0.1, 0.0, 0.05, 0.2, 0.3, 0.5] {
            let (value, rate) = spline.at(t);
            assert!((value - (2.0 - 3.0 * t)).abs() < 1e-14 && (rate + 3.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_sine_is_met_with_the_fourth_power_of_the_spacing() {
        // Theory: error of a cubic spline falls with h⁴ where the natural end condition holds
        // (sin'' = 0 at 0 and 2π).
        let worst = |n: usize| {
            let times: Vec<f64> =
                (0..=n).map(|i| std::f64::consts::TAU * i as f64 / n as f64).collect();
            let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
            let spline = Spline::natural(&times, &values);
            (0..1000)
                .map(|i| std::f64::consts::TAU * i as f64 / 1000.0)
                .map(|t| (spline.at(t).0 - t.sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (worst(20) / worst(40)).log2();
        assert!((3.7..4.3).contains(&order), "order {order}");
    }
}
