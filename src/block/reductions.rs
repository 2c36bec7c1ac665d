//! Reductions that blocks of one shape share.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::Shape;
use crate::error::Fault;
use crate::params::Params;
use crate::reduction::Reduction;

/// Shapes whose reductions are kept: many runs over the geometry would else fill the memory.
pub const KEPT: usize = 64;

type Made = Arc<OnceLock<Result<Arc<Reduction>, Fault>>>;

/// The last [`KEPT`] reductions, one per [`Shape`]; threads wait only for the shape that they need.
#[derive(Debug, Default)]
pub struct Reductions {
    kept: Mutex<VecDeque<(Shape, Made)>>,
}

impl Reductions {
    /// The reduction for `params`, made at the first call for its shape.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn of(&self, params: &Params) -> Result<Arc<Reduction>, Fault> {
        self.of_shape(Shape::of(params))
    }

    /// The reduction of `shape`, made at the first call for it.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn of_shape(&self, shape: Shape) -> Result<Arc<Reduction>, Fault> {
        let made = self.place(shape);
        made.get_or_init(|| shape.reduce().map(Arc::new)).clone()
    }

    fn place(&self, shape: Shape) -> Made {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, made)) = kept.iter().find(|(known, _)| *known == shape) {
            return made.clone();
        }
        if kept.len() == KEPT {
            kept.pop_front();
        }
        let made = Made::default();
        kept.push_back((shape, made.clone()));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_reduced_once_and_the_oldest_of_many_makes_room() {
        let reductions = Reductions::default();
        let of_length = |millimetres: usize| {
            let mut params = Params::default();
            params.block.length = 1e-3 * millimetres as f64;
            params.solver.elements_along = 4;
            params.solver.elements_up = 3;
            reductions.of(&params).unwrap()
        };
        let first = of_length(5);
        assert!(Arc::ptr_eq(&first, &of_length(5)), "made once");
        for millimetres in 6..6 + KEPT {
            of_length(millimetres);
        }
        assert!(!Arc::ptr_eq(&first, &of_length(5)), "{KEPT} others came after it");
    }
}
