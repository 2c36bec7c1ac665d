//! Where in the data: the gap as a table of runs, channels and phases, warmer where it is larger.

use super::short;
use crate::gap::campaign::CHANNELS;
use crate::gap::diagnose::Diagnosis;
use crate::page::{self, escape};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The channels in a reader's words, in the order of [`CHANNELS`].
const SPOKEN: [&str; CHANNELS.len()] =
    ["friction force", "normal force", "edge velocity", "edge displacement", "carriage approach"];

/// The gap of the recalibrated model by run, channel and phase.
pub(super) fn heat_map(d: &Diagnosis, out: &mut String) {
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
    let mut grid = String::from("<table><tr><th scope=\"col\">run</th>");
    for (channel, phase) in &columns {
        let _ = write!(grid, "<th scope=\"col\">{}<br>{phase}</th>", SPOKEN[*channel]);
    }
    grid.push_str("</tr>");
    for (run, cells) in &rows {
        let _ = write!(grid, "<tr><th scope=\"row\">{}</th>", escape(short(run)));
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
