//! The inputs at the present communication point, checked before they reach the model.

use super::Refusal;
use crate::block::{InputSpec, INPUTS};
use crate::drive::{Known, Pose};

/// Largest believable rate of each input \[unit/s\], in the order of [`INPUTS`]: faster is a jump.
///
/// 200 m/s is twice what a tyre does; 5e4 rad/s bends a belt by half a turn in 60 µs. A load may
/// jump: the carriage's mass answers it.
const MAX_RATES: [f64; 4] = [200.0, 200.0, 5e4, f64::INFINITY];

/// What the importer has set.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Inputs {
    /// Values.
    pub pose: Pose,
    /// First and second derivatives for the next step.
    pub derivatives: [[Option<f64>; 2]; 4],
    /// Time and values with which the last step started.
    pub last: Option<(f64, Pose)>,
}

impl Inputs {
    /// Sets a value; refuses what is not finite or out of range.
    pub fn set(&mut self, spec: &InputSpec, value: f64) -> Result<(), Refusal> {
        if !value.is_finite() || value < spec.min || value > spec.limit {
            return Err(Refusal::error(format!(
                "{} = {value}: allowed is {} to {} {}; check what is connected to this input",
                spec.name, spec.min, spec.limit, spec.unit
            )));
        }
        (spec.set)(&mut self.pose, value);
        Ok(())
    }

    /// Sets a derivative of order 1 or 2 for the next step.
    pub fn set_derivative(&mut self, input: usize, order: i32, value: f64) -> Result<(), Refusal> {
        let name = INPUTS[input].name;
        if !(1..=2).contains(&order) {
            return Err(Refusal::error(format!(
                "order {order} of the derivative of {name}: allowed is 1 or 2"
            )));
        }
        if !value.is_finite() || (order == 1 && value.abs() > MAX_RATES[input]) {
            return Err(Refusal::error(format!(
                "derivative {order} of {name} = {value}: allowed is a finite number{}; check what \
                 sets this derivative",
                match (order, MAX_RATES[input].is_finite()) {
                    (1, true) => format!(" up to {} {}/s", MAX_RATES[input], INPUTS[input].unit),
                    _ => String::new(),
                }
            )));
        }
        self.derivatives[input][order as usize - 1] = Some(value);
        Ok(())
    }

    /// Refuses a step that would start with a jump since the start of the last one.
    pub fn check_jump(&self, time: f64) -> Result<(), Refusal> {
        let Some((last_time, last)) = self.last else { return Ok(()) };
        let h = time - last_time;
        for (spec, max_rate) in INPUTS.iter().zip(MAX_RATES) {
            let (before, now) = ((spec.get)(&last), (spec.get)(&self.pose));
            if (now - before).abs() > max_rate * h {
                return Err(Refusal::error(format!(
                    "{} = {now}: jumps from {before} within {h:e} s; allowed is a change of {:e} {} \
                     (a rate of {max_rate} {}/s); let the input start where the block was \
                     initialized and move smoothly",
                    spec.name,
                    max_rate * h,
                    spec.unit,
                    spec.unit
                )));
            }
        }
        Ok(())
    }

    /// Values and derivatives as the predictor wants them. A second derivative alone means that
    /// the first is zero, as the standard's Taylor formula has it.
    pub fn known(&self) -> [Known; 4] {
        std::array::from_fn(|i| {
            let [rate, curvature] = self.derivatives[i];
            Known {
                value: (INPUTS[i].get)(&self.pose),
                rate: rate.or(curvature.map(|_| 0.0)),
                curvature,
            }
        })
    }

    /// After a step: derivatives hold for one step only.
    pub fn step_done(&mut self, start: f64) {
        self.derivatives = Default::default();
        self.last = Some((start, self.pose));
    }
}
