//! Lowest eigenpairs of a sparse pencil by subspace iteration.

use super::product::product;
use crate::error::Fault;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::CscMatrix;

/// Iterations after which the subspace is given up; ten are usual.
const MAX_ITERATIONS: usize = 200;
/// Relative change of the eigenvalues at which the iteration ends.
const TOLERANCE: f64 = 1e-12;

/// All eigenpairs of `stiffness` φ = λ `mass` φ with λ ≤ `bound`, ascending, φᵀ M φ = 1.
///
/// Subspace iteration with Rayleigh-Ritz (Bathe, Finite Element Procedures, 11.6); the subspace
/// grows until an eigenvalue beyond the bound has converged, so the count follows from the bound.
///
/// # Errors
/// [`Fault::NotFinite`] if the pencil is not positive definite.
pub fn eigenpairs_below(
    bound: f64,
    factor: &CscCholesky<f64>,
    mass: &CscMatrix<f64>,
) -> Result<(Vec<f64>, DMatrix<f64>), Fault> {
    let dofs = mass.nrows();
    let mut wanted = 12.min(dofs);
    loop {
        let (values, vectors) = lowest(wanted, factor, mass)?;
        let below = values.iter().filter(|v| **v <= bound).count();
        if below < values.len() || wanted == dofs {
            return Ok((values[..below].to_vec(), vectors.columns(0, below).into_owned()));
        }
        wanted = (2 * wanted).min(dofs);
    }
}

/// The `wanted` lowest eigenpairs.
fn lowest(
    wanted: usize,
    factor: &CscCholesky<f64>,
    mass: &CscMatrix<f64>,
) -> Result<(Vec<f64>, DMatrix<f64>), Fault> {
    let dofs = mass.nrows();
    let size = (wanted + wanted.max(8)).min(dofs);
    let mut basis = start_vectors(dofs, size);
    let mut mass_basis = product(mass, &basis);
    let mut last = vec![0.0; wanted];
    for _ in 0..MAX_ITERATIONS {
        let image = factor.solve(&mass_basis);
        let mass_image = product(mass, &image);
        let k = image.tr_mul(&mass_basis);
        let m = image.tr_mul(&mass_image);
        let (values, vectors) = dense_pencil(&k, &m)?;
        basis = image * &vectors;
        mass_basis = mass_image * vectors;
        let moved = values.iter().zip(&last).map(|(a, b)| ((a - b) / a).abs()).fold(0.0, f64::max);
        last.copy_from_slice(&values[..wanted]);
        if moved < TOLERANCE {
            break;
        }
    }
    Ok((last, basis.columns(0, wanted).into_owned()))
}

/// Deterministic vectors that no symmetry of the block is orthogonal to.
fn start_vectors(rows: usize, columns: usize) -> DMatrix<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    DMatrix::from_fn(rows, columns, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    })
}

/// Eigenpairs of the dense symmetric pencil `k` φ = λ `m` φ, ascending, φᵀ m φ = 1.
///
/// # Errors
/// [`Fault::NotFinite`] if `m` is not positive definite.
pub fn dense_pencil(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Result<(Vec<f64>, DMatrix<f64>), Fault> {
    let broken = || Fault::NotFinite { what: "mass matrix of the block".into(), time: 0.0 };
    let lower = m.clone().cholesky().ok_or_else(broken)?.unpack();
    let half = lower.solve_lower_triangular(k).ok_or_else(broken)?;
    let standard = lower.solve_lower_triangular(&half.transpose()).ok_or_else(broken)?;
    let eigen = SymmetricEigen::new((&standard + standard.transpose()) * 0.5);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let values: Vec<f64> = order.iter().map(|at| eigen.eigenvalues[*at]).collect();
    let columns: Vec<DVector<f64>> =
        order.iter().map(|at| eigen.eigenvectors.column(*at).into_owned()).collect();
    let vectors = lower
        .transpose()
        .solve_upper_triangular(&DMatrix::from_columns(&columns))
        .ok_or_else(broken)?;
    Ok((values, vectors))
}
