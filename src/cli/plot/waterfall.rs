//! Spectra of several runs above each other: a waterfall, as over a sweep of the road speed.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::panels::{self, Area, Points, BLUE_LINE};
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
        Waterfall::of(runs, speeds)
            .draw(&root)
            .and_then(|()| root.present().map_err(|e| e.to_string()))
            .map_err(|reason| Fault::unusable("plot", reason))?;
    }
    Ok(svg)
}

/// Frequency \[kHz\] to the right, road speed or number of the run upward.
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// What is drawn where.
struct Waterfall<'a> {
    /// Names and spectra of the runs.
    spectra: Vec<(&'a str, Points)>,
    /// Where each spectrum's zero lies.
    floors: Vec<f64>,
    /// Is it the road speed that goes upward?
    over_speed: bool,
    /// Largest amplitude \[mm/s\].
    largest: f64,
    /// Height of the largest amplitude: the mean distance of the spectra.
    height: f64,
}

impl<'a> Waterfall<'a> {
    fn of(runs: &'a [(String, Run)], speeds: &[f64]) -> Self {
        let spectrum = |run: &Run| panels::spectra(run, metrics::settled_from(&run.velocity)).0;
        let spectra: Vec<(&str, Points)> =
            runs.iter().map(|(name, run)| (name.as_str(), spectrum(run))).collect();
        let largest = spectra.iter().flat_map(|(_, s)| s).map(|p| p.1).fold(1e-9, f64::max);
        let over_speed = !speeds.is_empty();
        let floors: Vec<f64> =
            if over_speed { speeds.to_vec() } else { (0..runs.len()).map(|i| i as f64).collect() };
        let last = floors.len() - 1;
        let height = (floors[last] - floors[0]) / last as f64;
        Self { spectra, floors, over_speed, largest, height }
    }

    fn draw(&self, root: &Area) -> Result<(), String> {
        root.fill(&WHITE).map_err(|e| e.to_string())?;
        let mut chart = self.axes(root)?;
        for ((name, spectrum), floor) in self.spectra.iter().zip(&self.floors).rev() {
            self.spectrum(&mut chart, name, spectrum, *floor)?;
        }
        self.scale(&mut chart)
    }

    fn top(&self) -> f64 {
        self.floors[self.floors.len() - 1]
    }

    fn axes<'r, 'b>(&self, root: &'r Area<'b>) -> Result<Chart<'r, 'b>, String> {
        let upward = self.floors[0] - 0.1 * self.height..self.top() + 1.2 * self.height;
        let mut chart = ChartBuilder::on(root)
            .caption("Spectra of the run-in edge's velocity (settled part)", ("sans-serif", 17))
            .margin(14)
            .x_label_area_size(42)
            .y_label_area_size(if self.over_speed { 66 } else { 20 })
            .build_cartesian_2d(0.0..HIGHEST, upward)
            .map_err(|e| e.to_string())?;
        let mut mesh = chart.configure_mesh();
        mesh.disable_y_mesh()
            .x_desc("frequency [kHz]")
            .axis_desc_style(("sans-serif", 15))
            .label_style(("sans-serif", 13))
            .light_line_style(WHITE)
            .x_label_formatter(&panels::tick)
            .y_label_formatter(&panels::tick);
        if self.over_speed {
            mesh.y_desc("road speed [m/s]");
        } else {
            mesh.disable_y_axis();
        }
        mesh.draw().map_err(|e| e.to_string())?;
        Ok(chart)
    }

    /// One run's spectrum with its name.
    fn spectrum(
        &self,
        chart: &mut Chart,
        name: &str,
        spectrum: &Points,
        floor: f64,
    ) -> Result<(), String> {
        let (height, largest) = (self.height, self.largest);
        let curve = || spectrum.iter().map(move |(f, a)| (*f, floor + height * a / largest));
        let area = AreaSeries::new(curve(), floor, BLUE_LINE.mix(0.25));
        chart.draw_series(area).map_err(|e| e.to_string())?;
        chart.draw_series(LineSeries::new(curve(), BLUE_LINE)).map_err(|e| e.to_string())?;
        let place = (0.86 * HIGHEST, floor + 0.15 * height);
        let name = Text::new(name.to_string(), place, ("sans-serif", 13));
        chart.draw_series([name]).map_err(|e| e.to_string())?;
        Ok(())
    }

    /// The scale of the amplitudes: a bar as high as the largest.
    fn scale(&self, chart: &mut Chart) -> Result<(), String> {
        let (x, top, height) = (0.015 * HIGHEST, self.top(), self.height);
        let bar = [(x, top), (x, top + height)];
        chart
            .draw_series(LineSeries::new(bar, BLACK.stroke_width(2)))
            .map_err(|e| e.to_string())?;
        let scale = format!("{:.0} mm/s", self.largest);
        let place = (0.025 * HIGHEST, top + 0.6 * height);
        let text = Text::new(scale, place, ("sans-serif", 13));
        chart.draw_series([text]).map_err(|e| e.to_string())?;
        Ok(())
    }
}
