//! Sliding runs of many operating points, with the reduction of each geometry made once.

use std::sync::{Arc, Mutex, PoisonError};

use super::start::Start;
use crate::block::{Outputs, Shape, TreadBlock, STATIONS};
use crate::error::Fault;
use crate::metrics::{self, stick_slip, Recorder, StickSlip};
use crate::params::Params;
use crate::reduction::Reduction;
use crate::scenario::{self, Inputs, Plan};

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
    /// How it comes to that speed.
    pub start: Start,
    /// Length of the run at that speed \[s\].
    pub duration: f64,
    /// Distance of the rows \[s\].
    pub step: f64,
}

/// A run and what it amounts to.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// Metrics of the settled part.
    pub metrics: StickSlip,
    /// Rate \[1/s\] at which a vibration grows, or dies where it is negative, between the swing at which
    /// sticking begins and a tenth of it.
    pub growth: f64,
}

/// Share of the road's speed by which the velocity swings when a block begins to stick.
const STICKS: f64 = 0.8;
/// Silence is certain, and the run over, when the velocity swings by less than this share of the
/// road speed over [`WINDOW`].
const DEAD: f64 = 2e-4;
/// Time over which amplitudes are taken \[s\]; one period of the slowest stick-slip of the paper.
const WINDOW: f64 = 2e-3;
/// Windows after which a run may be over: a vibration that grows slowly must have the time to.
const PATIENCE: f64 = 5.0;
/// Time over which amplitudes are taken while a vibration grows or dies \[s\]; one period of 2 kHz, below which blocks
/// of the paper stick.
const SHORT_WINDOW: f64 = 0.5e-3;

/// Slides a block and shows it at every row from the time on at which it is at its speed, with the time since then;
/// stops at the first fault of the block or of `visit`.
///
/// # Errors
/// What stops the block or `visit`.
pub fn slide(
    params: &Params,
    reductions: &Reductions,
    point: Point,
    mut visit: impl FnMut(f64, &TreadBlock) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let load = point.pressure * params.block.length * params.block.width;
    let (scenario, lead) = (point.start.slide(point.speed, load), point.start.lead());
    let mut block = TreadBlock::with_reduction(params, reductions.of(params)?)?;
    let plan = Plan { step: point.step, duration: lead + point.duration, inputs: Inputs::Exact };
    scenario::run(&mut block, &scenario, &plan, |time, block| {
        if time < lead {
            return Ok(());
        }
        visit(time - lead, block)
    })
}

/// Slides a block; ends early when all vibration has died.
///
/// # Errors
/// What stops the block.
pub fn observe(params: &Params, reductions: &Reductions, point: Point) -> Result<Observed, Fault> {
    let mut recorder = Recorder::default();
    let mut swings = Swings::new(WINDOW, point.step);
    let mut short = Swings::new(SHORT_WINDOW, point.step);
    let outcome = slide(params, reductions, point, |time, block| {
        let outputs = block.outputs();
        recorder.push(time, outputs);
        swings.push(outputs.run_in_velocity[0]);
        short.push(outputs.run_in_velocity[0]);
        if time > PATIENCE * WINDOW && swings.last() < DEAD * point.speed.abs() {
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
    Ok(Observed { metrics, growth: growth(&short.swings, point.speed.abs()) })
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

/// Rate \[1/s\] at which the swings (one per [`SHORT_WINDOW`]) grow from a tenth of the road's speed to
/// [`STICKS`] of it, or, negative, fall from there to a tenth: what is left then is the carriage, which settles in
/// its own time whatever friction does.
fn growth(swings: &[f64], road_speed: f64) -> f64 {
    let large = |s: &f64| *s >= STICKS * road_speed;
    let small = |s: &f64| *s <= 0.1 * road_speed;
    let (from, to) = if swings.last().is_some_and(large) {
        let to = swings.iter().position(large).unwrap_or(0);
        (swings[..to].iter().rposition(small).unwrap_or(0), to)
    } else {
        let from = swings.iter().rposition(large).unwrap_or(0);
        let fallen = swings.iter().skip(from).position(small);
        (from, fallen.map_or(swings.len().saturating_sub(1), |windows| from + windows))
    };
    if from == to {
        return 0.0;
    }
    (swings[to] / swings[from]).ln() / ((to - from) as f64 * SHORT_WINDOW)
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
    fn the_rate_of_a_vibration_is_found_above_what_the_carriage_leaves() {
        // exp(-4000 t) for 10 ms over a slow rest, and the same backwards up to a limit cycle.
        let swing = |k: usize| (2.0 * (-4000.0 * SHORT_WINDOW * k as f64).exp() + 0.001).min(0.7);
        let dying: Vec<f64> = (0..20).map(swing).collect();
        let growing: Vec<f64> = dying.iter().rev().copied().collect();
        for (swings, rate) in [(dying, -4000.0), (growing, 4000.0)] {
            let found = growth(&swings, 0.3);
            assert!((found / rate - 1.0).abs() < 0.1, "{found}");
        }
        assert_eq!(growth(&[0.7; 9], 0.3), 0.0);
    }
}
