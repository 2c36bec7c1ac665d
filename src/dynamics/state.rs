//! Everything that changes while the block moves.

use super::linear::Linear;
use crate::pack::Aligned;

/// State of motion at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Modal displacements \[kg^1/2 m\].
    pub z: Aligned,
    /// Modal velocities \[kg^1/2 m/s\].
    pub w: Aligned,
    /// Modal accelerations without the inertia of the prescribed motion \[kg^1/2 m/s²\].
    pub dw: Aligned,
    /// Memory of the Maxwell branches, branch after branch \[kg^1/2 m\].
    pub y: Aligned,
    /// Free coordinates of the clamped face, in the order of [`Linear::base`] \[m\].
    pub base: [f64; 2],
    /// Their velocities \[m/s\].
    pub base_velocity: [f64; 2],
    /// Their accelerations \[m/s²\].
    pub base_acceleration: [f64; 2],
    /// Worn depth per contact node \[m\].
    pub worn: Aligned,
    /// Factor on the stiffness of the block (amplitude-dependent softening), 1 in the base model.
    pub stiffness_factor: f64,
    /// Factor on friction per contact node, 1 in the base model.
    pub friction_factor: Aligned,
    /// Internal step that the error control would take next \[s\].
    pub step: f64,
    /// Scale of the motion for the error control \[kg^1/2 m/s\].
    pub scale: f64,
}

impl State {
    /// At rest, undeformed.
    pub fn new(linear: &Linear) -> Self {
        let (modes, nodes) = (linear.modes(), linear.stride);
        Self {
            time: 0.0,
            z: Aligned::zeros(modes),
            w: Aligned::zeros(modes),
            dw: Aligned::zeros(modes),
            y: Aligned::zeros(modes * linear.branches.len()),
            base: [0.0; 2],
            base_velocity: [0.0; 2],
            base_acceleration: [0.0; 2],
            worn: Aligned::zeros(nodes),
            stiffness_factor: 1.0,
            friction_factor: Aligned::padded(&[], nodes, 1.0),
            step: 0.0,
            scale: 0.0,
        }
    }

    /// All numbers in a fixed order.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.extend([self.time, self.stiffness_factor, self.step, self.scale]);
        out.extend(self.base.iter().chain(&self.base_velocity).chain(&self.base_acceleration));
        for part in [&self.z, &self.w, &self.dw, &self.y, &self.worn, &self.friction_factor] {
            out.extend_from_slice(part);
        }
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None` if there is too little.
    pub fn restore<'a>(&mut self, mut from: &'a [f64]) -> Option<&'a [f64]> {
        let mut take = |count: usize| -> Option<&'a [f64]> {
            let (head, tail) = from.split_at_checked(count)?;
            from = tail;
            Some(head)
        };
        let head = take(4)?;
        (self.time, self.stiffness_factor, self.step, self.scale) =
            (head[0], head[1], head[2], head[3]);
        for part in [&mut self.base, &mut self.base_velocity, &mut self.base_acceleration] {
            part.copy_from_slice(take(2)?);
        }
        for part in [
            &mut self.z,
            &mut self.w,
            &mut self.dw,
            &mut self.y,
            &mut self.worn,
            &mut self.friction_factor,
        ] {
            let count = part.len();
            part.copy_from_slice(take(count)?);
        }
        Some(from)
    }
}
