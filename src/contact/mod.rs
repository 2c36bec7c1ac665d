//! Contact of the tread face with the road: nonlinear stiffness, friction characteristic, wear.

pub mod face;
pub mod friction;
pub mod friction_table;
pub mod normal;
pub mod wear;

pub use face::{Face, Placed, Traction};
pub use friction::{FrictionLaw, Mu};
