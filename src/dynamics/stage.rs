//! One implicit stage: given the explicit part of the stage, find velocities that satisfy inertia,
//! contact and friction at the end of it.

use super::dense;
use super::linear::Linear;
use super::matrices::StageMatrices;
use crate::contact::{Face, Traction};

/// Prescribed motion of the clamped face at one instant, road frame.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Kinematics {
    /// Position x, z [m].
    pub position: [f64; 2],
    /// Velocity x, z [m/s].
    pub velocity: [f64; 2],
    /// Acceleration x, z [m/s²].
    pub acceleration: [f64; 2],
    /// sin and cos of the angle.
    pub sin_cos: [f64; 2],
    /// Angular velocity [rad/s].
    pub omega: f64,
    /// Normal load [N].
    pub load: f64,
}

impl Kinematics {
    /// As plain numbers.
    pub fn to_numbers(&self) -> [f64; 10] {
        let [px, pz] = self.position;
        let [vx, vz] = self.velocity;
        let [ax, az] = self.acceleration;
        let [sin, cos] = self.sin_cos;
        [px, pz, vx, vz, ax, az, sin, cos, self.omega, self.load]
    }

    /// From what [`Self::to_numbers`] gave.
    pub fn from_numbers(n: &[f64; 10]) -> Self {
        Self {
            position: [n[0], n[1]],
            velocity: [n[2], n[3]],
            acceleration: [n[4], n[5]],
            sin_cos: [n[6], n[7]],
            omega: n[8],
            load: n[9],
        }
    }
}

/// How the Newton iteration of a stage went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Iterations done.
    pub iterations: usize,
    /// Last change of a velocity [m/s].
    pub change: f64,
    /// Did it converge?
    pub converged: bool,
}

/// Iterations after which a stage is given up and the step made smaller.
const MAX_ITERATIONS: usize = 25;

/// Explicit parts (starred in the theory, eq. 3.3), unknowns and buffers of a stage.
#[derive(Clone, Debug)]
pub struct Stage {
    /// z* per mode.
    pub z: Vec<f64>,
    /// w* per mode.
    pub w: Vec<f64>,
    /// y* per branch and mode.
    pub y: Vec<f64>,
    /// Contact displacements Φ z* [m], block frame.
    pub u: Vec<f64>,
    /// Free coordinates of the clamped face, starred [m].
    pub base: [f64; 2],
    /// Their velocities, starred [m/s].
    pub base_velocity: [f64; 2],
    /// Solution: modal velocities.
    pub w_end: Vec<f64>,
    /// Solution: velocities of the free face [m/s].
    pub base_velocity_end: [f64; 2],
    /// Solution (and first guess): contact velocities [m/s], block frame, with the free face's.
    pub v: Vec<f64>,
    /// Solution: contact forces [N], block frame.
    pub force: Vec<f64>,
    /// Speed over the road and away from it [m/s] at the last evaluation.
    pub slip: Vec<f64>,
    /// Speed away from the road [m/s] at the last evaluation.
    pub lift: Vec<f64>,
    /// Compression [m] at the last evaluation.
    pub compression: Vec<f64>,
    /// Forces and slopes at the last evaluation.
    pub traction: Traction,
    rhs: Vec<f64>,
    v_free: Vec<f64>,
    residual: Vec<f64>,
    jacobian: Vec<f64>,
    rest_compression: Vec<f64>,
    carried: Vec<f64>,
    scratch: Vec<f64>,
    product: Vec<f64>,
    slopes: Vec<[f64; 4]>,
}

