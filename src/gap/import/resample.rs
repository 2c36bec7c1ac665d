//! One channel from the logger's instants to the campaign's: copied where they agree, splined where not.

use crate::scenario::Spline;

/// A sample this near to its row, as a share of the row's step, is taken as it is.
const NEAR: f64 = 0.02;
/// A step longer than this many median steps is a gap.
const GAP: f64 = 1.5;
/// A logger slower than this share of the campaign's rate would have to be invented in part.
const SLOWEST: f64 = 0.95;
/// The campaign may begin this many rows after the start, as the check of campaigns allows.
const LATEST_ROW: usize = 2;

/// A channel of a logger, its time shifted so that the road starts at 0.
#[derive(Clone, Debug)]
pub struct Signal {
    /// \[s\]
    time: Vec<f64>,
    /// In the channel's SI unit.
    values: Vec<f64>,
    /// Median of the steps \[s\].
    pub step: f64,
}

/// A channel at the campaign's rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Values in the channel's SI unit.
    pub values: Vec<f64>,
    /// Were samples taken as they are, or were they splined?
    pub copied: bool,
    /// Largest distance of a row from the sample that it holds, or from the next one \[s\].
    pub distance: f64,
    /// What the rows do not hold of the record, rms over rms of the record about its mean \[-\].
    pub lost: f64,
}

