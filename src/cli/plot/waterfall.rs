//! Spectra of several runs above each other: a waterfall, as over a sweep of the road speed.

use plotters::prelude::*;

use super::panels::{self, BLUE_LINE};
use super::table::Run;
use crate::error::Fault;
use crate::metrics;

/// Highest frequency drawn [kHz].
const HIGHEST: f64 = 10.0;

/// A waterfall of the settled velocity's spectra, the first run at the bottom: over the road speed
/// \[m/s\] where `speeds` has one per run, or else evenly with the runs' names.
pub fn draw(runs: &[(String, Run)], speeds: &[f64]) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let height = 220 + 70 * runs.len() as u32;
        let root = SVGBackend::with_string(&mut svg, (1000, height)).into_drawing_area();
        chart(&root, runs, speeds)
            .and_then(|()| root.present().map_err(|e| e.to_string()))
            .map_err(|reason| Fault::unusable("plot", reason))?;
    }
    Ok(svg)
}

fn chart(root: &panels::Area, runs: &[(String, Run)], speeds: &[f64]) -> Result<(), String> {
    root.fill(&WHITE).map_err(|e| e.to_string())?;
    let spectra: Vec<Vec<(f64, f64)>> = runs
        .iter()
        .map(|(_, run)| panels::spectra(run, metrics::settled_from(&run.velocity)).0)
        .collect();
    let largest = spectra.iter().flatten().map(|p| p.1).fold(1e-9, f64::max);
    let over_speed = !speeds.is_empty();
    let floors: Vec<f64> =
        if over_speed { speeds.to_vec() } else { (0..runs.len()).map(|i| i as f64).collect() };
    // The largest peak is as high as the mean distance of the curves.
    let last = floors.len() - 1;
    let height = (floors[last] - floors[0]) / last as f64;
    let title = "Spectra of the run-in edge's velocity (settled part)";
    let mut chart = ChartBuilder::on(root)
        .caption(title, ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(if over_speed { 66 } else { 20 })
        .build_cartesian_2d(0.0..HIGHEST, floors[0] - 0.1 * height..floors[last] + 1.2 * height)
        .map_err(|e| e.to_string())?;
    let mut mesh = chart.configure_mesh();
    mesh.disable_y_mesh()
        .x_desc("frequency [kHz]")
        .axis_desc_style(("sans-serif", 15))
        .label_style(("sans-serif", 13))
        .light_line_style(WHITE)
        .x_label_formatter(&panels::tick)
        .y_label_formatter(&panels::tick);
    if over_speed {
        mesh.y_desc("road speed [m/s]");
    } else {
        mesh.disable_y_axis();
    }
    mesh.draw().map_err(|e| e.to_string())?;
    for (((name, _), spectrum), floor) in runs.iter().zip(&spectra).zip(&floors).rev() {
        let floor = *floor;
        let curve = || spectrum.iter().map(move |(f, a)| (*f, floor + height * a / largest));
        let area = AreaSeries::new(curve(), floor, BLUE_LINE.mix(0.25));
        chart.draw_series(area).map_err(|e| e.to_string())?;
        let line = LineSeries::new(curve(), BLUE_LINE);
        chart.draw_series(line).map_err(|e| e.to_string())?;
        let place = (0.86 * HIGHEST, floor + 0.15 * height);
        chart
            .draw_series([Text::new(name.clone(), place, ("sans-serif", 13))])
            .map_err(|e| e.to_string())?;
    }
    // The scale of the amplitudes: a bar as high as the largest peak.
    let bar = [(0.015 * HIGHEST, floors[last]), (0.015 * HIGHEST, floors[last] + height)];
    chart.draw_series(LineSeries::new(bar, BLACK.stroke_width(2))).map_err(|e| e.to_string())?;
    let scale = format!("{largest:.0} mm/s");
    let place = (0.025 * HIGHEST, floors[last] + 0.6 * height);
    let text = Text::new(scale, place, ("sans-serif", 13));
    chart.draw_series([text]).map_err(|e| e.to_string())?;
    Ok(())
}
