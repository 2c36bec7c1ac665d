//! The tread face as the outputs see it: where its nodes are, what is summed over them, and what stands at the stations.

use super::signals::{Outputs, STATIONS};
use crate::contact::{face::padded, Face, Placed, Traction};
use crate::dynamics::{dense, Kinematics, Linear};
use crate::pack::{Aligned, Pack, LANES};
use multiversion::multiversion;

/// Motion and tractions of the contact nodes, the way to the stations, and buffers.
#[derive(Clone, Debug)]
pub(super) struct Stations {
    /// Quadratic interpolation to the stations: one column of weights per contact node.
    weights: Aligned,
    /// Values at the stations.
    row: Aligned,
    /// Tractions of the contact nodes.
    pub(super) traction: Traction,
    /// Displacements of the contact nodes against the clamped face \[m\], block frame: x, then z.
    pub(super) u: Aligned,
    /// Their velocities \[m/s\].
    pub(super) v: Aligned,
    /// Contact nodes over the road.
    pub(super) placed: Placed,
    /// Where the nodes stand along the road, from the middle of the clamped face \[m\].
    pub(super) along: Aligned,
    /// Where they stand above it \[m\].
    up: Aligned,
}

/// Sums over the face.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Force of the road on the face \[N\], road frame: x, z.
    pub(super) force: [f64; 2],
    /// Moment of it about the middle of the clamped face \[N m\].
    pub(super) moment: f64,
    /// Power lost in friction \[W\].
    pub(super) power: f64,
    /// Largest worn depth \[m\].
    pub(super) deepest: f64,
    /// Area of the face, of what touches and of what sticks \[m²\].
    area: [f64; 3],
}

impl Sums {
    /// Writes the shares of the face that touch and that stick.
    pub(super) fn shares(&self, out: &mut Outputs) {
        let [face, touching, sticking] = self.area;
        out.area_fraction = touching / face;
        out.stick_fraction = if touching > 0.0 { sticking / touching } else { 0.0 };
    }
}

