//! The panels: displacement, forces, limit cycle, spectrum, pressure over the face.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::spectrum;
use super::table::Run;
use crate::error::Fault;
use crate::metrics;
use crate::scenario::Spline;

/// Two colours that also colour-blind people tell apart (Okabe and Ito's blue and vermilion).
pub(super) const BLUE_LINE: RGBColor = RGBColor(0, 114, 178);
const RED_LINE: RGBColor = RGBColor(213, 94, 0);
const SIZE: (u32, u32) = (1100, 1240);

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), String>;
pub(super) type Points = Vec<(f64, f64)>;

/// A curve with its name and colour.
struct Curve<'a> {
    name: &'a str,
    color: RGBColor,
    points: Points,
}

/// All panels as one SVG.
pub fn draw(run: &Run) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        panels(&root, run)
            .and_then(|()| root.present().map_err(|e| e.to_string()))
            .map_err(|reason| Fault::unusable("plot", reason))?;
    }
    Ok(svg)
}

fn panels(root: &Area, run: &Run) -> Drawn {
    root.fill(&WHITE).map_err(|e| e.to_string())?;
    let areas = root.split_evenly((3, 2));
    let over_time = |values: &[f64], factor: f64| -> Points {
        run.time.iter().zip(values).map(|(t, v)| (1e3 * t, factor * v)).collect()
    };
    let edges = [
        Curve { name: "run-in edge", color: BLUE_LINE, points: over_time(&run.run_in, 1e6) },
        Curve { name: "run-out edge", color: RED_LINE, points: over_time(&run.run_out, 1e6) },
    ];
    lines(&areas[0], "Displacement of the edges", ["time [ms]", "displacement [µm]"], &edges)?;
    let forces = [
        Curve { name: "tangential", color: BLUE_LINE, points: over_time(&run.forces[0], 1.0) },
        Curve { name: "normal", color: RED_LINE, points: over_time(&run.forces[1], 1.0) },
    ];
    lines(&areas[1], "Forces of the road on the block", ["time [ms]", "force [N]"], &forces)?;
    let from = metrics::settled_from(&run.velocity);
    let cycle = run.run_in[from..].iter().zip(&run.velocity[from..]);
    let cycle = Curve {
        name: "",
        color: BLUE_LINE,
        points: cycle.map(|(x, v)| (1e6 * x, 1e3 * v)).collect(),
    };
    let axes = ["displacement [µm]", "velocity [mm/s]"];
    lines(&areas[2], "Limit cycle of the run-in edge (settled part)", axes, &[cycle])?;
    let (spectrum, thirds) = spectra(run, from);
    lines(
        &areas[3],
        "Spectrum of the run-in velocity (settled part)",
        ["frequency [kHz]", "velocity [mm/s]"],
        &[
            Curve { name: "amplitude", color: BLUE_LINE, points: spectrum },
            Curve { name: "third octaves, rms", color: RED_LINE, points: thirds },
        ],
    )?;
    pressure_map(&areas[4], run)?;
    pressure_mean(&areas[5], run, from)
}

/// Amplitudes and third octaves (as steps) of the settled velocity in kHz and mm/s.
pub(super) fn spectra(run: &Run, from: usize) -> (Points, Points) {
    let time = &run.time[from..];
    let n = time.len();
    let step = (time[n - 1] - time[0]) / (n - 1) as f64;
    let spline = Spline::natural(time, &run.velocity[from..]);
    let even: Vec<f64> = (0..n).map(|i| spline.at(time[0] + i as f64 * step).0).collect();
    let lines = spectrum::amplitudes(step, &even, 10e3);
    let half_band = 10f64.powf(0.05);
    let thirds = spectrum::third_octaves(&lines)
        .into_iter()
        .flat_map(|(f, a)| [(1e-3 * f / half_band, 1e3 * a), (1e-3 * f * half_band, 1e3 * a)])
        .collect();
    (lines.into_iter().map(|(f, a)| (1e-3 * f, 1e3 * a)).collect(), thirds)
}

/// Range of values with a margin, never empty.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    low - margin..high + margin
}

/// A number at an axis: no more digits than it needs.
pub(super) fn tick(value: &f64) -> String {
    let digits = format!("{value:.4}");
    match digits.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_string(),
        short => short.to_string(),
    }
}

