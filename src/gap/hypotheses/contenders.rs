//! What leads is searched for once more, where a descent has not settled it.

use super::Hypothesis;
use crate::gap::fit::Fit;
use crate::gap::problem::Bench;

/// Effects that are searched for, the best one among them.
const SINGLES: usize = 2;
/// What leaves at most so many times what the best effect leaves is searched for as hard as that.
const CLOSE: f64 = 1.5;

/// The best effect to the end of its descent; where that does not settle it, it and a second one that is close to it by
/// a search around their optima.
pub(super) fn effects(
    bench: &Bench,
    singles: &mut [Hypothesis],
    order: &[usize],
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) {
    let Some(first) = order.first() else { return };
    singles[*first].deepen(bench, of);
    let best = singles[*first].fit.clone();
    for at in order.iter().take(SINGLES) {
        if is_contended(bench, &best, &singles[*at].fit, of) {
            progress(0.75, "searching around the best effects");
            singles[*at].search(bench, of);
        }
    }
}

/// Is `best` not settled, and `other` close to it?
pub(super) fn is_contended(bench: &Bench, best: &Fit, other: &Fit, of: &[usize]) -> bool {
    !best.is_settled(bench, of) && other.objective <= CLOSE * best.objective
}
