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
    let slip = record.since.iter().copied().fold(0.0, f64::max);
    let time = record.since_time.iter().copied().fold(0.0, f64::max);
    let memories: Vec<Option<f64>> = match law {
        Law::FrictionAgeing => SHARES.iter().map(|s| Some(s * slip)).collect(),
        Law::RigCompliance if record.piston => SHARES.iter().map(|s| Some(s * slip)).collect(),
        Law::ThermalFriction => SHARES.iter().map(|s| Some(s * time)).collect(),
        Law::RigCompliance => return None,
        Law::Adhesion if record.pressure.is_none() => return None,
        _ => vec![None],
    };
    // A stiff rig hands a change of the speed on at once.
    let mut stretches = vec![0.0];
    if !record.piston {
        stretches.extend(SHARES.iter().map(|s| s * slip));
    }
    let all = memories.iter().flat_map(|m| stretches.iter().map(move |s| (*m, *s)));
    all.filter_map(|(memory, stretch)| one(record, law, memory, stretch, pieces))
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
fn one(
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
    let x = DMatrix::from_fn(fit.len(), names.len(), |i, j| rows[fit[i]][j]);
    let y = DVector::from_fn(fit.len(), |i, _| record.value[fit[i]]);
    // Columns to one size, so that the normal matrix is well conditioned.
    let size: Vec<f64> = (0..names.len()).map(|j| x.column(j).norm().max(1e-300)).collect();
    let scaled = DMatrix::from_fn(fit.len(), names.len(), |i, j| x[(i, j)] / size[j]);
    let normal = scaled.tr_mul(&scaled) + DMatrix::identity(names.len(), names.len()) * 1e-12;
    let factor = normal.cholesky()?;
    let solution = factor.solve(&scaled.tr_mul(&y));
    let error = |of: &[usize]| {
        let sum: f64 = of
            .iter()
            .map(|i| {
                let told: f64 = (0..names.len()).map(|j| rows[*i][j] / size[j] * solution[j]).sum();
                (record.value[*i] - told).powi(2)
            })
            .sum();
        (sum / of.len() as f64).sqrt()
    };
    let fitted = error(&fit);
    let inverse = factor.inverse();
    // Errors of one piece are one error.
    let independent = (fit.len() as f64 / (pieces.iter().max()? / 2 + 1) as f64).max(1.0);
    let coefficients = names
        .iter()
        .enumerate()
        .map(|(j, name)| {
            let deviation = fitted * (inverse[(j, j)] * independent).sqrt() / size[j];
            (*name, solution[j] / size[j], deviation)
        })
        .collect();
    Some(Fitted {
        law,
        held_out: error(&judge),
        fitted,
        memory,
        stretch,
        coefficients,
        probability: 0.0,
        closed: 0.0,
    })
}
