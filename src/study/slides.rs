//! Sliding runs of many operating points, with the reduction of each geometry made once.

use std::sync::{Arc, Mutex, PoisonError};

use crate::block::{Outputs, Shape, TreadBlock, STATIONS};
use crate::error::Fault;
use crate::metrics::{self, stick_slip, Recorder, StickSlip};
use crate::params::Params;
use crate::reduction::Reduction;
use crate::scenario::{self, Inputs, Plan, Scenario, Slide};

/// Reductions made so far, one per [`Shape`].
#[derive(Debug, Default)]
pub struct Reductions {
    made: Mutex<Vec<(Shape, Arc<Reduction>)>>,
}

impl Reductions {
    /// The reduction for `params`, made at the first call for its shape.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn of(&self, params: &Params) -> Result<Arc<Reduction>, Fault> {
        let shape = Shape::of(params);
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, reduction)) = made.iter().find(|(s, _)| *s == shape) {
            return Ok(reduction.clone());
        }
        let reduction = Arc::new(shape.reduce()?);
        made.push((shape, reduction.clone()));
        Ok(reduction)
    }
}

/// What a sliding run is made of beside the block's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Road speed \[m/s\].
    pub speed: f64,
    /// Mean pressure \[Pa\].
    pub pressure: f64,
    /// Length of the run \[s\].
    pub duration: f64,
    /// Distance of the rows \[s\].
    pub step: f64,
}

/// A run and what it amounts to.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// Metrics of the settled part.
    pub metrics: StickSlip,
    /// Rate \[1/s\] at which a vibration dies, from the swing at which sticking ends to a tenth of it.
    pub death_rate: f64,
}

/// Silence is certain, and the run over, when the velocity swings by less than this share of the
/// road speed over [`WINDOW`].
const DEAD: f64 = 2e-3;
/// Time over which amplitudes are taken \[s\]; one period of the slowest stick-slip of the paper.
const WINDOW: f64 = 2e-3;
/// Time over which amplitudes are taken while a vibration dies \[s\]; one period of 2 kHz, below which blocks
/// of the paper stick.
const SHORT_WINDOW: f64 = 0.5e-3;

/// Slides a block; ends early when all vibration has died.
///
/// # Errors
/// What stops the block.
pub fn observe(params: &Params, reductions: &Reductions, point: Point) -> Result<Observed, Fault> {
    let load = point.pressure * params.block.length * params.block.width;
    let scenario = Scenario::Slide(Slide::constant(point.speed, load));
    let mut block = TreadBlock::with_reduction(params, reductions.of(params)?)?;
    let mut recorder = Recorder::default();
    let mut swings = Swings::new(WINDOW, point.step);
    let mut short = Swings::new(SHORT_WINDOW, point.step);
    let plan = Plan { step: point.step, duration: point.duration, inputs: Inputs::Exact };
    let outcome = scenario::run(&mut block, &scenario, &plan, |time, block| {
        let outputs = block.outputs();
        recorder.push(time, outputs);
        swings.push(outputs.run_in_velocity[0]);
        short.push(outputs.run_in_velocity[0]);
        if time > 2.0 * WINDOW && swings.last() < DEAD * point.speed.abs() {
            return Err(died());
        }
        Ok(())
    });
    match outcome {
        Err(fault) if fault != died() => return Err(fault),
        _ => {}
    }
    let mut metrics = stick_slip(&recorder.trace(), point.speed);
    if outcome.is_err() {
        metrics.frequency = 0.0;
    }
    Ok(Observed { metrics, death_rate: death_rate(&short.swings, point.speed.abs()) })
}

/// Share of the touching stations that slide slower than `bound` \[m/s\]: quasi-sticking creeps, so the
/// bound is a share of the road's speed, not the smoothing speed.
pub fn sticking(outputs: &Outputs, bound: f64) -> f64 {
    let touching = || (0..STATIONS).filter(|k| outputs.pressure[*k] > 0.0);
    let stuck = touching().filter(|k| outputs.sliding_speed[*k].abs() < bound).count();
    stuck as f64 / touching().count().max(1) as f64
}

/// Ends a run whose vibration has died; never leaves this file.
fn died() -> Fault {
    Fault::File { path: String::new(), reason: "vibration died".to_string() }
}

/// Rate \[1/s\] at which the swings (one per [`SHORT_WINDOW`]) fall from the road's speed, below which nothing
/// sticks any more, to a tenth of it: what is left then is the carriage, which settles in its own time
/// whatever friction does. 0 if they do not fall.
fn death_rate(swings: &[f64], road_speed: f64) -> f64 {
    let Some(from) = swings.iter().rposition(|s| *s >= 0.8 * road_speed) else { return 0.0 };
    let fallen = swings.iter().skip(from).position(|s| *s <= 0.1 * road_speed);
    let windows = fallen.unwrap_or(swings.len() - 1 - from);
    if windows == 0 {
        return 0.0;
    }
    (swings[from] / swings[from + windows]).ln() / (windows as f64 * SHORT_WINDOW)
}

/// Peak-to-peak velocity window by window.
struct Swings {
    length: usize,
    current: Vec<f64>,
    swings: Vec<f64>,
}

impl Swings {
    fn new(window: f64, step: f64) -> Self {
        let length = (window / step).round().max(4.0) as usize;
        Self { length, current: Vec::with_capacity(length), swings: Vec::new() }
    }

    fn push(&mut self, velocity: f64) {
        self.current.push(velocity);
        if self.current.len() == self.length {
            self.swings.push(metrics::peak_to_peak(&self.current));
            self.current.clear();
        }
    }

    fn last(&self) -> f64 {
        self.swings.last().copied().unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_a_dying_vibration_is_found_above_what_the_carriage_leaves() {
        // exp(-4000 t) for 10 ms over a slow rest.
        let swing = |k: usize| 2.0 * (-4000.0 * SHORT_WINDOW * k as f64).exp() + 0.001;
        let swings: Vec<f64> = (0..20).map(swing).collect();
        let rate = death_rate(&swings, 0.3);
        assert!((rate / 4000.0 - 1.0).abs() < 0.1, "{rate}");
        assert_eq!(death_rate(&[0.7; 9], 0.3), 0.0);
    }
}
