//! A block that passes through the contact patch on a given path of its clamped face.

use super::belt_path::BeltSample;
use super::spline::Spline;
use crate::drive::Pose;
use crate::error::{Fault, Problem};

/// Rolling: the clamped face follows a sampled path, a natural cubic spline through each column.
#[derive(Clone, Debug, PartialEq)]
pub struct Roll {
    x: Spline,
    z: Spline,
    angle: Spline,
}

/// Longest piece of a path that one cubic stands for \[s\]; its error is that of Hermite interpolation
/// over it, below 1e-12 m on a tyre's path, while short steps would only cost time.
const PIECE: f64 = 20e-6;

impl Roll {
    /// The motion through `samples`.
    ///
    /// # Errors
    /// [`Fault::Invalid`] for fewer than four samples, times that do not rise, numbers that are not
    /// finite and jumps.
    pub fn through(samples: &[BeltSample]) -> Result<Self, Fault> {
        let problems = problems(samples);
        if !problems.is_empty() {
            return Err(Fault::Invalid(problems));
        }
        let times: Vec<f64> = samples.iter().map(|s| s.time).collect();
        let column = |get: fn(&BeltSample) -> f64| {
            Spline::natural(&times, &samples.iter().map(get).collect::<Vec<_>>())
        };
        Ok(Self { x: column(|s| s.x), z: column(|s| s.z), angle: column(|s| s.angle) })
    }

    /// First and last time of the path \[s\].
    pub fn span(&self) -> (f64, f64) {
        let times = self.x.times();
        (times[0], times[times.len() - 1])
    }

    pub(super) fn pose(&self, t: f64) -> Pose {
        Pose { x: self.x.at(t).0, z: self.z.at(t).0, angle: self.angle.at(t).0, load: 0.0 }
    }

    pub(super) fn rates(&self, t: f64) -> Pose {
        Pose { x: self.x.at(t).1, z: self.z.at(t).1, angle: self.angle.at(t).1, load: 0.0 }
    }

    /// End of the piece that starts at `t`: a sample, at most [`PIECE`] away if samples are dense.
    pub(super) fn piece_end(&self, t: f64) -> f64 {
        let times = self.x.times();
        let next = self.x.interval(t) + 1;
        // A little less than PIECE would leave a sliver behind it; a tenth more does not matter.
        let far = times.partition_point(|&x| x <= t + 1.1 * PIECE);
        let end = times[next.max(far.saturating_sub(1)).min(times.len() - 1)];
        if end > t {
            end
        } else {
            f64::INFINITY
        }
    }
}

fn problems(samples: &[BeltSample]) -> Vec<Problem> {
    let mut found = Vec::new();
    if samples.len() < 4 {
        found.push(Problem::new(
            "belt path: number of samples",
            samples.len().to_string(),
            "4 or more",
            "`tread belt` writes a path",
        ));
    }
    for (row, sample) in samples.iter().enumerate() {
        let columns = [
            ("time_s", sample.time),
            ("belt_x_m", sample.x),
            ("belt_z_m", sample.z),
            ("belt_angle_rad", sample.angle),
        ];
        for (name, value) in columns.into_iter().filter(|(_, value)| !value.is_finite()) {
            found.push(Problem::new(
                format!("belt path: column {name}, sample {}", row + 1),
                value.to_string(),
                "a finite number",
                "mend or drop the sample",
            ));
        }
    }
    for (row, pair) in samples.windows(2).enumerate() {
        if pair[1].time <= pair[0].time {
            found.push(Problem::new(
                format!("belt path: column time_s, sample {}", row + 2),
                pair[1].time.to_string(),
                format!("more than {} of the sample before", pair[0].time),
                "sort the samples by time and drop doubles",
            ));
        }
    }
    if found.is_empty() {
        found.extend(jumps(samples));
    }
    // A file that is wrong in every row needs no thousand lines to say so.
    found.truncate(20);
    found
}

/// Steps no tyre makes: faster than 200 m/s, or an angle faster than 5000 rad/s.
fn jumps(samples: &[BeltSample]) -> Vec<Problem> {
    let mut found = Vec::new();
    for (row, pair) in samples.windows(2).enumerate() {
        let dt = pair[1].time - pair[0].time;
        let moves = [
            ("belt_x_m", (pair[1].x - pair[0].x) / dt, 200.0, "m/s"),
            ("belt_z_m", (pair[1].z - pair[0].z) / dt, 200.0, "m/s"),
            ("belt_angle_rad", (pair[1].angle - pair[0].angle) / dt, 5000.0, "rad/s"),
        ];
        for (name, rate, limit, unit) in moves.into_iter().filter(|m| m.1.abs() > m.2) {
            found.push(Problem::new(
                format!("belt path: column {name}, sample {}", row + 2),
                format!("a jump at {rate:.4e} {unit}"),
                format!("a motion slower than {limit} {unit}"),
                "check the unit of the column and look for a missing piece of the record",
            ));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time: f64) -> BeltSample {
        BeltSample { time, x: 0.3 * time, z: 0.01, angle: 0.0 }
    }

    #[test]
    fn a_path_that_runs_backwards_or_jumps_is_refused_by_row() {
        let mut samples: Vec<_> = (0..10).map(|i| sample(f64::from(i) * 5e-6)).collect();
        samples[4].time = samples[3].time;
        let Err(Fault::Invalid(problems)) = Roll::through(&samples) else { panic!("accepted") };
        assert!(problems[0].what.contains("sample 5"), "{problems:?}");
        samples[4].time = 20e-6;
        samples[7].z = 0.1;
        let Err(Fault::Invalid(problems)) = Roll::through(&samples) else { panic!("accepted") };
        assert!(problems[0].what.contains("belt_z_m, sample 8"), "{problems:?}");
    }

    #[test]
    fn pieces_end_at_samples_and_cover_the_path() {
        let samples: Vec<_> = (0..100).map(|i| sample(f64::from(i) * 5e-6)).collect();
        let roll = Roll::through(&samples).unwrap();
        let mut t = 0.0;
        let mut pieces = 0;
        while roll.piece_end(t).is_finite() {
            let end = roll.piece_end(t);
            assert!(end > t && end - t < 1.2 * PIECE);
            t = end;
            pieces += 1;
        }
        assert!((t - 495e-6).abs() < 1e-15 && pieces <= 26, "{pieces} pieces to {t}");
    }
}
