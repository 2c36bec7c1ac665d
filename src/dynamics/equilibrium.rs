//! Frictionless static equilibrium of the pressed block.

use super::linear::Linear;
use super::matrices::in_block_frame;
use super::state::State;
use crate::contact::{normal, Face};
use crate::drive::Pose;
use crate::error::Fault;
use nalgebra::{DMatrix, DVector};

/// Iterations after which there is no equilibrium; about ten are usual.
const MAX_ITERATIONS: usize = 200;
/// Largest change of a compression per iteration, in contact depths.
const LARGEST_CHANGE: f64 = 2.0;

/// Puts `state` into equilibrium: at the height of `pose`, or under its load where the clamped face
/// is free in z.
///
/// Newton's method on S₀u = f(u), S₀ the static stiffness of the contact degrees of freedom, with
/// the height as one more unknown for one more equation, Σ f_z = load (theory eq. 3.10).
///
/// # Errors
/// [`Fault::NoConvergence`] if there is none.
pub fn settle(linear: &Linear, face: &Face, pose: Pose, state: &mut State) -> Result<(), Fault> {
    let nodes = linear.nodes;
    let size = 2 * nodes;
    let up = in_block_frame(1, pose.angle);
    let free = linear.base.iter().position(|b| b.axis == 1);
    let compliance = compliance(linear, state.stiffness_factor);
    let stiffness = compliance.clone().try_inverse().ok_or_else(|| failure(state.time, 0.0))?;
    let mut height = start_height(linear, face, pose, free.is_some());
    let mut u = DVector::zeros(size);
    if free.is_some() && pose.load <= 0.0 {
        // Nothing presses: the block hangs where it just touches.
        store(linear, face, state, &u, [pose.x, height], up, free);
        return Ok(());
    }
    for _ in 0..MAX_ITERATIONS {
        let mut jacobian = stiffness.clone().resize(size + 1, size + 1, 0.0);
        let mut rhs = -(&stiffness * &u).resize_vertically(size + 1, 0.0);
        if free.is_some() {
            rhs[size] = pose.load;
        } else {
            jacobian[(size, size)] = 1.0;
        }
        for i in 0..nodes {
            let c = compression(linear, face, state, &u, [pose.x, height], up, i);
            let (p, dp) = face.stress_at_rest(c);
            let (force, slope) = (p * face.area[i], dp * face.area[i]);
            let axes = [(i, up[0]), (nodes + i, up[1])];
            for (row, e) in axes {
                rhs[row] += force * e;
                for (column, other) in axes {
                    jacobian[(row, column)] += slope * e * other;
                }
                jacobian[(row, size)] += slope * e;
                if free.is_some() {
                    jacobian[(size, row)] -= slope * e;
                }
            }
            if free.is_some() {
                rhs[size] -= force;
                jacobian[(size, size)] -= slope;
            }
        }
        let step = jacobian.lu().solve(&rhs).ok_or_else(|| failure(state.time, 0.0))?;
        let largest = step.amax();
        let shrink = (LARGEST_CHANGE * face.contact.depth / largest).min(1.0);
        u += shrink * step.rows(0, size);
        if free.is_some() {
            height += shrink * step[size];
        }
        if largest < 1e-13 {
            store(linear, face, state, &u, [pose.x, height], up, free);
            return Ok(());
        }
    }
    Err(failure(state.time, u.amax()))
}

/// Compression of node `i` \[m\], the middle of the clamped face at `place`.
fn compression(
    linear: &Linear,
    face: &Face,
    state: &State,
    u: &DVector<f64>,
    place: [f64; 2],
    up: [f64; 2],
    i: usize,
) -> f64 {
    let (x, z) = (linear.node_x[i] + u[i], linear.node_z + u[linear.nodes + i]);
    let road = face.road.map_or(0.0, |road| road.height(place[0] + up[1] * x - up[0] * z));
    road - (place[1] + up[0] * x + up[1] * z) - face.profile[i] - state.worn[i]
}

/// Static compliance of the contact degrees of freedom \[m/N\].
fn compliance(linear: &Linear, stiffness_factor: f64) -> DMatrix<f64> {
    let (nodes, stride) = (linear.nodes, linear.stride);
    let modes = DMatrix::from_fn(2 * nodes, linear.modes(), |c, m| {
        linear.by_mode[2 * m * stride + c / nodes * stride + c % nodes]
    });
    let mut weighted = modes.clone();
    for (mut column, omega2) in weighted.column_iter_mut().zip(&linear.omega2) {
        column /= omega2 * stiffness_factor;
    }
    weighted * modes.transpose()
}

/// A height from which the iteration starts: the given one, or where the mean pressure would hold.
fn start_height(linear: &Linear, face: &Face, pose: Pose, free: bool) -> f64 {
    if !free {
        return pose.z;
    }
    let area: f64 = face.area.iter().sum();
    let nearest = face.profile.iter().copied().fold(f64::INFINITY, f64::min);
    let tilt = pose.angle.sin().abs() * linear.node_x[linear.nodes - 1];
    let mean = normal::compression(&face.contact, pose.load / area);
    -linear.node_z * pose.angle.cos() + tilt - nearest - mean
}

fn store(
    linear: &Linear,
    face: &Face,
    state: &mut State,
    u: &DVector<f64>,
    place: [f64; 2],
    up: [f64; 2],
    free: Option<usize>,
) {
    let nodes = linear.nodes;
    let stride = linear.stride;
    let mut force = vec![0.0; 2 * stride];
    for i in 0..nodes {
        let c = compression(linear, face, state, u, place, up, i);
        let f = face.stress_at_rest(c).0 * face.area[i];
        force[i] = f * up[0];
        force[stride + i] = f * up[1];
    }
    for m in 0..linear.modes() {
        let mode = &linear.by_mode[2 * m * stride..2 * (m + 1) * stride];
        let load: f64 = mode.iter().zip(&force).map(|(phi, f)| phi * f).sum();
        state.z[m] = load / (linear.omega2[m] * state.stiffness_factor);
    }
    for (b, _) in linear.branches.iter().enumerate() {
        let modes = linear.modes();
        state.y[b * modes..(b + 1) * modes].copy_from_slice(&state.z);
    }
    if let Some(j) = free {
        state.base[j] = place[1];
    }
}

fn failure(time: f64, residual: f64) -> Fault {
    Fault::NoConvergence { time, step: 0.0, residual, iterations: MAX_ITERATIONS }
}
