//! The C functions of FMI 2.0 co-simulation: thin, each through one guard.
//!
//! # Safety
//! All functions take what the standard says: a component is NULL or came from [`fmi2Instantiate`]
//! and is not yet freed, arrays hold as many elements as announced, texts end with a zero byte, and
//! one instance is used by one thread at a time.

mod guard;
mod lifecycle;
mod not_offered;
mod states;
mod steps;
mod values;

pub use lifecycle::*;
pub use not_offered::*;
pub use states::*;
pub use steps::*;
pub use values::*;
