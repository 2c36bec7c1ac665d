//! Local search: Gauss-Newton with Levenberg's damping on the residuals, and what their Jacobian says.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::objective::{Problem, OUTLIER};

/// Step of the finite differences in the unit interval: large enough for the noise of a measured
/// frequency (about 1e-4), small enough for the curvature.
const DIFFERENCE: f64 = 0.01;
/// Share of that step where a cell jumps within it.
const NEARER: f64 = 0.3;
/// Change of a residual that no slope describes, over the whole step and over that share of it.
const JUMP: f64 = 0.1;
const STEEP: f64 = 0.2;

/// Where a local search ended.
#[derive(Clone, Debug)]
pub struct Local {
    /// Places of the unknowns.
    pub x: Vec<f64>,
    /// Residuals there.
    pub residuals: Vec<f64>,
    /// Jacobian there.
    pub jacobian: DMatrix<f64>,
}

/// What a cost is minimised: the pseudo-Huber cost's weights turn it into least squares.
fn weights(residuals: &[f64]) -> DVector<f64> {
    DVector::from_iterator(
        residuals.len(),
        residuals.iter().map(|r| (1.0 + (r / OUTLIER).powi(2)).powf(-0.5)),
    )
}

/// Jacobian of the residuals at `x`. A cell that jumps between the two points, to another limit cycle or into silence,
/// has no slope there: it is asked again on the other side, and then nearer; where it always jumps, its slope is 0.
pub fn jacobian(problem: &Problem<'_>, x: &[f64], residuals: &[f64]) -> DMatrix<f64> {
    let columns: Vec<DVector<f64>> = (0..x.len())
        .map(|i| {
            let mut slopes = vec![None; residuals.len()];
            for (share, jump) in [(1.0, JUMP), (-1.0, JUMP), (NEARER, STEEP), (-NEARER, STEEP)] {
                let step = share * DIFFERENCE;
                if !(0.0..=1.0).contains(&(x[i] + step)) {
                    continue;
                }
                let mut there = x.to_vec();
                there[i] += step;
                let moved = problem.residuals(&there);
                for ((slope, b), a) in slopes.iter_mut().zip(&moved).zip(residuals) {
                    if slope.is_none() && (b - a).abs() < jump {
                        *slope = Some((b - a) / step);
                    }
                }
                if slopes.iter().all(Option::is_some) {
                    break;
                }
            }
            DVector::from_iterator(slopes.len(), slopes.iter().map(|slope| slope.unwrap_or(0.0)))
        })
        .collect();
    DMatrix::from_columns(&columns)
}

/// Improves `x` in at most `rounds` rounds; `told` hears of every improvement.
pub fn improve(
    problem: &Problem<'_>,
    mut x: Vec<f64>,
    rounds: usize,
    mut told: impl FnMut(&[f64], f64),
) -> Local {
    let mut residuals = problem.residuals(&x);
    let mut cost = Problem::cost(&residuals, &x);
    told(&x, cost);
    let mut damping = 1e-2;
    let mut slopes = jacobian(problem, &x, &residuals);
    for _ in 0..rounds {
        let weights = weights(&residuals);
        let weighted = DMatrix::from_diagonal(&weights) * &slopes;
        let normal = slopes.transpose() * &weighted;
        let gradient = weighted.transpose() * DVector::from_column_slice(&residuals);
        let mut improved = false;
        for _ in 0..5 {
            let mut matrix = normal.clone();
            for i in 0..x.len() {
                matrix[(i, i)] += damping;
            }
            let Some(step) = matrix.lu().solve(&gradient) else { break };
            let there: Vec<f64> = x
                .iter()
                .zip(step.iter())
                .map(|(x, s)| (x - s.clamp(-0.15, 0.15)).clamp(0.0, 1.0))
                .collect();
            let moved = problem.residuals(&there);
            let moved_cost = Problem::cost(&moved, &there);
            if moved_cost < cost {
                improved = cost - moved_cost > 1e-3 * cost;
                (x, residuals, cost) = (there, moved, moved_cost);
                damping = (damping * 0.3).max(1e-6);
                told(&x, cost);
                break;
            }
            damping *= 5.0;
        }
        slopes = jacobian(problem, &x, &residuals);
        if !improved && damping > 1e3 {
            break;
        }
    }
    Local { x, residuals, jacobian: slopes }
}

/// A direction in the space of the unknowns and how well the data pin it down.
#[derive(Clone, Debug)]
pub struct Direction {
    /// Standard deviation along it, in unit intervals.
    pub deviation: f64,
    /// Its components.
    pub components: Vec<f64>,
}

impl Local {
    /// Variance of the residuals, from what the fit leaves over its degrees of freedom.
    pub fn variance(&self) -> f64 {
        let free = self.residuals.len().saturating_sub(self.x.len()).max(1);
        self.residuals.iter().map(|r| r * r).sum::<f64>() / free as f64
    }

    /// JᵀJ: what a step costs in squared residuals.
    pub(super) fn normal(&self) -> DMatrix<f64> {
        self.jacobian.transpose() * &self.jacobian
    }

    /// Directions of JᵀJ, the best determined first.
    pub fn directions(&self) -> Vec<Direction> {
        let eigen = SymmetricEigen::new(self.normal());
        let variance = self.variance();
        let mut order: Vec<usize> = (0..self.x.len()).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        order
            .into_iter()
            .map(|k| Direction {
                deviation: (variance / eigen.eigenvalues[k].max(1e-12)).sqrt(),
                components: eigen.eigenvectors.column(k).iter().copied().collect(),
            })
            .collect()
    }

    /// Standard deviations of the unknowns, in unit intervals; none exceeds that of a uniform
    /// distribution over its range, which is what is known without data.
    pub fn deviations(&self) -> Vec<f64> {
        let prior = 12.0;
        let mut information = self.normal() / self.variance();
        for i in 0..self.x.len() {
            information[(i, i)] += prior;
        }
        let covariance = information.try_inverse();
        (0..self.x.len())
            .map(|i| covariance.as_ref().map_or(f64::NAN, |c| c[(i, i)].max(0.0).sqrt()))
            .collect()
    }
}
