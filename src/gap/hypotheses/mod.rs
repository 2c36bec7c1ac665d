//! Which effects are asked, and how well each explains the data after the same effort.

mod base;
mod contenders;
mod pairs;
mod single;

use super::fit::{self, columns, evaluate, Effort, Fit, View};
use super::guess::Guess;
use super::problem::{Bench, Look};
use super::symmetry::{self, Finding};
use crate::error::Fault;
use nalgebra::DMatrix;
use pairs::pairs_and_alone;

/// A fitted hypothesis.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// The fit on the runs that may be seen, without effects for the base model.
    pub fit: Fit,
    /// Objective over the sum of weights on the start of the runs: about 1 where nothing is left.
    pub level: f64,
    /// What `fit` has looked at last.
    pub look: Look,
}

impl Hypothesis {
    /// Takes a fit on the runs `of` that is better than its own.
    pub(super) fn take_better(&mut self, bench: &Bench, fit: Fit, of: &[usize]) {
        if fit.objective < self.fit.objective {
            *self = level(bench, fit, of);
        }
    }

    /// Fits on, to where it no longer gets better: effects that share a valley leave it late.
    fn deepen(&mut self, bench: &Bench, of: &[usize]) {
        *self = level(bench, fit::to_the_end(bench, self.fit.clone(), of, ROUNDS), of);
    }

    /// Goes to the best place that a search around it finds.
    fn search(&mut self, bench: &Bench, of: &[usize]) {
        let fit = fit::search(bench, self.fit.clone(), of);
        self.take_better(bench, fit, of);
    }
}

/// Rounds of a fit that goes on, at most.
const ROUNDS: usize = 6;

/// All fits of a campaign.
#[derive(Clone, Debug)]
pub struct Fits {
    /// The recalibrated base model.
    pub base: Hypothesis,
    /// Best form of every effect, in the order of `effects::fit_specs()`.
    pub singles: Vec<Hypothesis>,
    /// Pairs among the best.
    pub pairs: Vec<Hypothesis>,
    /// Response to every effect: the severity that was tried, in the parameter's unit, and the weighted loss that it
    /// causes.
    pub response: Vec<(f64, f64)>,
    /// What the data say without any model.
    pub findings: Vec<Finding>,
}

/// Switches for the ablation table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Recalibrate the base model before anything is credited.
    pub recalibrate: bool,
    /// Start the base model again from what the effects' fits found.
    pub equal_effort: bool,
    /// Try all forms of an effect, not only the first.
    pub families: bool,
    /// Listen to what the data say without any model.
    pub symmetries: bool,
}

impl Method {
    /// Everything.
    pub const FULL: Self =
        Self { recalibrate: true, equal_effort: true, families: true, symmetries: true };
}

/// So many steps with a new Jacobian every `refresh`, looked at as [`View`] says.
pub(super) const fn effort(
    steps: usize,
    refresh: usize,
    heat: f64,
    onset_parts: Option<usize>,
) -> Effort {
    Effort { steps, refresh, view: View { heat, onset_parts } }
}

/// Fits everything on the runs `of`; `progress` is told the share done.
///
/// # Errors
/// What stops the reduction of the block.
pub fn fit_all(
    bench: &mut Bench,
    guess: &Guess,
    of: &[usize],
    method: Method,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Fits, Fault> {
    progress(0.1, "recalibrating the base model");
    let x = guess.base.clone();
    bench.measure_floor(&bench.params(&[], &x), of)?;
    let bench: &Bench = bench;
    let mut base = evaluate(bench, &[], x, of);
    if method.recalibrate {
        base = base::recalibrate(bench, base, of, !guess.promises());
    }
    let left =
        |fit: &Fit| format!("{:.2} of the floor left", fit.objective / bench.total_weight(of));
    progress(0.3, &format!("recalibrated: {}", left(&base)));
    base.jacobian = Some(full_jacobian(bench, &base, of));
    let possible = symmetry::possible(&guess.findings);
    let (mut singles, response) = single::each(bench, &base, &possible, of, method, progress);
    progress(0.54, "effects from their own first guess");
    single::from_guesses(bench, &mut singles, guess, of);
    if method.families {
        progress(0.55, "other forms of the best effects");
        single::other_forms(bench, &base, &mut singles, &possible, of, method);
    }
    let mut order = single::best_possible(&singles, &possible);
    if method.recalibrate {
        single::refine(bench, &mut singles, &order, of, progress);
        order = single::best_possible(&singles, &possible);
        contenders::effects(bench, &mut singles, &order, of, progress);
        order = single::best_possible(&singles, &possible);
    }
    if method.equal_effort && method.recalibrate {
        progress(0.75, "the base model once more, from what the effects found");
        base = base::again(bench, base, &singles, &order, of);
        progress(0.8, &format!("recalibrated: {}", left(&base)));
    }
    let pairs = pairs_and_alone(bench, &mut singles, &guess.findings, of, method, progress);
    progress(0.95, "fitted");
    let findings = guess.findings.clone();
    Ok(Fits { base: level(bench, base, of), singles, pairs, response, findings })
}

/// The Jacobian at a fit by differences.
fn full_jacobian(bench: &Bench, fit: &Fit, of: &[usize]) -> DMatrix<f64> {
    columns(bench, fit, &(0..fit.x.len()).collect::<Vec<_>>(), of)
}

/// The fit as a hypothesis with its level on the runs `of`.
fn level(bench: &Bench, fit: Fit, of: &[usize]) -> Hypothesis {
    let level = fit.objective / bench.total_weight(of);
    Hypothesis { fit, level, look: bench.look() }
}

/// Indices from the best to the worst.
pub fn ranked(hypotheses: &[Hypothesis]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..hypotheses.len()).collect();
    order.sort_by(|a, b| hypotheses[*a].level.total_cmp(&hypotheses[*b].level));
    order
}

/// Standard deviations of a fit's whitened parameters.
pub fn deviations(bench: &Bench, hypothesis: &Hypothesis) -> Vec<f64> {
    fit::deviations(bench, &hypothesis.fit)
}
