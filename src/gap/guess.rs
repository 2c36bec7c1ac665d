//! Where fits begin: from the datasheet, for the base model and for every effect alike.

use super::campaign::RunKind;
use super::fit::{approach, evaluate, evaluate_all, Effort, Fit, SETTLED};
use super::hypotheses::{effort, Method};
use super::noise::Noise;
use super::problem::{Bench, Choice};
use super::symmetry::{self, Finding};
use crate::effects::Module;
use crate::error::Fault;

/// Whitened severities from which an effect is started.
const STARTS: [f64; 3] = [-1.2, 0.3, 1.2];
/// The same where it has a sign: a pressure field that is tilted far lies behind a worse one.
const SIGNED: [f64; 6] = [-0.7, 0.7, -1.3, 1.3, -2.0, 2.0];
/// From the datasheet towards the optimum of the base model, on the first millisecond.
const FAR: [Effort; 3] =
    [effort(2, 1, 4.0, None), effort(2, 1, 4.0, None), effort(4, 2, 1.0, None)];

/// An effect in its best form, its parameters with the base model's before them, and how well they do.
pub type FirstGuess = (Vec<Choice>, Vec<f64>, f64);

/// Where fits begin: all of them from the datasheet, after the same effort.
#[derive(Clone, Debug)]
pub struct Guess {
    /// The base model's parameters, whitened.
    pub base: Vec<f64>,
    /// How well they do: objective over the sum of weights, about 1 at the floor.
    pub level: f64,
    /// Every effect in its best form, its parameters with the base model's before them, and how well they do; none of
    /// effects that the symmetries of the data rule out, and after [`second_guess`] of those that fell behind.
    pub effects: Vec<Option<FirstGuess>>,
    /// What the data say without any model.
    pub findings: Vec<Finding>,
}

impl Guess {
    /// Does an effect already do far better than the base model? Then there is no need to search on
    /// for a base model that does.
    pub(super) fn promises(&self) -> bool {
        self.effects.iter().flatten().any(|e| e.2 < 0.6 * self.level && self.level > SETTLED)
    }
}

