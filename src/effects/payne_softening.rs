//! Payne effect: the stiffness of filled rubber falls with the amplitude of strain.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// Which strain softens, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// The amplitude over the last cycles, after Kraus.
    #[default]
    Kraus,
    /// The strain at the instant, hyperbolically.
    Instantaneous,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Kraus, Self::Instantaneous];
}

/// Stiffness factor f(γ)/f(γ_r) of the whole block, γ = |ū|/h its mean shear: the mean tangential
/// displacement ū of the tread face over the height h (theory eqs. 7.8, 7.9). Pressing at rest does not shear and does not
/// soften: filler networks break with the amplitude of deformation and heal at rest.
///
/// `kraus` (Kraus, Rubber Chem. Technol. 51, 1978, with m = 0.55): f = 1 − s·x/(1 + x),
/// x = (γ_a/γ_c)^(2m), γ_a the largest shear of the last 2 ms. `instantaneous`:
/// f = 1 − s·γ/(γ + γ_c), smoothed over 30 µs. s = d/(1 + d) with the drop d = G₀/G_∞ − 1. γ_r is the
/// shear at which Young's modulus was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct PayneSoftening {
    /// Is the effect on?
    pub enabled: bool,
    /// Which strain softens.
    pub form: Form,
    /// Stiffness at small over that at large strain less 1, d = G₀/G_∞ − 1 \[-\].
    pub drop: f64,
    /// Strain γ_c of half the loss \[-\].
    pub strain: f64,
    /// Strain γ_r at which Young's modulus was measured \[-\].
    pub reference_strain: f64,
}

impl Default for PayneSoftening {
    fn default() -> Self {
        Self {
            enabled: false,
            form: Form::Kraus,
            drop: 1.0,
            strain: 8e-3,
            reference_strain: 0.0,
        }
    }
}

/// Time over which the amplitude is forgotten \[s\]: some cycles of a stick-slip vibration.
const MEMORY: f64 = 2e-3;
/// Time over which the instantaneous strain is smoothed \[s\]: well below a cycle.
const SMOOTHING: f64 = 30e-6;
/// Exponent 2m of Kraus' law.
const KRAUS_EXPONENT: f64 = 1.1;
/// Change of the stiffness below which the present factor stays: each change costs new matrices.
const RESOLUTION: f64 = 0.005;

impl PayneSoftening {
    /// Follows the strain: `amplitude` after `h` \[s\] at whose end the strain is `strain`.
    pub fn follow(&self, h: f64, strain: f64, amplitude: f64) -> f64 {
        match self.form {
            Form::Kraus => strain.max(amplitude * (-h / MEMORY).exp()),
            Form::Instantaneous => strain + (amplitude - strain) * (-h / SMOOTHING).exp(),
        }
    }

    /// Stiffness factor at an amplitude of strain.
    pub fn factor(&self, amplitude: f64) -> f64 {
        self.softened(amplitude) / self.softened(self.reference_strain)
    }

    /// The factor to use where `present` is in use: the same one until it is wrong by more than
    /// half a percent.
    pub fn update(&self, amplitude: f64, present: f64) -> f64 {
        let factor = self.factor(amplitude);
        if (factor - present).abs() > RESOLUTION * present {
            factor
        } else {
            present
        }
    }

    fn softened(&self, amplitude: f64) -> f64 {
        let ratio = amplitude / self.strain;
        let x = match self.form {
            Form::Kraus => ratio.powf(KRAUS_EXPONENT),
            Form::Instantaneous => ratio,
        };
        1.0 - self.drop / (1.0 + self.drop) * x / (1.0 + x)
    }
}

const PERCENT: Option<DisplayUnit> = Some(DisplayUnit { name: "%", factor: 100.0 });
const FORMS: &[Item] = &[
    Item { name: "kraus", doc: "Kraus' law over the amplitude of the last cycles" },
    Item { name: "instantaneous", doc: "hyperbolic fall with the strain at the instant" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.payne_softening.enabled", effect.payne_softening.enabled, Fixed, "Payne effect: stiffness falls with the amplitude of strain"),
    enum_param!("effect.payne_softening.form", effect.payne_softening.form, Form, "PayneSofteningForm", FORMS, Fixed, "Which strain softens"),
    real_param!("effect.payne_softening.drop", effect.payne_softening.drop, "1", None, 0.0, 50.0, 1.0, Tunable, "Stiffness at small over that at large strain, less 1; 0: none"),
    real_param!("effect.payne_softening.strain", effect.payne_softening.strain, "1", PERCENT, 1e-5, 1.0, 0.01, Tunable, "Strain of half the loss"),
    real_param!("effect.payne_softening.reference_strain", effect.payne_softening.reference_strain, "1", PERCENT, 0.0, 1.0, 0.001, Tunable, "Strain at which Young's modulus was measured"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "payne_softening",
    module: Module::Dynamic,
    forms: &[
        FitForm {
            name: "kraus",
            params: &[
                log("effect.payne_softening.drop", 1.5, 0.8),
                log("effect.payne_softening.strain", 8e-3, 0.7),
            ],
        },
        FitForm {
            name: "instantaneous",
            params: &[
                log("effect.payne_softening.drop", 1.5, 0.8),
                log("effect.payne_softening.strain", 8e-3, 0.7),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_loss_is_there_at_the_critical_strain() {
        // Closed form: x = 1 and s = 1/2 give 1 − 1/4.
        for form in Form::ALL {
            let on = PayneSoftening { form, ..PayneSoftening::default() };
            assert!((on.factor(8e-3) - 0.75).abs() < 1e-15);
            assert_eq!(on.factor(0.0), 1.0);
            assert_eq!(PayneSoftening { drop: 0.0, ..on }.factor(0.05), 1.0);
        }
    }

    #[test]
    fn the_modulus_holds_at_the_strain_of_its_measurement() {
        let on = PayneSoftening { reference_strain: 2e-3, ..PayneSoftening::default() };
        assert_eq!(on.factor(2e-3), 1.0);
        assert!(on.factor(0.0) > 1.0 && on.factor(0.02) < 1.0);
    }
}
