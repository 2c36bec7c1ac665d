//! Reads a record: friction against imposed slip, load and time.
//!
//! Two kinds of file are read. `time_s, displacement_m, friction_coefficient` and, if measured,
//! `normal_pressure_pa`: a friction coefficient while the sliding speed changes. `time_s, position_m,
//! pressure_pa, force_n`: a piston dragged to and fro, force = pressure × area ± friction.

use crate::columns;
use crate::error::{Fault, Problem};
use std::path::Path;

const REMEDY: &str =
    "write time_s with displacement_m and friction_coefficient, or with position_m, \
                      force_n and pressure_pa, in SI units";
/// Samples of a record after thinning: enough for every law here, and fast.
const SAMPLES: usize = 6000;
/// Samples over which speed is measured, each way.
const SPEED_REACH: usize = 3;
/// Samples at the least.
const FEWEST: usize = 100;
/// A piston stands, and shows no sliding friction, while it is slower than this share of its median speed.
const STANDS: f64 = 0.3;

/// What was measured, cut to what slides.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionRecord {
    /// File.
    pub file: String,
    /// What slides, in the order of the time.
    pub samples: Vec<Sample>,
    /// Is the value a force that holds pressure × area?
    pub piston: bool,
}

/// One instant of sliding, with what the laws ask of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Friction \[-\], or force \[N\] of a piston.
    pub value: f64,
    /// +1 or −1: the direction in which friction acts on the value; +1 throughout for a coefficient.
    pub direction: f64,
    /// Sliding speed, not less than 1 % of its median \[m/s\].
    pub speed: f64,
    /// Slip \[m\] since the direction or the imposed speed changed.
    pub since: f64,
    /// Time \[s\] since then.
    pub since_time: f64,
    /// Slip \[m\] since the start.
    pub slip: f64,
    /// Place \[m\].
    pub place: f64,
    /// Pressure \[Pa\] on the contact or behind the piston, if measured.
    pub pressure: Option<f64>,
    /// Number of the stroke, or of the piece between changes of speed.
    pub stroke: usize,
}

impl FrictionRecord {
    /// Number of the last stroke or piece.
    pub fn last_stroke(&self) -> usize {
        self.samples.last().map_or(0, |s| s.stroke)
    }
}

/// Columns of a file.
struct Columns {
    time: Vec<f64>,
    place: Vec<f64>,
    value: Vec<f64>,
    pressure: Option<Vec<f64>>,
}

/// Reads a record.
///
/// # Errors
/// A file that cannot be read, or columns from which nothing can be concluded.
pub fn read(path: &Path) -> Result<FrictionRecord, Fault> {
    let file = path.display().to_string();
    let has = header(path)?;
    let piston = has.iter().any(|h| h == "force_n");
    let mut names = if piston {
        vec!["time_s", "position_m", "force_n", "pressure_pa"]
    } else {
        vec!["time_s", "displacement_m", "friction_coefficient"]
    };
    if !piston && has.iter().any(|h| h == "normal_pressure_pa") {
        names.push("normal_pressure_pa");
    }
    let mut columns = columns::read(path, &names, REMEDY)?.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    let (time, place, value) = (next(), next(), next());
    let columns = Columns { time, place, value, pressure: columns.next() };
    check(&file, &columns)?;
    Ok(FrictionRecord { file, samples: sliding(&columns.thinned(), piston), piston })
}

/// Names of the columns.
fn header(path: &Path) -> Result<Vec<String>, Fault> {
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
    let first = text.lines().next().unwrap_or("").trim_start_matches('\u{feff}');
    Ok(first.split(',').map(|h| h.trim().to_string()).collect())
}

/// Tells all columns from which nothing can be concluded.
fn check(file: &str, Columns { time, place, value, .. }: &Columns) -> Result<(), Fault> {
    let mut problems = Vec::new();
    if time.len() < FEWEST {
        problems.push(Problem::new(
            file,
            format!("{} rows", time.len()),
            format!("{FEWEST} at the least"),
            "measure longer",
        ));
    }
    for (name, column) in [("time", time), ("friction", value), ("displacement", place)] {
        if column.iter().any(|x| !x.is_finite()) {
            problems.push(Problem::new(
                format!("{file}, {name}"),
                "not finite",
                "numbers",
                "mend or cut these rows",
            ));
        }
        let first = column.first().copied().unwrap_or(0.0);
        if column.iter().all(|x| *x == first) {
            problems.push(Problem::new(
                format!("{file}, {name}"),
                "constant",
                "a measured column",
                "check the channel",
            ));
        }
    }
    if time.windows(2).any(|w| w[1] < w[0]) {
        problems.push(Problem::new(
            format!("{file}, time"),
            "runs backwards",
            "rising times",
            "sort the rows or cut the record",
        ));
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(Fault::Invalid(problems))
    }
}

