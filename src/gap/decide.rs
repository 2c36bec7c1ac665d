//! From fits to probabilities and a decision.

use super::calibration::{
    ALIKE, ALIKE_CLOSED, ALIKE_NATS, BLUR, CLASS_FROM, CLASS_SIZE, CONTRADICTION, GOOD, INADEQUATE,
    KNOWN_BREAKER, LEAST_LEFT, NAME_FROM, NO_GAP, PRIOR_NONE, PRIOR_PAIR, PRIOR_UNKNOWN,
    SECOND_HELD_OUT, SHARPNESS, SURENESS, TEXTURE_ALLOWANCE, UNKNOWN_LEAVES,
};
use super::hypotheses::{Fits, Hypothesis};
use super::problem::Bench;
use super::symmetry;
use crate::effects::fit_specs;

/// So many of the most probable causes with a fit of their own are polished on whole runs and judged on those that no fit
/// has seen.
pub const JUDGED: usize = 2;

/// What a probability belongs to.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// No effect.
    None,
    /// An effect that is not in the list.
    Unknown,
    /// Effect number of `Fits::singles`.
    Single(usize),
    /// Pair number of `Fits::pairs`.
    Pair(usize),
}

impl Cause {
    /// Does it have a fit of its own, beside that of the base model?
    pub const fn is_fitted(&self) -> bool {
        matches!(self, Self::Single(_) | Self::Pair(_))
    }
}

/// A cause with its probability.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighed {
    /// The cause.
    pub cause: Cause,
    /// Its probability.
    pub probability: f64,
}

/// Kind of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// No gap above the floor.
    None,
    /// One cause is named.
    Named,
    /// One of a few causes that the data cannot tell apart.
    Class,
    /// None of the candidates.
    Unknown,
    /// Nothing can be said.
    Undecidable,
}

impl Kind {
    /// Name in the results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Named => "named",
            Self::Class => "class",
            Self::Unknown => "unknown",
            Self::Undecidable => "undecidable",
        }
    }

    /// Exit code of the command.
    pub const fn exit_code(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Named => 10,
            Self::Class => 11,
            Self::Unknown | Self::Undecidable => 12,
        }
    }
}

/// The decision.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Kind.
    pub kind: Kind,
    /// Effects named.
    pub effects: Vec<String>,
    /// Module of the model where the gap lies.
    pub module: Option<String>,
}

/// Evidence of a level (objective over sum of weights), in nats.
pub fn evidence(level: f64) -> f64 {
    -SHARPNESS * (level + BLUR).ln()
}

/// Share of the level that an effect answers for: a road is not the sine of its fit.
fn allowed(single: &Hypothesis) -> f64 {
    let textured = |c: &super::problem::Choice| fit_specs()[c.effect].effect == "road_texture";
    if single.added.iter().any(textured) {
        TEXTURE_ALLOWANCE
    } else {
        1.0
    }
}

/// Probabilities of all causes, most probable first.
pub fn weigh(fits: &Fits) -> Vec<Weighed> {
    let base = fits.base.level;
    let against = |h: &Hypothesis| {
        let effects: Vec<usize> = h.added.iter().map(|c| c.effect).collect();
        CONTRADICTION * symmetry::contradictions(&fits.findings, &effects) as f64
    };
    let inadequate = INADEQUATE * (base / GOOD).ln().max(0.0);
    let mut nats =
        vec![(Cause::None, evidence(base) + PRIOR_NONE - inadequate - against(&fits.base))];
    let known = KNOWN_BREAKER * symmetry::known(&fits.findings) as f64;
    let left = (base + BLUR).ln().max(0.0) * UNKNOWN_LEAVES;
    nats.push((Cause::Unknown, -SHARPNESS * left + PRIOR_UNKNOWN - known));
    for (k, single) in fits.singles.iter().enumerate() {
        nats.push((Cause::Single(k), evidence(allowed(single) * single.level) - against(single)));
    }
    for (k, pair) in fits.pairs.iter().enumerate() {
        nats.push((Cause::Pair(k), evidence(pair.level) + PRIOR_PAIR - against(pair)));
    }
    let highest = nats.iter().map(|n| n.1).fold(f64::NEG_INFINITY, f64::max);
    let odds = |n: f64| (SURENESS * (n - highest)).exp();
    normalised(nats.into_iter().map(|(cause, n)| Weighed { cause, probability: odds(n) }).collect())
}

/// Odds as probabilities that sum to one, most probable first.
fn normalised(mut out: Vec<Weighed>) -> Vec<Weighed> {
    let total: f64 = out.iter().map(|w| w.probability).sum();
    out.iter_mut().for_each(|w| w.probability /= total);
    out.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    out
}

