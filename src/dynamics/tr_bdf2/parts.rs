//! The explicit parts of the two stages, what stands at their ends, and the error of the step.

use super::{TrBdf2, ERROR, GAMMA, W};
use crate::dynamics::energy;
use crate::dynamics::kinematics::{free_face_velocity, Kinematics};
use crate::dynamics::linear::Linear;
use crate::dynamics::matrices::StageMatrices;
use crate::dynamics::state::State;
use crate::pack::Pack;

impl TrBdf2 {
    /// Explicit part of the trapezoidal rule from t to t + γh.
    #[inline(always)]
    pub(super) fn begin_first_stage(
        &mut self,
        n: usize,
        linear: &Linear,
        state: &State,
        matrices: &StageMatrices,
        ends: &[Kinematics; 3],
    ) {
        let (modes, a) = (linear.omega2.packs().len(), matrices.a);
        let stage = &mut self.stage;
        let by = Pack::splat(a);
        let [ix, iz] = self.inertia[0].map(Pack::splat);
        let (gx, gz) = (&linear.coupling[0].packs()[..modes], &linear.coupling[1].packs()[..modes]);
        let (z, w) = (&state.z.packs()[..modes], &state.w.packs()[..modes]);
        let dw = &state.dw.packs()[..modes];
        let z_star = &mut stage.z.packs_mut()[..modes];
        let w_star = &mut stage.w.packs_mut()[..modes];
        for m in 0..modes {
            z_star[m] = by.mul_add(w[m], z[m]);
            let rate = dw[m] - gx[m].mul_add(ix, gz[m] * iz);
            w_star[m] = by.mul_add(rate, w[m]);
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let ratio = Pack::splat(a / branch.time);
            let y = &state.y.packs()[b * modes..(b + 1) * modes];
            let y_star = &mut stage.y.packs_mut()[b * modes..(b + 1) * modes];
            for m in 0..modes {
                y_star[m] = ratio.mul_add(z[m] - y[m], y[m]);
            }
        }
        for j in 0..linear.base.len() {
            stage.base[j] = state.base[j] + a * state.base_velocity[j];
            stage.base_velocity[j] = state.base_velocity[j] + a * state.base_acceleration[j];
        }
        // First guess: as if the acceleration stayed.
        let face_velocity = free_face_velocity(linear, &ends[0], &state.base_velocity);
        let face_acceleration = free_face_velocity(linear, &ends[0], &state.base_acceleration);
        let (u, v) = (&self.u.packs()[..2 * n], &self.v.packs()[..2 * n]);
        let dv = &self.dv.packs()[..2 * n];
        let u_star = &mut stage.u.packs_mut()[..2 * n];
        let guess = &mut stage.v.packs_mut()[..2 * n];
        let twice = Pack::splat(2.0 * a);
        for axis in 0..2 {
            let carried = Pack::splat(face_velocity[axis] + 2.0 * a * face_acceleration[axis]);
            for k in axis * n..(axis + 1) * n {
                u_star[k] = by.mul_add(v[k], u[k]);
                guess[k] = twice.mul_add(dv[k], v[k] + carried);
            }
        }
    }

    /// Keeps what the second stage needs of the first.
    #[inline(always)]
    pub(super) fn end_first_stage(
        &mut self,
        n: usize,
        linear: &Linear,
        matrices: &StageMatrices,
        ends: &[Kinematics; 3],
    ) {
        let (modes, a) = (linear.omega2.packs().len(), matrices.a);
        let (stage, middle) = (&self.stage, &mut self.middle);
        let (by, per) = (Pack::splat(a), Pack::splat(1.0 / a));
        let (z_star, w_star) = (&stage.z.packs()[..modes], &stage.w.packs()[..modes]);
        let w_end = &stage.w_end.packs()[..modes];
        let (w, dw) = (&mut middle.w.packs_mut()[..modes], &mut middle.dw.packs_mut()[..modes]);
        for m in 0..modes {
            w[m] = w_end[m];
            dw[m] = (w_end[m] - w_star[m]) * per;
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let rate = Pack::splat(1.0 / (branch.time + a));
            let y_star = &stage.y.packs()[b * modes..(b + 1) * modes];
            let dy = &mut middle.dy.packs_mut()[b * modes..(b + 1) * modes];
            for m in 0..modes {
                // ẏ at the end of the implicit stage for y = y* + a ẏ.
                dy[m] = rate * (by.mul_add(w_end[m], z_star[m]) - y_star[m]);
            }
        }
        for j in 0..linear.base.len() {
            middle.base_velocity[j] = stage.base_velocity_end[j];
            middle.base_acceleration[j] = (stage.base_velocity_end[j] - stage.base_velocity[j]) / a;
        }
        let face_velocity = free_face_velocity(linear, &ends[1], &stage.base_velocity_end);
        let (own, v) = (&mut middle.v.packs_mut()[..2 * n], &stage.v.packs()[..2 * n]);
        for axis in 0..2 {
            let carried = Pack::splat(face_velocity[axis]);
            for k in axis * n..(axis + 1) * n {
                own[k] = v[k] - carried;
            }
        }
        if self.keep_power {
            self.powers[1] = energy::power(linear, stage, &ends[1]);
        }
    }

