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
    /// S₀ = (a Φ s Φᵀ)⁻¹ \[N s/m\], which a block under a clamped face would have, whatever its angle.
    clamped: Aligned,
    /// a s φ of one contact displacement.
    weighted: Aligned,
    /// q without padding and S₀ q, of each free direction.
    release: [[Aligned; 2]; 2],
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
            clamped: Aligned::zeros(4 * linear.nodes * linear.nodes),
            weighted: Aligned::zeros(modes),
            release: [(); 2].map(|()| [(); 2].map(|()| Aligned::zeros(2 * linear.nodes))),
        }
    }

    /// Do they hold for these arguments?
    pub fn fit(&self, linear: &Linear, a: f64, stiffness_factor: f64, angle: f64) -> bool {
        self.same_block(a, stiffness_factor) && self.angle == frame(linear, angle)
    }

    fn same_block(&self, a: f64, stiffness_factor: f64) -> bool {
        self.a == a && self.stiffness_factor == stiffness_factor
    }

    /// Computes them (theory eqs. 3.5 to 3.9); the elimination assumes `normal_slopes` \[N s/m\] of the nodes' normal
    /// forces by their normal speeds. `false` if the block is numerically singular.
    pub fn compute(
        &mut self,
        linear: &Linear,
        a: f64,
        stiffness_factor: f64,
        angle: f64,
        normal_slopes: impl Iterator<Item = f64>,
    ) -> bool {
        if !self.same_block(a, stiffness_factor) && !self.clamp(linear, a, stiffness_factor) {
            return false;
        }
        self.angle = frame(linear, angle);
        let n = self.free_face(linear, a, self.angle);
        self.release(linear, a, n);
        self.flat.split(&self.inverse_delassus, self.angle, normal_slopes)
    }

    /// What does not hang on the angle; `false` if the block is numerically singular.
    fn clamp(&mut self, linear: &Linear, a: f64, stiffness_factor: f64) -> bool {
        (self.a, self.stiffness_factor) = (a, stiffness_factor);
        let kappa = stiffness_factor
            + linear.branches.iter().map(|b| b.share / (1.0 + a / b.time)).sum::<f64>();
        for (m, omega2) in linear.omega2.iter().enumerate() {
            self.a_omega2[m] = a * omega2 * kappa;
            self.s[m] = 1.0 / (1.0 + a * linear.damping * omega2 + a * self.a_omega2[m]);
        }
        let (nodes, modes, size) = (linear.nodes, linear.modes(), 2 * linear.nodes);
        let row = |c: usize| {
            let place = c / nodes * linear.stride + c % nodes;
            &linear.by_contact[place * modes..(place + 1) * modes]
        };
        for i in 0..size {
            for ((to, s), phi) in self.weighted.iter_mut().zip(&self.s).zip(row(i)) {
                *to = a * s * phi;
            }
            for j in 0..=i {
                let w = dense::scalar_product(&self.weighted, row(j));
                self.clamped[i * size + j] = w;
                self.clamped[j * size + i] = w;
            }
        }
        dense::invert(&mut self.clamped, size)
    }

    /// S of S₀ (Woodbury): S₀ − S₀ q (N/a + qᵀ S₀ q)⁻¹ qᵀ S₀.
    fn release(&mut self, linear: &Linear, a: f64, n: [f64; 4]) {
        let (nodes, stride, free) = (linear.nodes, linear.stride, linear.base.len());
        for (j, [q, pushed]) in self.release.iter_mut().enumerate().take(free) {
            for (axis, part) in q.chunks_exact_mut(nodes).enumerate() {
                let from = (2 * j + axis) * stride;
                part.copy_from_slice(&self.q[from..from + nodes]);
            }
            for (to, row) in pushed.iter_mut().zip(self.clamped.chunks_exact(2 * nodes)) {
                *to = dense::scalar_product(row, q);
            }
        }
        let mut inner = n.map(|n| n / a);
        for (j, [q, _]) in self.release.iter().enumerate().take(free) {
            for (k, [_, pushed]) in self.release.iter().enumerate().take(free) {
                inner[2 * j + k] += dense::scalar_product(q, pushed);
            }
        }
        let inner = invert_2x2(inner, free);
        self.inverse_delassus.copy_from_slice(&self.clamped);
        for (j, [_, left]) in self.release.iter().enumerate().take(free) {
            for (k, [_, right]) in self.release.iter().enumerate().take(free) {
                let rows = self.inverse_delassus.chunks_exact_mut(2 * nodes);
                for (row, left) in rows.zip(left) {
                    dense::add(row, -inner[2 * j + k] * left, right);
                }
            }
        }
    }

    /// Γ̃, q and N⁻¹; returns N.
    fn free_face(&mut self, linear: &Linear, a: f64, angle: f64) -> [f64; 4] {
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
                let mode = &linear.by_mode[2 * m * stride..2 * (m + 1) * stride];
                dense::add(q, -(self.s[m] * coupling[m]), mode);
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
        self.n_inverse = invert_2x2(n, linear.base.len());
        n
    }
}

