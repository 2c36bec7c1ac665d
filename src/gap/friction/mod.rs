//! Friction records without block dynamics: which effect explains them.
//!
//! CSV → strokes or steps → every law fitted on some of them and judged on the others → probabilities.

mod design;
pub mod fit;
pub mod law;
pub mod record;
pub mod told;
pub mod verdict;
