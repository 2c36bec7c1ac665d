//! The two FMUs around the tread block: a belt path source before it, an acoustic stage behind it.
//!
//! A stage is a table of variables and a step ([`stage::Stage`]); [`c_interface`] makes an FMI 2.0
//! co-simulation FMU of it. The belt's law is the block's own source file, included, not copied.

pub mod acoustic_stage;
pub mod belt_source;
pub mod c_interface;
pub mod description;
mod export;
pub mod radiation;
pub mod stage;
pub mod third_octave;

/// The standard's types, for the exported functions.
pub use fmi_sys::fmi2 as fmi;

#[path = "../../../../src/scenario/belt_path.rs"]
pub mod belt_path;
#[path = "../../../../src/error.rs"]
pub mod error;