impl Stage {
    /// Room for a stage of `linear`.
    pub fn new(linear: &Linear) -> Self {
        let (modes, nodes) = (linear.modes(), linear.nodes());
        let m = || vec![0.0; modes];
        let c = || vec![0.0; 2 * nodes];
        let n = || vec![0.0; nodes];
        Self {
            z: m(),
            w: m(),
            y: vec![0.0; modes * linear.branches.len()],
            u: c(),
            base: [0.0; 2],
            base_velocity: [0.0; 2],
            w_end: m(),
            base_velocity_end: [0.0; 2],
            v: c(),
            force: c(),
            slip: n(),
            lift: n(),
            compression: n(),
            traction: Traction::new(nodes),
            rhs: m(),
            v_free: c(),
            residual: c(),
            jacobian: vec![0.0; 4 * nodes * nodes],
            rest_compression: n(),
            carried: c(),
            scratch: m(),
            product: c(),
            slopes: vec![[0.0; 4]; nodes],
        }
    }

    /// Velocity [m/s] with which the prescribed motion carries contact node `i`, road frame.
    pub fn carried(&self, i: usize) -> [f64; 2] {
        [self.carried[i], self.carried[self.slip.len() + i]]
    }

    /// Solves the stage; the result is in `w_end`, `base_velocity_end`, `v`, `force`.
    pub fn solve(
        &mut self,
        linear: &Linear,
        face: &Face,
        matrices: &StageMatrices,
        motion: &Kinematics,
        gap: &[f64],
        factor: &[f64],
    ) -> Convergence {
        let h = self.free_motion(linear, matrices, motion);
        self.place(linear, matrices.a, motion, gap);
        let convergence = self.iterate(linear, face, matrices, motion, factor);
        self.finish(linear, matrices, h);
        convergence
    }

    /// Velocities without contact: `rhs`, `v_free`; returns the free face's right-hand sides.
    fn free_motion(
        &mut self,
        linear: &Linear,
        matrices: &StageMatrices,
        motion: &Kinematics,
    ) -> [f64; 2] {
        let (modes, a) = (linear.modes(), matrices.a);
        let driven = linear.prescribed_acceleration(motion.acceleration);
        let acceleration = to_block(motion, driven);
        for m in 0..modes {
            self.rhs[m] = self.w[m]
                - matrices.a_omega2[m] * self.z[m]
                - a * linear.coupling_along(m, acceleration);
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let weight = a * branch.share / (1.0 + a / branch.time);
            let memory = &self.y[b * modes..(b + 1) * modes];
            for ((r, y), omega2) in self.rhs.iter_mut().zip(memory).zip(&linear.omega2) {
                *r += weight * omega2 * y;
            }
        }
        for ((x, r), s) in self.scratch.iter_mut().zip(&self.rhs).zip(&matrices.s) {
            *x = s * r;
        }
        self.v_free.fill(0.0);
        dense::add_columns(&mut self.v_free, &linear.by_mode, &self.scratch);
        let mut h = [0.0; 2];
        for (j, dof) in linear.base.iter().enumerate() {
            // The drive carries the mass of a deflection along.
            let external = match dof.axis {
                1 => -motion.load,
                _ => -(linear.block_mass + dof.mass) * driven[0],
            };
            let velocity = self.base_velocity[j];
            let stretch = self.base[j] + a * velocity;
            let coupling = &matrices.base_coupling[j * modes..(j + 1) * modes];
            let inertia: f64 = dense::dot(coupling, &self.scratch) - dense::dot(coupling, &self.w);
            h[j] = a * (external - dof.damping * velocity - dof.stiffness * stretch)
                - inertia;
        }
        self.add_face_velocity(linear, matrices, motion, h);
        h
    }

    /// Adds e·b* + q·N⁻¹h to `v_free`.
    fn add_face_velocity(
        &mut self,
        linear: &Linear,
        matrices: &StageMatrices,
        motion: &Kinematics,
        h: [f64; 2],
    ) {
        let nodes = linear.nodes();
        let y = times_2x2(&matrices.n_inverse, h);
        for (j, dof) in linear.base.iter().enumerate() {
            let mut road = [0.0; 2];
            road[dof.axis] = self.base_velocity[j];
            let velocity = to_block(motion, road);
            let q = &matrices.q[2 * j * nodes..2 * (j + 1) * nodes];
            for (c, (v, q)) in self.v_free.iter_mut().zip(q).enumerate() {
                *v += velocity[c / nodes] + q * y[j];
            }
        }
    }

