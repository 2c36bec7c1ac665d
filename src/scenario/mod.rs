//! What is done to a block: dragged over a road or rolled through a contact patch.
//!
//! A scenario is a motion known at every instant. It reaches the block either exactly, as the
//! polynomials that it consists of, or as an FMI master would give it: by values at communication
//! points, from which the block's own [`Predictor`] makes the motion.

#[cfg(feature = "cli")]
pub mod belt_csv;
mod belt_path;
#[cfg(feature = "cli")]
pub mod config;
mod roll;
#[cfg(feature = "cli")]
pub mod run_table;
mod slide;
mod spline;

pub use belt_path::{BeltPath, BeltSample};
pub use roll::Roll;
pub use slide::Slide;
pub use spline::Spline;

use crate::block::{Outputs, TreadBlock};
use crate::drive::{Cubic, Pose, Predictor, Segment};
use crate::error::{Fault, Problem};
use crate::params::{NormalDrive, Params};

/// A motion of the clamped face and the load on it.
#[derive(Clone, Debug, PartialEq)]
pub enum Scenario {
    /// Dragged over the road under a load.
    Slide(Slide),
    /// Rolled through the contact patch.
    Roll(Roll),
}

/// How the motion reaches the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Inputs {
    /// As the polynomials that it consists of; the communication step only says where rows are.
    #[default]
    Exact,
    /// By values at communication points, as an FMI master gives them.
    Sampled,
}

/// Which instants a run visits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Communication step \[s\]: the distance of the rows.
    pub step: f64,
    /// Length of the run \[s\].
    pub duration: f64,
    /// How the motion reaches the block.
    pub inputs: Inputs,
}

impl Scenario {
    /// Pose and load at time `t` \[s\].
    pub fn pose(&self, t: f64) -> Pose {
        match self {
            Self::Slide(slide) => slide.pose(t),
            Self::Roll(roll) => roll.pose(t),
        }
    }

    /// The normal drive that this scenario needs.
    pub fn normal_drive(&self) -> NormalDrive {
        match self {
            Self::Slide(_) => NormalDrive::Load,
            Self::Roll(_) => NormalDrive::Trajectory,
        }
    }

    /// `params` with the normal drive that this scenario needs.
    pub fn fit(&self, params: &Params) -> Params {
        let mut params = params.clone();
        params.drive.normal = self.normal_drive();
        params
    }

    /// Time at which the scenario starts \[s\].
    pub fn start(&self) -> f64 {
        match self {
            Self::Slide(_) => 0.0,
            Self::Roll(roll) => roll.span().0,
        }
    }

    /// The motion over the `h` \[s\] after `t` \[s\], within one polynomial piece.
    fn segment(&self, t: f64, h: f64) -> Segment {
        let (from, to) = (self.pose(t), self.pose(t + h));
        let (rate_from, rate_to) = (self.rates(t), self.rates(t + h));
        let cubic = |get: fn(&Pose) -> f64| {
            Cubic::hermite(h, (get(&from), get(&rate_from)), (get(&to), get(&rate_to)))
        };
        Segment {
            x: cubic(|p| p.x),
            z: cubic(|p| p.z),
            angle: cubic(|p| p.angle),
            load: cubic(|p| p.load),
        }
    }

    fn rates(&self, t: f64) -> Pose {
        match self {
            Self::Slide(slide) => slide.rates(t),
            Self::Roll(roll) => roll.rates(t),
        }
    }

    fn piece_end(&self, t: f64) -> f64 {
        match self {
            Self::Slide(slide) => slide.piece_end(t),
            Self::Roll(roll) => roll.piece_end(t),
        }
    }
}

/// Runs `scenario` with exact inputs and hands out the outputs every `step` \[s\], the start included.
///
/// # Errors
/// What stops the block, see [`TreadBlock::advance`], and an impossible step or duration.
pub fn simulate(
    block: &mut TreadBlock,
    scenario: &Scenario,
    step: f64,
    duration: f64,
    mut row: impl FnMut(f64, &Outputs),
) -> Result<(), Fault> {
    let plan = Plan { step, duration, inputs: Inputs::Exact };
    run(block, scenario, &plan, |t, block| {
        row(t, block.outputs());
        Ok(())
    })
}

/// Runs `scenario` by `plan` and shows the block at every communication point; stops at the first
/// fault of the block or of `visit`.
///
/// # Errors
/// See [`simulate`].
pub fn run(
    block: &mut TreadBlock,
    scenario: &Scenario,
    plan: &Plan,
    visit: impl FnMut(f64, &TreadBlock) -> Result<(), Fault>,
) -> Result<(), Fault> {
    plan.check()?;
    let start = scenario.start();
    block.initialize(start, scenario.pose(start))?;
    go_on(block, scenario, plan, visit)
}

