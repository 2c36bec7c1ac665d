//! Levenberg-Marquardt in whitened parameters with Gaussian priors, robust loss, and Jacobians that
//! are kept up to date by Broyden's rule between the simulations.

use super::features::{Aspect, Key};
use super::problem::{loss, robust_weight, Bench, Choice, Residuals};
use nalgebra::{DMatrix, DVector};

/// Step of the finite differences in prior standard deviations.
const DIFFERENCE: f64 = 0.12;
/// Largest change of a whitened parameter per step.
const LARGEST_STEP: f64 = 1.2;
/// Farthest a parameter may go from the centre of its prior.
const FARTHEST: f64 = 3.5;

/// A point with its residuals.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Effects that were added.
    pub added: Vec<Choice>,
    /// Whitened parameters.
    pub x: Vec<f64>,
    /// Residuals of the fitted runs.
    pub residuals: Residuals,
    /// Objective: weighted loss + |x|².
    pub objective: f64,
    /// Jacobian of the fitted residuals, run after run; columns are parameters.
    pub jacobian: Option<DMatrix<f64>>,
}

impl Fit {
    /// The other fit if it is better.
    #[must_use]
    pub fn or_better(self, other: Self) -> Self {
        if other.objective < self.objective {
            other
        } else {
            self
        }
    }
}

/// How the optimiser may spend simulations.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Steps.
    pub steps: usize,
    /// Steps after which the Jacobian is differenced anew.
    pub refresh: usize,
    /// What counts, and how softly.
    pub view: View,
}

/// How the residuals are looked at: coarsely far from the optimum, as they are close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Residuals are divided by this.
    pub heat: f64,
    /// Only ring-down and the onset up to this part, which follow the parameters without jumps.
    pub onset_parts: Option<usize>,
}

impl View {
    /// Everything at its own uncertainty.
    pub const PLAIN: Self = Self { heat: 1.0, onset_parts: None };

    fn counts(&self, key: &Key) -> bool {
        match self.onset_parts {
            None => true,
            Some(parts) => {
                key.aspect == Aspect::Ringdown
                    || key.aspect == Aspect::Snap && key.part == 0
                    || key.aspect == Aspect::Onset && key.part < parts
            }
        }
    }

    /// Weight of the prior: it cools with the data.
    fn prior(&self) -> f64 {
        1.0 / (self.heat * self.heat)
    }
}

/// From far away to the optimum: coarse and smooth first.
pub fn approach(bench: &Bench, mut fit: Fit, of: &[usize], schedule: &[Effort]) -> Fit {
    for effort in schedule {
        fit = improve(bench, fit, of, *effort);
        fit.jacobian = fit.jacobian.filter(|_| effort.refresh > effort.steps);
    }
    fit
}

/// Share of the objective that a round of [`to_the_end`] must leave at most to be followed by another.
const ENOUGH: f64 = 0.97;
/// A round with a Jacobian of its own.
const ROUND: [Effort; 1] = [Effort { steps: 4, refresh: 4, view: View::PLAIN }];

/// Rounds, so many at most, until one brings next to nothing.
pub fn to_the_end(bench: &Bench, mut fit: Fit, of: &[usize], rounds: usize) -> Fit {
    for _ in 0..rounds {
        let before = fit.objective;
        let found = approach(bench, Fit { jacobian: None, ..fit.clone() }, of, &ROUND);
        fit = fit.or_better(found);
        if fit.objective > ENOUGH * before {
            break;
        }
    }
    fit
}

/// Looks around an optimum in the directions that its data leave open, and goes to the best place
/// found: a limit cycle of another kind is not reached by descending.
pub fn explore(bench: &Bench, fit: Fit, of: &[usize], draws: usize, view: View) -> Fit {
    let size = fit.x.len();
    let jacobian = match &fit.jacobian {
        Some(jacobian) => jacobian.clone(),
        None => columns(bench, &fit, &(0..size).collect::<Vec<_>>(), of),
    };
    let (r, w) = weighted(bench, &fit.residuals, view);
    let (matrix, _) = normal(&jacobian, &r, &w, &fit.x);
    let Some(factor) = matrix.cholesky() else { return fit };
    let upper = factor.l().transpose();
    let mut noise = Noise::new(0);
    let points: Vec<Vec<f64>> = (0..draws)
        .map(|k| {
            let z = DVector::from_fn(size, |_, _| noise.normal());
            // Near and far in turn.
            let reach = REACH[k % REACH.len()];
            let step = upper.solve_upper_triangular(&z).unwrap_or_else(|| DVector::zeros(size));
            let shift = step.iter().map(|s| (reach * s).clamp(-1.5, 1.5));
            fit.x.iter().zip(shift).map(|(x, s)| (x + s).clamp(-2.5, 2.5)).collect()
        })
        .collect();
    let found = bench.residuals(&fit.added, &points, of);
    let mut best = fit;
    let mut lowest = objective(bench, &best.x, &best.residuals, view);
    for (x, residuals) in points.into_iter().zip(found) {
        let here = objective(bench, &x, &residuals, view);
        if here < lowest {
            lowest = here;
            let objective = objective(bench, &x, &residuals, View::PLAIN);
            best = Fit { added: best.added, x, residuals, objective, jacobian: None };
        }
    }
    best
}