    /// Where the nodes stand if their stage velocity were 0, and what velocity the prescribed
    /// motion carries them with.
    fn place(&mut self, linear: &Linear, a: f64, motion: &Kinematics, gap: &[f64]) {
        let nodes = linear.nodes();
        let [sin, cos] = motion.sin_cos;
        let mut height = motion.position[1];
        for (j, dof) in linear.base.iter().enumerate() {
            if dof.axis == 1 {
                height = self.base[j];
            }
        }
        let velocity = linear.prescribed(motion.velocity);
        for i in 0..nodes {
            let (x, z) = (linear.node_x[i] + self.u[i], linear.node_z + self.u[nodes + i]);
            self.rest_compression[i] = -(height + sin * x + cos * z) - gap[i];
            // The turning carries the node as it will stand at the end of the stage.
            let (x, z) = (x + a * self.v[i], z + a * self.v[nodes + i]);
            self.carried[i] = velocity[0] - motion.omega * (sin * x + cos * z);
            self.carried[nodes + i] = velocity[1] + motion.omega * (cos * x - sin * z);
        }
    }

    /// Newton's method on the contact velocities: S (v − v_free) = f(v).
    fn iterate(
        &mut self,
        linear: &Linear,
        face: &Face,
        matrices: &StageMatrices,
        motion: &Kinematics,
        factor: &[f64],
    ) -> Convergence {
        let size = 2 * linear.nodes();
        let tolerance = CHANGE_TOLERANCE * face.smoothing_speed;
        let mut change = f64::INFINITY;
        for iteration in 1..=MAX_ITERATIONS {
            self.evaluate(face, matrices.a, motion, factor);
            if iteration == 1 && self.traction.pressure.iter().all(|p| *p <= 0.0) {
                // Perhaps the road is out of reach altogether.
                self.v.copy_from_slice(&self.v_free);
                self.evaluate(face, matrices.a, motion, factor);
                if self.traction.pressure.iter().all(|p| *p <= 0.0) {
                    self.force.fill(0.0);
                    return Convergence { iterations: 1, change: 0.0, converged: true };
                }
            }
            self.newton_system(matrices, motion);
            if !dense::factor(&mut self.jacobian, size) {
                break;
            }
            dense::solve(&self.jacobian, &mut self.residual);
            change = self.take_step(motion, tolerance);
            if change < tolerance {
                return Convergence { iterations: iteration, change, converged: true };
            }
        }
        Convergence { iterations: MAX_ITERATIONS, change, converged: false }
    }

    /// Forces and slopes at the present velocities.
    fn evaluate(&mut self, face: &Face, a: f64, motion: &Kinematics, factor: &[f64]) {
        let nodes = self.slip.len();
        let [sin, cos] = motion.sin_cos;
        let (vx, vz) = self.v.split_at(nodes);
        for i in 0..nodes {
            let up = sin * vx[i] + cos * vz[i];
            self.slip[i] = cos * vx[i] - sin * vz[i] + self.carried[i];
            self.lift[i] = up + self.carried[nodes + i];
            self.compression[i] = self.rest_compression[i] - a * up;
        }
        face.evaluate(&self.compression, a, &self.slip, &self.lift, factor, &mut self.traction);
    }