/// First guesses from the free block and the first millisecond: `bench` looks at no more. An effect
/// begins at the datasheet, with modulus and damping of the free block, and not at the recalibrated base model, which
/// its absence has bent.
///
/// # Errors
/// What stops the reduction of the block.
pub fn first_guess(
    bench: &mut Bench,
    findings: Vec<Finding>,
    of: &[usize],
    method: Method,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Guess, Fault> {
    let free = struck(bench, &[], vec![0.0; bench.base_size()], of);
    let first = approach(bench, evaluate(bench, &[], free.clone(), of), of, &FAR[..1]);
    bench.measure_floor(&bench.params(&[], &first.x), of)?;
    let bench: &Bench = bench;
    let base = approach(bench, evaluate(bench, &[], first.x, of), of, &FAR[1..]);
    let mut effects = Vec::new();
    let possible = symmetry::possible(&findings);
    for (effect, spec) in bench.specs.iter().enumerate() {
        progress(0.05 + 0.01 * effect as f64, &format!("first guess of {}", spec.effect));
        let forms = if method.families { spec.forms.len() } else { 1 };
        let guess = possible[effect].then(|| guess_effect(bench, effect, forms, &free, of));
        effects.push(guess.flatten());
    }
    progress(0.15, "the most promising effects to the end of the first millisecond");
    let base = approach(bench, base, of, &TO_THE_END);
    let total = bench.total_weight(of);
    for guess in most_promising(&mut effects).into_iter().take(GUESSED).flatten() {
        let fit = approach(bench, evaluate(bench, &guess.0, guess.1.clone(), of), of, &TO_THE_END);
        *guess = (fit.added, fit.x, fit.objective / total);
    }
    Ok(Guess { base: base.x, level: base.objective / total, effects, findings })
}

/// The best of an effect's first `forms` forms on the first millisecond, with the base model's parameters from those of
/// the `free` block.
fn guess_effect(
    bench: &Bench,
    effect: usize,
    forms: usize,
    free: &[f64],
    of: &[usize],
) -> Option<FirstGuess> {
    let dynamic = bench.specs[effect].module == Module::Dynamic;
    let begin = |form| {
        let added = vec![Choice { effect, form }];
        let mut points = starts(bench, &added, free);
        if dynamic {
            // The free block tells of such an effect, too.
            let few = points.iter().take(STARTS.len());
            let ringing: Vec<Vec<f64>> =
                few.map(|x| struck(bench, &added, x.clone(), of)).collect();
            points.extend(ringing);
        }
        evaluate_all(bench, &added, points, of)
    };
    let towards = |fit| approach(bench, fit, of, &FIRST[..1]);
    let arrive = |fit| approach(bench, fit, of, &FIRST[1..]);
    let begun = best_of(STARTED, (0..forms).flat_map(begin).collect());
    let near = best_of(ARRIVING, begun.into_iter().map(towards).collect());
    let fit = near.into_iter().map(arrive).reduce(Fit::or_better)?;
    let level = fit.objective / bench.total_weight(of);
    Some((fit.added, fit.x, level))
}

/// Guesses from the best to the worst; those without a fit last.
fn most_promising(effects: &mut [Option<FirstGuess>]) -> Vec<&mut Option<FirstGuess>> {
    let mut order: Vec<&mut Option<FirstGuess>> = effects.iter_mut().collect();
    order.sort_by(|a, b| level_of(a).total_cmp(&level_of(b)));
    order
}

/// The base model and the most promising effects once more, on runs twice as long: an optimum of the
/// first millisecond that sees the next one meets the snap-outs one after the other and not all at once,
/// of which some would be met in the wrong place for good.
///
/// # Errors
/// What stops the reduction of the block.
pub fn second_guess(
    bench: &mut Bench,
    guess: &mut Guess,
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<(), Fault> {
    bench.measure_floor(&bench.params(&[], &guess.base), of)?;
    let bench: &Bench = bench;
    let total = bench.total_weight(of);
    let base = approach(bench, evaluate(bench, &[], guess.base.clone(), of), of, &SECOND);
    guess.level = base.objective / total;
    guess.base = base.x;
    for (rank, effect) in most_promising(&mut guess.effects).into_iter().enumerate() {
        let Some((added, x, _)) = effect.take().filter(|_| rank < GUESSED) else { continue };
        progress(0.16 + 0.02 * rank as f64, "second guess of the most promising effects");
        let fit = approach(bench, evaluate(bench, &added, x, of), of, &SECOND);
        *effect = Some((added, fit.x, fit.objective / total));
    }
    Ok(())
}

/// Level of a guess, of none the worst.
fn level_of(guess: &Option<FirstGuess>) -> f64 {
    guess.as_ref().map_or(f64::INFINITY, |g| g.2)
}

/// On the first millisecond the optimum is smooth and reached in full; on longer starts an optimum beside it has no
/// slope towards it.
const TO_THE_END: [Effort; 2] = [effort(4, 2, 3.0, None), effort(6, 2, 1.0, None)];
/// From one horizon to the next.
const SECOND: [Effort; 2] = [effort(4, 2, 2.0, None), effort(4, 2, 1.0, None)];
/// So many effects go on from their own first guess.
const GUESSED: usize = 5;

/// So many starts of an effect, the best of all its forms, go on: the best one often ends beside the optimum.
const STARTED: usize = 4;
/// So many of them to the end.
const ARRIVING: usize = 2;

/// The `count` best fits, each place once.
fn best_of(count: usize, mut fits: Vec<Fit>) -> Vec<Fit> {
    fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
    fits.dedup_by(|a, b| a.objective - b.objective < 1e-3 * b.objective);
    fits.truncate(count);
    fits
}

/// From the datasheet towards the optimum of an effect, on the first millisecond.
const FIRST: [Effort; 2] = [effort(4, 2, 4.0, None), effort(3, 3, 1.0, None)];

/// Starting points of an effect, the last of `added`, at the nuisance parameters `x`.
pub(super) fn starts(bench: &Bench, added: &[Choice], x: &[f64]) -> Vec<Vec<f64>> {
    let coordinates = bench.coordinates(added);
    let signed = coordinates[x.len()].spread.is_signed();
    let severities: &[f64] = if signed { &SIGNED } else { &STARTS };
    let at = |severity: &f64| {
        let mut point = x.to_vec();
        point.resize(coordinates.len(), 0.0);
        point[x.len()] = *severity;
        point
    };
    let mut points: Vec<Vec<f64>> = severities.iter().map(at).collect();
    if coordinates.len() > x.len() + 2 {
        // Three parameters of which one may be a phase: look around.
        let mut noise = Noise::new(coordinates.len() as u64);
        for _ in 0..DRAWN {
            let mut point = points[0].clone();
            for value in &mut point[x.len()..] {
                *value = noise.normal().clamp(-2.0, 2.0);
            }
            points.push(point);
        }
    }
    points
}

/// Points at which effects with three parameters are looked at before one is taken.
const DRAWN: usize = 24;

/// The free block alone tells modulus and damping, also beside an effect that acts in it, and costs next to nothing.
pub fn struck(bench: &Bench, added: &[Choice], start: Vec<f64>, of: &[usize]) -> Vec<f64> {
    let free = |r: &usize| bench.runs[*r].kind == RunKind::Ringdown;
    let rung: Vec<usize> = of.iter().copied().filter(free).collect();
    if rung.is_empty() {
        return start;
    }
    let fit = evaluate(bench, added, start, &rung);
    approach(bench, fit, &rung, &[effort(4, 2, 5.0, None), effort(4, 2, 1.0, None)]).x
}
