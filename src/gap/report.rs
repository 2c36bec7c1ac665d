//! `report.html`: one self-contained page.

use super::campaign::{Record, Run, CHANNELS, FRICTION, VELOCITY};
use super::decide::{self, Cause};
use super::diagnose::{self, Diagnosis};
use super::json;
use super::simulate::road_speed;
use super::spectrum::{amplitude, hann, mean, power};
use super::svg::{bars, key, lines};
use crate::page::{self, escape};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The channels in a reader's words, in the order of [`CHANNELS`].
const SPOKEN: [&str; CHANNELS.len()] =
    ["friction force", "normal force", "edge velocity", "edge displacement", "carriage approach"];

/// The page.
pub fn page(d: &Diagnosis) -> String {
    let mut out = page::head(&format!("Gap diagnosis of {}", d.campaign.plan.id));
    let _ = write!(out, "<p class=\"verdict\">{}</p>", escape(&diagnose::verdict(d)));
    flags(d, &mut out);
    ladder(d, &mut out);
    causes(d, &mut out);
    heat_map(d, &mut out);
    overlays(d, &mut out);
    parameters(d, &mut out);
    experiments(d, &mut out);
    provenance(d, &mut out);
    out.push_str(page::TAIL);
    out
}

fn flags(d: &Diagnosis, out: &mut String) {
    if d.campaign.warnings.is_empty() {
        return;
    }
    out.push_str("<h2>What was wrong with the data</h2><ul>");
    for problem in &d.campaign.warnings {
        let _ = write!(out, "<li>{}</li>", escape(&problem.to_string()));
    }
    out.push_str("</ul>");
}

fn ladder(d: &Diagnosis, out: &mut String) {
    let gap = &d.gap;
    let rows = [
        ("datasheet", gap.nominal, String::new()),
        ("recalibrated", gap.recalibrated, String::new()),
        ("with the effect", gap.with_effect, format!("closes {}", gap.closed_in_words())),
        ("floor", 1.0, "noise and error of the method".to_string()),
    ];
    let rows: Vec<(String, f64, String)> = rows
        .into_iter()
        .map(|(name, g, note)| (name.to_string(), g, format!("{g:.2}  {note}")))
        .collect();
    let longest = gap.nominal.max(gap.recalibrated).max(1.0);
    let files: Vec<&str> = gap.held_out.iter().map(|r| short(&d.bench.runs[*r].file)).collect();
    let _ = write!(
        out,
        "<h2>How far: gap in units of the floor, on runs that no fit has seen</h2>{}\
         <p class=\"note\">Held out: {}. Sham: the other effects, fitted with the same effort, close \
         {:.0} % (median).</p>",
        bars(&rows, longest),
        escape(&files.join(", ")),
        100.0 * gap.sham
    );
}

fn causes(d: &Diagnosis, out: &mut String) {
    let rows: Vec<(String, f64, String)> = d
        .weighed
        .iter()
        .zip(&d.closed)
        .take(12)
        .map(|(w, closed)| {
            let label = decide::label(&d.bench, &d.fits, &w.cause);
            let closes = closed.map_or(String::new(), |c| format!(", closes {:.0} %", 100.0 * c));
            (label, w.probability, format!("{:.3}{closes}", w.probability))
        })
        .collect();
    let _ = write!(out, "<h2>Which: probability of the causes</h2>{}", bars(&rows, 1.0));
    if !d.indistinguishable.is_empty() {
        let pairs: Vec<String> = d.indistinguishable.iter().map(|p| p.join(" / ")).collect();
        let _ = write!(out, "<p>Not told apart by these data: {}.</p>", escape(&pairs.join("; ")));
    }
    let shares: Vec<(String, f64, String)> = d
        .modules
        .iter()
        .map(|(name, share)| (name.clone(), *share, format!("{:.0} %", 100.0 * share)))
        .collect();
    let _ = write!(out, "<h2>Where in the model</h2>{}", bars(&shares, 1.0));
    out.push_str("<details><summary>Smallest severity that would have been seen</summary><table><tr><th>effect</th><th>severity</th></tr>");
    for (effect, severity) in &d.detectable {
        let _ = write!(out, "<tr><td>{effect}</td><td>{severity:.3e}</td></tr>");
    }
    out.push_str("</table></details>");
}

