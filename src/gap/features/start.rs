//! How a run begins: the waveform of the first milliseconds, the first snap-outs, and the free block that was struck.

use super::{rms, Aspect, Cutter};
use crate::gap::campaign::{CHANNEL_COUNT, DISPLACEMENT, VELOCITY};

/// Samples averaged in the onset.
const BIN: usize = 4;
/// Bins of the onset of fast runs; 2.88 ms at 25 kHz.
const BINS: usize = 18;
/// Travel of the road \[m\] that the onset of slow runs covers: the first snap-out comes before.
pub const TRAVEL: f64 = 0.5e-3;
/// Snap-outs looked at.
const SNAPS: usize = 2;
/// Share of its travel that the edge must fall back to have snapped.
const SNAP_SHARE: f64 = 0.2;
/// Samples of the ring-down that are compared one by one.
const RING_SAMPLES: usize = 100;

impl Cutter<'_> {
    /// Bins of the onset of this run.
    fn bins(&self) -> usize {
        let travel = TRAVEL / self.spec.road_speed_m_s.abs().max(1e-3);
        BINS.max((travel / (self.step * BIN as f64)) as usize).min(2 * BINS)
    }

    /// The free block, sample by sample.
    pub(super) fn ringdown(&mut self) {
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

    /// The waveform of the start, averaged over short bins.
    pub(super) fn onset(&mut self) {
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
    pub(super) fn snap(&mut self) {
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
}
