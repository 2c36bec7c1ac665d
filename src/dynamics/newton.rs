//! Newton directions for the contact velocities of a stage, in two forms: with the normal velocities
//! eliminated for a block that is not turned, and with the full matrix for all else.

use super::dense;
use super::kinematics::Kinematics;
use super::linear::Linear;
use super::matrices::{FlatMatrices, StageMatrices};
use super::stage::Stage;

/// Largest fall of friction with speed that a direction follows, as a share of the block's own
/// resistance: far from the solution the tangent of a steeper fall overshoots, near it only the
/// tangent converges fast.
const STEEPEST_FALL: [f64; 2] = [0.3, 0.95];
/// Iterations in which the solution is taken to be near. Before them it may be far; after them the
/// fall is too steep for the tangent, and the flatter slope creeps to a solution instead.
const NEAR: std::ops::RangeInclusive<usize> = 6..=12;

/// A direction and the buffers to find it.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    /// Change of the contact velocities [m/s], padded.
    direction: Vec<f64>,
    /// v − v_free [m/s], padded.
    difference: Vec<f64>,
    /// f_n + (assumed slope)·(v − v_free)_n [N].
    normal: Vec<f64>,
    product: Vec<f64>,
    diagonal: Vec<f64>,
    matrix: Vec<f64>,
    compact: Vec<f64>,
    /// −∂f/∂v per node in the block's frame: xx, xz, zx, zz [N s/m].
    slopes: Vec<[f64; 4]>,
    nodes: usize,
}

impl Newton {
    pub(super) fn new(linear: &Linear) -> Self {
        let (nodes, stride) = (linear.nodes, linear.stride);
        Self {
            direction: vec![0.0; 2 * stride],
            difference: vec![0.0; 2 * stride],
            normal: vec![0.0; stride],
            product: vec![0.0; stride],
            diagonal: vec![0.0; stride],
            matrix: vec![0.0; (4 * nodes * nodes).max(stride * stride)],
            compact: vec![0.0; 2 * nodes],
            slopes: vec![[0.0; 4]; stride],
            nodes,
        }
    }
}

impl Stage {
    /// With d = v − v_free and φ = f_n + G₀ d_n: (B + g) δ_t = f_t − B d_t − P φ, then
    /// d_n = A⁻¹ φ − Pᵀ (d_t + δ_t) (theory eq. 3.9).
    #[inline(always)]
    pub(super) fn flat_direction(&mut self, m: &FlatMatrices, iteration: usize) -> bool {
        let steepest_fall = STEEPEST_FALL[usize::from(NEAR.contains(&iteration))];
        let n = &mut self.newton;
        let stride = self.slip.len();
        for ((d, v), free) in n.difference.iter_mut().zip(&self.v).zip(&self.v_free) {
            *d = v - free;
        }
        let (d_t, d_n) = n.difference.split_at_mut(stride);
        let t = &self.traction;
        for i in 0..stride {
            n.normal[i] = t.normal[i] + m.normal_slope[i] * d_n[i];
            // A falling characteristic is not followed: its tangent would overshoot.
            let slope = t.slip_slope[i].max(-steepest_fall * m.b[i * stride + i]);
            n.slopes[i] = [slope, 0.0, 0.0, m.normal_slope[i]];
            n.diagonal[i] = slope;
        }
        self.force[..stride].copy_from_slice(&t.tangential);
        self.force[stride..].copy_from_slice(&t.normal);
        let (direction_t, direction_n) = n.direction.split_at_mut(stride);
        n.product.fill(0.0);
        dense::add_columns(&mut n.product, &m.b, d_t);
        dense::add_columns(&mut n.product, &m.p, &n.normal);
        for i in 0..stride {
            direction_t[i] = t.tangential[i] - n.product[i];
        }
        let solved = dense::solve_with_diagonal(
            &m.b,
            &n.diagonal,
            direction_t,
            n.nodes,
            stride,
            &mut n.matrix,
        );
        for (d, step) in d_t.iter_mut().zip(direction_t.iter()) {
            *d = -(*d + step);
        }
        n.product.fill(0.0);
        dense::add_columns(&mut n.product, &m.a_inverse, &n.normal);
        dense::add_columns(&mut n.product, &m.p_transposed, d_t);
        for i in 0..stride {
            direction_n[i] = n.product[i] - d_n[i];
        }
        solved
    }

