//! The Newton direction with the full matrix: of a block that is turned against the road, whose normal and tangential
//! velocities do not part, and of one whose contact is damped, with slopes that differ from node to node.

use super::dense;
use super::kinematics::Kinematics;
use super::matrices::StageMatrices;
use super::newton::{Changes, STEEPEST_FALL};
use super::stage::Stage;

impl Stage {
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
}
