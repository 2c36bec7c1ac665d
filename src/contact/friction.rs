//! Friction characteristic μ(p, v) with arctan smoothing at v = 0 (paper eq. 1, reconstructed).

use super::friction_table::Table;
use crate::pack::Pack;
use crate::params::{Friction, FrictionForm};
use std::f64::consts::{FRAC_2_PI, LN_10};

/// Pressure below which the pressure dependence of friction stops \[Pa\].
pub const MIN_PRESSURE: f64 = 1e3;

/// Friction coefficients and their derivatives at eight points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mu {
    /// μ \[-\], odd in the sliding speed.
    pub value: Pack,
    /// ∂μ/∂v \[s/m\].
    pub by_speed: Pack,
    /// p·∂μ/∂p \[-\].
    pub by_log_pressure: Pack,
}

/// A friction characteristic.
pub trait FrictionLaw {
    /// Coefficients at local pressures `p` \[Pa\] and sliding speeds `v` \[m/s\].
    fn mu(&self, p: Pack, v: Pack) -> Mu;

    /// Coefficient, ∂μ/∂v and ∂μ/∂p at one point.
    fn at(&self, p: f64, v: f64) -> [f64; 3] {
        let mu = self.mu(Pack::splat(p), Pack::splat(v));
        [mu.value.0[0], mu.by_speed.0[0], mu.by_log_pressure.0[0] / p]
    }

    /// Coefficient before its sign is smoothed over `smoothing_speed` \[m/s\], at one point; not
    /// resolved below the smoothing speed.
    fn level(&self, p: f64, v: f64, smoothing_speed: f64) -> f64 {
        let v = v.abs().max(smoothing_speed);
        let (sign, _) = Smoothing::over(smoothing_speed).sign(Pack::splat(v));
        self.at(p, v)[0] / sign.0[0]
    }
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
    /// See [`TwoExponentials`].
    TwoExponentials(TwoExponentials),
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
            (FrictionForm::TwoExponentials, _) => Self::TwoExponentials(TwoExponentials {
                fast: Exponential { common, exponent: params.decay_exponent },
                slow_share: params.slow_share,
                per_slow_speed: 1.0 / params.slow_speed,
                slow_exponent: params.slow_exponent,
            }),
            (FrictionForm::Table, Some(table)) => {
                let mut table = table.clone();
                table.smoothing_speed = params.smoothing_speed;
                Self::Table(Box::new(table))
            }
            (FrictionForm::Exponential, _) | (FrictionForm::Table, None) => {
                Self::Exponential(Exponential { common, exponent: params.decay_exponent })
            }
        }
    }
}

impl FrictionLaw for Law {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        match self {
            Self::Exponential(law) => law.mu(p, v),
            Self::Rational(law) => law.mu(p, v),
            Self::LogBell(law) => law.mu(p, v),
            Self::Table(law) => law.mu(p, v),
            Self::TwoExponentials(law) => law.mu(p, v),
        }
    }
}

/// Sign of a speed, smoothed about zero: (2/π) atan(v/v_ε). Quotients are made once: laws are evaluated millions of
/// times a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// 1/v_ε \[s/m\].
    per_speed: f64,
    /// Slope at zero \[s/m\].
    steepest: f64,
}

impl Smoothing {
    /// Over a speed v_ε \[m/s\].
    pub fn over(speed: f64) -> Self {
        Self { per_speed: 1.0 / speed, steepest: FRAC_2_PI / speed }
    }

    /// Smoothed sign \[-\] and its derivative \[s/m\].
    #[inline(always)]
    pub fn sign(self, v: Pack) -> (Pack, Pack) {
        let ratio = v * Pack::splat(self.per_speed);
        let slope = Pack::splat(self.steepest) / ratio.mul_add(ratio, Pack::splat(1.0));
        (ratio.atan() * Pack::splat(FRAC_2_PI), slope)
    }
}

/// What the closed forms share: μ = (2/π) atan(v/v_ε) · (max(p, 1 kPa)/p₀)ⁿ · \[μ_∞ + Δμ·fall(|v|)\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    mu_inf: f64,
    mu_drop: f64,
    per_decay_speed: f64,
    smoothing: Smoothing,
    pressure_exponent: f64,
    per_reference_pressure: f64,
}

impl Common {
    fn new(p: &Friction) -> Self {
        Self {
            mu_inf: p.mu_inf,
            mu_drop: p.mu_drop,
            per_decay_speed: 1.0 / p.decay_speed,
            smoothing: Smoothing::over(p.smoothing_speed),
            pressure_exponent: p.pressure_exponent,
            per_reference_pressure: 1.0 / p.reference_pressure,
        }
    }

    /// `fall` is the falling part in \[0, 1\], `slope` its derivative by |v| \[s/m\].
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack, fall: Pack, slope: Pack) -> Mu {
        let splat = Pack::splat;
        let (sign, sign_slope) = self.smoothing.sign(v);
        let level = fall.mul_add(splat(self.mu_drop), splat(self.mu_inf));
        let falling = sign.abs() * splat(self.mu_drop) * slope;
        let (value, by_speed) = (sign * level, sign_slope.mul_add(level, falling));
        if self.pressure_exponent == 0.0 {
            return Mu { value, by_speed, by_log_pressure: splat(0.0) };
        }
        let least = splat(MIN_PRESSURE);
        let ratio = p.max(least) * splat(self.per_reference_pressure);
        let by_p = ratio.powf(self.pressure_exponent);
        let value = by_p * value;
        let by_log_pressure = p.if_above(least, value * splat(self.pressure_exponent), splat(0.0));
        Mu { value, by_speed: by_p * by_speed, by_log_pressure }
    }
}

