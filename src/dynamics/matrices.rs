//! What a step of a given size needs and nothing else: modal denominators and the inverse Delassus
//! matrix of the contact degrees of freedom.

use super::dense;
use super::flat::FlatMatrices;
use super::linear::Linear;
use crate::pack::Aligned;

/// Angle \[rad\] between the frames for which S is split while a block turns whose S does not: half of it is how
/// far the road may lie off the frame.
const FRAMES: f64 = 0.01;

/// For stage equations with coefficient a \[s\] (γh/2 of the step h).
#[derive(Clone, Debug)]
pub struct StageMatrices {
    /// Coefficient a \[s\]; 0: not yet computed.
    pub a: f64,
    /// Stiffness factor that they hold for \[-\].
    pub stiffness_factor: f64,
    /// Angle \[rad\] of the block in the frame of the split, and where the clamped face is free in that of all.
    pub angle: f64,
    /// sₘ = 1/(1 + aβω² + a²ω²κ) per mode \[-\].
    pub s: Aligned,
    /// a·ω²·κ per mode \[1/s\]; κ = stiffness factor and branches as the stage sees them.
    pub a_omega2: Aligned,
    /// S = W⁻¹ \[N s/m\], W = a Φ s Φᵀ + a q N⁻¹ qᵀ the Delassus matrix: contact velocities per contact
    /// force, both in the block's frame, x of all nodes then z, without padding.
    pub inverse_delassus: Aligned,
    /// S split in normal and tangential velocities.
    pub flat: FlatMatrices,
    /// Coupling Γ̃ to each free direction of the clamped face, direction after direction.
    pub base_coupling: Aligned,
    /// q = e − Φ s Γ̃ per free direction: motion of the contact nodes per velocity of the face.
    pub q: Aligned,
    /// N⁻¹ \[1/kg\], 2 × 2.
    pub n_inverse: [f64; 4],
}

impl StageMatrices {
    /// Room for the matrices of `linear`.
    pub fn new(linear: &Linear) -> Self {
        let (modes, stride) = (linear.modes(), linear.stride);
        Self {
            a: 0.0,
            stiffness_factor: 1.0,
            angle: 0.0,
            s: Aligned::zeros(modes),
            a_omega2: Aligned::zeros(modes),
            inverse_delassus: Aligned::zeros(4 * linear.nodes * linear.nodes),
            flat: FlatMatrices::new(linear.nodes, stride),
            base_coupling: Aligned::zeros(2 * modes),
            q: Aligned::zeros(4 * stride),
            n_inverse: [0.0; 4],
        }
    }

    /// Do they hold for these arguments?
    pub fn fit(&self, linear: &Linear, a: f64, stiffness_factor: f64, angle: f64) -> bool {
        self.same_block(a, stiffness_factor) && self.angle == frame(linear, angle)
    }

    fn same_block(&self, a: f64, stiffness_factor: f64) -> bool {
        self.a == a && self.stiffness_factor == stiffness_factor
    }

    /// Computes them (theory eqs. 3.5 to 3.9); the elimination assumes
    /// `normal_slopes` \[N s/m\] of the nodes' normal forces by their normal speeds. `false` if the block is numerically singular.
    pub fn compute(
        &mut self,
        linear: &Linear,
        a: f64,
        stiffness_factor: f64,
        angle: f64,
        normal_slopes: impl Iterator<Item = f64>,
    ) -> bool {
        let turned_only = linear.base.is_empty() && self.same_block(a, stiffness_factor);
        self.angle = frame(linear, angle);
        if !turned_only && !self.invert(linear, a, stiffness_factor) {
            return false;
        }
        self.flat.split(&self.inverse_delassus, self.angle, normal_slopes)
    }

    /// All but the split; `false` if the block is numerically singular.
    fn invert(&mut self, linear: &Linear, a: f64, stiffness_factor: f64) -> bool {
        (self.a, self.stiffness_factor) = (a, stiffness_factor);
        let kappa = stiffness_factor
            + linear.branches.iter().map(|b| b.share / (1.0 + a / b.time)).sum::<f64>();
        for (m, omega2) in linear.omega2.iter().enumerate() {
            self.a_omega2[m] = a * omega2 * kappa;
            self.s[m] = 1.0 / (1.0 + a * linear.damping * omega2 + a * self.a_omega2[m]);
        }
        self.free_face(linear, a, self.angle);
        self.delassus(linear, a);
        dense::invert(&mut self.inverse_delassus, 2 * linear.nodes)
    }

