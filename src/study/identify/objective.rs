//! How far a set of parameters is from Table 1.

use rayon::prelude::*;

use super::space::{apply, Unknown};
use crate::block::Reductions;
use crate::error::Fault;
use crate::params::Params;
use crate::study::paper::{Cell, Column, PRESSURE, SPEEDS};
use crate::study::slides::{observe, Point};
use crate::study::start::Start;
use crate::study::watch::Observed;

/// How finely the runs of an identification are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Elements along a face of 15 mm and of 45 mm.
    pub along: [usize; 2],
    /// Elements over the height.
    pub up: usize,
    /// Largest internal step \[s\].
    pub max_step: f64,
    /// Tolerance of the integrator \[-\], as `solver.tolerance`.
    pub tolerance: f64,
    /// Frequency bound \[Hz\].
    pub bound: f64,
    /// Distance of rows \[s\].
    pub step: f64,
}

impl Fineness {
    /// For the global search: frequencies within about 1 % of the fine ones.
    pub const COARSE: Self =
        Self { along: [6, 12], up: 4, max_step: 1e-5, tolerance: 3e-3, bound: 9e3, step: 4e-5 };
    /// For the last steps and for Table 1.
    pub const FINE: Self =
        Self { along: [6, 18], up: 5, max_step: 1e-5, tolerance: 1e-3, bound: 20e3, step: 2e-5 };

    /// [`Self::COARSE`] or [`Self::FINE`].
    pub const fn choose(coarse: bool) -> Self {
        if coarse {
            Self::COARSE
        } else {
            Self::FINE
        }
    }

    /// Sets the solver of `params` for its geometry.
    pub fn apply(&self, params: &mut Params) {
        let long = params.block.length > 0.030;
        params.solver.elements_along = self.along[usize::from(long)];
        params.solver.elements_up = self.up;
        params.solver.max_step = self.max_step;
        params.solver.tolerance = self.tolerance;
        params.solver.frequency_bound = self.bound;
    }
}

/// One cell: where it is, what the paper says, what the model does.
#[derive(Clone, Debug)]
pub struct Compared {
    /// Column of Table 1.
    pub column: Column,
    /// Row of Table 1.
    pub row: usize,
    /// The model's run; `None` if the model could not do it.
    pub observed: Option<Observed>,
}

impl Compared {
    /// The paper's cell.
    pub fn cell(&self) -> Cell {
        self.column.cells[self.row]
    }

    /// Model frequency \[Hz\], 0 where silent.
    pub fn hz(&self) -> f64 {
        self.observed.as_ref().map_or(0.0, |o| o.frequency)
    }

    /// Relative error of the frequency where both oscillate.
    pub fn error(&self) -> Option<f64> {
        match self.cell() {
            Cell::Hz(paper) if self.hz() > 0.0 => Some(self.hz() / paper - 1.0),
            _ => None,
        }
    }

    /// Where the cell is, as people say it.
    pub fn place(&self) -> String {
        format!("{} at {:.0} mm/s", self.column.name, 1e3 * SPEEDS[self.row])
    }

    /// Does the model oscillate where the paper does and keep silent where it does?
    pub fn agrees(&self) -> bool {
        (self.hz() > 0.0) == (self.cell() != Cell::Silent)
    }

    /// Residual: the logarithm of the frequency ratio; where the block is silent (or loud) and should not be, a
    /// small step and then what grows with how clearly it is, so that a search feels which way is out.
    pub fn residual(&self) -> f64 {
        let Some(observed) = &self.observed else { return 1.0 };
        let hz = self.hz();
        let wrong = WRONG + STEEPNESS * (observed.growth.abs() / RATE_OF_SLOPE).min(0.25);
        match self.cell() {
            Cell::Hz(paper) if hz > 0.0 => (hz / paper).ln().clamp(-1.0, 1.0),
            Cell::Hz(_) | Cell::Between(..) if hz <= 0.0 => wrong,
            Cell::Between(low, high) => {
                let (below, above) = ((hz / low).ln().min(0.0), (hz / high).ln().max(0.0));
                below + above + TILT * (hz.clamp(low, high) / (low * high).sqrt()).ln()
            }
            _ if hz <= 0.0 => 0.0,
            _ => wrong,
        }
    }
}

/// Residual of a cell that is only just silent or loud against the paper.
const WRONG: f64 = 0.12;
/// Rate at which a vibration grows or dies \[1/s\] over the share of the slope of friction that is too much or
/// too little: half of βω², at β = 1e-4 s and 5 kHz.
const RATE_OF_SLOPE: f64 = 5e4;
/// Residual over that share.
const STEEPNESS: f64 = 4.0;

/// Where the paper's digits are lost: residual over the logarithm of the frequency within its bounds, so that a search
/// feels where it is.
pub const TILT: f64 = 0.1;

/// Longest duration of the run of a cell \[s\], and for how long its settled vibration is seen: twelve periods at the
/// paper's frequency or more. A vibration that grows slowly has the time to; one that has settled is not awaited.
fn durations(cell: Cell) -> (f64, f64) {
    match cell {
        Cell::Hz(hz) => (70e-3_f64.max(24.0 / hz), (12.0 / hz).max(12e-3)),
        Cell::Between(..) => (70e-3, 12e-3),
        Cell::Silent => (40e-3, 12e-3),
    }
}