/// As [`run`], from the block's state as it is at the start of the scenario: worn, for example.
///
/// # Errors
/// See [`simulate`].
pub fn go_on(
    block: &mut TreadBlock,
    scenario: &Scenario,
    plan: &Plan,
    mut visit: impl FnMut(f64, &TreadBlock) -> Result<(), Fault>,
) -> Result<(), Fault> {
    plan.check()?;
    let start = scenario.start();
    visit(start, block)?;
    let mut predictor = Predictor::default();
    let (mut t, end) = (start, start + plan.duration);
    for k in 1..=plan.rows() {
        let next = (start + k as f64 * plan.step).min(end);
        match plan.inputs {
            Inputs::Exact => advance(block, scenario, t, next)?,
            Inputs::Sampled => {
                let known = Predictor::known(scenario.pose(t));
                let segment = predictor.segment(t, next - t, known);
                block.advance(next - t, &segment)?;
            }
        }
        t = next;
        visit(t, block)?;
    }
    Ok(())
}

/// Moves the block from `t` to `next` \[s\] piece by piece; a piece shorter than rounding is no piece.
///
/// # Errors
/// See [`TreadBlock::advance`].
pub fn advance(
    block: &mut TreadBlock,
    scenario: &Scenario,
    t: f64,
    next: f64,
) -> Result<(), Fault> {
    const SLIVER: f64 = 1e-11;
    let mut at = t;
    while at < next {
        let piece_end = scenario.piece_end(at + SLIVER);
        let to = if piece_end < next - SLIVER { piece_end } else { next };
        block.advance(to - at, &scenario.segment(at, to - at))?;
        at = to;
    }
    Ok(())
}

impl Plan {
    /// Number of communication steps; the last may be shorter.
    pub fn rows(&self) -> usize {
        (self.duration / self.step - 1e-9).ceil().max(0.0) as usize
    }

    /// Checks step and duration.
    ///
    /// # Errors
    /// [`Fault::Invalid`] with what is impossible about them.
    pub fn check(&self) -> Result<(), Fault> {
        let problem = |what: &str, value: f64, allowed: &str| {
            Problem::new(what, value.to_string(), allowed, "change the [run] table")
        };
        let mut problems = Vec::new();
        if !(self.step > 0.0 && self.step <= 0.1) {
            problems.push(problem("run.communication_step", self.step, "more than 0 to 0.1 s"));
        }
        if !(self.duration > 0.0 && self.duration <= 1e4) {
            problems.push(problem("run.duration", self.duration, "more than 0 to 1e4 s"));
        }
        if problems.is_empty() && self.duration / self.step > 1e8 {
            let value = self.duration / self.step;
            problems.push(problem("rows of the run", value, "at most 1e8"));
        }
        if problems.is_empty() {
            Ok(())
        } else {
            Err(Fault::Invalid(problems))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visited(plan: &Plan) -> Vec<f64> {
        let scenario = Scenario::Slide(Slide::constant(0.3, 56.25));
        let mut block = TreadBlock::new(&scenario.fit(&Params::default())).unwrap();
        let mut times = Vec::new();
        run(&mut block, &scenario, plan, |t, _| {
            times.push(t);
            Ok(())
        })
        .unwrap();
        times
    }

    #[test]
    fn rows_are_multiples_of_the_step_and_the_last_is_the_end() {
        let plan = Plan { step: 3e-5, duration: 1e-4, inputs: Inputs::Exact };
        let expected = [0.0, 3e-5, 6e-5, 9e-5, 1e-4];
        let times = visited(&plan);
        assert_eq!(times.len(), expected.len());
        assert!(times.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{times:?}");
    }

    #[test]
    fn pieces_reproduce_the_motion_between_communication_points() {
        // Closed form: within the start ramp x = -v t²/(2 r).
        let scenario = Scenario::Slide(Slide::constant(0.3, 56.25));
        let segment = scenario.segment(1e-4, 3e-4);
        for s in [0.0, 1e-4, 2.5e-4, 3e-4] {
            let t: f64 = 1e-4 + s;
            assert!((segment.x.at(s) + 0.3 * t * t / (2.0 * 0.5e-3)).abs() < 1e-17);
        }
    }

    #[test]
    fn a_step_of_zero_is_refused() {
        let plan = Plan { step: 0.0, duration: f64::NAN, inputs: Inputs::Exact };
        let Err(Fault::Invalid(problems)) = plan.check() else { panic!("accepted") };
        assert_eq!(problems.len(), 2);
    }
}
