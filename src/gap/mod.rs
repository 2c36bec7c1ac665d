//! Diagnosis of the gap between a measured campaign and the model: where it lies, which unmodelled
//! effect causes it, how far it shrinks once the effect is added.
//!
//! Campaign → features of every run → base model recalibrated to the datasheet's spread → every effect
//! added and fitted with equal effort → probabilities → hold-out runs. See the book, `gap.md`.

pub mod balance;
pub mod calibration;
pub mod campaign;
pub mod decide;
pub mod diagnose;
pub mod features;
pub mod fit;
pub mod floor;
pub mod friction;
pub mod guess;
pub mod held_out;
pub mod hypotheses;
pub mod import;
pub mod json;
pub mod noise;
pub mod packed;
pub mod polish;
pub mod predict;
pub mod problem;
pub mod quality;
pub mod report;
mod ripple;
pub mod score;
pub mod second_look;
pub mod simulate;
pub mod spectrum;
pub mod suite;
pub mod svg;
pub mod symmetry;
pub mod verify;
pub mod where_;
