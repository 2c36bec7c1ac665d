//! The row of contact nodes: tractions and their derivatives from compression and sliding speed.

use super::friction::{FrictionLaw, Law, Smoothing};
use super::normal;
use crate::effects::road_texture::Texture;
use crate::pack::{Aligned, Pack, LANES};
use crate::params::Contact;
use multiversion::multiversion;

/// Gap \[m\] of the padding nodes that fill the last pack: out of reach of any road.
const OUT_OF_REACH: f64 = 1e3;
/// Pressure at an edge over that which the face bears on average \[-\].
const PRESSED_EDGE: f64 = 3.0;

/// The tread face and the laws that hold on it. Vectors per node are padded to full packs.
#[derive(Clone, Debug)]
pub struct Face {
    /// Area of each node \[m²\]; 0 in the padding.
    pub area: Aligned,
    /// How far each node of the undeformed face lies behind the plane of the face \[m\].
    pub profile: Aligned,
    /// Speed over which friction is smoothed \[m/s\]: the scale of the solver's tolerance.
    pub smoothing_speed: f64,
    /// Friction characteristic.
    pub friction: Law,
    /// Contact stiffness.
    pub contact: Contact,
    /// 1/depth of the contact stiffness \[1/m\].
    pub per_depth: f64,
    /// Load-independent shear strength \[Pa\] where there is contact (adhesion).
    pub shear_strength: f64,
    /// Speed over which the shear strength is smoothed \[m/s\].
    pub shear_smoothing: f64,
    /// Pull-off pressure \[Pa\] of full contact (adhesion).
    pub pull_off: f64,
    /// Pressure over which the adhering share of the face grows \[Pa\].
    pub adhesion_pressure: f64,
    /// Pressure per pressure and approach speed \[s/m\] (contact damping).
    pub damping: f64,
    /// Pressure per approach speed \[Pa s/m\] (contact damping).
    pub viscosity: f64,
    /// Height of the road, where it is not plane.
    pub road: Option<Texture>,
}

/// Forces of the road on the contact nodes and how they change, road frame; padded.
#[derive(Clone, Debug, Default)]
pub struct Traction {
    /// Tangential force \[N\].
    pub tangential: Aligned,
    /// Normal force \[N\].
    pub normal: Aligned,
    /// −∂(tangential)/∂(tangential speed) \[N s/m\].
    pub slip_slope: Aligned,
    /// −∂(tangential)/∂(normal speed) \[N s/m\].
    pub coupling: Aligned,
    /// −∂(normal)/∂(normal speed) \[N s/m\].
    pub approach_slope: Aligned,
    /// Pressure \[Pa\].
    pub pressure: Aligned,
}

/// Where the contact nodes stand and how they move, as the laws of the face see it; padded.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    /// Compression \[m\].
    pub compression: Aligned,
    /// Speed over the road \[m/s\].
    pub slip: Aligned,
    /// Speed away from the road \[m/s\].
    pub lift: Aligned,
}

impl Placed {
    /// Room for `nodes` contact nodes.
    pub fn new(nodes: usize) -> Self {
        let zeros = || Aligned::zeros(padded(nodes));
        Self { compression: zeros(), slip: zeros(), lift: zeros() }
    }
}

/// Number of nodes filled up to full packs.
pub fn padded(nodes: usize) -> usize {
    nodes.div_ceil(LANES) * LANES
}

