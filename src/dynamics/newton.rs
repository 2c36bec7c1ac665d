//! Newton directions for the contact velocities of a stage, in two forms: with the normal velocities
//! eliminated for a block that is not turned, and with the full matrix for all else.

use super::kinematics::Kinematics;
use super::linear::Linear;
use super::matrices::{FlatMatrices, StageMatrices};
use super::stage::Stage;
use super::dense;
use super::kept_inverse::KeptInverse;
use crate::contact::Traction;
use crate::pack::{larger, Aligned, Pack};

/// Largest fall of friction with speed that a direction follows, as a share of the block's own
/// resistance: far from the solution the tangent of a steeper fall overshoots, near it only the
/// tangent converges fast.
const STEEPEST_FALL: [f64; 2] = [0.3, 0.95];
/// Last change, as a share of the smoothing speed, below which the solution is taken to be near, if changes fall.
const NEAR_CHANGE: f64 = 3.0;
/// Iterations in which the solution is taken to be near in any case. After them the fall is too steep for the
/// tangent, and the flatter slope creeps to a solution instead.
const NEAR: std::ops::RangeInclusive<usize> = 6..=12;

/// Iterations before which an inverse for slopes that are only near may serve.
const CHORDS: usize = 4;
/// Changes are not taken to shrink more slowly than this.
const WORST_CONTRACTION: f64 = 0.9;
/// Ratio of a change to the one before, above which the inverse has to be closer.
const SLOW: f64 = 0.2;
/// Share of the sliding speed that adds to the smoothing speed where a change is judged: friction changes over
/// the smoothing speed where a node sticks and over decades of speed where it slips.
const SLIP_SHARE: f64 = 0.1;

/// Last two changes of a stage's velocities, as shares of the speed over which friction changes: the last but one
/// and the last.
pub(super) type Changes = [f64; 2];

/// A direction and the buffers to find it; vectors per node are padded to full packs.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    /// Change of the contact velocities \[m/s\].
    direction: Aligned,
    /// v − v_free \[m/s\].
    difference: Aligned,
    /// f_n + (assumed slope)·(v − v_free)_n \[N\].
    normal: Aligned,
    /// B d_t \[N\] and Pᵀ d_t \[m/s\].
    of_tangential: Aligned,
    /// The same of −δ_t.
    of_step: Aligned,
    /// P φ \[N\] and A⁻¹ φ \[m/s\].
    of_normal: Aligned,
    /// What is left of the tangential balance, with the other sign \[N\].
    residual: Aligned,
    /// −∂(tangential)/∂(tangential speed) that the direction follows \[N s/m\].
    followed: Aligned,
    matrix: Aligned,
    inverse: KeptInverse,
    /// Changes shrink by this factor per iteration, as far as is known \[-\].
    pub(super) contraction: f64,
    /// No tangent is steeper than the first of [`STEEPEST_FALL`], in all iterations.
    gentle: bool,
    compact: Aligned,
    /// −∂f/∂v per node in the block's frame: xx, xz, zx, zz \[N s/m\].
    slopes: [Aligned; 4],
    /// The largest of each eight, where it is looked for.
    most: Pack,
    /// 1 per node, 0 in the padding.
    inside: Aligned,
    nodes: usize,
}

impl Newton {
    pub(super) fn new(linear: &Linear) -> Self {
        let (nodes, stride) = (linear.nodes, linear.stride);
        let row = || Aligned::zeros(stride);
        Self {
            direction: Aligned::zeros(2 * stride),
            difference: Aligned::zeros(2 * stride),
            normal: row(),
            of_tangential: Aligned::zeros(2 * stride),
            of_step: Aligned::zeros(2 * stride),
            of_normal: Aligned::zeros(2 * stride),
            residual: row(),
            followed: row(),
            matrix: Aligned::zeros(4 * nodes * nodes),
            inverse: KeptInverse::new(nodes, stride),
            contraction: WORST_CONTRACTION,
            gentle: false,
            compact: Aligned::zeros(2 * nodes),
            slopes: [row(), row(), row(), row()],
            most: Pack::default(),
            inside: Aligned::padded(&vec![1.0; nodes], stride, 0.0),
            nodes,
        }
    }

    /// The inverse is made anew before it is used again.
    pub(super) fn forget(&mut self) {
        self.inverse.forget();
    }

