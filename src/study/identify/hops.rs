//! Global search by hops: from the end of a local search along the directions that the table hardly pins down, and
//! down again.
//!
//! Random starts are hopeless: two per cent more friction make silent cells vibrate, while other directions may be
//! followed through a quarter of the range at no price. The Jacobian at an end knows which is which.

use nalgebra::SymmetricEigen;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::gauss_newton::{improve, Local};
use super::objective::Problem;

/// Ends that are hopped from.
const KEPT: usize = 8;
/// Length of the residuals' change that a hop expects of each direction.
const PRICE: f64 = 0.025;
/// Standard deviation of a hop along a direction that changes nothing, in unit intervals.
const FARTHEST: f64 = 0.125;
/// A hop between ends goes this share of the way from one to another.
const SHARE: f64 = 0.6;
/// Places drawn before a hop is followed even if it looks hopeless.
const DRAWS: usize = 20;

/// The best ends so far, the best first.
pub struct Hops {
    ends: Vec<(f64, Local)>,
    rng: ChaCha8Rng,
}

impl Hops {
    /// A search that begins at `first`.
    pub fn new(first: Local, seed: u64) -> Self {
        let mut out = Self { ends: Vec::new(), rng: ChaCha8Rng::seed_from_u64(seed) };
        out.arrive(first);
        out
    }

    /// The best end and its cost.
    pub fn best(&self) -> (&Local, f64) {
        let (cost, local) = &self.ends[0];
        (local, *cost)
    }

    /// One hop, and a local search of `rounds` rounds from where it leads.
    pub fn hop(&mut self, problem: &Problem<'_>, rounds: usize) {
        let hopeless = 2.0 * self.ends[0].0 + 20.0;
        let mut x = self.place();
        for _ in 1..DRAWS {
            if Problem::cost(&problem.residuals(&x), &x) < hopeless {
                break;
            }
            x = self.place();
        }
        self.arrive(improve(problem, x, rounds, |_, _| {}));
    }

    fn arrive(&mut self, local: Local) {
        let cost = Problem::cost(&local.residuals, &local.x);
        self.ends.push((cost, local));
        self.ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.ends.truncate(KEPT);
    }

    /// Where a hop leads: better ends are left more often.
    fn place(&mut self) -> Vec<f64> {
        let count = self.ends.len();
        let rank = self.rng.random::<f64>() * self.rng.random::<f64>() * count as f64;
        let from = &self.ends[rank as usize].1;
        let mut x = from.x.clone();
        if count > 3 && self.rng.random_bool(0.3) {
            let [a, b] = [(); 2].map(|()| &self.ends[self.rng.random_range(0..count)].1.x);
            for (x, (a, b)) in x.iter_mut().zip(a.iter().zip(b)) {
                *x += SHARE * (a - b);
            }
        } else {
            let eigen = SymmetricEigen::new(from.normal());
            for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter())
            {
                let normal: f64 = StandardNormal.sample(&mut self.rng);
                let length = normal * (PRICE / value.max(1e-9).sqrt()).min(FARTHEST);
                x.iter_mut().zip(direction.iter()).for_each(|(x, d)| *x += length * d);
            }
        }
        x.iter().map(|x| x.clamp(0.0, 1.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn a_hop_goes_far_only_where_the_residuals_hardly_change() {
        // Residuals 5 x₀ and 0.01 x₁: expected lengths 0.025/5 = 0.005 and, bounded, 0.125.
        let jacobian = DMatrix::from_row_slice(2, 2, &[5.0, 0.0, 0.0, 0.01]);
        let end = Local { x: vec![0.5, 0.5], residuals: vec![0.1, 0.1], jacobian };
        let mut hops = Hops::new(end, 1);
        let spread = |at: usize, places: &[Vec<f64>]| {
            (places.iter().map(|x| (x[at] - 0.5).powi(2)).sum::<f64>() / places.len() as f64).sqrt()
        };
        let places: Vec<_> = (0..400).map(|_| hops.place()).collect();
        assert!((spread(0, &places) / 0.005 - 1.0).abs() < 0.15);
        assert!((spread(1, &places) / 0.125 - 1.0).abs() < 0.15);
    }
}
