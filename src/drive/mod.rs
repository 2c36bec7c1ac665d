//! How the clamped face and the load move within a communication step.

mod predictor;
mod segment;

pub use predictor::{Known, Predictor};
pub use segment::{Cubic, Pose, Segment};
