//! The Newton direction with the full matrix, where the eliminated system takes too many iterations: the normal slopes
//! of strongly damped contacts differ from node to node by more than what one elimination assumes.

use super::kinematics::Kinematics;
use super::matrices::StageMatrices;
use super::newton::{Changes, STEEPEST_FALL};
use super::stage::Stage;
use super::{dense, elimination};
use crate::pack::LANES;
use multiversion::multiversion;

/// [`Stage::with_full_matrix`] for the instruction set at hand.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn full_direction(
    stage: &mut Stage,
    matrices: &StageMatrices,
    motion: &Kinematics,
    iteration: usize,
    changes: Changes,
) -> bool {
    stage.with_full_matrix(matrices, motion, iteration, changes)
}

impl Stage {
    /// (S + G) δ = f − S (v − v_free) in the block's frame, whatever its angle.
    #[inline(always)]
    fn with_full_matrix(
        &mut self,
        matrices: &StageMatrices,
        motion: &Kinematics,
        iteration: usize,
        changes: Changes,
    ) -> bool {
        let (nodes, stride) = (self.newton.nodes, self.placed.slip.len());
        let size = 2 * nodes;
        let place = |c: usize| c / nodes * stride + c % nodes;
        let near = self.newton.near(iteration, changes);
        self.newton.forget();
        self.add_slopes(matrices, motion, STEEPEST_FALL[usize::from(near)]);
        let n = &mut self.newton;
        for c in 0..size {
            n.difference[c] = self.v[place(c)] - self.v_free[place(c)];
        }
        let width = elimination::width(size);
        let difference = &n.difference[..size];
        let rows = n.matrix.chunks_exact_mut(width * LANES);
        for (c, (row, s)) in rows.zip(matrices.inverse_delassus.chunks_exact(size)).enumerate() {
            row[size] = self.force[place(c)] - dense::scalar_product(s, difference);
        }
        if !elimination::solve_rows(n.matrix.packs_mut(), width, size, n.compact.packs_mut()) {
            return false;
        }
        n.direction.fill(0.0);
        for (c, step) in n.compact[..size].iter().enumerate() {
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

    /// Tractions into `force` and S + Rᵀ G R with G = \[tt tn; 0 nn\] of the road's frame into the matrix; no node falls
    /// more steeply than `steepest` times what S resists at it.
    #[inline(always)]
    fn add_slopes(&mut self, matrices: &StageMatrices, motion: &Kinematics, steepest: f64) {
        let (n, t) = (&mut self.newton, &self.traction);
        let (nodes, stride) = (n.nodes, self.placed.slip.len());
        let size = 2 * nodes;
        let [sin, cos] = motion.sin_cos;
        let s = &matrices.inverse_delassus;
        let width = elimination::width(size) * LANES;
        for (row, s) in n.matrix.chunks_exact_mut(width).zip(s.chunks_exact(size)) {
            row[..size].copy_from_slice(s);
        }
        for i in 0..nodes {
            self.force[i] = cos * t.tangential[i] + sin * t.normal[i];
            self.force[stride + i] = -sin * t.tangential[i] + cos * t.normal[i];
            let tt = t.slip_slope[i].max(-steepest * s[i * size + i]);
            let (tn, nn) = (t.coupling[i], t.approach_slope[i]);
            let (gx, gz) = (tt * cos + tn * sin, -tt * sin + tn * cos);
            let slopes = [
                cos * gx + sin * nn * sin,
                cos * gz + sin * nn * cos,
                -sin * gx + cos * nn * sin,
                -sin * gz + cos * nn * cos,
            ];
            n.matrix[i * width + i] += slopes[0];
            n.matrix[i * width + nodes + i] += slopes[1];
            n.matrix[(nodes + i) * width + i] += slopes[2];
            n.matrix[(nodes + i) * width + nodes + i] += slopes[3];
            for (kept, slope) in n.slopes.iter_mut().zip(slopes) {
                kept[i] = slope;
            }
        }
    }
}
