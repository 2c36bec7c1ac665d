//! The road's own waves, once a texture is known to be there.
//!
//! What the recalibrated model leaves of the normal force is looked at over the way of the road instead of over
//! time: a wave of the road has one length in runs of all speeds, and nothing else has. A wave that is short beside
//! the block presses on it with what its ends leave over, so the face is cut finely enough for the wave.

use super::campaign::{Campaign, NORMAL};
use super::fit::{approach, evaluate, Effort, Fit};
use super::hypotheses::{effort, Hypothesis};
use super::problem::{Bench, Choice, Look};
use super::simulate::{road_speed, FIT};
use crate::error::Fault;
use crate::params::Params;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Most waves that are looked for; a texture may have four, but each costs as much as all before it.
const WAVES: usize = 2;
/// Shortest and longest wavelength that is looked for \[m\], and how many between.
const LENGTHS: ([f64; 2], usize) = ([0.6e-3, 25e-3], 190);
/// Share of the remaining force, mean over the runs, that a wave has to explain to be taken.
const CLEAR: f64 = 0.25;
/// Phases and amplitudes \[m\] from which a wave is started.
const PHASES: usize = 8;
const AMPLITUDES: [f64; 2] = [3e-6, 9e-6];
/// Samples after the start of a run that are left out, and samples of the running mean.
const SKIPPED: usize = 40;
const SMOOTHED: usize = 15;

/// On the starts of runs, then on whole runs.
const STARTS: [Effort; 2] = [effort(3, 3, 3.0, None), effort(3, 3, 1.0, None)];
const WHOLE: [Effort; 2] = [effort(3, 3, 3.0, None), effort(4, 4, 1.0, None)];

/// A fit with the road's waves, and the bench of whole runs whose mesh it needs.
pub struct Waved {
    /// Whole runs on that mesh.
    pub whole: Bench,
    /// The fit.
    pub fit: Fit,
}

