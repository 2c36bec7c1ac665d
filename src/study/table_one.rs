//! Table 1 on our own model, beside the paper's.

use std::fmt::Write;

use super::identify::objective::{compare, Compared, Fineness};
use super::paper::{Cell, Column, SPEEDS, TABLE_1};
use super::slides::Reductions;
use crate::params::Params;

/// The table and how well it fits.
#[derive(Clone, Debug)]
pub struct TableOne {
    /// All cells, column by column, in the order of rising speed.
    pub cells: Vec<Compared>,
}

impl TableOne {
    /// Simulates the columns with the parameters of `base`; only geometry and solver are changed.
    pub fn simulate(base: &Params, columns: &[Column], fineness: &Fineness) -> Self {
        let mut cells = compare(base, columns, fineness, 1.5, &Reductions::default());
        let place = |c: &Compared| TABLE_1.iter().position(|t| t.name == c.column.name);
        cells.sort_by_key(|c| (place(c), c.row));
        Self { cells }
    }

    /// Median of the magnitudes of the relative errors over the legible frequencies; a cell that is
    /// silent where the paper's is not counts as 100 %.
    pub fn median_error(&self) -> f64 {
        let mut errors = self.errors();
        errors.sort_by(f64::total_cmp);
        match errors.len() {
            0 => 0.0,
            n => 0.5 * (errors[n / 2] + errors[(n - 1) / 2]),
        }
    }

    /// Largest error.
    pub fn max_error(&self) -> f64 {
        self.errors().into_iter().fold(0.0, f64::max)
    }

    /// Cells that oscillate where the paper's are silent, or the other way round.
    pub fn disagreements(&self) -> Vec<&Compared> {
        self.cells.iter().filter(|c| !c.agrees()).collect()
    }

    fn errors(&self) -> Vec<f64> {
        self.cells
            .iter()
            .filter(|c| matches!(c.cell(), Cell::Hz(_)))
            .map(|c| c.error().map_or(1.0, f64::abs))
            .collect()
    }

    /// The CSV of the study: 0 where silent, empty where the paper's digits are lost.
    pub fn csv(&self) -> String {
        let mut out = String::from("height_m,length_m,speed_m_s,paper_hz,model_hz\n");
        for cell in &self.cells {
            let paper = cell.cell().hz().map_or_else(String::new, |hz| hz.to_string());
            let _ = writeln!(
                out,
                "{},{},{},{paper},{:.1}",
                cell.column.height,
                cell.column.length,
                SPEEDS[cell.row],
                cell.hz()
            );
        }
        out
    }

    /// The table as people read it.
    pub fn text(&self) -> String {
        let mut out = String::from("mm/s    ");
        let columns: Vec<&str> = {
            let mut names: Vec<&str> = self.cells.iter().map(|c| c.column.name).collect();
            names.dedup();
            names
        };
        for name in &columns {
            let _ = write!(out, "{name:>8} paper  model  error");
        }
        out.push('\n');
        for (row, speed) in SPEEDS.iter().enumerate() {
            let _ = write!(out, "{:5.0}   ", speed * 1e3);
            for name in &columns {
                let cell = self.cells.iter().find(|c| c.column.name == *name && c.row == row);
                let Some(cell) = cell else { continue };
                let paper = match cell.cell() {
                    Cell::Hz(hz) => format!("{hz:.0}"),
                    Cell::Between(..) => "lost".to_string(),
                    Cell::Silent => "-".to_string(),
                };
                let model =
                    if cell.hz() > 0.0 { format!("{:.0}", cell.hz()) } else { "-".to_string() };
                let error = match cell.error() {
                    Some(error) => format!("{:+.1} %", 100.0 * error),
                    None if cell.agrees() => String::new(),
                    None => "WRONG".to_string(),
                };
                let _ = write!(out, "{paper:>14}{model:>7}{error:>8}");
            }
            out.push('\n');
        }
        let _ = writeln!(
            out,
            "median error {:.1} %, largest {:.1} %, {} cells silent or loud against the paper",
            100.0 * self.median_error(),
            100.0 * self.max_error(),
            self.disagreements().len()
        );
        out
    }
}
