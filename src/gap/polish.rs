//! The most probable causes once more, on whole runs: the fits before look at the first milliseconds,
//! where parameters act without jumps; what a repaired model is used for is the settled vibration.

use super::decide::{Cause, Weighed, JUDGED};
use super::fit::{approach, evaluate, to_the_end, Effort, Fit};
use super::hypotheses::{effort, Fits};
use super::problem::{Bench, Look};

/// From the optimum of the starts to that of whole runs: soft first, as cycles jump.
const SCHEDULE: [Effort; 2] = [effort(3, 9, 4.0, None), effort(5, 9, 1.0, None)];
/// Rounds with Jacobians of their own of the best cause, and of the base model from its nuisance parameters: equal
/// effort.
const ROUNDS: usize = 3;

/// Refits the base model and the most probable causes on the whole runs `of`; `whole` looks at all of
/// them. A fit that does not get better there is kept as it was. Levels stay those of the starts.
pub fn polish(
    whole: &Bench,
    fits: &mut Fits,
    weighed: &[Weighed],
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) {
    debug_assert!(whole.look() == Look::Whole);
    let causes = weighed.iter().map(|w| &w.cause).filter(|cause| cause.is_fitted());
    let causes: Vec<Cause> = causes.take(JUDGED).cloned().collect();
    progress(0.95, "the base model on whole runs");
    let mut base = once(whole, &fits.base.fit, of);
    for (rank, cause) in causes.iter().enumerate() {
        progress(0.96 + 0.01 * rank as f64, "the likeliest causes on whole runs");
        let hypothesis = match cause {
            Cause::Single(k) => &mut fits.singles[*k],
            Cause::Pair(k) => &mut fits.pairs[*k],
            _ => continue,
        };
        let mut found = once(whole, &hypothesis.fit, of);
        if rank == 0 || matches!(cause, Cause::Pair(_)) {
            found = to_the_end(whole, found, of, ROUNDS);
        }
        if rank == 0 {
            let x = found.x[..base.x.len()].to_vec();
            base = base.or_better(to_the_end(whole, evaluate(whole, &[], x, of), of, ROUNDS));
        }
        hypothesis.fit = found;
        hypothesis.look = Look::Whole;
    }
    fits.base.fit = base;
    fits.base.look = Look::Whole;
}

/// A fit on whole runs, from where it was.
fn once(whole: &Bench, fit: &Fit, of: &[usize]) -> Fit {
    let start = evaluate(whole, &fit.added, fit.x.clone(), of);
    let found = approach(whole, start.clone(), of, &SCHEDULE);
    start.or_better(found)
}
