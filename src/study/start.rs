//! How a sliding run comes to its speed.

use crate::scenario::{Scenario, Slide};

/// How a sliding run comes to its speed.
///
/// From the speed at which steady sliding loses its stability up to a higher one, steady sliding and a limit
/// cycle exist side by side (the bifurcation is subcritical: friction falls less steeply the faster a block
/// slides), and what the block did before decides which is seen. The paper does not say how its runs start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// The block rests under its load, then the road starts within 0.5 ms: the block sticks first and begins
    /// on the limit cycle wherever there is one.
    Rest,
    /// The road is braked from 1 m/s, where blocks slide steadily, within 10 ms: the block vibrates where steady
    /// sliding is unstable, the paper's "self-excited".
    Braking,
}

/// Road speed from which it is braked \[m/s\]: well above those of Table 1.
const FAST: f64 = 1.0;
/// Time that braking takes \[s\]: 25 periods of the base case. Ten times that changes no cell of Table 1.
const BRAKING: f64 = 10e-3;

impl Start {
    /// The run that comes to `speed` \[m/s\] under `load` \[N\] and stays there.
    pub fn slide(self, speed: f64, load: f64) -> Scenario {
        let slide = Slide::constant(speed, load);
        Scenario::Slide(match self {
            Self::Rest => slide,
            Self::Braking => Slide { speed: FAST.copysign(speed), sweep: BRAKING, ..slide },
        })
    }

    /// Time before the run is at its speed \[s\].
    pub fn lead(self) -> f64 {
        match self {
            Self::Rest => 0.0,
            Self::Braking => BRAKING,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_braked_road_covers_the_mean_of_its_speeds_and_then_goes_on_at_the_last() {
        // Closed form: (1.0 + 0.3)/2 over 10 ms less half of the 0.5 ms start, then 0.3 m/s.
        let at = |t: f64| -Start::Braking.slide(0.3, 50.0).pose(t).x;
        assert!((at(20e-3) - at(15e-3) - 0.3 * 5e-3).abs() < 1e-15);
        assert!((at(10e-3) - 0.65 * 10e-3 + 0.25e-3).abs() < 1e-5, "{}", at(10e-3));
    }
}
