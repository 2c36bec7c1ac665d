//! `report.html`: one self-contained page.

mod heat_map;
mod overlay;

use super::decide::{self, Cause};
use super::diagnose::{self, Diagnosis};
use super::json;
use super::svg::bars;
use crate::page::{self, escape};
use heat_map::heat_map;
use overlay::overlays;
use std::fmt::Write;

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

/// What was wrong with the data and worked around.
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

/// How far: G of datasheet, recalibrated model, model with the effect, and the floor.
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
         <p class=\"note\">Held out: {}; on these alone it closes {:.0} %, the figure above is what further runs \
         are expected to show. Sham: the other effects, fitted with the same effort, close \
         {:.0} % (median).</p>",
        bars(&rows, longest),
        escape(&files.join(", ")),
        100.0 * gap.closed_unseen,
        100.0 * gap.sham
    );
}

/// Which cause, and in which module of the model.
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
    detectable(d, out);
}

/// The smallest severities that would have been seen, in the unit of the effect's first parameter.
fn detectable(d: &Diagnosis, out: &mut String) {
    out.push_str("<details><summary>Smallest severity that would have been seen</summary><table>");
    out.push_str(&page::columns(&["effect", "severity", "unit", "parameter"]));
    for ((effect, severity), spec) in d.detectable.iter().zip(d.bench.specs) {
        let name = spec.forms[0].params[0].name;
        let _ = write!(
            out,
            "<tr><td>{effect}</td><td>{severity:.3e}</td><td>{}</td><td>{name}</td></tr>",
            json::unit(name)
        );
    }
    out.push_str("</table></details>");
}

/// A run's file without folder and ending.
fn short(file: &str) -> &str {
    file.trim_start_matches("runs/").trim_end_matches(".csv")
}

/// Fitted parameters beside their priors.
fn parameters(d: &Diagnosis, out: &mut String) {
    let best = diagnose::best_cause(&d.weighed);
    for (title, cause) in [("of the recalibrated model", Cause::None), ("with the effect", best)] {
        let _ = write!(out, "<h2>Parameters {title}</h2>");
        let mut grid = String::from("<table>");
        grid.push_str(&page::columns(&[
            "parameter",
            "prior",
            "fitted",
            "std",
            "unit",
            "sigmas from prior",
        ]));
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

/// Runs that would tell the likeliest causes apart.
fn experiments(d: &Diagnosis, out: &mut String) {
    if d.experiments.is_empty() {
        return;
    }
    out.push_str("<h2>What to measure next</h2>");
    let mut grid = String::from("<table>");
    grid.push_str(&page::columns(&[
        "run",
        "road speed",
        "pressure",
        "dwell",
        "tells apart",
        "expected nats",
    ]));
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

/// What the page was made of.
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
