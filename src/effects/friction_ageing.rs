//! Ageing of the contact: friction grows with the time of contact (rate and state).

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// How age strengthens the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// Without bound, with the logarithm of age.
    #[default]
    Dieterich,
    /// Towards a bound, exponentially.
    Saturating,
    /// Added to the characteristic, with the logarithm of age.
    Additive,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 3] = [Self::Dieterich, Self::Saturating, Self::Additive];
}

/// Contact age per node (theory eqs. 7.3 to 7.5); friction is multiplied by a factor that is 1 in steady sliding at the
/// reference speed v_r, so that the friction law keeps its meaning.
///
/// `dieterich` (ageing law, Dieterich, J. Geophys. Res. 84, 1979): θ̇ = 1 − |v|θ/D_c and
/// 1 + b·\[ln(1 + θ/t_c) − ln(1 + θ_r/t_c)\], θ_r = D_c/v_r. `saturating` (exponential growth of static
/// friction with rest: Brockley and Davis, J. Lubr. Technol. 90, 1968): share φ of full strength,
/// φ̇ = (1 − φ)/t_c − |v|φ/D_c, and 1 + b·(φ − φ_r). `additive` (the sum of rate and state as Ruina,
/// J. Geophys. Res. 88, 1983, writes it, with the ageing law): μ(p, v) + b·ln(1 + θ/t_c) at the pressure
/// of reference, the characteristic being that of a contact without age. Ruina's slip law is left out:
/// its contacts do not age at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionAgeing {
    /// Is the effect on?
    pub enabled: bool,
    /// How age strengthens the contact.
    pub form: Form,
    /// Strength b \[-\].
    pub strength: f64,
    /// Sliding distance D_c \[m\] that renews the contact.
    pub distance: f64,
    /// Time t_c \[s\] from which age counts (dieterich) or in which strength saturates (saturating).
    pub time: f64,
    /// Speed v_r \[m/s\] in which the factor is 1 (not for additive).
    pub reference_speed: f64,
    /// Age \[s\] of the contact at initialization: the time at rest under load before it.
    pub initial_age: f64,
}

impl Default for FrictionAgeing {
    fn default() -> Self {
        Self {
            enabled: false,
            form: Form::Dieterich,
            strength: 0.08,
            distance: 10e-6,
            time: 1e-4,
            reference_speed: 0.3,
            initial_age: 0.0,
        }
    }
}

/// Friction coefficient below which nothing is added: where there is no friction, contacts do not hold.
const LEAST_LEVEL: f64 = 1e-3;

impl FrictionAgeing {
    /// Ages every node over `h` \[s\] of sliding at `slip` \[m/s\]; exact for constant speed. The age is
    /// θ \[s\] (dieterich) or the share φ of full strength (saturating).
    pub fn age(&self, h: f64, slip: &[f64], age: &mut [f64]) {
        let healing = match self.form {
            Form::Dieterich | Form::Additive => 0.0,
            Form::Saturating => 1.0 / self.time,
        };
        let growth = match self.form {
            Form::Dieterich | Form::Additive => 1.0,
            Form::Saturating => 1.0 / self.time,
        };
        let per_distance = 1.0 / self.distance;
        for (age, v) in age.iter_mut().zip(slip) {
            let x = h * (healing + v.abs() * per_distance);
            let kept = (-x).exp();
            // (1 − e⁻ˣ)/x, continued to x = 0.
            let mean = if x > 1e-6 { (1.0 - kept) / x } else { 1.0 - 0.5 * x };
            *age = *age * kept + growth * h * mean;
        }
    }

    /// Ages every node over `duration` \[s\] at rest.
    pub fn rest(&self, duration: f64, age: &mut [f64]) {
        for age in age {
            match self.form {
                Form::Dieterich | Form::Additive => *age += duration,
                Form::Saturating => *age = 1.0 + (*age - 1.0) * (-duration / self.time).exp(),
            }
        }
    }

    /// Is friction added rather than multiplied?
    pub fn is_added(&self) -> bool {
        self.enabled && self.form == Form::Additive
    }

    /// Factor that adds b·ln(1 + θ/t_c) to a friction coefficient `level`.
    pub fn added(&self, age: f64, level: f64) -> f64 {
        1.0 + self.strength * (age / self.time).ln_1p() / level.max(LEAST_LEVEL)
    }

    /// Factor on friction at `age`; 1 where friction is added.
    pub fn factor(&self, age: f64) -> f64 {
        let sliding = self.reference_speed / self.distance;
        let gain = match self.form {
            Form::Dieterich => {
                (age / self.time).ln_1p() - (1.0 / (sliding * self.time)).ln_1p()
            }
            Form::Saturating => age - 1.0 / (1.0 + sliding * self.time),
            Form::Additive => 0.0,
        };
        1.0 + self.strength * gain
    }
}

