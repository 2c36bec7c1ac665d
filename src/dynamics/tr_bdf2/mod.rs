//! One step of TR-BDF2: second order, stiffly accurate, damps what it cannot resolve.
//!
//! Bank et al., IEEE Trans. CAD 4 (1985); coefficients and error estimate as in Hosea and Shampine,
//! Appl. Numer. Math. 20 (1996). Both implicit stages share one coefficient, hence one matrix.

mod compiled;
mod parts;

pub use compiled::contact_motion;
use compiled::{both_stages, go_on};

use super::energy::Power;
use super::iteration::Convergence;
use super::kinematics::{inertia, kinematics, Kinematics};
use super::linear::Linear;
use super::matrices::StageMatrices;
use super::stage::Stage;
use super::state::State;
use crate::contact::Face;
use crate::drive::Segment;
use crate::error::Fault;
use crate::pack::{Aligned, Pack, LANES};
use std::f64::consts::SQRT_2;

/// γ: the first stage ends at γh.
const GAMMA: f64 = 2.0 - SQRT_2;
/// Coefficient of the implicit part of both stages.
pub const D: f64 = GAMMA / 2.0;
/// Weight of the first two stages in the end value.
pub const W: f64 = SQRT_2 / 4.0;
/// Weights of the third-order error estimate.
const ERROR: [f64; 3] = [(4.0 * W - 1.0) / 3.0, -1.0 / 3.0, 2.0 * D / 3.0];

/// Buffers of a step; the result waits in `trial` until it is accepted.
#[derive(Clone, Debug)]
pub struct TrBdf2 {
    /// The stage, after a step the one at its end.
    pub stage: Stage,
    /// Newton iterations done so far.
    pub iterations: u64,
    /// Powers at the start, at γh and at the end of the step, if `keep_power`.
    pub(super) powers: [Power; 3],
    /// Are the powers wanted?
    pub keep_power: bool,
    middle: Middle,
    /// Contact displacements and velocities relative to the clamped face, block frame.
    u: Aligned,
    v: Aligned,
    /// Contact accelerations relative to the clamped face, for the first guess of a step.
    dv: Aligned,
    gap: Aligned,
    trial: State,
    inertia: [[f64; 2]; 3],
    /// Free face velocity at the end of the step, block frame.
    face_velocity: [f64; 2],
    /// Size of the local error and root of twice the kinetic energy at the end \[kg^1/2 m/s\].
    pub error: f64,
    /// See `error`.
    pub speed: f64,
    /// Partial sums of both, squared.
    sums: [Pack; 2],
    a: f64,
    /// Coefficient, stiffness factor and angle of the matrices used last.
    matrices_of: [f64; 3],
}

/// Results of the first stage.
#[derive(Clone, Debug)]
struct Middle {
    w: Aligned,
    dw: Aligned,
    dy: Aligned,
    v: Aligned,
    base_velocity: [f64; 2],
    base_acceleration: [f64; 2],
}

impl TrBdf2 {
    /// Room for steps of `linear`.
    pub fn new(linear: &Linear) -> Self {
        let (modes, contact) = (linear.modes(), 2 * linear.stride);
        Self {
            stage: Stage::new(linear),
            iterations: 0,
            powers: [Power::default(); 3],
            keep_power: false,
            middle: Middle {
                w: Aligned::zeros(modes),
                dw: Aligned::zeros(modes),
                dy: Aligned::zeros(modes * linear.branches.len()),
                v: Aligned::zeros(contact),
                base_velocity: [0.0; 2],
                base_acceleration: [0.0; 2],
            },
            u: Aligned::zeros(contact),
            v: Aligned::zeros(contact),
            dv: Aligned::zeros(contact),
            gap: Aligned::zeros(linear.stride),
            trial: State::new(linear),
            inertia: [[0.0; 2]; 3],
            face_velocity: [0.0; 2],
            error: 0.0,
            speed: 0.0,
            sums: [Pack::default(); 2],
            a: 0.0,
            matrices_of: [0.0; 3],
        }
    }

    /// Contact displacements from the modal state, lest rounding adds up over millions of steps; velocities as
    /// well where the state is `fresh` from outside.
    pub fn start_from(&mut self, linear: &Linear, state: &State, fresh: bool) {
        contact_motion(linear, &state.z, &mut self.u);
        if !fresh {
            return;
        }
        contact_motion(linear, &state.w, &mut self.v);
        contact_motion(linear, &state.dw, &mut self.dv);
        self.stage.newton.forget();
    }

    /// Displacements \[m\] and velocities \[m/s\] of the contact nodes relative to the clamped face, block frame.
    pub fn contact_motion(&self) -> [&Aligned; 2] {
        [&self.u, &self.v]
    }