impl Traction {
    /// Room for `nodes` contact nodes.
    pub fn new(nodes: usize) -> Self {
        let zeros = || Aligned::zeros(padded(nodes));
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
    /// A face of nodes with these areas \[m²\] and profile \[m\]; no adhesion, no contact damping.
    pub fn new(
        area: &[f64],
        profile: &[f64],
        friction: Law,
        contact: &Contact,
        smoothing_speed: f64,
    ) -> Self {
        let size = padded(area.len());
        Self {
            area: Aligned::padded(area, size, 0.0),
            profile: Aligned::padded(profile, size, OUT_OF_REACH),
            smoothing_speed,
            friction,
            contact: contact.clone(),
            per_depth: 1.0 / contact.depth,
            shear_strength: 0.0,
            shear_smoothing: smoothing_speed,
            pull_off: 0.0,
            adhesion_pressure: contact.reference_pressure,
            damping: 0.0,
            viscosity: 0.0,
            road: None,
        }
    }

    /// −∂(normal)/∂(normal speed) of each node at rest under the pressure `p` \[Pa\], padded \[N s/m\]; the
    /// compression changes by −`a` \[s\] per normal speed.
    ///
    /// That of a damper which grows with the pressure is taken for three times `p`, as at an edge: an iteration that
    /// assumes too steep a slope creeps to the solution, one that assumes too flat a slope leaves it.
    pub fn approach_slopes<'a>(&'a self, p: f64, a: f64) -> impl Iterator<Item = f64> + 'a {
        let compression = Pack::splat(normal::compression(&self.contact, p));
        let (_, by_lift) = self.pressure(compression, a, Pack::default());
        let slope = (PRESSED_EDGE - 1.0) * self.damping * p - by_lift.0[0];
        self.area.iter().map(move |area| area * slope)
    }

    /// Evaluates all nodes into `out`; returns the highest pressure \[Pa\].
    ///
    /// The compression changes by −`a` \[s\] per normal speed; `factor` is what effects make of friction \[-\].
    pub fn evaluate(&self, a: f64, at: &Placed, factor: &Aligned, out: &mut Traction) -> f64 {
        evaluate_now(self, a, at, factor, out)
    }

    /// [`Self::evaluate`], compiled for the instruction set of its caller.
    #[inline(always)]
    fn all_nodes(&self, a: f64, at: &Placed, factor: &Aligned, out: &mut Traction) -> f64 {
        let area = self.area.packs();
        let n = area.len();
        let factor = &factor.packs()[..n];
        let compression = &at.compression.packs()[..n];
        let (slip, lift) = (&at.slip.packs()[..n], &at.lift.packs()[..n]);
        let tangential = &mut out.tangential.packs_mut()[..n];
        let normal = &mut out.normal.packs_mut()[..n];
        let slip_slope = &mut out.slip_slope.packs_mut()[..n];
        let coupling = &mut out.coupling.packs_mut()[..n];
        let approach_slope = &mut out.approach_slope.packs_mut()[..n];
        let pressure = &mut out.pressure.packs_mut()[..n];
        let mut highest = Pack::splat(0.0);
        for k in 0..n {
            let (p, p_by_lift) = self.pressure(compression[k], a, lift[k]);
            let mu = self.friction.mu(p, slip[k]);
            let value = factor[k] * mu.value;
            let mut t = Nodes {
                tangential: -(value * p),
                slip_slope: factor[k] * mu.by_speed * p,
                coupling: factor[k].mul_add(mu.by_log_pressure, value) * p_by_lift,
                normal: p,
                approach_slope: -p_by_lift,
            };
            self.adhere(p, p_by_lift, slip[k], &mut t);
            tangential[k] = t.tangential * area[k];
            normal[k] = t.normal * area[k];
            slip_slope[k] = t.slip_slope * area[k];
            coupling[k] = t.coupling * area[k];
            approach_slope[k] = t.approach_slope * area[k];
            pressure[k] = p;
            highest = highest.max(p);
        }
        highest.largest()
    }

    /// Pressure \[Pa\] and its derivative by the speed away from the road \[Pa s/m\].
    #[inline(always)]
    fn pressure(&self, compression: Pack, a: f64, lift: Pack) -> (Pack, Pack) {
        let (p, stiffness) = normal::pressures(&self.contact, self.per_depth, compression);
        let by_lift = stiffness * Pack::splat(-a);
        if self.viscosity > 0.0 {
            return self.viscous_pressure(compression, a, lift, p, stiffness);
        }
        if self.damping == 0.0 {
            return (p, by_lift);
        }
        let (zero, k) = (Pack::splat(0.0), Pack::splat(self.damping));
        let damped = Pack::splat(1.0) - k * lift;
        (
            damped.if_above(zero, p * damped, zero),
            damped.if_above(zero, by_lift * damped - k * p, zero),
        )
    }

    /// Pressure with a damper beside the spring, d (1 − exp(−u/u₀)) u̇, never negative.
    #[inline(always)]
    fn viscous_pressure(&self, u: Pack, a: f64, lift: Pack, p: Pack, k: Pack) -> (Pack, Pack) {
        let (zero, viscosity) = (Pack::splat(0.0), Pack::splat(self.viscosity));
        let per_depth = Pack::splat(self.per_depth);
        let left = (-(u.max(zero) * per_depth)).exp();
        let damper = viscosity * (Pack::splat(1.0) - left);
        let sum = p - damper * lift;
        let slope = -(Pack::splat(a) * (k - viscosity * left * per_depth * lift)) - damper;
        let pressing = |then: Pack| u.if_above(zero, sum.if_above(zero, then, zero), zero);
        (pressing(sum), pressing(slope))
    }

    /// Normal stress of a face at rest, pressure less pull-off \[Pa\], and its derivative \[Pa/m\].
    pub fn stress_at_rest(&self, compression: f64) -> (f64, f64) {
        let (p, stiffness) = normal::pressure(&self.contact, compression);
        if self.pull_off == 0.0 {
            return (p, stiffness);
        }
        let left = (-p / self.adhesion_pressure).exp();
        let slope = self.pull_off * left / self.adhesion_pressure;
        (p - self.pull_off * (1.0 - left), stiffness * (1.0 - slope))
    }

    /// Adds adhesion: shear τ_a and pull p_a over the adhering share 1 − exp(−p/p_s).
    #[inline(always)]
    fn adhere(&self, p: Pack, p_by_lift: Pack, slip: Pack, t: &mut Nodes) {
        if self.shear_strength == 0.0 && self.pull_off == 0.0 {
            return;
        }
        let per_pressure = Pack::splat(1.0 / self.adhesion_pressure);
        let free = (-(p * per_pressure)).exp();
        let share = Pack::splat(1.0) - free;
        let share_by_lift = free * per_pressure * p_by_lift;
        let (sign, slope) = Smoothing::over(self.shear_smoothing).sign(slip);
        let (shear, pull) = (Pack::splat(self.shear_strength), Pack::splat(self.pull_off));
        t.tangential = t.tangential - shear * share * sign;
        t.slip_slope += shear * share * slope;
        t.coupling += shear * share_by_lift * sign;
        t.normal = t.normal - pull * share;
        t.approach_slope += pull * share_by_lift;
    }
}

/// On its own, so that the laws are compiled once per instruction set and not with every kernel that calls them.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn evaluate_now(face: &Face, a: f64, at: &Placed, factor: &Aligned, out: &mut Traction) -> f64 {
    face.all_nodes(a, at, factor, out)
}

/// Stresses of eight nodes and their slopes, see [`Traction`].
struct Nodes {
    tangential: Pack,
    slip_slope: Pack,
    coupling: Pack,
    normal: Pack,
    approach_slope: Pack,
}
