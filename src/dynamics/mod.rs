//! Motion of the reduced block: decoupled linear part, implicit contact and friction, adaptive steps.

pub mod dense;
mod elimination;
pub mod energy;
pub mod equilibrium;
pub mod flat;
mod full;
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

pub use energy::Ledger;
pub use kinematics::{kinematics, Kinematics};
pub use linear::{BaseDof, Linear};
pub use stage::Stage;
pub use state::State;
pub use step::{Integrator, Settings, Statistics};
