//! Global stiffness and mass of the block with its top face clamped.

use super::{element, material};
use crate::mesh::Mesh;
use crate::params::Plane;
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// The unreduced model, per unit modulus, density and width.
#[derive(Clone, Debug)]
pub struct FullModel {
    /// Stiffness C₁ \[-\] of the free degrees of freedom.
    pub stiffness: CscMatrix<f64>,
    /// Consistent mass M₁ \[m²\] of the free degrees of freedom.
    pub mass: CscMatrix<f64>,
    /// Rigid motions of all free degrees of freedom: x, z, and rotation about the middle of the
    /// clamped face (z' forward, −x upward; see `Outputs::moment_y`).
    pub rigid: [Vec<f64>; 3],
    /// Mass coupling M₁·r of the free degrees of freedom to the motion of the clamped face,
    /// including the consistent mass between free and clamped nodes \[m²\].
    pub rigid_coupling: [Vec<f64>; 3],
    /// Free degree of freedom of a node's x and z, `None` at the clamped face.
    pub dof: Vec<Option<usize>>,
}

impl FullModel {
    /// Number of free degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.stiffness.nrows()
    }
}

/// Assembles the block; the clamped face leaves the equations.
pub fn assemble(mesh: &Mesh, poisson_ratio: f64, plane: Plane) -> FullModel {
    let dof = number(mesh);
    let count = dof.iter().flatten().count();
    let elasticity = material::elasticity(poisson_ratio, plane);
    let mut stiffness = CooMatrix::new(count, count);
    let mut mass = CooMatrix::new(count, count);
    let mut coupling = [vec![0.0; count], vec![0.0; count], vec![0.0; count]];
    let (along, up) = mesh.elements();
    for ex in 0..along {
        for ez in 0..up {
            let dx = mesh.x[2 * ex + 2] - mesh.x[2 * ex];
            let dz = mesh.z[2 * ez + 2] - mesh.z[2 * ez];
            let (k, m) = element::matrices(dx, dz, &elasticity);
            let nodes: [usize; 9] =
                std::array::from_fn(|a| mesh.node(2 * ex + a / 3, 2 * ez + a % 3));
            for a in 0..element::DOFS {
                let Some(row) = dof[2 * nodes[a / 2] + a % 2] else { continue };
                for b in 0..element::DOFS {
                    let (node, axis) = (nodes[b / 2], b % 2);
                    for (sum, r) in coupling.iter_mut().zip(rigid_at(mesh, node, axis)) {
                        sum[row] += m[(a, b)] * r;
                    }
                    if let Some(column) = dof[2 * node + axis] {
                        stiffness.push(row, column, k[(a, b)]);
                        mass.push(row, column, m[(a, b)]);
                    }
                }
            }
        }
    }
    FullModel {
        stiffness: CscMatrix::from(&stiffness),
        mass: CscMatrix::from(&mass),
        rigid: rigid_motions(mesh, &dof),
        rigid_coupling: coupling,
        dof,
    }
}

/// Rigid motions of the free degrees of freedom, which are numbered in the order of the nodes.
fn rigid_motions(mesh: &Mesh, dof: &[Option<usize>]) -> [Vec<f64>; 3] {
    let free = (0..dof.len()).filter(|at| dof[*at].is_some());
    let motions: Vec<[f64; 3]> = free.map(|at| rigid_at(mesh, at / 2, at % 2)).collect();
    std::array::from_fn(|mode| motions.iter().map(|r| r[mode]).collect())
}

/// How far each rigid motion takes a node along an axis; rotation is about the middle of the clamped face.
fn rigid_at(mesh: &Mesh, node: usize, axis: usize) -> [f64; 3] {
    let height = mesh.z[mesh.z.len() - 1];
    let [x, z] = mesh.position(node);
    [[1.0, 0.0], [0.0, 1.0], [z - height, -x]].map(|r: [f64; 2]| r[axis])
}

fn number(mesh: &Mesh) -> Vec<Option<usize>> {
    let mut next = 0;
    (0..2 * mesh.node_count())
        .map(|at| {
            (!mesh.is_clamped(at / 2)).then(|| {
                next += 1;
                next - 1
            })
        })
        .collect()
}
