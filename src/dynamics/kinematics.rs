//! Prescribed motion of the clamped face at one instant.

use super::linear::Linear;
use crate::drive::Segment;

/// Prescribed motion of the clamped face at one instant, road frame.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Kinematics {
    /// Position x, z \[m\].
    pub position: [f64; 2],
    /// Velocity x, z \[m/s\].
    pub velocity: [f64; 2],
    /// Acceleration x, z \[m/s²\].
    pub acceleration: [f64; 2],
    /// sin and cos of the angle.
    pub sin_cos: [f64; 2],
    /// Angular velocity \[rad/s\].
    pub omega: f64,
    /// Normal load \[N\].
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

/// Prescribed motion at `s` \[s\] after the start of the segment.
pub fn kinematics(segment: &Segment, s: f64) -> Kinematics {
    let angle = segment.angle.at(s);
    // The same numbers without the work, for a block that is not turned.
    let (sin, cos) = if angle == 0.0 { (0.0, 1.0) } else { angle.sin_cos() };
    Kinematics {
        position: [segment.x.at(s), segment.z.at(s)],
        velocity: [segment.x.rate(s), segment.z.rate(s)],
        acceleration: [segment.x.curvature(s), segment.z.curvature(s)],
        sin_cos: [sin, cos],
        omega: segment.angle.rate(s),
        load: segment.load.at(s),
    }
}

/// A road vector in the block's frame.
pub fn to_block(motion: &Kinematics, [x, z]: [f64; 2]) -> [f64; 2] {
    let [sin, cos] = motion.sin_cos;
    [cos * x + sin * z, -sin * x + cos * z]
}

/// Prescribed acceleration of the clamped face in the block's frame \[m/s²\].
pub(super) fn inertia(linear: &Linear, motion: &Kinematics) -> [f64; 2] {
    to_block(motion, linear.prescribed_acceleration(motion.acceleration))
}

/// Velocity of the free clamped face in the block's frame \[m/s\].
pub(super) fn free_face_velocity(
    linear: &Linear,
    motion: &Kinematics,
    velocity: &[f64; 2],
) -> [f64; 2] {
    let mut road = [0.0; 2];
    for (j, dof) in linear.base.iter().enumerate() {
        road[dof.axis] = velocity[j];
    }
    to_block(motion, road)
}
