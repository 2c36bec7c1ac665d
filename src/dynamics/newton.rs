//! Newton directions for the contact velocities of a stage, in two forms: with the normal velocities
//! eliminated for a block that is not turned, and with the full matrix for all else.

use super::kinematics::Kinematics;
use super::linear::Linear;
use super::matrices::{FlatMatrices, StageMatrices};
use super::stage::Stage;
use super::{dense, gauss_jordan};
use crate::contact::Traction;
use crate::pack::Aligned;

/// Largest fall of friction with speed that a direction follows, as a share of the block's own
/// resistance: far from the solution the tangent of a steeper fall overshoots, near it only the
/// tangent converges fast.
const STEEPEST_FALL: [f64; 2] = [0.3, 0.95];
/// Iterations in which the solution is taken to be near. Before them it may be far; after them the
/// fall is too steep for the tangent, and the flatter slope creeps to a solution instead.
const NEAR: std::ops::RangeInclusive<usize> = 6..=12;

/// Iterations before which the inverse of an earlier iteration may serve, while slopes are near.
const CHORDS: usize = 4;
/// Change of a slope, as a share of the node's resistance, over which an inverse still serves.
const SAME_SLOPE: f64 = 0.25;
/// Ratio of a change to the one before, above which the inverse is made anew.
const SLOW: f64 = 0.2;

/// A direction and the buffers to find it.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    /// Change of the contact velocities \[m/s\], padded.
    direction: Aligned,
    /// v − v_free \[m/s\], padded.
    difference: Aligned,
    /// f_n + (assumed slope)·(v − v_free)_n \[N\].
    normal: Aligned,
    /// B d_t \[N\] and Pᵀ d_t \[m/s\].
    of_tangential: Aligned,
    /// P φ \[N\] and A⁻¹ φ \[m/s\].
    of_normal: Aligned,
    /// What is left of the tangential balance, with the other sign \[N\].
    residual: Aligned,
    diagonal: Aligned,
    matrix: Aligned,
    /// K⁻¹, column by column, for the slopes in `slopes`; see [`Self::renew_inverse`].
    inverse: Aligned,
    known: bool,
    /// No tangent is steeper than the first of [`STEEPEST_FALL`], in all iterations.
    gentle: bool,
    compact: Aligned,
    /// −∂f/∂v per node in the block's frame: xx, xz, zx, zz \[N s/m\].
    slopes: Vec<[f64; 4]>,
    nodes: usize,
}

impl Newton {
    pub(super) fn new(linear: &Linear) -> Self {
        let (nodes, stride) = (linear.nodes, linear.stride);
        Self {
            direction: Aligned::zeros(2 * stride),
            difference: Aligned::zeros(2 * stride),
            normal: Aligned::zeros(stride),
            of_tangential: Aligned::zeros(2 * stride),
            of_normal: Aligned::zeros(2 * stride),
            residual: Aligned::zeros(stride),
            diagonal: Aligned::zeros(stride),
            matrix: Aligned::zeros(4 * nodes * nodes),
            inverse: Aligned::zeros(nodes * stride),
            known: false,
            gentle: false,
            compact: Aligned::zeros(2 * nodes),
            slopes: vec![[0.0; 4]; stride],
            nodes,
        }
    }

    /// The inverse is made anew before it is used again.
    pub(super) fn forget(&mut self) {
        self.known = false;
    }

    /// Creeps to a solution that the tangent misses: slowly, but its matrix is always positive definite.
    pub(super) fn set_gentle(&mut self, gentle: bool) {
        self.gentle = gentle;
        self.known = false;
    }

    /// Largest fall that the direction of an iteration follows, as a share of the block's resistance.
    #[inline(always)]
    fn steepest_fall(&self, iteration: usize) -> f64 {
        STEEPEST_FALL[usize::from(!self.gentle && NEAR.contains(&iteration))]
    }

