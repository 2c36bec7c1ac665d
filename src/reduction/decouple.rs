//! The reduced model in its own eigenvectors: an exact change of basis that makes M, C and D = βC
//! diagonal, so that a step of any size needs no factorisation of the linear part.

use super::craig_bampton::CraigBampton;
use super::fixed_interface::dense_pencil;
use super::interface::Interface;
use crate::error::Fault;
use crate::fe::{assemble, FullModel};
use crate::mesh::Mesh;
use crate::params::Plane;
use nalgebra::{DMatrix, DVector};

/// The reduced block per unit modulus, density and width, decoupled.
///
/// For a block of modulus E, density ρ and width b: ω² = λ·E/ρ, and modes, coupling and shapes scale
/// with (ρ b)^(−1/2), (ρ b)^(1/2) and (ρ b)^(−1/2).
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Mesh that was reduced.
    pub mesh: Mesh,
    /// Eigenvalues λ \[1/m²\], ascending.
    pub lambda: Vec<f64>,
    /// Contact displacements per mode: rows x of the contact nodes then z, columns modes.
    pub contact_modes: DMatrix<f64>,
    /// Coupling Φᵀ M r to the rigid motions of the clamped face: x, z, rotation.
    pub coupling: [DVector<f64>; 3],
    /// Coupling Φᵀ M s to the shear pattern s that falls linearly along x from one at the tread face
    /// to zero at the clamped face.
    pub shear_coupling: DVector<f64>,
    /// Displacements of all free degrees of freedom per mode.
    pub shapes: DMatrix<f64>,
    /// Free degree of freedom of a node's x and z.
    pub dof: Vec<Option<usize>>,
    /// What stands for the tread face in contact.
    pub interface: Interface,
}

impl Reduction {
    /// Assembles, reduces and decouples; `bound` is λ = ω²ρ/E \[1/m²\] up to which fixed-interface modes are
    /// kept, `points` the number of contact points, `None` for the nodes of the mesh.
    ///
    /// # Errors
    /// [`Fault::NotFinite`] if the mesh is degenerate.
    pub fn of_block(
        mesh: Mesh,
        points: Option<usize>,
        poisson_ratio: f64,
        plane: Plane,
        bound: f64,
    ) -> Result<Self, Fault> {
        let full = assemble(&mesh, poisson_ratio, plane);
        let reduced = CraigBampton::reduce(&full, &mesh, bound)?;
        match points {
            None => Self::decouple(Interface::of_mesh(&mesh), mesh, &full, &reduced),
            Some(points) => {
                let interface = Interface::gauss_lobatto(&mesh, points);
                let restricted = interface.restrict(&reduced, &mesh);
                Self::decouple(interface, mesh, &full, &restricted)
            }
        }
    }

    /// Decouples a reduced model.
    ///
    /// # Errors
    /// [`Fault::NotFinite`] if the reduced mass is not positive definite.
    pub fn decouple(
        interface: Interface,
        mesh: Mesh,
        full: &FullModel,
        reduced: &CraigBampton,
    ) -> Result<Self, Fault> {
        let (lambda, vectors) = dense_pencil(&reduced.stiffness, &reduced.mass)?;
        let shapes = &reduced.basis * &vectors;
        let coupling = std::array::from_fn(|r| {
            shapes.transpose() * DVector::from_column_slice(&full.rigid_coupling[r])
        });
        let shear_coupling = shapes.transpose() * (&full.mass * shear_pattern(&mesh, full));
        Ok(Self {
            lambda,
            shear_coupling,
            contact_modes: vectors.rows(0, 2 * reduced.contact_nodes).into_owned(),
            coupling,
            shapes,
            dof: full.dof.clone(),
            interface,
            mesh,
        })
    }

    /// Number of contact nodes: nodes of the mesh or points between them.
    pub fn contact_nodes(&self) -> usize {
        self.interface.points()
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.lambda.len()
    }

    /// Free eigenfrequencies \[Hz\] for E/ρ \[m²/s²\].
    pub fn frequencies(&self, e_over_rho: f64) -> Vec<f64> {
        self.lambda.iter().map(|l| (l * e_over_rho).sqrt() / std::f64::consts::TAU).collect()
    }
}

/// 1 − y/h along x at the free degrees of freedom, y from the tread face.
fn shear_pattern(mesh: &Mesh, full: &FullModel) -> DVector<f64> {
    let height = mesh.z[mesh.z.len() - 1];
    let mut pattern = DVector::zeros(full.dofs());
    for node in 0..mesh.node_count() {
        if let Some(row) = full.dof[2 * node] {
            pattern[row] = 1.0 - mesh.position(node)[1] / height;
        }
    }
    pattern
}
