//! A walk downhill on tables: each step is the best of many on the linear model of the residuals, and is taken if the
//! tables agree.
//!
//! Least squares at one point may end where two limit cycles exist side by side, or beside the border of silence: one per
//! cent of friction then moves a cell by twenty. A walk asks for three tables, as it is and with the fall of friction one
//! per cent up and down, and looks at the worst cells and the median, too. That has corners, so it is searched by random
//! steps; they cost nothing on the linear model, and every table corrects the model (Broyden, Math. Comp. 19, 1965).

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::gauss_newton::{jacobian, Local};
use super::objective::Problem;
use super::toll::{part, toll};
use crate::study::margin::CHANGES;
use crate::study::paper::{Cell, Column};

/// First trust radius, in unit intervals, and that after the model was of no more use.
const RADIUS: f64 = 0.03;
/// Smallest and largest trust radius.
const BOUNDS: [f64; 2] = [0.004, 0.15];
/// Random steps on the model per step.
const DRAWS: usize = 4000;
/// Change of a residual beyond which a cell has flipped or jumped to another limit cycle, which no slope describes.
const JUMP: f64 = 0.2;
/// Every so many failures a proposal is blurred, so that the next does not ask the same again.
const BLURRED: usize = 3;

/// A walk.
pub struct Walk<'a> {
    problem: &'a Problem<'a>,
    /// Columns in the order in which they are asked: cheap blocks first, so that a bad step costs little.
    stages: Vec<Vec<Column>>,
    /// Cells in the order of the residuals: long blocks first.
    cells: Vec<Cell>,
    x: Vec<f64>,
    /// Residuals as it is, and with the fall of friction up and down.
    here: Vec<Vec<f64>>,
    toll: f64,
    model: DMatrix<f64>,
    radius: f64,
    failed: usize,
    rng: ChaCha8Rng,
}

impl<'a> Walk<'a> {
    /// Begins at `x`.
    pub fn new(problem: &'a Problem<'a>, x: Vec<f64>, seed: u64) -> Self {
        let (late, early) = problem.columns.iter().partition(|c| c.length > 0.030);
        let mut stages: Vec<Vec<Column>> = vec![early, late];
        stages.retain(|stage| !stage.is_empty());
        let cells = stages.iter().rev().flatten().flat_map(|c| c.cells).collect();
        let mut out = Self {
            problem,
            stages,
            cells,
            here: Vec::new(),
            toll: f64::INFINITY,
            model: DMatrix::zeros(0, 0),
            radius: RADIUS,
            failed: 0,
            rng: ChaCha8Rng::seed_from_u64(seed),
            x,
        };
        out.here = out.measure(&out.x);
        out.toll = toll(&out.here, &out.cells);
        out.model = jacobian(problem, &out.x, &out.here[0]);
        out
    }

    /// Where it is, and its toll.
    pub fn place(&self) -> (&[f64], f64) {
        (&self.x, self.toll)
    }

    /// Where it ended, with the model of its last tables as Jacobian.
    pub fn end(mut self) -> Local {
        Local { x: self.x, residuals: self.here.swap_remove(0), jacobian: self.model }
    }

    /// One step: a proposal, its tables, and what they teach.
    pub fn step(&mut self) {
        let there = self.propose();
        let tables = self.measure(&there);
        self.learn(&there, &tables);
        let reached =
            if tables.len() < self.here.len() { f64::INFINITY } else { toll(&tables, &self.cells) };
        if reached < self.toll {
            (self.x, self.here, self.toll, self.failed) = (there, tables, reached, 0);
            self.radius = (1.4 * self.radius).min(BOUNDS[1]);
        } else {
            self.failed += 1;
            self.radius *= 0.75;
            if self.radius < BOUNDS[0] {
                self.radius = RADIUS;
            }
        }
    }

    /// The tables at `x`: those that are whole before the toll exceeds that of the place where the walk is.
    fn measure(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let as_it_is = self.problem.params(x);
        let changed = CHANGES[..2].iter().map(|change| change.of(&as_it_is));
        let mut tables = Vec::new();
        let mut paid = 0.0;
        for (member, params) in std::iter::once(as_it_is.clone()).chain(changed).enumerate() {
            let mut table = Vec::new();
            for columns in &self.stages {
                let stage = Problem { columns, ..*self.problem };
                table.splice(0..0, stage.residuals_of(&params));
                if paid + part(&table, &self.cells, member) > self.toll {
                    break;
                }
            }
            if table.len() < self.cells.len() {
                break;
            }
            paid += part(&table, &self.cells, member);
            tables.push(table);
            if paid > self.toll {
                break;
            }
        }
        tables
    }

    /// Corrects the model by a secant: the median change of the tables, for cells that did not jump.
    fn learn(&mut self, there: &[f64], tables: &[Vec<f64>]) {
        if tables.is_empty() {
            return;
        }
        let step = DVector::from_fn(there.len(), |i, _| there[i] - self.x[i]);
        let square = step.norm_squared().max(1e-9);
        for row in 0..self.cells.len() {
            let mut changes: Vec<f64> =
                tables.iter().zip(&self.here).map(|(there, here)| there[row] - here[row]).collect();
            changes.sort_by(f64::total_cmp);
            let change =
                if changes.len() == 3 { changes[1] } else { tables[0][row] - self.here[0][row] };
            if change.abs() < JUMP {
                let wrong = change - (self.model.row(row) * &step)[0];
                let mut slopes = self.model.row_mut(row);
                slopes += step.transpose() * (wrong / square);
            }
        }
    }

    /// The best step within the trust radius on the model.
    fn propose(&mut self) -> Vec<f64> {
        let n = self.x.len();
        let mut best = (self.x.clone(), f64::INFINITY);
        for draw in 0..DRAWS {
            let scale = self.radius * 0.01_f64.powf(draw as f64 / DRAWS as f64);
            // Half of the steps change two of the unknowns or so.
            let share = if self.rng.random_bool(0.5) { 1.0 } else { 2.0 / n as f64 };
            let x = self.scattered(&best.0, scale, share);
            let step = DVector::from_fn(n, |i, _| x[i] - self.x[i]);
            let change = &self.model * step;
            let there: Vec<Vec<f64>> = self
                .here
                .iter()
                .map(|table| table.iter().zip(change.iter()).map(|(r, c)| r + c).collect())
                .collect();
            let expected = toll(&there, &self.cells);
            if expected < best.1 {
                best = (x, expected);
            }
        }
        if self.failed % BLURRED == BLURRED - 1 {
            best.0 = self.scattered(&best.0, 0.3 * self.radius, 1.0);
        }
        best.0
    }

    /// `x` with normal steps of `scale` on a `share` of its unknowns, within the trust radius.
    fn scattered(&mut self, x: &[f64], scale: f64, share: f64) -> Vec<f64> {
        let (radius, here) = (self.radius, &self.x);
        let rng = &mut self.rng;
        x.iter()
            .zip(here)
            .map(|(x, here)| {
                let normal: f64 = StandardNormal.sample(rng);
                let step =
                    if share >= 1.0 || rng.random_bool(share) { scale * normal } else { 0.0 };
                (x + step).clamp(here - radius, here + radius).clamp(0.0, 1.0)
            })
            .collect()
    }
}