/// A run's file without folder and ending.
fn short(file: &str) -> &str {
    file.trim_start_matches("runs/").trim_end_matches(".csv")
}

fn heat_map(d: &Diagnosis, out: &mut String) {
    let mut columns: Vec<(usize, &str)> = Vec::new();
    let mut rows: BTreeMap<&str, BTreeMap<(usize, &str), (f64, bool)>> = BTreeMap::new();
    for cell in &d.cells {
        let channel = CHANNELS.iter().position(|c| *c == cell.channel).unwrap_or(0);
        let key = (channel, cell.phase);
        if !columns.contains(&key) {
            columns.push(key);
        }
        rows.entry(&cell.run).or_default().insert(key, (cell.gap, cell.significant));
    }
    columns.sort_unstable();
    out.push_str(
        "<h2>Where in the data: gap of the recalibrated model, in units of the floor</h2>",
    );
    let mut grid = String::from("<table><tr><th>run</th>");
    for (channel, phase) in &columns {
        let _ = write!(grid, "<th scope=\"col\">{}<br>{phase}</th>", SPOKEN[*channel]);
    }
    grid.push_str("</tr>");
    for (run, cells) in &rows {
        let _ = write!(grid, "<tr><td>{}</td>", escape(short(run)));
        for key in &columns {
            match cells.get(key) {
                Some((g, significant)) => {
                    let heat =
                        if *significant { 0.7 * (g.ln() / 3.5).clamp(0.0, 1.0) } else { 0.0 };
                    let _ = write!(
                        grid,
                        "<td style=\"background:rgba(213,94,0,{heat:.2})\">{g:.1}</td>"
                    );
                }
                None => grid.push_str("<td></td>"),
            }
        }
        grid.push_str("</tr>");
    }
    out.push_str(&page::wide("Gap by run and channel", &(grid + "</table>")));
    out.push_str("<p class=\"note\">1 is the floor; cells without colour are not significant (Benjamini-Hochberg, 5 %).</p>");
}

