//! The one table of parameters: name, unit, range, meaning, and how to reach the number.

pub use super::spec::{DisplayUnit, Item, Kind, ParamSpec, Value, Variability};

use super::{ContactForm, FrictionForm, NormalDrive, Plane};
use crate::{enum_param, real_param};

const MM: Option<DisplayUnit> = Some(DisplayUnit { name: "mm", factor: 1e3 });
const UM: Option<DisplayUnit> = Some(DisplayUnit { name: "um", factor: 1e6 });
const US: Option<DisplayUnit> = Some(DisplayUnit { name: "us", factor: 1e6 });
const MPA: Option<DisplayUnit> = Some(DisplayUnit { name: "MPa", factor: 1e-6 });
const KPA: Option<DisplayUnit> = Some(DisplayUnit { name: "kPa", factor: 1e-3 });
const MM_S: Option<DisplayUnit> = Some(DisplayUnit { name: "mm/s", factor: 1e3 });
const KHZ: Option<DisplayUnit> = Some(DisplayUnit { name: "kHz", factor: 1e-3 });

/// A count at a field of [`Params`].
macro_rules! count_param {
    ($name:literal, $($field:ident).+, $min:expr, $max:expr, $doc:literal) => {
        ParamSpec {
            name: $name,
            kind: Kind::Integer { min: $min, max: $max },
            variability: Variability::Fixed,
            doc: $doc,
            get: |p| Value::Integer(p.$($field).+ as i32),
            set: |p, v| match v {
                Value::Integer(i) if *i >= 0 => { p.$($field).+ = *i as usize; true }
                _ => false,
            },
        }
    };
}

impl Plane {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Stress, Self::Strain];
}
impl FrictionForm {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 5] =
        [Self::Exponential, Self::Rational, Self::LogBell, Self::Table, Self::TwoExponentials];
}
impl ContactForm {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Exponential, Self::Power];
}
impl NormalDrive {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::Load, Self::Trajectory];
}

const PLANES: &[Item] = &[
    Item { name: "stress", doc: "plane stress: the block is free to bulge sideways" },
    Item { name: "strain", doc: "plane strain: the block is held sideways" },
];
const FRICTION_FORMS: &[Item] = &[
    Item { name: "exponential", doc: "stretched exponential fall with speed" },
    Item { name: "rational", doc: "rational fall with speed" },
    Item { name: "log_bell", doc: "bell over the logarithm of speed" },
    Item { name: "table", doc: "measured table over pressure and speed" },
    Item { name: "two_exponentials", doc: "a fast and a slow exponential fall with speed" },
];
const CONTACT_FORMS: &[Item] = &[
    Item { name: "exponential", doc: "p = p_r (exp(u/u0) - 1)" },
    Item { name: "power", doc: "p = p_r (u/u0)^m" },
];
const NORMAL_DRIVES: &[Item] = &[
    Item { name: "load", doc: "a carriage carries normal_load and moves freely in z" },
    Item { name: "trajectory", doc: "belt.z is prescribed" },
];