/// Stretched exponential: fall = exp(−(|v|/v_d)^γ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    common: Common,
    exponent: f64,
}

impl FrictionLaw for Exponential {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        let (fall, slope) = stretched(v, self.common.per_decay_speed, self.exponent);
        self.common.mu(p, v, fall, slope)
    }
}

/// exp(−(|v|·`per_speed`)^`exponent`) and its derivative by |v| \[s/m\].
#[inline(always)]
fn stretched(v: Pack, per_speed: f64, exponent: f64) -> (Pack, Pack) {
    let ratio = v.abs() * Pack::splat(per_speed);
    if exponent == 1.0 {
        let fall = (-ratio).exp();
        return (fall, fall * Pack::splat(-per_speed));
    }
    let power = power(ratio, exponent);
    let fall = (-power).exp();
    (fall, by_speed(v, Pack::splat(-exponent) * power * fall))
}

/// A derivative by |v| from the one by ln |v|; below 10⁻¹² m/s, where the smoothed sign makes nothing of a
/// steep one, that of 10⁻¹² m/s.
#[inline(always)]
fn by_speed(v: Pack, by_log_speed: Pack) -> Pack {
    by_log_speed / v.abs().max(Pack::splat(1e-12))
}

/// Two exponentials: fall = (1 − s) exp(−(|v|/v_d)^γ) + s exp(−(|v|/v_s)^γ_s), each a fall around a speed
/// of its own: sharp for a large exponent, spread over decades for a small one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoExponentials {
    fast: Exponential,
    slow_share: f64,
    per_slow_speed: f64,
    slow_exponent: f64,
}

impl FrictionLaw for TwoExponentials {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        let (share, rest) = (Pack::splat(self.slow_share), Pack::splat(1.0 - self.slow_share));
        let (fast, fast_slope) = stretched(v, self.fast.common.per_decay_speed, self.fast.exponent);
        let (slow, slow_slope) = stretched(v, self.per_slow_speed, self.slow_exponent);
        let fall = rest.mul_add(fast, share * slow);
        self.fast.common.mu(p, v, fall, rest.mul_add(fast_slope, share * slow_slope))
    }
}

/// `ratio` ≥ 0 to the power `exponent` > 0, 0 at 0.
#[inline(always)]
fn power(ratio: Pack, exponent: f64) -> Pack {
    ratio.max(Pack::splat(1e-290)).powf(exponent)
}

/// Rational: fall = 1/(1 + (|v|/v_d)^m); the form of Huemer et al. (2001) with its rising branch left
/// to the smoothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rational {
    common: Common,
    exponent: f64,
}

impl FrictionLaw for Rational {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        let ratio = v.abs() * Pack::splat(self.common.per_decay_speed);
        let power = power(ratio, self.exponent);
        let fall = Pack::splat(1.0) / (power + Pack::splat(1.0));
        let slope = Pack::splat(-self.exponent) * power * fall * fall;
        self.common.mu(p, v, fall, by_speed(v, slope))
    }
}

/// Log-bell (Savkoor): fall = exp(−(k log₁₀(|v|/v_m))²), a maximum at v_m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogBell {
    common: Common,
    steepness: f64,
}

impl FrictionLaw for LogBell {
    #[inline(always)]
    fn mu(&self, p: Pack, v: Pack) -> Mu {
        let ratio = v.abs().max(Pack::splat(1e-12)) * Pack::splat(self.common.per_decay_speed);
        let decades = ratio.ln() * Pack::splat(1.0 / LN_10);
        let scaled = decades * Pack::splat(self.steepness);
        let fall = (-(scaled * scaled)).exp();
        let slope = scaled * fall * Pack::splat(-2.0 * self.steepness / LN_10);
        self.common.mu(p, v, fall, by_speed(v, slope))
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
                    let [mu, by_speed, by_pressure] = law.at(p, v);
                    let by_v = (law.at(p, v + hv)[0] - law.at(p, v - hv)[0]) / (2.0 * hv);
                    let by_p = (law.at(p + hp, v)[0] - law.at(p - hp, v)[0]) / (2.0 * hp);
                    let (scale_v, scale_p) = (mu.abs() / v.abs(), mu.abs() / p);
                    assert!((by_v - by_speed).abs() < 1e-5 * scale_v, "{law:?} p {p} v {v}");
                    assert!((by_p - by_pressure).abs() < 1e-5 * scale_p, "{law:?} p {p} v {v}");
                }
            }
        }
    }

    #[test]
    fn friction_is_odd_in_speed_and_opposes_it() {
        for law in laws() {
            for v in [1e-4, 0.01, 0.3, 2.0] {
                let (forth, back) = (law.at(250e3, v)[0], law.at(250e3, -v)[0]);
                assert!((forth + back).abs() < 1e-14 && forth > 0.0, "{law:?} at {v}");
            }
        }
    }

    #[test]
    fn the_default_law_is_the_one_of_the_measurement_campaigns() {
        // Closed form of the campaigns' README at p = 400 kPa, v = 0.2 m/s, written out here.
        let by_hand = FRAC_2_PI
            * (20.0_f64).atan()
            * (1.6_f64).powf(-0.1)
            * (0.5 + 0.75 * (-2.0_f64 / 3.0).exp());
        let law = Law::new(&Friction::default(), None);
        assert!((law.at(400e3, 0.2)[0] - by_hand).abs() < 1e-14);
    }
}
