//! Where the points of a plan lie: every design is a list of values per axis.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use toml::Value;

use super::axis::Axis;

/// How points are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Every level of every axis with every other; the last axis runs fastest.
    Grid,
    /// The file's own values first, then each axis alone through its levels.
    OneAtATime,
    /// `points` values per axis, one in each of as many equal parts, shuffled per axis.
    LatinHypercube,
    /// The first `points` of an Owen-scrambled Sobol sequence (Burley, JCGT 9(4), 2020).
    Sobol,
}

impl Method {
    /// All methods with their names in a plan.
    pub const ALL: [(&'static str, Self); 4] = [
        ("grid", Self::Grid),
        ("one_at_a_time", Self::OneAtATime),
        ("latin_hypercube", Self::LatinHypercube),
        ("sobol", Self::Sobol),
    ];

    /// Do `points` and `seed` belong to it?
    pub fn samples(self) -> bool {
        matches!(self, Self::LatinHypercube | Self::Sobol)
    }
}

/// Most axes and points of a Sobol plan: what the sequence at hand offers.
pub const SOBOL_LIMITS: (usize, usize) = (256, 1 << 16);

/// Number of points; `None` if a grid's overflows.
pub fn count(method: Method, axes: &[Axis], points: usize) -> Option<usize> {
    let mut counts = axes.iter().map(Axis::count);
    match method {
        Method::Grid => counts.try_fold(1usize, |product, n| product.checked_mul(n)),
        Method::OneAtATime => counts.try_fold(1usize, |sum, n| sum.checked_add(n)),
        Method::LatinHypercube | Method::Sobol => Some(points),
    }
}

/// Values of all points, axis by axis; `base` are the file's own.
pub fn points(
    method: Method,
    axes: &[Axis],
    base: &[Value],
    points: usize,
    seed: u64,
) -> Vec<Vec<Value>> {
    match method {
        Method::Grid => grid(axes),
        Method::OneAtATime => one_at_a_time(axes, base),
        Method::LatinHypercube => {
            let shares = latin_hypercube(axes.len(), points, seed);
            let row = |i: usize| axes.iter().zip(&shares).map(|(axis, u)| axis.at(u[i])).collect();
            (0..points).map(row).collect()
        }
        Method::Sobol => {
            let seed = (seed ^ (seed >> 32)) as u32;
            let share = |i: usize, d: usize| sobol_burley::sample(i as u32, d as u32, seed);
            let row = |i: usize| {
                axes.iter().enumerate().map(|(d, axis)| axis.at(f64::from(share(i, d)))).collect()
            };
            (0..points).map(row).collect()
        }
    }
}

fn grid(axes: &[Axis]) -> Vec<Vec<Value>> {
    let mut rows: Vec<Vec<Value>> = vec![Vec::new()];
    for axis in axes {
        let longer = |row: &Vec<Value>| -> Vec<Vec<Value>> {
            (0..axis.count()).map(|i| [row.as_slice(), &[axis.level(i)]].concat()).collect()
        };
        rows = rows.iter().flat_map(longer).collect();
    }
    rows
}

fn one_at_a_time(axes: &[Axis], base: &[Value]) -> Vec<Vec<Value>> {
    let mut rows = vec![base.to_vec()];
    for (at, axis) in axes.iter().enumerate() {
        rows.extend((0..axis.count()).map(|i| {
            let mut row = base.to_vec();
            row[at] = axis.level(i);
            row
        }));
    }
    rows
}

/// Shares in [0, 1) per axis and point: one per stratum, in an order of its own per axis.
fn latin_hypercube(axes: usize, points: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut chance = ChaCha8Rng::seed_from_u64(seed);
    let mut axis = || {
        let mut strata: Vec<usize> = (0..points).collect();
        strata.shuffle(&mut chance);
        let within = |stratum: usize| (stratum as f64 + chance.random::<f64>()) / points as f64;
        strata.into_iter().map(within).collect()
    };
    (0..axes).map(|_| axis()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(texts: &[(&str, &str)]) -> Vec<Axis> {
        let axis = |(name, text): &(&str, &str)| {
            let table: toml::Table = format!("v = {text}").parse().unwrap();
            Axis::read(name, &table["v"]).unwrap()
        };
        texts.iter().map(axis).collect()
    }

    fn numbers(rows: &[Vec<Value>], axis: usize) -> Vec<f64> {
        rows.iter().map(|row| row[axis].as_float().unwrap()).collect()
    }

    const UNIT: &str = "{ from = 0.0, to = 1.0, count = 3 }";

    #[test]
    fn a_grid_has_every_pair_once() {
        let axes = axes(&[("friction.mu_inf", "[1.0, 2.0]"), ("friction.mu_drop", UNIT)]);
        let rows = points(Method::Grid, &axes, &[], 0, 0);
        assert_eq!(numbers(&rows, 0), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
        assert_eq!(numbers(&rows, 1), [0.0, 0.5, 1.0, 0.0, 0.5, 1.0]);
        assert_eq!(count(Method::Grid, &axes, 0), Some(6));
    }

    #[test]
    fn one_at_a_time_starts_at_the_base_and_moves_one_axis() {
        let axes = axes(&[("friction.mu_inf", "[1.0, 2.0]"), ("friction.mu_drop", "[3.0]")]);
        let base = [Value::Float(0.5), Value::Float(0.7)];
        let rows = points(Method::OneAtATime, &axes, &base, 0, 0);
        assert_eq!(numbers(&rows, 0), [0.5, 1.0, 2.0, 0.5]);
        assert_eq!(numbers(&rows, 1), [0.7, 0.7, 0.7, 3.0]);
    }

    #[test]
    fn samples_fill_every_stratum_of_every_axis_once() {
        // Definition of a Latin hypercube; for Sobol the property of a (0, m, 1)-net per axis.
        let axes = axes(&[("friction.mu_inf", UNIT), ("friction.mu_drop", UNIT)]);
        for method in [Method::LatinHypercube, Method::Sobol] {
            let rows = points(method, &axes, &[], 64, 7);
            for axis in 0..2 {
                let mut strata: Vec<usize> =
                    numbers(&rows, axis).iter().map(|u| (u * 64.0) as usize).collect();
                strata.sort_unstable();
                assert_eq!(strata, (0..64).collect::<Vec<_>>(), "{method:?} axis {axis}");
            }
        }
    }

    #[test]
    fn sobol_points_fill_every_square_of_two_axes_once() {
        // A (0, 2, 2)-net in base 2: the first 16 points lie one in each of 4 x 4 squares.
        let axes = axes(&[("friction.mu_inf", UNIT), ("friction.mu_drop", UNIT)]);
        let rows = points(Method::Sobol, &axes, &[], 16, 3);
        let (x, y) = (numbers(&rows, 0), numbers(&rows, 1));
        let mut squares: Vec<usize> =
            x.iter().zip(&y).map(|(x, y)| 4 * (x * 4.0) as usize + (y * 4.0) as usize).collect();
        squares.sort_unstable();
        assert_eq!(squares, (0..16).collect::<Vec<_>>());
    }
}
