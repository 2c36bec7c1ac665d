//! Candidate effects: one file each, physical extensions of the base model that are off by default.
//!
//! To add an effect: write its file (parameters, law, table, what a fit may vary) and add its line
//! to `effects!`. Effects of geometry, contact and rubber act where the block is built
//! (`block::build`); what they remember is the
//! block's memory (`block::memory`).

pub mod fit;

use crate::params::ParamSpec;
pub use fit::{FitForm, FitParam, FitSpec, Module, Spread};

/// Registers effects: a field of [`Effects`], a parameter table and a fit specification each.
macro_rules! effects {
    ($($name:ident :: $type:ident),* $(,)?) => {
        $(pub mod $name;)*
        /// Parameters of all effects.
        #[derive(Clone, Debug, PartialEq, Default)]
        pub struct Effects {
            $(
                #[doc = concat!("See [`", stringify!($name), "`].")]
                pub $name: $name::$type,
            )*
        }
        /// Names of all effects, in the order of registration.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];
        /// Parameter tables of all effects, in the order of registration.
        pub fn tables() -> Vec<&'static [ParamSpec]> {
            vec![$($name::PARAMS),*]
        }
        /// What a fit may vary, in the order of registration.
        pub fn fit_specs() -> &'static [FitSpec] {
            &[$($name::FIT),*]
        }
    };
}

effects! {
    thermal_friction::ThermalFriction,
    viscoelastic_modulus::ViscoelasticModulus,
    payne_softening::PayneSoftening,
    friction_ageing::FrictionAgeing,
    adhesion::Adhesion,
    road_texture::RoadTexture,
    rig_compliance::RigCompliance,
    misalignment::Misalignment,
    contact_damping::ContactDamping,
    worn_edge::WornEdge,
    sensor_dynamics::SensorDynamics,
}
