//! Table 1 on our own model, beside the paper's.

use std::fmt::Write;

use serde_json::{json, Value};

use super::identified;
use super::identify::objective::{compare, Compared, Fineness};
use super::margin;
use super::paper::{Cell, Column, SPEEDS, TABLE_1};
use super::plot::{svg, Panel, Series};
use super::report::{Study, Verdict};
use super::start::Start;
use crate::block::Reductions;
use crate::error::Fault;
use crate::metrics::median;
use crate::params::Params;

/// The table and how well it fits.
#[derive(Clone, Debug)]
pub struct TableOne {
    /// All cells, column by column, in the order of rising speed.
    pub cells: Vec<Compared>,
}

impl TableOne {
    /// Simulates the columns with the parameters of `base`; only geometry and solver are changed.
    pub fn simulate(
        base: &Params,
        columns: &[Column],
        fineness: &Fineness,
        start: Start,
        reductions: &Reductions,
    ) -> Self {
        let mut cells = compare(base, columns, fineness, start, reductions);
        let place = |c: &Compared| TABLE_1.iter().position(|t| t.name == c.column.name);
        cells.sort_by_key(|c| (place(c), c.row));
        Self { cells }
    }

    /// Median of the magnitudes of the relative errors over the legible frequencies; a cell that is
    /// silent where the paper's is not counts as 100 %.
    pub fn median_error(&self) -> f64 {
        median(self.errors()).unwrap_or(0.0)
    }

    /// Largest error.
    pub fn max_error(&self) -> f64 {
        self.errors().into_iter().fold(0.0, f64::max)
    }

    /// Cells that oscillate where the paper's are silent, or the other way round.
    pub fn disagreements(&self) -> Vec<&Compared> {
        self.cells.iter().filter(|c| !c.agrees()).collect()
    }

    /// Median and largest error as shares, and the places of the cells that disagree, as JSON.
    pub fn figures(&self) -> Value {
        let wrong: Vec<String> = self.disagreements().iter().map(|c| c.place()).collect();
        json!({ "median_error": self.median_error(), "max_error": self.max_error(), "wrong": wrong })
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

/// The study.
///
/// # Errors
/// What the drawing library says.
pub fn table_1(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let reductions = Reductions::default();
    let [table, from_rest] = [Start::Braking, Start::Rest]
        .map(|start| TableOne::simulate(compound, &TABLE_1, fineness, start, &reductions));
    let identification = identified::of(compound);
    let changed = margin::tables(compound, &TABLE_1, fineness, &reductions);
    let mut series = Vec::new();
    for (color, column) in TABLE_1.iter().enumerate() {
        let cells = || table.cells.iter().filter(|c| c.column.name == column.name);
        let model = cells().filter(|c| c.hz() > 0.0).map(|c| (1e3 * SPEEDS[c.row], c.hz()));
        let paper = cells().filter_map(|c| match c.cell() {
            Cell::Hz(hz) => Some((1e3 * SPEEDS[c.row], hz)),
            _ => None,
        });
        series.push(Series::line(column.name, color, model.collect()));
        series.push(Series::dots("", color, paper.collect()));
    }
    let axes = ["sliding speed [mm/s]", "stick-slip frequency [Hz]"];
    let picture = svg(&[Panel::new("Table 1: dots are the paper's", axes, series)], 1)?;
    Ok(Study {
        name: "table-1",
        title: "Stick-slip frequencies over geometry and speed",
        notes: format!(
            "{}{}{}",
            from_rest.changes(&table),
            margin::text(&changed),
            identification.as_ref().map_or("", |i| &i.notes)
        ),
        tables: [
            ("table-1.txt".to_string(), table.text()),
            ("table-1.csv".to_string(), table.csv()),
            ("table-1-from-rest.csv".to_string(), from_rest.csv()),
            ("table-1-margin.csv".to_string(), margin::csv(&changed)),
        ]
        .into_iter()
        .chain(identification.into_iter().flat_map(|i| i.tables))
        .collect(),
        pictures: vec![("table-1.svg".to_string(), picture)],
        verdicts: table.verdicts(),
    })
}

impl TableOne {
    /// What a block that starts from rest does otherwise, as a sentence.
    fn changes(&self, braked: &Self) -> String {
        let other: Vec<String> = self
            .cells
            .iter()
            .zip(&braked.cells)
            .filter(|(rest, braked)| (rest.hz() > 0.0) != (braked.hz() > 0.0))
            .map(|(rest, _)| format!("{} ({:.0} Hz)", rest.place(), rest.hz()))
            .collect();
        let cells = if other.is_empty() { "no cell".to_string() } else { other.join(", ") };
        format!(
            "The road is braked from 1 m/s to its speed; a block that starts from rest begins on the limit \
             cycle wherever there is one. Silent or loud by the start: {cells}.\n"
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let per_cent = |x: f64| format!("{:.1} %", 100.0 * x);
        let wrong = self.disagreements();
        let names: Vec<String> = wrong.iter().map(|c| c.place()).collect();
        let columns = |check: &dyn Fn(&[&Compared]) -> bool| {
            TABLE_1.iter().all(|column| {
                let cells: Vec<&Compared> =
                    self.cells.iter().filter(|c| c.column.name == column.name).collect();
                check(&cells)
            })
        };
        let rises = columns(&|cells| {
            let loud: Vec<f64> = cells.iter().map(|c| c.hz()).filter(|hz| *hz > 0.0).collect();
            loud.windows(2).all(|w| w[1] > w[0])
        });
        let below =
            columns(&|cells| cells.iter().all(|c| c.column.f0.is_none_or(|f0| c.hz() <= f0)));
        vec![
            Verdict::new(
                "median error at most 4 %",
                self.median_error() <= 0.04,
                per_cent(self.median_error()),
            ),
            Verdict::new(
                "no cell above 10 %",
                self.max_error() <= 0.10,
                per_cent(self.max_error()),
            ),
            Verdict::new(
                "the right cells are silent",
                wrong.is_empty(),
                if names.is_empty() { "all".to_string() } else { names.join(", ") },
            ),
            Verdict::new("the frequency rises with the speed", rises, "in every column"),
            Verdict::new("no frequency exceeds the first eigenfrequency", below, "f0 of the paper"),
        ]
    }
}
