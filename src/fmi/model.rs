//! The block of an instance: built when first needed, kept for a reset, rebuilt only where its shape changes.

use super::Refusal;
use crate::block::{Outputs, Shape, TreadBlock};
use crate::drive::Pose;
use crate::params::Params;

/// The block: built when first needed, kept pristine for a reset.
#[derive(Default)]
pub struct Model {
    pristine: Option<TreadBlock>,
    block: Option<TreadBlock>,
    /// Start time and pose with which `block` was initialized.
    rest: Option<(f64, Pose)>,
}

impl Model {
    /// The block at rest at `time` under `pose`; builds and initializes only what has changed.
    pub fn at_rest(&mut self, params: &Params, time: f64, pose: Pose) -> Result<&Outputs, Refusal> {
        if self.pristine.as_ref().is_none_or(|built| built.params() != params) {
            self.forget();
            self.pristine = Some(rebuilt(self.pristine.take(), params)?);
        }
        if self.rest != Some((time, pose)) {
            self.forget();
            let mut block = self.pristine.clone();
            if let Some(block) = &mut block {
                block.initialize(time, pose)?;
            }
            self.block = block;
            self.rest = Some((time, pose));
        }
        self.outputs().ok_or_else(|| Refusal::error("the block is not initialized"))
    }

    /// The block in motion.
    pub fn running(&mut self) -> Option<&mut TreadBlock> {
        self.block.as_mut()
    }

    /// The block, to look at.
    pub fn block(&self) -> Option<&TreadBlock> {
        self.block.as_ref()
    }

    /// What it tells, if it is initialized.
    pub fn outputs(&self) -> Option<&Outputs> {
        self.block.as_ref().map(TreadBlock::outputs)
    }

    /// Drops the motion, keeps the pristine block.
    pub fn forget(&mut self) {
        self.block = None;
        self.rest = None;
    }

    /// A block of these parameters that holds the motion `state`.
    pub fn resume(&mut self, params: &Params, state: &[f64]) -> Result<(), Refusal> {
        if self.pristine.as_ref().is_none_or(|built| built.params() != params) {
            self.pristine = Some(TreadBlock::new(params)?);
        }
        let mut block = self.pristine.clone();
        let fits = block.as_mut().is_some_and(|block| block.restore(state));
        if !fits {
            return Err(Refusal::error("the state does not fit the block of its own parameters"));
        }
        self.forget();
        self.block = block;
        Ok(())
    }
}

/// A block of these parameters; the reduction of the one before serves where its shape is the same.
fn rebuilt(before: Option<TreadBlock>, params: &Params) -> Result<TreadBlock, Refusal> {
    let kept = before.filter(|block| Shape::of(block.params()) == Shape::of(params));
    Ok(match kept {
        Some(block) => TreadBlock::with_reduction(params, block.reduction().clone())?,
        None => TreadBlock::new(params)?,
    })
}
