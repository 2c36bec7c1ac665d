//! How much of a run is compared: fits begin on the first milliseconds, where features follow the parameters without
//! jumps, and go on to longer records.

use crate::gap::campaign::{RunKind, RunSpec};
use crate::gap::features::TRAVEL;

/// How much of every run is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Up to the first snap-out: what follows the parameters without jumps.
    Start,
    /// Half way between: an optimum that has found the first snap-outs of fast runs finds the others.
    Middle,
    /// Enough to fit: the first snap-outs of all runs.
    Fit,
    /// All.
    Whole,
}

impl Look {
    /// Records are compared up to this time \[s\].
    pub fn horizon(self, run: &RunSpec) -> f64 {
        let speed = run.road_speed_m_s.abs();
        match self {
            Self::Whole => run.duration_s,
            _ if run.kind == RunKind::Ringdown => run.duration_s,
            Self::Start => FIRST.max(0.5 * TRAVEL / speed.max(1e-3)).min(START),
            Self::Middle => MIDDLE.max(0.75 * TRAVEL / speed.max(1e-3)).min(0.75 * SLOW),
            Self::Fit => START.max(TRAVEL / speed.max(1e-3)).min(SLOW),
        }
    }
}

/// Length of what is looked at first \[s\].
const FIRST: f64 = 1.3e-3;
/// Length of what is looked at next \[s\].
const MIDDLE: f64 = 2.0e-3;
/// Length of the fitted start of runs \[s\].
const START: f64 = 2.9e-3;
/// Longest fitted start, of slow runs \[s\].
const SLOW: f64 = 5.8e-3;
