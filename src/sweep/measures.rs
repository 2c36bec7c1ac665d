//! What a point of a sweep amounts to: a few numbers per run, the same from library and FMU.

use crate::block::Outputs;
use crate::metrics::{self, stick_slip, Trace};
use crate::scenario::{config::Config, Scenario};

/// Outputs that the measures need at every communication point; `time` comes before them.
pub const OUTPUT_NAMES: [&str; 5] = [
    "run_in.displacement.x",
    "run_in.velocity.x",
    "contact.friction_coefficient",
    "contact.stick_fraction",
    "wear.mass",
];

/// Columns of the measures: name with its SI unit.
pub const COLUMNS: [&str; 9] = [
    "frequency_hz",
    "regularity_1",
    "displacement_p2p_m",
    "velocity_p2p_m_s",
    "mean_friction_1",
    "largest_friction_1",
    "stick_fraction_1",
    "settled_from_s",
    "wear_mass_kg",
];

/// Traces of [`OUTPUT_NAMES`] over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traces {
    /// Time \[s\].
    pub time: Vec<f64>,
    /// One per name.
    pub outputs: [Vec<f64>; OUTPUT_NAMES.len()],
}

impl Traces {
    /// Appends a row.
    pub fn push(&mut self, time: f64, outputs: &Outputs) {
        self.time.push(time);
        let row = [
            outputs.run_in_displacement[0],
            outputs.run_in_velocity[0],
            outputs.friction_coefficient,
            outputs.stick_fraction,
            outputs.wear_mass,
        ];
        self.outputs.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }

    /// The numbers of [`COLUMNS`]. A rolling run has no steady state: no frequency and no means, and
    /// its swings are those of the whole passage.
    pub fn measures(&self, config: &Config) -> [f64; COLUMNS.len()] {
        let [displacement, velocity, friction, stick, wear] = &self.outputs;
        let largest = friction.iter().fold(0.0, |most: f64, mu| most.max(mu.abs()));
        let worn = wear.last().copied().unwrap_or(0.0);
        let swing = metrics::peak_to_peak;
        match &config.scenario {
            Scenario::Slide(slide) => {
                let time = &self.time;
                let trace = Trace { time, displacement, velocity, friction, stick };
                let m = stick_slip(&trace, slide.speed);
                let [x, v] = [m.displacement_amplitude, m.velocity_amplitude];
                let [mu, stuck] = [m.mean_friction, m.stick_fraction];
                [m.frequency, m.regularity, x, v, mu, largest, stuck, m.settled_from, worn]
            }
            Scenario::Roll(_) => {
                let stuck = metrics::time_mean(&self.time, stick);
                let [x, v] = [swing(displacement), swing(velocity)];
                [0.0, 0.0, x, v, f64::NAN, largest, stuck, f64::NAN, worn]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::OUTPUTS;

    #[test]
    fn traces_are_the_outputs_of_their_names() {
        let outputs = Outputs {
            run_in_displacement: [1.0, 0.0],
            run_in_velocity: [2.0, 0.0],
            friction_coefficient: 3.0,
            stick_fraction: 4.0,
            wear_mass: 5.0,
            ..Outputs::default()
        };
        let mut traces = Traces::default();
        traces.push(0.0, &outputs);
        for (name, trace) in OUTPUT_NAMES.iter().zip(&traces.outputs) {
            let spec = OUTPUTS.iter().find(|spec| spec.name == *name).unwrap();
            assert_eq!((spec.get)(&outputs, 0), trace[0], "{name}");
        }
    }
}
