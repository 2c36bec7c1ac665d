//! The whole way from a campaign's folder to the answers.

mod experiment;
mod how_far;
mod resolution;
mod verdict;

pub use experiment::Experiment;
pub use how_far::Gap;
pub use verdict::verdict;

use super::campaign::Campaign;
use super::decide::{self, Cause, Decision, Weighed};
use super::guess::{self, Guess};
use super::held_out::{self, Shrinkage};
use super::hypotheses::{self, Fits, Method};
use super::polish;
use super::problem::{Bench, Look};
use super::second_look;
use super::symmetry;
use super::where_::{self, Cell};
use crate::error::{Fault, Problem};
use how_far::{at, how_far, Judged};
use resolution::{detectable, indistinguishable};
use std::path::Path;
use std::time::Instant;

/// How to go about it.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Which steps are done; all but in the ablation.
    pub method: Method,
    /// Are runs held out? If not, the gap is measured where it was fitted.
    pub hold_out: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 1, method: Method::FULL, hold_out: true }
    }
}

/// The answers.
#[derive(Debug)]
pub struct Diagnosis {
    /// Data vector of the start of the runs, and model.
    pub bench: Bench,
    /// The same of whole runs.
    pub whole: Bench,
    /// Campaign with its data.
    pub campaign: Campaign,
    /// All fits.
    pub fits: Fits,
    /// Probabilities.
    pub weighed: Vec<Weighed>,
    /// Decision.
    pub decision: Decision,
    /// How far.
    pub gap: Gap,
    /// Closed fraction to be expected on further runs, of every cause in `weighed` that is judged.
    pub closed: Vec<Option<f64>>,
    /// Where, before any effect is added.
    pub cells: Vec<Cell>,
    /// Share per module.
    pub modules: Vec<(String, f64)>,
    /// Smallest severity that would have been seen, per effect.
    pub detectable: Vec<(String, f64)>,
    /// Pairs of effects that explain the data equally well.
    pub indistinguishable: Vec<[String; 2]>,
    /// What to measure next.
    pub experiments: Vec<Experiment>,
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// How it was done.
    pub settings: Settings,
}

impl Diagnosis {
    /// Simulations of the fits on the start of the runs and on whole runs.
    pub fn simulations(&self) -> usize {
        self.bench.simulations() + self.whole.simulations()
    }
}

/// Diagnoses the campaign in `folder`.
///
/// # Errors
/// Unusable data, or a model that cannot be built.
pub fn diagnose(
    folder: &Path,
    settings: Settings,
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Diagnosis, Fault> {
    let began = Instant::now();
    let campaign = Campaign::load(folder)?;
    let mut bench = Bench::new(&campaign, crate::effects::fit_specs(), Look::Fit)?;
    let all: Vec<usize> = (0..bench.runs.len()).collect();
    let held = if settings.hold_out { held_out::choose(&bench.runs) } else { Vec::new() };
    let seen = held_out::to_fit(&bench.runs, &held, Look::Fit);
    progress(0.0, "recalibrating the base model");
    let guess = guess(&campaign, &bench, settings.method, &seen, progress)?;
    let mut fits = hypotheses::fit_all(&mut bench, &guess, &seen, settings.method, progress)?;
    let first_look = decide::weigh(&fits);
    let modules = decide::modules(&bench, &fits);
    let (detectable, indistinguishable) =
        (detectable(&bench, &fits), indistinguishable(&bench, &fits));
    let rest = held_out::to_fit(&bench.runs, &held, Look::Whole);
    let judged = if held.is_empty() {
        Judged { unseen: all.clone(), seen: Vec::new() }
    } else {
        Judged { unseen: held, seen: rest.clone() }
    };
    let mut whole = Bench::new(&campaign, bench.specs, Look::Whole)?;
    whole.measure_floor(&bench.params(&[], &fits.base.fit.x), &all)?;
    if settings.method.recalibrate {
        polish::polish(&whole, &mut fits, &first_look, &rest, progress);
    }
    progress(0.99, "judging the held-out runs");
    let (weighed, gap, closed) = judge(&whole, &fits, first_look, &judged, settings);
    let decision = decide::decide(&bench, &fits, &weighed);
    let cells = where_::map(&whole, &at(&whole, &fits.base, &all));
    let experiments = experiment::next(&bench, &fits, &weighed);
    Ok(Diagnosis {
        detectable,
        indistinguishable,
        campaign,
        fits,
        weighed,
        decision,
        gap,
        closed,
        cells,
        modules,
        experiments,
        bench,
        whole,
        seconds: began.elapsed().as_secs_f64(),
        settings,
    })
}

/// Where the fits on `bench` begin: on ever longer starts of the runs `seen`, or at the datasheet where nothing is
/// recalibrated.
fn guess(
    campaign: &Campaign,
    bench: &Bench,
    method: Method,
    seen: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Guess, Fault> {
    let mut findings = symmetry::findings(campaign);
    if !method.symmetries {
        findings.clear();
    }
    if !method.recalibrate {
        let base = vec![0.0; bench.base_size()];
        return Ok(Guess { base, level: 1.0, effects: Vec::new(), findings });
    }
    let mut first = Bench::new(campaign, bench.specs, Look::Start)?;
    let mut guess = guess::first_guess(&mut first, findings, seen, method, progress)?;
    let mut middle = Bench::new(campaign, bench.specs, Look::Middle)?;
    guess::second_guess(&mut middle, &mut guess, seen, progress)?;
    Ok(guess)
}

/// The causes after a second look where runs are held out, the gap on the runs `judged`, and the closed fraction of
/// every cause that is judged.
fn judge(
    whole: &Bench,
    fits: &Fits,
    first_look: Vec<Weighed>,
    judged: &Judged,
    settings: Settings,
) -> (Vec<Weighed>, Gap, Vec<Option<f64>>) {
    let expected = |all: Vec<Option<Shrinkage>>| {
        all.iter().map(|s| s.as_ref().map(Shrinkage::expected)).collect()
    };
    let (gap, shrinkages) = how_far(whole, fits, &first_look, judged, settings.seed);
    if !settings.hold_out {
        return (first_look, gap, expected(shrinkages));
    }
    let unseen: Vec<Option<f64>> =
        shrinkages.iter().map(|s| s.as_ref().map(|s| s.unseen.closed())).collect();
    let weighed = second_look::second_look(fits, &first_look, &unseen);
    if weighed.iter().zip(&first_look).all(|(now, then)| now.cause == then.cause) {
        return (weighed, gap, expected(shrinkages));
    }
    let (gap, shrinkages) = how_far(whole, fits, &weighed, judged, settings.seed);
    (weighed, gap, expected(shrinkages))
}

/// The most probable cause with a fit of its own.
pub fn best_cause(weighed: &[Weighed]) -> Cause {
    weighed.iter().find(|w| w.cause.is_fitted()).map_or(Cause::None, |w| w.cause.clone())
}

/// What was wrong with the data, if it was worked around.
pub fn flags(diagnosis: &Diagnosis) -> &[Problem] {
    &diagnosis.campaign.warnings
}
