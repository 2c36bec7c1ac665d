//! Parameters of the model: one tree of plain structs in SI units, one table that names them.
//!
//! The dotted names of [`table`] serve the TOML files, the command line, the FMU and the docs.

pub mod check;
pub mod load;
mod spec;
pub mod table;

pub use table::{Kind, ParamSpec, Value, Variability};

use crate::effects::Effects;

/// Everything that a tread block is made of and how it is solved.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Params {
    /// Size of the block.
    pub block: Block,
    /// Rubber compound.
    pub rubber: Rubber,
    /// Friction characteristic μ(p, v).
    pub friction: Friction,
    /// Nonlinear contact stiffness p(u).
    pub contact: Contact,
    /// Wear law.
    pub wear: Wear,
    /// Carriage that carries the normal load in `load` drive.
    pub carriage: Carriage,
    /// How the clamped face is driven.
    pub drive: Drive,
    /// Discretisation and integrator.
    pub solver: Solver,
    /// Physical effects beyond the base model, all off by default.
    pub effect: Effects,
}

/// Size of the undeformed block \[m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Length l in rolling direction \[m\].
    pub length: f64,
    /// Height h from the tread face to the clamped face \[m\].
    pub height: f64,
    /// Width b across the plane of the model \[m\].
    pub width: f64,
}

impl Default for Block {
    fn default() -> Self {
        Self { length: 0.015, height: 0.010, width: 0.015 }
    }
}

/// Assumption about the stress across the plane of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Plane {
    /// σ_yy = 0: the block is free to bulge sideways.
    #[default]
    Stress,
    /// ε_yy = 0: the block is held between its neighbours.
    Strain,
}

/// Linear viscoelastic rubber, D = β C.
#[derive(Clone, Debug, PartialEq)]
pub struct Rubber {
    /// Young's modulus E \[Pa\].
    pub young_modulus: f64,
    /// Poisson's ratio ν \[-\].
    pub poisson_ratio: f64,
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Stiffness-proportional damping β \[s\].
    pub stiffness_damping: f64,
    /// Plane stress or plane strain.
    pub plane: Plane,
}

impl Default for Rubber {
    fn default() -> Self {
        Self {
            young_modulus: 50e6,
            poisson_ratio: 0.49,
            density: 1100.0,
            stiffness_damping: 2e-5,
            plane: Plane::Stress,
        }
    }
}

/// Form of the friction characteristic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum FrictionForm {
    /// Stretched exponential fall, see the law.
    #[default]
    Exponential,
    /// Rational law, see the law.
    Rational,
    /// Log-bell law, see the law.
    LogBell,
    /// Table measured over p and v, see the law.
    Table,
    /// A fast and a slow exponential fall, see the law.
    TwoExponentials,
}

/// Friction characteristic μ(p, v).
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Form of the law.
    pub form: FrictionForm,
    /// Friction coefficient at high speed μ_∞ \[-\].
    pub mu_inf: f64,
    /// Fall from low to high speed Δμ \[-\].
    pub mu_drop: f64,
    /// Speed of the fall v_d \[m/s\].
    pub decay_speed: f64,
    /// Exponent γ of the stretched exponential exp(−(|v|/v_d)^γ) \[-\].
    pub decay_exponent: f64,
    /// Width v_ε of the arctan smoothing at v = 0 \[m/s\].
    pub smoothing_speed: f64,
    /// Exponent of the local pressure \[-\].
    pub pressure_exponent: f64,
    /// Pressure at which the coefficients hold \[Pa\].
    pub reference_pressure: f64,
    /// Exponent m of the speed in the rational law \[-\].
    pub rational_exponent: f64,
    /// Half width k of the log-bell law in decades⁻¹ \[-\].
    pub bell_steepness: f64,
    /// Share of the fall that is slow in the law of two exponentials \[-\].
    pub slow_share: f64,
    /// Speed over which the slow share falls \[m/s\].
    pub slow_speed: f64,
    /// Exponent of the slow share of two exponentials: exp(−(|v|/slow_speed)^g).
    pub slow_exponent: f64,
    /// File of a measured characteristic (CSV: pressure_pa, speed_m_s, mu); empty: none.
    pub table_file: String,
}

