//! Frequency-dependent modulus: Maxwell branches beside the static modulus.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// One branch of a generalised Maxwell model beside the elastic modulus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Modulus of the branch over Young's modulus \[-\].
    pub share: f64,
    /// Relaxation time \[s\].
    pub time: f64,
}

/// Number of branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// One branch: the standard linear solid.
    #[default]
    OneBranch,
    /// Two branches a decade apart, half the share each.
    TwoBranches,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::OneBranch, Self::TwoBranches];
}

/// E(ω) = E·(1 + Σ gⱼ jωτⱼ/(1 + jωτⱼ)): the static modulus is E, the one far above 1/τ is (1 + g)E (theory eq. 7.7).
///
/// Generalised Maxwell (Prony) model of rubber; for a tread block Liu, Sutcliffe and Graham, Tire
/// Sci. Technol. 36(3) (2008). The damping β stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct ViscoelasticModulus {
    /// Is the effect on?
    pub enabled: bool,
    /// Number of branches.
    pub form: Form,
    /// Rise of the modulus from slow to fast over the static one, g = Σ gⱼ \[-\].
    pub share: f64,
    /// Relaxation time τ \[s\]; with two branches the geometric mean of theirs.
    pub time: f64,
}

impl Default for ViscoelasticModulus {
    fn default() -> Self {
        Self { enabled: false, form: Form::OneBranch, share: 0.5, time: 100e-6 }
    }
}

impl ViscoelasticModulus {
    /// The branches in force; none where the effect is off.
    pub fn branches(&self) -> Vec<Branch> {
        let branch = |share: f64, time: f64| Branch { share, time };
        match self.form {
            _ if !self.enabled || self.share == 0.0 => Vec::new(),
            Form::OneBranch => vec![branch(self.share, self.time)],
            Form::TwoBranches => {
                let apart = 10.0_f64.sqrt();
                let half = 0.5 * self.share;
                vec![branch(half, self.time / apart), branch(half, self.time * apart)]
            }
        }
    }
}

const US: Option<DisplayUnit> = Some(DisplayUnit { name: "us", factor: 1e6 });
const FORMS: &[Item] = &[
    Item { name: "one_branch", doc: "one Maxwell branch" },
    Item { name: "two_branches", doc: "two Maxwell branches a decade apart" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.viscoelastic_modulus.enabled", effect.viscoelastic_modulus.enabled, Fixed, "Frequency-dependent modulus: Maxwell branches beside Young's modulus, which is then the static one"),
    enum_param!("effect.viscoelastic_modulus.form", effect.viscoelastic_modulus.form, Form, "ViscoelasticModulusForm", FORMS, Fixed, "Number of Maxwell branches"),
    real_param!("effect.viscoelastic_modulus.share", effect.viscoelastic_modulus.share, "1", None, 0.0, 20.0, 0.5, Fixed, "Rise of the modulus from slow to fast over the static modulus; 0: none"),
    real_param!("effect.viscoelastic_modulus.time", effect.viscoelastic_modulus.time, "s", US, 1e-7, 10.0, 1e-4, Fixed, "Relaxation time; with two branches the geometric mean of theirs"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "viscoelastic_modulus",
    module: Module::Dynamic,
    forms: &[
        FitForm {
            name: "one_branch",
            params: &[
                log("effect.viscoelastic_modulus.share", 0.5, 0.8),
                log("effect.viscoelastic_modulus.time", 100e-6, 1.0),
            ],
        },
        FitForm {
            name: "two_branches",
            params: &[
                log("effect.viscoelastic_modulus.share", 0.6, 0.8),
                log("effect.viscoelastic_modulus.time", 100e-6, 1.0),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_rise_by_the_share_from_slow_to_fast() {
        // Closed form: the sum of g over the branches is the rise from frequency 0 to infinity.
        for form in Form::ALL {
            let on = ViscoelasticModulus { enabled: true, form, share: 0.8, time: 1e-4 };
            let sum: f64 = on.branches().iter().map(|b| b.share).sum();
            let mean: f64 = on.branches().iter().map(|b| b.time.ln()).sum::<f64>();
            assert!((sum - 0.8).abs() < 1e-15);
            assert!((mean / on.branches().len() as f64 - 1e-4_f64.ln()).abs() < 1e-12);
        }
    }
}
