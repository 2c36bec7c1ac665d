//! The base model, recalibrated: nothing is credited to an effect that it could have explained.

use super::contenders::is_contended;
use super::{effort, full_jacobian, Hypothesis};
use crate::gap::fit::{approach, evaluate, explore, improve, search, Effort, Fit, View};
use crate::gap::problem::Bench;

/// Once more from another place.
const HOME: [Effort; 2] = [effort(1, 1, 3.0, None), effort(4, 2, 1.0, None)];
/// Places looked at where the optimum is not good.
const DRAWS: usize = 32;
/// Once more.
const AGAIN: Effort = effort(2, 9, 1.0, None);

/// The base model's optimum from `start`; where it is not good, `search` looks for one further away.
pub(super) fn recalibrate(bench: &Bench, start: Fit, of: &[usize], search: bool) -> Fit {
    let mut best = approach(bench, start, of, &HOME);
    if search && !best.is_settled(bench, of) {
        let view = View { heat: 3.0, onset_parts: None };
        let found = explore(bench, best.clone(), of, DRAWS, view);
        best = best.or_better(approach(bench, found, of, &HOME));
    }
    best
}

/// The base model from the nuisance parameters of the best effects, and by a search where one of them had to be searched
/// for and is close.
pub(super) fn again(
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
    if order.first().is_some_and(|at| is_contended(bench, &singles[*at].fit, &base, of)) {
        base = search(bench, base, of);
    }
    if base.jacobian.is_none() {
        base.jacobian = Some(full_jacobian(bench, &base, of));
    }
    base
}
