//! How far the gap shrinks, on runs that no fit has seen.

use super::campaign::{RunKind, RunSpec};
use super::problem::{Bench, Look, Residuals};

/// Residuals beyond count as this many standard deviations.
const CAP: f64 = 40.0;
/// Bootstrap samples of the interval.
const SAMPLES: usize = 2000;

/// Runs to be held out: plain sliding runs inside the range of speeds and pressures of the others,
/// so that the fit keeps the corners, at most two fifths of the plain runs.
pub fn choose(runs: &[RunSpec]) -> Vec<usize> {
    let plain: Vec<usize> = (0..runs.len())
        .filter(|r| runs[*r].kind == RunKind::Sliding && runs[*r].dwell_s == 0.0)
        .filter(|r| runs[*r].road_speed_m_s > 0.0)
        .collect();
    if plain.len() < 6 {
        return Vec::new();
    }
    let inside = |of: fn(&RunSpec) -> f64, r: usize| {
        let value = of(&runs[r]);
        plain.iter().any(|o| of(&runs[*o]) < value) && plain.iter().any(|o| of(&runs[*o]) > value)
    };
    let twin = |r: usize| {
        plain.iter().any(|o| {
            *o != r
                && runs[*o].road_speed_m_s == runs[r].road_speed_m_s
                && runs[*o].mean_pressure_pa == runs[r].mean_pressure_pa
        })
    };
    let candidates: Vec<usize> = plain
        .iter()
        .copied()
        .filter(|r| {
            inside(|s| s.road_speed_m_s, *r) && inside(|s| s.mean_pressure_pa, *r) && !twin(*r)
        })
        .collect();
    let most = (2 * plain.len() / 5).max(1);
    let step = (candidates.len() as f64 / most as f64).max(1.0);
    let mut chosen: Vec<usize> =
        (0..most).filter_map(|k| candidates.get((k as f64 * step) as usize).copied()).collect();
    chosen.dedup();
    chosen
}

/// Runs to be fitted: all but the held-out ones, repetitions, and slow ramps that are as good as at
/// rest within what a fit looks at (not all of the run).
pub fn to_fit(runs: &[RunSpec], held_out: &[usize], look: Look) -> Vec<usize> {
    let same = |a: &RunSpec, b: &RunSpec| {
        RunSpec { file: String::new(), ..a.clone() } == RunSpec { file: String::new(), ..b.clone() }
    };
    let slow = |r: &RunSpec| {
        let gain = r.road_speed_end_m_s.unwrap_or(0.0).abs() * look.horizon(r) / r.duration_s;
        look != Look::Whole && r.kind == RunKind::SpeedRamp && r.road_speed_m_s.abs() + gain < 0.15
    };
    (0..runs.len())
        .filter(|r| !held_out.contains(r) && !slow(&runs[*r]))
        .filter(|r| !runs[..*r].iter().any(|earlier| same(earlier, &runs[*r])))
        .collect()
}

/// G² of single runs: weighted mean square of the residuals.
pub fn squares(bench: &Bench, residuals: &Residuals, of: &[usize]) -> Vec<f64> {
    of.iter()
        .map(|r| {
            let pairs = residuals[*r].iter().zip(&bench.weight[*r]);
            let sum: f64 = pairs.map(|(x, w)| w * (x * x).min(CAP * CAP)).sum();
            sum / bench.weight[*r].iter().sum::<f64>().max(1e-12)
        })
        .collect()
}

