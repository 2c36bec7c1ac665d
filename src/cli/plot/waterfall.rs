//! Spectra of several runs above each other: a waterfall, as over a sweep of the road speed.

use plotters::prelude::*;

use super::panels::{self, BLUE_LINE};
use super::table::Run;
use crate::error::Fault;
use crate::metrics;

/// Highest frequency drawn [kHz].
const HIGHEST: f64 = 10.0;

/// A waterfall of the settled velocity's spectra, the first run at the bottom.
pub fn draw(runs: &[(String, Run)]) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let height = 220 + 70 * runs.len() as u32;
        let root = SVGBackend::with_string(&mut svg, (1000, height)).into_drawing_area();
        chart(&root, runs)
            .and_then(|()| root.present().map_err(|e| e.to_string()))
            .map_err(|reason| Fault::File { path: "plot".to_string(), reason })?;
    }
    Ok(svg)
}

fn chart(root: &panels::Area, runs: &[(String, Run)]) -> Result<(), String> {
    root.fill(&WHITE).map_err(|e| e.to_string())?;
    let spectra: Vec<Vec<(f64, f64)>> = runs
        .iter()
        .map(|(_, run)| panels::spectra(run, metrics::settled_from(&run.velocity)).0)
        .collect();
    let largest = spectra.iter().flatten().map(|p| p.1).fold(1e-9, f64::max);
    let title = format!("Spectra of the run-in velocity; one step of height: {largest:.0} mm/s");
    let mut chart = ChartBuilder::on(root)
        .caption(title, ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(20)
        .build_cartesian_2d(0.0..HIGHEST, 0.0..runs.len() as f64 + 0.6)
        .map_err(|e| e.to_string())?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .x_desc("frequency [kHz]")
        .axis_desc_style(("sans-serif", 15))
        .label_style(("sans-serif", 13))
        .light_line_style(WHITE)
        .draw()
        .map_err(|e| e.to_string())?;
    for (level, ((name, _), spectrum)) in runs.iter().zip(&spectra).enumerate().rev() {
        let floor = level as f64;
        let curve = || spectrum.iter().map(move |(f, a)| (*f, floor + a / largest));
        let area = AreaSeries::new(curve(), floor, BLUE_LINE.mix(0.25));
        chart.draw_series(area).map_err(|e| e.to_string())?;
        let line = LineSeries::new(curve(), BLUE_LINE);
        chart.draw_series(line).map_err(|e| e.to_string())?;
        let label = Text::new(name.clone(), (0.86 * HIGHEST, floor + 0.15), ("sans-serif", 13));
        chart.draw_series([label]).map_err(|e| e.to_string())?;
    }
    Ok(())
}
