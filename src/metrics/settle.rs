//! From when on a vibration is settled.

use super::peak_to_peak;

/// Windows into which a record is cut; each should hold a period or more.
const WINDOWS: usize = 12;
/// How far a settled window's amplitude may be from the usual one.
const BAND: f64 = 0.15;

/// Index of the first sample from which on the vibration keeps its amplitude: the peak-to-peak value
/// of every later window (a twelfth of the record each) stays within 15 % of the median of the last
/// six. Never less than three twelfths of the record (the start, in which also the carriage comes to
/// rest) and never more than seven.
pub fn settled_from(signal: &[f64]) -> usize {
    let length = signal.len() / WINDOWS;
    if length < 2 {
        return signal.len() / 2;
    }
    let amplitude: Vec<f64> =
        (0..WINDOWS).map(|w| peak_to_peak(&signal[w * length..(w + 1) * length])).collect();
    let mut late = amplitude[WINDOWS / 2..].to_vec();
    late.sort_by(f64::total_cmp);
    let usual = 0.5 * (late[late.len() / 2] + late[(late.len() - 1) / 2]);
    let unsettled = amplitude.iter().rposition(|a| (a - usual).abs() > BAND * usual);
    length * unsettled.map_or(3, |w| w + 1).clamp(3, 7)
}