/// Runs all cells of `columns`, each started like the others.
pub fn compare(
    base: &Params,
    columns: &[Column],
    fineness: &Fineness,
    start: Start,
    reductions: &Reductions,
) -> Vec<Compared> {
    let mut cells: Vec<(Column, usize)> =
        columns.iter().flat_map(|c| (0..SPEEDS.len()).map(move |row| (*c, row))).collect();
    // The dearest first, so that no core waits for a last long run.
    cells.sort_by(|a, b| b.0.length.total_cmp(&a.0.length));
    cells
        .into_par_iter()
        .map(|(column, row)| {
            let observed = observe_cell(base, &column, row, fineness, start, reductions);
            Compared { column, row, observed: observed.ok() }
        })
        .collect()
}

/// Runs one cell.
fn observe_cell(
    base: &Params,
    column: &Column,
    row: usize,
    fineness: &Fineness,
    start: Start,
    reductions: &Reductions,
) -> Result<Observed, Fault> {
    let mut params = base.clone();
    params.block.height = column.height;
    params.block.length = column.length;
    fineness.apply(&mut params);
    let (duration, seen) = durations(column.cells[row]);
    let point =
        Point { speed: SPEEDS[row], pressure: PRESSURE, start, duration, step: fineness.step };
    observe(&params, reductions, point, seen)
}

/// E/ρ \[m²/s²\] at which the eigenfrequencies of the free blocks fit Table 1 best.
///
/// # Errors
/// What stops the reduction.
pub fn modulus_over_density(
    base: &Params,
    columns: &[Column],
    reductions: &Reductions,
) -> Result<f64, Fault> {
    let (mut sum, mut count) = (0.0, 0.0);
    for column in columns {
        let Some(f0) = column.f0 else { continue };
        let mut params = base.clone();
        params.block.height = column.height;
        params.block.length = column.length;
        Fineness::FINE.apply(&mut params);
        let lambda = reductions.of(&params)?.lambda[0];
        sum += ((f0 * std::f64::consts::TAU).powi(2) / lambda).ln();
        count += 1.0;
    }
    Ok((sum / count).exp())
}

/// Residual from which on the cost grows linearly.
pub const OUTLIER: f64 = 0.15;

/// The problem that a search solves: residuals of the cells over the unknowns.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// What is not unknown.
    pub base: &'a Params,
    /// Unknowns.
    pub unknowns: &'a [Unknown],
    /// Columns to fit.
    pub columns: &'a [Column],
    /// How finely.
    pub fineness: Fineness,
    /// Reductions.
    pub reductions: &'a Reductions,
}

impl Problem<'_> {
    /// Parameters at `x`.
    pub fn params(&self, x: &[f64]) -> Params {
        let mut params = self.base.clone();
        apply(self.unknowns, x, &mut params);
        params
    }

    /// Residuals at `x`, cell by cell.
    pub fn residuals(&self, x: &[f64]) -> Vec<f64> {
        self.residuals_of(&self.params(x))
    }

    /// Residuals of any parameters, cell by cell.
    pub fn residuals_of(&self, params: &Params) -> Vec<f64> {
        let Self { columns, fineness, reductions, .. } = self;
        let mut cells = compare(params, columns, fineness, Start::Braking, reductions);
        cells.par_iter_mut().for_each(|cell| self.tell_how_silent(cell, params));
        cells.iter().map(Compared::residual).collect()
    }

    /// Where the block is silent and should not be: the rate at which the vibration of a start from rest dies. A block
    /// that came to slide steadily from a higher speed has none that could.
    fn tell_how_silent(&self, cell: &mut Compared, params: &Params) {
        if cell.agrees() || cell.hz() > 0.0 {
            return;
        }
        let Some(observed) = &mut cell.observed else { return };
        let (column, row) = (&cell.column, cell.row);
        let from_rest =
            observe_cell(params, column, row, &self.fineness, Start::Rest, self.reductions);
        observed.growth = from_rest.map_or(0.0, |rest| rest.growth.min(0.0));
    }

    /// All cells at `x`.
    pub fn compare(&self, x: &[f64]) -> Vec<Compared> {
        compare(&self.params(x), self.columns, &self.fineness, Start::Braking, self.reductions)
    }

    /// Cost of residuals: half their squares in units of 5 %, but from [`OUTLIER`] on (pseudo-Huber)
    /// linear, so that no single cell rules, and a wall for leaving the unit cube.
    pub fn cost(residuals: &[f64], x: &[f64]) -> f64 {
        let unit = (OUTLIER / 0.05).powi(2);
        let one = |r: &f64| unit * ((1.0 + (r / OUTLIER).powi(2)).sqrt() - 1.0);
        let fit: f64 = residuals.iter().map(one).sum();
        let outside: f64 = x.iter().map(|x| (x - x.clamp(0.0, 1.0)).powi(2)).sum();
        fit + 1e3 * outside
    }
}
