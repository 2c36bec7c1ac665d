//! How residuals follow the parameters: the Jacobian by differences, its updates, and what the normal equations make
//! of it.

use super::objective::{flat, weighted, View};
use super::Fit;
use crate::gap::problem::Bench;
use nalgebra::{DMatrix, DVector};

/// Step of the finite differences in prior standard deviations.
const DIFFERENCE: f64 = 0.12;

/// Columns `which` of the Jacobian at `fit` by forward differences.
pub fn columns(bench: &Bench, fit: &Fit, which: &[usize], of: &[usize]) -> DMatrix<f64> {
    let points: Vec<Vec<f64>> = which
        .iter()
        .map(|k| {
            let mut x = fit.x.clone();
            x[*k] += difference(x[*k]);
            x
        })
        .collect();
    let shifted = bench.residuals(&fit.added, &points, of);
    let base = flat(&fit.residuals);
    let mut out = DMatrix::zeros(base.len(), which.len());
    for (column, (k, residuals)) in which.iter().zip(&shifted).enumerate() {
        let change = (flat(residuals) - &base) / difference(fit.x[*k]);
        out.set_column(column, &change);
    }
    out
}

/// Differences point to the centre of the prior.
fn difference(x: f64) -> f64 {
    if x > 0.0 {
        -DIFFERENCE
    } else {
        DIFFERENCE
    }
}

/// Step of (JᵀWJ + I)(1 + damping on the diagonal) s = −(JᵀWr + x).
pub(super) fn newton(
    jacobian: &DMatrix<f64>,
    r: &DVector<f64>,
    w: &DVector<f64>,
    x: &[f64],
    damping: f64,
) -> DVector<f64> {
    let (mut matrix, gradient) = normal(jacobian, r, w, x);
    for i in 0..x.len() {
        matrix[(i, i)] *= 1.0 + damping;
    }
    matrix.cholesky().map_or_else(|| DVector::zeros(x.len()), |c| -c.solve(&gradient))
}

/// JᵀWJ + I and JᵀWr + x.
pub(super) fn normal(
    jacobian: &DMatrix<f64>,
    r: &DVector<f64>,
    w: &DVector<f64>,
    x: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let mut weighted = jacobian.clone();
    for mut column in weighted.column_iter_mut() {
        column.component_mul_assign(w);
    }
    let matrix = weighted.tr_mul(jacobian) + DMatrix::identity(x.len(), x.len());
    let gradient = weighted.tr_mul(r) + DVector::from_column_slice(x);
    (matrix, gradient)
}

/// Standard deviations of the whitened parameters (Laplace).
pub fn deviations(bench: &Bench, fit: &Fit) -> Vec<f64> {
    let Some(jacobian) = fit.jacobian.as_ref() else { return vec![1.0; fit.x.len()] };
    let (r, w) = weighted(bench, &fit.residuals, View::PLAIN);
    let (matrix, _) = normal(jacobian, &r, &w, &fit.x);
    matrix.cholesky().map_or_else(
        || vec![1.0; fit.x.len()],
        |c| c.inverse().diagonal().iter().map(|v| v.sqrt()).collect(),
    )
}

/// Broyden's rank-one update: the least change of J that explains the step.
pub(super) fn broyden(jacobian: &DMatrix<f64>, from: &Fit, to: &Fit) -> DMatrix<f64> {
    let step = DVector::from_iterator(from.x.len(), to.x.iter().zip(&from.x).map(|(a, b)| a - b));
    let square = step.norm_squared();
    if square < 1e-10 {
        return jacobian.clone();
    }
    let change = flat(&to.residuals) - flat(&from.residuals);
    let miss = change - jacobian * &step;
    jacobian + miss * (step.transpose() / square)
}