impl Columns {
    /// Means of neighbouring rows, so that about [`SAMPLES`] are left.
    fn thinned(&self) -> Self {
        let every = (self.time.len() / SAMPLES).max(1);
        let thin = |column: &Vec<f64>| -> Vec<f64> {
            column.chunks_exact(every).map(|c| c.iter().sum::<f64>() / every as f64).collect()
        };
        let [time, place, value] = [&self.time, &self.place, &self.value].map(thin);
        Self { time, place, value, pressure: self.pressure.as_ref().map(thin) }
    }
}

/// The rows that slide, with what the laws ask of them.
fn sliding(columns: &Columns, piston: bool) -> Vec<Sample> {
    let Columns { time, place, value, pressure } = columns;
    let velocity = velocity(time, place);
    let mut sizes: Vec<f64> = velocity.iter().map(|v| v.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let typical = sizes[time.len() / 2].max(1e-15);
    let stands = STANDS * typical;
    let changes = if piston { reversals(&velocity, stands) } else { steps(time, place) };
    let mut samples = Vec::new();
    let (mut slip, mut last, mut stroke) = (0.0, 0, 0);
    let mut at_change = 0.0;
    for i in 0..time.len() {
        if changes.contains(&i) {
            (last, at_change, stroke) = (i, slip, stroke + 1);
        }
        slip += if i > 0 { (place[i] - place[i - 1]).abs() } else { 0.0 };
        if piston && velocity[i].abs() < stands {
            continue;
        }
        samples.push(Sample {
            value: value[i],
            direction: if piston { velocity[i].signum() } else { 1.0 },
            speed: velocity[i].abs().max(0.01 * typical),
            since: slip - at_change,
            since_time: time[i] - time[last],
            slip,
            place: place[i],
            pressure: pressure.as_ref().map(|p| p[i]),
            stroke,
        });
    }
    samples
}

/// Slope of the place over a few samples each way \[m/s\].
fn velocity(time: &[f64], place: &[f64]) -> Vec<f64> {
    let last = time.len().saturating_sub(1);
    (0..time.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(SPEED_REACH), (i + SPEED_REACH).min(last));
            (place[b] - place[a]) / (time[b] - time[a]).max(1e-12)
        })
        .collect()
}

/// Rows at which the direction changes, at speeds above `least` \[m/s\].
fn reversals(velocity: &[f64], least: f64) -> Vec<usize> {
    let mut out = Vec::new();
    let mut sign = 0.0;
    for (i, v) in velocity.iter().enumerate() {
        if v.abs() > least && v.signum() != sign {
            out.push(i);
            sign = v.signum();
        }
    }
    out
}

/// The row at which the speed is stepped: two straight lines fit the displacement best.
fn steps(time: &[f64], place: &[f64]) -> Vec<usize> {
    let count = time.len();
    let misfit = |from: usize, to: usize| {
        let n = (to - from) as f64;
        let mean = |c: &[f64]| c[from..to].iter().sum::<f64>() / n;
        let (mt, mx) = (mean(time), mean(place));
        let (mut tt, mut tx, mut xx) = (0.0, 0.0, 0.0);
        for i in from..to {
            let (t, x) = (time[i] - mt, place[i] - mx);
            tt += t * t;
            tx += t * x;
            xx += x * x;
        }
        (xx - tx * tx / tt.max(1e-300)).max(0.0)
    };
    let candidates = (1..40).map(|k| k * count / 40);
    let coarse = candidates
        .min_by(|a, b| {
            (misfit(0, *a) + misfit(*a, count)).total_cmp(&(misfit(0, *b) + misfit(*b, count)))
        })
        .unwrap_or(count / 2);
    let (lo, hi) = (coarse.saturating_sub(count / 40).max(3), (coarse + count / 40).min(count - 3));
    let fine = (lo..hi).min_by(|a, b| {
        (misfit(0, *a) + misfit(*a, count)).total_cmp(&(misfit(0, *b) + misfit(*b, count)))
    });
    fine.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_the_speed_is_found_where_it_is() {
        // 1 µm/s for 60 s, then 10 µm/s: exact kink at row 600 of 1000.
        let time: Vec<f64> = (0..1000).map(|i| 0.1 * f64::from(i)).collect();
        let place: Vec<f64> = time.iter().map(|t| 1e-6 * t + 9e-6 * (t - 60.0).max(0.0)).collect();
        let found = steps(&time, &place);
        assert!((found[0] as i64 - 600).abs() <= 1, "{found:?}");
    }

    #[test]
    fn a_piston_that_turns_round_begins_a_stroke() {
        let velocity = [1.0, 1.0, 0.1, -0.1, -1.0, -1.0, 1.0];
        assert_eq!(reversals(&velocity, 0.3), vec![0, 4, 6]);
    }
}
