//! The whole way from a campaign's folder to the answers.

use super::calibration::BLUR;
use super::campaign::{Campaign, RunKind, RunSpec};
use super::decide::{self, Cause, Decision, Kind, Weighed};
use super::features;
use super::fit::evaluate;
use super::guess::{self, Guess};
use super::held_out;
use super::hypotheses::{self, Fits, Hypothesis, Method};
use super::polish;
use super::problem::{loss, Bench, Look, Residuals};
use super::symmetry;
use super::where_::{self, Cell};
use crate::error::{Fault, Problem};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// So many of the most probable causes are judged on the held-out runs.
const JUDGED: usize = 2;

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

/// A run that would tell causes apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Settings.
    pub run: RunSpec,
    /// Expected nats between the two most probable causes.
    pub gain: f64,
    /// Which causes it tells apart.
    pub between: [String; 2],
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
    /// Closed fraction of every cause in `weighed` that has a fit of its own.
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
    let mut findings = symmetry::findings(&campaign);
    if !settings.method.symmetries {
        findings.clear();
    }
    let mut guess = Guess {
        base: vec![0.0; bench.base_size()],
        level: 1.0,
        effects: Vec::new(),
        findings: findings.clone(),
    };
    if settings.method.recalibrate {
        let mut first = Bench::new(&campaign, bench.specs, Look::Start)?;
        guess = guess::first_guess(&mut first, findings, &seen, settings.method, progress)?;
        let mut middle = Bench::new(&campaign, bench.specs, Look::Middle)?;
        guess::second_guess(&mut middle, &mut guess, &seen, progress)?;
    }
    let mut fits = hypotheses::fit_all(&mut bench, &guess, &seen, settings.method, progress)?;
    let weighed = decide::weigh(&fits);
    let decision = decide::decide(&bench, &fits, &weighed);
    let modules = decide::modules(&bench, &fits);
    let (detectable, indistinguishable) =
        (detectable(&bench, &fits), indistinguishable(&bench, &fits));
    let judged = if held.is_empty() { all.clone() } else { held.clone() };
    let mut whole = Bench::new(&campaign, bench.specs, Look::Whole)?;
    whole.measure_floor(&bench.params(&[], &fits.base.fit.x), &all)?;
    if settings.method.recalibrate {
        let seen = held_out::to_fit(&bench.runs, &held, Look::Whole);
        polish::polish(&whole, &mut fits, &weighed, &seen, progress);
    }
    progress(0.99, "judging the held-out runs");
    let (gap, closed) = how_far(&whole, &fits, &weighed, &judged, settings.seed);
    let cells = where_::map(&whole, &at(&whole, &fits.base, &all));
    let experiments = next_experiments(&bench, &fits, &weighed);
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

/// Residuals of a hypothesis on the runs `of`.
fn at(bench: &Bench, hypothesis: &Hypothesis, of: &[usize]) -> Residuals {
    evaluate(bench, &hypothesis.added, hypothesis.fit.x.clone(), of).residuals
}

/// The most probable cause with a fit of its own.
pub fn best_cause(weighed: &[Weighed]) -> Cause {
    let own = |w: &&Weighed| matches!(w.cause, Cause::Single(_) | Cause::Pair(_));
    weighed.iter().find(own).map_or(Cause::None, |w| w.cause.clone())
}

