//! One communication step: what may go in, what comes out, and at which time the block stands.

use super::instance::Instance;
use super::Refusal;
use crate::block::OUTPUTS;

/// Longest communication step \[s\]; more is a slip of units, and would keep the importer waiting.
const MAX_STEP: f64 = 10.0;

/// Times of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Clock {
    /// Start time \[s\].
    pub start: f64,
    /// Stop time \[s\], if the importer defined one.
    pub stop: Option<f64>,
    /// The present communication point \[s\].
    pub time: f64,
    /// Time up to which the solution is good \[s\].
    pub last_successful: f64,
    /// Length of the last step \[s\], as far as it succeeded; 0 before the first.
    pub last_step: f64,
}

impl Clock {
    /// Takes over start and stop time of `fmi2SetupExperiment`.
    pub fn set_up(&mut self, start: f64, stop: Option<f64>) -> Result<(), Refusal> {
        if !start.is_finite() {
            return Err(Refusal::error(format!(
                "startTime = {start}: allowed is a finite number; give the start of the simulation"
            )));
        }
        if let Some(stop) = stop.filter(|stop| !stop.is_finite() || *stop < start) {
            return Err(Refusal::error(format!(
                "stopTime = {stop}: allowed is a finite number not before startTime = {start}; \
                 correct it or set stopTimeDefined to fmi2False"
            )));
        }
        *self = Self { start, stop, time: start, last_successful: start, last_step: 0.0 };
        Ok(())
    }

    /// The length by which the model has to move so that it arrives at `time + h`.
    ///
    /// Importers count time in their own way (sums, products, nanoseconds). A difference of rounding
    /// leaves `h` alone; a drift of up to a thousandth of the step is taken up by this step.
    fn admit(&self, time: f64, h: f64) -> Result<f64, Refusal> {
        if !(h > 0.0 && h <= MAX_STEP) {
            return Err(Refusal::error(format!(
                "communicationStepSize = {h}: allowed is more than 0 up to {MAX_STEP} s; give a \
                 positive step (1e-6 to 1e-3 s serve best)"
            )));
        }
        let gap = time - self.time;
        let rounding = 16.0 * f64::EPSILON * time.abs().max(h);
        if !gap.is_finite() || gap.abs() > rounding + 1e-3 * h {
            return Err(Refusal::error(format!(
                "currentCommunicationPoint = {time}: allowed is {} (the end of the last step, or \
                 the start time); continue there, or restore a state of that time",
                self.time
            )));
        }
        if time + h <= time {
            return Err(Refusal::error(format!(
                "communicationStepSize = {h}: is lost in rounding at t = {time} s; take a longer step"
            )));
        }
        if let Some(stop) = self.stop.filter(|stop| time + h > stop + 1e-3 * h + rounding) {
            return Err(Refusal::error(format!(
                "communicationStepSize = {h} at t = {time} s: goes beyond stopTime = {stop}; end \
                 there, or set stopTimeDefined to fmi2False"
            )));
        }
        Ok(if gap.abs() <= rounding { h } else { h + gap })
    }
}

/// `fmi2DoStep`; allocates nothing while all goes well.
pub fn do_step(instance: &mut Instance, time: f64, h: f64) -> Result<(), Refusal> {
    let model_step = instance.clock.admit(time, h)?;
    instance.inputs.check_jump(time)?;
    let Some(block) = instance.model.running() else {
        return Err(Refusal::error("the block is not initialized"));
    };
    if block.params() != instance.settings.params() {
        block.retune(instance.settings.params())?;
    }
    remember(block.outputs(), &mut instance.before);
    let segment = instance.predictor.segment(time, model_step, instance.inputs.known());
    let start = block.time();
    let result = block.advance(model_step, &segment);
    instance.inputs.step_done(time);
    instance.clock.last_step = h;
    match result {
        Ok(()) => {
            instance.clock.time = time + h;
            instance.clock.last_successful = time + h;
            Ok(())
        }
        Err(fault) => {
            let reached = instance.clock.time + (block.time() - start).clamp(0.0, h);
            instance.clock.last_successful = reached;
            instance.clock.last_step = reached - instance.clock.time;
            Err(Refusal::discard(format!("the step stopped at t = {reached} s: {fault}")))
        }
    }
}

/// Keeps the outputs of the start of a step, for the output derivatives.
fn remember(outputs: &crate::block::Outputs, before: &mut [f64]) {
    let values = OUTPUTS.iter().flat_map(|spec| (0..spec.size).map(|i| (spec.get)(outputs, i)));
    for (slot, value) in before.iter_mut().zip(values) {
        *slot = value;
    }
}