fn lines(area: &Area, title: &str, [x_axis, y_axis]: [&str; 2], curves: &[Curve]) -> Drawn {
    let points = || curves.iter().flat_map(|c| c.points.iter());
    let (xs, mut ys) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)));
    if curves.iter().any(|c| !c.name.is_empty()) {
        // Room for the legend above the curves.
        ys.end += 0.2 * (ys.end - ys.start);
    }
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(66)
        .build_cartesian_2d(xs, ys)
        .map_err(|e| e.to_string())?;
    chart
        .configure_mesh()
        .x_desc(x_axis)
        .y_desc(y_axis)
        .axis_desc_style(("sans-serif", 15))
        .label_style(("sans-serif", 13))
        .light_line_style(WHITE)
        .x_label_formatter(&tick)
        .y_label_formatter(&tick)
        .x_labels(7)
        .y_labels(7)
        .draw()
        .map_err(|e| e.to_string())?;
    for curve in curves {
        let color = curve.color;
        let series = LineSeries::new(curve.points.iter().copied(), color.stroke_width(1));
        let drawn = chart.draw_series(series).map_err(|e| e.to_string())?;
        if !curve.name.is_empty() {
            drawn.label(curve.name).legend(move |(x, y)| {
                PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2))
            });
        }
    }
    if curves.iter().any(|c| !c.name.is_empty()) {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 13))
            .draw()
            .map_err(|e| e.to_string())?;
    }
    Ok(())
}

/// Columns of the map: more are not seen and make a heavy file.
const MOST_COLUMNS: usize = 160;

/// Contact pressure over face and time, from white (none) over orange to black (largest).
fn pressure_map(area: &Area, run: &Run) -> Drawn {
    let largest = run.pressure.iter().flatten().copied().fold(0.0, f64::max);
    let title = format!("Contact pressure over the face; black: {:.0} kPa", 1e-3 * largest);
    let stations = run.pressure.len();
    let rows = run.time.len();
    let stride = rows.div_ceil(MOST_COLUMNS);
    let (start, end) = (1e3 * run.time[0], 1e3 * run.time[rows - 1]);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(42)
        .y_label_area_size(66)
        .build_cartesian_2d(start..end, 0.5..stations as f64 + 0.5)
        .map_err(|e| e.to_string())?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("time [ms]")
        .y_desc("station, 1 = run-in edge")
        .axis_desc_style(("sans-serif", 15))
        .label_style(("sans-serif", 13))
        .x_label_formatter(&tick)
        .y_label_formatter(&tick)
        .x_labels(7)
        .draw()
        .map_err(|e| e.to_string())?;
    let cells = (0..rows).step_by(stride).flat_map(|row| {
        let until = 1e3 * run.time[(row + stride).min(rows - 1)];
        run.pressure.iter().enumerate().map(move |(station, column)| {
            let last = (row + stride).min(rows);
            let share =
                column[row..last].iter().sum::<f64>() / (last - row) as f64 / largest.max(1.0);
            let low = station as f64 + 0.5;
            Rectangle::new([(1e3 * run.time[row], low), (until, low + 1.0)], shade(share).filled())
        })
    });
    chart.draw_series(cells).map_err(|e| e.to_string())?;
    Ok(())
}

/// Brightness falls evenly from white over orange to black: readable in grey and colour-blind.
fn shade(share: f64) -> RGBColor {
    let s = share.clamp(0.0, 1.0);
    let channel = |weight: f64| (255.0 * (1.0 - s.powf(weight))) as u8;
    RGBColor(channel(2.5), channel(1.0), channel(0.45))
}

/// Mean and largest pressure at each station in the settled part.
fn pressure_mean(area: &Area, run: &Run, from: usize) -> Drawn {
    let over_face = |reduce: &dyn Fn(&[f64]) -> f64| -> Points {
        let columns = run.pressure.iter().enumerate();
        columns.map(|(i, c)| (i as f64 + 1.0, 1e-3 * reduce(&c[from..]))).collect()
    };
    let mean = |c: &[f64]| c.iter().sum::<f64>() / c.len() as f64;
    let largest = |c: &[f64]| c.iter().copied().fold(0.0, f64::max);
    let curves = [
        Curve { name: "mean", color: BLUE_LINE, points: over_face(&mean) },
        Curve { name: "largest", color: RED_LINE, points: over_face(&largest) },
    ];
    let axes = ["station, 1 = run-in edge", "pressure [kPa]"];
    lines(area, "Contact pressure over the face (settled part)", axes, &curves)
}
