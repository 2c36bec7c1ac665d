//! Levenberg-Marquardt in whitened parameters with Gaussian priors, robust loss, and Jacobians that
//! are kept up to date by Broyden's rule between the simulations.

mod jacobian;
mod objective;
mod search;

pub use jacobian::{columns, deviations};
pub use objective::View;
pub use search::search;

use super::noise::Noise;
use super::problem::{Bench, Choice, Residuals};
use jacobian::{broyden, newton, normal};
use nalgebra::{DMatrix, DVector};
use objective::{objective, weighted};

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
    /// Has [`to_the_end`] ended here?
    pub is_at_end: bool,
}

impl Fit {
    /// Is it a good optimum on the runs `of`?
    pub fn is_settled(&self, bench: &Bench, of: &[usize]) -> bool {
        self.objective < SETTLED * bench.total_weight(of)
    }

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
pub const FINE: [Effort; 1] = [Effort { steps: 4, refresh: 4, view: View::PLAIN }];

/// Level from which on an optimum is good.
pub const SETTLED: f64 = 0.8;

/// Rounds, so many at most, until one brings next to nothing or leaves a good optimum; none from where they have ended
/// before.
pub fn to_the_end(bench: &Bench, mut fit: Fit, of: &[usize], rounds: usize) -> Fit {
    for _ in 0..rounds {
        if fit.is_at_end {
            break;
        }
        let before = fit.objective;
        let found = approach(bench, Fit { jacobian: None, ..fit.clone() }, of, &FINE);
        fit = fit.or_better(found);
        fit.is_at_end = fit.is_settled(bench, of) || fit.objective > ENOUGH * before;
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
    let found = evaluate_all(bench, &fit.added, points, of);
    let mut best = fit;
    let mut lowest = objective(bench, &best.x, &best.residuals, view);
    for fit in found {
        let here = objective(bench, &fit.x, &fit.residuals, view);
        if here < lowest {
            (lowest, best) = (here, fit);
        }
    }
    best
}

/// How far the draws of [`explore`] go, in standard deviations.
const REACH: [f64; 4] = [3.0, 8.0, 20.0, 50.0];

/// Evaluates a point.
pub fn evaluate(bench: &Bench, added: &[Choice], x: Vec<f64>, of: &[usize]) -> Fit {
    evaluate_all(bench, added, vec![x], of).swap_remove(0)
}

/// Evaluates points side by side.
pub fn evaluate_all(
    bench: &Bench,
    added: &[Choice],
    points: Vec<Vec<f64>>,
    of: &[usize],
) -> Vec<Fit> {
    let all = bench.residuals(added, &points, of);
    let fit = |(x, residuals): (Vec<f64>, Residuals)| {
        let objective = objective(bench, &x, &residuals, View::PLAIN);
        Fit { added: added.to_vec(), x, residuals, objective, jacobian: None, is_at_end: false }
    };
    points.into_iter().zip(all).map(fit).collect()
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
