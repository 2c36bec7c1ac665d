//! Contact damping: the pressure depends on how fast rubber and road approach each other.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::Item;
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// Law of the contact damping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// p(u)·(1 + c·u̇).
    #[default]
    HuntCrossley,
    /// p(u) + d·(1 − exp(−u/u₀))·u̇.
    Kelvin,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::HuntCrossley, Self::Kelvin];
}

/// Rate-dependent contact pressure, never negative: the road does not pull (theory eqs. 7.11, 7.12).
///
/// Hunt and Crossley, J. Appl. Mech. 42 (1975): p·(1 + c·u̇), c about 1.5 times the loss of
/// restitution per speed. Kelvin: p + d·u̇, the damper faded in over the contact depth u₀ so that
/// touching makes no jump.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactDamping {
    /// Is the effect on?
    pub enabled: bool,
    /// Law.
    pub form: Form,
    /// c \[s/m\] of the form `hunt_crossley`.
    pub damping: f64,
    /// d \[Pa s/m\] of the form `kelvin`.
    pub viscosity: f64,
}

impl Default for ContactDamping {
    fn default() -> Self {
        Self { enabled: false, form: Form::HuntCrossley, damping: 3.0, viscosity: 5e5 }
    }
}

impl ContactDamping {
    /// c \[s/m\] and d \[Pa s/m\] in force.
    pub fn coefficients(&self) -> (f64, f64) {
        match (self.enabled, self.form) {
            (false, _) => (0.0, 0.0),
            (true, Form::HuntCrossley) => (self.damping, 0.0),
            (true, Form::Kelvin) => (0.0, self.viscosity),
        }
    }
}

const FORMS: &[Item] = &[
    Item { name: "hunt_crossley", doc: "p (1 + damping du/dt)" },
    Item { name: "kelvin", doc: "p + viscosity du/dt" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.contact_damping.enabled", effect.contact_damping.enabled, Fixed, "Contact damping: rate-dependent contact pressure"),
    enum_param!("effect.contact_damping.form", effect.contact_damping.form, Form, "ContactDampingForm", FORMS, Fixed, "Law of the contact damping"),
    real_param!("effect.contact_damping.damping", effect.contact_damping.damping, "s/m", None, 0.0, 1e3, 3.0, Tunable, "Pressure per pressure and approach speed (form hunt_crossley); 0: none"),
    real_param!("effect.contact_damping.viscosity", effect.contact_damping.viscosity, "Pa.s/m", None, 0.0, 1e9, 5e5, Tunable, "Pressure per approach speed (form kelvin); 0: none"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "contact_damping",
    module: Module::Contact,
    forms: &[
        FitForm {
            name: "hunt_crossley",
            params: &[log("effect.contact_damping.damping", 3.0, 1.0)],
        },
        FitForm {
            name: "kelvin",
            params: &[log("effect.contact_damping.viscosity", 5e5, 1.0)],
        },
    ],
};