const UM: Option<DisplayUnit> = Some(DisplayUnit { name: "um", factor: 1e6 });
const MS: Option<DisplayUnit> = Some(DisplayUnit { name: "ms", factor: 1e3 });
const MM_S: Option<DisplayUnit> = Some(DisplayUnit { name: "mm/s", factor: 1e3 });
const FORMS: &[Item] = &[
    Item { name: "dieterich", doc: "grows with the logarithm of age" },
    Item { name: "saturating", doc: "grows exponentially towards a bound" },
    Item { name: "additive", doc: "adds to the friction characteristic with the logarithm of age (rate and state)" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.friction_ageing.enabled", effect.friction_ageing.enabled, Fixed, "Ageing of the contact: friction grows with the time of contact"),
    enum_param!("effect.friction_ageing.form", effect.friction_ageing.form, Form, "FrictionAgeingForm", FORMS, Fixed, "How age strengthens the contact"),
    real_param!("effect.friction_ageing.strength", effect.friction_ageing.strength, "1", None, 0.0, 20.0, 0.08, Tunable, "Strength: gain of friction per e-fold of age, or in all (form saturating); 0: none"),
    real_param!("effect.friction_ageing.distance", effect.friction_ageing.distance, "m", UM, 1e-8, 1e-2, 1e-5, Tunable, "Sliding distance that renews the contact"),
    real_param!("effect.friction_ageing.time", effect.friction_ageing.time, "s", MS, 1e-7, 1e4, 1e-4, Tunable, "Time from which age counts, or in which strength saturates"),
    real_param!("effect.friction_ageing.reference_speed", effect.friction_ageing.reference_speed, "m/s", MM_S, 1e-4, 100.0, 0.3, Tunable, "Speed of steady sliding at which friction is as without the effect"),
    real_param!("effect.friction_ageing.initial_age", effect.friction_ageing.initial_age, "s", None, 0.0, 1e9, 1e-2, Tunable, "Time at rest under load before initialization"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "friction_ageing",
    module: Module::Friction,
    forms: &[
        FitForm {
            name: "dieterich",
            params: &[
                log("effect.friction_ageing.strength", 0.2, 0.8),
                log("effect.friction_ageing.distance", 30e-6, 0.9),
                log("effect.friction_ageing.time", 1e-4, 1.0),
                log("effect.friction_ageing.initial_age", 0.015, 1.5),
            ],
        },
        FitForm {
            name: "saturating",
            params: &[
                log("effect.friction_ageing.strength", 0.7, 0.8),
                log("effect.friction_ageing.distance", 30e-6, 0.9),
                log("effect.friction_ageing.time", 3e-3, 1.0),
                log("effect.friction_ageing.initial_age", 0.015, 1.5),
            ],
        },
        FitForm {
            name: "additive",
            params: &[
                log("effect.friction_ageing.strength", 0.06, 0.8),
                log("effect.friction_ageing.distance", 30e-6, 0.9),
                log("effect.friction_ageing.time", 1e-4, 1.0),
                log("effect.friction_ageing.initial_age", 0.015, 1.5),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_sliding_at_the_reference_speed_leaves_friction_alone() {
        // Closed form of the steady state, after 10 renewals: e⁻¹⁰ of the age is left, times b.
        for form in Form::ALL {
            let on = FrictionAgeing { form, ..FrictionAgeing::default() };
            let mut age = [0.0];
            on.age(10.0 * on.distance / 0.3, &[-0.3], &mut age);
            assert!((on.factor(age[0]) - 1.0).abs() < 1e-5, "{form:?}");
        }
    }

    #[test]
    fn additive_friction_is_the_sum_of_rate_and_state() {
        // Closed form: 0.08·ln(1 + 1 s/0.1 ms) on top of 0.7, with 0.7 in front.
        let on = FrictionAgeing { form: Form::Additive, ..FrictionAgeing::default() };
        let expected = 0.7 + 0.08 * 10_001.0_f64.ln();
        assert!((0.7 * on.added(1.0, 0.7) - expected).abs() < 1e-14);
    }

    #[test]
    fn ten_times_the_rest_adds_b_ln_10() {
        // ln(1 + t/t_c) with t ≫ t_c; the rest of the logarithm is t_c/t = 1e-3.
        let on = FrictionAgeing::default();
        let (mut short, mut long) = ([0.0], [0.0]);
        on.rest(0.1, &mut short);
        on.rest(1.0, &mut long);
        let gain = on.factor(long[0]) - on.factor(short[0]);
        assert!((gain - 0.08 * 10.0_f64.ln()).abs() < 0.08 * 1e-3, "{gain}");
    }

    #[test]
    fn slow_sliding_ages_as_rest_does() {
        // |v| = 1e-12 m/s: the renewal term is 1e-7 per second of age.
        for form in Form::ALL {
            let on = FrictionAgeing { form, ..FrictionAgeing::default() };
            let (mut slid, mut rested) = ([1e-4], [1e-4]);
            on.age(1e-3, &[1e-12], &mut slid);
            on.rest(1e-3, &mut rested);
            assert!((slid[0] / rested[0] - 1.0).abs() < 1e-6, "{form:?}");
        }
    }
}
