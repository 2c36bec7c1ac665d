//! What a step of a given size needs and nothing else: modal denominators and the inverse Delassus
//! matrix of the contact degrees of freedom.

use super::dense;
use super::linear::Linear;

/// For stage equations with coefficient a [s] (γh/2 of the step h).
#[derive(Clone, Debug)]
pub struct StageMatrices {
    /// Coefficient a [s]; 0: not yet computed.
    pub a: f64,
    /// Stiffness factor that they hold for [-].
    pub stiffness_factor: f64,
    /// Angle [rad] that they hold for (matters only where the clamped face is free).
    pub angle: f64,
    /// sₘ = 1/(1 + aβω² + a²ω²κ) per mode [-].
    pub s: Vec<f64>,
    /// a·ω²·κ per mode [1/s]; κ = stiffness factor and branches as the stage sees them.
    pub a_omega2: Vec<f64>,
    /// W⁻¹ [N s/m], W = a Φ s Φᵀ + a q N⁻¹ qᵀ the Delassus matrix: contact velocities per contact
    /// force, both in the block's frame, x of all nodes then z.
    pub inverse_delassus: Vec<f64>,
    /// Coupling Γ̃ to each free direction of the clamped face, direction after direction.
    pub base_coupling: Vec<f64>,
    /// q = e − Φ s Γ̃ per free direction: motion of the contact nodes per velocity of the face.
    pub q: Vec<f64>,
    /// N⁻¹ [1/kg], 2 × 2.
    pub n_inverse: [f64; 4],
}

impl StageMatrices {
    /// Room for the matrices of `linear`.
    pub fn new(linear: &Linear) -> Self {
        let (modes, contact) = (linear.modes(), 2 * linear.nodes());
        Self {
            a: 0.0,
            stiffness_factor: 1.0,
            angle: 0.0,
            s: vec![0.0; modes],
            a_omega2: vec![0.0; modes],
            inverse_delassus: vec![0.0; contact * contact],
            base_coupling: vec![0.0; 2 * modes],
            q: vec![0.0; 2 * contact],
            n_inverse: [0.0; 4],
        }
    }

    /// Do they hold for these arguments?
    pub fn fit(&self, linear: &Linear, a: f64, stiffness_factor: f64, angle: f64) -> bool {
        self.a == a
            && self.stiffness_factor == stiffness_factor
            && (linear.base.is_empty() || self.angle == angle)
    }

    /// Computes them (theory eqs. 3.5 to 3.8); `false` if the block is numerically singular.
    pub fn compute(&mut self, linear: &Linear, a: f64, stiffness_factor: f64, angle: f64) -> bool {
        (self.a, self.stiffness_factor, self.angle) = (a, stiffness_factor, angle);
        let kappa = stiffness_factor
            + linear.branches.iter().map(|b| b.share / (1.0 + a / b.time)).sum::<f64>();
        for (m, omega2) in linear.omega2.iter().enumerate() {
            self.a_omega2[m] = a * omega2 * kappa;
            self.s[m] = 1.0 / (1.0 + a * linear.damping * omega2 + a * self.a_omega2[m]);
        }
        self.free_face(linear, a, angle);
        self.delassus(linear, a);
        dense::invert(&mut self.inverse_delassus, 2 * linear.nodes())
    }

    /// Γ̃, q and N⁻¹.
    fn free_face(&mut self, linear: &Linear, a: f64, angle: f64) {
        let (modes, nodes) = (linear.modes(), linear.nodes());
        let mut n = [0.0; 4];
        for (j, dof) in linear.base.iter().enumerate() {
            let direction = in_block_frame(dof.axis, angle);
            let coupling = &mut self.base_coupling[j * modes..(j + 1) * modes];
            let q = &mut self.q[2 * j * nodes..2 * (j + 1) * nodes];
            for (axis, component) in direction.iter().enumerate() {
                q[axis * nodes..(axis + 1) * nodes].fill(*component);
            }
            for m in 0..modes {
                coupling[m] = linear.coupling_along(m, direction);
                let weight = self.s[m] * coupling[m];
                let mode = &linear.by_mode[2 * m * nodes..2 * (m + 1) * nodes];
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
        let (modes, contact) = (linear.modes(), 2 * linear.nodes());
        let w = &mut self.inverse_delassus;
        w.fill(0.0);
        for m in 0..modes {
            let mode = &linear.by_mode[m * contact..(m + 1) * contact];
            add_outer(w, mode, mode, a * self.s[m]);
        }
        for j in 0..linear.base.len() {
            for k in 0..linear.base.len() {
                let (left, right) = (
                    &self.q[j * contact..(j + 1) * contact],
                    &self.q[k * contact..(k + 1) * contact],
                );
                add_outer(w, left, right, a * self.n_inverse[2 * j + k]);
            }
        }
    }
}

/// Unit vector of a road axis (0: along, 1: up) in the frame of a block turned by `angle` [rad].
pub fn in_block_frame(axis: usize, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    if axis == 0 {
        [cos, -sin]
    } else {
        [sin, cos]
    }
}

/// `matrix` += `factor` · `left` `right`ᵀ.
fn add_outer(matrix: &mut [f64], left: &[f64], right: &[f64], factor: f64) {
    for (row, l) in matrix.chunks_exact_mut(right.len()).zip(left) {
        let weight = factor * l;
        for (value, r) in row.iter_mut().zip(right) {
            *value += weight * r;
        }
    }
}