    /// What a stage carries to the next one, as numbers.
    pub(super) fn save(&self, out: &mut Vec<f64>) {
        out.push(self.contraction);
        self.inverse.save(out);
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None` if there is too little.
    pub(super) fn restore<'a>(&mut self, from: &'a [f64]) -> Option<&'a [f64]> {
        let (contraction, rest) = from.split_first()?;
        self.contraction = contraction.clamp(0.0, WORST_CONTRACTION);
        self.inverse.restore(rest)
    }

    /// Estimated error after a change, from how changes shrink (Hairer and Wanner, Solving ODEs II, IV.8); the
    /// first change of a stage is judged by the stage before.
    pub(super) fn error_after(&mut self, iteration: usize, changes: Changes) -> f64 {
        if iteration > 1 {
            // One good pair of changes does not make a contraction.
            let measured = larger(changes[1] / changes[0], 0.3 * self.contraction);
            self.contraction = if measured < WORST_CONTRACTION { measured } else { WORST_CONTRACTION };
        }
        changes[1] * self.contraction / (1.0 - self.contraction)
    }

    /// Creeps to a solution that the tangent misses: slowly, but its matrix is always positive definite.
    pub(super) fn set_gentle(&mut self, gentle: bool) {
        self.gentle = gentle;
        self.forget();
    }

    /// Is the solution near, so that the direction may follow the tangent of a falling characteristic?
    #[inline(always)]
    fn near(&self, iteration: usize, [before, last]: Changes) -> bool {
        let falling = iteration == 1 || (last < NEAR_CHANGE && last < before);
        !self.gentle && (NEAR.contains(&iteration) || (falling && iteration < *NEAR.start()))
    }

    /// Slopes that the direction follows and an inverse that serves for them; `false` if the matrix is not
    /// positive definite.
    #[inline(always)]
    fn prepare(
        &mut self,
        n: usize,
        m: &FlatMatrices,
        t: &Traction,
        iteration: usize,
        changes: Changes,
    ) -> bool {
        let close = iteration >= CHORDS || changes[1] > SLOW * changes[0];
        let near = self.near(iteration, changes);
        self.follow(n, m, t, STEEPEST_FALL[usize::from(near)]);
        let coupling = t.coupling.packs();
        if self.inverse.fit(n, m, self.followed.packs(), coupling, close) {
            return true;
        }
        // Many nodes that fall together resist less than each alone.
        self.follow(n, m, t, STEEPEST_FALL[0]);
        self.inverse.forget();
        near && self.inverse.fit(n, m, self.followed.packs(), coupling, true)
    }

    /// Slopes but for a fall steeper than `steepest`, as a share of the node's resistance: the tangent of a
    /// characteristic that falls too fast overshoots.
    #[inline(always)]
    fn follow(&mut self, n: usize, m: &FlatMatrices, t: &Traction, steepest: f64) {
        let steepest = Pack::splat(-steepest);
        let (own, slope) = (&m.resistance.packs()[..n], &t.slip_slope.packs()[..n]);
        let followed = &mut self.followed.packs_mut()[..n];
        for k in 0..n {
            followed[k] = slope[k].max(steepest * own[k]);
        }
    }
}

impl Stage {
    /// With d = v − v_free, φ = f_n + G₀ d_n and e = A⁻¹ φ − d_n − Pᵀ d_t:
    /// (B + g − c Pᵀ) δ_t = f_t − B d_t − P φ − c e, then δ_n = e − Pᵀ δ_t, where −g and −c are the
    /// slopes of the tangential forces by the tangential and the normal speed (theory eq. 3.9).
    #[inline(always)]
    pub(super) fn flat_direction(
        &mut self,
        n: usize,
        m: &FlatMatrices,
        iteration: usize,
        changes: Changes,
    ) -> bool {
        let (newton, t) = (&mut self.newton, &self.traction);
        if !newton.prepare(n, m, t, iteration, changes) {
            return false;
        }
        let (v, v_free) = (&self.v.packs()[..2 * n], &self.v_free.packs()[..2 * n]);
        let (tangential, f_n) = (&t.tangential.packs()[..n], &t.normal.packs()[..n]);
        let normal_slope = &m.normal_slope.packs()[..n];
        let difference = &mut newton.difference.packs_mut()[..2 * n];
        let normal = &mut newton.normal.packs_mut()[..n];
        for k in 0..n {
            difference[k] = v[k] - v_free[k];
            difference[n + k] = v[n + k] - v_free[n + k];
            normal[k] = normal_slope[k].mul_add(difference[n + k], f_n[k]);
        }
        // B d_t and Pᵀ d_t, P φ and A⁻¹ φ.
        let of_tangential = &mut newton.of_tangential.packs_mut()[..2 * n];
        let of_normal = &mut newton.of_normal.packs_mut()[..2 * n];
        dense::multiply(of_tangential, m.by_tangential.packs(), &difference[..n]);
        dense::multiply(of_normal, m.by_normal.packs(), normal);
        let coupling = &t.coupling.packs()[..n];
        let residual = &mut newton.residual.packs_mut()[..n];
        let direction_n = &mut newton.direction.packs_mut()[n..2 * n];
        for k in 0..n {
            // The normal change if the tangential one were none.
            direction_n[k] = of_normal[n + k] - difference[n + k] - of_tangential[n + k];
            let left = tangential[k] - of_tangential[k] - of_normal[k];
            residual[k] = coupling[k].mul_add(direction_n[k], -left);
        }
        newton.inverse.solve(
            n,
            m,
            &newton.followed.packs()[..n],
            coupling,
            residual,
            &mut newton.direction.packs_mut()[..n],
            &mut newton.of_step.packs_mut()[..2 * n],
        );
        // What the linear equations make of the forces: f_t = B d_t + P φ at the end of the direction.
        let (direction_t, direction_n) = newton.direction.packs_mut()[..2 * n].split_at_mut(n);
        let (of_tangential, of_normal) = (&newton.of_tangential.packs()[..n], &newton.of_normal.packs()[..n]);
        let of_step = &newton.of_step.packs()[..2 * n];
        let force = &mut self.force.packs_mut()[..2 * n];
        for k in 0..n {
            direction_n[k] += of_step[n + k];
            force[k] = of_tangential[k] + of_normal[k] - of_step[k];
            force[n + k] = f_n[k] - normal_slope[k] * direction_n[k];
            direction_t[k] = -direction_t[k];
        }
        true
    }

    /// (S + G) δ = f − S (v − v_free) with the full matrix of the turned block.
    pub(super) fn full_direction(
        &mut self,
        matrices: &StageMatrices,
        motion: &Kinematics,
        iteration: usize,
        changes: Changes,
    ) -> bool {
        let n = &mut self.newton;
        let steepest_fall = STEEPEST_FALL[usize::from(n.near(iteration, changes))];
        n.forget();
        let (nodes, stride) = (n.nodes, self.placed.slip.len());
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
            for (kept, slope) in n.slopes.iter_mut().zip(slopes) {
                kept[i] = slope;
            }
        }
        for c in 0..size {
            n.difference[c] = self.v[place(c)] - self.v_free[place(c)];
        }
        for (c, row) in matrices.inverse_delassus.chunks_exact(size).enumerate() {
            let product: f64 = row.iter().zip(&n.difference).map(|(s, d)| s * d).sum();
            n.compact[c] = self.force[place(c)] - product;
        }
        if !dense::factor(matrix, size) {
            return false;
        }
        dense::solve(matrix, &mut n.compact);
        n.direction.fill(0.0);
        for (c, step) in n.compact.iter().enumerate() {
            n.direction[place(c)] = *step;
        }
        // What the linear equations make of the forces.
        let [xx, xz, zx, zz] = &n.slopes;
        for i in 0..nodes {
            let (dx, dz) = (n.compact[i], n.compact[nodes + i]);
            self.force[i] -= xx[i] * dx + xz[i] * dz;
            self.force[stride + i] -= zx[i] * dx + zz[i] * dz;
        }
        true
    }

    /// Largest change of a velocity that the direction asks for, as a share of the speed over which friction
    /// changes: `smoothing_speed` \[m/s\] where a node sticks, more where it slips.
    #[inline(always)]
    pub(super) fn change(&mut self, n: usize, smoothing_speed: f64) -> f64 {
        let (share, smoothing) = (Pack::splat(SLIP_SHARE), Pack::splat(smoothing_speed));
        let slip = &self.placed.slip.packs()[..n];
        let (x, z) = self.newton.direction.packs()[..2 * n].split_at(n);
        let inside = &self.newton.inside.packs()[..n];
        let mut most = Pack::default();
        for k in 0..n {
            // The padding is carried along with the face, which no direction accounts for.
            let scale = slip[k].abs().mul_add(share, smoothing);
            most = most.max(inside[k] * x[k].abs().max(z[k].abs()) / scale);
        }
        // By way of memory: what ends there becomes vector instructions.
        self.newton.most = most;
        most.largest()
    }

    /// Goes along the direction; the forces are already those at its end.
    ///
    /// A tangential speed that would change its sign stops at zero: friction is concave on either
    /// side, so from there the iteration cannot overshoot again. The last step is `whole`: velocities and forces
    /// then satisfy the linear equations to rounding.
    #[inline(always)]
    pub(super) fn take_direction(&mut self, n: usize, motion: &Kinematics, whole: bool) {
        let [sin, cos] = motion.sin_cos.map(Pack::splat);
        let newton = &mut self.newton;
        let (direction_x, direction_z) = newton.direction.packs()[..2 * n].split_at(n);
        let inside = &newton.inside.packs()[..n];
        let slip = &self.placed.slip.packs()[..n];
        let (vx, vz) = self.v.packs_mut()[..2 * n].split_at_mut(n);
        let zero = Pack::default();
        for k in 0..n {
            let (mut dx, dz) = (inside[k] * direction_x[k], inside[k] * direction_z[k]);
            if !whole {
                let turned = sin * dz - slip[k];
                // Where slip · (slip + change) is negative it crosses zero.
                let after = cos.mul_add(dx, -turned);
                let stopped = if cos == Pack::splat(1.0) { turned } else { turned / cos };
                dx = (-(slip[k] * after)).if_above(zero, stopped, dx);
            }
            vx[k] += dx;
            vz[k] += dz;
        }
    }
}
