//! How far the gap shrinks: the recalibrated model and the likeliest causes on runs that no fit has seen.

use super::best_cause;
use crate::gap::decide::{self, Cause, Weighed, JUDGED};
use crate::gap::fit::evaluate;
use crate::gap::held_out;
use crate::gap::hypotheses::{Fits, Hypothesis};
use crate::gap::problem::{Bench, Residuals};

/// The gap on the held-out runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// G with the datasheet's values.
    pub nominal: f64,
    /// G after recalibration.
    pub recalibrated: f64,
    /// G with the most probable effect.
    pub with_effect: f64,
    /// Share of the closable gap that the effect closes: value, 5 % and 95 %.
    pub closed: [f64; 3],
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

/// Residuals of a hypothesis on the runs `of`.
pub(super) fn at(bench: &Bench, hypothesis: &Hypothesis, of: &[usize]) -> Residuals {
    evaluate(bench, &hypothesis.fit.added, hypothesis.fit.x.clone(), of).residuals
}

/// The gap on the runs `judged`, and the closed fraction of every cause in `weighed` that is judged.
pub(super) fn how_far(
    bench: &Bench,
    fits: &Fits,
    weighed: &[Weighed],
    judged: &[usize],
    seed: u64,
) -> (Gap, Vec<Option<f64>>) {
    let of = |h: &Hypothesis| held_out::squares(bench, &at(bench, h, judged), judged);
    let nominal = evaluate(bench, &[], vec![0.0; bench.base_size()], judged).residuals;
    let nominal = held_out::squares(bench, &nominal, judged);
    let base = of(&fits.base);
    let best = best_cause(weighed);
    let mut judged_so_far = 0;
    let squares: Vec<Option<Vec<f64>>> = weighed
        .iter()
        .map(|w| {
            let own = w.cause.is_fitted();
            judged_so_far += usize::from(own);
            (own && judged_so_far <= JUDGED).then(|| of(decide::fit_of(fits, &w.cause)))
        })
        .collect();
    let place = weighed.iter().position(|w| w.cause == best);
    let with = place.and_then(|k| squares[k].clone()).unwrap_or_else(|| base.clone());
    let mut others: Vec<f64> = weighed
        .iter()
        .zip(&squares)
        .filter(|(w, _)| w.cause != best && matches!(w.cause, Cause::Single(_)))
        .filter_map(|(_, s)| s.as_ref().map(|s| held_out::closed(&base, s)))
        .collect();
    others.sort_by(f64::total_cmp);
    let (lo, hi) = held_out::interval(&base, &with, seed);
    let gap = Gap {
        nominal: held_out::gap(&nominal),
        recalibrated: held_out::gap(&base),
        with_effect: held_out::gap(&with),
        closed: [held_out::closed(&base, &with), lo, hi],
        sham: others.get(others.len() / 2).copied().unwrap_or(0.0),
        held_out: judged.to_vec(),
    };
    let closed = squares.iter().map(|s| s.as_ref().map(|s| held_out::closed(&base, s))).collect();
    (gap, closed)
}
