//! Whatever communication step a master chooses, the stick-slip is that of the converged solution.
//!
//! Hard requirement of the project: frequency and mean friction within 0.5 % for communication steps
//! from 1 µs to 1 ms, also varying ones. Case slide-1 of tests/data/verification.

use std::sync::{Arc, OnceLock};
use tread_block::block::Shape;
use tread_block::drive::{Cubic, Pose, Predictor, Segment};
use tread_block::metrics::{self, Recorder, StickSlip};
use tread_block::reduction::Reduction;
use tread_block::scenario::{Scenario, Slide};
use tread_block::{Params, TreadBlock};

const SPEED: f64 = 0.30;
const LOAD: f64 = 56.25;
/// As long as the reference [s].
const DURATION: f64 = 24e-3;
/// End of the linear start [s].
const RAMP: f64 = 0.5e-3;
/// Time between looks at the motion [s].
const LOOK: f64 = 20e-6;
/// Internal step [s] and tolerance of the solution that counts as converged.
const CONVERGED: (f64, f64) = (0.5e-6, 1e-4);

fn pose(t: f64) -> Pose {
    Pose { x: -Slide::constant(SPEED, LOAD).road_distance(t), load: LOAD, ..Pose::default() }
}

/// The exact motion from `t` on, up to the end of the ramp or for ever.
fn exact(t: f64) -> Segment {
    let slide = Slide::constant(SPEED, LOAD);
    let curvature = if t < RAMP - 1e-12 { -0.5 * SPEED / RAMP } else { 0.0 };
    let x = Cubic([-slide.road_distance(t), -slide.road_speed(t), curvature, 0.0]);
    Segment { x, ..Segment::still(pose(t)) }
}

/// The same motion, counted from `s` on.
fn later(segment: &Segment, s: f64) -> Segment {
    let shift = |c: &Cubic| Cubic([c.at(s), c.rate(s), 0.5 * c.curvature(s), c.0[3]]);
    Segment {
        x: shift(&segment.x),
        z: shift(&segment.z),
        angle: shift(&segment.angle),
        load: shift(&segment.load),
    }
}

/// Advances `block` by one communication step. A long step is looked into by a copy of the block,
/// which leaves the block itself alone.
fn advance(block: &mut TreadBlock, h: f64, segment: &Segment, recorder: &mut Recorder) {
    let looks = (h / LOOK).floor() as usize;
    if looks > 1 {
        let (mut witness, start) = (block.clone(), block.time());
        for k in 0..looks - 1 {
            witness.advance(LOOK, &later(segment, LOOK * k as f64)).unwrap();
            recorder.push(start + LOOK * (k + 1) as f64, witness.outputs());
        }
    }
    block.advance(h, segment).unwrap();
    recorder.push(block.time(), block.outputs());
}

fn reduction() -> Arc<Reduction> {
    static SHARED: OnceLock<Arc<Reduction>> = OnceLock::new();
    let make = || Arc::new(Shape::of(&Params::default()).reduce().unwrap());
    Arc::clone(SHARED.get_or_init(make))
}

/// Stick-slip with communication steps of `step(k)` [s].
fn run(params: &Params, step: impl Fn(usize) -> f64, sampled: bool) -> StickSlip {
    let params = Scenario::Slide(Slide::constant(SPEED, LOAD)).fit(params);
    let mut block = TreadBlock::with_reduction(&params, reduction()).unwrap();
    block.initialize(0.0, pose(0.0)).unwrap();
    let (mut recorder, mut predictor) = (Recorder::default(), Predictor::default());
    recorder.push(0.0, block.outputs());
    let (mut k, mut t) = (0, 0.0);
    while t < DURATION - 1e-9 {
        let h = step(k).min(DURATION - t);
        if sampled {
            let segment = predictor.segment(t, h, Predictor::known(pose(t)));
            advance(&mut block, h, &segment, &mut recorder);
        } else {
            // No polynomial has a kink: the step in which the ramp ends is cut there.
            let first = if t < RAMP - 1e-9 { h.min(RAMP - t) } else { h };
            advance(&mut block, first, &exact(t), &mut recorder);
            if h - first > 1e-9 {
                advance(&mut block, h - first, &exact(t + first), &mut recorder);
            }
        }
        t += h;
        k += 1;
    }
    metrics::stick_slip(&recorder.trace(), SPEED)
}

fn converged() -> StickSlip {
    static SOLUTION: OnceLock<StickSlip> = OnceLock::new();
    *SOLUTION.get_or_init(|| {
        let mut params = Params::default();
        (params.solver.max_step, params.solver.tolerance) = CONVERGED;
        let found = run(&params, |_| LOOK, false);
        println!("converged: {:.3} Hz, friction {:.5}", found.frequency, found.mean_friction);
        found
    })
}

/// Any size between 1 µs and 1 ms, evenly over the logarithm, without a pattern.
fn irregular(k: usize) -> f64 {
    let share = ((k as u64 + 1) * 7_919 * 48_271 % 65_537) as f64 / 65_537.0;
    1e-6 * 1000_f64.powf(share)
}

const STEPS: [(&str, fn(usize) -> f64); 7] = [
    ("1 µs", |_| 1e-6),
    ("5 µs", |_| 5e-6),
    ("13.7 µs", |_| 13.7e-6),
    ("20 µs", |_| 20e-6),
    ("100 µs", |_| 100e-6),
    ("1 ms", |_| 1e-3),
    ("irregular", irregular),
];

fn agrees(sampled: bool) {
    let expected = converged();
    let mut wrong = Vec::new();
    for (name, step) in STEPS {
        let found = run(&Params::default(), step, sampled);
        let frequency = found.frequency / expected.frequency - 1.0;
        let friction = found.mean_friction / expected.mean_friction - 1.0;
        println!(
            "{name}: frequency {:+.3} %, friction {:+.3} %",
            100.0 * frequency,
            100.0 * friction
        );
        if frequency.abs() > 0.005 || friction.abs() > 0.005 || !frequency.is_finite() {
            wrong.push(format!("{name}: frequency {frequency:+.2e}, friction {friction:+.2e}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn any_communication_step_gives_the_converged_stick_slip_with_exact_inputs() {
    agrees(false);
}

#[test]
fn any_communication_step_gives_the_converged_stick_slip_with_sampled_inputs() {
    agrees(true);
}

#[test]
fn the_converged_solution_is_converged() {
    // Half the step again moves it by less than a fifth of what is allowed to the others.
    let mut params = Params::default();
    (params.solver.max_step, params.solver.tolerance) = (0.5 * CONVERGED.0, 0.5 * CONVERGED.1);
    let (finer, found) = (run(&params, |_| LOOK, false), converged());
    let frequency = finer.frequency / found.frequency - 1.0;
    let friction = finer.mean_friction / found.mean_friction - 1.0;
    println!("half the step: frequency {frequency:+.1e}, friction {friction:+.1e}");
    assert!(frequency.abs() < 1e-3 && friction.abs() < 1e-3);
}
