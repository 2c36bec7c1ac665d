//! Wear over many metres: a few cycles are simulated, their wear is extrapolated over a distance, the
//! profile is set, and so on.
//!
//! The profile obeys dw/ds = r(w), r the mean wear rate of the settled vibration of a block of the
//! profile w. Heun's method takes it forward; half the difference of its two slopes is the error of
//! the first-order result and sets the next jump.

use super::wear_laws::WearLaw;
use crate::block::Reductions;
use crate::block::{Outputs, TreadBlock, STATIONS};
use crate::error::Fault;
use crate::params::Params;
use crate::scenario::{self, Inputs, Plan, Scenario, Slide};

/// Distance of rows \[s\].
const STEP: f64 = 2e-5;
/// The vibration settles on a new profile for so long \[s\].
const SETTLE: f64 = 4e-3;
/// Wear is averaged over so long \[s\].
const WINDOW: f64 = 6e-3;

/// A block that slides and wears by a law.
pub struct Wearing<'a> {
    /// Parameters.
    pub params: &'a Params,
    /// Reductions.
    pub reductions: &'a Reductions,
    /// Wear law.
    pub law: WearLaw,
    /// Its factor, 1 for the law's own rate.
    pub factor: f64,
    /// Road speed \[m/s\].
    pub speed: f64,
    /// Mean pressure \[Pa\].
    pub pressure: f64,
    /// Friction coefficient at the reference.
    pub reference_mu: f64,
}

/// How a jump went.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Depth at the contact nodes \[m\].
    pub depth: Vec<f64>,
    /// Positions of the nodes \[m\].
    pub x: Vec<f64>,
    /// Estimated error of the depth \[m\].
    pub error: f64,
    /// Jumps made.
    pub jumps: usize,
}

impl Wearing<'_> {
    /// Wears over `distance` \[m\], every jump within `tolerance` \[m\].
    ///
    /// # Errors
    /// What stops the block.
    pub fn over(&self, distance: f64, tolerance: f64) -> Result<Worn, Fault> {
        let mut block = self.block()?;
        let nodes = block.worn().len();
        let (mut depth, mut error, mut jumps) = (vec![0.0; nodes], 0.0, 0);
        let (mut s, mut jump) = (0.0, distance / 50.0);
        let mut rate = self.rate(&mut block, &depth)?;
        while s < distance * (1.0 - 1e-9) {
            let ds = jump.min(distance - s);
            let ahead: Vec<f64> = depth.iter().zip(&rate).map(|(w, r)| w + ds * r).collect();
            let next = self.rate(&mut block, &ahead)?;
            let local =
                rate.iter().zip(&next).map(|(a, b)| 0.5 * ds * (a - b).abs()).fold(0.0, f64::max);
            jumps += 1;
            if local <= tolerance || ds < distance / 400.0 {
                for ((w, a), b) in depth.iter_mut().zip(&rate).zip(&next) {
                    *w += 0.5 * ds * (a + b);
                }
                s += ds;
                // Local errors of the second-order result are smaller by about this ratio.
                error += local * (local / tolerance).clamp(0.1, 1.0);
                rate = next;
            }
            jump = ds * (0.8 * (tolerance / local.max(1e-12)).sqrt()).clamp(0.3, 2.0);
        }
        Ok(Worn { depth, x: block.reduction().interface.x.clone(), error, jumps })
    }

    /// Wears over `distance` \[m\] in full, cycle by cycle, the profile set every `every` \[s\].
    ///
    /// # Errors
    /// What stops the block.
    pub fn brute_force(&self, distance: f64) -> Result<Worn, Fault> {
        let mut block = self.block()?;
        let x = block.reduction().interface.x.clone();
        let mut depth = vec![0.0; x.len()];
        let scenario = self.scenario();
        block.initialize(0.0, scenario.pose(0.0))?;
        let count = (distance / (self.speed * STEP)).round() as usize;
        let mut t = 0.0;
        for _ in 0..count {
            scenario::advance(&mut block, &scenario, t, t + STEP)?;
            t += STEP;
            for (w, r) in depth.iter_mut().zip(self.instant(block.outputs(), &x)) {
                *w += r * STEP;
            }
            block.set_worn(&depth);
        }
        Ok(Worn { depth, x, error: 0.0, jumps: count })
    }

    fn block(&self) -> Result<TreadBlock, Fault> {
        TreadBlock::with_reduction(self.params, self.reductions.of(self.params)?)
    }

    fn scenario(&self) -> Scenario {
        let area = self.params.block.length * self.params.block.width;
        Scenario::Slide(Slide::constant(self.speed, self.pressure * area))
    }

    /// Mean depth per distance \[m/m\] of the settled vibration on a worn profile.
    fn rate(&self, block: &mut TreadBlock, depth: &[f64]) -> Result<Vec<f64>, Fault> {
        let x = block.reduction().interface.x.clone();
        let scenario = self.scenario();
        block.initialize(0.0, scenario.pose(0.0))?;
        block.set_worn(depth);
        let mut sum = vec![0.0; x.len()];
        let mut count = 0.0;
        let plan = Plan { step: STEP, duration: SETTLE + WINDOW, inputs: Inputs::Exact };
        scenario::go_on(block, &scenario, &plan, |time, block| {
            if time > SETTLE {
                for (sum, r) in sum.iter_mut().zip(self.instant(block.outputs(), &x)) {
                    *sum += r;
                }
                count += 1.0;
            }
            Ok(())
        })?;
        Ok(sum.iter().map(|r| r / (count * self.speed)).collect())
    }

    /// Growth of the depth \[m/s\] at the nodes, from the stations of the outputs.
    fn instant(&self, o: &Outputs, x: &[f64]) -> Vec<f64> {
        let (first, last) = (x[0], x[x.len() - 1]);
        let at = |k: usize| {
            let (p, v) = (o.pressure[k].max(0.0), o.sliding_speed[k]);
            self.factor * self.law.rate(o.friction_coefficient, p, v, self.reference_mu) * v.abs()
        };
        x.iter()
            .map(|x| {
                let place = (x - first) / (last - first) * (STATIONS - 1) as f64;
                let left = (place.floor() as usize).min(STATIONS - 2);
                let share = place - left as f64;
                (1.0 - share) * at(left) + share * at(left + 1)
            })
            .collect()
    }
}