    /// Keeps K⁻¹ = (B + g − c Pᵀ)⁻¹ for the slopes as they stand, unless it holds for slopes that
    /// are near enough; `false` if K is not positive definite.
    #[inline(always)]
    fn renew_inverse(
        &mut self,
        m: &FlatMatrices,
        t: &Traction,
        iteration: usize,
        slow: bool,
    ) -> bool {
        let steepest_fall = self.steepest_fall(iteration);
        let stride = self.residual.len();
        let mut near = self.known && iteration < CHORDS && !slow;
        for i in 0..self.nodes {
            // A falling characteristic is not followed: its tangent would overshoot.
            let own = m.by_tangential[i * 2 * stride + i];
            let slope = t.slip_slope[i].max(-steepest_fall * own);
            near &= (slope - self.slopes[i][0]).abs() <= SAME_SLOPE * (own + slope);
            self.diagonal[i] = slope;
        }
        if near {
            return true;
        }
        self.known = false;
        // Row by row the transpose: its inverse then stands column by column.
        let rows = m.by_tangential.chunks_exact(2 * stride);
        let rows = self.inverse.chunks_exact_mut(stride).zip(rows);
        for (i, (to, row)) in rows.enumerate().take(self.nodes) {
            let (b, p) = row.split_at(stride);
            for (((to, b), p), c) in to.iter_mut().zip(b).zip(p).zip(&t.coupling) {
                *to = b - c * p;
            }
            to[i] += self.diagonal[i];
            self.slopes[i] = [self.diagonal[i], t.coupling[i], 0.0, m.normal_slope[i]];
        }
        self.known = gauss_jordan::invert_rows(&mut self.inverse, self.nodes);
        self.known
    }
}

impl Stage {
    /// With d = v − v_free, φ = f_n + G₀ d_n and e = A⁻¹ φ − d_n − Pᵀ d_t:
    /// (B + g − c Pᵀ) δ_t = f_t − B d_t − P φ − c e, then δ_n = e − Pᵀ δ_t, where −g and −c are the
    /// slopes of the tangential forces by the tangential and the normal speed (theory eq. 3.9).
    #[inline(always)]
    pub(super) fn flat_direction(
        &mut self,
        m: &FlatMatrices,
        iteration: usize,
        changes: [f64; 2],
    ) -> bool {
        let n = &mut self.newton;
        let (stride, t) = (self.slip.len(), &self.traction);
        if !n.renew_inverse(m, t, iteration, changes[1] > SLOW * changes[0]) {
            return false;
        }
        for ((d, v), free) in n.difference.iter_mut().zip(&self.v).zip(&self.v_free) {
            *d = v - free;
        }
        let (d_t, d_n) = n.difference.split_at(stride);
        for i in 0..stride {
            n.normal[i] = t.normal[i] + m.normal_slope[i] * d_n[i];
        }
        self.force[..stride].copy_from_slice(&t.tangential);
        self.force[stride..].copy_from_slice(&t.normal);
        // B d_t and Pᵀ d_t, P φ and A⁻¹ φ.
        for product in [&mut n.of_tangential, &mut n.of_normal] {
            product.fill(0.0);
        }
        dense::add_columns(&mut n.of_tangential, &m.by_tangential, &d_t[..n.nodes]);
        dense::add_columns(&mut n.of_normal, &m.by_normal, &n.normal[..n.nodes]);
        let (direction_t, direction_n) = n.direction.split_at_mut(stride);
        let (b_d, p_d) = n.of_tangential.split_at(stride);
        let (p_phi, a_phi) = n.of_normal.split_at(stride);
        for i in 0..stride {
            // The normal change if the tangential one were none.
            direction_n[i] = a_phi[i] - d_n[i] - p_d[i];
            let pull = n.slopes[i][1] * direction_n[i];
            n.residual[i] = -(t.tangential[i] - b_d[i] - p_phi[i] - pull);
        }
        // −δ_t, since −Pᵀ δ_t is what is added to the normal change.
        direction_t.fill(0.0);
        dense::add_columns(direction_t, &n.inverse, &n.residual[..n.nodes]);
        let steps = &direction_t[..n.nodes];
        dense::add_lower_columns(direction_n, &m.by_tangential, steps, stride);
        for x in direction_t.iter_mut() {
            *x = -*x;
        }
        true
    }

    /// (S + G) δ = f − S (v − v_free) with the full matrix of the turned block.
    pub(super) fn full_direction(
        &mut self,
        matrices: &StageMatrices,
        motion: &Kinematics,
        iteration: usize,
    ) -> bool {
        let n = &mut self.newton;
        let steepest_fall = n.steepest_fall(iteration);
        n.forget();
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
        let mut change = 0.0;
        for i in 0..n.nodes {
            let most = larger(direction_x[i].abs(), direction_z[i].abs());
            change = larger(most, change);
        }
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

/// The larger of two numbers, where neither is NaN.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}
