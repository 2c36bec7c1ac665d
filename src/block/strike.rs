//! A blow on the free block, and where the clamped face stands against its prescribed motion.

use super::TreadBlock;

impl TreadBlock {
    /// Strikes the block: adds the velocity `speed` · (1 − y/h) along the road, y from the tread face
    /// and h the height, to every point of the rubber at once (the measured ring-down begins so).
    ///
    /// Modal velocities follow by projection with the mass matrix, w += Φᵀ M v. Meant for a block
    /// that does not touch the road: friction is not asked.
    pub fn strike(&mut self, speed: f64) {
        let scale = (self.params.rubber.density * self.params.block.width).sqrt();
        for m in 0..self.reduction.modes() {
            let added = speed * scale * self.reduction.shear_coupling[m];
            self.state.w[m] += added;
            self.state.dw[m] -= self.linear.damping * self.linear.omega2[m] * added;
        }
        self.integrator.start_afresh();
        self.observe();
    }
}
