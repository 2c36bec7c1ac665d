//! Small drawings as inline SVG.

/// Colours of measured, recalibrated and repaired.
pub const COLOURS: [&str; 3] = ["#222222", "#d1495b", "#2a7f9e"];

/// A line: x, y, colour.
pub type Line<'a> = (&'a [f64], &'a [f64], &'a str);

/// Lines over common axes, with the ranges at the axes' ends.
pub fn lines(title: &str, unit: [&str; 2], of: &[Line<'_>], [width, height]: [f64; 2]) -> String {
    let (left, right, top, bottom) = (52.0, 8.0, 18.0, 26.0);
    let range = |pick: fn(&Line<'_>) -> Vec<f64>| {
        let all = of.iter().flat_map(pick).filter(|v| v.is_finite());
        let (a, b) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if b > a {
            (a, b)
        } else {
            (a - 1.0, a + 1.0)
        }
    };
    let (x0, x1) = range(|l| l.0.to_vec());
    let (y0, y1) = range(|l| l.1.to_vec());
    let px = |x: f64| left + (x - x0) / (x1 - x0) * (width - left - right);
    let py = |y: f64| height - bottom - (y - y0) / (y1 - y0) * (height - top - bottom);
    let mut out = format!(
        "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\">\
         <title>{title}</title><text x=\"{left}\" y=\"12\" class=\"t\">{title}</text>\
         <rect x=\"{left}\" y=\"{top}\" width=\"{:.1}\" height=\"{:.1}\" class=\"frame\"/>",
        width - left - right,
        height - top - bottom
    );
    for (x, anchor) in [(x0, "start"), (x1, "end")] {
        out.push_str(&format!(
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{} {}</text>",
            px(x),
            height - 10.0,
            short(x),
            unit[0]
        ));
    }
    for y in [y0, y1] {
        let at = if y == y0 { py(y) } else { py(y) + 9.0 };
        out.push_str(&format!(
            "<text x=\"{:.1}\" y=\"{at:.1}\" text-anchor=\"end\">{}</text>",
            left - 4.0,
            short(y)
        ));
    }
    out.push_str(&format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
        left - 4.0,
        0.5 * height,
        unit[1]
    ));
    for (x, y, colour) in of {
        let points: Vec<String> =
            x.iter().zip(y.iter()).map(|(x, y)| format!("{:.1},{:.1}", px(*x), py(*y))).collect();
        out.push_str(&format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1\"/>",
            points.join(" ")
        ));
    }
    out.push_str("</svg>");
    out
}

/// Horizontal bars with labels.
pub fn bars(of: &[(String, f64, String)], longest: f64) -> String {
    let height = 22.0 * of.len() as f64 + 6.0;
    let mut out = format!("<svg viewBox=\"0 0 640 {height}\" width=\"640\" height=\"{height}\">");
    for (k, (label, value, note)) in of.iter().enumerate() {
        let y = 4.0 + 22.0 * k as f64;
        let length = 330.0 * (value / longest).clamp(0.0, 1.0);
        out.push_str(&format!(
            "<text x=\"196\" y=\"{:.0}\" text-anchor=\"end\">{label}</text>\
             <rect x=\"202\" y=\"{y:.0}\" width=\"{length:.1}\" height=\"16\" class=\"bar\"/>\
             <text x=\"{:.1}\" y=\"{:.0}\">{note}</text>",
            y + 13.0,
            208.0 + length,
            y + 13.0
        ));
    }
    out.push_str("</svg>");
    out
}

fn short(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || (0.01..1e4).contains(&size) {
        let text = format!("{x:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        format!("{x:.1e}")
    }
}