fn how_far(
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
    let squares: Vec<Option<Vec<f64>>> = weighed
        .iter()
        .enumerate()
        .map(|(rank, w)| match w.cause {
            Cause::None | Cause::Unknown => None,
            _ if rank >= JUDGED => None,
            _ => Some(of(decide::fit_of(fits, &w.cause))),
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

/// The severity at which an effect would move ln(G²) by three nats' worth: its loss grows with the
/// square of a small severity.
fn detectable(bench: &Bench, fits: &Fits) -> Vec<(String, f64)> {
    let needed = (3.0 / super::calibration::SHARPNESS).exp_m1() * (1.0 + BLUR);
    let specs = bench.specs.iter().zip(&fits.response);
    specs
        .map(|(spec, (severity, caused))| {
            (spec.effect.to_string(), severity * (needed / caused.max(1e-9)).sqrt())
        })
        .collect()
}

/// Pairs of single effects whose evidence is within three nats and that both explain something.
fn indistinguishable(bench: &Bench, fits: &Fits) -> Vec<[String; 2]> {
    let base = decide::evidence(fits.base.level);
    let nats: Vec<f64> = fits.singles.iter().map(|s| decide::evidence(s.level)).collect();
    let top = nats.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let good: Vec<usize> =
        (0..nats.len()).filter(|k| nats[*k] > base + 3.0 && nats[*k] > top - 3.0).collect();
    let name = |k: usize| bench.specs[fits.singles[k].added[0].effect].effect.to_string();
    good.iter()
        .enumerate()
        .flat_map(|(i, a)| good[i + 1..].iter().map(move |b| (*a, *b)))
        .map(|(a, b)| [name(a), name(b)])
        .collect()
}

/// Runs that would tell the two most probable causes apart, best first.
fn next_experiments(bench: &Bench, fits: &Fits, weighed: &[Weighed]) -> Vec<Experiment> {
    let mut rivals: Vec<&Weighed> =
        weighed.iter().filter(|w| w.cause != Cause::Unknown).take(2).collect();
    if rivals.len() < 2 {
        return Vec::new();
    }
    rivals.truncate(2);
    let hypotheses = [&rivals[0].cause, &rivals[1].cause].map(|c| decide::fit_of(fits, c));
    let between = [0, 1].map(|k| {
        let names = decide::names(bench, fits, &rivals[k].cause);
        if names.is_empty() {
            "none".to_string()
        } else {
            names.join(" + ")
        }
    });
    let params = hypotheses.map(|h| bench.params(&h.added, &h.fit.x));
    let mut out: Vec<Experiment> = candidates()
        .into_par_iter()
        .filter_map(|run| {
            let [a, b] = [0, 1].map(|k| bench.simulate(&params[k], &run).ok());
            let [a, b] = [a?, b?].map(|r| features::of_run(&bench.plan, &run, 0, &r));
            let mean = a
                .iter()
                .zip(&b)
                .map(|(a, b)| loss((a.value - b.value) / super::floor::uncertainty(a)))
                .sum::<f64>()
                / a.len().max(1) as f64;
            let gain = super::calibration::SHARPNESS * mean.ln_1p();
            Some(Experiment { run, gain, between: between.clone() })
        })
        .collect();
    out.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    out.truncate(3);
    out
}

/// What a rig can do without being rebuilt.
fn candidates() -> Vec<RunSpec> {
    let run = |file: &str, speed: f64, pressure: f64, dwell: f64| RunSpec {
        file: file.to_string(),
        kind: RunKind::Sliding,
        road_speed_m_s: speed,
        road_speed_end_m_s: None,
        mean_pressure_pa: pressure,
        dwell_s: dwell,
        duration_s: 0.024,
    };
    vec![
        run("slow and light", 0.05, 80e3, 0.0),
        run("slow and heavy", 0.05, 700e3, 0.0),
        run("fast and light", 0.9, 120e3, 0.0),
        run("fast and heavy", 0.9, 600e3, 0.0),
        run("long dwell", 0.1, 250e3, 0.05),
        run("very slow", 0.02, 250e3, 0.0),
        run("reverse and fast", -0.7, 300e3, 0.0),
    ]
}

/// What was wrong with the data, if it was worked around.
pub fn flags(diagnosis: &Diagnosis) -> &[Problem] {
    &diagnosis.campaign.warnings
}

/// The verdict in words.
pub fn verdict(d: &Diagnosis) -> String {
    let gap = &d.gap;
    let top = d.weighed.first().map_or(0.0, |w| w.probability);
    let percent = |x: f64| format!("{:.0} %", 100.0 * x);
    let opening = format!(
        "On runs that no fit has seen the datasheet model is {:.1} times the floor off, the recalibrated one {:.1}.",
        gap.nominal, gap.recalibrated
    );
    let closing = format!(
        "closes {} [{}, {}] of what recalibration leaves",
        percent(gap.closed[0]),
        percent(gap.closed[1]),
        percent(gap.closed[2])
    );
    let names = d.decision.effects.join(" + ");
    match d.decision.kind {
        Kind::None => format!("{opening} No gap that an effect would be needed for (P = {top:.2})."),
        Kind::Named => format!("{opening} The rest is consistent with {names} (P = {top:.2}), which {closing}."),
        Kind::Class => format!(
            "{opening} The rest is consistent with one or more of: {}; the data cannot tell which. The likeliest {closing}.",
            d.decision.effects.join(", ")
        ),
        Kind::Unknown => format!(
            "{opening} No candidate explains the rest (P(unknown) = {top:.2}); it looks most like module {}.",
            d.decision.module.as_deref().unwrap_or("none")
        ),
        Kind::Undecidable => format!("{opening} Nothing can be said."),
    }
}
