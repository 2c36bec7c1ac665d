//! Energy ledger: what the belt put in and where it went.

use super::kinematics::{to_block, Kinematics};
use super::linear::Linear;
use super::stage::Stage;
use super::state::State;
use crate::contact::{normal, Face};

/// Energies \[J\] since the ledger was opened, in the frame that moves with the clamped face.
///
/// belt + load = Δelastic + Δkinetic + damping + friction + wear + carriage (theory eq. 3.12).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Ledger {
    /// Work of the belt: contact forces times the prescribed velocity, and its inertia.
    pub belt: f64,
    /// Work of the normal load on the carriage.
    pub load: f64,
    /// Loss in the rubber's damping.
    pub damping: f64,
    /// Loss in friction.
    pub friction: f64,
    /// Energy of the contact springs released by wear.
    pub wear: f64,
    /// Loss in the carriage's damping.
    pub carriage: f64,
    /// Stored energy when the ledger was opened.
    pub stored_at_start: f64,
    /// Stored energy now: block, contact springs, kinetic.
    pub stored: f64,
}

impl Ledger {
    /// What is left over \[J\]: zero but for the error of the integrator.
    pub fn remainder(&self) -> f64 {
        let gained = self.stored - self.stored_at_start;
        let lost = self.damping + self.friction + self.wear + self.carriage;
        self.belt + self.load - gained - lost
    }

    /// Adds powers over a duration.
    pub(super) fn add(&mut self, power: &Power, duration: f64) {
        self.belt += power.belt * duration;
        self.load += power.load * duration;
        self.damping += power.damping * duration;
        self.friction += power.friction * duration;
        self.carriage += power.carriage * duration;
    }
}

/// Powers \[W\] at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Power {
    belt: f64,
    load: f64,
    damping: f64,
    pub(super) friction: f64,
    carriage: f64,
}

/// Powers at the end of a solved stage.
pub(super) fn power(linear: &Linear, stage: &Stage, motion: &Kinematics) -> Power {
    let mut out = Power::default();
    let [sin, cos] = motion.sin_cos;
    for i in 0..linear.nodes {
        let at = linear.stride + i;
        let (fx, fz) = (stage.force[i], stage.force[at]);
        let (tangential, normal) = (cos * fx - sin * fz, sin * fx + cos * fz);
        let (vx, vz) = (stage.v[i], stage.v[at]);
        let own_x = cos * vx - sin * vz;
        let [carried_x, carried_z] = stage.carried(i);
        out.friction -= tangential * (own_x + carried_x);
        out.belt -= tangential * carried_x + normal * carried_z;
    }
    let inertia = to_block(motion, linear.prescribed_acceleration(motion.acceleration));
    for (m, w) in stage.w_end.iter().enumerate() {
        out.damping += linear.damping * linear.omega2[m] * w * w;
        out.belt -= linear.coupling_along(m, inertia) * w;
    }
    for (j, dof) in linear.base.iter().enumerate() {
        let b = stage.base_velocity_end[j];
        out.carriage += dof.damping * b * b;
        if dof.axis == 1 {
            out.load -= motion.load * b;
        }
    }
    out
}

/// Energy stored in block, contact springs and motion \[J\]; base model (no Maxwell branches).
pub(super) fn stored(linear: &Linear, face: &Face, state: &State, compression: &[f64]) -> f64 {
    let block: f64 = (0..linear.modes())
        .map(|m| {
            let (z, w) = (state.z[m], state.w[m]);
            0.5 * (w * w + state.stiffness_factor * linear.omega2[m] * z * z)
        })
        .sum();
    let springs: f64 = compression
        .iter()
        .zip(&face.area)
        .map(|(u, area)| area * normal::energy(&face.contact, *u))
        .sum();
    let face_motion: f64 = linear
        .base
        .iter()
        .enumerate()
        .map(|(j, dof)| {
            let b = state.base_velocity[j];
            let coupled: f64 =
                linear.coupling[dof.axis].iter().zip(&state.w).map(|(g, w)| g * w).sum();
            0.5 * (dof.mass + linear.block_mass) * b * b + coupled * b
        })
        .sum();
    block + springs + face_motion
}
