//! Small drawings for reports: curves as inline SVG, bars as HTML. Colours come from the page's style.

use crate::page::escape;

/// A curve: x, y, and its class (0 measured, 1 recalibrated, 2 with the effect).
pub type Line<'a> = (&'a [f64], &'a [f64], usize);

/// Room beside the axes for their labels \[px\].
const LEFT: f64 = 54.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 20.0;
const BOTTOM: f64 = 36.0;

/// One axis: its range and its place in the picture.
struct Axis {
    range: (f64, f64),
    pixels: (f64, f64),
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, pixels: (f64, f64)) -> Self {
        let (a, b) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let range = if b > a { (a, b) } else { (a.min(0.0) - 1.0, a.max(0.0) + 1.0) };
        let range = if range.0.is_finite() && range.1.is_finite() { range } else { (0.0, 1.0) };
        Self { range, pixels }
    }

    fn at(&self, x: f64) -> f64 {
        let ((a, b), (p, q)) = (self.range, self.pixels);
        p + (x - a) / (b - a) * (q - p)
    }

    /// Two to seven round numbers within the range, and how many decimals they need.
    fn ticks(&self) -> (Vec<f64>, usize) {
        let (a, b) = self.range;
        let power = 10f64.powf(((b - a) / 6.0).log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
        let step = steps.into_iter().find(|s| (b - a) / s <= 6.0).unwrap_or(10.0 * power);
        let first = (a / step).ceil() as i64;
        let last = (b / step).floor() as i64;
        let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
        ((first..=last).map(|k| k as f64 * step).collect(), decimals)
    }
}

/// Curves over common axes; `labels` are quantity and unit of x and y.
pub fn lines(title: &str, labels: [&str; 2], of: &[Line<'_>], [width, height]: [f64; 2]) -> String {
    let axes = Axes {
        x: Axis::over(of.iter().flat_map(|l| l.0.iter().copied()), (LEFT, width - RIGHT)),
        y: Axis::over(of.iter().flat_map(|l| l.1.iter().copied()), (height - BOTTOM, TOP)),
    };
    let [title, x, y] = [title, labels[0], labels[1]].map(escape);
    let mut out = format!(
        "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\" \
         aria-label=\"{title}: {y} over {x}\">\
         <text x=\"{LEFT}\" y=\"13\" class=\"t\">{title}</text>"
    );
    out.push_str(&axes.grid());
    out.push_str(&axes.frame(&x, &y));
    out.extend(of.iter().map(|line| axes.curve(line)));
    out.push_str("</svg>");
    out
}

/// The axes of a picture.
struct Axes {
    x: Axis,
    y: Axis,
}

impl Axes {
    /// Right and lower end \[px\].
    fn corner(&self) -> (f64, f64) {
        (self.x.pixels.1, self.y.pixels.0)
    }

    /// Lines and numbers at the ticks.
    fn grid(&self) -> String {
        let (right, bottom) = self.corner();
        let mut out = String::new();
        let (ticks, decimals) = self.x.ticks();
        for (at, x) in ticks.iter().map(|x| (self.x.at(*x), x)) {
            out.push_str(&format!(
                "<path d=\"M{at:.1} {TOP}V{bottom}\" class=\"grid\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{x:.decimals$}</text>",
                bottom + 13.0
            ));
        }
        let (ticks, decimals) = self.y.ticks();
        for (at, y) in ticks.iter().map(|y| (self.y.at(*y), y)) {
            out.push_str(&format!(
                "<path d=\"M{LEFT} {at:.1}H{right}\" class=\"grid\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{y:.decimals$}</text>",
                LEFT - 4.0,
                at + 4.0
            ));
        }
        out
    }

    /// The frame, and what the axes show.
    fn frame(&self, x: &str, y: &str) -> String {
        let (right, bottom) = self.corner();
        let middle = 0.5 * (TOP + bottom);
        format!(
            "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\" class=\"frame\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{x}</text>\
             <text transform=\"translate(12 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{y}</text>",
            right - LEFT,
            bottom - TOP,
            0.5 * (LEFT + right),
            bottom + BOTTOM - 6.0
        )
    }

    fn curve(&self, (x, y, class): &Line<'_>) -> String {
        let points: Vec<String> = x
            .iter()
            .zip(y.iter())
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .map(|(x, y)| format!("{:.1},{:.1}", self.x.at(*x), self.y.at(*y)))
            .collect();
        format!("<polyline points=\"{}\" class=\"l{class}\"/>", points.join(" "))
    }
}

/// A short stroke of a curve's class, for legends.
pub fn key(class: usize) -> String {
    format!(
        "<svg class=\"key\" width=\"30\" height=\"10\" aria-hidden=\"true\">\
         <path d=\"M0 5H30\" class=\"l{class}\"/></svg>"
    )
}

/// Horizontal bars with labels and notes; a table, so that it reads well without eyes.
pub fn bars(of: &[(String, f64, String)], longest: f64) -> String {
    let mut out = String::from("<table class=\"bars\">");
    for (label, value, note) in of {
        let share = (value / longest).clamp(0.0, 1.0);
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td><span class=\"bar\" style=\"width:{:.1}%\"></span>{}</td></tr>",
            // Blanks, so that long names break on phones.
            escape(&label.replace('_', " ")),
            55.0 * share,
            escape(note)
        ));
    }
    out.push_str("</table>");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_says_what_is_drawn_over_what() {
        let svg = lines("spectrum", ["f in kHz", "level in dB"], &[], [100.0, 100.0]);
        assert!(svg.contains("role=\"img\" aria-label=\"spectrum: level in dB over f in kHz\""));
    }

    #[test]
    fn ticks_are_round_and_lie_within_the_range() {
        for (range, expected) in [
            ((0.0, 24.0), vec![0.0, 5.0, 10.0, 15.0, 20.0]),
            ((-70.0, -61.0), vec![-70.0, -68.0, -66.0, -64.0, -62.0]),
            ((0.05, 7.95), vec![2.0, 4.0, 6.0]),
            ((-0.157, 0.295), vec![-0.1, 0.0, 0.1, 0.2]),
        ] {
            let axis = Axis { range, pixels: (0.0, 1.0) };
            assert_eq!(axis.ticks().0, expected, "{range:?}");
        }
    }

    #[test]
    fn a_curve_without_a_range_or_a_number_still_makes_a_picture() {
        for values in [vec![], vec![f64::NAN, 1.0], vec![5.0, 5.0]] {
            let svg = lines("t", ["x", "y"], &[(&values, &values, 0)], [100.0, 100.0]);
            assert!(
                svg.ends_with("</svg>") && !svg.contains("NaN") && !svg.contains("inf"),
                "{svg}"
            );
        }
    }
}