impl Default for Friction {
    fn default() -> Self {
        Self {
            form: FrictionForm::Exponential,
            mu_inf: 0.50,
            mu_drop: 0.75,
            decay_speed: 0.30,
            decay_exponent: 1.0,
            smoothing_speed: 0.010,
            pressure_exponent: -0.10,
            reference_pressure: 250e3,
            rational_exponent: 1.0,
            bell_steepness: 0.7,
            slow_share: 0.5,
            slow_speed: 3.0,
            slow_exponent: 1.0,
            table_file: String::new(),
        }
    }
}

/// Form of the nonlinear contact stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ContactForm {
    /// p = p_r (exp(u/u₀) − 1).
    #[default]
    Exponential,
    /// p = p_r (u/u₀)^m.
    Power,
}

/// Nonlinear contact stiffness p(u), u the local compression.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Form of the law.
    pub form: ContactForm,
    /// Reference pressure p_r \[Pa\].
    pub reference_pressure: f64,
    /// Depth u₀ over which the pressure grows e-fold \[m\].
    pub depth: f64,
    /// Exponent m of the power law \[-\].
    pub exponent: f64,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            form: ContactForm::Exponential,
            reference_pressure: 80e3,
            depth: 40e-6,
            exponent: 2.0,
        }
    }
}

/// Wear rate η = k₁ μ (p/p₀)^k₂ (|v|/v₀)^k₃, mass loss per area and sliding distance, with
/// p₀ = 250 kPa and v₀ = 0.3 m/s so that k₁ keeps its unit whatever the exponents.
#[derive(Clone, Debug, PartialEq)]
pub struct Wear {
    /// k₁ \[kg/m³\]: mass per area and distance at μ = 1, p₀, v₀.
    pub coefficient: f64,
    /// k₂ \[-\].
    pub pressure_exponent: f64,
    /// k₃ \[-\].
    pub speed_exponent: f64,
}

impl Default for Wear {
    /// Blunt concrete, 0.01 mm³/(N m): alive, but without influence on a few milliseconds.
    fn default() -> Self {
        Self { coefficient: 0.01e-9 * 1100.0 * 250e3, pressure_exponent: 1.0, speed_exponent: 0.0 }
    }
}

/// Carriage of the `load` drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Carriage {
    /// Mass \[kg\] that moves with the clamped face in z.
    pub mass: f64,
    /// Viscous damping of its motion \[N s/m\].
    pub damping: f64,
}

impl Default for Carriage {
    fn default() -> Self {
        Self { mass: 2.0, damping: 240.0 }
    }
}

/// What drives the clamped face normal to the road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NormalDrive {
    /// The carriage carries `normal_load` and moves freely in z.
    #[default]
    Load,
    /// `belt.z` is prescribed.
    Trajectory,
}

/// How the clamped face is driven.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Drive {
    /// Normal to the road.
    pub normal: NormalDrive,
}

/// Discretisation and integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Solver {
    /// Elements along the tread face; 0: chosen from the block's size.
    pub elements_along: usize,
    /// Elements over the height; 0: chosen from the block's size.
    pub elements_up: usize,
    /// Contact points of the tread face; 0: the nodes of the elements.
    pub contact_points: usize,
    /// Fixed-interface modes up to this frequency are kept \[Hz\].
    pub frequency_bound: f64,
    /// Error of a step relative to the motion's own scale \[-\].
    pub tolerance: f64,
    /// Largest internal step \[s\].
    pub max_step: f64,
    /// Smallest internal step \[s\].
    pub min_step: f64,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            elements_along: 0,
            elements_up: 0,
            contact_points: 0,
            frequency_bound: 10e3,
            tolerance: 5e-3,
            max_step: 5e-6,
            min_step: 0.1e-6,
        }
    }
}