    /// Γ̃, q and N⁻¹.
    fn free_face(&mut self, linear: &Linear, a: f64, angle: f64) {
        let (modes, stride) = (linear.modes(), linear.stride);
        let mut n = [0.0; 4];
        for (j, dof) in linear.base.iter().enumerate() {
            let direction = in_block_frame(dof.axis, angle);
            let coupling = &mut self.base_coupling[j * modes..(j + 1) * modes];
            let q = &mut self.q[2 * j * stride..2 * (j + 1) * stride];
            q.fill(0.0);
            for (axis, component) in direction.iter().enumerate() {
                q[axis * stride..axis * stride + linear.nodes].fill(*component);
            }
            for m in 0..modes {
                coupling[m] = linear.coupling_along(m, direction);
                let weight = self.s[m] * coupling[m];
                let mode = &linear.by_mode[2 * m * stride..2 * (m + 1) * stride];
                for (q, phi) in q.iter_mut().zip(mode) {
                    *q -= weight * phi;
                }
            }
            n[3 * j] = linear.block_mass + dof.mass + a * dof.damping + a * a * dof.stiffness;
        }
        for j in 0..linear.base.len() {
            for k in 0..linear.base.len() {
                let sum: f64 = (0..modes)
                    .map(|m| {
                        self.base_coupling[j * modes + m]
                            * self.s[m]
                            * self.base_coupling[k * modes + m]
                    })
                    .sum();
                n[2 * j + k] -= sum;
            }
        }
        self.n_inverse = match linear.base.len() {
            0 => [0.0; 4],
            1 => [1.0 / n[0], 0.0, 0.0, 0.0],
            _ => {
                let det = n[0] * n[3] - n[1] * n[2];
                [n[3] / det, -n[1] / det, -n[2] / det, n[0] / det]
            }
        };
    }

    /// W into `inverse_delassus`, not yet inverted.
    fn delassus(&mut self, linear: &Linear, a: f64) {
        let (nodes, stride) = (linear.nodes, linear.stride);
        let w = &mut self.inverse_delassus;
        w.fill(0.0);
        for (m, mode) in linear.by_mode.chunks_exact(2 * stride).enumerate() {
            add_outer(w, mode, mode, a * self.s[m], nodes, stride);
        }
        for j in 0..linear.base.len() {
            for k in 0..linear.base.len() {
                let left = &self.q[2 * j * stride..2 * (j + 1) * stride];
                let right = &self.q[2 * k * stride..2 * (k + 1) * stride];
                add_outer(w, left, right, a * self.n_inverse[2 * j + k], nodes, stride);
            }
        }
    }
}

/// Angle \[rad\] of the frame in which a block turned by `angle` is split: its own where all depends on it, else one
/// of few, because a block that rolls turns in every step. It hangs on nothing but the angle, so that restored
/// blocks go on with the same bits.
fn frame(linear: &Linear, angle: f64) -> f64 {
    if linear.base.is_empty() {
        (angle / FRAMES).round() * FRAMES
    } else {
        angle
    }
}

/// Unit vector of a road axis (0: along, 1: up) in the frame of a block turned by `angle` \[rad\].
pub fn in_block_frame(axis: usize, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    if axis == 0 {
        [cos, -sin]
    } else {
        [sin, cos]
    }
}

/// `matrix` (without padding) += `factor` · `left` `right`ᵀ (padded).
fn add_outer(
    matrix: &mut [f64],
    left: &[f64],
    right: &[f64],
    factor: f64,
    nodes: usize,
    stride: usize,
) {
    for (c, row) in matrix.chunks_exact_mut(2 * nodes).enumerate() {
        let weight = factor * left[c / nodes * stride + c % nodes];
        let (x, z) = row.split_at_mut(nodes);
        for (value, r) in x.iter_mut().zip(right) {
            *value += weight * r;
        }
        for (value, r) in z.iter_mut().zip(&right[stride..]) {
            *value += weight * r;
        }
    }
}
