//! Outputs from the state of motion.

use super::stations::{self, Sums};
use super::TreadBlock;
use crate::dynamics::tr_bdf2::contact_motion;
use crate::dynamics::{Kinematics, Linear, State};

impl TreadBlock {
    /// Compression of the contact nodes \[m\] as the state stands.
    pub(super) fn compression(&self) -> Vec<f64> {
        self.stations.placed.compression.to_vec()
    }

    /// Displacements \[m\] of all mesh nodes relative to the clamped face, block frame: x and z per
    /// node, in the order of [`crate::mesh::Mesh::position`].
    pub fn field(&self) -> Vec<[f64; 2]> {
        let scale = (self.params.rubber.density * self.params.block.width).sqrt();
        let value = |dof: Option<usize>| {
            dof.map_or(0.0, |row| {
                let shape = self.reduction.shapes.row(row);
                shape.iter().zip(&self.state.z).map(|(s, z)| s * z).sum::<f64>() / scale
            })
        };
        self.reduction.dof.chunks_exact(2).map(|d| [value(d[0]), value(d[1])]).collect()
    }

    /// Writes the outputs for the state and the prescribed motion as they stand.
    pub(super) fn observe(&mut self) {
        let mut motion = self.motion;
        free_the_face(&self.linear, &self.state, &mut motion);
        self.contact_now(&motion);
        let (nodes, stride) = (self.linear.nodes, self.linear.stride);
        let (stations, out) = (&self.stations, &mut self.outputs);
        let corner = |values: &[f64], node: usize| [values[node], values[stride + node]];
        out.run_in_displacement = corner(&stations.u, 0);
        out.run_in_velocity = corner(&stations.v, 0);
        out.run_out_displacement = corner(&stations.u, nodes - 1);
        out.run_out_velocity = corner(&stations.v, nodes - 1);
        let sums = stations::sum(&mut self.stations, &self.face, &self.state.worn, out);
        out.contact_force = sums.force;
        let [x, z] = sums.force;
        out.friction_coefficient = if z > 0.0 { x / z } else { 0.0 };
        out.friction_power = sums.power;
        sums.shares(out);
        out.wear_mass = self.wear_mass;
        out.wear_depth_max = sums.deepest;
        out.carriage_z = motion.position[1];
        out.deflection = self.linear.deflection(&self.state.base);
        out.deflection_velocity = self.linear.deflection(&self.state.base_velocity);
        self.belt_reaction(&motion, &sums);
    }

    /// Displacements, velocities and tractions of the contact nodes.
    fn contact_now(&mut self, motion: &Kinematics) {
        let (linear, st) = (&self.linear, &mut self.stations);
        if let Some([u, v]) = self.integrator.contact_motion() {
            st.u.copy_from_slice(u);
            st.v.copy_from_slice(v);
        } else {
            contact_motion(linear, &self.state.z, &mut st.u);
            contact_motion(linear, &self.state.w, &mut st.v);
        }
        stations::place(st, linear, &self.face, &self.state.worn, motion);
        if let Some(road) = &self.face.road {
            for (compression, along) in st.placed.compression.iter_mut().zip(&st.along) {
                *compression += road.height(motion.position[0] + along);
            }
        }
        let factor = &self.state.friction_factor;
        self.face.evaluate(0.0, &st.placed, factor, &mut st.traction);
    }

    /// Force and moment on the belt: contact forces less what accelerates the block.
    fn belt_reaction(&mut self, motion: &Kinematics, sums: &Sums) {
        let (linear, state) = (&self.linear, &self.state);
        let [sin, cos] = motion.sin_cos;
        let driven = linear.prescribed_acceleration(motion.acceleration);
        let mut road = driven;
        for (j, dof) in linear.base.iter().enumerate() {
            road[dof.axis] += state.base_acceleration[j];
        }
        let base = [cos * road[0] + sin * road[1], -sin * road[0] + cos * road[1]];
        let prescribed = [cos * driven[0] + sin * driven[1], -sin * driven[0] + cos * driven[1]];
        let [x, z, y] = stations::inertia(&linear.coupling, &state.dw, prescribed);
        let rate = [linear.block_mass * base[0] + x, linear.block_mass * base[1] + z];
        let turning = linear.block_mass * 0.5 * linear.node_z * base[0] + y;
        let out = &mut self.outputs;
        out.force = [
            out.contact_force[0] - (cos * rate[0] - sin * rate[1]),
            out.contact_force[1] - (sin * rate[0] + cos * rate[1]),
        ];
        out.moment_y = sums.moment - turning;
    }
}

/// Replaces the prescribed by the actual motion of a free clamped face, but for the acceleration.
fn free_the_face(linear: &Linear, state: &State, motion: &mut Kinematics) {
    motion.position = linear.prescribed(motion.position);
    motion.velocity = linear.prescribed(motion.velocity);
    for (j, dof) in linear.base.iter().enumerate() {
        motion.position[dof.axis] += state.base[j];
        motion.velocity[dof.axis] += state.base_velocity[j];
    }
}
