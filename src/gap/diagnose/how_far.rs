//! How far the gap shrinks: the recalibrated model and the likeliest causes on runs that no fit has seen.

use super::best_cause;
use crate::gap::decide::{self, Cause, Weighed, JUDGED};
use crate::gap::fit::evaluate;
use crate::gap::held_out::{self, Paired, Shrinkage};
use crate::gap::hypotheses::{Fits, Hypothesis};
use crate::gap::problem::{Bench, Residuals};
use crate::metrics::median;

/// The gap on the held-out runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// G with the datasheet's values.
    pub nominal: f64,
    /// G after recalibration.
    pub recalibrated: f64,
    /// G with the most probable effect.
    pub with_effect: f64,
    /// Share of the closable gap that the effect is expected to close on further runs: value, 5 % and 95 %.
    pub closed: [f64; 3],
    /// What it closes on the held-out runs alone.
    pub closed_unseen: f64,
    /// The same of a sham: the median over the other causes that were judged.
    pub sham: f64,
    /// The runs, by index.
    pub held_out: Vec<usize>,
}

impl Gap {
    /// The closed fraction and its interval: `62 % [35 %, 80 %]`.
    pub fn closed_in_words(&self) -> String {
        let [value, lo, hi] = self.closed.map(|x| format!("{:.0} %", 100.0 * x));
        format!("{value} [{lo}, {hi}]")
    }
}

/// Residuals of a hypothesis on the runs `of`; those of its fit where `bench` has fitted it there.
pub(super) fn at(bench: &Bench, hypothesis: &Hypothesis, of: &[usize]) -> Residuals {
    let Hypothesis { fit, look, .. } = hypothesis;
    if *look == bench.look() && of.iter().all(|r| !fit.residuals[*r].is_empty()) {
        return fit.residuals.clone();
    }
    evaluate(bench, &fit.added, fit.x.clone(), of).residuals
}

/// The runs on which causes are judged.
pub(super) struct Judged {
    /// Those that no fit has seen; all where none is held out.
    pub unseen: Vec<usize>,
    /// Those that were fitted; none where none is held out.
    pub seen: Vec<usize>,
}

/// The gap on the runs `judged`, and how every cause in `weighed` does on them that is judged.
pub(super) fn how_far(
    bench: &Bench,
    fits: &Fits,
    weighed: &[Weighed],
    judged: &Judged,
    seed: u64,
) -> (Gap, Vec<Option<Shrinkage>>) {
    let both = [&judged.unseen, &judged.seen];
    let of = |h: &Hypothesis| both.map(|runs| held_out::squares(bench, &at(bench, h, runs), runs));
    let nominal = evaluate(bench, &[], vec![0.0; bench.base_size()], &judged.unseen).residuals;
    let nominal = held_out::squares(bench, &nominal, &judged.unseen);
    let base = of(&fits.base);
    let against_base = |[unseen, seen]: [Vec<f64>; 2]| {
        let pair = |k: usize, after| Paired { before: base[k].clone(), after };
        Shrinkage { unseen: pair(0, unseen), seen: pair(1, seen) }
    };
    let fitted: Vec<&Cause> =
        weighed.iter().map(|w| &w.cause).filter(|c| c.is_fitted()).take(JUDGED).collect();
    let judge = |w: &Weighed| {
        let is_judged = fitted.contains(&&w.cause);
        is_judged.then(|| against_base(of(decide::fit_of(fits, &w.cause))))
    };
    let shrinkages: Vec<Option<Shrinkage>> = weighed.iter().map(judge).collect();
    let best = best_cause(weighed);
    let place = weighed.iter().position(|w| w.cause == best);
    let found =
        place.and_then(|k| shrinkages[k].clone()).unwrap_or_else(|| against_base(base.clone()));
    let (lo, hi) = found.interval(seed);
    let gap = Gap {
        nominal: held_out::gap(&nominal),
        recalibrated: held_out::gap(&found.unseen.before),
        with_effect: held_out::gap(&found.unseen.after),
        closed: [found.expected(), lo, hi],
        closed_unseen: found.unseen.closed(),
        sham: sham(weighed, &shrinkages, &best),
        held_out: judged.unseen.clone(),
    };
    (gap, shrinkages)
}

/// Median over the single effects but the best cause of what they close.
fn sham(weighed: &[Weighed], shrinkages: &[Option<Shrinkage>], best: &Cause) -> f64 {
    let others = weighed
        .iter()
        .zip(shrinkages)
        .filter(|(w, _)| w.cause != *best && matches!(w.cause, Cause::Single(_)))
        .filter_map(|(_, found)| found.as_ref().map(Shrinkage::expected))
        .collect();
    median(others).unwrap_or(0.0)
}
