//! Misalignment: the tread face is tilted against the road.

use super::fit::{signed, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// Shape of the gap between a misaligned face and the road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// Linear over the face: the block is mounted at an angle.
    #[default]
    Wedge,
    /// Linear over the run-in half only: face or road are bent.
    Bend,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Wedge, Self::Bend];
}

/// A gap g(x) = −x·tan φ before the face touches, x from the middle of the face towards run-out: a
/// positive angle opens the run-in edge (theory eq. 7.14).
///
/// First order of a rotation by φ: pressure shifts towards the run-out edge by ∂p/∂u·l·φ/2
/// (wedge of gap, as in any alignment error of a tribometer). The carriage does not turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Misalignment {
    /// Is the effect on?
    pub enabled: bool,
    /// Shape of the gap.
    pub form: Form,
    /// Angle φ \[rad\].
    pub angle: f64,
}

impl Default for Misalignment {
    fn default() -> Self {
        Self { enabled: false, form: Form::Wedge, angle: 2e-3 }
    }
}

impl Misalignment {
    /// Gap \[m\] at `x` \[m\] from the middle of the face.
    pub fn gap(&self, x: f64) -> f64 {
        let reach = match self.form {
            _ if !self.enabled => return 0.0,
            Form::Wedge => x,
            Form::Bend => x.min(0.0),
        };
        -reach * self.angle.tan()
    }
}

const DEG: Option<DisplayUnit> =
    Some(DisplayUnit { name: "deg", factor: 180.0 / std::f64::consts::PI });
const FORMS: &[Item] = &[
    Item { name: "wedge", doc: "linear over the whole face" },
    Item { name: "bend", doc: "linear over the run-in half of the face" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.misalignment.enabled", effect.misalignment.enabled, Fixed, "Misalignment: the tread face is tilted against the road"),
    enum_param!("effect.misalignment.form", effect.misalignment.form, Form, "MisalignmentForm", FORMS, Fixed, "Shape of the gap between face and road"),
    real_param!("effect.misalignment.angle", effect.misalignment.angle, "rad", DEG, -0.1, 0.1, 2e-3, Tunable, "Angle between face and road; positive opens the run-in edge; 0: none"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "misalignment",
    module: Module::Rig,
    forms: &[
        FitForm { name: "wedge", params: &[signed("effect.misalignment.angle", 0.0, 6e-3)] },
        FitForm { name: "bend", params: &[signed("effect.misalignment.angle", 0.0, 8e-3)] },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_positive_angle_opens_the_run_in_edge() {
        // Closed form: 7.5 mm times 2 mrad is 15 um.
        let on = Misalignment { enabled: true, ..Misalignment::default() };
        assert!((on.gap(-7.5e-3) - 15e-6).abs() < 1e-9);
        assert!((on.gap(7.5e-3) + 15e-6).abs() < 1e-9);
        assert_eq!(Misalignment::default().gap(-7.5e-3), 0.0);
    }
}
