//! Adhesion: a shear strength of the real contact that does not depend on the load, and a pull-off.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// How the adhering share of the face grows with the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// The whole face adheres where it touches.
    #[default]
    FullContact,
    /// The real contact adheres, which saturates with the pressure.
    RealContact,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::FullContact, Self::RealContact];
}

/// Traction τ_a·s(v)·A(p)/A₀ beside friction and −p_a·A(p)/A₀ beside the pressure, s the smoothed
/// sign of friction and A(p)/A₀ = 1 − exp(−p/p_s) the adhering share (see [`Self::saturation`]; theory eq. 7.6).
///
/// Tolpekina and Persson, Lubricants 7(3) 20 (2019): the adhesive term τ_f A/A₀ beside hysteresis;
/// the exponential saturation stands for Persson's error function.
#[derive(Clone, Debug, PartialEq)]
pub struct Adhesion {
    /// Is the effect on?
    pub enabled: bool,
    /// Growth of the adhering share.
    pub form: Form,
    /// Shear strength τ_a \[Pa\] of full contact.
    pub shear_strength: f64,
    /// Pull-off p_a \[Pa\] of full contact.
    pub pull_off: f64,
    /// Pressure p_s \[Pa\] over which real contact saturates.
    pub saturation_pressure: f64,
}

impl Default for Adhesion {
    fn default() -> Self {
        Self {
            enabled: false,
            form: Form::FullContact,
            shear_strength: 50e3,
            pull_off: 0.0,
            saturation_pressure: 80e3,
        }
    }
}

/// Pressure over which full contact is made \[Pa\]: small beside any load, finite for the solver.
const FIRST_TOUCH: f64 = 5e3;

impl Adhesion {
    /// Pressure p_s \[Pa\] over which the adhering share grows.
    pub fn saturation(&self) -> f64 {
        match self.form {
            Form::FullContact => FIRST_TOUCH,
            Form::RealContact => self.saturation_pressure,
        }
    }
}

const KPA: Option<DisplayUnit> = Some(DisplayUnit { name: "kPa", factor: 1e-3 });
const FORMS: &[Item] = &[
    Item { name: "full_contact", doc: "the whole face adheres where it touches" },
    Item { name: "real_contact", doc: "the adhering share grows as 1 - exp(-p/saturation_pressure)" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.adhesion.enabled", effect.adhesion.enabled, Fixed, "Adhesion: shear and pull-off that do not depend on the load"),
    enum_param!("effect.adhesion.form", effect.adhesion.form, Form, "AdhesionForm", FORMS, Fixed, "How the adhering share grows with the pressure"),
    real_param!("effect.adhesion.shear_strength", effect.adhesion.shear_strength, "Pa", KPA, 0.0, 1e7, 5e4, Tunable, "Shear strength of full contact; 0: none"),
    real_param!("effect.adhesion.pull_off", effect.adhesion.pull_off, "Pa", KPA, 0.0, 1e6, 1e4, Tunable, "Pull-off pressure of full contact"),
    real_param!("effect.adhesion.saturation_pressure", effect.adhesion.saturation_pressure, "Pa", KPA, 1e3, 1e8, 8e4, Tunable, "Pressure over which the real contact saturates (form real_contact)"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "adhesion",
    module: Module::Friction,
    forms: &[
        FitForm {
            name: "full_contact",
            params: &[log("effect.adhesion.shear_strength", 50e3, 0.8)],
        },
        FitForm {
            name: "real_contact",
            params: &[
                log("effect.adhesion.shear_strength", 60e3, 0.8),
                log("effect.adhesion.saturation_pressure", 80e3, 0.7),
            ],
        },
    ],
};
