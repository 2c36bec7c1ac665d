//! What to measure next: runs in which the two likeliest causes differ most.

use crate::gap::calibration::SHARPNESS;
use crate::gap::campaign::{RunKind, RunSpec};
use crate::gap::decide::{self, Cause, Weighed};
use crate::gap::features;
use crate::gap::floor::uncertainty;
use crate::gap::hypotheses::Fits;
use crate::gap::problem::{loss, Bench};
use rayon::prelude::*;

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

/// Runs that would tell the two most probable causes apart, best first.
pub(super) fn next(bench: &Bench, fits: &Fits, weighed: &[Weighed]) -> Vec<Experiment> {
    let mut known = weighed.iter().map(|w| &w.cause).filter(|cause| **cause != Cause::Unknown);
    let (Some(first), Some(second)) = (known.next(), known.next()) else { return Vec::new() };
    let between = [first, second].map(|cause| decide::label(bench, fits, cause));
    let params = [first, second].map(|cause| {
        let hypothesis = decide::fit_of(fits, cause);
        bench.params(&hypothesis.fit.added, &hypothesis.fit.x)
    });
    let mut out: Vec<Experiment> = candidates()
        .into_par_iter()
        .filter_map(|run| {
            let [a, b] = [0, 1].map(|k| bench.simulate(&params[k], &run).ok());
            let [a, b] = [a?, b?].map(|r| features::of_run(&bench.plan, &run, 0, &r));
            let mean = a
                .iter()
                .zip(&b)
                .map(|(a, b)| loss((a.value - b.value) / uncertainty(a)))
                .sum::<f64>()
                / a.len().max(1) as f64;
            let gain = SHARPNESS * mean.ln_1p();
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
