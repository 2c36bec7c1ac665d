//! What sensors make of a record: what is wrong with them, and noise.

use super::{share_off, Truth};
use crate::gap::campaign::{self, Plan, Record, CHANNELS};
use crate::gap::noise::Noise;

/// What is wrong with the measurement itself.
pub(super) fn distort(truth: Truth, severity: f64, record: &mut Record) {
    let share = 1.0 + share_off(severity);
    match truth {
        Truth::Gain => {
            if let Some(force) = record.channel[campaign::FRICTION].as_mut() {
                force.iter_mut().for_each(|f| *f *= share);
            }
        }
        Truth::Clock => {
            for column in record.channel.iter_mut().flatten() {
                *column = slowed(column, share);
            }
        }
        Truth::CrossTalk => {
            let [friction, normal, ..] = &mut record.channel;
            let pairs = friction.iter().flatten().zip(normal.iter_mut().flatten());
            pairs.for_each(|(f, n)| *n += (share - 1.0) * f);
        }
        Truth::Drift => {
            let count = record.time.len() as f64;
            let full = DRIFT * (1.0 + severity);
            for column in record.channel[campaign::FRICTION].iter_mut() {
                column.iter_mut().enumerate().for_each(|(i, f)| *f += full * i as f64 / count);
            }
        }
        Truth::None | Truth::Effect(_) | Truth::Pair(_) => {}
        Truth::SpeedRipple | Truth::LoadRipple => {}
    }
}

/// Drift of the zero of the friction channel over a run at severity 1 \[N\].
const DRIFT: f64 = 3.0;

/// The column as a clock sees it that is slow by the factor `share`; the end stands still.
fn slowed(column: &[f64], share: f64) -> Vec<f64> {
    let value = |i: usize| {
        let at = i as f64 * share;
        let k = (at as usize).min(column.len() - 1);
        let next = (k + 1).min(column.len() - 1);
        column[k] + (at - k as f64).min(1.0) * (column[next] - column[k])
    };
    (0..column.len()).map(value).collect()
}

/// Adds the noise of the channels.
pub(super) fn blur(plan: &Plan, record: &mut Record, noise: &mut Noise) {
    for (column, std) in record.channel.iter_mut().zip(plan.noise) {
        let (Some(column), Some(std)) = (column, std) else { continue };
        column.iter_mut().for_each(|v| *v += std * noise.normal());
    }
    debug_assert_eq!(CHANNELS.len(), record.channel.len());
}
