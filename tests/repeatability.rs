//! The same bits again: saved and restored, initialized twice, built twice.

use std::sync::Arc;
use tread_block::block::Shape;
use tread_block::drive::{Cubic, Pose, Segment};
use tread_block::params::NormalDrive;
use tread_block::{Params, TreadBlock};

/// The clamped face of the default block 0.15 mm below where the tread face touches, for the drive that heeds it.
const REST: Pose = Pose { x: 0.0, z: 9.85e-3, angle: 0.0, load: 56.25 };
/// How fast a block turns that rolls at 10 m/s \[rad/s\].
const ROLLING: f64 = 33.0;

fn block(params: &Params) -> TreadBlock {
    let mut block = TreadBlock::new(params).unwrap();
    block.initialize(0.0, REST).unwrap();
    block
}

/// Communication steps of several sizes, so that the history of step sizes matters if it can.
fn step(k: usize) -> f64 {
    [10e-6, 10e-6, 35e-6, 1e-6, 100e-6][k % 5]
}

/// Drags the block through communication steps `from..to`; returns all it says, as bits.
fn drag(block: &mut TreadBlock, from: usize, to: usize) -> Vec<u64> {
    drag_turning(block, from, to, 0.0)
}

/// [`drag`] of a block that turns by `rate` \[rad/s\].
fn drag_turning(block: &mut TreadBlock, from: usize, to: usize, rate: f64) -> Vec<u64> {
    let mut bits = Vec::new();
    for k in from..to {
        let t = block.time();
        let (x, angle) = (Cubic::line(-0.3 * t, -0.3), Cubic::line(rate * t, rate));
        block.advance(step(k), &Segment { x, angle, ..Segment::still(REST) }).unwrap();
        assert!(block.time() > t);
        bits.extend(all(block));
    }
    bits
}

/// Outputs and complete state, as bits.
fn all(block: &TreadBlock) -> Vec<u64> {
    let mut numbers = Vec::new();
    block.save(&mut numbers);
    let out = block.outputs();
    numbers.extend(out.force.iter().chain(&out.contact_force).chain(&out.run_in_velocity));
    numbers.extend([
        out.moment_y,
        out.friction_coefficient,
        out.friction_power,
        out.stick_fraction,
    ]);
    numbers.extend(out.pressure.iter().chain(&out.sliding_speed));
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// All effects that remember something, so that their memory is saved too.
fn with_memory() -> Params {
    let mut params = Params::default();
    params.effect.thermal_friction.enabled = true;
    params.effect.friction_ageing.enabled = true;
    params.effect.payne_softening.enabled = true;
    params.effect.viscoelastic_modulus.enabled = true;
    params
}

#[test]
fn a_restored_block_goes_on_bit_for_bit() {
    let mut trajectory = Params::default();
    trajectory.drive.normal = NormalDrive::Trajectory;
    for (params, rate) in [
        (Params::default(), 0.0),
        (with_memory(), 0.0),
        (Params::default(), ROLLING),
        (trajectory, ROLLING),
    ] {
        let mut first = block(&params);
        drag_turning(&mut first, 0, 60, rate);
        let mut saved = Vec::new();
        first.save(&mut saved);
        let expected = drag_turning(&mut first, 60, 120, rate);
        // Into the block that has gone on, and into one that has seen nothing.
        assert!(first.restore(&saved));
        assert!(drag_turning(&mut first, 60, 120, rate) == expected, "restored in place");
        let mut other = TreadBlock::new(&params).unwrap();
        assert!(other.restore(&saved));
        assert!(drag_turning(&mut other, 60, 120, rate) == expected, "restored into another block");
    }
}

#[test]
fn a_block_initialized_again_does_the_same_again() {
    let mut first = block(&with_memory());
    let expected = drag(&mut first, 0, 60);
    first.initialize(0.0, REST).unwrap();
    assert!(drag(&mut first, 0, 60) == expected);
}

#[test]
fn blocks_built_twice_or_on_one_reduction_are_the_same() {
    let params = Params::default();
    let shared = Arc::new(Shape::of(&params).reduce().unwrap());
    let mut on_shared = TreadBlock::with_reduction(&params, shared).unwrap();
    on_shared.initialize(0.0, REST).unwrap();
    let expected = drag(&mut block(&params), 0, 60);
    assert!(drag(&mut block(&params), 0, 60) == expected, "built twice");
    assert!(drag(&mut on_shared, 0, 60) == expected, "on one reduction");
}

#[test]
fn a_state_of_another_block_is_refused_and_changes_nothing() {
    let mut trajectory = Params::default();
    trajectory.drive.normal = NormalDrive::Trajectory;
    trajectory.solver.elements_along = 12;
    let mut saved = Vec::new();
    TreadBlock::new(&trajectory).unwrap().save(&mut saved);
    let mut first = block(&Params::default());
    drag(&mut first, 0, 10);
    let before = all(&first);
    assert!(!first.restore(&saved));
    assert!(!first.restore(&saved[..3]));
    let mut own = Vec::new();
    first.save(&mut own);
    for at in [0, own.len() / 2, own.len() - 1] {
        let mut spoilt = own.clone();
        spoilt[at] = f64::NAN;
        assert!(!first.restore(&spoilt), "number {at}");
    }
    assert!(all(&first) == before);
}