/// Inverse of the first `size` rows and columns, the rest zeros.
fn invert_2x2([a, b, c, d]: [f64; 4], size: usize) -> [f64; 4] {
    match size {
        0 => [0.0; 4],
        1 => [1.0 / a, 0.0, 0.0, 0.0],
        _ => {
            let det = a * d - b * c;
            [d / det, -b / det, -c / det, a / det]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Shape;
    use crate::params::{NormalDrive, Params};

    #[test]
    fn under_a_prescribed_face_matrices_are_kept_while_a_block_turns_by_a_two_hundredth() {
        // By the definition of the frames: multiples of 0.01 rad, the nearest serves.
        let mut params = Params::default();
        params.drive.normal = NormalDrive::Trajectory;
        let linear = Linear::new(&Shape::of(&params).reduce().unwrap(), &params);
        let mut m = StageMatrices::new(&linear);
        assert!(m.compute(&linear, 3e-6, 1.0, 0.02, std::iter::repeat(1.0)));
        for (angle, holds) in [(0.0249, true), (0.0151, true), (0.0251, false), (-0.02, false)] {
            assert_eq!(m.fit(&linear, 3e-6, 1.0, angle), holds, "{angle} rad");
        }
    }

    #[test]
    fn the_inverse_of_a_freed_and_turned_block_times_its_delassus_matrix_is_one() {
        // W = a Φ s Φᵀ + a q N⁻¹ qᵀ as in theory eq. 3.6, written out here; condition about 1e4.
        let mut params = Params::default();
        params.effect.rig_compliance.enabled = true;
        params.drive.normal = NormalDrive::Load;
        let linear = Linear::new(&Shape::of(&params).reduce().unwrap(), &params);
        assert_eq!(linear.base.len(), 2);
        let (a, size, modes) = (3e-6, 2 * linear.nodes, linear.modes());
        let mut m = StageMatrices::new(&linear);
        for angle in [0.0, 0.15, -0.02] {
            assert!(m.compute(&linear, a, 0.9, angle, std::iter::repeat(1.0)));
            let place = |c: usize| c / linear.nodes * linear.stride + c % linear.nodes;
            let phi = |c: usize, mode: usize| linear.by_contact[place(c) * modes + mode];
            let q = |c: usize, j: usize| m.q[2 * j * linear.stride + place(c)];
            let w = |i: usize, j: usize| {
                let own: f64 = (0..modes).map(|k| phi(i, k) * m.s[k] * phi(j, k)).sum();
                let of_face: f64 = (0..4).map(|k| q(i, k / 2) * m.n_inverse[k] * q(j, k % 2)).sum();
                a * (own + of_face)
            };
            for i in 0..size {
                for j in [0, 7, size - 1] {
                    let one: f64 =
                        (0..size).map(|k| m.inverse_delassus[i * size + k] * w(k, j)).sum();
                    let wanted = if i == j { 1.0 } else { 0.0 };
                    assert!((one - wanted).abs() < 1e-9, "{angle} rad, row {i}, column {j}: {one}");
                }
            }
        }
    }
}
