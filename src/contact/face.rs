//! The row of contact nodes: tractions and their derivatives from compression and sliding speed.

use super::friction::{smoothed_sign, FrictionLaw, Law};
use super::normal;
use crate::effects::road_texture::Texture;
use crate::params::Contact;

/// The tread face and the laws that hold on it.
#[derive(Clone, Debug)]
pub struct Face {
    /// Area of each node [m²].
    pub area: Vec<f64>,
    /// How far each node of the undeformed face lies behind the plane of the face [m].
    pub profile: Vec<f64>,
    /// Speed over which friction is smoothed [m/s]: the scale of the solver's tolerance.
    pub smoothing_speed: f64,
    /// Friction characteristic.
    pub friction: Law,
    /// Contact stiffness.
    pub contact: Contact,
    /// Load-independent shear strength [Pa] where there is contact (adhesion).
    pub shear_strength: f64,
    /// Speed over which the shear strength is smoothed [m/s].
    pub shear_smoothing: f64,
    /// Pull-off pressure [Pa] of full contact (adhesion).
    pub pull_off: f64,
    /// Pressure over which the adhering share of the face grows [Pa].
    pub adhesion_pressure: f64,
    /// Pressure per pressure and approach speed [s/m] (contact damping).
    pub damping: f64,
    /// Pressure per approach speed [Pa s/m] (contact damping).
    pub viscosity: f64,
    /// Height of the road, where it is not plane.
    pub road: Option<Texture>,
}

/// Forces of the road on the contact nodes and how they change, road frame.
#[derive(Clone, Debug, Default)]
pub struct Traction {
    /// Tangential force [N].
    pub tangential: Vec<f64>,
    /// Normal force [N].
    pub normal: Vec<f64>,
    /// −∂(tangential)/∂(tangential speed) [N s/m].
    pub slip_slope: Vec<f64>,
    /// −∂(tangential)/∂(normal speed) [N s/m].
    pub coupling: Vec<f64>,
    /// −∂(normal)/∂(normal speed) [N s/m].
    pub approach_slope: Vec<f64>,
    /// Pressure [Pa].
    pub pressure: Vec<f64>,
}

impl Traction {
    /// Room for `nodes` contact nodes.
    pub fn new(nodes: usize) -> Self {
        let zeros = || vec![0.0; nodes];
        Self {
            tangential: zeros(),
            normal: zeros(),
            slip_slope: zeros(),
            coupling: zeros(),
            approach_slope: zeros(),
            pressure: zeros(),
        }
    }
}

impl Face {
    /// Evaluates all nodes into `out`.
    ///
    /// `compression` [m] and its change per normal speed −`a` [s], `slip` and `lift` the speeds over
    /// and away from the road [m/s], `factor` what effects make of friction [-].
    pub fn evaluate(
        &self,
        compression: &[f64],
        a: f64,
        slip: &[f64],
        lift: &[f64],
        factor: &[f64],
        out: &mut Traction,
    ) {
        for i in 0..self.area.len() {
            let (mut p, mut p_by_lift) = self.pressure(compression[i], a, lift[i]);
            let area = self.area[i];
            out.pressure[i] = p;
            let touching = p > 0.0;
            if !touching {
                (p, p_by_lift) = (0.0, 0.0);
            }
            let mu = self.friction.mu(p, slip[i]);
            let (mu_value, mu_slope) = (factor[i] * mu.value, factor[i] * mu.by_speed);
            let by_pressure = mu_value + p * factor[i] * mu.by_pressure;
            out.tangential[i] = -mu_value * p * area;
            out.slip_slope[i] = mu_slope * p * area;
            out.coupling[i] = by_pressure * p_by_lift * area;
            out.normal[i] = p * area;
            out.approach_slope[i] = -p_by_lift * area;
            if touching {
                self.adhere(i, p, p_by_lift, slip[i], out);
            }
        }
    }

    /// Pressure [Pa] and its derivative by the speed away from the road [Pa s/m].
    fn pressure(&self, compression: f64, a: f64, lift: f64) -> (f64, f64) {
        let (p, stiffness) = normal::pressure(&self.contact, compression);
        let damped = 1.0 - self.damping * lift;
        if self.viscosity > 0.0 {
            self.viscous_pressure(compression, a, lift, p, stiffness)
        } else if self.damping == 0.0 {
            (p, -a * stiffness)
        } else if damped <= 0.0 {
            (0.0, 0.0)
        } else {
            (p * damped, -a * stiffness * damped - self.damping * p)
        }
    }

    /// Pressure with a damper beside the spring, d (1 − exp(−u/u₀)) u̇, never negative.
    fn viscous_pressure(&self, u: f64, a: f64, lift: f64, p: f64, stiffness: f64) -> (f64, f64) {
        let left = (-u.max(0.0) / self.contact.depth).exp();
        let damper = self.viscosity * (1.0 - left);
        let sum = p - damper * lift;
        if u <= 0.0 || sum <= 0.0 {
            return (0.0, 0.0);
        }
        let stiffening = self.viscosity * left / self.contact.depth;
        (sum, -a * (stiffness - stiffening * lift) - damper)
    }

    /// Normal stress of a face at rest, pressure less pull-off [Pa], and its derivative [Pa/m].
    pub fn stress_at_rest(&self, compression: f64) -> (f64, f64) {
        let (p, stiffness) = normal::pressure(&self.contact, compression);
        if self.pull_off == 0.0 {
            return (p, stiffness);
        }
        let left = (-p / self.adhesion_pressure).exp();
        let slope = self.pull_off * left / self.adhesion_pressure;
        (p - self.pull_off * (1.0 - left), stiffness * (1.0 - slope))
    }

    /// Adds adhesion at node `i`: shear τ_a and pull p_a over the adhering share 1 − exp(−p/p_s).
    fn adhere(&self, i: usize, p: f64, p_by_lift: f64, slip: f64, out: &mut Traction) {
        if self.shear_strength == 0.0 && self.pull_off == 0.0 {
            return;
        }
        let p_s = self.adhesion_pressure;
        let share = 1.0 - (-p / p_s).exp();
        let share_by_lift = (1.0 - share) / p_s * p_by_lift;
        let (sign, slope) = smoothed_sign(slip, self.shear_smoothing);
        let area = self.area[i];
        out.tangential[i] -= self.shear_strength * share * sign * area;
        out.slip_slope[i] += self.shear_strength * share * slope * area;
        out.coupling[i] += self.shear_strength * share_by_lift * sign * area;
        out.normal[i] -= self.pull_off * share * area;
        out.approach_slope[i] += self.pull_off * share_by_lift * area;
    }
}