    /// Jacobian S + G and residual f − S (v − v_free).
    fn newton_system(&mut self, matrices: &StageMatrices, motion: &Kinematics) {
        let nodes = self.slip.len();
        let size = 2 * nodes;
        let [sin, cos] = motion.sin_cos;
        for ((r, v), free) in self.residual.iter_mut().zip(&self.v).zip(&self.v_free) {
            *r = v - free;
        }
        for (out, row) in self.product.iter_mut().zip(matrices.inverse_delassus.chunks_exact(size))
        {
            *out = dense::dot(row, &self.residual);
        }
        self.jacobian.copy_from_slice(&matrices.inverse_delassus);
        let t = &self.traction;
        for i in 0..nodes {
            self.force[i] = cos * t.tangential[i] + sin * t.normal[i];
            self.force[nodes + i] = -sin * t.tangential[i] + cos * t.normal[i];
            let (tt, tn, nn) = (t.slip_slope[i], t.coupling[i], t.approach_slope[i]);
            // Rᵀ G R with G = [tt tn; 0 nn] in the road frame.
            let (gx, gz) = (tt * cos + tn * sin, -tt * sin + tn * cos);
            let slopes = [
                cos * gx + sin * nn * sin,
                cos * gz + sin * nn * cos,
                -sin * gx + cos * nn * sin,
                -sin * gz + cos * nn * cos,
            ];
            self.jacobian[i * size + i] += slopes[0];
            self.jacobian[i * size + nodes + i] += slopes[1];
            self.jacobian[(nodes + i) * size + i] += slopes[2];
            self.jacobian[(nodes + i) * size + nodes + i] += slopes[3];
            self.slopes[i] = slopes;
        }
        for ((r, f), product) in self.residual.iter_mut().zip(&self.force).zip(&self.product) {
            *r = f - product;
        }
    }

    /// Takes the Newton step that `residual` now holds; returns the largest change of a velocity.
    ///
    /// A tangential speed that would change its sign stops at zero: friction is concave on either
    /// side, so from there the iteration cannot overshoot again. The forces follow along the
    /// tangent, so that they and the velocities satisfy the linear equations to rounding.
    fn take_step(&mut self, motion: &Kinematics, tolerance: f64) -> f64 {
        let nodes = self.slip.len();
        let [sin, cos] = motion.sin_cos;
        let mut change: f64 = 0.0;
        for i in 0..nodes {
            let (mut dx, dz) = (self.residual[i], self.residual[nodes + i]);
            let slip = self.slip[i];
            let move_over_road = cos * dx - sin * dz;
            let crosses = slip * (slip + move_over_road) < 0.0;
            if crosses && self.slopes[i][0] > 0.0 && move_over_road.abs() > tolerance {
                dx = (sin * dz - slip) / cos;
            }
            change = change.max(dx.abs()).max(dz.abs());
            let [xx, xz, zx, zz] = self.slopes[i];
            self.force[i] -= xx * dx + xz * dz;
            self.force[nodes + i] -= zx * dx + zz * dz;
            self.v[i] += dx;
            self.v[nodes + i] += dz;
        }
        change
    }

    /// Modal velocities and the free face from the contact forces.
    fn finish(&mut self, linear: &Linear, matrices: &StageMatrices, mut h: [f64; 2]) {
        let (modes, nodes, a) = (linear.modes(), linear.nodes(), matrices.a);
        for (j, h) in h.iter_mut().enumerate().take(linear.base.len()) {
            *h += a * dense::dot(&matrices.q[2 * j * nodes..2 * (j + 1) * nodes], &self.force);
        }
        let y = times_2x2(&matrices.n_inverse, h);
        self.scratch.fill(0.0);
        dense::add_columns(&mut self.scratch, &linear.by_contact, &self.force);
        for m in 0..modes {
            let mut sum = self.rhs[m] + a * self.scratch[m];
            for j in 0..linear.base.len() {
                sum -= matrices.base_coupling[j * modes + m] * y[j];
            }
            self.w_end[m] = matrices.s[m] * sum;
        }
        for j in 0..linear.base.len() {
            self.base_velocity_end[j] = self.base_velocity[j] + y[j];
        }
    }
}

/// Change of the sliding speeds, as a share of the smoothing speed, at which Newton's method stops;
/// it converges quadratically, so the error left is about the square of it.
const CHANGE_TOLERANCE: f64 = 1e-3;

/// A road vector in the block's frame.
pub fn to_block(motion: &Kinematics, [x, z]: [f64; 2]) -> [f64; 2] {
    let [sin, cos] = motion.sin_cos;
    [cos * x + sin * z, -sin * x + cos * z]
}

fn times_2x2(matrix: &[f64; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    [matrix[0] * x + matrix[1] * y, matrix[2] * x + matrix[3] * y]
}
