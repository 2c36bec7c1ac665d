//! Identification of friction, contact and damping from Table 1.

pub mod cma;
pub mod gauss_newton;
pub mod objective;
pub mod report;
pub mod run;
pub mod space;