/// What cannot be told of a time column: value found and what would be accepted.
pub type Unclear = (String, &'static str);

impl Signal {
    /// A signal whose road starts at `start` \[s\] of `time`.
    ///
    /// # Errors
    /// Times that do not rise, gaps, fewer than 50 rows.
    pub fn new(time: Vec<f64>, values: Vec<f64>, start: f64) -> Result<Self, Unclear> {
        if time.len() < 50 {
            return Err((format!("{} rows", time.len()), "50 rows or more"));
        }
        let steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        let held = steps.iter().filter(|s| **s == 0.0).count();
        let back = steps.iter().filter(|s| **s < 0.0).count();
        if held + back > 0 {
            let first = steps.iter().position(|s| *s <= 0.0).unwrap_or(0) + 1;
            let told = format!(
                "{held} times twice and {back} steps back, the first at row {first} ({} s)",
                time[first]
            );
            return Err((told, "times that rise from row to row"));
        }
        let mut sorted = steps.clone();
        sorted.sort_by(f64::total_cmp);
        let step = sorted[sorted.len() / 2];
        let gaps = steps.iter().filter(|s| **s > GAP * step).count();
        if let Some(first) = steps.iter().position(|s| *s > GAP * step) {
            let told = format!(
                "{gaps} gaps, the first of {:.4e} s after {} s, where the step is {step:.4e} s",
                steps[first], time[first]
            );
            return Err((told, "a record without gaps"));
        }
        let time = time.into_iter().map(|t| t - start).collect();
        Ok(Self { time, values, step })
    }

    /// First and last row at `rate` \[Hz\] within the record, up to `duration` \[s\].
    ///
    /// # Errors
    /// A record that begins after the start or ends before the duration, or whose rate is too low.
    pub fn rows(&self, rate: f64, duration: Option<f64>) -> Result<(usize, usize), Unclear> {
        if 1.0 / self.step < SLOWEST * rate {
            let told = format!("{:.6} Hz", 1.0 / self.step);
            return Err((
                told,
                "channels.sampling_rate_hz or more: what lies between is not known",
            ));
        }
        let (from, to) = (self.time[0], self.time[self.time.len() - 1]);
        let first = ((from * rate - NEAR).ceil()).max(0.0) as usize;
        if first > LATEST_ROW {
            return Err((
                format!("begins {from:.6} s after the start"),
                "a record from the start on",
            ));
        }
        let last = (to * rate + NEAR).floor().max(0.0) as usize;
        let wanted = duration.map_or(last, |d| (d * rate + NEAR).floor() as usize);
        // The last row may be the one before the duration's end, as loggers count.
        if last + 1 < wanted || last < first + 50 {
            return Err((
                format!("ends {to:.6} s after the start"),
                "a record as long as duration_s",
            ));
        }
        Ok((first, wanted.min(last)))
    }

    /// Values at the rows `first..=last` at `rate` \[Hz\].
    pub fn at_rows(&self, rate: f64, (first, last): (usize, usize)) -> Sampled {
        let instants: Vec<f64> = (first..=last).map(|row| row as f64 / rate).collect();
        let nearest: Vec<usize> = instants.iter().map(|t| self.nearest(*t)).collect();
        let distance = nearest
            .iter()
            .zip(&instants)
            .map(|(i, t)| (self.time[*i] - t).abs())
            .fold(0.0, f64::max);
        let copied = distance * rate <= NEAR;
        let values: Vec<f64> = if copied {
            nearest.iter().map(|i| self.values[*i]).collect()
        } else {
            let spline = Spline::natural(&self.time, &self.values);
            instants.iter().map(|t| spline.at(*t).0).collect()
        };
        let lost = self.lost(&instants, &values);
        Sampled { values, copied, distance, lost }
    }

    /// The sample nearest to an instant.
    fn nearest(&self, t: f64) -> usize {
        let after = self.time.partition_point(|x| *x < t).min(self.time.len() - 1);
        let before = after.saturating_sub(1);
        if (self.time[before] - t).abs() <= (self.time[after] - t).abs() {
            before
        } else {
            after
        }
    }

    /// The record against a spline through its rows: what lies above half the campaign's rate is lost.
    fn lost(&self, instants: &[f64], values: &[f64]) -> f64 {
        let back = Spline::natural(instants, values);
        let end = instants[instants.len() - 1];
        let inside: Vec<usize> =
            (0..self.time.len()).filter(|i| (instants[0]..=end).contains(&self.time[*i])).collect();
        let count = inside.len().max(1) as f64;
        let mean = inside.iter().map(|i| self.values[*i]).sum::<f64>() / count;
        let sum = |of: &dyn Fn(usize) -> f64| inside.iter().map(|i| of(*i).powi(2)).sum::<f64>();
        let missed = sum(&|i| self.values[i] - back.at(self.time[i]).0);
        let whole = sum(&|i| self.values[i] - mean);
        if whole > 0.0 {
            (missed / whole).sqrt()
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(rate: f64, frequency: f64) -> Signal {
        let time: Vec<f64> = (0..4000).map(|i| f64::from(i) / rate).collect();
        let wave = time.iter().map(|t| (std::f64::consts::TAU * frequency * t).sin()).collect();
        Signal::new(time, wave, 0.0).unwrap()
    }

    #[test]
    fn a_record_at_the_campaigns_rate_is_copied_to_the_last_bit() {
        let signal = sine(25e3, 1e3);
        let sampled = signal.at_rows(25e3, signal.rows(25e3, Some(0.02)).unwrap());
        assert!(sampled.copied && sampled.values[..] == signal.values[..501]);
    }

    #[test]
    fn a_sine_between_the_samples_is_met_as_splines_promise() {
        // de Boor: a cubic spline's error is at most 5/384 h⁴ max|f''''|; here h·ω = 2π/100.
        let bound = 5.0 / 384.0 * (std::f64::consts::TAU / 100.0).powi(4);
        let signal = sine(100e3, 1e3);
        let sampled = signal.at_rows(33e3, (30, 600));
        assert!(!sampled.copied);
        for (row, value) in (30..=600).zip(&sampled.values) {
            let truth = (std::f64::consts::TAU * 1e3 * f64::from(row) / 33e3).sin();
            assert!((value - truth).abs() < 1.5 * bound, "row {row}: {value} against {truth}");
        }
    }

    #[test]
    fn what_is_above_half_the_rate_is_told_as_lost() {
        // 20 kHz sampled at 25 kHz is gone: the aliased spline has nothing to do with it, so the rest
        // is as large as the sum of both, sqrt(2) of the wave.
        let high = sine(200e3, 20e3);
        let lost = high.at_rows(25e3, (0, 400)).lost;
        assert!((1.2..1.6).contains(&lost), "{lost}");
        let low = sine(200e3, 500.0).at_rows(25e3, (0, 400)).lost;
        assert!(low < 1e-3, "{low}");
    }

    #[test]
    fn gaps_repeated_times_and_slow_loggers_are_refused() {
        let mut time: Vec<f64> = (0..100).map(|i| 1e-3 * f64::from(i)).collect();
        time[40] = time[39];
        let refused = Signal::new(time.clone(), time.clone(), 0.0).unwrap_err();
        assert!(refused.0.contains("1 times twice") && refused.0.contains("row 40"), "{refused:?}");
        let gap: Vec<f64> = (0..100).map(|i| 1e-3 * f64::from(i + i / 50)).collect();
        assert!(Signal::new(gap.clone(), gap, 0.0).unwrap_err().0.contains("1 gaps"));
        let slow = sine(10e3, 1e3);
        assert!(slow.rows(25e3, None).unwrap_err().0.contains("10000"));
        assert!(sine(25e3, 1e3).rows(25e3, Some(1.0)).unwrap_err().0.contains("ends"));
    }
}
