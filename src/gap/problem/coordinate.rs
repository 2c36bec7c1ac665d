//! What is fitted: whitened parameters, those of the base model and those of the effects that were added.

use crate::effects::fit::Spread;
use crate::gap::campaign::Plan;
use crate::gap::simulate::DATASHEET;

/// Datasheet parameters that are recalibrated. Density is left at its value: with one per cent of
/// spread it does what the modulus does.
const CALIBRATED: [&str; 9] = [
    "young_modulus_pa",
    "stiffness_damping_s",
    "friction_mu_inf",
    "friction_mu_drop",
    "friction_decay_speed_m_s",
    "friction_smoothing_speed_m_s",
    "friction_pressure_exponent",
    "contact_reference_pressure_pa",
    "contact_depth_m",
];

/// An effect in one of its forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Index into `effects::fit_specs()`.
    pub effect: usize,
    /// Index of its form.
    pub form: usize,
}

/// One whitened parameter: value = centre·exp(spread·x) or centre + spread·x, x ~ N(0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// Dotted name of the parameter.
    pub name: &'static str,
    /// Centre of the prior, in the parameter's unit.
    pub centre: f64,
    /// Width of the prior.
    pub spread: Spread,
}

impl Coordinate {
    /// The parameter's value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        match self.spread {
            Spread::Log(s) => self.centre * (s * x).exp(),
            Spread::Absolute(s) => self.centre + s * x,
        }
    }

    /// Standard deviation of the value where x has the standard deviation `sd`.
    pub fn deviation(&self, x: f64, sd: f64) -> f64 {
        match self.spread {
            Spread::Log(s) => (self.value(x) * s * sd).abs(),
            Spread::Absolute(s) => s * sd,
        }
    }
}

/// Coordinates of the base model: what the datasheet of `plan` leaves open.
pub(super) fn of_base(plan: &Plan) -> Vec<Coordinate> {
    CALIBRATED
        .iter()
        .filter_map(|key| {
            let datum = plan.nominal.get(*key).filter(|d| d.relative_std > 0.0)?;
            let name = DATASHEET.iter().find(|(k, _)| k == key)?.1;
            let spread = Spread::Log(datum.relative_std);
            Some(Coordinate { name, centre: datum.value, spread })
        })
        .collect()
}