/// How far the draws of [`explore`] go, in standard deviations.
const REACH: [f64; 4] = [3.0, 8.0, 20.0, 50.0];

/// Deterministic random numbers.
#[derive(Clone, Debug)]
pub struct Noise(u64);

impl Noise {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Self {
        let mut noise =
            Self((seed ^ 0x5eed_0123_4567_89ab).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        (0..8).for_each(|_| _ = noise.uniform());
        noise
    }

    /// Uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Evaluates a point.
pub fn evaluate(bench: &Bench, added: &[Choice], x: Vec<f64>, of: &[usize]) -> Fit {
    let residuals = bench.residuals(added, std::slice::from_ref(&x), of).swap_remove(0);
    let objective = objective(bench, &x, &residuals, View::PLAIN);
    Fit { added: added.to_vec(), x, residuals, objective, jacobian: None }
}

/// Weighted loss + |x|².
fn objective(bench: &Bench, x: &[f64], residuals: &Residuals, view: View) -> f64 {
    let weights = of_weights(bench, residuals, view);
    let data: f64 =
        residuals.iter().flatten().zip(weights).map(|(r, w)| w * loss(*r / view.heat)).sum();
    data + view.prior() * x.iter().map(|v| v * v).sum::<f64>()
}

/// Columns `which` of the Jacobian at `fit` by forward differences.
pub fn columns(bench: &Bench, fit: &Fit, which: &[usize], of: &[usize]) -> DMatrix<f64> {
    let points: Vec<Vec<f64>> = which
        .iter()
        .map(|k| {
            let mut x = fit.x.clone();
            x[*k] += difference(x[*k]);
            x
        })
        .collect();
    let shifted = bench.residuals(&fit.added, &points, of);
    let base = flat(&fit.residuals);
    let mut out = DMatrix::zeros(base.len(), which.len());
    for (column, (k, residuals)) in which.iter().zip(&shifted).enumerate() {
        let change = (flat(residuals) - &base) / difference(fit.x[*k]);
        out.set_column(column, &change);
    }
    out
}

/// Differences point to the centre of the prior.
fn difference(x: f64) -> f64 {
    if x > 0.0 {
        -DIFFERENCE
    } else {
        DIFFERENCE
    }
}

/// Residuals as one vector.
pub fn flat(residuals: &Residuals) -> DVector<f64> {
    DVector::from_iterator(
        residuals.iter().map(Vec::len).sum(),
        residuals.iter().flatten().copied(),
    )
}

/// Improves `fit` on the runs `of`.
pub fn improve(bench: &Bench, mut fit: Fit, of: &[usize], effort: Effort) -> Fit {
    let (size, view) = (fit.x.len(), effort.view);
    let mut damping = 0.01;
    let mut since = 0;
    fit.objective = objective(bench, &fit.x, &fit.residuals, view);
    for _ in 0..effort.steps {
        if fit.jacobian.is_none() || since >= effort.refresh {
            fit.jacobian = Some(columns(bench, &fit, &(0..size).collect::<Vec<_>>(), of));
            since = 0;
        }
        let Some(jacobian) = fit.jacobian.as_ref() else { break };
        let (r, w) = weighted(bench, &fit.residuals, view);
        let step = newton(jacobian, &r, &w, &fit.x, damping);
        let x: Vec<f64> = fit
            .x
            .iter()
            .zip(step.iter())
            .map(|(x, s)| (x + s.clamp(-LARGEST_STEP, LARGEST_STEP)).clamp(-FARTHEST, FARTHEST))
            .collect();
        let mut trial = evaluate(bench, &fit.added, x, of);
        trial.objective = objective(bench, &trial.x, &trial.residuals, view);
        since += 1;
        let updated = broyden(jacobian, &fit, &trial);
        let gain = fit.objective - trial.objective;
        if gain > 0.0 {
            damping = (damping * 0.3_f64).max(1e-4);
            let small = gain < 2e-3 * trial.objective;
            fit = Fit { jacobian: Some(updated), ..trial };
            if small {
                break;
            }
        } else {
            damping = (damping * 8.0).max(0.1);
            fit.jacobian = Some(updated);
            if damping > 1e4 {
                break;
            }
        }
    }
    fit.objective = objective(bench, &fit.x, &fit.residuals, View::PLAIN);
    fit
}

/// Weights in the order of [`flat`].
fn of_weights<'a>(
    bench: &'a Bench,
    residuals: &'a Residuals,
    view: View,
) -> impl Iterator<Item = f64> + 'a {
    let present = residuals.iter().zip(bench.weight.iter().zip(&bench.measured));
    present.filter(|(r, _)| !r.is_empty()).flat_map(move |(_, (weights, features))| {
        weights.iter().zip(features).map(
            move |(w, feature)| {
                if view.counts(&feature.key) {
                    *w
                } else {
                    0.0
                }
            },
        )
    })
}

