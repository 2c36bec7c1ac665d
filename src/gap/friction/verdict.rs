//! Which law explains a record: all of them fitted on the same pieces, weighed by what they leave on the others.

use super::design::design;
use super::fit::{best, Fitted};
use super::law::Law;
use super::record::{FrictionRecord, Sample};

/// Independent comparisons per held-out piece: samples of one stroke err together, its quarters do not.
const NATS_PER_PIECE: f64 = 4.0;
/// Pieces into which a record without strokes is cut, each side of the step.
const PIECES: usize = 8;
/// Share of the variance that a law may leave and still be called adequate, where repeated strokes say
/// nothing of the noise.
const ADEQUATE: f64 = 0.1;

/// What a record says.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// All laws, the most probable first.
    pub laws: Vec<Fitted>,
    /// Standard deviation of the noise from second differences of the samples, in the record's unit.
    pub noise: f64,
    /// Does the best law leave more than it should?
    pub remainder: bool,
    /// Error of the best law by quarter of a stroke, from its beginning, in the record's unit.
    pub quarters: [f64; 4],
}

/// Fits all laws to a record.
pub fn explain(record: &FrictionRecord) -> Verdict {
    let pieces = pieces(record);
    let count = pieces.iter().copied().max().unwrap_or(0) + 1;
    let noise = noise(record);
    let mut laws: Vec<Fitted> =
        Law::ALL.iter().filter_map(|law| best(record, *law, &pieces)).collect();
    let judged = (count / 2).max(1) as f64;
    let nats: Vec<f64> = laws
        .iter()
        .map(|l| {
            let free = l.coefficients.len() as f64 + f64::from(u8::from(l.memory.is_some()));
            let square = l.held_out.powi(2) + noise * noise;
            -0.5 * NATS_PER_PIECE * judged * square.ln() - 0.5 * free
        })
        .collect();
    let highest = nats.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = nats.iter().map(|n| (n - highest).exp()).sum();
    let before = laws.iter().find(|l| l.law == Law::Speed).map_or(0.0, |l| l.held_out);
    let open = (before * before - noise * noise).max(1e-300);
    for (law, n) in laws.iter_mut().zip(&nats) {
        law.probability = (n - highest).exp() / total;
        law.closed = ((before.powi(2) - law.held_out.powi(2)) / open).clamp(-1.0, 1.0);
    }
    laws.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let spread = deviation(&record.samples.iter().map(|s| s.value).collect::<Vec<_>>());
    let remainder = laws.first().is_some_and(|l| {
        l.held_out > 3.0 * noise
            && l.held_out.powi(2) > ADEQUATE * spread.powi(2).min(before.powi(2))
    });
    let quarters = laws.first().map_or([0.0; 4], |l| by_quarter(record, l));
    Verdict { laws, noise, remainder, quarters }
}

/// Strokes, or pieces of equal length on each side of the step; even ones are fitted, odd ones judged.
fn pieces(record: &FrictionRecord) -> Vec<usize> {
    let samples = &record.samples;
    let strokes = record.last_stroke() + 1;
    if record.piston && strokes >= 4 {
        // Out and back belong together: two strokes fitted, two judged.
        return samples.iter().map(|s| s.stroke / 2).collect();
    }
    let piece = |(i, sample): (usize, &Sample)| {
        let first = samples.partition_point(|s| s.stroke < sample.stroke);
        let last = samples.partition_point(|s| s.stroke <= sample.stroke);
        // After a change things happen at once: pieces of equal share of the logarithm.
        let at = ((i - first) as f64 + 1.0).ln() / ((last - first) as f64 + 1.0).ln();
        2 * PIECES * sample.stroke + (at * (2 * PIECES) as f64) as usize % (2 * PIECES)
    };
    samples.iter().enumerate().map(piece).collect()
}

/// Standard deviation of the noise, in the record's unit.
fn noise(record: &FrictionRecord) -> f64 {
    // Second differences: blind to slow changes; variance 6σ².
    let square = |w: &[Sample]| (w[2].value - 2.0 * w[1].value + w[0].value).powi(2) / 6.0;
    let mut squares: Vec<f64> = record.samples.windows(3).map(square).collect();
    squares.sort_by(f64::total_cmp);
    // Median of χ² of one degree of freedom: 0.455.
    (squares.get(squares.len() / 2).copied().unwrap_or(0.0) / 0.455).sqrt()
}

/// Standard deviation about the mean.
fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Root mean square error of a law by quarter of the longest slip since a change.
fn by_quarter(record: &FrictionRecord, law: &Fitted) -> [f64; 4] {
    let (_, rows) = design(record, law.law, law.memory, law.stretch);
    let longest = record.samples.iter().map(|s| s.since).fold(1e-300, f64::max);
    let (mut sum, mut count) = ([0.0; 4], [0.0; 4]);
    for (sample, row) in record.samples.iter().zip(&rows) {
        let told: f64 = row.iter().zip(&law.coefficients).map(|(x, c)| x * c.1).sum();
        let k = ((4.0 * sample.since / longest) as usize).min(3);
        sum[k] += (sample.value - told).powi(2);
        count[k] += 1.0;
    }
    std::array::from_fn(|k| (sum[k] / f64::max(count[k], 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed step by 10 at row 600 whose friction evolves over 20 µm of slip.
    fn made(evolves: f64) -> FrictionRecord {
        let speed = |i: usize| if i < 600 { 1e-6 } else { 1e-5 };
        let slip: Vec<f64> = (0..1500).map(|i| (0..i).map(speed).sum::<f64>() * 0.1).collect();
        let sample = |i: usize| {
            let since = if i < 600 { slip[i] } else { slip[i] - slip[600] };
            let wiggle = 1e-4 * ((i * 7919 % 13) as f64 - 6.0) / 6.0;
            let fresh = if i < 600 { 0.0 } else { evolves * (-since / 20e-6).exp() };
            Sample {
                value: 0.6 + 0.005 * (speed(i) / 1e-6_f64).ln() + fresh + wiggle,
                direction: 1.0,
                speed: speed(i),
                since,
                since_time: 0.1 * (i % 600) as f64,
                slip: slip[i],
                place: slip[i],
                pressure: None,
                stroke: usize::from(i >= 600),
            }
        };
        let samples = (0..slip.len()).map(sample).collect();
        FrictionRecord { file: "made".into(), samples, piston: false }
    }

    #[test]
    fn friction_that_follows_the_speed_at_once_needs_no_effect() {
        let verdict = explain(&made(0.0));
        let recalibrated = verdict.laws.iter().find(|l| l.law == Law::Speed).unwrap();
        // 0.005 per e-fold was put in; the wiggle is 1e-4.
        assert!((recalibrated.coefficients[1].1 - 0.005).abs() < 2e-4);
        assert!(recalibrated.held_out < 1.5e-4);
    }
}
