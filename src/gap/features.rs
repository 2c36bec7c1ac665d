//! The data vector: what of a run is compared, phase by phase, so that a small error of the frequency
//! does not hide everything else (the book, gap.md).

use super::campaign::{
    Plan, Record, RunKind, RunSpec, CHANNEL_COUNT, DISPLACEMENT, FRICTION, NORMAL, VELOCITY,
};
use super::simulate::road_speed;
use super::spectrum::{amplitude, fundamental, hann, mean, power, Complex};

/// Samples averaged in the onset.
const BIN: usize = 4;
/// Bins of the onset of fast runs; 2.88 ms at 25 kHz.
const BINS: usize = 18;
/// Travel of the road \[m\] that the onset of slow runs covers: the first snap-out comes before.
pub const TRAVEL: f64 = 0.5e-3;
/// Samples from which a run is long enough for its settled part.
const LONG: usize = 200;
/// Snap-outs looked at.
const SNAPS: usize = 2;
/// Share of its travel that the edge must fall back to have snapped.
const SNAP_SHARE: f64 = 0.2;
/// Samples of a part, about.
const PART: usize = 180;
/// Samples of the ring-down that are compared one by one.
const RING_SAMPLES: usize = 100;
/// Harmonics compared per channel.
const HARMONICS: [usize; CHANNEL_COUNT] = [4, 3, 4, 2, 1];
/// Speed of the soft stick indicator \[m/s\].
const STICK_SPEED: f64 = 0.03;

/// Which kind of quantity a feature is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Aspect {
    /// Waveform of the first milliseconds.
    Onset,
    /// First snap-out of the edge: when, from where, to where.
    Snap,
    /// Mean over a part of the run.
    Mean,
    /// Logarithm of the stick-slip frequency.
    Frequency,
    /// Waveform of the cycle, by its harmonics.
    Cycle,
    /// Power beside the harmonics and below the fundamental.
    Broadband,
    /// Stick fraction and peak slip.
    Stick,
    /// Waveform of the free block.
    Ringdown,
}

impl Aspect {
    /// All, in order.
    pub const ALL: [Self; 8] = [
        Self::Onset,
        Self::Snap,
        Self::Mean,
        Self::Frequency,
        Self::Cycle,
        Self::Broadband,
        Self::Stick,
        Self::Ringdown,
    ];

    /// Contact phase in the results.
    pub const fn phase(self) -> &'static str {
        match self {
            Self::Onset => "onset",
            Self::Snap => "snap-out",
            Self::Mean => "settled mean",
            Self::Frequency => "settled frequency",
            Self::Cycle => "settled cycle",
            Self::Broadband => "settled broadband",
            Self::Stick => "stick and slip",
            Self::Ringdown => "ring-down",
        }
    }
}

/// What a feature belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Index of the run.
    pub run: usize,
    /// Index of the channel.
    pub channel: usize,
    /// Kind.
    pub aspect: Aspect,
    /// Part of the run, from 0.
    pub part: usize,
}

/// A feature of a measurement: value, noise and size against which errors of the model are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// What it belongs to.
    pub key: Key,
    /// Value.
    pub value: f64,
    /// Standard deviation from the noise of the channel.
    pub noise: f64,
    /// Size against which errors are judged before they are measured; grows where phases drift.
    pub scale: f64,
    /// Size of the quantity itself.
    pub size: f64,
}

/// A record, cut into what is compared.
struct Cutter<'a> {
    plan: &'a Plan,
    spec: &'a RunSpec,
    record: &'a Record,
    run: usize,
    step: f64,
    out: Vec<Feature>,
}

/// Features of a run; channels of which `record` has none give none.
pub fn of_run(plan: &Plan, spec: &RunSpec, run: usize, record: &Record) -> Vec<Feature> {
    let step = 1.0 / plan.sampling_rate;
    let mut cutter = Cutter { plan, spec, record, run, step, out: Vec::with_capacity(256) };
    if spec.kind == RunKind::Ringdown {
        cutter.ringdown();
        return cutter.out;
    }
    cutter.onset();
    cutter.snap();
    // After the start, in parts of about 7 ms; a short record is one part.
    let (first, last) = (40, record.time.len());
    if last >= LONG {
        let parts = ((last - first) / PART).max(1);
        let length = (last - first) / parts;
        for part in 0..parts {
            cutter.part(part, first + part * length, first + (part + 1) * length);
        }
    }
    cutter.out
}

