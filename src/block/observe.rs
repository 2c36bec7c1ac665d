//! Outputs from the state of motion.

use super::signals::{Outputs, STATIONS};
use super::TreadBlock;
use crate::contact::{face::padded, Placed, Traction};
use crate::dynamics::tr_bdf2::contact_motion;
use crate::dynamics::{Kinematics, Linear, State};
use crate::pack::{Aligned, Pack, LANES};

/// Quadratic interpolation from contact nodes to equidistant stations, with buffers.
#[derive(Clone, Debug)]
pub(super) struct Stations {
    /// Per station: first of three nodes, and their weights.
    places: Vec<(usize, [f64; 3])>,
    traction: Traction,
    u: Aligned,
    v: Aligned,
    placed: Placed,
    /// Where the nodes stand along the road from the middle of the clamped face \[m\].
    along: Aligned,
}

impl Stations {
    /// Stations along a tread face with contact points at `points` \[m\].
    pub(super) fn along(points: &[f64]) -> Self {
        let nodes = points.len();
        let stride = padded(nodes);
        let (first, last) = (points[0], points[nodes - 1]);
        let place = |k: usize| {
            let x = first + (last - first) * k as f64 / (STATIONS - 1) as f64;
            // Points in threes, as the nodes of quadratic elements; the last three may overlap.
            let before = (1..nodes / 2).take_while(|e| points[2 * e] <= x).count();
            let start = (2 * before).min(nodes.saturating_sub(3));
            (start, parabola(&points[start..], x))
        };
        Self {
            places: (0..STATIONS).map(place).collect(),
            traction: Traction::new(nodes),
            u: Aligned::zeros(2 * stride),
            v: Aligned::zeros(2 * stride),
            placed: Placed::new(nodes),
            along: Aligned::zeros(stride),
        }
    }

    fn at(&self, values: &[f64]) -> [f64; STATIONS] {
        std::array::from_fn(|k| {
            let (node, weights) = self.places[k];
            let three = &values[node..node + 3];
            weights[0] * three[0] + weights[1] * three[1] + weights[2] * three[2]
        })
    }
}