/// `hypothesis` with the waves that are found in place of the form that told the texture; `None` where it has no
/// texture or no wave is clear.
///
/// # Errors
/// What stops the reduction of the block.
pub fn waves(
    campaign: &Campaign,
    whole: &Bench,
    hypothesis: &Hypothesis,
    base: &Fit,
    of: &[usize],
    progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Option<Waved>, Fault> {
    let textured = |c: &Choice| whole.specs[c.effect].effect == "road_texture";
    if !hypothesis.added.iter().any(textured) {
        return Ok(None);
    }
    progress(0.96, "the waves of the road");
    let smooth = whole.params(&[], &base.x);
    let Some(length) = clearest(campaign, whole, &smooth, of) else { return Ok(None) };
    let fineness = FIT.for_wave(length, campaign.plan.block.length_m);
    let bench_of = |look: Look| -> Result<Bench, Fault> {
        let mut bench = Bench::cut(campaign, whole.specs, look, fineness)?;
        bench.measure_floor(&smooth, &(0..bench.runs.len()).collect::<Vec<_>>())?;
        Ok(bench)
    };
    let bench = bench_of(Look::Fit)?;
    let flat = without_texture(&bench, hypothesis, base);
    let fit = approach(&bench, first(&bench, &flat, length, of), of, &STARTS);
    let whole = bench_of(Look::Whole)?;
    progress(0.97, "the waves of the road on whole runs");
    let begun = turned(&whole, fit, flat.x.len(), length, of);
    let mut fit = approach(&whole, begun, of, &WHOLE);
    for _ in 1..WAVES {
        let params = whole.params(&fit.added, &fit.x);
        let Some(length) = clearest(campaign, &whole, &params, of) else { break };
        let more = approach(&whole, first(&whole, &fit, length, of), of, &WHOLE);
        if more.objective >= fit.objective {
            break;
        }
        fit = more;
    }
    Ok(Some(Waved { whole, fit }))
}

/// The best of a wave as the starts of runs have it, and the same with the `length` that whole runs tell, at all
/// phases; its parameters begin at `at`.
fn turned(bench: &Bench, fit: Fit, at: usize, length: f64, of: &[usize]) -> Fit {
    let coordinates = bench.coordinates(&fit.added);
    let turn = std::f64::consts::TAU / PHASES as f64;
    let mut best = evaluate(bench, &fit.added, fit.x.clone(), of);
    for k in 0..PHASES {
        let mut x = fit.x.clone();
        x[at + 1] = coordinates[at + 1].whitened(length);
        x[at + 2] = coordinates[at + 2].whitened(turn * (k as f64 - 0.5 * PHASES as f64));
        best = best.or_better(evaluate(bench, &fit.added, x, of));
    }
    best
}

/// The hypothesis without its texture; a texture alone begins where the base model does.
fn without_texture(bench: &Bench, hypothesis: &Hypothesis, base: &Fit) -> Fit {
    let from = if hypothesis.added.len() == 1 { base } else { &hypothesis.fit };
    let mut at = bench.base_size();
    let mut x = from.x[..at].to_vec();
    let mut added = Vec::new();
    for choice in &hypothesis.added {
        let spec = &bench.specs[choice.effect];
        let count = spec.forms[choice.form].params.len();
        if spec.effect != "road_texture" {
            added.push(*choice);
            x.extend(&hypothesis.fit.x[at..at + count]);
        }
        at += count;
    }
    Fit { added, x, jacobian: None, ..from.clone() }
}

/// The best of the places where one more wave of this length may begin.
fn first(bench: &Bench, fit: &Fit, length: f64, of: &[usize]) -> Fit {
    let mut added = fit.added.clone();
    let spec = bench.specs.iter().position(|s| s.effect == "road_texture").unwrap_or(0);
    match added.last_mut().filter(|c| c.effect == spec) {
        // The forms are: a sine, a band, then two waves and more.
        Some(last) => last.form = (last.form + 1).max(2),
        None => added.push(Choice { effect: spec, form: 0 }),
    }
    let coordinates = bench.coordinates(&added);
    let own = &coordinates[fit.x.len()..];
    let turn = std::f64::consts::TAU / PHASES as f64;
    let places = AMPLITUDES.iter().flat_map(|a| (0..PHASES).map(move |k| (*a, k)));
    let points: Vec<Vec<f64>> = places
        .map(|(amplitude, k)| {
            let phase = turn * (k as f64 - 0.5 * PHASES as f64);
            let wave = [amplitude, length, phase];
            let wave = own.iter().zip(wave).map(|(c, value)| c.whitened(value));
            fit.x.iter().copied().chain(wave).collect()
        })
        .collect();
    points
        .into_iter()
        .map(|x| evaluate(bench, &added, x, of))
        .reduce(Fit::or_better)
        .unwrap_or_else(|| fit.clone())
}

/// The wavelength \[m\] that explains most of what `params` leave of the normal force, if it is clear.
fn clearest(campaign: &Campaign, bench: &Bench, params: &Params, of: &[usize]) -> Option<f64> {
    let left: Vec<(Vec<f64>, Vec<f64>)> =
        of.par_iter().filter_map(|r| remaining(campaign, bench, params, *r)).collect();
    let ([shortest, longest], count) = LENGTHS;
    let length = |k: usize| shortest * (longest / shortest).powf(k as f64 / (count - 1) as f64);
    let shares: Vec<f64> = (0..count)
        .into_par_iter()
        .map(|k| {
            let sum: f64 = left.iter().map(|(way, force)| share(way, force, length(k))).sum();
            sum / left.len().max(1) as f64
        })
        .collect();
    let best = (0..count).max_by(|a, b| shares[*a].total_cmp(&shares[*b]))?;
    (shares[best] > CLEAR).then(|| length(best))
}

/// Way of the road \[m\] and smoothed remainder of the normal force \[N\] of a run.
fn remaining(
    campaign: &Campaign,
    bench: &Bench,
    params: &Params,
    run: usize,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let spec = &bench.runs[run];
    if spec.road_speed_m_s == 0.0 && spec.road_speed_end_m_s.is_none() {
        return None;
    }
    let measured = campaign.runs[run].record.channel[NORMAL].as_ref()?;
    let record = bench.simulate(params, spec).ok()?;
    let simulated = record.channel[NORMAL].as_ref()?;
    let step = 1.0 / bench.plan.sampling_rate;
    let mut way = 0.0;
    let ways: Vec<f64> = record
        .time
        .iter()
        .map(|t| {
            way += step * road_speed(&bench.plan, spec, *t);
            way
        })
        .collect();
    let left: Vec<f64> = measured.iter().zip(simulated).map(|(m, s)| m - s).collect();
    let smooth: Vec<f64> =
        left.windows(SMOOTHED).map(|w| w.iter().sum::<f64>() / SMOOTHED as f64).collect();
    if smooth.len() < 4 * SKIPPED {
        return None;
    }
    let middle = SMOOTHED / 2;
    let mean = smooth[SKIPPED..].iter().sum::<f64>() / (smooth.len() - SKIPPED) as f64;
    let force = smooth[SKIPPED..].iter().map(|f| f - mean).collect();
    Some((ways[SKIPPED + middle..smooth.len() + middle].to_vec(), force))
}

/// Share of `force` that a sine of `length` over `way` explains, with an offset.
fn share(way: &[f64], force: &[f64], length: f64) -> f64 {
    if way.last().zip(way.first()).is_none_or(|(b, a)| (b - a).abs() < 0.7 * length) {
        return 0.0;
    }
    let turn = std::f64::consts::TAU / length;
    let row = |x: &f64| [(turn * x).cos(), (turn * x).sin(), 1.0];
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(3, 3), DVector::<f64>::zeros(3));
    for (x, f) in way.iter().zip(force) {
        let row = row(x);
        for i in 0..3 {
            right[i] += row[i] * f;
            for j in 0..3 {
                matrix[(i, j)] += row[i] * row[j];
            }
        }
    }
    let Some(solved) = matrix.cholesky().map(|c| c.solve(&right)) else { return 0.0 };
    let total: f64 = force.iter().map(|f| f * f).sum();
    solved.dot(&right) / total.max(1e-12)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::fit_specs;
    use crate::gap::campaign::{self, Run, RunKind, RunSpec};
    use crate::gap::simulate::{nominal, Simulator};
    use crate::gap::suite;

    #[test]
    fn a_wave_over_the_way_is_told_from_a_vibration_over_time() {
        // Closed form: a sine of 2 mm explains all of itself and of a wave 20 wavelengths long next to nothing of
        // one half as long.
        let way: Vec<f64> = (0..800).map(|i| 5e-5 * f64::from(i)).collect();
        let force: Vec<f64> =
            way.iter().map(|x| (std::f64::consts::TAU * x / 2e-3).sin()).collect();
        assert!(share(&way, &force, 2e-3) > 0.999);
        assert!(share(&way, &force, 1e-3) < 0.01);
    }

    #[test]
    fn the_wave_of_a_made_road_is_found_by_its_length() {
        // A block of the own simulator, cut finer than the fits, on a road of 3.1 mm and 4 um: the length that went
        // in, to the 2 % by which the lengths that are tried lie apart.
        let mut plan = campaign::parse_plan(suite::TEMPLATE, "template").unwrap();
        plan.runs.retain(|r| r.kind == RunKind::Sliding && r.dwell_s == 0.0);
        plan.runs.truncate(4);
        let smooth = nominal(&plan);
        let mut rough = smooth.clone();
        let road = &mut rough.effect.road_texture;
        (road.enabled, road.amplitude, road.wavelength, road.phase) = (true, 4e-6, 3.1e-3, 0.7);
        let simulator = Simulator::cut(&plan, FIT.finer()).unwrap();
        let run = |spec: &RunSpec| {
            let record = simulator.run(&rough, spec, spec.duration_s).unwrap();
            Run { spec: spec.clone(), record, hash: 0 }
        };
        let runs = plan.runs.iter().map(run).collect();
        let campaign = Campaign { plan, runs, warnings: Vec::new() };
        let bench = Bench::new(&campaign, fit_specs(), Look::Whole).unwrap();
        let found = clearest(&campaign, &bench, &smooth, &[0, 1, 2, 3]).unwrap();
        assert!((found / 3.1e-3 - 1.0).abs() < 0.03, "{found} m");
    }
}
