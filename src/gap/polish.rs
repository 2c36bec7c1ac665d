//! The most probable causes once more, on whole runs: the fits before look at the first milliseconds,
//! where parameters act without jumps; what a repaired model is used for is the settled vibration.

use super::campaign::Campaign;
use super::decide::{self, Cause, Weighed};
use super::fit::{approach, evaluate, Effort, Fit};
use super::guess::starts;
use super::hypotheses::{effort, Fits};
use super::problem::{Bench, Choice, Look};
use super::road::{self, Waved};
use crate::error::Fault;

/// Causes with a fit of their own that are polished.
const POLISHED: usize = 2;
/// From the optimum of the starts to that of whole runs: soft first, as cycles jump.
const SCHEDULE: [Effort; 2] = [effort(3, 9, 4.0, None), effort(5, 9, 1.0, None)];
/// The best cause with a Jacobian of its new place, and the base model from its nuisance parameters: equal
/// effort.
const CROSS: [Effort; 1] = [effort(4, 4, 1.0, None)];

/// Most Jacobians of the likeliest cause and of the base model.
const ROUNDS: usize = 4;
/// Share of its objective that a round has to gain to be followed by another.
const GAINED: f64 = 0.01;
/// Severities from which another form is started.
const STARTED: usize = 4;

/// Refits the base model and the most probable causes on the whole runs `of`; `whole` looks at all of
/// them. A fit that does not get better there is kept as it was. Levels stay those of the starts.
///
/// # Errors
/// What stops the reduction of the block.
pub fn polish(
    campaign: &Campaign,
    whole: &mut Bench,
    fits: &mut Fits,
    weighed: &[Weighed],
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<(), Fault> {
    debug_assert!(whole.look() == Look::Whole);
    let own = |w: &&Weighed| matches!(w.cause, Cause::Single(_) | Cause::Pair(_));
    let causes: Vec<Cause> =
        weighed.iter().filter(own).take(POLISHED).map(|w| w.cause.clone()).collect();
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
        if rank == 0 {
            found = other_forms(whole, found, of);
            found = settled(whole, found, of);
            let x = found.x[..base.x.len()].to_vec();
            let again = approach(whole, evaluate(whole, &[], x, of), of, &CROSS);
            base = settled(whole, base.or_better(again), of);
        }
        hypothesis.added.clone_from(&found.added);
        hypothesis.fit = found;
        hypothesis.look = Look::Whole;
    }
    fits.base.fit = base;
    fits.base.look = Look::Whole;
    if let Some(cause) = causes.first() {
        waved(campaign, whole, fits, cause, of, progress)?;
    }
    Ok(())
}

/// A fit on whole runs, from where it was.
fn once(whole: &Bench, fit: &Fit, of: &[usize]) -> Fit {
    let start = evaluate(whole, &fit.added, fit.x.clone(), of);
    let found = approach(whole, start.clone(), of, &SCHEDULE);
    start.or_better(found)
}

/// The other forms of a single cause, from the nuisance parameters of the one that did best on the starts: some
/// differ only where a run has settled.
fn other_forms(whole: &Bench, found: Fit, of: &[usize]) -> Fit {
    let [choice] = found.added[..] else { return found };
    let size = whole.base_size();
    let mut best = found.clone();
    for form in (0..whole.specs[choice.effect].telling()).filter(|form| *form != choice.form) {
        let added = vec![Choice { effect: choice.effect, form }];
        let begun = starts(whole, &added, &found.x[..size])
            .into_iter()
            .take(STARTED)
            .map(|x| evaluate(whole, &added, x, of))
            .reduce(Fit::or_better);
        if let Some(fit) = begun {
            best = best.or_better(approach(whole, fit, of, &SCHEDULE));
        }
    }
    best
}

/// The optimum, with Jacobians of its own until nothing is gained any more.
fn settled(whole: &Bench, mut fit: Fit, of: &[usize]) -> Fit {
    for _ in 0..ROUNDS {
        let before = fit.objective;
        let again = approach(whole, Fit { jacobian: None, ..fit.clone() }, of, &CROSS);
        fit = fit.or_better(again);
        if fit.objective > (1.0 - GAINED) * before {
            break;
        }
    }
    fit
}

/// The likeliest cause with the waves of the road, if it is a texture, and all that is compared with it on the mesh
/// that the waves need.
fn waved(
    campaign: &Campaign,
    whole: &mut Bench,
    fits: &mut Fits,
    cause: &Cause,
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<(), Fault> {
    let hypothesis = decide::fit_of(fits, cause).clone();
    let found = road::waves(campaign, whole, &hypothesis, &fits.base.fit, of, progress)?;
    let Some(Waved { whole: fine, fit }) = found else { return Ok(()) };
    let anew = |fit: &Fit| evaluate(&fine, &fit.added, fit.x.clone(), of);
    let before = anew(&hypothesis.fit);
    if fit.objective >= before.objective {
        return Ok(());
    }
    let size = fine.base_size();
    let from_waves = evaluate(&fine, &[], fit.x[..size].to_vec(), of);
    let base = anew(&fits.base.fit).or_better(approach(&fine, from_waves, of, &CROSS));
    fits.base.fit = base;
    let slot = match cause {
        Cause::Single(k) => &mut fits.singles[*k],
        Cause::Pair(k) => &mut fits.pairs[*k],
        _ => return Ok(()),
    };
    slot.added.clone_from(&fit.added);
    slot.fit = fit;
    *whole = fine;
    Ok(())
}
