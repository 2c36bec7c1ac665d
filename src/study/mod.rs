//! The paper's studies on the project's own model, side by side with the paper's numbers.

pub mod identify;
pub mod paper;
pub mod plot;
pub mod report;
pub mod slides;
pub mod table_one;
pub mod vibration;
