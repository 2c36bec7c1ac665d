//! What a step of a given size needs and nothing else: modal denominators and the inverse Delassus
//! matrix of the contact degrees of freedom.

use super::dense;
use super::linear::Linear;
use crate::pack::{Aligned, LANES};

/// For stage equations with coefficient a \[s\] (γh/2 of the step h).
#[derive(Clone, Debug)]
pub struct StageMatrices {
    /// Coefficient a \[s\]; 0: not yet computed.
    pub a: f64,
    /// Stiffness factor that they hold for \[-\].
    pub stiffness_factor: f64,
    /// Angle \[rad\] that they hold for (matters only where the clamped face is free).
    pub angle: f64,
    /// sₘ = 1/(1 + aβω² + a²ω²κ) per mode \[-\].
    pub s: Aligned,
    /// a·ω²·κ per mode \[1/s\]; κ = stiffness factor and branches as the stage sees them.
    pub a_omega2: Aligned,
    /// S = W⁻¹ \[N s/m\], W = a Φ s Φᵀ + a q N⁻¹ qᵀ the Delassus matrix: contact velocities per contact
    /// force, both in the block's frame, x of all nodes then z, without padding.
    pub inverse_delassus: Aligned,
    /// S split for a block that is not turned.
    pub flat: FlatMatrices,
    /// Coupling Γ̃ to each free direction of the clamped face, direction after direction.
    pub base_coupling: Aligned,
    /// q = e − Φ s Γ̃ per free direction: motion of the contact nodes per velocity of the face.
    pub q: Aligned,
    /// N⁻¹ \[1/kg\], 2 × 2.
    pub n_inverse: [f64; 4],
}

/// S = \[S_tt S_tn; S_nt S_nn\] with the normal velocities eliminated (theory eq. 3.9): what one vector
/// is multiplied by stands in one matrix, column by column of 2 · stride numbers.
#[derive(Clone, Debug)]
pub struct FlatMatrices {
    /// Slope of the normal force by the normal velocity that the elimination assumes, per node
    /// \[N s/m\].
    pub normal_slope: Aligned,
    /// Diagonal of B \[N s/m\]: how a node resists to sliding faster than the others.
    pub resistance: Aligned,
    /// \[B; Pᵀ\], B = S_tt − P S_nt symmetric, P = S_tn A⁻¹.
    pub by_tangential: Aligned,
    /// \[P; A⁻¹\], A⁻¹ = (S_nn + normal slope)⁻¹ symmetric.
    pub by_normal: Aligned,
    /// A⁻¹ and S_tn A⁻¹ while they are made, without padding.
    room: [Aligned; 2],
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
        self.a == a
            && self.stiffness_factor == stiffness_factor
            && (linear.base.is_empty() || self.angle == angle)
    }

    /// Computes them (theory eqs. 3.5 to 3.9); `contact_stiffness` \[N/m\] per node is
    /// what the elimination assumes. `false` if the block is numerically singular.
    pub fn compute(
        &mut self,
        linear: &Linear,
        a: f64,
        stiffness_factor: f64,
        angle: f64,
        contact_stiffness: &[f64],
    ) -> bool {
        (self.a, self.stiffness_factor, self.angle) = (a, stiffness_factor, angle);
        let kappa = stiffness_factor
            + linear.branches.iter().map(|b| b.share / (1.0 + a / b.time)).sum::<f64>();
        for (m, omega2) in linear.omega2.iter().enumerate() {
            self.a_omega2[m] = a * omega2 * kappa;
            self.s[m] = 1.0 / (1.0 + a * linear.damping * omega2 + a * self.a_omega2[m]);
        }
        self.free_face(linear, a, angle);
        self.delassus(linear, a);
        dense::invert(&mut self.inverse_delassus, 2 * linear.nodes)
            && self.flat.split(
                &self.inverse_delassus,
                a,
                contact_stiffness,
                linear.nodes,
                linear.stride,
            )
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

impl FlatMatrices {
    /// Room for `nodes` nodes, `stride` with the padding.
    pub(super) fn new(nodes: usize, stride: usize) -> Self {
        Self {
            normal_slope: Aligned::zeros(stride),
            resistance: Aligned::zeros(stride),
            by_tangential: Aligned::zeros(2 * stride * columns(nodes)),
            by_normal: Aligned::zeros(2 * stride * columns(nodes)),
            room: [(); 2].map(|()| Aligned::zeros(nodes * nodes)),
        }
    }

    fn split(
        &mut self,
        s: &[f64],
        a: f64,
        contact_stiffness: &[f64],
        n: usize,
        stride: usize,
    ) -> bool {
        let full = |i: usize, j: usize| s[i * 2 * n + j];
        for (slope, k) in self.normal_slope.iter_mut().zip(contact_stiffness) {
            *slope = a * k;
        }
        let [a_inverse, p] = &mut self.room;
        for i in 0..n {
            for j in 0..n {
                a_inverse[i * n + j] = full(n + i, n + j);
            }
            a_inverse[i * n + i] += self.normal_slope[i];
        }
        if !dense::invert(a_inverse, n) {
            return false;
        }
        self.by_tangential.fill(0.0);
        self.by_normal.fill(0.0);
        for i in 0..n {
            for j in 0..n {
                let sum = (0..n).map(|k| full(i, n + k) * a_inverse[k * n + j]).sum();
                p[i * n + j] = sum;
                self.by_normal[j * 2 * stride + i] = sum;
                self.by_normal[j * 2 * stride + stride + i] = a_inverse[i * n + j];
                self.by_tangential[i * 2 * stride + stride + j] = sum;
            }
        }
        for i in 0..n {
            for j in 0..=i {
                let sum: f64 = (0..n).map(|k| p[i * n + k] * full(n + k, j)).sum();
                self.by_tangential[i * 2 * stride + j] = full(i, j) - sum;
                self.by_tangential[j * 2 * stride + i] = full(i, j) - sum;
            }
            self.resistance[i] = self.by_tangential[i * 2 * stride + i];
        }
        true
    }
}

/// Columns of a matrix per contact node: an even number, and a full pack, which is compiled without a loop, of few.
pub(super) fn columns(nodes: usize) -> usize {
    nodes.next_multiple_of(2).max(LANES)
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
