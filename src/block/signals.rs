//! The table of inputs and outputs: name, unit, meaning, and how to reach the number.

use crate::drive::Pose;
use crate::params::table::DisplayUnit;

/// Number of stations along the tread face at which pressure and sliding speed are given.
pub const STATIONS: usize = 21;

/// Everything that the block tells at a communication point, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// Force of the block on the belt \[N\], road frame: x, z.
    pub force: [f64; 2],
    /// Moment of the block on the belt about the middle of the clamped face \[N m\]; positive about
    /// +y of the right-handed frame x forward, z up (z F_x − x F_z).
    pub moment_y: f64,
    /// Force of the road on the block \[N\], road frame: x, z.
    pub contact_force: [f64; 2],
    /// Run-in edge of the tread face relative to the clamped face \[m\], block frame: x, z.
    pub run_in_displacement: [f64; 2],
    /// Its velocity \[m/s\].
    pub run_in_velocity: [f64; 2],
    /// Run-out edge of the tread face relative to the clamped face \[m\], block frame: x, z.
    pub run_out_displacement: [f64; 2],
    /// Its velocity \[m/s\].
    pub run_out_velocity: [f64; 2],
    /// Friction force over normal force, positive when the road drags the block to +x \[-\].
    pub friction_coefficient: f64,
    /// Share of the contact area in which the rubber sticks, |v| below the smoothing speed \[-\].
    pub stick_fraction: f64,
    /// Share of the tread face that touches the road \[-\].
    pub area_fraction: f64,
    /// Power lost in friction \[W\].
    pub friction_power: f64,
    /// Contact pressure at the stations from run-in to run-out edge \[Pa\].
    pub pressure: [f64; STATIONS],
    /// Speed of the tread face over the road at the stations \[m/s\].
    pub sliding_speed: [f64; STATIONS],
    /// Mass worn off since initialization \[kg\].
    pub wear_mass: f64,
    /// Largest worn depth \[m\].
    pub wear_depth_max: f64,
    /// Height of the clamped face's middle above the road \[m\].
    pub carriage_z: f64,
    /// Tangential deflection of the clamped face against its drive \[m\], 0 but for a compliant rig.
    pub deflection: f64,
    /// Its velocity \[m/s\].
    pub deflection_velocity: f64,
}

impl Outputs {
    /// Is every output a number?
    pub(super) fn are_finite(&self) -> bool {
        // Every field by name, so that a new one cannot be forgotten.
        let Self {
            force,
            moment_y,
            contact_force,
            run_in_displacement,
            run_in_velocity,
            run_out_displacement,
            run_out_velocity,
            friction_coefficient,
            stick_fraction,
            area_fraction,
            friction_power,
            pressure,
            sliding_speed,
            wear_mass,
            wear_depth_max,
            carriage_z,
            deflection,
            deflection_velocity,
        } = self;
        let pairs = [
            *force,
            *contact_force,
            *run_in_displacement,
            *run_in_velocity,
            *run_out_displacement,
            *run_out_velocity,
            [*moment_y, *friction_coefficient],
            [*stick_fraction, *area_fraction],
            [*friction_power, *carriage_z],
            [*wear_mass, *wear_depth_max],
            [*deflection, *deflection_velocity],
        ];
        pairs.as_flattened().iter().chain(pressure).chain(sliding_speed).all(|x| x.is_finite())
    }
}

impl Default for Outputs {
    fn default() -> Self {
        Self {
            force: [0.0; 2],
            moment_y: 0.0,
            contact_force: [0.0; 2],
            run_in_displacement: [0.0; 2],
            run_in_velocity: [0.0; 2],
            run_out_displacement: [0.0; 2],
            run_out_velocity: [0.0; 2],
            friction_coefficient: 0.0,
            stick_fraction: 0.0,
            area_fraction: 0.0,
            friction_power: 0.0,
            pressure: [0.0; STATIONS],
            sliding_speed: [0.0; STATIONS],
            wear_mass: 0.0,
            wear_depth_max: 0.0,
            carriage_z: 0.0,
            deflection: 0.0,
            deflection_velocity: 0.0,
        }
    }
}

/// One input.
#[derive(Clone, Copy, Debug)]
pub struct InputSpec {
    /// Dotted name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Unit in which people read it.
    pub display: Option<DisplayUnit>,
    /// Largest magnitude that is accepted \[unit\]; beyond it the input is an error of the master.
    pub limit: f64,
    /// Smallest accepted value \[unit\].
    pub min: f64,
    /// What it is.
    pub doc: &'static str,
    /// Reads it from a pose.
    pub get: fn(&Pose) -> f64,
    /// Writes it to a pose.
    pub set: fn(&mut Pose, f64),
}

/// One output (an array's elements are outputs of their own).
#[derive(Clone, Copy, Debug)]
pub struct OutputSpec {
    /// Dotted name; of an array without its index.
    pub name: &'static str,
    /// Number of elements; 1 for a scalar.
    pub size: usize,
    /// SI unit; `1` where there is none.
    pub unit: &'static str,
    /// Unit in which people read it.
    pub display: Option<DisplayUnit>,
    /// Typical size \[unit\].
    pub nominal: f64,
    /// What it is.
    pub doc: &'static str,
    /// Reads element `i` (from 0).
    pub get: fn(&Outputs, usize) -> f64,
}