/// Residuals with their weights, robust ones included.
fn weighted(bench: &Bench, residuals: &Residuals, view: View) -> (DVector<f64>, DVector<f64>) {
    let r = flat(residuals);
    let weights = of_weights(bench, residuals, view);
    let w = DVector::from_iterator(
        r.len(),
        r.iter().zip(weights).map(|(r, w)| w * robust_weight(*r / view.heat)),
    );
    (r, w)
}

/// Step of (JᵀWJ + I)(1 + damping on the diagonal) s = −(JᵀWr + x).
fn newton(
    jacobian: &DMatrix<f64>,
    r: &DVector<f64>,
    w: &DVector<f64>,
    x: &[f64],
    damping: f64,
) -> DVector<f64> {
    let (mut matrix, gradient) = normal(jacobian, r, w, x);
    for i in 0..x.len() {
        matrix[(i, i)] *= 1.0 + damping;
    }
    matrix.cholesky().map_or_else(|| DVector::zeros(x.len()), |c| -c.solve(&gradient))
}

/// JᵀWJ + I and JᵀWr + x.
fn normal(
    jacobian: &DMatrix<f64>,
    r: &DVector<f64>,
    w: &DVector<f64>,
    x: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let mut weighted = jacobian.clone();
    for mut column in weighted.column_iter_mut() {
        column.component_mul_assign(w);
    }
    let matrix = weighted.tr_mul(jacobian) + DMatrix::identity(x.len(), x.len());
    let gradient = weighted.tr_mul(r) + DVector::from_column_slice(x);
    (matrix, gradient)
}

/// Standard deviations of the whitened parameters (Laplace).
pub fn deviations(bench: &Bench, fit: &Fit) -> Vec<f64> {
    let Some(jacobian) = fit.jacobian.as_ref() else { return vec![1.0; fit.x.len()] };
    let (r, w) = weighted(bench, &fit.residuals, View::PLAIN);
    let (matrix, _) = normal(jacobian, &r, &w, &fit.x);
    matrix.cholesky().map_or_else(
        || vec![1.0; fit.x.len()],
        |c| c.inverse().diagonal().iter().map(|v| v.sqrt()).collect(),
    )
}

/// Broyden's rank-one update: the least change of J that explains the step.
fn broyden(jacobian: &DMatrix<f64>, from: &Fit, to: &Fit) -> DMatrix<f64> {
    let step = DVector::from_iterator(from.x.len(), to.x.iter().zip(&from.x).map(|(a, b)| a - b));
    let square = step.norm_squared();
    if square < 1e-10 {
        return jacobian.clone();
    }
    let change = flat(&to.residuals) - flat(&from.residuals);
    let miss = change - jacobian * &step;
    jacobian + miss * (step.transpose() / square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::fit_specs;
    use crate::gap::problem::Coordinate;
    use crate::params::{table, Kind};

    /// A run that is refused for its parameters says nothing about an effect.
    #[test]
    fn no_fit_leaves_the_range_of_a_parameter() {
        for param in fit_specs().iter().flat_map(|s| s.forms).flat_map(|form| form.params) {
            let Kind::Real { min, max, .. } = table::find(param.name).unwrap().kind else {
                panic!("{}", param.name)
            };
            let coordinate =
                Coordinate { name: param.name, centre: param.centre, spread: param.spread };
            let ends = [-FARTHEST, FARTHEST].map(|x| coordinate.value(x));
            let inside = ends.iter().all(|x| (min..=max).contains(x));
            assert!(inside, "{} goes to {ends:?}, allowed {min} to {max}", param.name);
        }
    }
}
