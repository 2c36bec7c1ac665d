//! Line plots as SVG: panels in a grid, the paper's numbers as dots beside our curves.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::error::Fault;

/// Colours that also colour-blind people tell apart (Okabe and Ito).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
];
const PANEL: (u32, u32) = (620, 400);

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// Dots: what the paper or a measurement says.
    Dots,
}

/// A series of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Line or dots.
    pub mark: Mark,
    /// Which colour; series of one colour belong together.
    pub color: usize,
}

impl Series {
    /// A line in the colour of its place.
    pub fn line(name: impl Into<String>, color: usize, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, mark: Mark::Line, color }
    }

    /// Dots.
    pub fn dots(name: impl Into<String>, color: usize, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, mark: Mark::Dots, color }
    }
}

/// One diagram.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Labels of the axes, with units.
    pub axes: [&'static str; 2],
    /// What is drawn.
    pub series: Vec<Series>,
    /// Is x logarithmic?
    pub log_x: bool,
    /// Same scale on both axes: shapes, not curves.
    pub to_scale: bool,
}

impl Panel {
    /// A diagram with linear axes.
    pub fn new(title: impl Into<String>, axes: [&'static str; 2], series: Vec<Series>) -> Self {
        Self { title: title.into(), axes, series, log_x: false, to_scale: false }
    }
}

/// Draws panels in rows of `columns`.
///
/// # Errors
/// What the drawing library says.
pub fn svg(panels: &[Panel], columns: usize) -> Result<String, Fault> {
    let rows = panels.len().div_ceil(columns).max(1);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = root.fill(&WHITE).map_err(|e| e.to_string()).and_then(|()| {
            root.split_evenly((rows, columns))
                .iter()
                .zip(panels)
                .try_for_each(|(area, panel)| draw(area, panel))
        });
        drawn
            .and_then(|()| root.present().map_err(|e| e.to_string()))
            .map_err(|reason| Fault::unusable("plot", reason))?;
    }
    Ok(text)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn draw(area: &Area, panel: &Panel) -> Result<(), String> {
    let (mut x, mut y) = (range(panel, |p| p.0, panel.log_x), range(panel, |p| p.1, false));
    if panel.to_scale {
        equal_scales(&mut x, &mut y);
    }
    let entries = entries(panel);
    let rows = entries.last().map_or(0, |e| e.row + 1);
    let (area, below) = area.split_vertically(PANEL.1 - rows * ROW);
    legend(&below, &entries).map_err(|e| e.to_string())?;
    let mut builder = ChartBuilder::on(&area);
    builder
        .caption(&panel.title, ("sans-serif", 17))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(62);
    if panel.log_x {
        let chart = builder.build_cartesian_2d((x.0..x.1).log_scale(), y.0..y.1);
        finish(chart.map_err(|e| e.to_string())?, panel)
    } else {
        let chart = builder.build_cartesian_2d(x.0..x.1, y.0..y.1);
        finish(chart.map_err(|e| e.to_string())?, panel)
    }
}

fn finish<'a, X>(
    mut chart: ChartContext<
        'a,
        SVGBackend<'a>,
        Cartesian2d<X, plotters::coord::types::RangedCoordf64>,
    >,
    panel: &Panel,
) -> Result<(), String>
where
    X: Ranged<ValueType = f64> + plotters::coord::ranged1d::ValueFormatter<f64>,
{
    let told = |e: DrawingAreaErrorKind<_>| format!("{e:?}");
    chart
        .configure_mesh()
        .x_desc(panel.axes[0])
        .y_desc(panel.axes[1])
        .light_line_style(TRANSPARENT)
        .x_labels(8)
        .y_labels(7)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(told)?;
    for series in &panel.series {
        let color = COLORS[series.color % COLORS.len()];
        match series.mark {
            Mark::Line => chart.draw_series(LineSeries::new(series.points.iter().copied(), &color)),
            Mark::Dots => chart.draw_series(PointSeries::<_, _, Circle<_, _>, _>::new(
                series.points.iter().copied(),
                4,
                color.filled(),
            )),
        }
        .map_err(told)?;
    }
    Ok(())
}

/// Height of a row of the legend, below the diagram, where it hides nothing.
const ROW: u32 = 19;
/// Left end of its rows.
const INDENT: i32 = 74;

/// A name in the legend and where it stands.
struct Entry<'a> {
    name: &'a str,
    color: RGBColor,
    x: i32,
    row: u32,
}

/// The names of the series, in rows as wide as the panel.
fn entries(panel: &Panel) -> Vec<Entry<'_>> {
    let (mut x, mut row) = (INDENT, 0);
    let mut out = Vec::new();
    for series in panel.series.iter().filter(|s| !s.name.is_empty()) {
        // A letter of the font is 7 pixels wide or a little more.
        let width = 34 + 7 * series.name.chars().count() as i32;
        if x > INDENT && x + width > PANEL.0 as i32 {
            (x, row) = (INDENT, row + 1);
        }
        out.push(Entry { name: &series.name, color: COLORS[series.color % COLORS.len()], x, row });
        x += width;
    }
    out
}

fn legend<'a>(
    area: &Area<'a>,
    entries: &[Entry<'_>],
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    for entry in entries {
        let (x, y) = (entry.x, (entry.row * ROW) as i32);
        area.draw(&Rectangle::new([(x, y + 3), (x + 14, y + 11)], entry.color.filled()))?;
        area.draw(&Text::new(entry.name.to_string(), (x + 20, y), ("sans-serif", 13)))?;
    }
    Ok(())
}

/// Range of a coordinate over all series, with a margin.
fn range(panel: &Panel, pick: fn(&(f64, f64)) -> f64, logarithmic: bool) -> (f64, f64) {
    let all = panel.series.iter().flat_map(|s| s.points.iter().map(pick)).filter(|x| x.is_finite());
    let (low, high) =
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    if low > high {
        return (0.1, 1.0);
    }
    if logarithmic {
        return (low, high.max(1.01 * low));
    }
    let margin = (0.04 * (high - low)).max(1e-9 + 1e-3 * high.abs());
    (low - margin, high + margin)
}

/// Widens one of the ranges until a unit is as long on both axes of a panel.
fn equal_scales(x: &mut (f64, f64), y: &mut (f64, f64)) {
    let (wide, tall) = (f64::from(PANEL.0 - 98), f64::from(PANEL.1 - 90));
    let unit = ((x.1 - x.0) / wide).max((y.1 - y.0) / tall);
    for (range, pixels) in [(x, wide), (y, tall)] {
        let middle = 0.5 * (range.0 + range.1);
        *range = (middle - 0.5 * unit * pixels, middle + 0.5 * unit * pixels);
    }
}
