//! Wear rate (paper eq. 3, reconstructed) and worn depth.

use crate::params::Wear;

/// Pressure at which [`Wear::coefficient`] holds \[Pa\].
pub const REFERENCE_PRESSURE: f64 = 250e3;
/// Speed at which [`Wear::coefficient`] holds \[m/s\].
pub const REFERENCE_SPEED: f64 = 0.3;

/// Mass worn per area and sliding distance, η = k₁ μ (p/p₀)^k₂ (|v|/v₀)^k₃ \[kg/m³\].
///
/// Archard: k₂ = 1, k₃ = 0, μ absorbed in k₁; Fleischer: k₂ = 1, k₃ = 0; Hofstetter and
/// Viswanath-Bellow: powers of pressure and speed.
pub fn rate(law: &Wear, mu: f64, pressure: f64, speed: f64) -> f64 {
    if pressure <= 0.0 || law.coefficient == 0.0 {
        return 0.0;
    }
    let by_speed = if law.speed_exponent == 0.0 {
        1.0
    } else {
        (speed.abs().max(1e-6) / REFERENCE_SPEED).powf(law.speed_exponent)
    };
    let by_pressure = if law.pressure_exponent == 1.0 {
        pressure / REFERENCE_PRESSURE
    } else {
        (pressure / REFERENCE_PRESSURE).powf(law.pressure_exponent)
    };
    law.coefficient * mu.abs() * by_pressure * by_speed
}

/// Growth of the worn depth \[m/s\] at a point that slides at `speed` \[m/s\].
pub fn depth_rate(law: &Wear, density: f64, mu: f64, pressure: f64, speed: f64) -> f64 {
    rate(law, mu, pressure, speed) * speed.abs() / density
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn archard_wears_in_proportion_to_load_and_distance() {
        // Closed form: 0.08 mm³/(N m) at 250 kPa over 25 m wears 0.5 mm.
        let law = Wear {
            coefficient: 0.08e-9 * 1100.0 * REFERENCE_PRESSURE,
            pressure_exponent: 1.0,
            speed_exponent: 0.0,
        };
        let depth = depth_rate(&law, 1100.0, 1.0, 250e3, 0.3) * 25.0 / 0.3;
        assert!((depth - 0.5e-3).abs() < 1e-12, "{depth}");
    }
}
