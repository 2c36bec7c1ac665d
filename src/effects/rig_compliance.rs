//! Rig compliance: the carriage that holds the block gives way along the road.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// A mass on a spring and a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// Mass \[kg\].
    pub mass: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
}

/// What moves on the tangential spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// A fixture of its own mass, given by the frequency of its resonance.
    #[default]
    Fixture,
    /// The whole load carriage.
    Carriage,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Fixture, Self::Carriage];
}

/// A sprung, damped tangential degree of freedom ξ of the clamped face against its drive:
/// m ξ̈ + 2ζ√(m k) ξ̇ + k ξ = F, k = 1/C (theory eq. 7.15).
///
/// Form `fixture`: m = 1/(C(2πf)²) from the frequency f without the block; form `carriage`: m is
/// the mass of the load carriage. Rig resonance as the textbook spring-mass slider.
#[derive(Clone, Debug, PartialEq)]
pub struct RigCompliance {
    /// Is the effect on?
    pub enabled: bool,
    /// What moves.
    pub form: Form,
    /// Compliance C \[m/N\].
    pub compliance: f64,
    /// Frequency f of the fixture without the block \[Hz\].
    pub frequency: f64,
    /// Damping ratio ζ \[-\].
    pub damping_ratio: f64,
}

impl Default for RigCompliance {
    fn default() -> Self {
        Self {
            enabled: false,
            form: Form::Fixture,
            compliance: 3e-7,
            frequency: 700.0,
            damping_ratio: 0.03,
        }
    }
}

impl RigCompliance {
    /// The oscillator in force; none where the effect is off. `carriage_mass` \[kg\].
    pub fn oscillator(&self, carriage_mass: f64) -> Option<Oscillator> {
        if !self.enabled || self.compliance == 0.0 {
            return None;
        }
        let stiffness = 1.0 / self.compliance;
        let mass = match self.form {
            Form::Fixture => stiffness / (std::f64::consts::TAU * self.frequency).powi(2),
            Form::Carriage => carriage_mass,
        };
        let damping = 2.0 * self.damping_ratio * (mass * stiffness).sqrt();
        Some(Oscillator { mass, damping, stiffness })
    }
}

const UM_N: Option<DisplayUnit> = Some(DisplayUnit { name: "um/N", factor: 1e6 });
const FORMS: &[Item] = &[
    Item { name: "fixture", doc: "a fixture with a resonance of its own" },
    Item { name: "carriage", doc: "the whole load carriage on the spring" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.rig_compliance.enabled", effect.rig_compliance.enabled, Fixed, "Rig compliance: the clamped face gives way along the road"),
    enum_param!("effect.rig_compliance.form", effect.rig_compliance.form, Form, "RigComplianceForm", FORMS, Fixed, "What moves on the tangential spring"),
    real_param!("effect.rig_compliance.compliance", effect.rig_compliance.compliance, "m/N", UM_N, 0.0, 1e-3, 3e-7, Fixed, "Tangential compliance; 0: none"),
    real_param!("effect.rig_compliance.frequency", effect.rig_compliance.frequency, "Hz", None, 1.0, 1e5, 700.0, Fixed, "Frequency of the fixture without the block (form fixture)"),
    real_param!("effect.rig_compliance.damping_ratio", effect.rig_compliance.damping_ratio, "1", None, 0.0, 2.0, 0.03, Fixed, "Damping ratio of the rig"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "rig_compliance",
    module: Module::Rig,
    forms: &[
        FitForm {
            name: "fixture",
            params: &[
                log("effect.rig_compliance.compliance", 3e-7, 1.2),
                log("effect.rig_compliance.frequency", 700.0, 0.7),
                log("effect.rig_compliance.damping_ratio", 0.03, 0.7),
            ],
        },
        FitForm {
            name: "carriage",
            params: &[
                log("effect.rig_compliance.compliance", 3e-7, 1.2),
                log("effect.rig_compliance.damping_ratio", 0.03, 0.7),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fixture_resonates_where_it_says() {
        // Closed form: f = √(k/m)/2π.
        let on = RigCompliance { enabled: true, ..RigCompliance::default() };
        let rig = on.oscillator(2.0).unwrap();
        let frequency = (rig.stiffness / rig.mass).sqrt() / std::f64::consts::TAU;
        assert!((frequency - 700.0).abs() < 1e-9);
    }
}
