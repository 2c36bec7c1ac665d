//! Friction characteristic μ(p, v) with arctan smoothing at v = 0 (paper eq. 1, reconstructed).

use super::friction_table::Table;
use crate::params::{Friction, FrictionForm};
use std::f64::consts::{FRAC_2_PI, LN_10};

/// Pressure below which the pressure dependence of friction stops [Pa].
pub const MIN_PRESSURE: f64 = 1e3;

/// Friction coefficient and its derivatives at one point.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Mu {
    /// μ [-], odd in the sliding speed.
    pub value: f64,
    /// ∂μ/∂v [s/m].
    pub by_speed: f64,
    /// ∂μ/∂p [1/Pa].
    pub by_pressure: f64,
}

/// A friction characteristic.
pub trait FrictionLaw {
    /// Coefficient at local pressure `p` [Pa] and sliding speed `v` [m/s].
    fn mu(&self, p: f64, v: f64) -> Mu;
}

/// The law that the parameters ask for.
#[derive(Clone, Debug)]
pub enum Law {
    /// See [`Exponential`].
    Exponential(Exponential),
    /// See [`Rational`].
    Rational(Rational),
    /// See [`LogBell`].
    LogBell(LogBell),
    /// See [`Table`].
    Table(Box<Table>),
}

impl Law {
    /// The law of the parameters; `table` is the measured characteristic for the form `table`.
    pub fn new(params: &Friction, table: Option<&Table>) -> Self {
        let common = Common::new(params);
        match (params.form, table) {
            (FrictionForm::Rational, _) => {
                Self::Rational(Rational { common, exponent: params.rational_exponent })
            }
            (FrictionForm::LogBell, _) => {
                Self::LogBell(LogBell { common, steepness: params.bell_steepness })
            }
            (FrictionForm::Table, Some(table)) => {
                let mut table = table.clone();
                table.smoothing_speed = params.smoothing_speed;
                Self::Table(Box::new(table))
            }
            _ => Self::Exponential(Exponential { common, exponent: params.decay_exponent }),
        }
    }
}

impl FrictionLaw for Law {
    fn mu(&self, p: f64, v: f64) -> Mu {
        match self {
            Self::Exponential(law) => law.mu(p, v),
            Self::Rational(law) => law.mu(p, v),
            Self::LogBell(law) => law.mu(p, v),
            Self::Table(law) => law.mu(p, v),
        }
    }
}

/// What the closed forms share: μ = (2/π) atan(v/v_ε) · (max(p, 1 kPa)/p₀)ⁿ · [μ_∞ + Δμ·fall(|v|)].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    mu_inf: f64,
    mu_drop: f64,
    decay_speed: f64,
    smoothing_speed: f64,
    pressure_exponent: f64,
    reference_pressure: f64,
}

impl Common {
    fn new(p: &Friction) -> Self {
        Self {
            mu_inf: p.mu_inf,
            mu_drop: p.mu_drop,
            decay_speed: p.decay_speed,
            smoothing_speed: p.smoothing_speed,
            pressure_exponent: p.pressure_exponent,
            reference_pressure: p.reference_pressure,
        }
    }

    /// `fall` is the falling part in [0, 1], `speed_slope` is |v|·d fall/d|v| (finite at v = 0).
    fn mu(&self, p: f64, v: f64, fall: f64, speed_slope: f64) -> Mu {
        let (sign, slope) = smoothed_sign(v, self.smoothing_speed);
        let bounded = p.max(MIN_PRESSURE);
        let by_p = (bounded / self.reference_pressure).powf(self.pressure_exponent);
        let level = self.mu_inf + self.mu_drop * fall;
        // sign · d level/d|v| · d|v|/dv = (sign/v) · |v| d level/d|v|; sign/v → slope as v → 0.
        let sign_over_v = if v.abs() < 1e-12 { slope } else { sign / v };
        Mu {
            value: by_p * sign * level,
            by_speed: by_p * (slope * level + sign_over_v * self.mu_drop * speed_slope),
            by_pressure: if p > MIN_PRESSURE {
                self.pressure_exponent / bounded * by_p * sign * level
            } else {
                0.0
            },
        }
    }
}