    /// What a step carries to the next one besides the state, as numbers: with them a restored block goes on
    /// with the same bits.
    pub fn save(&self, out: &mut Vec<f64>) {
        for part in [&self.u, &self.v, &self.dv] {
            out.extend_from_slice(part);
        }
        out.extend(self.matrices_of);
        self.stage.newton.save(out);
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None` if there is too little.
    pub fn restore<'a>(&mut self, mut from: &'a [f64]) -> Option<&'a [f64]> {
        for part in [&mut self.u, &mut self.v, &mut self.dv] {
            let (own, rest) = from.split_at_checked(part.len())?;
            part.copy_from_slice(own);
            from = rest;
        }
        let (of, rest) = from.split_first_chunk()?;
        self.matrices_of = *of;
        self.stage.newton.restore(rest)
    }

    /// Steps from `from` \[s\] after the start of the segment by `h` \[s\].
    ///
    /// # Errors
    /// [`Fault::NoConvergence`] if a stage does not converge.
    #[allow(clippy::too_many_arguments)]
    pub fn take(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &State,
        matrices: &StageMatrices,
        segment: &Segment,
        from: f64,
        h: f64,
    ) -> Result<(), Fault> {
        if self.matrices_of != [matrices.a, matrices.stiffness_factor, matrices.angle] {
            self.matrices_of = [matrices.a, matrices.stiffness_factor, matrices.angle];
            self.stage.newton.forget();
        }
        self.a = matrices.a;
        let at = |s| kinematics(segment, s);
        let ends = [at(from), at(from + GAMMA * h), at(from + h)];
        let [start, middle, end] = &ends;
        self.inertia = [inertia(linear, start), inertia(linear, middle), inertia(linear, end)];
        // Compiled for the usual numbers of packs: loops over them are then none.
        match linear.stride / LANES {
            1 => both_stages::<1>(self, linear, face, state, matrices, &ends, h),
            2 => both_stages::<2>(self, linear, face, state, matrices, &ends, h),
            3 => both_stages::<3>(self, linear, face, state, matrices, &ends, h),
            _ => both_stages::<0>(self, linear, face, state, matrices, &ends, h),
        }
    }

    /// Takes the height of the road off the gaps, where the nodes will stand at the end of the step.
    fn raise_road(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &State,
        end: &Kinematics,
        h: f64,
    ) {
        let Some(road) = &face.road else { return };
        let stride = linear.stride;
        let [sin, cos] = end.sin_cos;
        let middle = end.position[0] + linear.deflection(&state.base);
        for (i, gap) in self.gap.iter_mut().enumerate() {
            let x = linear.node_x[i] + self.u[i] + h * self.v[i];
            let z = linear.node_z + self.u[stride + i];
            *gap -= road.height(middle + cos * x - sin * z);
        }
    }

    /// Makes the trial the state.
    pub fn accept(&mut self, state: &mut State) {
        let trial = &mut self.trial;
        std::mem::swap(&mut state.z, &mut trial.z);
        std::mem::swap(&mut state.w, &mut trial.w);
        std::mem::swap(&mut state.dw, &mut trial.dw);
        std::mem::swap(&mut state.y, &mut trial.y);
        state.base = trial.base;
        state.base_velocity = trial.base_velocity;
        state.base_acceleration = trial.base_acceleration;
        go_on(self);
    }

    /// Contact motion at the end of the step becomes that at the start of the next one.
    #[inline(always)]
    fn go_on(&mut self) {
        let n = self.gap.packs().len();
        let splat = Pack::splat;
        let a = splat(self.a);
        // Slope at the end of the parabola through the three velocities of the step.
        let (first, second) = (splat(0.5 / self.a), splat(0.5 * GAMMA / (self.a * (1.0 - GAMMA))));
        let face_velocity = self.face_velocity.map(splat);
        let (u, v) = (&mut self.u.packs_mut()[..2 * n], &mut self.v.packs_mut()[..2 * n]);
        let dv = &mut self.dv.packs_mut()[..2 * n];
        let (u_star, v_end) = (&self.stage.u.packs()[..2 * n], &self.stage.v.packs()[..2 * n]);
        let middle = &self.middle.v.packs()[..2 * n];
        for axis in 0..2 {
            for k in axis * n..(axis + 1) * n {
                let end = v_end[k] - face_velocity[axis];
                let rates = [(middle[k] - v[k]) * first, (end - middle[k]) * second];
                dv[k] = splat(1.0 - GAMMA).mul_add(rates[1] - rates[0], rates[1]);
                v[k] = end;
                u[k] = a.mul_add(end, u_star[k]);
            }
        }
    }

    fn count(&mut self, solved: Convergence, time: f64, a: f64) -> Result<(), Fault> {
        self.iterations += solved.iterations as u64;
        if solved.converged {
            return Ok(());
        }
        Err(Fault::NoConvergence {
            time,
            step: a / D,
            residual: solved.change,
            iterations: solved.iterations,
        })
    }
}
