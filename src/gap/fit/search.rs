//! A search that does not descend: where limit cycles jump, an optimum that Levenberg-Marquardt ends in is one of many.

use super::{evaluate, to_the_end, Fit, FARTHEST};
use crate::gap::problem::Bench;
use cmaes::{CMAESOptions, DVector};

/// Points that are looked at.
const POINTS: usize = 800;
/// Points of a generation.
const GENERATION: usize = 16;
/// Standard deviation of the first generation, in whitened parameters.
const WIDTH: f64 = 0.3;
/// Objective of a point per square of its distance from the box that parameters are kept in.
const OUTSIDE: f64 = 10.0;
/// Rounds of the descent from the best point.
const ROUNDS: usize = 6;

/// The best of `fit`, of what evolution with an adapted covariance matrix finds around it (Hansen and Ostermeier, Evol.
/// Comput. 9, 2001), and of the descent from there. The same whatever the number of threads.
pub fn search(bench: &Bench, fit: Fit, of: &[usize]) -> Fit {
    let cost = |x: &[f64]| {
        let near = inside(x);
        let off: f64 = x.iter().zip(&near).map(|(a, b)| (a - b) * (a - b)).sum();
        evaluate(bench, &fit.added, near, of).objective + OUTSIDE * off
    };
    let Some(best) = evolve(&cost, &fit.x, POINTS) else { return fit };
    let found = evaluate(bench, &fit.added, inside(&best), of);
    fit.or_better(to_the_end(bench, found, of, ROUNDS))
}

/// The nearest point of the box that parameters are kept in.
fn inside(x: &[f64]) -> Vec<f64> {
    x.iter().map(|v| v.clamp(-FARTHEST, FARTHEST)).collect()
}

/// The lowest of so many `points` around `start`, looked at side by side.
fn evolve(cost: &(dyn Fn(&[f64]) -> f64 + Sync), start: &[f64], points: usize) -> Option<Vec<f64>> {
    let cost = |x: &DVector<f64>| cost(x.as_slice());
    let options = CMAESOptions::new(start.to_vec(), WIDTH).population_size(GENERATION);
    let mut evolution = options.max_function_evals(points).seed(1).build(cost).ok()?;
    evolution.run_parallel().overall_best.map(|best| best.point.as_slice().to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_rippled_bowl_is_found() {
        // Closed form: 0 at the centre. The start lies three ripples of 0.2 away, and every ripple has an optimum of its
        // own: |slope of the bowl| at most 2·0.7 there, of the ripples 0.1·2π/0.2 = 3.1.
        let centre = [0.4, -0.3, 0.1, 0.6];
        let cost = |x: &[f64]| {
            let of = |(x, c): (&f64, &f64)| {
                let d = x - c;
                d * d + 0.1 * (1.0 - (std::f64::consts::TAU * d / 0.2).cos())
            };
            x.iter().zip(&centre).map(of).sum::<f64>()
        };
        let start = centre.map(|c| c + 0.6);
        let found = evolve(&cost, &start, POINTS).unwrap();
        assert!(cost(&start) > 1.4 && cost(&found) < 0.05, "{} {}", cost(&start), cost(&found));
    }

    #[test]
    fn a_search_says_the_same_twice() {
        let cost = |x: &[f64]| x.iter().map(|v| (v - 0.2) * (v - 0.2)).sum::<f64>();
        let [a, b] = [0, 1].map(|_| evolve(&cost, &[0.0; 3], 160).unwrap());
        assert_eq!(a, b);
    }
}
