//! How firmly a compound stands: Table 1 with friction and damping a little stronger and weaker.
//!
//! Two limit cycles may exist side by side, and the border of silence may be near; a compound that is good at one point
//! only is good by luck.

use std::fmt::Write;

use super::identify::objective::Fineness;
use super::identify::space::{get, set};
use super::paper::Column;
use super::start::Start;
use super::table_one::TableOne;
use crate::block::Reductions;
use crate::params::Params;

/// A parameter and the factor on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Dotted name.
    pub parameter: &'static str,
    /// Factor.
    pub factor: f64,
}

const fn change(parameter: &'static str, factor: f64) -> Change {
    Change { parameter, factor }
}

/// What a compound should stand: one per cent of the fall of friction, and of damping.
pub const CHANGES: [Change; 4] = [
    change("friction.mu_drop", 1.01),
    change("friction.mu_drop", 0.99),
    change("rubber.stiffness_damping", 1.01),
    change("rubber.stiffness_damping", 0.99),
];

impl Change {
    /// `base` with this change.
    pub fn of(&self, base: &Params) -> Params {
        let mut params = base.clone();
        set(&mut params, self.parameter, self.factor * get(base, self.parameter));
        params
    }
}

/// Table 1 after each change.
pub fn tables(
    base: &Params,
    columns: &[Column],
    fineness: &Fineness,
    reductions: &Reductions,
) -> Vec<(Change, TableOne)> {
    let table = |change: &Change| {
        TableOne::simulate(&change.of(base), columns, fineness, Start::Braking, reductions)
    };
    CHANGES.iter().map(|change| (*change, table(change))).collect()
}

/// The tables as a sentence each.
pub fn text(tables: &[(Change, TableOne)]) -> String {
    let mut out = String::new();
    for (change, table) in tables {
        let wrong: Vec<String> = table.disagreements().iter().map(|c| c.place()).collect();
        let _ = writeln!(
            out,
            "{} {:+.0} %: median error {:.1} %, largest {:.1} %, silent or loud against the paper: {}.",
            change.parameter,
            100.0 * (change.factor - 1.0),
            100.0 * table.median_error(),
            100.0 * table.max_error(),
            if wrong.is_empty() { "no cell".to_string() } else { wrong.join(", ") }
        );
    }
    out
}

/// The tables as CSV.
pub fn csv(tables: &[(Change, TableOne)]) -> String {
    let mut out = String::from("parameter,factor,median,largest,wrong_cells\n");
    for (change, table) in tables {
        let (median, largest) = (table.median_error(), table.max_error());
        let (Change { parameter, factor }, wrong) = (change, table.disagreements().len());
        let _ = writeln!(out, "{parameter},{factor},{median:.4},{largest:.4},{wrong}");
    }
    out
}
