//! Identification of friction, contact and damping from Table 1.

pub mod cma;
pub mod gauss_newton;
pub mod hops;
pub mod laws;
pub mod objective;
pub mod report;
pub mod residual;
pub mod run;
pub mod space;
pub mod toll;
pub mod walk;
