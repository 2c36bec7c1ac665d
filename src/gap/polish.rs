//! The most probable causes once more, on whole runs: the fits before look at the first milliseconds,
//! where parameters act without jumps; what a repaired model is used for is the settled vibration.

use super::decide::{Cause, Weighed, JUDGED};
use super::fit::{approach, evaluate, evaluate_all, to_the_end, Effort, Fit};
use super::hypotheses::{effort, Fits};
use super::problem::{Bench, Look};
use crate::effects::FitForm;

/// From the optimum of the starts to that of whole runs: soft first, as cycles jump.
const SCHEDULE: [Effort; 2] = [effort(3, 9, 4.0, None), effort(5, 9, 1.0, None)];
/// Rounds with Jacobians of their own of the best cause, and of the base model from its nuisance parameters: equal
/// effort.
const ROUNDS: usize = 3;

/// Severities from which the likeliest effect starts once more.
const SEVERITIES: [f64; 5] = [-3.0, -2.0, -1.0, 0.0, 1.5];
/// The same where it has a sign.
const SIGNED: [f64; 4] = [-2.0, -0.7, 0.7, 2.0];
/// Second parameters, most of them what an effect remembers by.
const SECOND: [f64; 4] = [0.0, -2.0, -1.0, 1.5];
/// Such a start goes on if it leaves at most this many times what the best fit so far leaves.
const PROMISING: f64 = 1.5;

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
        if rank == 0 && !found.is_settled(whole, of) {
            found = all_over(whole, found, of);
        }
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

/// The effects of `fit`, one after the other, in all their forms from all over their parameters: what lasts longer than
/// the start of a run shows on whole runs only, where most optima are not the best one.
fn all_over(whole: &Bench, fit: Fit, of: &[usize]) -> Fit {
    let mut best = fit;
    for k in 0..best.added.len() {
        let (from, x) = (best.added.clone(), best.x.clone());
        let [begin, end] = [k, k + 1].map(|k| whole.coordinates(&from[..k]).len());
        let with = |own: Vec<f64>| [&x[..begin], &own, &x[end..]].concat();
        for (form, spec) in whole.specs[from[k].effect].forms.iter().enumerate() {
            let mut added = from.clone();
            added[k].form = form;
            let points = scattered(spec).into_iter().map(with).collect();
            let begun = evaluate_all(whole, &added, points, of).into_iter().reduce(Fit::or_better);
            let promising = begun.filter(|fit| fit.objective <= PROMISING * best.objective);
            let Some(begun) = promising else { continue };
            let found = approach(whole, begun.clone(), of, &SCHEDULE[1..]);
            best = best.or_better(begun.or_better(found));
        }
    }
    best
}

/// Whitened parameters of an effect from far below to far above the centres of the first two priors.
fn scattered(form: &FitForm) -> Vec<Vec<f64>> {
    let severities: &[f64] = if form.params[0].spread.is_signed() { &SIGNED } else { &SEVERITIES };
    let second: &[f64] = if form.params.len() > 1 { &SECOND } else { &SECOND[..1] };
    let pairs = severities.iter().flat_map(|a| second.iter().map(|b| [*a, *b, 0.0, 0.0]));
    pairs.map(|all| all[..form.params.len()].to_vec()).collect()
}

/// A fit on whole runs, from where it was.
fn once(whole: &Bench, fit: &Fit, of: &[usize]) -> Fit {
    let start = evaluate(whole, &fit.added, fit.x.clone(), of);
    let found = approach(whole, start.clone(), of, &SCHEDULE);
    start.or_better(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::fit_specs;

    #[test]
    fn every_form_starts_from_places_with_a_number_for_each_of_its_parameters() {
        // Five severities (four where it has a sign) by four second parameters, or by one where there is no second.
        for form in fit_specs().iter().flat_map(|spec| spec.forms) {
            let points = scattered(form);
            let signed = form.params[0].spread.is_signed();
            let expected = (5 - usize::from(signed)) * if form.params.len() > 1 { 4 } else { 1 };
            assert_eq!(points.len(), expected, "{}", form.name);
            assert!(points.iter().all(|x| x.len() == form.params.len()), "{}", form.name);
        }
    }
}
