//! The runs as curves: measured, recalibrated, and with the effect.

use super::short;
use crate::gap::campaign::{Record, Run, FRICTION, VELOCITY};
use crate::gap::decide::{self, Cause};
use crate::gap::diagnose::{self, Diagnosis};
use crate::gap::json;
use crate::gap::simulate::road_speed;
use crate::gap::spectrum::{amplitude, hann, mean, power};
use crate::gap::svg::{key, lines};
use crate::page::escape;
use rayon::prelude::*;
use std::fmt::Write;

/// Size of a picture \[px\].
const SIZE: [f64; 2] = [360.0, 220.0];

/// A curve: x, y, and its class as the drawing has it.
type Curve = (Vec<f64>, Vec<f64>, usize);

/// All runs, measured and simulated.
pub(super) fn overlays(d: &Diagnosis, out: &mut String) {
    let best = diagnose::best_cause(&d.weighed);
    let models = [json::params_of(d, &Cause::None), json::params_of(d, &best)];
    let _ = write!(
        out,
        "<h2>Runs</h2><p>{} measured, {} recalibrated, {} with {}. Friction force over time; friction \
         force over sliding speed of the run-in edge (last quarter); spectrum of the edge velocity.</p>",
        key(0),
        key(1),
        key(2),
        escape(&decide::label(&d.bench, &d.fits, &best))
    );
    let simulated: Vec<Vec<Option<Record>>> = d
        .campaign
        .runs
        .par_iter()
        .map(|run| models.iter().map(|m| d.bench.simulate(m, &run.spec).ok()).collect())
        .collect();
    // Over their whole length: the eye sees drifts of phase that the fit does not look at.
    for (run, records) in d.campaign.runs.iter().zip(&simulated) {
        let mut all = vec![&run.record];
        all.extend(records.iter().flatten());
        overlay(d, run, &all, out);
    }
}

/// Pictures of a run: what was measured first, the models after it.
fn overlay(d: &Diagnosis, run: &Run, records: &[&Record], out: &mut String) {
    let name = escape(short(&run.spec.file));
    let _ = write!(out, "<details open><summary>{name}</summary><div class=\"row\">");
    // A struck block hangs free: there is no friction to be shown.
    let slides = run.spec.mean_pressure_pa > 0.0;
    let (title, channel, label) = if slides {
        ("friction force", FRICTION, "friction force in N")
    } else {
        ("ring-down", VELOCITY, "edge velocity in m/s")
    };
    let of_each = |curve: &dyn Fn(&Record) -> Option<[Vec<f64>; 2]>| -> Vec<Curve> {
        let curves = records.iter().enumerate();
        curves.filter_map(|(class, record)| curve(record).map(|[x, y]| (x, y, class))).collect()
    };
    let traces = of_each(&|record| trace(record, channel));
    let cycles = if slides { of_each(&|record| cycle(d, run, record)) } else { Vec::new() };
    let step = 1.0 / d.campaign.plan.sampling_rate;
    let spectra = of_each(&|record| spectrum(record, step));
    for (title, labels, curves) in [
        (title, ["time in ms", label], &traces),
        ("limit cycle", ["sliding speed in m/s", "friction force in N"], &cycles),
        ("spectrum", ["frequency in kHz", "level in dB re 1 m/s"], &spectra),
    ] {
        if !curves.is_empty() {
            let curves: Vec<_> = curves.iter().map(|(x, y, c)| (&x[..], &y[..], *c)).collect();
            out.push_str(&lines(title, labels, &curves, SIZE));
        }
    }
    out.push_str("</div></details>");
}

/// A channel over time \[ms\].
fn trace(record: &Record, channel: usize) -> Option<[Vec<f64>; 2]> {
    let values = record.channel[channel].clone()?;
    Some([record.time.iter().map(|t| t * 1e3).collect(), values])
}

/// Friction force \[N\] over sliding speed of the run-in edge \[m/s\], in the last quarter of the run.
fn cycle(d: &Diagnosis, run: &Run, record: &Record) -> Option<[Vec<f64>; 2]> {
    let velocity = record.channel[VELOCITY].as_ref()?;
    let force = record.channel[FRICTION].as_ref()?;
    let late = velocity.len() - velocity.len() / 4;
    let slip = (late..velocity.len())
        .map(|i| road_speed(&d.campaign.plan, &run.spec, record.time[i]) - velocity[i])
        .collect();
    Some([slip, force[late..].to_vec()])
}

/// Level of the edge velocity \[dB re 1 m/s\] over frequency \[kHz\]; samples every `step` \[s\].
fn spectrum(record: &Record, step: f64) -> Option<[Vec<f64>; 2]> {
    let velocity = record.channel[VELOCITY].as_ref()?;
    let weights = hann(velocity.len());
    let offset = mean(velocity, &weights);
    let frequencies: Vec<f64> = (1..160).map(|k| 50.0 * f64::from(k)).collect();
    let levels = frequencies
        .iter()
        .map(|f| 10.0 * (power(amplitude(velocity, &weights, offset, step, *f)) + 1e-7).log10())
        .collect();
    Some([frequencies.iter().map(|f| f / 1e3).collect(), levels])
}
