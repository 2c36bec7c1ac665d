//! The probabilities once more, from runs that no fit has seen.

use super::calibration::{
    ALIKE, ALIKE_CLOSED, ALIKE_NATS, FIRST_HELD_OUT, LEAST_LEFT, SECOND_HELD_OUT, SURENESS,
};
use super::decide::{evidence, fit_of, normalised, Cause, Weighed};
use super::hypotheses::Fits;

/// The probabilities once more, from the share of the gap that the likeliest causes close on runs that no fit has seen
/// (`closed`, cause by cause).
///
/// An effect that takes more off the fitted runs than off those leaves as much to chance, which is no effect at all. A
/// second effect that only follows the fitted runs closes nothing more there than the first one alone; and two effects
/// that close the same there are told apart by the fitted runs by little, since an effect with more parameters follows
/// what the fits' mesh does to another.
pub fn second_look(fits: &Fits, weighed: &[Weighed], closed: &[Option<f64>]) -> Vec<Weighed> {
    let mut out = weighed.to_vec();
    for (w, gain) in out.iter_mut().zip(gains(fits, weighed, closed)) {
        w.probability *= (SURENESS * gain).exp();
    }
    if let Some(none) = out.iter_mut().find(|w| w.cause == Cause::None) {
        none.probability *= (SURENESS * by_chance(fits, weighed, closed)).exp();
    }
    if let Some((likelier, other)) = alike(weighed, closed) {
        let (sum, odds) =
            (out[likelier].probability + out[other].probability, (SURENESS * ALIKE_NATS).exp());
        let most = sum * odds / (1.0 + odds);
        if out[likelier].probability > most {
            (out[likelier].probability, out[other].probability) = (most, sum - most);
        }
    }
    normalised(out)
}

/// Share of the gap that a cause leaves.
fn left(closed: f64) -> f64 {
    (1.0 - closed).max(LEAST_LEFT)
}

/// Nats of each pair from what it closes beyond its first effect; 0 for other causes.
fn gains(fits: &Fits, weighed: &[Weighed], closed: &[Option<f64>]) -> Vec<f64> {
    let of_first = |pair: usize| {
        let first = fits.pairs[pair].fit.added[0].effect;
        let is = |c: &Cause| matches!(c, Cause::Single(k) if fits.singles[*k].fit.added[0].effect == first);
        closed[weighed.iter().position(|w| is(&w.cause))?]
    };
    let gain = |(w, both): (&Weighed, &Option<f64>)| match w.cause {
        Cause::Pair(pair) => Some(SECOND_HELD_OUT * (left(of_first(pair)?) / left((*both)?)).ln()),
        _ => None,
    };
    weighed.iter().zip(closed).map(|case| gain(case).unwrap_or(0.0)).collect()
}

/// Nats that the likeliest judged cause takes off the fitted runs beyond what any of them earns on unseen ones.
fn by_chance(fits: &Fits, weighed: &[Weighed], closed: &[Option<f64>]) -> f64 {
    let base = evidence(fits.base.level);
    let judged = || weighed.iter().zip(closed).filter_map(|(w, c)| Some((&w.cause, (*c)?)));
    let taken = |cause: &Cause| evidence(fit_of(fits, cause).level) - base;
    let earned = |(cause, c): (&Cause, f64)| taken(cause).min(-FIRST_HELD_OUT * left(c).ln());
    let most = judged().map(earned).fold(0.0, f64::max);
    judged().next().map_or(0.0, |(likeliest, _)| (taken(likeliest) - most).max(0.0))
}