impl Stations {
    /// Stations along a tread face with contact points at `points` \[m\].
    pub(super) fn along(points: &[f64]) -> Self {
        let (nodes, height) = (points.len(), padded(STATIONS));
        let stride = padded(nodes);
        let (first, last) = (points[0], points[nodes - 1]);
        // Columns go in pairs, see `dense::multiply`.
        let mut weights = Aligned::zeros(height * nodes.next_multiple_of(2));
        for station in 0..STATIONS {
            let x = first + (last - first) * station as f64 / (STATIONS - 1) as f64;
            // Points in threes, as the nodes of quadratic elements; the last three may overlap.
            let before = (1..nodes / 2).take_while(|e| points[2 * e] <= x).count();
            let start = (2 * before).min(nodes.saturating_sub(3));
            let three = parabola(&points[start..], x);
            for (node, weight) in (start..nodes).zip(three) {
                weights[node * height + station] = weight;
            }
        }
        Self {
            weights,
            row: Aligned::zeros(height),
            traction: Traction::new(nodes),
            u: Aligned::zeros(2 * stride),
            v: Aligned::zeros(2 * stride),
            placed: Placed::new(nodes),
            along: Aligned::zeros(stride),
            up: Aligned::zeros(stride),
        }
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

/// Where the contact nodes stand over the road `motion.position` \[m\] below the clamped face, and how they move, from
/// their displacements.
pub(super) fn place(
    st: &mut Stations,
    linear: &Linear,
    face: &Face,
    worn: &Aligned,
    motion: &Kinematics,
) {
    let n = linear.stride / LANES;
    let [sin, cos] = motion.sin_cos.map(Pack::splat);
    let (ux, uz) = st.u.packs()[..2 * n].split_at(n);
    let (vx, vz) = st.v.packs()[..2 * n].split_at(n);
    let (node_x, node_z) = (&linear.node_x.packs()[..n], Pack::splat(linear.node_z));
    let (profile, worn) = (&face.profile.packs()[..n], &worn.packs()[..n]);
    let compression = &mut st.placed.compression.packs_mut()[..n];
    let slip = &mut st.placed.slip.packs_mut()[..n];
    let lift = &mut st.placed.lift.packs_mut()[..n];
    let along = &mut st.along.packs_mut()[..n];
    let up = &mut st.up.packs_mut()[..n];
    let [height, omega] = [motion.position[1], motion.omega].map(Pack::splat);
    let [speed, rise] = motion.velocity.map(Pack::splat);
    for k in 0..n {
        let (x, z) = (node_x[k] + ux[k], node_z + uz[k]);
        up[k] = sin * x + cos * z;
        along[k] = cos * x - sin * z;
        compression[k] = -(height + up[k]) - profile[k] - worn[k];
        slip[k] = speed + cos * vx[k] - sin * vz[k] - omega * up[k];
        lift[k] = rise + sin * vx[k] + cos * vz[k] + omega * along[k];
    }
}

/// Sums over the face, and pressure \[Pa\] and sliding speed \[m/s\] at the stations. For the instruction set at hand, as
/// fused products would be calls without one.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn sum(st: &mut Stations, face: &Face, worn: &Aligned, out: &mut Outputs) -> Sums {
    let area = face.area.packs();
    let n = area.len();
    let (pressure, slip) = (&st.traction.pressure.packs()[..n], &st.placed.slip.packs()[..n]);
    let (tangential, normal) =
        (&st.traction.tangential.packs()[..n], &st.traction.normal.packs()[..n]);
    let (along, up) = (&st.along.packs()[..n], &st.up.packs()[..n]);
    let (zero, smoothing) = (Pack::default(), Pack::splat(face.smoothing_speed));
    let worn = &worn.packs()[..n];
    let (mut sums, mut deepest) = ([zero; 7], zero);
    for k in 0..n {
        let touching = pressure[k].if_above(zero, area[k], zero);
        sums[0] += tangential[k];
        sums[1] += normal[k];
        sums[2] += up[k] * tangential[k] - along[k] * normal[k];
        sums[3] += -(tangential[k] * slip[k]);
        sums[4] += area[k];
        sums[5] += touching;
        deepest = deepest.max(worn[k]);
        sums[6] += smoothing.if_above(slip[k].abs(), touching, zero);
    }
    let [x, z, moment, power, whole, touching, sticking] = sums.map(Pack::sum);
    let row = st.row.packs_mut();
    dense::multiply(row, st.weights.packs(), pressure);
    for k in row.iter_mut() {
        *k = k.max(zero);
    }
    out.pressure.copy_from_slice(&st.row[..STATIONS]);
    dense::multiply(st.row.packs_mut(), st.weights.packs(), slip);
    out.sliding_speed.copy_from_slice(&st.row[..STATIONS]);
    Sums {
        force: [x, z],
        moment,
        power,
        deepest: deepest.largest(),
        area: [whole, touching, sticking],
    }
}

/// Σ Γ_m ẅ_m of the modes: forces \[N\] along x and z and moment \[N m\] that accelerate them against the clamped face;
/// `rate` is their velocities' rate without what the face's acceleration `prescribed` \[m/s²\] takes off.
pub(super) fn inertia(coupling: &[Aligned; 3], rate: &Aligned, prescribed: [f64; 2]) -> [f64; 3] {
    let rate = rate.packs();
    let [gx, gz, gy] = coupling;
    let modes = rate.len();
    let (gx, gz, gy) = (&gx.packs()[..modes], &gz.packs()[..modes], &gy.packs()[..modes]);
    let [x, z] = prescribed.map(Pack::splat);
    let mut sums = [Pack::default(); 3];
    for m in 0..modes {
        let acceleration = rate[m] - (gx[m] * x + gz[m] * z);
        sums[0] += gx[m] * acceleration;
        sums[1] += gz[m] * acceleration;
        sums[2] += gy[m] * acceleration;
    }
    sums.map(Pack::sum)
}
