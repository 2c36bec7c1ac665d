//! From force and surface velocity to sound pressure: two compact sources on a rigid road.
//!
//! Sound pressure at the distance r in retarded time t − r/c, the road as a rigid baffle:
//!
//!   p(t) = ρ₀/(2πr) [ a_F(t) + Q′(t) ]                                                     (1)
//!
//! Q′, airborne: volume flow of the block's own faces, a small source in a baffle (Rayleigh's integral,
//! *The Theory of Sound*, vol. 2, § 278). The faces before and behind move on average with half the
//! speed of their lower edges; what they push aside together cancels: Q = ½ A (v_out − v_in), A = height × width.
//!
//! a_F, structure-borne: the force normal to the belt drives it as an infinite plate below coincidence.
//! At the wavenumbers that radiate such a plate answers with its mass m″ alone, whatever its stiffness:
//! the far field is (1) with a_F = F/m″ at all angles and frequencies, and the power in the half space
//! W = ρ₀F²/(2πc m″²) (Cremer, Heckl, Petersson, *Structure-Borne Sound*, Springer 2005, "Point-excited
//! plates"). Inflation pressure and side walls hold the belt like an elastic foundation (Kropp, *Applied
//! Acoustics* 26, 1989): below the frequency f₀ of the mass on it nothing follows the force,
//!
//!   a_F″ + 2ζω₀ a_F′ + ω₀² a_F = F″/m″.                                                      (2)
//!
//! Not in it: the horn between tyre and road (10 to 20 dB around 1 kHz near its plane), the finite belt
//! and its modes, tangential forces, scattering, a porous road.

use std::f64::consts::PI;

/// Section of a digital filter, direct form II transposed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Section {
    b: [f64; 3],
    a: [f64; 2],
    state: [f64; 2],
}

impl Section {
    /// (b₂s² + b₁s + b₀)/(s² + a₁s + a₀) by the bilinear transform s = 2 f_s (z − 1)/(z + 1).
    pub fn bilinear([b2, b1, b0]: [f64; 3], [a1, a0]: [f64; 2], sampling: f64) -> Self {
        let k = 2.0 * sampling;
        let norm = k * k + a1 * k + a0;
        Self {
            b: [
                (b2 * k * k + b1 * k + b0) / norm,
                2.0 * (b0 - b2 * k * k) / norm,
                (b2 * k * k - b1 * k + b0) / norm,
            ],
            a: [2.0 * (a0 - k * k) / norm, (k * k - a1 * k + a0) / norm],
            state: [0.0; 2],
        }
    }

    /// The next value.
    pub fn pass(&mut self, x: f64) -> f64 {
        let y = self.b[0] * x + self.state[0];
        self.state = [self.b[1] * x - self.a[0] * y + self.state[1], self.b[2] * x - self.a[1] * y];
        y
    }
}

/// The two sources.
#[derive(Clone, Debug)]
pub struct Radiation {
    belt: Section,
    /// Force at the start and flow at the last sample.
    past: Option<[f64; 2]>,
    spread: f64,
    sampling: f64,
}

/// What the radiation depends on, SI units.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Distance of the observer r [m].
    pub distance: f64,
    /// Density of air ρ₀ [kg/m³].
    pub air_density: f64,
    /// Mass of the belt per area m″ [kg/m²].
    pub belt_mass: f64,
    /// Frequency f₀ of the belt on its foundation [Hz].
    pub cut_on: f64,
    /// Damping ratio ζ of that motion [-].
    pub damping: f64,
}

impl Radiation {
    /// Sources at rest, for samples at `sampling` [Hz].
    pub fn new(around: Surroundings, sampling: f64) -> Self {
        let omega = 2.0 * PI * around.cut_on;
        let numerator = [1.0 / around.belt_mass, 0.0, 0.0];
        let denominator = [2.0 * around.damping * omega, omega * omega];
        Self {
            belt: Section::bilinear(numerator, denominator, sampling),
            past: None,
            spread: around.air_density / (2.0 * PI * around.distance),
            sampling,
        }
    }

    /// Sound pressure [Pa] for the next sample of the normal force [N] and the volume flow Q [m³/s].
    ///
    /// Q′ is its mean since the last sample, so that the short peaks of a face that is let go do not
    /// depend on whether a sample meets them.
    pub fn pressure(&mut self, force: f64, flow: f64) -> f64 {
        // The force at the start has been there for ever: it has long ceased to radiate.
        let [rest, before] = self.past.unwrap_or([force, flow]);
        self.past = Some([rest, flow]);
        self.spread * (self.belt.pass(force - rest) + (flow - before) * self.sampling)
    }
}
