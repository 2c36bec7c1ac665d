//! A block that hangs free and is struck rings down as the independent program says.

use tread_block::drive::{Pose, Segment};
use tread_block::params::NormalDrive;
use tread_block::{Params, TreadBlock};

/// `shared/verification`, case ringdown-1: h 8 mm, l 15 mm, struck with 0.3 m/s × (1 − y/h).
/// Two per cent of the peak: the reference's own mesh error is below one per cent (its README).
#[test]
fn a_struck_block_rings_down_within_two_per_cent_of_the_peak() {
    let mut params = Params::default();
    params.block.height = 0.008;
    params.drive.normal = NormalDrive::Trajectory;
    let mut block = TreadBlock::new(&params).unwrap();
    let pose = Pose { z: 1.008, ..Pose::default() };
    block.initialize(0.0, pose).unwrap();
    block.strike(0.3);
    let text = include_str!("data/verification/ringdown-1.csv");
    let mut worst = 0.0_f64;
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let h = row[0] - block.time();
        if h > 0.0 {
            block.advance(h, &Segment::still(pose)).unwrap();
            worst = worst.max((block.outputs().run_in_velocity[0] - row[7]).abs());
        }
    }
    assert!(worst < 0.02 * 0.3, "largest deviation {worst} m/s of 0.3 m/s");
}
