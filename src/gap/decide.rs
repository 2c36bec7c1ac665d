//! From fits to probabilities and a decision.

use super::calibration::{
    BLUR, CLASS_FROM, CLASS_SIZE, CONTRADICTION, GOOD, INADEQUATE, KNOWN_BREAKER, NAME_FROM,
    NO_GAP, PRIOR_NONE, PRIOR_PAIR, PRIOR_UNKNOWN, SHARPNESS, SURENESS, TEXTURE_ALLOWANCE,
    UNKNOWN_LEAVES,
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
    if single.fit.added.iter().any(textured) {
        TEXTURE_ALLOWANCE
    } else {
        1.0
    }
}

/// Probabilities of all causes, most probable first.
pub fn weigh(fits: &Fits) -> Vec<Weighed> {
    let base = fits.base.level;
    let against = |h: &Hypothesis| {
        let effects: Vec<usize> = h.fit.added.iter().map(|c| c.effect).collect();
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
pub(super) fn normalised(mut out: Vec<Weighed>) -> Vec<Weighed> {
    let total: f64 = out.iter().map(|w| w.probability).sum();
    out.iter_mut().for_each(|w| w.probability /= total);
    out.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    out
}

/// Names of the effects of a cause.
pub fn names(bench: &Bench, fits: &Fits, cause: &Cause) -> Vec<String> {
    let of = |h: &Hypothesis| {
        h.fit.added.iter().map(|c| bench.specs[c.effect].effect.to_string()).collect()
    };
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
        let module = bench.specs[single.fit.added[0].effect].module.name();
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
pub(super) mod tests {
    use super::*;
    use crate::gap::fit::Fit;
    use crate::gap::problem::Look;

    pub(in crate::gap) fn at(level: f64) -> Hypothesis {
        let fit = Fit {
            added: Vec::new(),
            x: Vec::new(),
            residuals: Vec::new(),
            objective: level,
            jacobian: None,
            is_at_end: false,
        };
        Hypothesis { fit, level, look: Look::Fit }
    }

    pub(in crate::gap) fn fits(base: f64, singles: &[f64]) -> Fits {
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

    #[test]
    fn probabilities_sum_to_one() {
        let sum: f64 = weigh(&fits(3.0, &[2.0, 1.0])).iter().map(|w| w.probability).sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }
}
