//! Single effects: every one beside the recalibrated base model after the same effort, then the best of them further.

use super::{effort, full_jacobian, level, ranked, Hypothesis, Method};
use crate::gap::fit::{approach, columns, evaluate, evaluate_all, Effort, Fit, FINE};
use crate::gap::guess::{starts, Guess};
use crate::gap::problem::{Bench, Choice, Coordinate};

/// Effects of which all forms are tried.
const FAMILIES: usize = 3;
/// Effects that are refined with Jacobians of their own.
const REFINED: usize = 3;
/// From the base model's optimum to that of an effect, with an inherited Jacobian.
const NEAR: [Effort; 2] = [effort(2, 9, 3.0, None), effort(2, 9, 1.0, None)];
/// Whitened severity of an effect that is as good as absent.
const NEXT_TO_NONE: f64 = -3.5;
/// Whitened severity at which a second effect begins beside a first one that was fitted without it: a stronger one
/// would have to take back first what that fit has done in its place.
const FAINT: f64 = -2.4;
/// From an effect's own first guess.
const GUESS: [Effort; 2] = [effort(2, 2, 3.0, None), effort(5, 2, 1.0, None)];

/// Every effect in its first form from the optimum of `base`, and the responses as [`super::Fits`] has them; those that
/// are not `possible` as good as absent.
pub(super) fn each(
    bench: &Bench,
    base: &Fit,
    possible: &[bool],
    of: &[usize],
    method: Method,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> (Vec<Hypothesis>, Vec<(f64, f64)>) {
    let (mut singles, mut response) = (Vec::new(), Vec::new());
    for (effect, spec) in bench.specs.iter().enumerate() {
        let done = 0.35 + 0.20 * effect as f64 / bench.specs.len() as f64;
        progress(done, &format!("fitting {}", spec.effect));
        let choice = Choice { effect, form: 0 };
        if !possible[effect] {
            response.push((0.0, 0.0));
            singles.push(ruled_out(bench, base, choice, of));
            continue;
        }
        let (found, tried) = start_effect(bench, base, choice, of, method);
        response.push(tried);
        singles.push(level(bench, found, of));
    }
    (singles, response)
}

/// Effects that have a first guess of their own, once more from there.
pub(super) fn from_guesses(bench: &Bench, singles: &mut [Hypothesis], guess: &Guess, of: &[usize]) {
    for (single, guessed) in singles.iter_mut().zip(&guess.effects) {
        let Some((added, x, _)) = guessed else { continue };
        let fit = evaluate(bench, added, x.clone(), of);
        single.take_better(bench, approach(bench, fit, of, &GUESS), of);
    }
}

/// The best possible effects in their other forms.
pub(super) fn other_forms(
    bench: &Bench,
    base: &Fit,
    singles: &mut [Hypothesis],
    possible: &[bool],
    of: &[usize],
    method: Method,
) {
    for at in best_possible(singles, possible).into_iter().take(FAMILIES) {
        let effect = singles[at].fit.added[0].effect;
        for form in 1..bench.specs[effect].forms.len() {
            let (found, _) = start_effect(bench, base, Choice { effect, form }, of, method);
            singles[at].take_better(bench, found, of);
        }
    }
}

/// The first of `order` with Jacobians of their own.
pub(super) fn refine(
    bench: &Bench,
    singles: &mut [Hypothesis],
    order: &[usize],
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) {
    for (k, at) in order.iter().take(REFINED).enumerate() {
        progress(0.6 + 0.15 * k as f64 / REFINED as f64, "refining the best effects");
        let mut fit = approach(bench, singles[*at].fit.clone(), of, &FINE);
        fit.jacobian = Some(full_jacobian(bench, &fit, of));
        singles[*at].take_better(bench, fit, of);
    }
}

/// Indices of the effects that the symmetries of the data allow, from the best to the worst.
pub(super) fn best_possible(singles: &[Hypothesis], possible: &[bool]) -> Vec<usize> {
    ranked(singles).into_iter().filter(|at| possible[*at]).collect()
}

/// An effect that the symmetries of the data rule out: the base model with next to none of it.
fn ruled_out(bench: &Bench, base: &Fit, choice: Choice, of: &[usize]) -> Hypothesis {
    let added = vec![choice];
    let x = faint(&bench.coordinates(&added), &base.x, NEXT_TO_NONE);
    level(bench, Fit { added, x, jacobian: None, is_at_end: false, ..base.clone() }, of)
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
    let fits = evaluate_all(bench, &added, points, of);
    let tried = fits.first().map_or((0.0, 0.0), |fit| {
        (coordinates[at].value(fit.x[at]).abs(), caused(bench, base, fit))
    });
    let Some(mut fit) = fits.into_iter().reduce(Fit::or_better) else {
        return (base.clone(), tried);
    };
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
    if !coordinates[x.len()].spread.is_signed() {
        point[x.len()] = severity;
    }
    point
}

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
