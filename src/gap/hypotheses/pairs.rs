//! Two effects at once.

use super::single::start_effect;
use super::{full_jacobian, level, ranked, Hypothesis, Method};
use crate::gap::fit::{approach, evaluate, FINE};
use crate::gap::problem::{Bench, Choice};
use crate::gap::symmetry::{self, Finding};

/// Level of a single effect below which there is nothing left for a second one.
const LITTLE: f64 = 1.2;
/// Pairs that are kept.
const PAIRED: usize = 3;
/// Pairs that are fitted further.
const DEEPENED: usize = 3;
/// Share of its level below which an effect is another start for pairs.
const MUCH_BETTER: f64 = 0.9;

/// Pairs of the best effect, the best first; that effect alone once more from its best pair; and where this made it much
/// better, the pairs once more, because they began where it is no longer.
pub(super) fn pairs_and_alone(
    bench: &Bench,
    singles: &mut [Hypothesis],
    findings: &[Finding],
    of: &[usize],
    method: Method,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Vec<Hypothesis> {
    let mut found = pairs(bench, singles, findings, of, method, progress);
    let Some(pair) = found.first() else { return found };
    progress(0.94, "the best effect once more, from what its pair found");
    let before = best_level(singles);
    alone(bench, pair, singles, of);
    if best_level(singles) < MUCH_BETTER * before {
        let again = |_: f64, what: &str| progress(0.94, what);
        found.extend(pairs(bench, singles, findings, of, method, &again));
        found.sort_by(|a, b| a.level.total_cmp(&b.level));
        let mut seen = Vec::new();
        found.retain(|pair| {
            let second = pair.fit.added[1].effect;
            let new = !seen.contains(&second);
            seen.push(second);
            new
        });
    }
    found
}

fn best_level(hypotheses: &[Hypothesis]) -> f64 {
    hypotheses.iter().map(|h| h.level).fold(f64::INFINITY, f64::min)
}

/// The first effect of a pair from where the pair has left the block: a pair must not take credit
/// for an optimum that its first effect alone has missed.
fn alone(bench: &Bench, pair: &Hypothesis, singles: &mut [Hypothesis], of: &[usize]) {
    let added = vec![pair.fit.added[0]];
    let x = pair.fit.x[..bench.coordinates(&added).len()].to_vec();
    let fit = approach(bench, evaluate(bench, &added, x, of), of, &FINE);
    for single in singles.iter_mut().filter(|s| s.fit.added[0].effect == added[0].effect) {
        single.take_better(bench, fit.clone(), of);
        single.deepen(bench, of);
    }
}

/// The best effect with every other that the symmetries allow beside it, then once more the best
/// of these pairs.
fn pairs(
    bench: &Bench,
    singles: &mut [Hypothesis],
    findings: &[Finding],
    of: &[usize],
    method: Method,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Vec<Hypothesis> {
    let possible = symmetry::possible(findings);
    let Some(first) = ranked(singles).into_iter().find(|at| possible[*at]) else {
        return Vec::new();
    };
    if singles[first].level < LITTLE {
        return Vec::new();
    }
    // Equal effort: what a pair is given more rounds for, its first effect alone is given as well.
    singles[first].deepen(bench, of);
    let mut from = singles[first].fit.clone();
    if from.jacobian.is_none() {
        from.jacobian = Some(full_jacobian(bench, &from, of));
    }
    let against = |e: usize| symmetry::contradictions(findings, &[from.added[0].effect, e]);
    let others = (0..singles.len()).filter(|e| *e != from.added[0].effect);
    let least = others.clone().map(against).min().unwrap_or(0);
    let mut out = Vec::new();
    for effect in others.filter(|e| against(*e) == least) {
        progress(0.82 + 0.01 * effect as f64, "fitting pairs");
        let choice = Choice { effect, form: singles[effect].fit.added[0].form };
        let (found, _) = start_effect(bench, &from, choice, of, method);
        out.push(level(bench, found, of));
    }
    for at in ranked(&out).into_iter().take(DEEPENED) {
        out[at].deepen(bench, of);
    }
    out.sort_by(|a, b| a.level.total_cmp(&b.level));
    out.truncate(PAIRED);
    // Equal effort once more: the first effect alone was searched for.
    let single = singles[first].fit.objective;
    let open = |pair: &&mut Hypothesis| {
        pair.fit.objective < MUCH_BETTER * single && !pair.fit.is_settled(bench, of)
    };
    if let Some(pair) = out.first_mut().filter(open) {
        progress(0.93, "searching around the best pair");
        pair.search(bench, of);
    }
    out
}
