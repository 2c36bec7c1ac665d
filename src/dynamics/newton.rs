//! The Newton direction with the normal velocities eliminated, and what directions share.

use super::flat::{turn, FlatMatrices, Turn};
use super::kept_inverse::{Closeness, KeptInverse};
use super::kinematics::Kinematics;
use super::linear::Linear;
use super::stage::Stage;
use super::{dense, elimination};
use crate::contact::Traction;
use crate::pack::{larger, Aligned, Pack, LANES};

/// Largest fall of friction with speed that a direction follows, as a share of the block's own
/// resistance: far from the solution the tangent of a steeper fall overshoots, near it only the
/// tangent converges fast.
pub(super) const STEEPEST_FALL: [f64; 2] = [0.3, 0.95];
/// Last change, as a share of the smoothing speed, below which the solution is taken to be near, if changes fall.
const NEAR_CHANGE: f64 = 3.0;
/// Iterations in which the solution is taken to be near in any case. After them the fall is too steep for the
/// tangent, and the flatter slope creeps to a solution instead.
const NEAR: std::ops::RangeInclusive<usize> = 6..=12;

/// Iterations before which an inverse for slopes that are only near may serve.
const CHORDS: usize = 4;
/// Estimated error of the velocities at which Newton's method stops, as a share of the speed over which friction
/// changes: least and largest. A tenth of the least moves the independent solutions by less than what a change of
/// friction by a millionth does.
const ACCURACY: [f64; 2] = [3e-3, 3e-2];
/// The same as a share of the error that a step may have.
const ACCURACY_OF_STEP: f64 = 0.6;
/// Changes are not taken to shrink more slowly than this.
const WORST_CONTRACTION: f64 = 0.9;
/// Ratio of a change to the one before, above which the inverse has to be closer.
const SLOW: f64 = 0.2;
/// Last two changes of a stage's velocities, as shares of the speed over which friction changes: the last but one
/// and the last.
pub(super) type Changes = [f64; 2];

