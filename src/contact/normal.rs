//! Nonlinear contact stiffness: pressure over local compression (paper eq. 2).

use crate::pack::Pack;
use crate::params::{Contact, ContactForm};

/// Pressure p \[Pa\] and stiffness dp/du \[Pa/m\] at a compression u \[m\]; both 0 for u ≤ 0 (lift-off).
/// `per_depth` is 1/u₀ \[1/m\], which is not divided anew millions of times a second.
///
/// Exponential: p = p_r (exp(u/u₀) − 1), after the logarithmic law of tyre-road contact (Wang et
/// al., Tribol. Lett. 56, 2014). Power: p = p_r (u/u₀)^m.
#[inline(always)]
pub fn pressures(law: &Contact, per_depth: f64, compression: Pack) -> (Pack, Pack) {
    let splat = Pack::splat;
    let (p_r, zero) = (law.reference_pressure, splat(0.0));
    let ratio = compression * splat(per_depth);
    let (p, stiffness) = match law.form {
        ContactForm::Exponential => {
            // Beyond 40 e-folds the tangent continues: no solver iterate may overflow.
            let bounded = ratio.min(splat(40.0));
            let grown = bounded.exp();
            let p = grown - splat(1.0) + grown * (ratio - bounded);
            (p * splat(p_r), grown * splat(p_r * per_depth))
        }
        ContactForm::Power => {
            let lower = ratio.max(splat(1e-200)).powf(law.exponent - 1.0);
            (ratio * lower * splat(p_r), lower * splat(p_r * law.exponent * per_depth))
        }
    };
    (compression.if_above(zero, p, zero), compression.if_above(zero, stiffness, zero))
}

/// [`pressures`] at one compression.
pub fn pressure(law: &Contact, compression: f64) -> (f64, f64) {
    let (p, stiffness) = pressures(law, 1.0 / law.depth, Pack::splat(compression));
    (p.0[0], stiffness.0[0])
}

/// Compression u \[m\] at which the law gives `pressure` \[Pa\].
pub fn compression(law: &Contact, pressure: f64) -> f64 {
    let ratio = (pressure / law.reference_pressure).max(0.0);
    match law.form {
        ContactForm::Exponential => law.depth * ratio.ln_1p(),
        ContactForm::Power => law.depth * ratio.powf(1.0 / law.exponent),
    }
}

/// Elastic energy per area ∫₀ᵘ p du \[J/m²\] stored in the contact springs.
pub fn energy(law: &Contact, compression: f64) -> f64 {
    if compression <= 0.0 {
        return 0.0;
    }
    let (p_r, u0, ratio) = (law.reference_pressure, law.depth, compression / law.depth);
    match law.form {
        ContactForm::Exponential => p_r * u0 * (ratio.exp_m1() - ratio),
        ContactForm::Power => p_r * u0 * ratio.powf(law.exponent + 1.0) / (law.exponent + 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<Contact> {
        let power = Contact { form: ContactForm::Power, exponent: 2.5, ..Contact::default() };
        vec![Contact::default(), power]
    }

    #[test]
    fn stiffness_is_the_derivative_of_pressure_and_pressure_that_of_energy() {
        // Central differences at 1e-4 of the depth: error about 1e-8 relative.
        for law in laws() {
            for u in [1e-6, 2e-5, 6e-5, 1.5e-4] {
                let h = 1e-4 * u;
                let slope = (pressure(&law, u + h).0 - pressure(&law, u - h).0) / (2.0 * h);
                let work = (energy(&law, u + h) - energy(&law, u - h)) / (2.0 * h);
                let (p, dp) = pressure(&law, u);
                assert!((slope / dp - 1.0).abs() < 1e-6, "{law:?} at {u}: {slope} vs {dp}");
                assert!((work / p - 1.0).abs() < 1e-6, "{law:?} at {u}: {work} vs {p}");
            }
        }
    }

    #[test]
    fn compression_inverts_pressure() {
        for law in laws() {
            let u = compression(&law, 250e3);
            assert!((pressure(&law, u).0 / 250e3 - 1.0).abs() < 1e-12);
        }
    }
}
