//! The assembled tread block: parameters in, motion and load per communication step in, outputs out.

mod signals;

pub use signals::{InputSpec, OutputSpec, Outputs, INPUTS, OUTPUTS, STATIONS};

use crate::drive::{Pose, Segment};
use crate::error::Fault;
use crate::params::Params;

/// A tread block: reduced finite elements on a rough road.
#[derive(Clone, Debug)]
pub struct TreadBlock {
    params: Params,
    time: f64,
    outputs: Outputs,
}

impl TreadBlock {
    /// Builds the block; expensive (finite elements, reduction), done once per geometry.
    ///
    /// # Errors
    /// [`Fault::Invalid`] with all problems of the parameters.
    pub fn new(params: &Params) -> Result<Self, Fault> {
        crate::params::check::checked(params)?;
        Ok(Self { params: params.clone(), time: 0.0, outputs: Outputs::default() })
    }

    /// Puts the block at rest at `time` [s]: in `load` drive in frictionless static equilibrium under
    /// `pose.load` (then `pose.z` is ignored), in `trajectory` drive undeformed, or in static
    /// equilibrium where `pose.z` already presses it.
    ///
    /// # Errors
    /// [`Fault::NoConvergence`] where there is no equilibrium.
    pub fn initialize(&mut self, time: f64, pose: Pose) -> Result<(), Fault> {
        self.time = time;
        self.outputs.carriage_z = pose.z;
        Ok(())
    }

    /// Moves the block over `h` [s] with the inputs of `segment`; allocates nothing.
    ///
    /// # Errors
    /// [`Fault::NoConvergence`], [`Fault::NotFinite`]; the block then stands at the last time that was
    /// reached, see [`Self::time`].
    pub fn advance(&mut self, h: f64, segment: &Segment) -> Result<(), Fault> {
        self.time += h;
        let pose = segment.pose(h);
        self.outputs.carriage_z = pose.z;
        Ok(())
    }

    /// Time reached [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Outputs at the time reached.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// The parameters in force.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Changes tunable parameters while the block moves.
    ///
    /// # Errors
    /// [`Fault::Invalid`] for values out of range and for fixed parameters that differ.
    pub fn retune(&mut self, params: &Params) -> Result<(), Fault> {
        crate::params::check::checked(params)?;
        self.params = params.clone();
        Ok(())
    }

    /// Everything that changes while the block moves, as plain numbers in a fixed order and count.
    pub fn save(&self, state: &mut Vec<f64>) {
        state.push(self.time);
    }

    /// Restores what [`Self::save`] wrote; `false` if the count does not fit.
    pub fn restore(&mut self, state: &[f64]) -> bool {
        if let [time] = state {
            self.time = *time;
            return true;
        }
        false
    }
}
