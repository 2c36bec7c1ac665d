//! A friction characteristic measured over pressure and speed, interpolated.

use super::friction::{FrictionLaw, Mu, Smoothing};
use crate::error::{Fault, Problem};
use crate::pack::{Pack, LANES};

/// μ over a grid of pressure and sliding speed, bilinear in pressure and the logarithm of speed;
/// constant beyond the grid. The smoothed sign makes it odd and continuous at v = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Pressures of the grid \[Pa\], rising.
    pub pressures: Vec<f64>,
    /// Natural logarithms of the grid's speeds \[ln(m/s)\], rising.
    pub log_speeds: Vec<f64>,
    /// μ \[-\], row per pressure.
    pub mu: Vec<f64>,
    /// Width of the smoothing at v = 0 \[m/s\].
    pub smoothing_speed: f64,
}

impl Table {
    /// A table from points (p \[Pa\], v \[m/s\], μ) that fill a grid, in any order.
    ///
    /// # Errors
    /// [`Fault::Invalid`] with every value out of range, and if the points do not fill a grid.
    pub fn from_points(points: &[(f64, f64, f64)]) -> Result<Self, Fault> {
        let mut problems = Vec::new();
        for (row, (p, v, mu)) in points.iter().enumerate() {
            for (name, value) in [("pressure_pa", p), ("speed_m_s", v), ("mu", mu)] {
                if !(value.is_finite() && *value > 0.0) {
                    problems.push(Problem::new(
                        format!("{name} in row {}", row + 1),
                        value.to_string(),
                        "a positive number",
                        "mend or delete the row",
                    ));
                }
            }
        }
        let axis = |pick: fn(&(f64, f64, f64)) -> f64| {
            let mut values: Vec<f64> = points.iter().map(pick).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        let (pressures, speeds) = (axis(|p| p.0), axis(|p| p.1));
        let mut mu = vec![f64::NAN; pressures.len() * speeds.len()];
        for (p, v, value) in points {
            let at = |axis: &[f64], x: f64| axis.iter().position(|a| *a == x).unwrap_or(0);
            mu[at(&pressures, *p) * speeds.len() + at(&speeds, *v)] = *value;
        }
        let missing = mu.iter().filter(|m| m.is_nan()).count();
        if points.len() < 2 || (missing > 0 && problems.is_empty()) {
            problems.push(Problem::new(
                "friction.table_file",
                format!("{} points, {missing} missing", points.len()),
                "every pressure with every speed, two points or more",
                "measure or interpolate the missing points of the grid",
            ));
        }
        if !problems.is_empty() {
            return Err(Fault::Invalid(problems));
        }
        let log_speeds = speeds.iter().map(|v| v.ln()).collect();
        Ok(Self { pressures, log_speeds, mu, smoothing_speed: 0.01 })
    }

    /// A small table for tests and examples: μ = 1.2 − 0.25 ln(1 + v/0.1), −5 % per doubled pressure.
    pub fn example() -> Self {
        let mut points = Vec::new();
        for p in [50e3, 100e3, 200e3, 400e3, 800e3] {
            for v in [1e-3, 1e-2, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6] {
                let mu =
                    (1.2 - 0.25 * (1.0_f64 + v / 0.1).ln()) * (1.1 - 0.05 * f64::log2(p / 50e3));
                points.push((p, v, mu));
            }
        }
        Self::from_points(&points).unwrap_or(Self {
            pressures: vec![1.0],
            log_speeds: vec![0.0],
            mu: vec![1.0],
            smoothing_speed: 0.01,
        })
    }

    /// Level and its derivatives by pressure and by ln v.
    fn level(&self, p: f64, log_v: f64) -> (f64, f64, f64) {
        let (i, s, ds) = locate(&self.pressures, p);
        let (j, t, dt) = locate(&self.log_speeds, log_v);
        let columns = self.log_speeds.len();
        let next = |at: usize, count: usize| (at + 1).min(count - 1);
        let (i1, j1) = (next(i, self.pressures.len()), next(j, columns));
        let at = |i: usize, j: usize| self.mu[i * columns + j];
        let low = at(i, j) + t * (at(i, j1) - at(i, j));
        let high = at(i1, j) + t * (at(i1, j1) - at(i1, j));
        let slope = (1.0 - s) * (at(i, j1) - at(i, j)) + s * (at(i1, j1) - at(i1, j));
        (low + s * (high - low), ds * (high - low), dt * slope)
    }
}

/// Interval, place in it (0 to 1), and derivative of the place; flat beyond the ends.
fn locate(axis: &[f64], x: f64) -> (usize, f64, f64) {
    let last = axis.len() - 1;
    if x <= axis[0] || last == 0 {
        return (0, 0.0, 0.0);
    }
    if x >= axis[last] {
        return (last, 0.0, 0.0);
    }
    let at = axis.partition_point(|a| *a <= x) - 1;
    let width = axis[at + 1] - axis[at];
    (at, (x - axis[at]) / width, 1.0 / width)
}

impl FrictionLaw for Table {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        let (sign, slope) = Smoothing::over(self.smoothing_speed).sign(v);
        let tiny = Pack::splat(1e-12);
        let log_v = v.abs().max(tiny).ln();
        let mut level = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let (value, by_pressure, by_log_v) = self.level(p.0[i], log_v.0[i]);
            (level[0][i], level[1][i], level[2][i]) = (value, by_pressure, by_log_v);
        }
        let [level, by_pressure, by_log_v] = level.map(Pack);
        Mu {
            value: sign * level,
            by_speed: slope * level + sign.abs() * by_log_v / v.abs().max(tiny),
            by_log_pressure: sign * by_pressure * p,
        }
    }
}
