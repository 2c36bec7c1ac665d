//! Craig and Bampton, AIAA Journal 6 (1968): constraint modes and fixed-interface modes; and what the
//! block's own free modes add to them.

use super::fixed_interface::eigenpairs_below;
use super::product::product;
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
    /// Reduced stiffness \[-\].
    pub stiffness: DMatrix<f64>,
    /// Reduced mass \[m²\].
    pub mass: DMatrix<f64>,
    /// Free degrees of freedom of the full model from the reduced coordinates.
    pub basis: DMatrix<f64>,
    /// Number of contact nodes.
    pub contact_nodes: usize,
}

impl CraigBampton {
    /// Reduces `full`, keeping all fixed-interface modes with λ = ω²ρ/E ≤ `bound` \[1/m²\].
    ///
    /// These converge slowly where many degrees of freedom are contacts: for 0.1 % in a frequency they
    /// had to reach to seven times that frequency. Therefore the basis also takes what it lacks of the
    /// free eigenvectors up to the bound; their frequencies are then those of the full model.
    ///
    /// # Errors
    /// [`Fault::NotFinite`] if the mesh is degenerate.
    pub fn reduce(full: &FullModel, mesh: &Mesh, bound: f64) -> Result<Self, Fault> {
        let contact = contact_dofs(full, mesh);
        let inner: Vec<usize> = (0..full.dofs()).filter(|d| !contact.contains(d)).collect();
        let k_ii = part(&full.stiffness, &inner, &inner);
        let factor = CscCholesky::factor(&k_ii).map_err(|_| Fault::NotFinite {
            what: "stiffness matrix of the block".into(),
            time: 0.0,
        })?;
        let k_ic = DMatrix::from(&part(&full.stiffness, &inner, &contact));
        let constraint_modes = -factor.solve(&k_ic);
        let m_ii = part(&full.mass, &inner, &inner);
        let (_, fixed_modes) = eigenpairs_below(bound, &factor, &m_ii)?;
        let free_modes = free_modes(full, bound)?;
        let lacking = lacking(&free_modes, &contact, &inner, &constraint_modes);
        let inner_modes = joined(fixed_modes, &lacking, &m_ii);
        let basis = basis(full.dofs(), &contact, &inner, &constraint_modes, &inner_modes);
        let project = |matrix: &CscMatrix<f64>| basis.tr_mul(&product(matrix, &basis));
        Ok(Self {
            stiffness: project(&full.stiffness),
            mass: project(&full.mass),
            basis,
            contact_nodes: contact.len() / 2,
        })
    }
}

/// Eigenvectors of the block with a free tread face, λ ≤ `bound`.
fn free_modes(full: &FullModel, bound: f64) -> Result<DMatrix<f64>, Fault> {
    let factor = CscCholesky::factor(&full.stiffness).map_err(|_| Fault::NotFinite {
        what: "stiffness matrix of the block".into(),
        time: 0.0,
    })?;
    Ok(eigenpairs_below(bound, &factor, &full.mass)?.1)
}

/// What static deflections under their contact displacements leave of `modes`, inner part.
fn lacking(
    modes: &DMatrix<f64>,
    contact: &[usize],
    inner: &[usize],
    constraint_modes: &DMatrix<f64>,
) -> DMatrix<f64> {
    modes.select_rows(inner) - constraint_modes * modes.select_rows(contact)
}

/// Share of a vector below which nothing new is left of it.
const NOTHING_NEW: f64 = 1e-5;

/// `fixed_modes` (M-orthonormal) and what is new in `more`, M-orthonormal to all before.
fn joined(fixed_modes: DMatrix<f64>, more: &DMatrix<f64>, mass: &CscMatrix<f64>) -> DMatrix<f64> {
    let mut all = fixed_modes;
    for column in more.column_iter() {
        let mut rest = DMatrix::from_column_slice(column.len(), 1, column.clone_owned().as_slice());
        let norm = |vector: &DMatrix<f64>| vector.dot(&product(mass, vector)).sqrt();
        let before = norm(&rest);
        // Twice is enough for orthogonality to rounding.
        for _ in 0..2 {
            let share = all.tr_mul(&product(mass, &rest));
            rest -= &all * share;
        }
        let left = norm(&rest);
        if left > NOTHING_NEW * before {
            let at = all.ncols();
            all = all.insert_column(at, 0.0);
            all.set_column(at, &(rest.column(0) / left));
        }
    }
    all
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
