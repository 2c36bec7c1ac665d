//! Sensor dynamics: the force channel is band-limited and late.

use super::fit::{log, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};
use std::f64::consts::FRAC_1_SQRT_2;

/// Filter of the force channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// First-order low-pass.
    #[default]
    FirstOrder,
    /// Butterworth low-pass of second order.
    Butterworth,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 2] = [Self::FirstOrder, Self::Butterworth];
}

/// Low-pass 1/(1 + sτ) or 1/(1 + √2 sτ + s²τ²) and a delay T, on `contact.force` and `force`
/// (theory eqs. 7.16, 7.17).
///
/// The cut-off (−3 dB) is 1/(2πτ) in both forms. The delay is Padé's all-pass of second order,
/// (12 − 6sT + s²T²)/(12 + 6sT + s²T²), whose phase is right within 1 % up to sT = 2. Between
/// internal steps the input is linear and the filter exact. All else that the block tells, the
/// friction coefficient included, is unfiltered; `force` is filtered at communication points.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorDynamics {
    /// Is the effect on?
    pub enabled: bool,
    /// Filter.
    pub form: Form,
    /// Time constant τ \[s\].
    pub time: f64,
    /// Delay over the time constant, T/τ \[-\].
    pub relative_delay: f64,
}

impl Default for SensorDynamics {
    fn default() -> Self {
        Self { enabled: false, form: Form::FirstOrder, time: 60e-6, relative_delay: 0.3 }
    }
}

impl SensorDynamics {
    /// Is there anything to filter?
    pub fn is_active(&self) -> bool {
        self.enabled && self.time > 0.0
    }
}

/// Memory of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Channel {
    input: f64,
    low: [f64; 2],
    late: [f64; 2],
    output: f64,
}

impl Channel {
    /// As many numbers as [`Self::numbers`] gives.
    pub const COUNT: usize = 6;

    /// Settles at a constant input.
    pub fn settle(&mut self, input: f64) {
        *self = Self { input, low: [input, 0.0], late: [input, 0.0], output: input };
    }

    /// What the sensor shows.
    pub fn output(&self) -> f64 {
        self.output
    }

    /// All numbers.
    pub fn numbers(&self) -> [f64; Self::COUNT] {
        [self.input, self.low[0], self.low[1], self.late[0], self.late[1], self.output]
    }

    /// From what [`Self::numbers`] gave.
    pub fn from_numbers(n: &[f64; Self::COUNT]) -> Self {
        Self { input: n[0], low: [n[1], n[2]], late: [n[3], n[4]], output: n[5] }
    }

    /// Follows the input to `input` over `h` \[s\]; the sensor is active.
    pub fn follow(&mut self, sensor: &SensorDynamics, h: f64, input: f64) {
        let before = self.low[0];
        if h <= 0.0 {
            return;
        }
        match sensor.form {
            Form::FirstOrder => {
                let late = sensor.time * (input - self.input) / h;
                let kept = (-h / sensor.time).exp();
                self.low[0] = input - late + (self.low[0] - self.input + late) * kept;
            }
            Form::Butterworth => {
                let corner = FRAC_1_SQRT_2 / sensor.time;
                oscillate(&mut self.low, [corner, corner], h, self.input, input);
            }
        }
        self.input = input;
        let delay = sensor.relative_delay * sensor.time;
        if delay > 0.0 {
            let poles = [3.0 / delay, 3.0_f64.sqrt() / delay];
            oscillate(&mut self.late, poles, h, before, self.low[0]);
            self.output = self.low[0] - delay * self.late[1];
        } else {
            self.output = self.low[0];
        }
    }
}

/// Moves y'' + 2a y' + (a² + b²)(y − u) = 0 over `h` \[s\] while u goes linearly from `from` to `to`;
/// `state` is y, y'. Exact.
fn oscillate(state: &mut [f64; 2], [a, b]: [f64; 2], h: f64, from: f64, to: f64) {
    let square = a * a + b * b;
    let slope = (to - from) / h;
    let lag = 2.0 * a * slope / square;
    let (x, v) = (state[0] - from + lag, state[1] - slope);
    let (sin, cos) = (b * h).sin_cos();
    let kept = (-a * h).exp();
    state[0] = to - lag + kept * (x * cos + (v + a * x) / b * sin);
    state[1] = slope + kept * (v * cos - (square * x + a * v) / b * sin);
}