    /// (S + G) δ = f − S (v − v_free) with the full matrix of the turned block.
    pub(super) fn full_direction(
        &mut self,
        matrices: &StageMatrices,
        motion: &Kinematics,
        iteration: usize,
    ) -> bool {
        let steepest_fall = STEEPEST_FALL[usize::from(NEAR.contains(&iteration))];
        let n = &mut self.newton;
        let (nodes, stride) = (n.nodes, self.slip.len());
        let size = 2 * nodes;
        let place = |c: usize| c / nodes * stride + c % nodes;
        let [sin, cos] = motion.sin_cos;
        let matrix = &mut n.matrix[..size * size];
        matrix.copy_from_slice(&matrices.inverse_delassus);
        let t = &self.traction;
        for i in 0..nodes {
            self.force[i] = cos * t.tangential[i] + sin * t.normal[i];
            self.force[stride + i] = -sin * t.tangential[i] + cos * t.normal[i];
            let steepest = -steepest_fall * matrices.inverse_delassus[i * size + i];
            let tt = t.slip_slope[i].max(steepest);
            let (tn, nn) = (t.coupling[i], t.approach_slope[i]);
            // Rᵀ G R with G = [tt tn; 0 nn] in the road frame.
            let (gx, gz) = (tt * cos + tn * sin, -tt * sin + tn * cos);
            let slopes = [
                cos * gx + sin * nn * sin,
                cos * gz + sin * nn * cos,
                -sin * gx + cos * nn * sin,
                -sin * gz + cos * nn * cos,
            ];
            matrix[i * size + i] += slopes[0];
            matrix[i * size + nodes + i] += slopes[1];
            matrix[(nodes + i) * size + i] += slopes[2];
            matrix[(nodes + i) * size + nodes + i] += slopes[3];
            n.slopes[i] = slopes;
        }
        for c in 0..size {
            n.difference[c] = self.v[place(c)] - self.v_free[place(c)];
        }
        for (c, row) in matrices.inverse_delassus.chunks_exact(size).enumerate() {
            n.compact[c] = self.force[place(c)] - dense::dot(row, &n.difference[..size]);
        }
        if !dense::factor(matrix, size) {
            return false;
        }
        dense::solve(matrix, &mut n.compact);
        n.direction.fill(0.0);
        for (c, step) in n.compact.iter().enumerate() {
            n.direction[place(c)] = *step;
        }
        true
    }

    /// Goes along the direction; returns the largest change of a velocity that it asked for.
    ///
    /// A tangential speed that would change its sign stops at zero: friction is concave on either
    /// side, so from there the iteration cannot overshoot again. The last step
    /// is whole: its forces follow along the tangent, so that they and the velocities satisfy the
    /// linear equations to rounding.
    #[inline(always)]
    pub(super) fn take_direction(&mut self, motion: &Kinematics, tolerance: f64) -> f64 {
        let n = &mut self.newton;
        let stride = self.slip.len();
        let [sin, cos] = motion.sin_cos;
        let (direction_x, direction_z) = n.direction.split_at(stride);
        // The padding is carried along with the face, which no direction accounts for.
        let real = direction_x[..n.nodes].iter().chain(&direction_z[..n.nodes]);
        let change = real.fold(0.0_f64, |largest, d| largest.max(d.abs()));
        let near = change < tolerance;
        let (vx, vz) = self.v.split_at_mut(stride);
        let (fx, fz) = self.force.split_at_mut(stride);
        for i in 0..n.nodes {
            let (mut dx, dz) = (direction_x[i], direction_z[i]);
            let slip = self.slip[i];
            let crosses = slip * (slip + cos * dx - sin * dz) < 0.0;
            if crosses && !near {
                dx = (sin * dz - slip) / cos;
            }
            let [xx, xz, zx, zz] = n.slopes[i];
            fx[i] -= xx * dx + xz * dz;
            fz[i] -= zx * dx + zz * dz;
            vx[i] += dx;
            vz[i] += dz;
        }
        change
    }
}
