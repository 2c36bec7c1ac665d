//! Plane finite elements: biquadratic (9-node) quadrilaterals, linear elasticity.
//!
//! Everything is assembled for unit modulus, unit density and unit width: C = E·b·C₁, M = ρ·b·M₁.

mod assemble;
mod element;
mod material;

pub use assemble::{assemble, FullModel};
pub use material::elasticity;
