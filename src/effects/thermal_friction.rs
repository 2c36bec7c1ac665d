//! Flash temperature: friction heats the asperities of the contact, and warm rubber rubs less.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};

/// How heat is kept and how it lowers friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// A warm skin that cools in time.
    #[default]
    Lumped,
    /// Macroasperities that warm up over a sliding distance.
    Macroasperity,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Lumped, Self::Macroasperity];
}

/// Flash temperature rise T \[K\] per contact node, from the friction power density q = μ p |v| (theory eqs. 7.1, 7.2).
///
/// `lumped`: Ṫ = q/(ρ c δ φ) − T/τ with the skin δ = √(κτ/ρc) that heat reaches within τ, and
/// μ → μ/(1 + c_T T). `macroasperity` (Persson, J. Phys.: Condens. Matter 18, 2006; memory over the
/// sliding distance: Persson and Miyashita, arXiv 2602.22078): T tends to
/// q D/(8κφ)/√(1 + (π/2)|v|D/D_th) over the distance D, cools at rest with D²/D_th, and
/// μ → μ exp(−c_T T). φ = 2 % is the share of the macroasperity contact in the face.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalFriction {
    /// Is the effect on?
    pub enabled: bool,
    /// How heat is kept.
    pub form: Form,
    /// Sensitivity c_T of friction to the temperature rise \[1/K\].
    pub sensitivity: f64,
    /// Time constant τ \[s\] of the form `lumped`.
    pub time: f64,
    /// Diameter D \[m\] of a macroasperity.
    pub distance: f64,
}

impl Default for ThermalFriction {
    fn default() -> Self {
        Self { enabled: false, form: Form::Lumped, sensitivity: 5e-3, time: 2e-3, distance: 5e-4 }
    }
}

/// Heat conductivity κ of rubber \[W/(m K)\].
const CONDUCTIVITY: f64 = 0.3;
/// Heat capacity ρc of rubber \[J/(m³ K)\].
const CAPACITY: f64 = 1150.0 * 1500.0;
/// Share φ of the macroasperity contact in the face \[-\].
const CONTACT_SHARE: f64 = 0.02;

impl ThermalFriction {
    /// Temperature rise \[K\] of each node after `h` \[s\] in which it slides at `slip` \[m/s\] with the
    /// tangential force `force` \[N\] on `area` \[m²\]; exact for constant power.
    pub fn warm(&self, h: f64, slip: &[f64], force: &[f64], area: &[f64], rise: &mut [f64]) {
        let diffusivity = CONDUCTIVITY / CAPACITY;
        match self.form {
            Form::Lumped => {
                let skin = (diffusivity * self.time).sqrt();
                let per_power = self.time / (CAPACITY * skin * CONTACT_SHARE);
                let kept = (-h / self.time).exp();
                for (((rise, v), f), a) in rise.iter_mut().zip(slip).zip(force).zip(area) {
                    let steady = per_power * (v * f).abs() / a;
                    *rise = steady + (*rise - steady) * kept;
                }
            }
            Form::Macroasperity => {
                let d = self.distance;
                let per_power = d / (8.0 * CONDUCTIVITY * CONTACT_SHARE);
                let cooling = diffusivity / (d * d);
                for (((rise, v), f), a) in rise.iter_mut().zip(slip).zip(force).zip(area) {
                    let speed = v.abs();
                    let peclet = std::f64::consts::FRAC_PI_2 * speed * d / diffusivity;
                    let steady = per_power * speed * f.abs() / a / (1.0 + peclet).sqrt();
                    let rate = speed / d + cooling;
                    let target = steady * (speed / d) / rate;
                    *rise = target + (*rise - target) * (-h * rate).exp();
                }
            }
        }
    }

    /// Cools the contact over `duration` \[s\] at rest.
    pub fn rest(&self, duration: f64, rise: &mut [f64]) {
        let rate = match self.form {
            Form::Lumped => 1.0 / self.time,
            Form::Macroasperity => CONDUCTIVITY / CAPACITY / (self.distance * self.distance),
        };
        rise.iter_mut().for_each(|t| *t *= (-duration * rate).exp());
    }

    /// Factor on friction at a temperature rise `rise` \[K\].
    pub fn factor(&self, rise: f64) -> f64 {
        match self.form {
            Form::Lumped => 1.0 / (1.0 + self.sensitivity * rise),
            Form::Macroasperity => (-self.sensitivity * rise).exp(),
        }
    }
}

