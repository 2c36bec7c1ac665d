//! One implicit stage: given the explicit part of the stage, find velocities that satisfy inertia,
//! contact and friction at the end of it.

use super::dense;
use super::kinematics::{to_block, Kinematics};
use super::linear::Linear;
use super::matrices::StageMatrices;
use super::newton::Newton;
use crate::contact::{Face, Traction};
use crate::pack::Aligned;

/// How the Newton iteration of a stage went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Iterations done.
    pub iterations: usize,
    /// Last change of a velocity \[m/s\].
    pub change: f64,
    /// Did it converge?
    pub converged: bool,
}

/// Iterations after which a stage is given up and the step made smaller.
const MAX_ITERATIONS: usize = 150;
/// Iterations after which the full Newton matrix is used.
const FLAT_ITERATIONS: usize = 12;

/// Explicit parts (starred in the theory, eq. 3.3), unknowns and buffers of a stage.
#[derive(Clone, Debug)]
pub struct Stage {
    /// z* per mode.
    pub z: Aligned,
    /// w* per mode.
    pub w: Aligned,
    /// y* per branch and mode.
    pub y: Aligned,
    /// Contact displacements Φ z* \[m\], block frame.
    pub u: Aligned,
    /// Free coordinates of the clamped face, starred \[m\].
    pub base: [f64; 2],
    /// Their velocities, starred \[m/s\].
    pub base_velocity: [f64; 2],
    /// Solution: modal velocities.
    pub w_end: Aligned,
    /// Solution: velocities of the free face \[m/s\].
    pub base_velocity_end: [f64; 2],
    /// Solution (and first guess): contact velocities \[m/s\], block frame, with the free face's.
    pub v: Aligned,
    /// Solution: contact forces \[N\], block frame.
    pub force: Aligned,
    /// Speed over the road and away from it \[m/s\] at the last evaluation.
    pub slip: Aligned,
    /// Speed away from the road \[m/s\] at the last evaluation.
    pub lift: Aligned,
    /// Compression \[m\] at the last evaluation.
    pub compression: Aligned,
    /// Forces and slopes at the last evaluation.
    pub traction: Traction,
    /// Newton directions and their buffers.
    pub(super) newton: Newton,
    pub(super) v_free: Aligned,
    rhs: Aligned,
    rest_compression: Aligned,
    carried: Aligned,
    scratch: Aligned,
}

impl Stage {
    /// Room for a stage of `linear`.
    pub fn new(linear: &Linear) -> Self {
        let (modes, stride) = (linear.modes(), linear.stride);
        let m = || Aligned::zeros(modes);
        let c = || Aligned::zeros(2 * stride);
        let n = || Aligned::zeros(stride);
        Self {
            z: m(),
            w: m(),
            y: Aligned::zeros(modes * linear.branches.len()),
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
            traction: Traction::new(linear.nodes),
            newton: Newton::new(linear),
            v_free: c(),
            rhs: m(),
            rest_compression: n(),
            carried: c(),
            scratch: m(),
        }
    }

    /// Velocity \[m/s\] with which the prescribed motion carries contact node `i`, road frame.
    pub fn carried(&self, i: usize) -> [f64; 2] {
        [self.carried[i], self.carried[self.slip.len() + i]]
    }

