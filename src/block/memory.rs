//! What the effects remember while the block moves.

use super::signals::Outputs;
use crate::contact::{Face, FrictionLaw};
use crate::dynamics::{Linear, Stage, State};
use crate::effects::sensor_dynamics::Channel;
use crate::effects::Effects;
use crate::params::Params;

/// Memory of the effects that have one; part of the block's state.
#[derive(Clone, Debug, PartialEq)]
pub struct Memory {
    /// Flash temperature rise per contact node \[K\].
    rise: Vec<f64>,
    /// Age per contact node, see [`crate::effects::friction_ageing`].
    age: Vec<f64>,
    /// Pressure at which the friction coefficients hold \[Pa\].
    pressure: f64,
    /// Amplitude of strain \[-\].
    amplitude: f64,
    /// Mean shear of the block per modal coordinate: tangential displacement of the face over the
    /// height.
    shear: Vec<f64>,
    /// Force channels: contact x and z, belt x and z.
    channels: [Channel; 4],
}

impl Memory {
    /// The memory of a block at rest that has just been pressed on the road.
    pub fn new(params: &Params, linear: &Linear, area: &[f64]) -> Self {
        let nodes = linear.nodes;
        let per_area = 1.0 / (area.iter().sum::<f64>() * params.block.height);
        let shear = linear.by_mode.chunks_exact(2 * linear.stride).map(|mode| {
            per_area * mode.iter().zip(&area[..nodes]).map(|(phi, a)| phi * a).sum::<f64>()
        });
        Self {
            rise: vec![0.0; nodes],
            age: vec![0.0; nodes],
            pressure: params.friction.reference_pressure,
            amplitude: 0.0,
            shear: shear.collect(),
            channels: [Channel::default(); 4],
        }
    }

    /// Forgets everything; the contact then has the age that the parameters give it.
    pub fn reset(&mut self, effects: &Effects, state: &mut State) {
        self.rise.fill(0.0);
        self.age.fill(0.0);
        self.amplitude = 0.0;
        self.channels = [Channel::default(); 4];
        self.rest(effects, effects.friction_ageing.initial_age, state);
    }

    /// Lets the block rest for `duration` \[s\].
    pub fn rest(&mut self, effects: &Effects, duration: f64, state: &mut State) {
        effects.thermal_friction.rest(duration, &mut self.rise);
        effects.friction_ageing.rest(duration, &mut self.age);
        self.set_friction(effects, state);
    }

    /// Follows an internal step of `h` \[s\] and sets what acts on the next one.
    pub fn after_step(
        &mut self,
        effects: &Effects,
        linear: &Linear,
        face: &Face,
        h: f64,
        stage: &Stage,
        state: &mut State,
    ) {
        let traction = &stage.traction;
        let (thermal, ageing) = (&effects.thermal_friction, &effects.friction_ageing);
        if thermal.enabled {
            thermal.warm(h, &stage.placed.slip, &traction.tangential, &face.area, &mut self.rise);
        }
        if ageing.enabled {
            ageing.age(h, &stage.placed.slip, &mut self.age);
        }
        self.set_friction(effects, state);
        if ageing.is_added() {
            let slip = self.age.iter().zip(&stage.placed.slip).zip(&mut state.friction_factor);
            for ((age, v), factor) in slip {
                let level = face.friction.level(self.pressure, *v, face.smoothing_speed);
                *factor *= ageing.added(*age, level);
            }
        }
        if effects.payne_softening.enabled {
            self.soften(effects, linear, h, state);
        }
        let sensor = &effects.sensor_dynamics;
        if sensor.is_active() {
            let sums = [&traction.tangential, &traction.normal].map(|f| f.iter().sum::<f64>());
            for (channel, force) in self.channels.iter_mut().zip(sums) {
                channel.follow(sensor, h, force);
            }
        }
    }

    /// The force channels have shown the same for long.
    pub fn settle_sensor(&mut self, outputs: &Outputs) {
        let inputs = outputs.contact_force.iter().chain(&outputs.force);
        self.channels.iter_mut().zip(inputs).for_each(|(c, force)| c.settle(*force));
    }

    /// Follows the force on the belt over a communication step of `h` \[s\].
    pub fn follow_belt(&mut self, effects: &Effects, h: f64, outputs: &Outputs) {
        if effects.sensor_dynamics.is_active() {
            for (channel, force) in self.channels[2..].iter_mut().zip(outputs.force) {
                channel.follow(&effects.sensor_dynamics, h, force);
            }
        }
    }

    /// Replaces the forces by what the sensor shows.
    pub fn show(&self, effects: &Effects, outputs: &mut Outputs) {
        if effects.sensor_dynamics.is_active() {
            let shown = self.channels.map(|c| c.output());
            outputs.contact_force = [shown[0], shown[1]];
            outputs.force = [shown[2], shown[3]];
        }
    }

    /// All numbers in a fixed order.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.push(self.amplitude);
        out.extend(self.rise.iter().chain(&self.age));
        self.channels.iter().for_each(|c| out.extend(c.numbers()));
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None` if there is too little.
    pub fn restore<'a>(&mut self, from: &'a [f64]) -> Option<&'a [f64]> {
        let nodes = self.rise.len();
        let (amplitude, from) = from.split_first()?;
        let (rise, from) = from.split_at_checked(nodes)?;
        let (age, mut from) = from.split_at_checked(nodes)?;
        for channel in &mut self.channels {
            let (numbers, rest) = from.split_first_chunk()?;
            (*channel, from) = (Channel::from_numbers(numbers), rest);
        }
        self.amplitude = *amplitude;
        self.rise.copy_from_slice(rise);
        self.age.copy_from_slice(age);
        Some(from)
    }

    /// Factors on friction from temperature and age.
    fn set_friction(&self, effects: &Effects, state: &mut State) {
        let (thermal, ageing) = (&effects.thermal_friction, &effects.friction_ageing);
        if !thermal.enabled && !ageing.enabled {
            return;
        }
        for ((factor, rise), age) in state.friction_factor.iter_mut().zip(&self.rise).zip(&self.age)
        {
            let warm = if thermal.enabled { thermal.factor(*rise) } else { 1.0 };
            let old = if ageing.enabled { ageing.factor(*age).max(0.0) } else { 1.0 };
            *factor = warm * old;
        }
    }

    /// Stiffness factor from the shear; the accelerations follow, so that the next step starts
    /// from them.
    fn soften(&mut self, effects: &Effects, linear: &Linear, h: f64, state: &mut State) {
        let strain = self.shear.iter().zip(&state.z).map(|(s, z)| s * z).sum::<f64>().abs();
        let payne = &effects.payne_softening;
        self.amplitude = payne.follow(h, strain, self.amplitude);
        let factor = payne.update(self.amplitude, state.stiffness_factor);
        let change = factor - state.stiffness_factor;
        if change != 0.0 {
            for ((dw, omega2), z) in state.dw.iter_mut().zip(&linear.omega2).zip(&state.z) {
                *dw -= change * omega2 * z;
            }
            state.stiffness_factor = factor;
        }
    }
}
