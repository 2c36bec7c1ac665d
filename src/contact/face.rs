//! The row of contact nodes: tractions and their derivatives from compression and sliding speed.

use super::friction::{smoothed_sign, FrictionLaw, Law};
use super::normal;
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
    /// Pressure per pressure and approach speed [s/m] (contact damping).
    pub damping: f64,
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
        if self.damping == 0.0 {
            (p, -a * stiffness)
        } else if damped <= 0.0 {
            (0.0, 0.0)
        } else {
            (p * damped, -a * stiffness * damped - self.damping * p)
        }
    }

    /// Adds adhesion at node `i`: shear τ_a and pull p_a over the share 1 − exp(−p/p_r) of real
    /// contact.
    fn adhere(&self, i: usize, p: f64, p_by_lift: f64, slip: f64, out: &mut Traction) {
        if self.shear_strength == 0.0 && self.pull_off == 0.0 {
            return;
        }
        let p_r = self.contact.reference_pressure;
        let share = 1.0 - (-p / p_r).exp();
        let share_by_lift = (1.0 - share) / p_r * p_by_lift;
        let (sign, slope) = smoothed_sign(slip, self.shear_smoothing);
        let area = self.area[i];
        out.tangential[i] -= self.shear_strength * share * sign * area;
        out.slip_slope[i] += self.shear_strength * share * slope * area;
        out.coupling[i] += self.shear_strength * share_by_lift * sign * area;
        out.normal[i] -= self.pull_off * share * area;
        out.approach_slope[i] += self.pull_off * share_by_lift * area;
    }
}
