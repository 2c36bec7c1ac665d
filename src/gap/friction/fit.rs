//! Least squares of a law on some pieces of a record, judged on the others: laws are linear but for one length or time,
//! which is tried.

use super::design::design;
use super::law::Law;
use super::record::FrictionRecord;
use nalgebra::{DMatrix, DVector};

/// Lengths and times that are tried, as a share of the longest stroke: from the first samples to it.
const SHARES: [f64; 9] = [0.003, 0.006, 0.012, 0.025, 0.05, 0.1, 0.2, 0.4, 0.8];

/// A fitted law.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The law.
    pub law: Law,
    /// Root mean square error on held-out pieces, in the record's unit.
    pub held_out: f64,
    /// Root mean square error where it was fitted, in the record's unit.
    pub fitted: f64,
    /// Length \[m\] or time \[s\] of its memory, if it has one.
    pub memory: Option<f64>,
    /// Length \[m\] over which a change of the speed arrives, where the speed is stepped.
    pub stretch: f64,
    /// Coefficients with standard deviations: name, value, deviation.
    pub coefficients: Vec<(&'static str, f64, f64)>,
    /// Probability among the laws.
    pub probability: f64,
    /// Share that it closes of what constant friction with recalibrated speed leaves above the noise.
    pub closed: f64,
}

/// The law with the memory and the stretch that do best where it is fitted.
pub(super) fn best(record: &FrictionRecord, law: Law, pieces: &[usize]) -> Option<Fitted> {
    let slip = record.samples.iter().map(|s| s.since).fold(0.0, f64::max);
    let time = record.samples.iter().map(|s| s.since_time).fold(0.0, f64::max);
    let memories: Vec<Option<f64>> = match law {
        Law::FrictionAgeing => SHARES.iter().map(|s| Some(s * slip)).collect(),
        Law::RigCompliance if record.piston => SHARES.iter().map(|s| Some(s * slip)).collect(),
        Law::ThermalFriction => SHARES.iter().map(|s| Some(s * time)).collect(),
        Law::RigCompliance => return None,
        Law::Adhesion if record.samples.iter().all(|s| s.pressure.is_none()) => return None,
        _ => vec![None],
    };
    // A stiff rig hands a change of the speed on at once.
    let mut stretches = vec![0.0];
    if !record.piston {
        stretches.extend(SHARES.iter().map(|s| s * slip));
    }
    let all = memories.iter().flat_map(|m| stretches.iter().map(move |s| (*m, *s)));
    all.filter_map(|(memory, stretch)| fitted(record, law, memory, stretch, pieces))
        .filter(of_right_sign)
        .min_by(|a, b| a.fitted.total_cmp(&b.fitted))
}

/// Old contacts rub more, warm ones less, and what gives way shows less friction at first.
fn of_right_sign(fitted: &Fitted) -> bool {
    let Some((_, last, _)) = fitted.coefficients.last() else { return false };
    match fitted.law {
        Law::FrictionAgeing => *last > 0.0,
        Law::RigCompliance | Law::ThermalFriction => *last < 0.0,
        _ => true,
    }
}

/// The law with this memory \[m or s\] and this stretch \[m\]: even pieces are fitted, odd ones judged.
fn fitted(
    record: &FrictionRecord,
    law: Law,
    memory: Option<f64>,
    stretch: f64,
    pieces: &[usize],
) -> Option<Fitted> {
    let (names, rows) = design(record, law, memory, stretch);
    let fit: Vec<usize> = (0..pieces.len()).filter(|i| pieces[*i] % 2 == 0).collect();
    let judge: Vec<usize> = (0..pieces.len()).filter(|i| pieces[*i] % 2 == 1).collect();
    if fit.len() <= names.len() || judge.is_empty() {
        return None;
    }
    let values: Vec<f64> = record.samples.iter().map(|s| s.value).collect();
    let solved = LeastSquares::of(&rows, &values, &fit)?;
    let fitted = solved.error(&rows, &values, &fit);
    // Errors of one piece are one error.
    let alike = (fit.len() as f64 / (pieces.iter().max()? / 2 + 1) as f64).max(1.0);
    let told = |(j, name): (usize, &&'static str)| {
        (*name, solved.coefficient(j), solved.deviation(j, fitted, alike))
    };
    Some(Fitted {
        law,
        held_out: solved.error(&rows, &values, &judge),
        fitted,
        memory,
        stretch,
        coefficients: names.iter().enumerate().map(told).collect(),
        probability: 0.0,
        closed: 0.0,
    })
}

/// A solution of least squares, its columns scaled to one size so that the normal matrix is well conditioned.
struct LeastSquares {
    /// Size of each column.
    size: Vec<f64>,
    /// Coefficients of the scaled columns.
    scaled: DVector<f64>,
    /// Inverse of the normal matrix of the scaled columns.
    inverse: DMatrix<f64>,
}

impl LeastSquares {
    /// Of the values and the rows of factors at the places `of`; `None` where they do not determine it.
    fn of(rows: &[Vec<f64>], values: &[f64], of: &[usize]) -> Option<Self> {
        let count = rows.first()?.len();
        let x = DMatrix::from_fn(of.len(), count, |i, j| rows[of[i]][j]);
        let y = DVector::from_fn(of.len(), |i, _| values[of[i]]);
        let size: Vec<f64> = (0..count).map(|j| x.column(j).norm().max(1e-300)).collect();
        let scaled = DMatrix::from_fn(of.len(), count, |i, j| x[(i, j)] / size[j]);
        let normal = scaled.tr_mul(&scaled) + DMatrix::identity(count, count) * 1e-12;
        let factor = normal.cholesky()?;
        let solution = factor.solve(&scaled.tr_mul(&y));
        Some(Self { size, scaled: solution, inverse: factor.inverse() })
    }

    fn coefficient(&self, j: usize) -> f64 {
        self.scaled[j] / self.size[j]
    }

    /// Standard deviation of a coefficient where every `alike` samples with the same `error` are one.
    fn deviation(&self, j: usize, error: f64, alike: f64) -> f64 {
        error * (self.inverse[(j, j)] * alike).sqrt() / self.size[j]
    }

    /// Root mean square error at the places `of`.
    fn error(&self, rows: &[Vec<f64>], values: &[f64], of: &[usize]) -> f64 {
        let square = |i: &usize| {
            let scaled = rows[*i].iter().zip(&self.size).map(|(x, size)| x / size);
            let told: f64 = scaled.zip(&self.scaled).map(|(x, c)| x * c).sum();
            (values[*i] - told).powi(2)
        };
        (of.iter().map(square).sum::<f64>() / of.len() as f64).sqrt()
    }
}
