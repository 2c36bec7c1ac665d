//! What a run settles to, part by part: means, frequency, the cycle by its harmonics, what lies beside them, stick and
//! slip.

use super::{rms, Aspect, Cutter};
use crate::gap::campaign::{CHANNEL_COUNT, FRICTION, NORMAL, VELOCITY};
use crate::gap::simulate::road_speed;
use crate::gap::spectrum::{amplitude, fundamental, hann, mean, power, Complex};

/// Samples of the start, which is looked at on its own.
const FIRST: usize = 40;
/// Samples from which a run is long enough for its settled part.
const LONG: usize = 200;
/// Samples of a part, about.
const PART: usize = 180;
/// Harmonics compared per channel.
const HARMONICS: [usize; CHANNEL_COUNT] = [4, 3, 4, 2, 1];
/// Speed of the soft stick indicator \[m/s\].
const STICK_SPEED: f64 = 0.03;

impl Cutter<'_> {
    /// After the start, in parts of about 7 ms; a record that ends sooner has none.
    pub(super) fn settled(&mut self) {
        let (first, last) = (FIRST, self.record.time.len());
        if last < LONG {
            return;
        }
        let parts = ((last - first) / PART).max(1);
        let length = (last - first) / parts;
        for part in 0..parts {
            self.part(part, first + part * length, first + (part + 1) * length);
        }
    }

    /// Samples `from..to`: the frequency of the leading channel, then every channel in its phase.
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

    /// Mean, harmonics of `f0` \[Hz\] turned by the leading channel's `phase` \[rad\], and powers beside them;
    /// `spread` is what the weights make of white noise.
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

    /// Share of soft sticking, and slip speeds that are exceeded in 90, 50 and 10 % of the samples.
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

/// z·exp(i·angle).
fn turned([re, im]: Complex, angle: f64) -> Complex {
    let (sin, cos) = angle.sin_cos();
    [re * cos - im * sin, re * sin + im * cos]
}
