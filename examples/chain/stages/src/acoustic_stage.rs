//! AcousticStage.fmu: sound pressure, its spectrum and third-octave levels at a stated distance.
//!
//! The stage samples its inputs at its own rate: between two communication points it draws a line
//! through the values, a cubic where the master has also set derivatives. It looks at the past only,
//! so what it tells at the end of a step is the sound up to that step's start.

use crate::radiation::{Radiation, Surroundings};
use crate::stage::{Stage, Variable};
use crate::third_octave::{self, Band, BANDS};
use std::f64::consts::PI;

/// Lines of the spectrum, and their distance [Hz].
const LINES: usize = 100;
const SPACING: f64 = 100.0;
/// Where inputs and outputs stand in the table.
const INPUT: usize = 9;
const OUTPUT: usize = 12;

/// Inputs at a communication point: time [s], force [N], volume flow [m³/s], and their derivatives.
#[derive(Clone, Copy, Debug)]
struct Known {
    time: f64,
    value: [f64; 2],
    rate: Option<[f64; 2]>,
}

/// The sound so far.
#[derive(Clone, Debug)]
pub struct AcousticStage {
    face: f64,
    sampling: f64,
    start: f64,
    samples: u64,
    last: Option<Known>,
    radiation: Radiation,
    bands: [Band; BANDS],
    energy: f64,
    lines: [[f64; 2]; LINES],
    pressure: f64,
}

impl AcousticStage {
    /// Samples up to the communication point `now`.
    fn listen(&mut self, now: Known) {
        let from = self.last.unwrap_or(now);
        while self.next_sample() <= now.time + 1e-12 {
            let [force, flow] = between(&from, &now, self.next_sample());
            self.sample(force, flow);
        }
        self.last = Some(now);
    }

    fn next_sample(&self) -> f64 {
        self.start + self.samples as f64 / self.sampling
    }

    fn sample(&mut self, force: f64, flow: f64) {
        let pressure = self.radiation.pressure(force, flow);
        self.pressure = pressure;
        self.energy += pressure * pressure;
        self.bands.iter_mut().for_each(|band| band.take(pressure));
        let turn = 2.0 * PI * SPACING * self.samples as f64 / self.sampling;
        for (k, line) in self.lines.iter_mut().enumerate() {
            let (sin, cos) = (turn * (k + 1) as f64).sin_cos();
            line[0] += pressure * cos / self.sampling;
            line[1] -= pressure * sin / self.sampling;
        }
        self.samples += 1;
    }

    fn tell(&self, values: &mut [f64]) {
        let mean = |sum: f64| sum / self.samples.max(1) as f64;
        let values = &mut values[OUTPUT..];
        values[0] = self.pressure;
        values[1] = third_octave::level(mean(self.energy));
        for (value, band) in values[2..].iter_mut().zip(&self.bands) {
            *value = third_octave::level(mean(band.energy()));
        }
        for (value, [re, im]) in values[2 + BANDS..].iter_mut().zip(&self.lines) {
            *value = re.hypot(*im);
        }
    }
}

/// Values at `time` on the line, or cubic, from one communication point to the next.
fn between(from: &Known, to: &Known, time: f64) -> [f64; 2] {
    let h = to.time - from.time;
    if h <= 0.0 {
        return to.value;
    }
    let s = (time - from.time) / h;
    std::array::from_fn(|i| {
        let (x0, x1) = (from.value[i], to.value[i]);
        let bend = match (from.rate, to.rate) {
            // Hermite: what bends the line to the slopes at its ends.
            (Some(v0), Some(v1)) => {
                let line = (x1 - x0) / h;
                h * s * (1.0 - s) * ((v0[i] - line) * (1.0 - s) - (v1[i] - line) * s)
            }
            _ => 0.0,
        };
        x0 + s * (x1 - x0) + bend
    })
}

impl Stage for AcousticStage {
    const IDENTIFIER: &'static str = "AcousticStage";
    const DESCRIPTION: &'static str =
        "Sound of a tread block at a distance: pressure, spectrum, third-octave levels";
    const DERIVATIVES: u32 = 0;
    const TAKES_DERIVATIVES: bool = true;
    const STEP: f64 = 1e-5;

    #[rustfmt::skip]
    fn table() -> Vec<Variable> {
        let (p, o) = (Variable::parameter, Variable::output);
        let mut table = vec![
            p("distance", "m", 1.0, (0.1, 100.0), "Distance of the observer from the contact patch"),
            p("air.density", "kg/m3", 1.2, (0.1, 10.0), "Density of air"),
            p("air.sound_speed", "m/s", 343.0, (100.0, 1000.0), "Speed of sound; distance over it is the delay left out of the pressure"),
            p("belt.mass_per_area", "kg/m2", 15.0, (1.0, 100.0), "Mass of belt and tread per area"),
            p("belt.cut_on_frequency", "Hz", 100.0, (1.0, 1000.0), "Frequency of the belt on its foundation"),
            p("belt.damping_ratio", "1", 0.1, (0.001, 2.0), "Damping ratio of that motion"),
            p("block.height", "m", 0.010, (1e-3, 0.1), "Height of the block"),
            p("block.width", "m", 0.015, (1e-3, 1.0), "Width of the block"),
            p("sampling.frequency", "Hz", 96_000.0, (48_000.0, 1e6), "Rate at which the stage samples"),
            Variable::input("force.z", "N", "Force of the block on the belt, upward"),
            Variable::input("run_in.velocity.x", "m/s", "Velocity of the run-in edge relative to the clamped face, forward"),
            Variable::input("run_out.velocity.x", "m/s", "Velocity of the run-out edge relative to the clamped face, forward"),
            o("pressure", "Pa", "Sound pressure in retarded time"),
            o("level", "dB", "Equivalent level since the start, re 20 uPa"),
        ];
        table.extend((0..BANDS).map(|i| o(
            &format!("third_octave.level[{}]", i + 1), "dB",
            &format!("Equivalent level since the start in the band around {:.0} Hz, re 20 uPa", third_octave::middle(i)))));
        table.extend((1..=LINES).map(|k| o(
            &format!("spectrum.pressure[{k}]"), "Pa.s",
            &format!("Magnitude of the Fourier transform of the pressure since the start at {} Hz", k as f64 * SPACING))));
        table
    }

    fn start(values: &mut [f64], time: f64) -> Result<Self, String> {
        let [distance, air_density, _, belt_mass, cut_on, damping, height, width, sampling] =
            std::array::from_fn(|i| values[i]);
        let around = Surroundings { distance, air_density, belt_mass, cut_on, damping };
        let stage = Self {
            face: height * width,
            sampling,
            start: time,
            samples: 0,
            last: None,
            radiation: Radiation::new(around, sampling),
            bands: std::array::from_fn(|i| Band::new(i, sampling)),
            energy: 0.0,
            lines: [[0.0; 2]; LINES],
            pressure: 0.0,
        };
        stage.tell(values);
        Ok(stage)
    }

    fn step(
        &mut self,
        values: &mut [f64],
        rates: &[Option<f64>],
        time: f64,
        _h: f64,
    ) -> Result<(), String> {
        let both = |x: &[f64]| [x[0], 0.5 * self.face * (x[2] - x[1])];
        let given: Option<Vec<f64>> = rates[INPUT..INPUT + 3].iter().copied().collect();
        let value = both(&values[INPUT..INPUT + 3]);
        let rate = given.map(|rates| both(&rates));
        self.listen(Known { time, value, rate });
        self.tell(values);
        Ok(())
    }
}
