//! Sliding runs of many operating points, with the reduction of each geometry made once.

use super::start::Start;
use super::watch::{Observed, Watch};
use crate::block::{Outputs, Reductions, TreadBlock, STATIONS};
use crate::error::Fault;
use crate::params::Params;
use crate::scenario::{self, Inputs, Plan};

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

/// Slides a block for at most the duration of `point`; ends early when all vibration has died, or when it has settled
/// and was seen for `seen` \[s\].
///
/// # Errors
/// What stops the block.
pub fn observe(
    params: &Params,
    reductions: &Reductions,
    point: Point,
    seen: f64,
) -> Result<Observed, Fault> {
    let mut watch = Watch::new(point.speed, point.step, seen);
    let outcome = slide(params, reductions, point, |time, block| {
        match watch.push(time, block.outputs().run_in_velocity[0]) {
            true => Err(over()),
            false => Ok(()),
        }
    });
    match outcome {
        Err(fault) if fault != over() => Err(fault),
        _ => Ok(watch.observed()),
    }
}

/// Share of the touching stations that slide slower than `bound` \[m/s\]: quasi-sticking creeps, so the
/// bound is a share of the road's speed, not the smoothing speed.
pub fn sticking(outputs: &Outputs, bound: f64) -> f64 {
    let touching = || (0..STATIONS).filter(|k| outputs.pressure[*k] > 0.0);
    let stuck = touching().filter(|k| outputs.sliding_speed[*k].abs() < bound).count();
    stuck as f64 / touching().count().max(1) as f64
}

/// Ends a run that has shown what it can; never leaves this file.
fn over() -> Fault {
    Fault::unusable("", "seen enough")
}
