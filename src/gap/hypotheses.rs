//! Which effects are asked, and how well each explains the data after the same effort.

use super::fit::{self, approach, columns, evaluate, explore, improve, Effort, Fit, View};
use super::guess::{starts, Guess};
use super::pairs::pairs_and_alone;
use super::problem::{Bench, Choice, Coordinate, Look};
use super::symmetry::{self, Finding};
use crate::effects::Spread;
use crate::error::Fault;
use nalgebra::DMatrix;

/// Effects of which all forms are tried.
const FAMILIES: usize = 3;
/// Effects that are refined with Jacobians of their own.
const REFINED: usize = 3;

/// A fitted hypothesis.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// Effects; empty for the base model.
    pub added: Vec<Choice>,
    /// The fit on the runs that may be seen.
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
}

/// All fits of a campaign.
#[derive(Clone, Debug)]
pub struct Fits {
    /// The recalibrated base model.
    pub base: Hypothesis,
    /// Best form of every effect, in the order of `effects::fit_specs()`.
    pub singles: Vec<Hypothesis>,
    /// Pairs among the best.
    pub pairs: Vec<Hypothesis>,
    /// Smallest whitened response of every effect: severity that was tried, and weighted loss that
    /// it causes.
    pub response: Vec<(f64, f64)>,
    /// What the data say without any model.
    pub findings: Vec<Finding>,
}

/// An effect that the symmetries of the data rule out: the base model with next to none of it.
fn ruled_out(bench: &Bench, base: &Fit, choice: Choice, of: &[usize]) -> Hypothesis {
    let added = vec![choice];
    let x = faint(&bench.coordinates(&added), &base.x, NEXT_TO_NONE);
    level(bench, Fit { added, x, jacobian: None, ..base.clone() }, of)
}

/// Whitened severity of an effect that is as good as absent.
const NEXT_TO_NONE: f64 = -3.5;

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

pub(super) const fn effort(
    steps: usize,
    refresh: usize,
    heat: f64,
    onset_parts: Option<usize>,
) -> Effort {
    Effort { steps, refresh, view: View { heat, onset_parts } }
}

/// Once more from another place.
const HOME: [Effort; 2] = [effort(1, 1, 3.0, None), effort(4, 2, 1.0, None)];
/// Places looked at where the optimum is not good.
const DRAWS: usize = 32;
/// Level from which on an optimum is good.
pub(super) const SETTLED: f64 = 0.8;
/// From the base model's optimum to that of an effect, with an inherited Jacobian.
const NEAR: [Effort; 2] = [effort(2, 9, 3.0, None), effort(2, 9, 1.0, None)];
/// With Jacobians of its own.
pub const FINE: [Effort; 1] = [effort(4, 4, 1.0, None)];
/// From an effect's own first guess.
const GUESS: [Effort; 2] = [effort(2, 2, 3.0, None), effort(5, 2, 1.0, None)];
/// Once more.
const AGAIN: Effort = effort(2, 9, 1.0, None);

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
        base = recalibrate(bench, base, of, !guess.promises());
    }
    let left =
        |fit: &Fit| format!("{:.2} of the floor left", fit.objective / bench.total_weight(of));
    progress(0.3, &format!("recalibrated: {}", left(&base)));
    base.jacobian = Some(full_jacobian(bench, &base, of));
    let possible = symmetry::possible(&guess.findings);
    let mut singles = Vec::new();
    let mut response = Vec::new();
    for (effect, spec) in bench.specs.iter().enumerate() {
        let done = 0.35 + 0.20 * effect as f64 / bench.specs.len() as f64;
        progress(done, &format!("fitting {}", spec.effect));
        let choice = Choice { effect, form: 0 };
        if !possible[effect] {
            response.push((0.0, 0.0));
            singles.push(ruled_out(bench, &base, choice, of));
            continue;
        }
        let (found, tried) = start_effect(bench, &base, choice, of, method);
        response.push(tried);
        singles.push(level(bench, found, of));
    }
    for (single, guessed) in singles.iter_mut().zip(&guess.effects) {
        let Some((added, x, _)) = guessed else { continue };
        progress(0.54, "effects from their own first guess");
        let fit = evaluate(bench, added, x.clone(), of);
        single.take_better(bench, approach(bench, fit, of, &GUESS), of);
    }
    if method.families {
        progress(0.55, "other forms of the best effects");
        let order = ranked(&singles).into_iter().filter(|at| possible[*at]);
        for at in order.take(FAMILIES).collect::<Vec<_>>() {
            let effect = singles[at].added[0].effect;
            for form in 1..bench.specs[effect].forms.len() {
                let (found, _) = start_effect(bench, &base, Choice { effect, form }, of, method);
                singles[at].take_better(bench, found, of);
            }
        }
    }
    let order: Vec<usize> = ranked(&singles).into_iter().filter(|at| possible[*at]).collect();
    for (k, at) in order.iter().take(REFINED).enumerate() {
        progress(0.6 + 0.15 * k as f64 / REFINED as f64, "refining the best effects");
        if method.recalibrate {
            let mut fit = approach(bench, singles[*at].fit.clone(), of, &FINE);
            fit.jacobian = Some(full_jacobian(bench, &fit, of));
            singles[*at].take_better(bench, fit, of);
        }
    }
    if method.equal_effort && method.recalibrate {
        progress(0.75, "the base model once more, from what the effects found");
        base = again(bench, base, &singles, &order, of);
        progress(0.8, &format!("recalibrated: {}", left(&base)));
    }
    let pairs = pairs_and_alone(bench, &mut singles, &guess.findings, of, method, progress);
    progress(0.95, "fitted");
    let findings = guess.findings.clone();
    Ok(Fits { base: level(bench, base, of), singles, pairs, response, findings })
}