/// Mean of squares as a gap G.
pub fn gap(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// Share of the closable gap that was closed: (G_c² − G_e²)/(G_c² − 1), and 0 where nothing is open.
pub fn closed(before: &[f64], after: &[f64]) -> f64 {
    let (before, after) = (gap(before).powi(2), gap(after).powi(2).max(1.0));
    if before <= 1.0 {
        return 0.0;
    }
    ((before - after) / (before - 1.0)).clamp(-1.0, 1.0)
}

/// Squares run by run, as [`squares`] has them, of the recalibrated model and of the one with a cause.
#[derive(Clone, Debug)]
pub struct Paired {
    /// Of the recalibrated model.
    pub before: Vec<f64>,
    /// With the cause.
    pub after: Vec<f64>,
}

impl Paired {
    /// Share of the closable gap that was closed.
    pub fn closed(&self) -> f64 {
        closed(&self.before, &self.after)
    }

    /// Is there anything to close?
    fn is_open(&self) -> bool {
        gap(&self.before) > 1.0
    }
}

/// Weight of unseen runs in what further runs are told to do: 1 - 1/e.
const UNSEEN: f64 = 0.632;

/// How a cause does on the two kinds of runs that a campaign has.
#[derive(Clone, Debug)]
pub struct Shrinkage {
    /// On runs that no fit has seen.
    pub unseen: Paired,
    /// On those that were fitted; none where none is held out.
    pub seen: Paired,
}

impl Shrinkage {
    /// The closed fraction to be expected on further runs of the block: 0.632 of what the unseen runs say and the rest
    /// of what the fitted ones say (B. Efron, J. Am. Stat. Assoc. 78, 1983, 316). The former is right on average, but of
    /// four runs that jump between limit cycles it scatters; the latter scatters little and is too good.
    pub fn expected(&self) -> f64 {
        if self.seen.is_open() {
            UNSEEN * self.unseen.closed() + (1.0 - UNSEEN) * self.seen.closed()
        } else {
            self.unseen.closed()
        }
    }

    /// Interval of [`Self::expected`] (5 % to 95 %): that of the unseen runs, stretched to hold the value. Fitted runs do
    /// not narrow it, as what they say is too good by an unknown amount.
    pub fn interval(&self, seed: u64) -> (f64, f64) {
        let (lo, hi) = interval(&self.unseen.before, &self.unseen.after, seed);
        (lo.min(self.expected()), hi.max(self.expected()))
    }
}

/// Interval of [`closed`] (5 % to 95 %) by a paired bootstrap over the runs, widened for their
/// small number.
fn interval(before: &[f64], after: &[f64], seed: u64) -> (f64, f64) {
    let count = before.len();
    if count < 2 {
        return (-1.0, 1.0);
    }
    let mut state = seed | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % count
    };
    let mut values: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            let draw: Vec<usize> = (0..count).map(|_| next()).collect();
            let pick = |from: &[f64]| draw.iter().map(|i| from[*i]).collect::<Vec<_>>();
            closed(&pick(before), &pick(after))
        })
        .collect();
    values.sort_by(f64::total_cmp);
    let value = closed(before, after);
    let wide = |end: f64| (value + few(count) * (end - value)).clamp(-1.0, 1.0);
    (wide(values[SAMPLES / 20]), wide(values[SAMPLES - SAMPLES / 20 - 1]))
}

/// By how much the percentiles of a bootstrap over `count` runs are too narrow: it divides by n instead of n − 1, and
/// takes the normal distribution for Student's (T. Hesterberg, Am. Stat. 69, 2015, 371).
fn few(count: usize) -> f64 {
    let n = count as f64;
    let at = (count - 2).min(STUDENT.len() - 1);
    (n / (n - 1.0)).sqrt() * STUDENT[at] / 1.645
}

/// 95 % of Student's distribution with 1, 2, ... degrees of freedom (tables).
const STUDENT: [f64; 10] = [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_everything_down_to_the_floor_is_one() {
        assert_eq!(closed(&[9.0, 16.0], &[1.0, 1.0]), 1.0);
    }

    #[test]
    fn closing_nothing_is_zero_and_harm_is_negative() {
        assert_eq!(closed(&[9.0], &[9.0]), 0.0);
        assert!(closed(&[9.0], &[12.0]) < 0.0);
    }

    #[test]
    fn four_runs_tell_an_interval_that_is_wide_enough() {
        // Student's 90 % interval of the mean of four is 2.353·√(4/3)/1.645 = 1.65 of what a bootstrap tells.
        assert!((few(4) - 1.652).abs() < 1e-3, "{}", few(4));
    }

    fn shrinkage(unseen: [[f64; 3]; 2], seen: [[f64; 3]; 2]) -> Shrinkage {
        let paired = |[b, a]: [[f64; 3]; 2]| Paired { before: b.to_vec(), after: a.to_vec() };
        Shrinkage { unseen: paired(unseen), seen: paired(seen) }
    }

    #[test]
    fn fitted_runs_have_a_say_of_a_bit_more_than_a_third() {
        // (11 - 6)/(11 - 1) = 0.5 and 1 by hand; 0.632·0.5 + 0.368.
        let half = [[11.0; 3], [6.0; 3]];
        let both = shrinkage(half, [[5.0; 3], [0.5; 3]]);
        assert!((both.expected() - 0.684).abs() < 1e-12);
        // Where they leave nothing to close, they say nothing.
        assert!((shrinkage(half, [[0.9; 3], [0.5; 3]]).expected() - 0.5).abs() < 1e-12);
        // The bootstrap of equal runs says [0.5, 0.5]; it is stretched to the value.
        let (lo, hi) = both.interval(7);
        assert!((lo - 0.5).abs() < 1e-12 && (hi - 0.684).abs() < 1e-12, "{lo} {hi}");
    }

    #[test]
    fn the_interval_holds_the_value() {
        let (before, after) = ([9.0, 16.0, 12.0], [2.0, 5.0, 1.5]);
        let (lo, hi) = interval(&before, &after, 7);
        let value = closed(&before, &after);
        assert!(lo <= value && value <= hi, "{lo} {value} {hi}");
    }
}