/// Smoothed sign (2/π) atan(v/v_ε) and its derivative [s/m].
pub fn smoothed_sign(v: f64, smoothing_speed: f64) -> (f64, f64) {
    let ratio = v / smoothing_speed;
    (FRAC_2_PI * ratio.atan(), FRAC_2_PI / (smoothing_speed * (1.0 + ratio * ratio)))
}

/// Stretched exponential: fall = exp(−(|v|/v_d)^γ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    common: Common,
    exponent: f64,
}

impl FrictionLaw for Exponential {
    fn mu(&self, p: f64, v: f64) -> Mu {
        let ratio = v.abs() / self.common.decay_speed;
        let power = if self.exponent == 1.0 { ratio } else { ratio.powf(self.exponent) };
        let fall = (-power).exp();
        self.common.mu(p, v, fall, -self.exponent * power * fall)
    }
}

/// Rational: fall = 1/(1 + (|v|/v_d)^m); the form of Huemer et al. (2001) with its rising branch left
/// to the smoothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rational {
    common: Common,
    exponent: f64,
}

impl FrictionLaw for Rational {
    fn mu(&self, p: f64, v: f64) -> Mu {
        let power = (v.abs() / self.common.decay_speed).powf(self.exponent);
        let fall = 1.0 / (1.0 + power);
        self.common.mu(p, v, fall, -self.exponent * power * fall * fall)
    }
}

/// Log-bell (Savkoor): fall = exp(−(k log₁₀(|v|/v_m))²), a maximum at v_m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogBell {
    common: Common,
    steepness: f64,
}

impl FrictionLaw for LogBell {
    fn mu(&self, p: f64, v: f64) -> Mu {
        let decades = (v.abs().max(1e-12) / self.common.decay_speed).log10();
        let fall = (-(self.steepness * decades).powi(2)).exp();
        let slope = -2.0 * self.steepness * self.steepness * decades / LN_10 * fall;
        self.common.mu(p, v, fall, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<Law> {
        let mut out = Vec::new();
        for form in FrictionForm::ALL {
            for exponent in [0.6, 1.0] {
                let params = Friction { form, decay_exponent: exponent, ..Friction::default() };
                out.push(Law::new(&params, Some(&Table::example())));
            }
        }
        out
    }

    #[test]
    fn every_law_has_the_derivatives_that_finite_differences_find() {
        // Central differences, step 1e-6 of the argument: truncation and rounding below 1e-5.
        for law in laws() {
            for p in [3e3, 80e3, 260e3, 900e3] {
                for v in [-1.3, -0.02, -1.1e-3, 2e-4, 5e-3, 0.11, 0.7] {
                    let (hp, hv) = (1e-6 * p, 1e-6 * v);
                    let mu = law.mu(p, v);
                    let by_v = (law.mu(p, v + hv).value - law.mu(p, v - hv).value) / (2.0 * hv);
                    let by_p = (law.mu(p + hp, v).value - law.mu(p - hp, v).value) / (2.0 * hp);
                    let scale_v = mu.value.abs() / v.abs();
                    assert!((by_v - mu.by_speed).abs() < 1e-5 * scale_v, "{law:?} p {p} v {v}");
                    assert!((by_p - mu.by_pressure).abs() < 1e-5 * mu.value.abs() / p, "{law:?} {p}");
                }
            }
        }
    }

    #[test]
    fn friction_is_odd_in_speed_and_opposes_it() {
        for law in laws() {
            for v in [1e-4, 0.01, 0.3, 2.0] {
                let (forth, back) = (law.mu(250e3, v).value, law.mu(250e3, -v).value);
                assert!((forth + back).abs() < 1e-14 && forth > 0.0, "{law:?} at {v}");
            }
        }
    }

    #[test]
    fn the_default_law_is_the_one_of_the_measurement_campaigns() {
        // Closed form of the campaigns' README at p = 400 kPa, v = 0.2 m/s, written out here.
        let by_hand = FRAC_2_PI * (20.0_f64).atan()
            * (1.6_f64).powf(-0.1)
            * (0.5 + 0.75 * (-2.0_f64 / 3.0).exp());
        let law = Law::new(&Friction::default(), None);
        assert!((law.mu(400e3, 0.2).value - by_hand).abs() < 1e-14);
    }
}