/// A direction and the buffers to find it; vectors per node are padded to full packs.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    /// Change of the contact velocities \[m/s\].
    pub(super) direction: Aligned,
    /// v − v_free \[m/s\].
    pub(super) difference: Aligned,
    /// f_n + (assumed slope)·(v − v_free)_n \[N\].
    pub(super) normal: Aligned,
    /// B d_t \[N\] and Pᵀ d_t \[m/s\].
    pub(super) of_tangential: Aligned,
    /// The same of −δ_t.
    pub(super) of_step: Aligned,
    /// P φ \[N\] and A⁻¹ φ \[m/s\].
    pub(super) of_normal: Aligned,
    /// What is left of the tangential balance, with the other sign \[N\].
    pub(super) residual: Aligned,
    /// −∂(tangential)/∂(tangential speed) that the direction follows \[N s/m\].
    pub(super) followed: Aligned,
    /// Full matrix and right-hand side, row by row, see [`elimination::solve_rows`].
    pub(super) matrix: Aligned,
    pub(super) inverse: KeptInverse,
    /// Changes shrink by this factor per iteration, as far as is known \[-\].
    pub(super) contraction: f64,
    /// Estimated error at which the iteration stops, as a share of the speed over which friction changes \[-\].
    pub(super) accuracy: f64,
    /// No tangent is steeper than the first of [`STEEPEST_FALL`], in all iterations.
    pub(super) gentle: bool,
    /// Solution with the full matrix, without padding between x and z.
    pub(super) compact: Aligned,
    /// −∂f/∂v per node in the block's frame: xx, xz, zx, zz \[N s/m\].
    pub(super) slopes: [Aligned; 4],
    /// The largest of each eight, where it is looked for.
    pub(super) most: Pack,
    /// 1 per node, 0 in the padding.
    pub(super) inside: Aligned,
    pub(super) nodes: usize,
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
            matrix: Aligned::zeros(2 * nodes * elimination::width(2 * nodes) * LANES),
            inverse: KeptInverse::new(nodes, stride),
            contraction: WORST_CONTRACTION,
            accuracy: ACCURACY[0],
            gentle: false,
            compact: Aligned::zeros(elimination::width(2 * nodes) * LANES),
            slopes: [row(), row(), row(), row()],
            most: Pack::default(),
            inside: Aligned::padded(&vec![1.0; nodes], stride, 0.0),
            nodes,
        }
    }

    /// The iteration need not be closer than steps of `tolerance`, the error of a step over the scale of the motion.
    pub(super) fn serve(&mut self, tolerance: f64) {
        self.accuracy = (ACCURACY_OF_STEP * tolerance).clamp(ACCURACY[0], ACCURACY[1]);
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
            self.contraction =
                if measured < WORST_CONTRACTION { measured } else { WORST_CONTRACTION };
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
    pub(super) fn near(&self, iteration: usize, [before, last]: Changes) -> bool {
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
        let slow = iteration >= CHORDS || changes[1] > SLOW * changes[0];
        let closeness = Closeness { slow, early: self.accuracy > ACCURACY[0] };
        let near = self.near(iteration, changes);
        self.follow(n, m, t, STEEPEST_FALL[usize::from(near)]);
        let coupling = t.coupling.packs();
        if self.inverse.fit(n, m, self.followed.packs(), coupling, closeness) {
            return true;
        }
        // Many nodes that fall together resist less than each alone.
        self.follow(n, m, t, STEEPEST_FALL[0]);
        self.inverse.forget();
        near && self.inverse.fit(n, m, self.followed.packs(), coupling, closeness)
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
    ///
    /// All in the frame of the split, from which the road's may be turned by so little that its slopes serve.
    #[inline(always)]
    pub(super) fn flat_direction(
        &mut self,
        n: usize,
        m: &FlatMatrices,
        motion: &Kinematics,
        iteration: usize,
        changes: Changes,
    ) -> bool {
        if !self.newton.prepare(n, m, &self.traction, iteration, changes) {
            return false;
        }
        let frame = m.turn(motion);
        self.enter_frame(n, m, frame.as_ref());
        let (newton, force) = (&mut self.newton, &self.force.packs()[..2 * n]);
        let difference = &newton.difference.packs()[..2 * n];
        // B d_t and Pᵀ d_t, P φ and A⁻¹ φ.
        let of_tangential = &mut newton.of_tangential.packs_mut()[..2 * n];
        let of_normal = &mut newton.of_normal.packs_mut()[..2 * n];
        dense::multiply(of_tangential, m.by_tangential.packs(), &difference[..n]);
        dense::multiply(of_normal, m.by_normal.packs(), &newton.normal.packs()[..n]);
        let coupling = &self.traction.coupling.packs()[..n];
        let residual = &mut newton.residual.packs_mut()[..n];
        let direction_n = &mut newton.direction.packs_mut()[n..2 * n];
        for k in 0..n {
            // The normal change if the tangential one were none.
            direction_n[k] = of_normal[n + k] - difference[n + k] - of_tangential[n + k];
            let left = force[k] - of_tangential[k] - of_normal[k];
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
        self.leave_frame(n, m, frame.as_ref());
        true
    }

    /// v − v_free, the tractions (as `force`) and φ, in the frame of the split.
    #[inline(always)]
    fn enter_frame(&mut self, n: usize, m: &FlatMatrices, frame: Option<&Turn>) {
        let (newton, t) = (&mut self.newton, &self.traction);
        let (v, v_free) = (&self.v.packs()[..2 * n], &self.v_free.packs()[..2 * n]);
        let (tangential, f_n) = (&t.tangential.packs()[..n], &t.normal.packs()[..n]);
        let normal_slope = &m.normal_slope.packs()[..n];
        let difference = &mut newton.difference.packs_mut()[..2 * n];
        let force = &mut self.force.packs_mut()[..2 * n];
        for k in 0..n {
            difference[k] = v[k] - v_free[k];
            difference[n + k] = v[n + k] - v_free[n + k];
            (force[k], force[n + k]) = (tangential[k], f_n[k]);
        }
        if let Some(frame) = frame {
            turn(difference, n, frame.of_block);
            turn(force, n, frame.of_road);
        }
        let normal = &mut newton.normal.packs_mut()[..n];
        for k in 0..n {
            normal[k] = normal_slope[k].mul_add(difference[n + k], force[n + k]);
        }
    }

    /// The whole direction, and what the linear equations make of the forces at its end, f_t = B d_t + P φ, in the
    /// block's frame.
    #[inline(always)]
    fn leave_frame(&mut self, n: usize, m: &FlatMatrices, frame: Option<&Turn>) {
        let newton = &mut self.newton;
        let direction = &mut newton.direction.packs_mut()[..2 * n];
        let (of_tangential, of_normal) =
            (&newton.of_tangential.packs()[..n], &newton.of_normal.packs()[..n]);
        let of_step = &newton.of_step.packs()[..2 * n];
        let normal_slope = &m.normal_slope.packs()[..n];
        let force = &mut self.force.packs_mut()[..2 * n];
        for k in 0..n {
            direction[n + k] += of_step[n + k];
            force[k] = of_tangential[k] + of_normal[k] - of_step[k];
            force[n + k] = force[n + k] - normal_slope[k] * direction[n + k];
            direction[k] = -direction[k];
        }
        if let Some(frame) = frame {
            turn(direction, n, frame.back());
            turn(force, n, frame.back());
        }
    }
}