/// The probabilities once more, from the share of the gap that the likeliest causes close on runs that no fit has seen
/// (`closed`, cause by cause).
///
/// A second effect that only follows the fitted runs closes nothing more there than the first one alone; and two effects
/// that close the same there are told apart by the fitted runs by little, since an effect with more parameters follows
/// what the fits' mesh does to another.
pub fn second_look(fits: &Fits, weighed: &[Weighed], closed: &[Option<f64>]) -> Vec<Weighed> {
    let mut out = weighed.to_vec();
    for (w, gain) in out.iter_mut().zip(gains(fits, weighed, closed)) {
        w.probability *= (SURENESS * gain).exp();
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
        let first = fits.pairs[pair].added[0].effect;
        let is =
            |c: &Cause| matches!(c, Cause::Single(k) if fits.singles[*k].added[0].effect == first);
        closed[weighed.iter().position(|w| is(&w.cause))?]
    };
    let gain = |(w, both): (&Weighed, &Option<f64>)| match w.cause {
        Cause::Pair(pair) => Some(SECOND_HELD_OUT * (left(of_first(pair)?) / left((*both)?)).ln()),
        _ => None,
    };
    weighed.iter().zip(closed).map(|case| gain(case).unwrap_or(0.0)).collect()
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

/// Names of the effects of a cause.
pub fn names(bench: &Bench, fits: &Fits, cause: &Cause) -> Vec<String> {
    let of =
        |h: &Hypothesis| h.added.iter().map(|c| bench.specs[c.effect].effect.to_string()).collect();
    match cause {
        Cause::None => Vec::new(),
        Cause::Unknown => vec!["unknown".to_string()],
        Cause::Single(k) => of(&fits.singles[*k]),
        Cause::Pair(k) => of(&fits.pairs[*k]),
    }
}

/// The same as people read it: `adhesion + worn_edge`, or `none`.
pub fn label(bench: &Bench, fits: &Fits, cause: &Cause) -> String {
    match names(bench, fits, cause) {
        names if names.is_empty() => "none".to_string(),
        names => names.join(" + "),
    }
}

/// The fit of a cause; the base model where there is none.
pub fn fit_of<'a>(fits: &'a Fits, cause: &Cause) -> &'a Hypothesis {
    match cause {
        Cause::None | Cause::Unknown => &fits.base,
        Cause::Single(k) => &fits.singles[*k],
        Cause::Pair(k) => &fits.pairs[*k],
    }
}

/// The decision from the probabilities.
pub fn decide(bench: &Bench, fits: &Fits, weighed: &[Weighed]) -> Decision {
    let Some(first) = weighed.first() else {
        return Decision { kind: Kind::Undecidable, effects: Vec::new(), module: None };
    };
    let module = best_module(bench, fits);
    let small = fits.base.level < NO_GAP;
    match &first.cause {
        Cause::None => return Decision { kind: Kind::None, effects: Vec::new(), module: None },
        Cause::Unknown if first.probability >= 0.5 => {
            return Decision { kind: Kind::Unknown, effects: vec!["unknown".into()], module };
        }
        cause if first.probability >= NAME_FROM && *cause != Cause::Unknown && !small => {
            return Decision { kind: Kind::Named, effects: names(bench, fits, cause), module };
        }
        _ => {}
    }
    let (mut effects, mut sum, mut taken) = (Vec::new(), 0.0, 0);
    for w in weighed {
        if sum >= CLASS_FROM || taken == CLASS_SIZE {
            break;
        }
        sum += w.probability;
        taken += 1;
        for name in names(bench, fits, &w.cause) {
            if !effects.contains(&name) {
                effects.push(name);
            }
        }
    }
    Decision { kind: Kind::Class, effects, module }
}

/// The module of the best single effect.
fn best_module(bench: &Bench, fits: &Fits) -> Option<String> {
    modules(bench, fits)
        .into_iter()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|m| m.1 > 0.0)
        .map(|m| m.0)
}

/// Share of the explicable gap per module: what the best effect of the module takes off ln(G²).
pub fn modules(bench: &Bench, fits: &Fits) -> Vec<(String, f64)> {
    let mut out: Vec<(String, f64)> = ["dynamic", "friction", "contact", "wear", "rig", "sensor"]
        .iter()
        .map(|m| (m.to_string(), 0.0))
        .collect();
    let base = (fits.base.level + BLUR).ln();
    for single in &fits.singles {
        let module = bench.specs[single.added[0].effect].module.name();
        let gain = (base - (single.level + BLUR).ln()).max(0.0);
        if let Some(slot) = out.iter_mut().find(|m| m.0 == module) {
            slot.1 = slot.1.max(gain);
        }
    }
    let total: f64 = out.iter().map(|m| m.1).sum();
    if total > 0.0 {
        out.iter_mut().for_each(|m| m.1 /= total);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::fit::Fit;
    use crate::gap::problem::{Choice, Look};

    fn at(level: f64) -> Hypothesis {
        let fit = Fit {
            added: Vec::new(),
            x: Vec::new(),
            residuals: Vec::new(),
            objective: level,
            jacobian: None,
        };
        Hypothesis { added: Vec::new(), fit, level, look: Look::Fit }
    }

    fn fits(base: f64, singles: &[f64]) -> Fits {
        let singles = singles.iter().map(|l| at(*l)).collect();
        Fits {
            base: at(base),
            singles,
            pairs: Vec::new(),
            response: Vec::new(),
            findings: Vec::new(),
        }
    }

    #[test]
    fn without_a_gap_none_is_most_probable() {
        assert_eq!(weigh(&fits(1.0, &[0.97, 0.99]))[0].cause, Cause::None);
    }

    #[test]
    fn an_effect_that_closes_the_gap_is_most_probable() {
        let weighed = weigh(&fits(8.0, &[1.2, 6.0, 7.0]));
        assert_eq!(weighed[0].cause, Cause::Single(0));
        assert!(weighed[0].probability > 0.9);
    }

    #[test]
    fn a_gap_that_nothing_closes_is_unknown() {
        assert_eq!(weigh(&fits(8.0, &[7.5, 7.0, 7.9]))[0].cause, Cause::Unknown);
    }

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
        fits.singles[0].added = vec![choice(0)];
        fits.singles[1].added = vec![choice(1)];
        let mut pair = at(0.9);
        pair.added = vec![choice(0), choice(1)];
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
    fn probabilities_sum_to_one() {
        let sum: f64 = weigh(&fits(3.0, &[2.0, 1.0])).iter().map(|w| w.probability).sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }
}
