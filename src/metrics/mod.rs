//! What a sliding run amounts to: stick-slip frequency, amplitude, mean friction, stick fraction.

mod frequency;
mod median;
mod settle;

pub use frequency::{frequency, Periodicity};
pub use median::median;
pub use settle::settled_from;

/// Traces of a sliding run at rising times; all of the same length.
#[derive(Clone, Copy, Debug)]
pub struct Trace<'a> {
    /// Time \[s\].
    pub time: &'a [f64],
    /// Tangential displacement of the run-in edge \[m\].
    pub displacement: &'a [f64],
    /// Its velocity \[m/s\].
    pub velocity: &'a [f64],
    /// Friction coefficient of the whole contact \[-\].
    pub friction: &'a [f64],
    /// Share of the contact area that sticks \[-\].
    pub stick: &'a [f64],
}

/// Owned traces, filled row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorder {
    time: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    friction: Vec<f64>,
    stick: Vec<f64>,
}

impl Recorder {
    /// Appends one row of a run.
    pub fn push(&mut self, time: f64, outputs: &crate::block::Outputs) {
        self.time.push(time);
        self.displacement.push(outputs.run_in_displacement[0]);
        self.velocity.push(outputs.run_in_velocity[0]);
        self.friction.push(outputs.friction_coefficient);
        self.stick.push(outputs.stick_fraction);
    }

    /// The traces.
    pub fn trace(&self) -> Trace<'_> {
        Trace {
            time: &self.time,
            displacement: &self.displacement,
            velocity: &self.velocity,
            friction: &self.friction,
            stick: &self.stick,
        }
    }
}

/// Stick-slip of the settled part of a sliding run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickSlip {
    /// Time from which the vibration is settled \[s\].
    pub settled_from: f64,
    /// Frequency \[Hz\]; 0 where the block is silent or too few periods are seen.
    pub frequency: f64,
    /// How alike one period is to the next: the correlation at a lag of one period \[-\].
    pub regularity: f64,
    /// Peak-to-peak displacement of the run-in edge \[m\].
    pub displacement_amplitude: f64,
    /// Peak-to-peak velocity of the run-in edge \[m/s\].
    pub velocity_amplitude: f64,
    /// Time mean of the friction coefficient \[-\].
    pub mean_friction: f64,
    /// Time mean of the share of the contact area that sticks \[-\].
    pub stick_fraction: f64,
}

/// Share of the sliding speed below which a peak-to-peak velocity counts as silence: well above what
/// a settled solver leaves and well below any stick-slip, whose velocity swings by more than 1.
const SILENCE: f64 = 0.05;

/// Metrics of a sliding run at road speed `speed` \[m/s\]; all zero for fewer than 16 samples.
pub fn stick_slip(trace: &Trace, speed: f64) -> StickSlip {
    if trace.time.len() < 16 {
        return StickSlip {
            settled_from: 0.0,
            frequency: 0.0,
            regularity: 0.0,
            displacement_amplitude: 0.0,
            velocity_amplitude: 0.0,
            mean_friction: 0.0,
            stick_fraction: 0.0,
        };
    }
    let from = settled_from(trace.velocity);
    let time = &trace.time[from..];
    let velocity_amplitude = peak_to_peak(&trace.velocity[from..]);
    let silent = velocity_amplitude <= SILENCE * speed.abs();
    let period = if silent { None } else { frequency(time, &trace.velocity[from..]) };
    // Means over whole periods: a part of a period at the end would shift them.
    let to = period.map_or(time.len(), |p| whole_periods(time, 1.0 / p.frequency));
    let mean = |values: &[f64]| time_mean(&time[..to], &values[from..][..to]);
    StickSlip {
        settled_from: time[0],
        frequency: period.map_or(0.0, |p| p.frequency),
        regularity: period.map_or(0.0, |p| p.regularity),
        displacement_amplitude: peak_to_peak(&trace.displacement[from..]),
        velocity_amplitude,
        mean_friction: mean(trace.friction),
        stick_fraction: mean(trace.stick),
    }
}

/// Largest minus smallest value.
pub fn peak_to_peak(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    (high - low).max(0.0)
}

/// Mean over time by the trapezoidal rule, for samples that need not be equidistant.
pub fn time_mean(time: &[f64], values: &[f64]) -> f64 {
    let span = time.last().zip(time.first()).map_or(0.0, |(b, a)| b - a);
    if span <= 0.0 {
        return values.first().copied().unwrap_or(0.0);
    }
    let area: f64 = time
        .windows(2)
        .zip(values.windows(2))
        .map(|(t, v)| 0.5 * (t[1] - t[0]) * (v[0] + v[1]))
        .sum();
    area / span
}

/// Number of samples that the most whole periods take.
fn whole_periods(time: &[f64], period: f64) -> usize {
    let span = time[time.len() - 1] - time[0];
    let whole = (span / period).floor() * period;
    if whole <= 0.0 {
        return time.len();
    }
    time.partition_point(|t| *t <= time[0] + whole + 1e-12)
}

#[cfg(test)]
mod tests;