const MS: Option<DisplayUnit> = Some(DisplayUnit { name: "ms", factor: 1e3 });
const MM: Option<DisplayUnit> = Some(DisplayUnit { name: "mm", factor: 1e3 });
const FORMS: &[Item] = &[
    Item { name: "lumped", doc: "a warm skin that cools in time; mu/(1 + sensitivity T)" },
    Item { name: "macroasperity", doc: "asperities that warm up over a distance; mu exp(-sensitivity T)" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.thermal_friction.enabled", effect.thermal_friction.enabled, Fixed, "Flash temperature: friction power lowers friction"),
    enum_param!("effect.thermal_friction.form", effect.thermal_friction.form, Form, "ThermalFrictionForm", FORMS, Fixed, "How heat is kept and lowers friction"),
    real_param!("effect.thermal_friction.sensitivity", effect.thermal_friction.sensitivity, "1/K", None, 0.0, 1.0, 5e-3, Tunable, "Relative fall of friction per flash temperature; 0: none"),
    real_param!("effect.thermal_friction.time", effect.thermal_friction.time, "s", MS, 1e-6, 1e3, 2e-3, Tunable, "Time in which the warm skin cools (form lumped)"),
    real_param!("effect.thermal_friction.distance", effect.thermal_friction.distance, "m", MM, 1e-6, 0.1, 5e-4, Tunable, "Diameter of a macroasperity: sliding distance of warming up (form macroasperity)"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "thermal_friction",
    module: Module::Friction,
    forms: &[
        FitForm {
            name: "lumped",
            params: &[
                log("effect.thermal_friction.sensitivity", 5e-3, 1.0),
                log("effect.thermal_friction.time", 2e-3, 1.0),
            ],
        },
        FitForm {
            name: "macroasperity",
            params: &[
                log("effect.thermal_friction.sensitivity", 1e-2, 1.0),
                log("effect.thermal_friction.distance", 5e-4, 0.8),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    fn after(on: &ThermalFriction, time: f64, steps: usize, v: f64) -> f64 {
        let mut rise = [0.0];
        for _ in 0..steps {
            // 0.2 N on 1 mm²: 200 kPa of friction.
            on.warm(time / steps as f64, &[v], &[-0.2], &[1e-6], &mut rise);
        }
        rise[0]
    }

    #[test]
    fn constant_power_warms_the_same_whatever_the_step() {
        // Exact exponential integration: a hundred steps and one agree to rounding.
        for form in Form::ALL {
            let on = ThermalFriction { form, ..ThermalFriction::default() };
            let (one, many) = (after(&on, 1e-3, 1, 0.3), after(&on, 1e-3, 100, 0.3));
            assert!((one / many - 1.0).abs() < 1e-12, "{form:?}: {one} {many}");
        }
    }

    #[test]
    fn the_steady_temperature_is_the_closed_form() {
        // q = 200 kPa · 0.3 m/s. Lumped: qτ/(ρcδφ) = 60e3 √(τ/(κρc))/φ = 187 K at τ = 2 ms.
        let lumped = ThermalFriction::default();
        let expected = 60e3 * (2e-3_f64 / (0.3 * 1150.0 * 1500.0)).sqrt() / 0.02;
        assert!((after(&lumped, 1.0, 10, 0.3) / expected - 1.0).abs() < 1e-12);
        // Macroasperity: q D/(8κφ)/√(1 + (π/2) v D/D_th), less the share 1e-3 lost by cooling.
        let macro_ = ThermalFriction { form: Form::Macroasperity, ..ThermalFriction::default() };
        let peclet: f64 = 0.3 * 5e-4 / (0.3 / (1150.0 * 1500.0));
        let expected = 60e3 * 5e-4 / (8.0 * 0.3 * 0.02) / (1.0 + std::f64::consts::FRAC_PI_2 * peclet).sqrt();
        let got = after(&macro_, 1.0, 10, 0.3);
        assert!((got / expected - 1.0).abs() < 2e-3, "{got} {expected}");
    }

    #[test]
    fn a_cold_contact_and_no_sensitivity_leave_friction_alone() {
        for form in Form::ALL {
            let on = ThermalFriction { form, ..ThermalFriction::default() };
            assert_eq!(on.factor(0.0), 1.0);
            assert_eq!(ThermalFriction { sensitivity: 0.0, ..on }.factor(80.0), 1.0);
        }
    }
}
