//! A tyre's tread block that sticks and slips on the road, small enough to simulate in real time.
//!
//! Data flows one way, in the order of the modules:
//! parameters → mesh → finite elements → reduction → contact → dynamics → block; the C interface
//! (`fmi`), the command line, the studies and the gap diagnosis stand beside each other on the block.

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod block;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
pub mod columns;
pub mod contact;
pub mod drive;
pub mod dynamics;
pub mod effects;
pub mod error;
pub mod fe;
pub mod fmi;
#[cfg(feature = "cli")]
pub mod gap;
pub mod mesh;
pub mod metrics;
pub mod pack;
#[cfg(feature = "cli")]
pub mod page;
pub mod params;
pub mod reduction;
pub mod scenario;
#[cfg(feature = "cli")]
pub mod study;
#[cfg(feature = "cli")]
pub mod sweep;
#[cfg(feature = "cli")]
pub mod threads;

pub use block::TreadBlock;
pub use error::{Fault, Problem};
pub use params::Params;