/// Parameters of the base model; those of the effects follow in [`specs`].
#[rustfmt::skip]
static BASE: &[ParamSpec] = &[
    real_param!("block.length", block.length, "m", MM, 1e-3, 0.2, 0.015, Fixed, "Length of the block in rolling direction"),
    real_param!("block.height", block.height, "m", MM, 1e-3, 0.1, 0.01, Fixed, "Height of the block from the tread face to the clamped face"),
    real_param!("block.width", block.width, "m", MM, 1e-3, 0.5, 0.015, Fixed, "Width of the block across the plane of the model"),
    real_param!("rubber.young_modulus", rubber.young_modulus, "Pa", MPA, 1e5, 1e10, 5e7, Fixed, "Young's modulus of the rubber at vibration frequencies"),
    real_param!("rubber.poisson_ratio", rubber.poisson_ratio, "1", None, 0.0, 0.4999, 0.49, Fixed, "Poisson's ratio of the rubber"),
    real_param!("rubber.density", rubber.density, "kg/m3", None, 100.0, 10000.0, 1100.0, Fixed, "Density of the rubber"),
    real_param!("rubber.stiffness_damping", rubber.stiffness_damping, "s", US, 0.0, 1e-2, 2e-5, Fixed, "Damping factor beta of D = beta C, C the stiffness matrix"),
    enum_param!("rubber.plane", rubber.plane, Plane, "Plane", PLANES, Fixed, "Plane stress or plane strain"),
    enum_param!("friction.form", friction.form, FrictionForm, "FrictionForm", FRICTION_FORMS, Fixed, "Form of the friction characteristic"),
    real_param!("friction.mu_inf", friction.mu_inf, "1", None, 0.0, 10.0, 0.5, Tunable, "Friction coefficient at high sliding speed"),
    real_param!("friction.mu_drop", friction.mu_drop, "1", None, -5.0, 10.0, 0.75, Tunable, "Fall of the friction coefficient from low to high speed"),
    real_param!("friction.decay_speed", friction.decay_speed, "m/s", MM_S, 1e-5, 100.0, 0.3, Tunable, "Speed over which friction falls; in the log-bell law the speed of its maximum"),
    real_param!("friction.decay_exponent", friction.decay_exponent, "1", None, 0.1, 5.0, 1.0, Tunable, "Exponent g of exp(-(|v|/decay_speed)^g)"),
    real_param!("friction.smoothing_speed", friction.smoothing_speed, "m/s", MM_S, 1e-5, 1.0, 0.01, Tunable, "Width of the arctan smoothing at zero speed"),
    real_param!("friction.pressure_exponent", friction.pressure_exponent, "1", None, -1.0, 1.0, 0.1, Tunable, "Exponent of the local pressure over the reference pressure"),
    real_param!("friction.reference_pressure", friction.reference_pressure, "Pa", KPA, 1e3, 1e8, 2.5e5, Tunable, "Pressure at which the friction coefficients hold"),
    real_param!("friction.rational_exponent", friction.rational_exponent, "1", None, 0.1, 5.0, 1.0, Tunable, "Exponent m of the rational law mu_inf + mu_drop/(1 + (|v|/decay_speed)^m)"),
    real_param!("friction.bell_steepness", friction.bell_steepness, "1", None, 0.01, 10.0, 0.7, Tunable, "Steepness k of the log-bell law exp(-(k log10(|v|/decay_speed))^2)"),
    real_param!("friction.slow_share", friction.slow_share, "1", None, 0.0, 1.0, 0.5, Tunable, "Share of the fall that is slow in the law of two exponentials"),
    real_param!("friction.slow_speed", friction.slow_speed, "m/s", MM_S, 1e-3, 1000.0, 3.0, Tunable, "Speed over which the slow share falls"),
    real_param!("friction.slow_exponent", friction.slow_exponent, "1", None, 0.1, 5.0, 1.0, Tunable, "Exponent of the slow share: exp(-(|v|/slow_speed)^g)"),
    ParamSpec {
        name: "friction.table_file", kind: Kind::Text, variability: Variability::Fixed,
        doc: "CSV of a measured characteristic (pressure_pa, speed_m_s, mu) for the form table",
        get: |p| Value::Text(p.friction.table_file.clone()),
        set: |p, v| match v { Value::Text(t) => { p.friction.table_file = t.clone(); true } _ => false },
    },
    enum_param!("contact.form", contact.form, ContactForm, "ContactForm", CONTACT_FORMS, Fixed, "Form of the nonlinear contact stiffness"),
    real_param!("contact.reference_pressure", contact.reference_pressure, "Pa", KPA, 10.0, 1e9, 8e4, Tunable, "Reference pressure of the contact stiffness"),
    real_param!("contact.depth", contact.depth, "m", UM, 1e-7, 1e-2, 4e-5, Tunable, "Compression over which the contact pressure grows e-fold (exponential) or reaches the reference pressure (power)"),
    real_param!("contact.exponent", contact.exponent, "1", None, 1.0, 6.0, 2.0, Tunable, "Exponent of the power law"),
    real_param!("wear.coefficient", wear.coefficient, "kg/m3", None, 0.0, 1e3, 2.75e-3, Tunable, "Mass worn per area and sliding distance at mu = 1, 250 kPa, 0.3 m/s"),
    real_param!("wear.pressure_exponent", wear.pressure_exponent, "1", None, 0.0, 5.0, 1.0, Tunable, "Exponent of the pressure in the wear rate"),
    real_param!("wear.speed_exponent", wear.speed_exponent, "1", None, -2.0, 5.0, 1.0, Tunable, "Exponent of the sliding speed in the wear rate"),
    real_param!("carriage.mass", carriage.mass, "kg", None, 1e-3, 1e4, 2.0, Fixed, "Mass of the carriage that moves with the clamped face in z (load drive)"),
    real_param!("carriage.damping", carriage.damping, "N.s/m", None, 0.0, 1e6, 240.0, Fixed, "Viscous damping of the carriage (load drive)"),
    enum_param!("drive.normal", drive.normal, NormalDrive, "NormalDrive", NORMAL_DRIVES, Fixed, "What drives the clamped face normal to the road"),
    count_param!("solver.elements_along", solver.elements_along, 0, 60, "Quadratic elements along the tread face; 0: chosen from the size of the block"),
    count_param!("solver.elements_up", solver.elements_up, 0, 40, "Quadratic elements over the height; 0: chosen from the size of the block"),
    count_param!("solver.contact_points", solver.contact_points, 0, 40, "Contact points of the tread face, dense towards its edges, through which it moves as a polynomial; 0: the nodes of the elements. Fewer are faster"),
    real_param!("solver.frequency_bound", solver.frequency_bound, "Hz", KHZ, 1e3, 1e6, 2e4, Fixed, "Fixed-interface modes up to this frequency are kept"),
    real_param!("solver.tolerance", solver.tolerance, "1", None, 1e-9, 1.0, 1e-3, Fixed, "Error of one internal step relative to the motion's own scale"),
    real_param!("solver.max_step", solver.max_step, "s", US, 1e-8, 1e-3, 2e-5, Fixed, "Largest internal step"),
    real_param!("solver.min_step", solver.min_step, "s", US, 1e-10, 1e-4, 1e-7, Fixed, "Smallest internal step"),
];

/// All parameters: those of the base model, then those of the effects, in a fixed order.
pub fn specs() -> impl Iterator<Item = &'static ParamSpec> {
    BASE.iter().chain(crate::effects::tables().into_iter().flatten())
}

/// The parameter of this name.
pub fn find(name: &str) -> Option<&'static ParamSpec> {
    specs().find(|s| s.name == name)
}

/// Text of a value as a user would write it.
pub fn show(spec: &ParamSpec, value: &Value) -> String {
    match (value, spec.kind) {
        (Value::Integer(i), Kind::Enumeration { items, .. }) => usize::try_from(*i - 1)
            .ok()
            .and_then(|at| items.get(at))
            .map_or_else(|| i.to_string(), |item| item.name.to_string()),
        (Value::Real(x), _) => format!("{x}"),
        (Value::Integer(i), _) => i.to_string(),
        (Value::Boolean(b), _) => b.to_string(),
        (Value::Text(t), _) => t.clone(),
    }
}