fn overlays(d: &Diagnosis, out: &mut String) {
    let best = diagnose::best_cause(&d.weighed);
    let models = [json::params_of(d, &Cause::None), json::params_of(d, &best)];
    let names = decide::names(&d.bench, &d.fits, &best);
    let _ = write!(
        out,
        "<h2>Runs</h2><p>{} measured, {} recalibrated, {} with {}. Friction force over time; friction \
         force over sliding speed of the run-in edge (last quarter); spectrum of the edge velocity.</p>",
        key(0),
        key(1),
        key(2),
        escape(&names.join(" + "))
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

fn overlay(d: &Diagnosis, run: &Run, records: &[&Record], out: &mut String) {
    let _ = write!(
        out,
        "<details open><summary>{}</summary><div class=\"row\">",
        escape(short(&run.spec.file))
    );
    let channel = if run.spec.mean_pressure_pa > 0.0 { FRICTION } else { VELOCITY };
    let mut traces = Vec::new();
    let mut cycles = Vec::new();
    let mut spectra = Vec::new();
    let step = 1.0 / d.campaign.plan.sampling_rate;
    for (class, record) in records.iter().enumerate() {
        let millis: Vec<f64> = record.time.iter().map(|t| t * 1e3).collect();
        if let Some(values) = &record.channel[channel] {
            traces.push((millis, values.clone(), class));
        }
        let Some(velocity) = &record.channel[VELOCITY] else { continue };
        if let (Some(force), true) = (&record.channel[FRICTION], channel == FRICTION) {
            let late = velocity.len() - velocity.len() / 4;
            let slip: Vec<f64> = (late..velocity.len())
                .map(|i| road_speed(&d.campaign.plan, &run.spec, record.time[i]) - velocity[i])
                .collect();
            cycles.push((slip, force[late..].to_vec(), class));
        }
        let weights = hann(velocity.len());
        let offset = mean(velocity, &weights);
        let frequencies: Vec<f64> = (1..160).map(|k| 50.0 * f64::from(k)).collect();
        let levels: Vec<f64> = frequencies
            .iter()
            .map(|f| 10.0 * (power(amplitude(velocity, &weights, offset, step, *f)) + 1e-7).log10())
            .collect();
        spectra.push((frequencies.iter().map(|f| f / 1e3).collect(), levels, class));
    }
    let trace = if channel == FRICTION {
        ("friction force", "friction force in N")
    } else {
        ("ring-down", "edge velocity in m/s")
    };
    for (title, labels, of) in [
        (trace.0, ["time in ms", trace.1], &traces),
        ("limit cycle", ["sliding speed in m/s", "friction force in N"], &cycles),
        ("spectrum", ["frequency in kHz", "level in dB re 1 m/s"], &spectra),
    ] {
        if !of.is_empty() {
            let of: Vec<_> = of
                .iter()
                .map(|(x, y, c): &(Vec<f64>, Vec<f64>, usize)| (&x[..], &y[..], *c))
                .collect();
            out.push_str(&lines(title, labels, &of, [360.0, 220.0]));
        }
    }
    out.push_str("</div></details>");
}

fn parameters(d: &Diagnosis, out: &mut String) {
    let best = diagnose::best_cause(&d.weighed);
    for (title, cause) in [("of the recalibrated model", Cause::None), ("with the effect", best)] {
        let _ = write!(out, "<h2>Parameters {title}</h2>");
        let mut grid = String::from(
            "<table><tr><th>parameter</th><th>prior</th><th>fitted</th>\
             <th>std</th><th>unit</th><th>sigmas from prior</th></tr>",
        );
        for p in json::parameters(d, &cause) {
            let number = |key: &str| p[key].as_f64().unwrap_or(f64::NAN);
            let _ = write!(
                grid,
                "<tr><td>{}</td><td>{:.4e}</td><td>{:.4e}</td><td>{:.1e}</td><td>{}</td><td>{:+.2}</td></tr>",
                p["name"].as_str().unwrap_or(""),
                number("prior"),
                number("value"),
                number("std"),
                p["unit"].as_str().unwrap_or(""),
                number("sigmas_from_prior")
            );
        }
        out.push_str(&page::wide(&format!("Parameters {title}"), &(grid + "</table>")));
    }
}

fn experiments(d: &Diagnosis, out: &mut String) {
    if d.experiments.is_empty() {
        return;
    }
    out.push_str("<h2>What to measure next</h2>");
    let mut grid = String::from("<table><tr><th>run</th><th>road speed</th><th>pressure</th><th>dwell</th><th>tells apart</th><th>expected nats</th></tr>");
    for e in &d.experiments {
        let _ = write!(
            grid,
            "<tr><td>{}</td><td>{:.3} m/s</td><td>{:.0} kPa</td><td>{:.0} ms</td><td>{} / {}</td><td>{:.1}</td></tr>",
            escape(&e.run.file),
            e.run.road_speed_m_s,
            e.run.mean_pressure_pa / 1e3,
            e.run.dwell_s * 1e3,
            escape(&e.between[0]),
            escape(&e.between[1]),
            e.gain
        );
    }
    out.push_str(&page::wide("What to measure next", &(grid + "</table>")));
}

fn provenance(d: &Diagnosis, out: &mut String) {
    let _ = write!(
        out,
        "<h2>Provenance</h2><p class=\"note\">Version {}, seed {}, {} simulations, {:.0} s, data {:016x}, \
         {} runs used of {}. A named effect is a class of models that the data are consistent with, no proof \
         of a mechanism.</p>",
        env!("CARGO_PKG_VERSION"),
        d.settings.seed,
        d.simulations(),
        d.seconds,
        d.campaign.hash(),
        d.campaign.runs.len(),
        d.campaign.plan.runs.len()
    );
}
