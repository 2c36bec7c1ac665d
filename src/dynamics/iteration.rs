//! The Newton iteration of a stage: which direction it takes, how far it goes, and when it stops.

use super::full::full_direction;
use super::kinematics::Kinematics;
use super::matrices::StageMatrices;
use super::stage::Stage;
use crate::contact::Face;
use crate::pack::{Aligned, Pack};

/// How the Newton iteration of a stage went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Iterations done.
    pub iterations: usize,
    /// Last change of a velocity \[m/s\], of a node that sticks.
    pub change: f64,
    /// Did it converge?
    pub converged: bool,
}

/// Iterations after which a stage is given up and the step made smaller.
const MAX_ITERATIONS: usize = 150;
/// Iterations after which the full Newton matrix is used.
const FLAT_ITERATIONS: usize = 12;
/// Share of the sliding speed that adds to the smoothing speed where a change is judged: friction changes over
/// the smoothing speed where a node sticks and over decades of speed where it slips.
const SLIP_SHARE: f64 = 0.1;

impl Stage {
    /// Newton's method on the contact velocities: S (v − v_free) = f(v).
    #[inline(always)]
    pub(super) fn iterate(
        &mut self,
        n: usize,
        face: &Face,
        matrices: &StageMatrices,
        motion: &Kinematics,
        factor: &Aligned,
    ) -> Convergence {
        let mut convergence = Convergence { iterations: 0, change: 0.0, converged: true };
        let mut guess_left = true;
        let mut changes = [f64::INFINITY; 2];
        loop {
            let highest = self.evaluate(n, face, matrices.a, motion, factor);
            if convergence.iterations == 0 && highest <= 0.0 {
                if !guess_left {
                    // The road is out of reach altogether.
                    self.force.fill(0.0);
                    return convergence;
                }
                guess_left = false;
                self.v.copy_from_slice(&self.v_free);
                continue;
            }
            convergence.iterations += 1;
            // The elimination of the normal velocities converges fast where the contact is as
            // stiff as it assumes; where it does not, the full matrix serves.
            let iteration = convergence.iterations;
            let solved = if iteration <= FLAT_ITERATIONS {
                self.flat_direction(n, &matrices.flat, motion, iteration, changes)
            } else {
                full_direction(self, matrices, motion, iteration, changes)
            };
            if !solved {
                convergence.converged = false;
                return convergence;
            }
            changes = [changes[1], self.change(n, face.smoothing_speed)];
            convergence.change = changes[1] * face.smoothing_speed;
            let near = self.newton.error_after(iteration, changes) < self.newton.accuracy;
            self.take_direction(n, motion, near);
            if near {
                return convergence;
            }
            if iteration == MAX_ITERATIONS {
                convergence.converged = false;
                return convergence;
            }
        }
    }

    /// Largest change of a velocity that the direction asks for, as a share of the speed over which friction
    /// changes: `smoothing_speed` \[m/s\] where a node sticks, more where it slips.
    #[inline(always)]
    fn change(&mut self, n: usize, smoothing_speed: f64) -> f64 {
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
    fn take_direction(&mut self, n: usize, motion: &Kinematics, whole: bool) {
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
