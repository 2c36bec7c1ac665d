//! A walk downhill on tables: random steps, those are taken that leave it better.
//!
//! Least squares at one point may end where two limit cycles exist side by side, or beside the border of silence: a half
//! per cent of friction then moves a cell by ten. Such a place has no slopes worth following. A walk asks for Table 1 as it
//! is and with friction and damping one per cent up and down ([`crate::study::margin`]), and looks at the worst cells
//! and the median, too. Its step grows with every success and shrinks with every failure (Rechenberg's (1+1) strategy).

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::objective::Problem;
use super::toll::{part, whole};
use crate::study::margin::CHANGES;
use crate::study::paper::{Cell, Column};

/// First step, and the smallest and the largest, in unit intervals.
const STEP: f64 = 0.010;
const BOUNDS: [f64; 2] = [0.002, 0.03];
/// What a success and a failure make of it: balanced where one step in six succeeds.
const CHANGE: [f64; 2] = [1.3, 0.95];
/// The carriage is hardly felt, so its parameters go so many times as far.
const FAR: f64 = 8.0;
/// Shares of the unknowns that a step changes; one of them is drawn for each step.
const SHARES: [f64; 3] = [0.15, 0.4, 1.0];

/// A walk.
pub struct Walk<'a> {
    problem: &'a Problem<'a>,
    /// Columns in the order in which they are asked: cheap blocks first, so that a bad step costs little.
    stages: Vec<Vec<Column>>,
    /// Cells in the order of the residuals: long blocks first.
    cells: Vec<Cell>,
    x: Vec<f64>,
    toll: f64,
    step: f64,
    rng: ChaCha8Rng,
}

impl<'a> Walk<'a> {
    /// Begins at `x`.
    pub fn new(problem: &'a Problem<'a>, x: Vec<f64>, seed: u64) -> Self {
        let (late, early) = problem.columns.iter().partition(|c| c.length > 0.030);
        let mut stages: Vec<Vec<Column>> = vec![early, late];
        stages.retain(|stage| !stage.is_empty());
        let cells = stages.iter().rev().flatten().flat_map(|c| c.cells).collect();
        let rng = ChaCha8Rng::seed_from_u64(seed);
        let mut out = Self { problem, stages, cells, x, toll: f64::INFINITY, step: STEP, rng };
        out.toll = out.measure(&out.x);
        out
    }

    /// Where it is, and its toll.
    pub fn place(&self) -> (&[f64], f64) {
        (&self.x, self.toll)
    }

    /// One step.
    pub fn step(&mut self) {
        let there = self.propose();
        let reached = self.measure(&there);
        if reached < self.toll {
            (self.x, self.toll) = (there, reached);
            self.step = (CHANGE[0] * self.step).min(BOUNDS[1]);
        } else {
            self.step = (CHANGE[1] * self.step).max(BOUNDS[0]);
        }
    }

    /// The toll at `x`; of a place that is worse than where the walk is, no more than is needed to know that.
    fn measure(&self, x: &[f64]) -> f64 {
        let as_it_is = self.problem.params(x);
        let changed = CHANGES.iter().map(|change| change.of(&as_it_is));
        let mut paid = 0.0;
        for (member, params) in std::iter::once(as_it_is.clone()).chain(changed).enumerate() {
            let mut table = Vec::new();
            for columns in &self.stages {
                let stage = Problem { columns, ..*self.problem };
                // Residuals come with the long blocks first.
                table.splice(0..0, stage.residuals_of(&params));
                if paid + part(&table, &self.cells, member) > self.toll {
                    return f64::INFINITY;
                }
            }
            paid += part(&table, &self.cells, member);
            if member == 0 {
                paid += whole(&table, &self.cells);
            }
        }
        paid
    }

    /// Where a step leads.
    fn propose(&mut self) -> Vec<f64> {
        let share = SHARES[self.rng.random_range(0..SHARES.len())];
        let unknowns = self.problem.unknowns;
        let always = self.rng.random_range(0..self.x.len());
        let (x, step, rng) = (&self.x, self.step, &mut self.rng);
        x.iter()
            .zip(unknowns)
            .enumerate()
            .map(|(i, (x, unknown))| {
                let normal: f64 = StandardNormal.sample(rng);
                let moves = rng.random_bool(share) || i == always;
                let far = if unknown.name.starts_with("carriage.") { FAR } else { 1.0 };
                (x + if moves { far * step * normal } else { 0.0 }).clamp(0.0, 1.0)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Reductions;
    use crate::params::Params;
    use crate::study::identify::objective::Fineness;
    use crate::study::identify::space::unknowns;

    #[test]
    fn a_step_changes_one_unknown_at_least_and_the_carriage_most() {
        // Steps of 0.010 standard deviation, 8 times that for the carriage; 400 draws, so within 15 %.
        let (base, reductions) = (Params::default(), Reductions::default());
        let unknowns = unknowns(base.friction.form);
        let problem = Problem {
            base: &base,
            unknowns: &unknowns,
            columns: &[],
            fineness: Fineness::COARSE,
            reductions: &reductions,
        };
        let x = vec![0.5; unknowns.len()];
        let mut walk = Walk::new(&problem, x.clone(), 1);
        let mut squares = vec![(0.0, 0.0); unknowns.len()];
        for _ in 0..400 {
            let there = walk.propose();
            let moved: Vec<f64> = there.iter().zip(&x).map(|(a, b)| a - b).collect();
            assert!(moved.iter().any(|d| *d != 0.0));
            for (sum, d) in squares.iter_mut().zip(moved).filter(|(_, d)| *d != 0.0) {
                *sum = (sum.0 + d * d, sum.1 + 1.0);
            }
        }
        for (unknown, (sum, count)) in unknowns.iter().zip(squares) {
            let expected = if unknown.name.starts_with("carriage.") { 0.080 } else { 0.010 };
            assert!(((sum / count).sqrt() / expected - 1.0).abs() < 0.2, "{}", unknown.name);
        }
    }
}