/// The two likeliest single effects, if unseen runs do not tell them apart.
fn alike(weighed: &[Weighed], closed: &[Option<f64>]) -> Option<(usize, usize)> {
    let mut singles = weighed.iter().zip(closed).enumerate().filter_map(|(at, (w, closed))| {
        matches!(w.cause, Cause::Single(_)).then_some(())?;
        Some((at, (*closed)?))
    });
    let ((first, a), (second, b)) = (singles.next()?, singles.next()?);
    let same = (left(a) / left(b)).ln().abs() < ALIKE && a.min(b) >= ALIKE_CLOSED;
    same.then_some((first, second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::calibration::SHARPNESS;
    use crate::gap::decide::tests::{at, fits};
    use crate::gap::decide::weigh;
    use crate::gap::problem::Choice;

    /// Probability of one cause over that of another.
    fn odds_of(weighed: &[Weighed], a: &Cause, b: &Cause) -> f64 {
        let share = |c: &Cause| weighed.iter().find(|w| w.cause == *c).unwrap().probability;
        share(a) / share(b)
    }

    /// Closed fractions cause by cause, of two that were judged.
    fn closed_by(weighed: &[Weighed], judged: [(Cause, f64); 2]) -> Vec<Option<f64>> {
        let of = |w: &Weighed| judged.iter().find(|j| j.0 == w.cause).map(|j| j.1);
        weighed.iter().map(of).collect()
    }

    /// An effect of the list.
    fn choice(effect: usize) -> Choice {
        Choice { effect, form: 0 }
    }

    #[test]
    fn a_pair_gains_by_what_it_closes_beyond_its_first_effect_on_unseen_runs() {
        // Left 0.25 instead of 0.75: 4 ln 3 nats, by the common factor of all log odds.
        let mut fits = fits(8.0, &[1.4, 6.0]);
        fits.singles[0].fit.added = vec![choice(0)];
        fits.singles[1].fit.added = vec![choice(1)];
        let mut pair = at(0.9);
        pair.fit.added = vec![choice(0), choice(1)];
        fits.pairs = vec![pair];
        let weighed = weigh(&fits);
        let odds = |of: &[Weighed]| odds_of(of, &Cause::Pair(0), &Cause::Single(0));
        let closed = |alone: f64, both: f64| {
            closed_by(&weighed, [(Cause::Single(0), alone), (Cause::Pair(0), both)])
        };
        let more = second_look(&fits, &weighed, &closed(0.25, 0.75));
        let gained = (odds(&more) / odds(&weighed)).ln();
        assert!((gained - SURENESS * SECOND_HELD_OUT * 3.0_f64.ln()).abs() < 1e-9, "{gained}");
        let same = second_look(&fits, &weighed, &closed(0.8, 0.8));
        assert!((odds(&same) / odds(&weighed) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn two_effects_that_close_the_same_on_unseen_runs_are_half_a_nat_apart_at_most() {
        let fits = fits(8.0, &[0.5, 1.3, 6.0]);
        let weighed = weigh(&fits);
        let closed =
            |a: f64, b: f64| closed_by(&weighed, [(Cause::Single(0), a), (Cause::Single(1), b)]);
        let odds = |of: &[Weighed]| odds_of(of, &Cause::Single(0), &Cause::Single(1));
        let alike = second_look(&fits, &weighed, &closed(0.97, 0.99));
        assert!((odds(&alike).ln() - SURENESS * ALIKE_NATS).abs() < 1e-9, "{}", odds(&alike));
        let apart = second_look(&fits, &weighed, &closed(0.97, 0.6));
        assert!((odds(&apart) / odds(&weighed) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_an_effect_takes_off_fitted_runs_alone_speaks_for_none() {
        // Level 1.4 to 0.8 is 9 ln(1.65/1.05) nats for the effect; an unseen tenth is worth 9 ln(1/0.9) of them.
        let fits = fits(1.4, &[0.8, 1.3]);
        let weighed = weigh(&fits);
        let odds = |of: &[Weighed]| odds_of(of, &Cause::None, &Cause::Single(0));
        let seen = SHARPNESS * (1.65_f64 / 1.05).ln();
        let gained = |closed: f64| {
            let judged = closed_by(&weighed, [(Cause::Single(0), closed), (Cause::Single(1), 0.0)]);
            (odds(&second_look(&fits, &weighed, &judged)) / odds(&weighed)).ln() / SURENESS
        };
        assert!((gained(0.1) - seen - FIRST_HELD_OUT * 0.9_f64.ln()).abs() < 1e-9);
        assert!(gained(0.6).abs() < 1e-9);
    }
}
