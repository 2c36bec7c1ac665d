//! Drives that hold neither speed nor load: what a made campaign may have and no candidate effect describes.

use crate::block::TreadBlock;
use crate::drive::{Cubic, Segment};
use crate::error::Fault;
use crate::scenario::{Plan, Slide};

/// What a rig's drives add to speed and load: sines, as shares of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ripple {
    /// Amplitude of the road speed over the road speed \[-\].
    pub(super) speed: f64,
    /// Amplitude of the load over the load \[-\].
    pub(super) load: f64,
}

/// Frequency of a [`Ripple`] \[Hz\].
const RIPPLE: f64 = 150.0;

impl Ripple {
    /// As [`crate::scenario::go_on`], with the ripple on top of what `slide` says.
    pub(super) fn go_on(
        self,
        block: &mut TreadBlock,
        slide: &Slide,
        plan: &Plan,
        mut visit: impl FnMut(f64, &TreadBlock) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        visit(0.0, block)?;
        for k in 0..plan.rows() {
            let t = k as f64 * plan.step;
            block.advance(plan.step, &self.segment(slide, t, plan.step))?;
            visit(t + plan.step, block)?;
        }
        Ok(())
    }

    /// Motion and load of a block that slides as `slide` says, over the `h` \[s\] after `t` \[s\].
    fn segment(self, slide: &Slide, t: f64, h: f64) -> Segment {
        let omega = 2.0 * std::f64::consts::PI * RIPPLE;
        let added = self.speed * slide.speed;
        let speed = |t: f64| slide.road_speed(t) + added * (omega * t).sin();
        let way = |t: f64| slide.road_distance(t) + added * (1.0 - (omega * t).cos()) / omega;
        let load = |t: f64| slide.load * (1.0 + self.load * (omega * t).sin());
        let rate = |t: f64| slide.load * self.load * omega * (omega * t).cos();
        Segment {
            x: Cubic::hermite(h, (-way(t), -speed(t)), (-way(t + h), -speed(t + h))),
            load: Cubic::hermite(h, (load(t), rate(t)), (load(t + h), rate(t + h))),
            ..Segment::default()
        }
    }
}