const US: Option<DisplayUnit> = Some(DisplayUnit { name: "us", factor: 1e6 });
const FORMS: &[Item] = &[
    Item { name: "first_order", doc: "first-order low-pass and delay" },
    Item { name: "butterworth", doc: "second-order Butterworth low-pass and delay" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.sensor_dynamics.enabled", effect.sensor_dynamics.enabled, Fixed, "Sensor dynamics: the force outputs are band-limited and late"),
    enum_param!("effect.sensor_dynamics.form", effect.sensor_dynamics.form, Form, "SensorDynamicsForm", FORMS, Fixed, "Filter of the force channel"),
    real_param!("effect.sensor_dynamics.time", effect.sensor_dynamics.time, "s", US, 0.0, 1.0, 6e-5, Fixed, "Time constant; the cut-off is 1/(2 pi time); 0: none"),
    real_param!("effect.sensor_dynamics.relative_delay", effect.sensor_dynamics.relative_delay, "1", None, 0.0, 10.0, 0.3, Fixed, "Delay over the time constant"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "sensor_dynamics",
    module: Module::Sensor,
    forms: &[
        FitForm {
            name: "first_order",
            params: &[
                log("effect.sensor_dynamics.time", 60e-6, 1.0),
                log("effect.sensor_dynamics.relative_delay", 0.3, 1.0),
            ],
        },
        FitForm {
            name: "butterworth",
            params: &[
                log("effect.sensor_dynamics.time", 60e-6, 1.0),
                log("effect.sensor_dynamics.relative_delay", 0.3, 1.0),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Gain and phase \[rad\] at angular frequency `omega`, by correlation over 20 periods.
    fn response(sensor: &SensorDynamics, omega: f64) -> (f64, f64) {
        let h = std::f64::consts::TAU / omega / 1000.0;
        let mut channel = Channel::default();
        let (mut in_phase, mut quadrature) = (0.0, 0.0);
        for k in 1..=40_000 {
            let t = f64::from(k) * h;
            channel.follow(sensor, h, (omega * t).sin());
            if k > 20_000 {
                in_phase += channel.output() * (omega * t).sin() / 10_000.0;
                quadrature += channel.output() * (omega * t).cos() / 10_000.0;
            }
        }
        (in_phase.hypot(quadrature), quadrature.atan2(in_phase))
    }

    #[test]
    fn the_cut_off_loses_3_db_and_the_delay_only_phase() {
        // Closed forms at ωτ = 1: gain 1/√2; phase −45° (first order) or −90° (second), less ωT. The
        // linear input between 1000 points per period and Padé at ωT = 0.3 cost below 1e-4.
        for (form, phase) in [(Form::FirstOrder, -0.25), (Form::Butterworth, -0.5)] {
            let sensor = SensorDynamics { enabled: true, form, ..SensorDynamics::default() };
            let (gain, angle) = response(&sensor, 1.0 / sensor.time);
            assert!((gain - FRAC_1_SQRT_2).abs() < 1e-4, "{form:?} {gain}");
            let expected = phase * std::f64::consts::PI - 0.3;
            assert!((angle - expected).abs() < 1e-4, "{form:?} {angle} {expected}");
        }
    }

    #[test]
    fn the_step_size_does_not_matter_for_a_ramp() {
        // Exact for linear inputs: a hundred steps and one agree to rounding.
        for form in Form::ALL {
            let sensor = SensorDynamics { form, relative_delay: 0.0, ..SensorDynamics::default() };
            let (mut one, mut many) = (Channel::default(), Channel::default());
            one.follow(&sensor, 1e-4, 5.0);
            (1..=100).for_each(|k| many.follow(&sensor, 1e-6, 0.05 * f64::from(k)));
            assert!((one.output() - many.output()).abs() < 1e-10, "{form:?}");
        }
    }
}