    /// Solves the stage; the result is in `w_end`, `base_velocity_end`, `v`, `force`.
    #[inline(always)]
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
        let convergence = self.iterate(face, matrices, motion, factor);
        self.finish(linear, matrices, h);
        convergence
    }

    /// Velocities without contact: `rhs`, `v_free`; returns the free face's right-hand sides.
    #[inline(always)]
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
            h[j] = a * (external - dof.damping * velocity - dof.stiffness * stretch) - inertia;
        }
        self.add_face_velocity(linear, matrices, motion, h);
        h
    }

    /// Adds e·b* + q·N⁻¹h to `v_free`.
    #[inline(always)]
    fn add_face_velocity(
        &mut self,
        linear: &Linear,
        matrices: &StageMatrices,
        motion: &Kinematics,
        h: [f64; 2],
    ) {
        let stride = linear.stride;
        let y = times_2x2(&matrices.n_inverse, h);
        for (j, dof) in linear.base.iter().enumerate() {
            let mut road = [0.0; 2];
            road[dof.axis] = self.base_velocity[j];
            let velocity = to_block(motion, road);
            let q = &matrices.q[2 * j * stride..2 * (j + 1) * stride];
            for (half, velocity) in velocity.iter().enumerate() {
                let range = half * stride..(half + 1) * stride;
                for (v, q) in self.v_free[range.clone()].iter_mut().zip(&q[range]) {
                    *v += velocity + q * y[j];
                }
            }
        }
    }

    /// Where the nodes stand if their stage velocity were 0, and what velocity the prescribed
    /// motion carries them with.
    #[inline(always)]
    fn place(&mut self, linear: &Linear, a: f64, motion: &Kinematics, gap: &[f64]) {
        let stride = linear.stride;
        let [sin, cos] = motion.sin_cos;
        let mut height = motion.position[1];
        for (j, dof) in linear.base.iter().enumerate() {
            if dof.axis == 1 {
                height = self.base[j];
            }
        }
        let velocity = linear.prescribed(motion.velocity);
        let (ux, uz) = self.u.split_at(stride);
        let (vx, vz) = self.v.split_at(stride);
        let (carried_x, carried_z) = self.carried.split_at_mut(stride);
        for i in 0..stride {
            let (x, z) = (linear.node_x[i] + ux[i], linear.node_z + uz[i]);
            self.rest_compression[i] = -(height + sin * x + cos * z) - gap[i];
            // The turning carries the node as it will stand at the end of the stage.
            let (x, z) = (x + a * vx[i], z + a * vz[i]);
            carried_x[i] = velocity[0] - motion.omega * (sin * x + cos * z);
            carried_z[i] = velocity[1] + motion.omega * (cos * x - sin * z);
        }
    }

    /// Newton's method on the contact velocities: S (v − v_free) = f(v).
    #[inline(always)]
    fn iterate(
        &mut self,
        face: &Face,
        matrices: &StageMatrices,
        motion: &Kinematics,
        factor: &[f64],
    ) -> Convergence {
        let tolerance = CHANGE_TOLERANCE * face.smoothing_speed;
        let flat = motion.sin_cos[0] == 0.0;
        let mut convergence = Convergence { iterations: 0, change: 0.0, converged: true };
        let mut guess_left = true;
        let mut changes = [f64::INFINITY; 2];
        loop {
            let highest = self.evaluate(face, matrices.a, motion, factor);
            if highest <= 0.0 && convergence.iterations == 0 {
                if !guess_left {
                    // The road is out of reach altogether.
                    self.force.fill(0.0);
                    return convergence;
                }
                guess_left = false;
                self.v.copy_from_slice(&self.v_free);
                continue;
            }
            convergence.iterations += 1;
            // The elimination of the normal velocities converges fast where the contact is as
            // stiff as it assumes; where it does not, the full matrix serves.
            let iteration = convergence.iterations;
            let solved = if flat && iteration <= FLAT_ITERATIONS {
                self.flat_direction(&matrices.flat, iteration, changes)
            } else {
                self.full_direction(matrices, motion, iteration)
            };
            if !solved {
                convergence.converged = false;
                return convergence;
            }
            convergence.change = self.take_direction(motion, tolerance);
            changes = [changes[1], convergence.change];
            if convergence.change < tolerance {
                return convergence;
            }
            if iteration == MAX_ITERATIONS {
                convergence.converged = false;
                return convergence;
            }
        }
    }

    /// Forces and slopes at the present velocities; returns the highest pressure \[Pa\].
    #[inline(always)]
    fn evaluate(&mut self, face: &Face, a: f64, motion: &Kinematics, factor: &[f64]) -> f64 {
        let stride = self.slip.len();
        let [sin, cos] = motion.sin_cos;
        let (vx, vz) = self.v.split_at(stride);
        let (carried_x, carried_z) = self.carried.split_at(stride);
        for i in 0..stride {
            let up = sin * vx[i] + cos * vz[i];
            self.slip[i] = cos * vx[i] - sin * vz[i] + carried_x[i];
            self.lift[i] = up + carried_z[i];
            self.compression[i] = self.rest_compression[i] - a * up;
        }
        face.evaluate(&self.compression, a, &self.slip, &self.lift, factor, &mut self.traction)
    }

    /// Modal velocities and the free face from the contact forces.
    #[inline(always)]
    fn finish(&mut self, linear: &Linear, matrices: &StageMatrices, mut h: [f64; 2]) {
        let (modes, stride, a) = (linear.modes(), linear.stride, matrices.a);
        for (j, h) in h.iter_mut().enumerate().take(linear.base.len()) {
            *h += a * dense::dot(&matrices.q[2 * j * stride..2 * (j + 1) * stride], &self.force);
        }
        let y = times_2x2(&matrices.n_inverse, h);
        self.scratch.fill(0.0);
        dense::add_columns(&mut self.scratch, &linear.by_contact, &self.force);
        for m in 0..modes {
            self.w_end[m] = self.rhs[m] + a * self.scratch[m];
        }
        for j in 0..linear.base.len() {
            let coupling = &matrices.base_coupling[j * modes..(j + 1) * modes];
            for (w, c) in self.w_end.iter_mut().zip(coupling) {
                *w -= c * y[j];
            }
        }
        for (w, s) in self.w_end.iter_mut().zip(&matrices.s) {
            *w *= s;
        }
        for j in 0..linear.base.len() {
            self.base_velocity_end[j] = self.base_velocity[j] + y[j];
        }
    }
}

/// Change of the sliding speeds, as a share of the smoothing speed, at which Newton's method stops. With 1e-2 a sixth
/// of the iterations would be saved and the reference case moves by 0.002 % only, but the amplitude of a slow
/// slide (`slide-2` of the independent solutions) by 1.2 %.
const CHANGE_TOLERANCE: f64 = 1e-3;

fn times_2x2(matrix: &[f64; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    [matrix[0] * x + matrix[1] * y, matrix[2] * x + matrix[3] * y]
}
