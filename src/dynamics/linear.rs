//! The linear part of the block in SI units: decoupled modes of the clamped block and its carriage.

use crate::contact::face::padded;
use crate::effects::viscoelastic_modulus::Branch;
use crate::pack::Aligned;
use crate::params::{NormalDrive, Params};
use crate::reduction::Reduction;

/// A direction in which the clamped face may move, with what holds it: normal to the road its
/// position itself, along the road its deflection from the prescribed motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseDof {
    /// 0: along the road, 1: normal to it.
    pub axis: usize,
    /// Mass \[kg\] that moves with the clamped face.
    pub mass: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
    /// Stiffness \[N/m\] towards 0.
    pub stiffness: f64,
}

/// Vectors per mode and per contact node are padded to full packs: modes that couple to nothing,
/// nodes out of reach of the road.
///
/// z̈ + βω²ż + ω²(z + Σ gⱼ(z − yⱼ)) = Φᵀf − Γ·a, ẏⱼ = (z − yⱼ)/τⱼ, per mode (theory eq. 3.1).
#[derive(Clone, Debug)]
pub struct Linear {
    /// ω² \[1/s²\] per mode.
    pub omega2: Aligned,
    /// Stiffness-proportional damping β \[s\].
    pub damping: f64,
    /// Number of contact nodes.
    pub nodes: usize,
    /// The same, padded.
    pub stride: usize,
    /// Contact displacements per mode \[kg^−1/2\]: mode m at `m * 2 * stride`, x of all nodes then z.
    pub by_mode: Aligned,
    /// The transpose: contact displacement c (of 2 · stride) at `c * modes`.
    pub by_contact: Aligned,
    /// Coupling Γ \[kg^1/2\] to the acceleration of the clamped face: x, z, rotation.
    pub coupling: [Aligned; 3],
    /// Mass of the block \[kg\].
    pub block_mass: f64,
    /// Positions of the contact nodes from the middle of the clamped face: x \[m\].
    pub node_x: Aligned,
    /// The same, z \[m\]: −h.
    pub node_z: f64,
    /// Directions in which the clamped face is free.
    pub base: Vec<BaseDof>,
    /// Does the road move under a block that rests in the laboratory, so that the prescribed
    /// tangential motion has no inertia?
    pub road_moves: bool,
    /// Maxwell branches.
    pub branches: Vec<Branch>,
}

impl Linear {
    /// Scales a reduction to modulus, density and width.
    pub fn new(reduction: &Reduction, params: &Params) -> Self {
        let rubber = &params.rubber;
        let linear_density = rubber.density * params.block.width;
        let scale = linear_density.sqrt();
        let (nodes, modes) = (reduction.contact_nodes(), padded(reduction.modes()));
        let stride = padded(nodes);
        let mut by_mode = Aligned::zeros(modes * 2 * stride);
        let mut by_contact = Aligned::zeros(modes * 2 * stride);
        for m in 0..reduction.modes() {
            for c in 0..2 * nodes {
                let value = reduction.contact_modes[(c, m)] / scale;
                let place = c / nodes * stride + c % nodes;
                by_mode[m * 2 * stride + place] = value;
                by_contact[place * modes + m] = value;
            }
        }
        let e_over_rho = rubber.young_modulus / rubber.density;
        let omega2: Vec<f64> = reduction.lambda.iter().map(|l| l * e_over_rho).collect();
        let mut base = Vec::new();
        if params.drive.normal == NormalDrive::Load {
            let carriage = &params.carriage;
            base.push(BaseDof {
                axis: 1,
                mass: carriage.mass,
                damping: carriage.damping,
                stiffness: 0.0,
            });
        }
        if let Some(rig) = params.effect.rig_compliance.oscillator(params.carriage.mass) {
            let (mass, damping, stiffness) = (rig.mass, rig.damping, rig.stiffness);
            base.push(BaseDof { axis: 0, mass, damping, stiffness });
        }
        Self {
            omega2: Aligned::padded(&omega2, modes, 1.0),
            nodes,
            stride,
            damping: rubber.stiffness_damping,
            by_mode,
            by_contact,
            coupling: std::array::from_fn(|r| {
                Aligned::padded((&reduction.coupling[r] * scale).as_slice(), modes, 0.0)
            }),
            block_mass: linear_density * params.block.length * params.block.height,
            node_x: Aligned::padded(&reduction.interface.x, stride, 0.0),
            node_z: -params.block.height,
            base,
            road_moves: params.drive.normal == NormalDrive::Load,
            branches: params.effect.viscoelastic_modulus.branches(),
        }
    }

    /// Number of modes, padded.
    pub fn modes(&self) -> usize {
        self.omega2.len()
    }

    /// The parts of a road vector that are prescribed: none normal to the road where the clamped face
    /// is free; along the road always, since its freedom there is a deflection.
    pub fn prescribed(&self, mut vector: [f64; 2]) -> [f64; 2] {
        for dof in self.base.iter().filter(|dof| dof.axis == 1) {
            vector[dof.axis] = 0.0;
        }
        vector
    }

    /// Prescribed acceleration that the block's inertia feels \[m/s²\].
    pub fn prescribed_acceleration(&self, acceleration: [f64; 2]) -> [f64; 2] {
        let [x, z] = self.prescribed(acceleration);
        [if self.road_moves { 0.0 } else { x }, z]
    }

    /// Tangential deflection of the clamped face in the coordinates `base`; also of velocities.
    pub fn deflection(&self, base: &[f64; 2]) -> f64 {
        self.base.iter().zip(base).filter(|(dof, _)| dof.axis == 0).map(|(_, b)| b).sum()
    }

    /// Coupling of mode `m` to a unit acceleration of the clamped face along a direction that is
    /// (`x`, `z`) in the block's frame.
    #[inline(always)]
    pub fn coupling_along(&self, m: usize, [x, z]: [f64; 2]) -> f64 {
        self.coupling[0][m] * x + self.coupling[1][m] * z
    }
}
