//! Covariance matrix adaptation: a global search that learns which way is down.
//!
//! Hansen, "The CMA evolution strategy: a tutorial", arXiv 1604.00772: (μ/μ_w, λ) selection, rank-one
//! and rank-μ update, cumulative step-size adaptation; names as there.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// State of a search.
pub struct Cma {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    path_c: DVector<f64>,
    path_s: DVector<f64>,
    weights: Vec<f64>,
    population: usize,
    generation: usize,
    rng: ChaCha8Rng,
    root: DMatrix<f64>,
    root_inverse: DMatrix<f64>,
}

impl Cma {
    /// Starts at `mean` with the standard deviation `sigma` in every direction.
    pub fn new(mean: &[f64], sigma: f64, population: usize, seed: u64) -> Self {
        let n = mean.len();
        let parents = population / 2;
        let raw: Vec<f64> = (0..parents)
            .map(|i| ((parents as f64 + 0.5).ln() - ((i + 1) as f64).ln()).max(0.0))
            .collect();
        let sum: f64 = raw.iter().sum();
        Self {
            mean: DVector::from_column_slice(mean),
            sigma,
            covariance: DMatrix::identity(n, n),
            path_c: DVector::zeros(n),
            path_s: DVector::zeros(n),
            weights: raw.iter().map(|w| w / sum).collect(),
            population,
            generation: 0,
            rng: ChaCha8Rng::seed_from_u64(seed),
            root: DMatrix::identity(n, n),
            root_inverse: DMatrix::identity(n, n),
        }
    }

    /// Present step size.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Candidates of the next generation.
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        let normal = StandardNormal;
        (0..self.population)
            .map(|_| {
                let z = DVector::from_fn(n, |_, _| normal.sample(&mut self.rng));
                (&self.mean + self.sigma * (&self.root * z)).as_slice().to_vec()
            })
            .collect()
    }

    /// Learns from the costs of what [`Self::ask`] gave.
    pub fn tell(&mut self, candidates: &[Vec<f64>], costs: &[f64]) {
        let n = self.mean.len() as f64;
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        let steps: Vec<DVector<f64>> = order
            .iter()
            .take(self.weights.len())
            .map(|i| (DVector::from_column_slice(&candidates[*i]) - &self.mean) / self.sigma)
            .collect();
        let mu_eff = 1.0 / self.weights.iter().map(|w| w * w).sum::<f64>();
        let c_s = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let d_s = 1.0 + c_s + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0);
        let c_c = (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu =
            (2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((n + 2.0).powi(2) + mu_eff)).min(1.0 - c_1);
        let mut shift = DVector::zeros(self.mean.len());
        for (w, y) in self.weights.iter().zip(&steps) {
            shift += *w * y;
        }
        self.mean += self.sigma * &shift;
        self.generation += 1;
        self.path_s = (1.0 - c_s) * &self.path_s
            + (c_s * (2.0 - c_s) * mu_eff).sqrt() * (&self.root_inverse * &shift);
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let length = self.path_s.norm();
        let forgotten = (1.0 - (1.0 - c_s).powi(2 * self.generation as i32)).sqrt();
        let steady = length / forgotten < (1.4 + 2.0 / (n + 1.0)) * expected;
        let h = f64::from(u8::from(steady));
        self.path_c = (1.0 - c_c) * &self.path_c + h * (c_c * (2.0 - c_c) * mu_eff).sqrt() * &shift;
        let lost = (1.0 - h) * c_c * (2.0 - c_c);
        self.covariance *= 1.0 - c_1 - c_mu + c_1 * lost;
        self.covariance += c_1 * &self.path_c * self.path_c.transpose();
        for (w, y) in self.weights.iter().zip(&steps) {
            self.covariance += c_mu * *w * y * y.transpose();
        }
        self.sigma *= ((c_s / d_s) * (length / expected - 1.0)).exp();
        self.roots();
    }

    fn roots(&mut self) {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let scaled = |power: f64| {
            let values = eigen.eigenvalues.map(|v| v.max(1e-14).powf(power));
            &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
        };
        self.root = scaled(0.5);
        self.root_inverse = scaled(-0.5);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_search_finds_the_bottom_of_a_bent_valley() {
        // Rosenbrock's function in 4 dimensions, minimum 0 at (1, 1, 1, 1).
        let cost = |x: &[f64]| -> f64 {
            x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum()
        };
        let mut search = Cma::new(&[0.0; 4], 0.3, 10, 1);
        let mut best = f64::INFINITY;
        for _ in 0..600 {
            let candidates = search.ask();
            let costs: Vec<f64> = candidates.iter().map(|x| cost(x)).collect();
            best = costs.iter().copied().fold(best, f64::min);
            search.tell(&candidates, &costs);
        }
        assert!(best < 1e-8, "{best}");
    }
}
