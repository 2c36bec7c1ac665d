//! One implicit stage: given the explicit part of the stage, find velocities that satisfy inertia,
//! contact and friction at the end of it.

use super::dense;
use super::iteration::Convergence;
use super::kinematics::{to_block, Kinematics};
use super::linear::Linear;
use super::matrices::StageMatrices;
use super::newton::Newton;
use crate::contact::{Face, Placed, Traction};
use crate::pack::{Aligned, Pack};

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
    /// Compression, speed over the road and away from it at the last evaluation.
    pub placed: Placed,
    /// Forces and slopes at the last evaluation.
    pub traction: Traction,
    /// Newton directions and their buffers.
    pub(super) newton: Newton,
    pub(super) v_free: Aligned,
    rhs: Aligned,
    rest_compression: Aligned,
    carried: Aligned,
    scratch: Aligned,
    sums: Pack,
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
            placed: Placed::new(linear.nodes),
            traction: Traction::new(linear.nodes),
            newton: Newton::new(linear),
            v_free: c(),
            rhs: m(),
            rest_compression: n(),
            carried: c(),
            scratch: m(),
            sums: Pack::default(),
        }
    }

    /// Velocity \[m/s\] with which the prescribed motion carries contact node `i`, road frame.
    pub fn carried(&self, i: usize) -> [f64; 2] {
        [self.carried[i], self.carried[self.placed.slip.len() + i]]
    }

    /// Solves the stage with `n` packs of nodes; the result is in `w_end`, `base_velocity_end`, `v`, `force`.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub fn solve(
        &mut self,
        n: usize,
        linear: &Linear,
        face: &Face,
        matrices: &StageMatrices,
        motion: &Kinematics,
        gap: &Aligned,
        factor: &Aligned,
    ) -> Convergence {
        let h = self.free_motion(n, linear, matrices, motion);
        self.place(n, linear, matrices.a, motion, gap);
        let convergence = self.iterate(n, face, matrices, motion, factor);
        self.finish(n, linear, matrices, h);
        convergence
    }

    /// Velocities without contact: `rhs`, `v_free`; returns the free face's right-hand sides.
    #[inline(always)]
    fn free_motion(
        &mut self,
        n: usize,
        linear: &Linear,
        matrices: &StageMatrices,
        motion: &Kinematics,
    ) -> [f64; 2] {
        let a = matrices.a;
        let driven = linear.prescribed_acceleration(motion.acceleration);
        self.modal_balance(linear, matrices, to_block(motion, driven));
        let v_free = &mut self.v_free.packs_mut()[..2 * n];
        dense::multiply(v_free, linear.by_mode.packs(), self.scratch.packs());
        let modes = self.scratch.packs().len();
        let mut h = [0.0; 2];
        // What the modes gain, in place of s·rhs, which is not needed any more.
        let gained = &mut self.scratch.packs_mut()[..modes];
        let w = &self.w.packs()[..modes];
        for m in 0..modes {
            gained[m] = gained[m] - w[m];
        }
        for (j, dof) in linear.base.iter().enumerate() {
            // The drive carries the mass of a deflection along.
            let external = match dof.axis {
                1 => -motion.load,
                _ => -(linear.block_mass + dof.mass) * driven[0],
            };
            let velocity = self.base_velocity[j];
            let stretch = self.base[j] + a * velocity;
            let coupling = &matrices.base_coupling.packs()[j * modes..(j + 1) * modes];
            let inertia = dense::dot(coupling, self.scratch.packs(), &mut self.sums);
            h[j] = a * (external - dof.damping * velocity - dof.stiffness * stretch) - inertia;
        }
        self.add_face_velocity(n, linear, matrices, motion, h);
        h
    }

    /// `rhs` and `scratch` = s·`rhs`, the modal velocities without contact; `acceleration` of the clamped
    /// face in the block's frame.
    #[inline(always)]
    fn modal_balance(&mut self, linear: &Linear, matrices: &StageMatrices, acceleration: [f64; 2]) {
        let a = matrices.a;
        let modes = self.rhs.packs().len();
        let [ax, az] = acceleration.map(|along| Pack::splat(-a * along));
        let (gx, gz) = (&linear.coupling[0].packs()[..modes], &linear.coupling[1].packs()[..modes]);
        let (w, z) = (&self.w.packs()[..modes], &self.z.packs()[..modes]);
        let (a_omega2, s) = (&matrices.a_omega2.packs()[..modes], &matrices.s.packs()[..modes]);
        let rhs = &mut self.rhs.packs_mut()[..modes];
        let free = &mut self.scratch.packs_mut()[..modes];
        for m in 0..modes {
            rhs[m] = gz[m].mul_add(az, gx[m].mul_add(ax, (-a_omega2[m]).mul_add(z[m], w[m])));
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let weight = Pack::splat(a * branch.share / (1.0 + a / branch.time));
            let memory = &self.y.packs()[b * modes..(b + 1) * modes];
            let omega2 = &linear.omega2.packs()[..modes];
            for m in 0..modes {
                rhs[m] += weight * omega2[m] * memory[m];
            }
        }
        for m in 0..modes {
            free[m] = s[m] * rhs[m];
        }
    }

    /// Adds e·b* + q·N⁻¹h to `v_free`.
    #[inline(always)]
    fn add_face_velocity(
        &mut self,
        n: usize,
        linear: &Linear,
        matrices: &StageMatrices,
        motion: &Kinematics,
        h: [f64; 2],
    ) {
        let y = times_2x2(&matrices.n_inverse, h);
        let (vx, vz) = self.v_free.packs_mut()[..2 * n].split_at_mut(n);
        for (j, dof) in linear.base.iter().enumerate() {
            let mut road = [0.0; 2];
            road[dof.axis] = self.base_velocity[j];
            let [x, z] = to_block(motion, road).map(Pack::splat);
            let (qx, qz) = matrices.q.packs()[2 * j * n..2 * (j + 1) * n].split_at(n);
            let y = Pack::splat(y[j]);
            for k in 0..n {
                vx[k] += qx[k].mul_add(y, x);
                vz[k] += qz[k].mul_add(y, z);
            }
        }
    }

    /// Where the nodes stand if their stage velocity were 0, and what velocity the prescribed
    /// motion carries them with.
    #[inline(always)]
    fn place(&mut self, n: usize, linear: &Linear, a: f64, motion: &Kinematics, gap: &Aligned) {
        let splat = Pack::splat;
        let [sin, cos] = motion.sin_cos.map(splat);
        let mut height = motion.position[1];
        for (j, dof) in linear.base.iter().enumerate() {
            if dof.axis == 1 {
                height = self.base[j];
            }
        }
        let (height, a, omega) = (splat(height), splat(a), splat(motion.omega));
        let velocity = linear.prescribed(motion.velocity).map(splat);
        let (node_x, node_z) = (&linear.node_x.packs()[..n], splat(linear.node_z));
        let gap = &gap.packs()[..n];
        let (ux, uz) = self.u.packs()[..2 * n].split_at(n);
        let (vx, vz) = self.v.packs()[..2 * n].split_at(n);
        let (carried_x, carried_z) = self.carried.packs_mut()[..2 * n].split_at_mut(n);
        let rest = &mut self.rest_compression.packs_mut()[..n];
        for k in 0..n {
            let (x, z) = (node_x[k] + ux[k], node_z + uz[k]);
            rest[k] = -(height + sin.mul_add(x, cos * z)) - gap[k];
            // The turning carries the node as it will stand at the end of the stage.
            let (x, z) = (a.mul_add(vx[k], x), a.mul_add(vz[k], z));
            carried_x[k] = velocity[0] - omega * sin.mul_add(x, cos * z);
            carried_z[k] = velocity[1] + omega * cos.mul_add(x, -(sin * z));
        }
    }

    /// Forces and slopes at the present velocities; returns the highest pressure \[Pa\].
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        n: usize,
        face: &Face,
        a: f64,
        motion: &Kinematics,
        factor: &Aligned,
    ) -> f64 {
        let [sin, cos] = motion.sin_cos.map(Pack::splat);
        let minus_a = Pack::splat(-a);
        let (vx, vz) = self.v.packs()[..2 * n].split_at(n);
        let (carried_x, carried_z) = self.carried.packs()[..2 * n].split_at(n);
        let rest = &self.rest_compression.packs()[..n];
        let slip = &mut self.placed.slip.packs_mut()[..n];
        let lift = &mut self.placed.lift.packs_mut()[..n];
        let compression = &mut self.placed.compression.packs_mut()[..n];
        for k in 0..n {
            let up = sin.mul_add(vx[k], cos * vz[k]);
            slip[k] = cos.mul_add(vx[k], -(sin * vz[k])) + carried_x[k];
            lift[k] = up + carried_z[k];
            compression[k] = minus_a.mul_add(up, rest[k]);
        }
        face.evaluate(a, &self.placed, factor, &mut self.traction)
    }

    /// Modal velocities and the free face from the contact forces.
    #[inline(always)]
    fn finish(&mut self, n: usize, linear: &Linear, matrices: &StageMatrices, mut h: [f64; 2]) {
        let modes = self.rhs.packs().len();
        let force = &self.force.packs()[..2 * n];
        for (j, h) in h.iter_mut().enumerate().take(linear.base.len()) {
            *h += matrices.a
                * dense::dot(
                    &matrices.q.packs()[2 * j * n..2 * (j + 1) * n],
                    force,
                    &mut self.sums,
                );
        }
        let y = times_2x2(&matrices.n_inverse, h);
        let pushed = &mut self.scratch.packs_mut()[..modes];
        dense::multiply(pushed, linear.by_contact.packs(), force);
        let (rhs, s) = (&self.rhs.packs()[..modes], &matrices.s.packs()[..modes]);
        let w_end = &mut self.w_end.packs_mut()[..modes];
        let a = Pack::splat(matrices.a);
        for m in 0..modes {
            w_end[m] = a.mul_add(pushed[m], rhs[m]);
        }
        for j in 0..linear.base.len() {
            let coupling = &matrices.base_coupling.packs()[j * modes..(j + 1) * modes];
            let y = Pack::splat(-y[j]);
            for m in 0..modes {
                w_end[m] = coupling[m].mul_add(y, w_end[m]);
            }
        }
        for m in 0..modes {
            w_end[m] = w_end[m] * s[m];
        }
        for j in 0..linear.base.len() {
            self.base_velocity_end[j] = self.base_velocity[j] + y[j];
        }
    }
}

fn times_2x2(matrix: &[f64; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    [matrix[0] * x + matrix[1] * y, matrix[2] * x + matrix[3] * y]
}
