//! Worn edge: the run-in edge has been worn back from the plane of the face.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// Shape of the worn edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// A parabola that leaves the face tangentially: a flat circular arc.
    #[default]
    Rounded,
    /// A straight bevel.
    Chamfer,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Rounded, Self::Chamfer];
}

/// Depth d·(1 − s/L)ⁿ behind the plane of the face at distance s < L from the run-in edge; n = 2
/// rounded (an arc of radius L²/2d), n = 1 chamfer (theory eq. 7.13).
///
/// Shape of worn blocks: Hofstetter et al., and TU Dresden/Hannover, Lubricants 9(12) 113 (2021):
/// the leading edge is worn to 0.1 to 1 mm.
#[derive(Clone, Debug, PartialEq)]
pub struct WornEdge {
    /// Is the effect on?
    pub enabled: bool,
    /// Shape.
    pub form: Form,
    /// Depth d at the edge \[m\].
    pub depth: f64,
    /// Length L of the worn part \[m\].
    pub length: f64,
}

impl Default for WornEdge {
    fn default() -> Self {
        Self { enabled: false, form: Form::Rounded, depth: 100e-6, length: 3e-3 }
    }
}

impl WornEdge {
    /// Depth \[m\] at distance `s` \[m\] from the run-in edge.
    pub fn depth(&self, s: f64) -> f64 {
        let left = (1.0 - s / self.length).max(0.0);
        match self.form {
            _ if !self.enabled => 0.0,
            Form::Rounded => self.depth * left * left,
            Form::Chamfer => self.depth * left,
        }
    }
}

const UM: Option<DisplayUnit> = Some(DisplayUnit { name: "um", factor: 1e6 });
const MM: Option<DisplayUnit> = Some(DisplayUnit { name: "mm", factor: 1e3 });
const FORMS: &[Item] = &[
    Item { name: "rounded", doc: "parabola that leaves the face tangentially" },
    Item { name: "chamfer", doc: "straight bevel" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.worn_edge.enabled", effect.worn_edge.enabled, Fixed, "Worn edge: the run-in edge lies behind the plane of the face"),
    enum_param!("effect.worn_edge.form", effect.worn_edge.form, Form, "WornEdgeForm", FORMS, Fixed, "Shape of the worn edge"),
    real_param!("effect.worn_edge.depth", effect.worn_edge.depth, "m", UM, 0.0, 0.01, 1e-4, Tunable, "Depth worn off at the run-in edge; 0: none"),
    real_param!("effect.worn_edge.length", effect.worn_edge.length, "m", MM, 1e-5, 0.1, 3e-3, Tunable, "Length of the worn part from the run-in edge"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "worn_edge",
    module: Module::Wear,
    forms: &[
        FitForm {
            name: "rounded",
            params: &[
                log("effect.worn_edge.depth", 100e-6, 1.0),
                log("effect.worn_edge.length", 3e-3, 0.5),
            ],
        },
        FitForm {
            name: "chamfer",
            params: &[
                log("effect.worn_edge.depth", 80e-6, 1.0),
                log("effect.worn_edge.length", 3e-3, 0.5),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rounded_edge_is_the_arc_that_it_stands_for() {
        // Circle of radius R = L²/2d touching the face at s = L: the parabola is its second order; the
        // fourth is (L/R)²/4 = 1/900 of the depth.
        let on = WornEdge { enabled: true, ..WornEdge::default() };
        let radius = on.length * on.length / (2.0 * on.depth);
        for s in [0.0, 1e-3, 2.5e-3, 3e-3, 5e-3] {
            let back: f64 = (on.length - s).max(0.0);
            let circle = radius - (radius * radius - back * back).sqrt();
            assert!((on.depth(s) - circle).abs() < 1.2e-3 * on.depth, "{s}");
        }
    }
}
