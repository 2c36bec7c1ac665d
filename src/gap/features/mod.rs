//! The data vector: what of a run is compared, phase by phase, so that a small error of the frequency
//! does not hide everything else (the book, gap.md).

mod settled;
mod start;

pub use start::TRAVEL;

use super::campaign::{Plan, Record, RunKind, RunSpec};

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

impl Key {
    /// What a cell has in common, channel, aspect and part: the errors of its features are correlated.
    pub(super) const fn cell(&self) -> (usize, Aspect, usize) {
        (self.channel, self.aspect, self.part)
    }
}

/// A feature of a measurement: value, noise and size against which errors of the model are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// What it belongs to.
    pub key: Key,
    /// Value, in the unit of its channel and aspect; so are the three below.
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
    /// Distance of the samples \[s\].
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
    cutter.settled();
    cutter.out
}

impl Cutter<'_> {
    /// Standard deviation of a channel's noise, in its unit.
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
}

/// Root mean square of `values[from..to]` about `centre`.
fn rms(values: &[f64], centre: f64, from: usize, to: usize) -> f64 {
    let squares: f64 = values[from..to].iter().map(|v| (v - centre) * (v - centre)).sum();
    (squares / (to - from).max(1) as f64).sqrt()
}