    /// Explicit part of the BDF2-like stage to t + h.
    #[inline(always)]
    pub(super) fn begin_second_stage(&mut self, n: usize, linear: &Linear, state: &State, h: f64) {
        let modes = linear.omega2.packs().len();
        let (stage, middle) = (&mut self.stage, &self.middle);
        let weight = Pack::splat(W * h);
        let [ix, iz] = self.inertia[0].map(Pack::splat);
        let (gx, gz) = (&linear.coupling[0].packs()[..modes], &linear.coupling[1].packs()[..modes]);
        let (z, w) = (&state.z.packs()[..modes], &state.w.packs()[..modes]);
        let dw = &state.dw.packs()[..modes];
        let (w_mid, dw_mid) = (&middle.w.packs()[..modes], &middle.dw.packs()[..modes]);
        let z_star = &mut stage.z.packs_mut()[..modes];
        let w_star = &mut stage.w.packs_mut()[..modes];
        for m in 0..modes {
            let rate = dw[m] - gx[m].mul_add(ix, gz[m] * iz);
            z_star[m] = weight.mul_add(w[m] + w_mid[m], z[m]);
            w_star[m] = weight.mul_add(rate + dw_mid[m], w[m]);
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let per_time = Pack::splat(1.0 / branch.time);
            let y = &state.y.packs()[b * modes..(b + 1) * modes];
            let dy_mid = &middle.dy.packs()[b * modes..(b + 1) * modes];
            let y_star = &mut stage.y.packs_mut()[b * modes..(b + 1) * modes];
            for m in 0..modes {
                y_star[m] = weight.mul_add(per_time.mul_add(z[m] - y[m], dy_mid[m]), y[m]);
            }
        }
        for j in 0..linear.base.len() {
            let by = W * h;
            stage.base[j] = state.base[j] + by * (state.base_velocity[j] + middle.base_velocity[j]);
            stage.base_velocity[j] = state.base_velocity[j]
                + by * (state.base_acceleration[j] + middle.base_acceleration[j]);
        }
        // First guess: the parabola through start and middle with the slope at the start goes on.
        let (u, v) = (&self.u.packs()[..2 * n], &self.v.packs()[..2 * n]);
        let v_mid = &middle.v.packs()[..2 * n];
        let u_star = &mut stage.u.packs_mut()[..2 * n];
        let guess = &mut stage.v.packs_mut()[..2 * n];
        let dv = &self.dv.packs()[..2 * n];
        let on = Pack::splat((1.0 - GAMMA) / GAMMA);
        let (bent, middle) =
            (Pack::splat((1.0 - GAMMA) / (GAMMA * GAMMA)), Pack::splat(-GAMMA * h));
        for k in 0..2 * n {
            u_star[k] = weight.mul_add(v[k] + v_mid[k], u[k]);
            let change = v_mid[k] - v[k];
            let line = on.mul_add(change, guess[k]);
            guess[k] = bent.mul_add(middle.mul_add(dv[k], change), line);
        }
    }