/// The base model's optimum from `start`.
pub fn recalibrate(bench: &Bench, start: Fit, of: &[usize], search: bool) -> Fit {
    let mut best = approach(bench, start, of, &HOME);
    if search && best.objective >= SETTLED * bench.total_weight(of) {
        let view = View { heat: 3.0, onset_parts: None };
        let found = explore(bench, best.clone(), of, DRAWS, view);
        best = best.or_better(approach(bench, found, of, &HOME));
    }
    best
}

pub(super) fn full_jacobian(bench: &Bench, fit: &Fit, of: &[usize]) -> DMatrix<f64> {
    columns(bench, fit, &(0..fit.x.len()).collect::<Vec<_>>(), of)
}

pub(super) fn level(bench: &Bench, fit: Fit, of: &[usize]) -> Hypothesis {
    let level = fit.objective / bench.total_weight(of);
    Hypothesis { added: fit.added.clone(), fit, level, look: bench.look() }
}

/// Indices from the best to the worst.
pub fn ranked(hypotheses: &[Hypothesis]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..hypotheses.len()).collect();
    order.sort_by(|a, b| hypotheses[*a].level.total_cmp(&hypotheses[*b].level));
    order
}

/// One form of an effect from the base model's optimum, with the base model's Jacobian.
pub(super) fn start_effect(
    bench: &Bench,
    base: &Fit,
    choice: Choice,
    of: &[usize],
    method: Method,
) -> (Fit, (f64, f64)) {
    let mut added = base.added.clone();
    added.push(choice);
    let coordinates = bench.coordinates(&added);
    let at = base.x.len();
    let mut points = starts(bench, &added, &base.x);
    if !base.added.is_empty() {
        points.push(faint(&coordinates, &base.x, FAINT));
    }
    let mut tried = (0.0, 0.0);
    let mut best: Option<Fit> = None;
    for (k, x) in points.into_iter().enumerate() {
        let fit = evaluate(bench, &added, x, of);
        if k == 0 {
            tried = (coordinates[at].value(fit.x[at]).abs(), caused(bench, base, &fit));
        }
        best = Some(match best {
            Some(best) => best.or_better(fit),
            None => fit,
        });
    }
    let Some(mut fit) = best else { return (base.clone(), tried) };
    let own: Vec<usize> = if method.recalibrate { (at..fit.x.len()).collect() } else { vec![at] };
    let columns = columns(bench, &fit, &own, of);
    fit.jacobian = base.jacobian.as_ref().map(|j| {
        let mut wide = j.clone().resize_horizontally(coordinates.len(), 0.0);
        if !method.recalibrate {
            wide.fill(0.0);
        }
        for (k, column) in own.iter().enumerate() {
            wide.set_column(*column, &columns.column(k));
        }
        wide
    });
    (approach(bench, fit, of, &NEAR), tried)
}

/// `x` with an effect that is next to nothing: none where its severity has a sign, else of the whitened `severity`.
fn faint(coordinates: &[Coordinate], x: &[f64], severity: f64) -> Vec<f64> {
    let mut point = x.to_vec();
    point.resize(coordinates.len(), 0.0);
    if let Spread::Log(_) = coordinates[x.len()].spread {
        point[x.len()] = severity;
    }
    point
}

/// Whitened severity at which a second effect begins beside a first one that was fitted without it: a stronger one
/// would have to take back first what that fit has done in its place.
const FAINT: f64 = -2.4;

/// Weighted loss of what an effect changes.
fn caused(bench: &Bench, from: &Fit, to: &Fit) -> f64 {
    let change = to
        .residuals
        .iter()
        .zip(&from.residuals)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect())
        .collect();
    bench.gap(&change)
}

/// The base model from the nuisance parameters of the best effects.
fn again(
    bench: &Bench,
    mut base: Fit,
    singles: &[Hypothesis],
    order: &[usize],
    of: &[usize],
) -> Fit {
    let size = base.x.len();
    for at in order.iter().take(2) {
        let x = singles[*at].fit.x[..size].to_vec();
        let trial = improve(bench, evaluate(bench, &[], x, of), of, AGAIN);
        base = base.or_better(trial);
    }
    if base.jacobian.is_none() {
        base.jacobian = Some(full_jacobian(bench, &base, of));
    }
    base
}

/// Standard deviations of a fit's whitened parameters.
pub fn deviations(bench: &Bench, hypothesis: &Hypothesis) -> Vec<f64> {
    fit::deviations(bench, &hypothesis.fit)
}
