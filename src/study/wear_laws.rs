//! Wear laws from the literature, brought to one scale, and the fit of the generalised one.

use nalgebra::{Matrix3, Vector3};

/// Pressure \[Pa\] and speed \[m/s\] at which all laws wear alike.
pub const REFERENCE: (f64, f64) = (250e3, 0.3);
/// Wear at the reference per load and distance at μ = 1 \[m³/(N m)\]: corundum paper, the size that
/// wears about 0.5 mm over 25 m (physics notes 1.3).
pub const SPECIFIC_WEAR: f64 = 0.08e-9;

/// A wear law as depth per sliding distance: k μ^a (p/p₀)^b (|v|/v₀)^c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearLaw {
    /// Name.
    pub name: &'static str,
    /// Exponent of the friction coefficient.
    pub friction: f64,
    /// Exponent of the pressure.
    pub pressure: f64,
    /// Exponent of the speed.
    pub speed: f64,
}

/// The laws of figure 3. Archard (J. Appl. Phys. 24, 1953): volume per distance k F/H, friction plays
/// no part. Fleischer (Schmierungstechnik 4, 1973): volume per friction work. Hofstetter (thesis, TU
/// Wien 2004): a power of the friction power, here 1.3 \[reconstructed\]. Viswanath and Bellow (Wear
/// 181, 1995): a product of powers of pressure and speed, here 1.5 and 0.3 \[reconstructed\]. The
/// generalised law of the paper, η = k₁ μ p^k₂ |v|^k₃, has its exponents from a fit.
pub fn published(generalised: [f64; 2]) -> [WearLaw; 5] {
    let [pressure, speed] = generalised;
    [
        WearLaw { name: "Archard", friction: 0.0, pressure: 1.0, speed: 0.0 },
        WearLaw { name: "Fleischer", friction: 1.0, pressure: 1.0, speed: 0.0 },
        WearLaw { name: "Hofstetter", friction: 1.3, pressure: 1.3, speed: 0.3 },
        WearLaw { name: "Viswanath-Bellow", friction: 0.0, pressure: 1.5, speed: 0.3 },
        WearLaw { name: "generalised", friction: 1.0, pressure, speed },
    ]
}

impl WearLaw {
    /// Depth worn per sliding distance \[m/m\]; `mu` is taken relative to `reference_mu`, so that all
    /// laws agree at the reference.
    pub fn rate(&self, mu: f64, pressure: f64, speed: f64, reference_mu: f64) -> f64 {
        if pressure <= 0.0 {
            return 0.0;
        }
        let v = (speed.abs() / REFERENCE.1).max(1e-6);
        SPECIFIC_WEAR
            * REFERENCE.0
            * (mu.abs() / reference_mu).powf(self.friction)
            * (pressure / REFERENCE.0).powf(self.pressure)
            * v.powf(self.speed)
    }
}

/// A measured wear rate over the friction coefficient, η* = η/μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Sliding speed \[m/s\].
    pub speed: f64,
    /// η* \[kg/m³\].
    pub rate: f64,
}

/// k₁ \[kg/m³\] at the reference, k₂ and k₃ of η* = k₁ (p/p₀)^k₂ (v/v₀)^k₃ by least squares of the
/// logarithms; `None` if the points do not determine them.
pub fn fit(points: &[Measured]) -> Option<[f64; 3]> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for point in points {
        let row = Vector3::new(
            1.0,
            (point.pressure / REFERENCE.0).ln(),
            (point.speed / REFERENCE.1).ln(),
        );
        normal += row * row.transpose();
        right += row * point.rate.ln();
    }
    let solution = normal.try_inverse()? * right;
    Some([solution[0].exp(), solution[1], solution[2]])
}

/// η* \[kg/m³\] that the generalised law with the k₁, k₂ and k₃ of [`fit`] says.
pub fn generalised_rate([k1, k2, k3]: [f64; 3], pressure: f64, speed: f64) -> f64 {
    k1 * (pressure / REFERENCE.0).powf(k2) * (speed / REFERENCE.1).powf(k3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_finds_the_exponents_that_made_the_points() {
        // Points of η* = 0.02 (p/p₀)^1.1 (v/v₀)^0.2, exact: the fit must return them to rounding.
        let mut points = Vec::new();
        for pressure in [100e3_f64, 250e3, 600e3] {
            for speed in [0.05_f64, 0.3, 1.0] {
                let rate =
                    0.02 * (pressure / REFERENCE.0).powf(1.1) * (speed / REFERENCE.1).powf(0.2);
                points.push(Measured { pressure, speed, rate });
            }
        }
        let found = fit(&points).unwrap();
        for (a, b) in found.iter().zip([0.02, 1.1, 0.2]) {
            assert!((a - b).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn all_laws_wear_alike_at_the_reference() {
        for law in published([1.2, 0.1]) {
            let rate = law.rate(0.9, REFERENCE.0, REFERENCE.1, 0.9);
            assert!((rate / (SPECIFIC_WEAR * REFERENCE.0) - 1.0).abs() < 1e-12, "{law:?}");
        }
    }
}