const MM: Option<DisplayUnit> = Some(DisplayUnit { name: "mm", factor: 1e3 });
const UM: Option<DisplayUnit> = Some(DisplayUnit { name: "um", factor: 1e6 });
const KPA: Option<DisplayUnit> = Some(DisplayUnit { name: "kPa", factor: 1e-3 });
const MG: Option<DisplayUnit> = Some(DisplayUnit { name: "mg", factor: 1e6 });
const MM_S: Option<DisplayUnit> = Some(DisplayUnit { name: "mm/s", factor: 1e3 });
const DEG: Option<DisplayUnit> =
    Some(DisplayUnit { name: "deg", factor: 180.0 / std::f64::consts::PI });

/// The inputs, in the order of [`Pose`].
#[rustfmt::skip]
pub const INPUTS: &[InputSpec] = &[
    InputSpec { name: "belt.x", unit: "m", display: MM, min: -1e6, limit: 1e6, doc: "Middle of the clamped face, forward position in the road frame", get: |p| p.x, set: |p, v| p.x = v },
    InputSpec { name: "belt.z", unit: "m", display: MM, min: -1e3, limit: 1e3, doc: "Middle of the clamped face, height above the road (trajectory drive)", get: |p| p.z, set: |p, v| p.z = v },
    InputSpec { name: "belt.angle", unit: "rad", display: DEG, min: -1.0, limit: 1.0, doc: "Angle of the clamped face; positive lifts the +x side", get: |p| p.angle, set: |p, v| p.angle = v },
    InputSpec { name: "normal_load", unit: "N", display: None, min: 0.0, limit: 1e6, doc: "Load on the carriage (load drive)", get: |p| p.load, set: |p, v| p.load = v },
];

/// The outputs.
#[rustfmt::skip]
pub const OUTPUTS: &[OutputSpec] = &[
    scalar("force.x", "N", None, 10.0, "Force of the block on the belt, forward", |o, _| o.force[0]),
    scalar("force.z", "N", None, 10.0, "Force of the block on the belt, upward", |o, _| o.force[1]),
    scalar("moment.y", "N.m", None, 0.1, "Moment of the block on the belt about the middle of the clamped face (z Fx - x Fz)", |o, _| o.moment_y),
    scalar("contact.force.x", "N", None, 10.0, "Force of the road on the block, forward", |o, _| o.contact_force[0]),
    scalar("contact.force.z", "N", None, 10.0, "Force of the road on the block, upward", |o, _| o.contact_force[1]),
    scalar("run_in.displacement.x", "m", UM, 1e-4, "Run-in edge (local -x) relative to the clamped face, forward", |o, _| o.run_in_displacement[0]),
    scalar("run_in.displacement.z", "m", UM, 1e-4, "Run-in edge relative to the clamped face, upward", |o, _| o.run_in_displacement[1]),
    scalar("run_in.velocity.x", "m/s", MM_S, 0.1, "Velocity of the run-in edge relative to the clamped face, forward", |o, _| o.run_in_velocity[0]),
    scalar("run_in.velocity.z", "m/s", MM_S, 0.1, "Velocity of the run-in edge relative to the clamped face, upward", |o, _| o.run_in_velocity[1]),
    scalar("run_out.displacement.x", "m", UM, 1e-4, "Run-out edge (local +x) relative to the clamped face, forward", |o, _| o.run_out_displacement[0]),
    scalar("run_out.displacement.z", "m", UM, 1e-4, "Run-out edge relative to the clamped face, upward", |o, _| o.run_out_displacement[1]),
    scalar("run_out.velocity.x", "m/s", MM_S, 0.1, "Velocity of the run-out edge relative to the clamped face, forward", |o, _| o.run_out_velocity[0]),
    scalar("run_out.velocity.z", "m/s", MM_S, 0.1, "Velocity of the run-out edge relative to the clamped face, upward", |o, _| o.run_out_velocity[1]),
    scalar("contact.friction_coefficient", "1", None, 1.0, "Friction force over normal force, positive when the road drags the block forward", |o, _| o.friction_coefficient),
    scalar("contact.stick_fraction", "1", None, 1.0, "Share of the contact area in which the rubber sticks (sliding speed below the smoothing speed)", |o, _| o.stick_fraction),
    scalar("contact.area_fraction", "1", None, 1.0, "Share of the tread face that touches the road", |o, _| o.area_fraction),
    scalar("contact.friction_power", "W", None, 10.0, "Power lost in friction", |o, _| o.friction_power),
    OutputSpec { name: "contact.pressure", size: STATIONS, unit: "Pa", display: KPA, nominal: 1e5, doc: "Contact pressure at equidistant stations from run-in to run-out edge", get: |o, i| o.pressure[i] },
    OutputSpec { name: "contact.sliding_speed", size: STATIONS, unit: "m/s", display: MM_S, nominal: 0.1, doc: "Velocity of the tread face over the road at equidistant stations from run-in to run-out edge", get: |o, i| o.sliding_speed[i] },
    scalar("wear.mass", "kg", MG, 1e-6, "Mass worn off since initialization", |o, _| o.wear_mass),
    scalar("wear.depth_max", "m", UM, 1e-6, "Largest worn depth", |o, _| o.wear_depth_max),
    scalar("carriage.z", "m", MM, 1e-2, "Height of the middle of the clamped face above the road", |o, _| o.carriage_z),
    scalar("carriage.deflection.x", "m", UM, 1e-5, "Deflection of the clamped face against its drive, forward (effect rig_compliance)", |o, _| o.deflection),
    scalar("carriage.deflection_velocity.x", "m/s", MM_S, 0.01, "Velocity of that deflection, forward", |o, _| o.deflection_velocity),
];

const fn scalar(
    name: &'static str,
    unit: &'static str,
    display: Option<DisplayUnit>,
    nominal: f64,
    doc: &'static str,
    get: fn(&Outputs, usize) -> f64,
) -> OutputSpec {
    OutputSpec { name, size: 1, unit, display, nominal, doc, get }
}