    /// The state at the end of the step.
    #[inline(always)]
    pub(super) fn write_trial(&mut self, linear: &Linear, end: &Kinematics) {
        let (modes, a) = (linear.omega2.packs().len(), self.a);
        let (stage, trial) = (&self.stage, &mut self.trial);
        let (by, per) = (Pack::splat(a), Pack::splat(1.0 / a));
        let [ix, iz] = self.inertia[2].map(Pack::splat);
        let (gx, gz) = (&linear.coupling[0].packs()[..modes], &linear.coupling[1].packs()[..modes]);
        let (z_star, w_star) = (&stage.z.packs()[..modes], &stage.w.packs()[..modes]);
        let w_end = &stage.w_end.packs()[..modes];
        let (z, w) = (&mut trial.z.packs_mut()[..modes], &mut trial.w.packs_mut()[..modes]);
        let dw = &mut trial.dw.packs_mut()[..modes];
        for m in 0..modes {
            z[m] = by.mul_add(w_end[m], z_star[m]);
            w[m] = w_end[m];
            dw[m] = gx[m].mul_add(ix, gz[m].mul_add(iz, (w_end[m] - w_star[m]) * per));
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let ratio = a / branch.time;
            let (ratio, share) = (Pack::splat(ratio), Pack::splat(1.0 / (1.0 + ratio)));
            let y_star = &stage.y.packs()[b * modes..(b + 1) * modes];
            let y = &mut trial.y.packs_mut()[b * modes..(b + 1) * modes];
            for m in 0..modes {
                y[m] = ratio.mul_add(z[m], y_star[m]) * share;
            }
        }
        for j in 0..linear.base.len() {
            let velocity = stage.base_velocity_end[j];
            trial.base[j] = stage.base[j] + a * velocity;
            trial.base_velocity[j] = velocity;
            trial.base_acceleration[j] = (velocity - stage.base_velocity[j]) / a;
        }
        self.face_velocity = free_face_velocity(linear, end, &stage.base_velocity_end);
    }

    /// Size of the local error in the energy norm \[kg^1/2 m/s\], with what is stiff filtered out as
    /// the implicit stage would damp it; and the root of twice the kinetic energy at the end of the step.
    #[inline(always)]
    pub(super) fn judge(
        &mut self,
        linear: &Linear,
        state: &State,
        matrices: &StageMatrices,
        h: f64,
    ) {
        let modes = linear.omega2.packs().len();
        let a = Pack::splat(matrices.a);
        let weight = ERROR.map(|weight| Pack::splat(h * weight));
        // What the prescribed acceleration adds at the start and at the end.
        let [sx, sz] = self.inertia[0].map(|along| Pack::splat(-h * ERROR[0] * along));
        let [ex, ez] = self.inertia[2].map(|along| Pack::splat(-h * ERROR[2] * along));
        let (ix, iz) = (sx + ex, sz + ez);
        let (gx, gz) = (&linear.coupling[0].packs()[..modes], &linear.coupling[1].packs()[..modes]);
        let (w, dw) = (&state.w.packs()[..modes], &state.dw.packs()[..modes]);
        let (w_mid, dw_mid) = (&self.middle.w.packs()[..modes], &self.middle.dw.packs()[..modes]);
        let (w_end, dw_end) = (&self.trial.w.packs()[..modes], &self.trial.dw.packs()[..modes]);
        let (s, a_omega2) = (&matrices.s.packs()[..modes], &matrices.a_omega2.packs()[..modes]);
        let omega2 = &linear.omega2.packs()[..modes];
        let (mut error, mut speed) = (Pack::default(), Pack::default());
        for m in 0..modes {
            let of_z = weight[2].mul_add(w_end[m], weight[1].mul_add(w_mid[m], weight[0] * w[m]));
            let of_w =
                weight[2].mul_add(dw_end[m], weight[1].mul_add(dw_mid[m], weight[0] * dw[m]));
            let of_w = gx[m].mul_add(ix, gz[m].mul_add(iz, of_w));
            let of_w = s[m] * (-a_omega2[m]).mul_add(of_z, of_w);
            let of_z = a.mul_add(of_w, of_z);
            error = of_w.mul_add(of_w, (omega2[m] * of_z).mul_add(of_z, error));
            speed = w_end[m].mul_add(w_end[m], speed);
        }
        // By way of memory: what ends there becomes vector instructions.
        self.sums = [error, speed];
        (self.error, self.speed) = (error.sum().sqrt(), speed.sum().sqrt());
    }
}
