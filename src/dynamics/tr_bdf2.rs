//! One step of TR-BDF2: second order, stiffly accurate, damps what it cannot resolve.
//!
//! Bank et al., IEEE Trans. CAD 4 (1985); coefficients and error estimate as in Hosea and Shampine,
//! Appl. Numer. Math. 20 (1996). Both implicit stages share one coefficient, hence one matrix.

use super::dense;
use super::energy::{self, Power};
use super::kinematics::{free_face_velocity, inertia, kinematics, Kinematics};
use super::linear::Linear;
use super::matrices::StageMatrices;
use super::stage::{Convergence, Stage};
use super::state::State;
use crate::contact::Face;
use crate::drive::Segment;
use crate::error::Fault;
use crate::pack::Aligned;
use multiversion::multiversion;
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
            a: 0.0,
            matrices_of: [0.0; 3],
        }
    }

    /// Contact displacements and velocities from the modal state, so that a restored state goes on
    /// with the same bits.
    pub fn start_from(&mut self, linear: &Linear, state: &State) {
        contact_motion(linear, &state.z, &mut self.u);
        contact_motion(linear, &state.w, &mut self.v);
        contact_motion(linear, &state.dw, &mut self.dv);
        self.stage.newton.forget();
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
        let ends = [from, from + GAMMA * h, from + h].map(|s| kinematics(segment, s));
        self.inertia = [0, 1, 2].map(|k| inertia(linear, &ends[k]));
        both_stages(self, linear, face, state, matrices, &ends, h)
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
        let nodes = self.gap.len();
        let (first, second) = (2.0 * self.a, 2.0 * self.a * (1.0 - GAMMA) / GAMMA);
        for c in 0..2 * nodes {
            let v = self.stage.v[c] - self.face_velocity[c / nodes];
            // Slope at the end of the parabola through the three velocities of the step.
            let rates = [(self.middle.v[c] - self.v[c]) / first, (v - self.middle.v[c]) / second];
            self.dv[c] = rates[1] + (1.0 - GAMMA) * (rates[1] - rates[0]);
            self.v[c] = v;
            self.u[c] = self.stage.u[c] + self.a * self.v[c];
        }
    }

    /// Explicit part of the trapezoidal rule from t to t + γh.
    #[inline(always)]
    fn begin_first_stage(
        &mut self,
        linear: &Linear,
        state: &State,
        matrices: &StageMatrices,
        ends: &[Kinematics; 3],
    ) {
        let (modes, a) = (linear.modes(), matrices.a);
        let stage = &mut self.stage;
        let inertia = self.inertia[0];
        for m in 0..modes {
            stage.z[m] = state.z[m] + a * state.w[m];
            stage.w[m] = state.w[m] + a * (state.dw[m] - linear.coupling_along(m, inertia));
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            for m in 0..modes {
                let at = b * modes + m;
                stage.y[at] = state.y[at] + a * (state.z[m] - state.y[at]) / branch.time;
            }
        }
        for j in 0..linear.base.len() {
            stage.base[j] = state.base[j] + a * state.base_velocity[j];
            stage.base_velocity[j] = state.base_velocity[j] + a * state.base_acceleration[j];
        }
        let nodes = linear.stride;
        let face_velocity = free_face_velocity(linear, &ends[0], &state.base_velocity);
        let face_acceleration = free_face_velocity(linear, &ends[0], &state.base_acceleration);
        for c in 0..2 * nodes {
            stage.u[c] = self.u[c] + a * self.v[c];
            // First guess: as if the acceleration stayed.
            let acceleration = self.dv[c] + face_acceleration[c / nodes];
            stage.v[c] = self.v[c] + face_velocity[c / nodes] + 2.0 * a * acceleration;
        }
    }

    /// Keeps what the second stage needs of the first.
    #[inline(always)]
    fn end_first_stage(
        &mut self,
        linear: &Linear,
        matrices: &StageMatrices,
        ends: &[Kinematics; 3],
    ) {
        let (modes, nodes, a) = (linear.modes(), linear.stride, matrices.a);
        let (stage, middle) = (&self.stage, &mut self.middle);
        for m in 0..modes {
            middle.w[m] = stage.w_end[m];
            middle.dw[m] = (stage.w_end[m] - stage.w[m]) / a;
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            for m in 0..modes {
                let z = stage.z[m] + a * stage.w_end[m];
                let y = (stage.y[b * modes + m] + a / branch.time * z) / (1.0 + a / branch.time);
                middle.dy[b * modes + m] = (y - stage.y[b * modes + m]) / a;
            }
        }
        for j in 0..linear.base.len() {
            middle.base_velocity[j] = stage.base_velocity_end[j];
            middle.base_acceleration[j] = (stage.base_velocity_end[j] - stage.base_velocity[j]) / a;
        }
        let face_velocity = free_face_velocity(linear, &ends[1], &stage.base_velocity_end);
        for (c, (own, v)) in middle.v.iter_mut().zip(&stage.v).enumerate() {
            *own = v - face_velocity[c / nodes];
        }
        if self.keep_power {
            self.powers[1] = energy::power(linear, stage, &ends[1]);
        }
    }

    /// Explicit part of the BDF2-like stage to t + h.
    #[inline(always)]
    fn begin_second_stage(&mut self, linear: &Linear, state: &State, h: f64) {
        let (modes, nodes, weight) = (linear.modes(), linear.stride, W * h);
        let (stage, middle) = (&mut self.stage, &self.middle);
        let inertia_start = self.inertia[0];
        for m in 0..modes {
            let dw = state.dw[m] - linear.coupling_along(m, inertia_start);
            stage.z[m] = state.z[m] + weight * (state.w[m] + middle.w[m]);
            stage.w[m] = state.w[m] + weight * (dw + middle.dw[m]);
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            for m in 0..modes {
                let at = b * modes + m;
                let dy = (state.z[m] - state.y[at]) / branch.time;
                stage.y[at] = state.y[at] + weight * (dy + middle.dy[at]);
            }
        }
        for j in 0..linear.base.len() {
            stage.base[j] =
                state.base[j] + weight * (state.base_velocity[j] + middle.base_velocity[j]);
            stage.base_velocity[j] = state.base_velocity[j]
                + weight * (state.base_acceleration[j] + middle.base_acceleration[j]);
        }
        for c in 0..2 * nodes {
            stage.u[c] = self.u[c] + weight * (self.v[c] + middle.v[c]);
            // First guess: the change of the first stage goes on.
            stage.v[c] += (1.0 - GAMMA) / GAMMA * (middle.v[c] - self.v[c]);
        }
    }

    /// The state at the end of the step.
    #[inline(always)]
    fn write_trial(&mut self, linear: &Linear, end: &Kinematics) {
        let (modes, a) = (linear.modes(), self.a);
        let (stage, trial) = (&self.stage, &mut self.trial);
        for m in 0..modes {
            let coupling = linear.coupling_along(m, self.inertia[2]);
            trial.z[m] = stage.z[m] + a * stage.w_end[m];
            trial.w[m] = stage.w_end[m];
            trial.dw[m] = (stage.w_end[m] - stage.w[m]) / a + coupling;
        }
        for (b, branch) in linear.branches.iter().enumerate() {
            let ratio = a / branch.time;
            for m in 0..modes {
                let at = b * modes + m;
                trial.y[at] = (stage.y[at] + ratio * trial.z[m]) / (1.0 + ratio);
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
    /// the implicit stage would damp it.
    pub fn error(&self, linear: &Linear, state: &State, matrices: &StageMatrices, h: f64) -> f64 {
        let mut sum = 0.0;
        for m in 0..linear.modes() {
            let at = |k: usize| linear.coupling_along(m, self.inertia[k]);
            let z = h
                * (ERROR[0] * state.w[m]
                    + ERROR[1] * self.middle.w[m]
                    + ERROR[2] * self.trial.w[m]);
            let w = h
                * (ERROR[0] * (state.dw[m] - at(0))
                    + ERROR[1] * self.middle.dw[m]
                    + ERROR[2] * (self.trial.dw[m] - at(2)));
            let w = matrices.s[m] * (w - matrices.a_omega2[m] * z);
            let z = z + matrices.a * w;
            sum += w * w + linear.omega2[m] * z * z;
        }
        sum.sqrt()
    }

    /// Root of twice the kinetic energy at the end of the step \[kg^1/2 m/s\].
    pub fn speed(&self) -> f64 {
        dense::dot(&self.trial.w, &self.trial.w).sqrt()
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

/// Contact displacements Φ·`modal` without padding effects, for the instruction set at hand.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub fn contact_motion(linear: &Linear, modal: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    dense::add_columns(out, &linear.by_mode, modal);
}

/// The work of a step, compiled for several instruction sets of which the machine's best is taken;
/// all give the same bits, because sums have a fixed order and fused operations are spelled out.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn both_stages(
    step: &mut TrBdf2,
    linear: &Linear,
    face: &Face,
    state: &State,
    matrices: &StageMatrices,
    ends: &[Kinematics; 3],
    h: f64,
) -> Result<(), Fault> {
    for ((gap, profile), worn) in step.gap.iter_mut().zip(&face.profile).zip(&state.worn) {
        *gap = profile + worn;
    }
    step.raise_road(linear, face, state, &ends[2], h);
    // One place where a stage is solved: the solver is large, and inlined once.
    for (k, end) in ends[1..].iter().enumerate() {
        match k {
            0 => step.begin_first_stage(linear, state, matrices, ends),
            _ => step.begin_second_stage(linear, state, h),
        }
        let factor = &state.friction_factor;
        let solved = step.stage.solve(linear, face, matrices, end, &step.gap, factor);
        step.count(solved, state.time, matrices.a)?;
        if k == 0 {
            step.end_first_stage(linear, matrices, ends);
        }
    }
    if step.keep_power {
        step.powers[2] = energy::power(linear, &step.stage, &ends[2]);
    }
    step.write_trial(linear, &ends[2]);
    Ok(())
}
