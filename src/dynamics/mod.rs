//! Motion of the reduced block: decoupled linear part, implicit contact and friction, adaptive steps.

pub mod dense;
pub mod energy;
pub mod equilibrium;
pub mod gauss_jordan;
pub mod iteration;
pub mod kept_inverse;
mod kinematics;
pub mod linear;
pub mod matrices;
pub mod newton;
pub mod stage;
pub mod state;
pub mod step;
pub mod tr_bdf2;
mod turned;

pub use energy::Ledger;
pub use kinematics::{kinematics, Kinematics};
pub use linear::{BaseDof, Linear};
pub use stage::Stage;
pub use state::State;
pub use step::{Integrator, Settings, Statistics};
