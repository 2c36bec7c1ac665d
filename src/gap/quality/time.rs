//! What can be wrong with the time column of a record.

use crate::error::Problem;
use crate::gap::campaign::{Plan, Record, RunSpec};

/// Fewest rows of a record.
const FEWEST_ROWS: usize = 50;
/// A clock that is off by up to this share is as right as clocks are.
const SLIGHTLY_WRONG_CLOCK: f64 = 0.005;
/// A clock that is off by up to this share is told, and the rows are taken by their number.
const WRONG_CLOCK: f64 = 0.15;

/// Checks the time column, and puts a clock right that is a little off.
///
/// # Errors
/// The problem for which the whole run cannot be used.
pub(super) fn check_time(
    record: &mut Record,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let expected = 1.0 / plan.sampling_rate;
    check_rows(&record.time, spec)?;
    check_clock(record, expected, spec, warnings)?;
    check_span(&record.time, 2.0 * expected, spec)
}

fn check_rows(time: &[f64], spec: &RunSpec) -> Result<(), Problem> {
    if time.len() < FEWEST_ROWS {
        let allowed = format!("{FEWEST_ROWS} rows or more");
        return Err(of_time(spec, format!("{} rows", time.len()), &allowed, "the run is left out"));
    }
    if time.iter().any(|t| !t.is_finite()) || time.windows(2).any(|w| w[1] <= w[0]) {
        let remedy = "the run is left out; sort it, or mend the time column";
        return Err(of_time(spec, "not increasing".into(), "finite and increasing", remedy));
    }
    Ok(())
}

/// Compares the samples' distance with the `expected` one \[s\]; takes the rows by their number if it is a little off.
fn check_clock(
    record: &mut Record,
    expected: f64,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let time = &mut record.time;
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    record.clock = step / expected;
    let off = (record.clock - 1.0).abs();
    if off > WRONG_CLOCK {
        return Err(of_time(
            spec,
            format!("{step:.6} s per sample"),
            &format!("{expected:.6} s, as channels.sampling_rate_hz says"),
            "the run is left out: rate and time column contradict each other, correct one of them",
        ));
    }
    if off > SLIGHTLY_WRONG_CLOCK {
        tell_clock(step, expected, spec, warnings);
        for (row, t) in time.iter_mut().enumerate() {
            *t = row as f64 * expected;
        }
    }
    Ok(())
}

/// Does the record begin with the road, within `shift` \[s\], and last as long as it should?
fn check_span(time: &[f64], shift: f64, spec: &RunSpec) -> Result<(), Problem> {
    if time[0].abs() > shift {
        return Err(of_time(
            spec,
            format!("starts at {:.6} s", time[0]),
            "starts at 0 s, when the road starts",
            "the run is left out; shift the time so that the road starts at 0",
        ));
    }
    let end = time[time.len() - 1];
    if end < 0.6 * spec.duration_s {
        return Err(of_time(
            spec,
            format!("ends at {end:.6} s"),
            &format!("{:.6} s as duration_s says", spec.duration_s),
            "the run is left out; it is cut off",
        ));
    }
    Ok(())
}

fn of_time(spec: &RunSpec, value: String, allowed: &str, remedy: &str) -> Problem {
    Problem::new(format!("{}: time_s", spec.file), value, allowed, remedy)
}

/// Tells once for a campaign that its samples are `step` \[s\] apart instead of `expected` \[s\].
fn tell_clock(step: f64, expected: f64, spec: &RunSpec, warnings: &mut Vec<Problem>) {
    let what = "time_s against channels.sampling_rate_hz";
    if !warnings.iter().any(|w| w.what == what) {
        warnings.push(Problem::new(
            what,
            format!("{step:.7} s per sample ({} and perhaps others)", spec.file),
            format!("{expected:.7} s"),
            "rows are taken at the sampling rate, and no effect is named: find out which of the two is right",
        ));
    }
}
