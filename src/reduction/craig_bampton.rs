//! Craig and Bampton, AIAA Journal 6 (1968): constraint modes and fixed-interface modes.

use super::fixed_interface::eigenpairs_below;
use crate::error::Fault;
use crate::fe::FullModel;
use crate::mesh::Mesh;
use nalgebra::DMatrix;
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// The reduced pencil, per unit modulus, density and width.
///
/// Coordinates: x of the contact nodes from run-in to run-out edge, z of the same, then the
/// amplitudes of the fixed-interface modes.
#[derive(Clone, Debug)]
pub struct CraigBampton {
    /// Reduced stiffness [-].
    pub stiffness: DMatrix<f64>,
    /// Reduced mass [m²].
    pub mass: DMatrix<f64>,
    /// Free degrees of freedom of the full model from the reduced coordinates.
    pub basis: DMatrix<f64>,
    /// Number of contact nodes.
    pub contact_nodes: usize,
}

impl CraigBampton {
    /// Reduces `full`, keeping all fixed-interface modes with λ = ω²ρ/E ≤ `bound` [1/m²].
    ///
    /// # Errors
    /// [`Fault::NotFinite`] if the mesh is degenerate.
    pub fn reduce(full: &FullModel, mesh: &Mesh, bound: f64) -> Result<Self, Fault> {
        let contact = contact_dofs(full, mesh);
        let inner: Vec<usize> = (0..full.dofs()).filter(|d| !contact.contains(d)).collect();
        let k_ii = part(&full.stiffness, &inner, &inner);
        let factor = CscCholesky::factor(&k_ii)
            .map_err(|_| Fault::NotFinite { what: "stiffness matrix of the block".into(), time: 0.0 })?;
        let k_ic = DMatrix::from(&part(&full.stiffness, &inner, &contact));
        let constraint_modes = -factor.solve(&k_ic);
        let m_ii = part(&full.mass, &inner, &inner);
        let (_, fixed_modes) = eigenpairs_below(bound, &factor, &m_ii)?;
        let basis = basis(full.dofs(), &contact, &inner, &constraint_modes, &fixed_modes);
        let project = |matrix: &CscMatrix<f64>| basis.transpose() * (matrix * &basis);
        Ok(Self {
            stiffness: project(&full.stiffness),
            mass: project(&full.mass),
            basis,
            contact_nodes: contact.len() / 2,
        })
    }
}

/// Free degrees of freedom of the tread face: all x, then all z.
fn contact_dofs(full: &FullModel, mesh: &Mesh) -> Vec<usize> {
    let face = mesh.tread_face();
    (0..2).flat_map(|axis| face.iter().filter_map(move |n| full.dof[2 * n + axis])).collect()
}

/// Rows and columns of a sparse matrix.
fn part(matrix: &CscMatrix<f64>, rows: &[usize], columns: &[usize]) -> CscMatrix<f64> {
    let place = |list: &[usize], size: usize| {
        let mut at = vec![None; size];
        for (new, old) in list.iter().enumerate() {
            at[*old] = Some(new);
        }
        at
    };
    let (row_at, column_at) = (place(rows, matrix.nrows()), place(columns, matrix.ncols()));
    let mut out = CooMatrix::new(rows.len(), columns.len());
    for (row, column, value) in matrix.triplet_iter() {
        if let (Some(i), Some(j)) = (row_at[row], column_at[column]) {
            out.push(i, j, *value);
        }
    }
    CscMatrix::from(&out)
}

fn basis(
    dofs: usize,
    contact: &[usize],
    inner: &[usize],
    constraint_modes: &DMatrix<f64>,
    fixed_modes: &DMatrix<f64>,
) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(dofs, contact.len() + fixed_modes.ncols());
    for (column, row) in contact.iter().enumerate() {
        out[(*row, column)] = 1.0;
    }
    for (i, row) in inner.iter().enumerate() {
        for column in 0..contact.len() {
            out[(*row, column)] = constraint_modes[(i, column)];
        }
        for mode in 0..fixed_modes.ncols() {
            out[(*row, contact.len() + mode)] = fixed_modes[(i, mode)];
        }
    }
    out
}
