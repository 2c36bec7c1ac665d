//! The biquadratic rectangle: shape functions, element stiffness and consistent mass.

use nalgebra::{Matrix3, SMatrix};

/// Degrees of freedom of an element: x and z of nine nodes, node `3 i + j` in column i, row j.
pub const DOFS: usize = 18;
/// Element matrix.
pub type ElementMatrix = SMatrix<f64, DOFS, DOFS>;

/// Three Gauss points on \[−1, 1\] with their weights: exact to degree five.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Quadratic Lagrange polynomials at the nodes −1, 0, 1 and their derivatives, at `xi`.
fn lagrange(xi: f64) -> ([f64; 3], [f64; 3]) {
    ([0.5 * xi * (xi - 1.0), 1.0 - xi * xi, 0.5 * xi * (xi + 1.0)], [xi - 0.5, -2.0 * xi, xi + 0.5])
}

/// Stiffness C = ∫ Bᵀ D B dA and consistent mass M = ∫ Nᵀ N dA of a `dx` × `dz` \[m\] rectangle, for
/// unit modulus, density and width (theory eq. 1.3).
pub fn matrices(dx: f64, dz: f64, elasticity: &Matrix3<f64>) -> (ElementMatrix, ElementMatrix) {
    let mut stiffness = ElementMatrix::zeros();
    let mut mass = ElementMatrix::zeros();
    for (xi, wx) in GAUSS {
        for (eta, wz) in GAUSS {
            let area = wx * wz * 0.25 * dx * dz;
            let ((nx, gx), (nz, gz)) = (lagrange(xi), lagrange(eta));
            let mut b = SMatrix::<f64, 3, DOFS>::zeros();
            let mut n = SMatrix::<f64, 2, DOFS>::zeros();
            for i in 0..3 {
                for j in 0..3 {
                    let at = 2 * (3 * i + j);
                    let ddx = gx[i] * nz[j] * 2.0 / dx;
                    let ddz = nx[i] * gz[j] * 2.0 / dz;
                    b[(0, at)] = ddx;
                    b[(1, at + 1)] = ddz;
                    b[(2, at)] = ddz;
                    b[(2, at + 1)] = ddx;
                    n[(0, at)] = nx[i] * nz[j];
                    n[(1, at + 1)] = nx[i] * nz[j];
                }
            }
            stiffness += b.transpose() * elasticity * b * area;
            mass += n.transpose() * n * area;
        }
    }
    (stiffness, mass)
}