impl Cutter<'_> {
    fn noise(&self, channel: usize) -> f64 {
        self.plan.noise[channel].unwrap_or(0.0)
    }

    fn push(
        &mut self,
        channel: usize,
        aspect: Aspect,
        part: usize,
        [value, noise, scale]: [f64; 3],
    ) {
        let key = Key { run: self.run, channel, aspect, part };
        self.out.push(Feature { key, value, noise, scale, size: scale });
    }

    /// Bins of the onset of this run.
    fn bins(&self) -> usize {
        let travel = TRAVEL / self.spec.road_speed_m_s.abs().max(1e-3);
        BINS.max((travel / (self.step * BIN as f64)) as usize).min(2 * BINS)
    }

    fn ringdown(&mut self) {
        for channel in [VELOCITY, DISPLACEMENT] {
            let Some(values) = self.record.channel[channel].as_ref() else { continue };
            let size = rms(values, 0.0, 0, values.len().min(RING_SAMPLES));
            let noise = self.noise(channel);
            // The first sample is the blow itself, the same for every model.
            for (i, value) in values.iter().enumerate().take(RING_SAMPLES).skip(1) {
                self.push(channel, Aspect::Ringdown, i / 25, [*value, noise, size]);
            }
        }
    }

    fn onset(&mut self) {
        for channel in 0..CHANNEL_COUNT {
            let Some(values) = self.record.channel[channel].as_ref() else { continue };
            let count = values.len();
            let bins = self.bins();
            let first = count.min(BIN * bins);
            let centre = values[..first].iter().sum::<f64>() / first as f64;
            let size = rms(values, centre, 0, first);
            let noise = self.noise(channel) / (BIN as f64).sqrt();
            for bin in 0..bins.min(count / BIN) {
                let piece = &values[bin * BIN..(bin + 1) * BIN];
                let value = piece.iter().sum::<f64>() / BIN as f64;
                // An error of the frequency adds up to an error of the phase.
                let late = (bin as f64 + 0.5) * BIN as f64 * self.step / 1e-3;
                let late = size * (1.0 + late * late).sqrt();
                self.push(channel, Aspect::Onset, bin / 4, [value, noise, late]);
                if let Some(feature) = self.out.last_mut() {
                    feature.size = size;
                }
            }
        }
    }

    /// The edge is dragged along until it snaps back: time, place and depth follow the parameters
    /// smoothly where the waveform only says that it is somewhere else.
    fn snap(&mut self) {
        let Some(x) = self.record.channel[DISPLACEMENT].as_ref() else { return };
        let direction = self.spec.road_speed_m_s.signum();
        let end = x.len().min(BIN * self.bins());
        let travel = |i: usize| direction * (x[i] - x[0]);
        let mut from = 0;
        for part in 0..SNAPS {
            let low = travel(from);
            let (mut top, mut at) = (low, from);
            for i in from..end {
                if travel(i) > top {
                    (top, at) = (travel(i), i);
                } else if top - travel(i) > SNAP_SHARE * top && at > from + 4 {
                    break;
                }
            }
            let last = end.min(at + 10);
            let bottom = (at..last).min_by(|a, b| travel(*a).total_cmp(&travel(*b))).unwrap_or(at);
            let time = (at.max(1) as f64 * self.step).ln();
            let depth = travel(bottom) / top.max(1e-9);
            self.push(DISPLACEMENT, Aspect::Snap, part, [time, 0.0, 1.0]);
            self.push(DISPLACEMENT, Aspect::Snap, part, [top.max(1e-9).ln(), 0.0, 1.0]);
            self.push(DISPLACEMENT, Aspect::Snap, part, [depth, 0.0, 3.0]);
            from = bottom.min(end - 1);
        }
    }

    fn part(&mut self, part: usize, from: usize, to: usize) {
        let record = self.record;
        let weights = hann(to - from);
        let spread = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let piece = |c: usize| record.channel[c].as_ref().map(|v| &v[from..to]);
        let Some((lead, leading)) =
            [VELOCITY, FRICTION, NORMAL].into_iter().find_map(|c| piece(c).map(|p| (c, p)))
        else {
            return;
        };
        let f0 = fundamental(leading, &weights, self.step);
        let offset = mean(leading, &weights);
        let first = amplitude(leading, &weights, offset, self.step, f0);
        let phase = first[1].atan2(first[0]);
        let clear = power(first).sqrt();
        let blur = 2.0 * self.noise(lead) * spread / clear.max(1e-12);
        let bin = 1.0 / ((to - from) as f64 * self.step);
        self.push(lead, Aspect::Frequency, part, [f0.ln(), 0.3 * blur * bin / f0, 1.0]);
        for channel in 0..CHANNEL_COUNT {
            if let Some(values) = piece(channel) {
                self.channel(part, channel, values, &weights, (f0, phase, spread));
            }
        }
        self.stick(part, from, to, &weights);
    }

    fn channel(
        &mut self,
        part: usize,
        channel: usize,
        values: &[f64],
        weights: &[f64],
        (f0, phase, spread): (f64, f64, f64),
    ) {
        let noise = self.noise(channel);
        let offset = mean(values, weights);
        let size = rms(values, offset, 0, values.len());
        let blur = noise * spread;
        self.push(channel, Aspect::Mean, part, [offset, blur, size.max(0.2 * offset.abs())]);
        let mut periodic = 0.0;
        for k in 1..=HARMONICS[channel] {
            let z = amplitude(values, weights, offset, self.step, k as f64 * f0);
            periodic += 0.5 * power(z);
            let [re, im] = turned(z, -(k as f64) * phase);
            self.push(channel, Aspect::Cycle, part, [re, 2.0 * blur, size]);
            if !(channel == VELOCITY && k == 1) {
                self.push(channel, Aspect::Cycle, part, [im, 2.0 * blur, size]);
            }
        }
        // Logarithms of powers, lifted so that noise alone does not make them jump.
        let lift = (0.03 * size).powi(2) + noise * noise;
        let total: f64 =
            values.iter().zip(weights).map(|(v, w)| w * (v - offset) * (v - offset)).sum();
        let rest = (total - periodic).max(0.0);
        let wobble = noise * noise * 2.0 / (values.len() as f64).sqrt() / (rest + lift);
        self.push(channel, Aspect::Broadband, part, [(rest + lift).ln(), wobble, 1.0]);
        let bin = 1.0 / (values.len() as f64 * self.step);
        let steps = (0.6 * f0 / bin) as usize;
        let low: f64 = (1..=steps.min(12))
            .map(|k| 0.5 * power(amplitude(values, weights, offset, self.step, k as f64 * bin)))
            .sum();
        let wobble = 4.0 * blur * (low + lift).sqrt() / (low + lift);
        self.push(channel, Aspect::Broadband, part, [(low + lift).ln(), wobble, 1.0]);
    }

    fn stick(&mut self, part: usize, from: usize, to: usize, weights: &[f64]) {
        let Some(velocity) = self.record.channel[VELOCITY].as_ref() else { return };
        let slip: Vec<f64> = (from..to)
            .map(|i| road_speed(self.plan, self.spec, self.record.time[i]) - velocity[i])
            .collect();
        let stuck = |v: f64| 1.0 / (1.0 + (v / STICK_SPEED).powi(2));
        let share = slip.iter().zip(weights).map(|(v, w)| w * stuck(*v)).sum::<f64>();
        let noise = self.noise(VELOCITY);
        self.push(VELOCITY, Aspect::Stick, part, [share, 0.5 * noise / STICK_SPEED * 0.1, 1.0]);
        let mut sorted = slip;
        sorted.sort_by(f64::total_cmp);
        let high = |q: f64| sorted[((sorted.len() - 1) as f64 * q) as usize];
        let size = rms(velocity, 0.0, from, to);
        for q in [0.1, 0.5, 0.9] {
            self.push(VELOCITY, Aspect::Stick, part, [high(q), noise, size]);
        }
    }
}

fn turned([re, im]: Complex, angle: f64) -> Complex {
    let (sin, cos) = angle.sin_cos();
    [re * cos - im * sin, re * sin + im * cos]
}

fn rms(values: &[f64], centre: f64, from: usize, to: usize) -> f64 {
    let squares: f64 = values[from..to].iter().map(|v| (v - centre) * (v - centre)).sum();
    (squares / (to - from).max(1) as f64).sqrt()
}
