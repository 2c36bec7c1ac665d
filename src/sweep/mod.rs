//! Many runs over any parameters: a plan, all cores, results that a stop cannot lose.
//!
//! A plan is a run's file with a `[sweep]` table. It becomes points, each a run of its own; every point
//! that is done, or failed, is a line of a journal, from which the tables are made. What a point gives
//! depends on the plan and its number alone, so neither threads, nor the order, nor a stop in between,
//! nor the FMU in place of the library changes a bit.

pub mod axis;
mod design;
pub mod journal;
mod measures;
pub mod plan;
pub mod run;
pub mod serve;
pub mod table;

pub use journal::{Journal, Record};
pub use plan::Plan;