/// Weights at `x` of the first three `points` in the parabola through them, or of two in the line.
fn parabola(points: &[f64], x: f64) -> [f64; 3] {
    let points = &points[..points.len().min(3)];
    std::array::from_fn(|i| {
        let Some(own) = points.get(i) else { return 0.0 };
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| (x - other) / (own - other)).product()
    })
}

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
        let t = &stations.traction;
        out.contact_force = [t.tangential.iter().sum(), t.normal.iter().sum()];
        out.friction_coefficient = if out.contact_force[1] > 0.0 {
            out.contact_force[0] / out.contact_force[1]
        } else {
            0.0
        };
        out.friction_power =
            t.tangential.iter().zip(&stations.placed.slip).map(|(f, v)| -f * v).sum();
        out.pressure = stations.at(&t.pressure).map(|p| p.max(0.0));
        out.sliding_speed = stations.at(&stations.placed.slip);
        shares(&self.face.area, stations, self.params.friction.smoothing_speed, out);
        out.wear_mass = self.wear_mass;
        out.wear_depth_max = self.state.worn.iter().copied().fold(0.0, f64::max);
        out.carriage_z = motion.position[1];
        out.deflection = self.linear.deflection(&self.state.base);
        out.deflection_velocity = self.linear.deflection(&self.state.base_velocity);
        self.belt_reaction(&motion);
    }

    /// Displacements, velocities and tractions of the contact nodes.
    fn contact_now(&mut self, motion: &Kinematics) {
        let (linear, st) = (&self.linear, &mut self.stations);
        let stride = linear.stride;
        if let Some([u, v]) = self.integrator.contact_motion() {
            st.u.copy_from_slice(u);
            st.v.copy_from_slice(v);
        } else {
            contact_motion(linear, &self.state.z, &mut st.u);
            contact_motion(linear, &self.state.w, &mut st.v);
        }
        let splat = Pack::splat;
        let [sin, cos] = motion.sin_cos.map(splat);
        let n = stride / LANES;
        let (ux, uz) = st.u.packs()[..2 * n].split_at(n);
        let (vx, vz) = st.v.packs()[..2 * n].split_at(n);
        let (node_x, node_z) = (&linear.node_x.packs()[..n], splat(linear.node_z));
        let (profile, worn) = (&self.face.profile.packs()[..n], &self.state.worn.packs()[..n]);
        let compression = &mut st.placed.compression.packs_mut()[..n];
        let slip = &mut st.placed.slip.packs_mut()[..n];
        let lift = &mut st.placed.lift.packs_mut()[..n];
        let along = &mut st.along.packs_mut()[..n];
        let [height, omega] = [motion.position[1], motion.omega].map(splat);
        let [speed, rise] = motion.velocity.map(splat);
        for k in 0..n {
            let (x, z) = (node_x[k] + ux[k], node_z + uz[k]);
            let up = sin * x + cos * z;
            along[k] = cos * x - sin * z;
            compression[k] = -(height + up) - profile[k] - worn[k];
            slip[k] = speed + cos * vx[k] - sin * vz[k] - omega * up;
            lift[k] = rise + sin * vx[k] + cos * vz[k] + omega * along[k];
        }
        if let Some(road) = &self.face.road {
            for (compression, along) in st.placed.compression.iter_mut().zip(&st.along) {
                *compression += road.height(motion.position[0] + along);
            }
        }
        let factor = &self.state.friction_factor;
        self.face.evaluate(0.0, &st.placed, factor, &mut st.traction);
    }

    /// Force and moment on the belt: contact forces less what accelerates the block.
    fn belt_reaction(&mut self, motion: &Kinematics) {
        let (linear, state) = (&self.linear, &self.state);
        let [sin, cos] = motion.sin_cos;
        let driven = linear.prescribed_acceleration(motion.acceleration);
        let mut road = driven;
        for (j, dof) in linear.base.iter().enumerate() {
            road[dof.axis] += state.base_acceleration[j];
        }
        let base = [cos * road[0] + sin * road[1], -sin * road[0] + cos * road[1]];
        let prescribed = [cos * driven[0] + sin * driven[1], -sin * driven[0] + cos * driven[1]];
        let modes = state.dw.packs().len();
        let [gx, gz, gy] = &linear.coupling;
        let (gx, gz, gy) = (&gx.packs()[..modes], &gz.packs()[..modes], &gy.packs()[..modes]);
        let [x, z] = prescribed.map(Pack::splat);
        let mut sums = [Pack::default(); 3];
        for (m, dw) in state.dw.packs().iter().enumerate() {
            let acceleration = *dw - (gx[m] * x + gz[m] * z);
            sums[0] += gx[m] * acceleration;
            sums[1] += gz[m] * acceleration;
            sums[2] += gy[m] * acceleration;
        }
        let [x, z, y] = sums.map(Pack::sum);
        let rate = [linear.block_mass * base[0] + x, linear.block_mass * base[1] + z];
        let turning = linear.block_mass * 0.5 * linear.node_z * base[0] + y;
        let out = &mut self.outputs;
        out.force = [
            out.contact_force[0] - (cos * rate[0] - sin * rate[1]),
            out.contact_force[1] - (sin * rate[0] + cos * rate[1]),
        ];
        let st = &self.stations;
        let mut moment = -turning;
        for i in 0..linear.nodes {
            let (x, z) = (linear.node_x[i] + st.u[i], linear.node_z + st.u[linear.stride + i]);
            let (along, up) = (cos * x - sin * z, sin * x + cos * z);
            moment += up * st.traction.tangential[i] - along * st.traction.normal[i];
        }
        out.moment_y = moment;
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

/// Shares of the face that touch and that stick.
fn shares(area: &[f64], stations: &Stations, smoothing_speed: f64, out: &mut Outputs) {
    let total: f64 = area.iter().sum();
    let (mut touching, mut sticking) = (0.0, 0.0);
    for ((a, p), v) in area.iter().zip(&stations.traction.pressure).zip(&stations.placed.slip) {
        if *p > 0.0 {
            touching += a;
            if v.abs() < smoothing_speed {
                sticking += a;
            }
        }
    }
    out.area_fraction = touching / total;
    out.stick_fraction = if touching > 0.0 { sticking / touching } else { 0.0 };
}
