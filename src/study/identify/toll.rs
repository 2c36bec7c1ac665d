//! What a walk minimises: the cost of the searches on three tables, and what exceeds the aims.

use super::objective::{Problem, TILT};
use crate::study::paper::{Cell, SPEEDS};

/// What is asked of one of the tables.
struct Member {
    /// Weight of its cells.
    weight: f64,
    /// Largest error of a cell that costs nothing more.
    largest: f64,
    /// What a cell that exceeds it can cost more at most: a jump to another limit cycle is no worse than a large error.
    most: f64,
}

/// The table as it is, and those with the fall of friction one per cent up and down.
const MEMBERS: [Member; 3] = [
    Member { weight: 1.0, largest: 0.057, most: 12.0 },
    Member { weight: 0.5, largest: 0.095, most: 6.0 },
    Member { weight: 0.5, largest: 0.095, most: 6.0 },
];

/// Median error that costs nothing more.
const MEDIAN: f64 = 0.0195;
/// Excess of the median that costs as much as an excess of one per cent of a cell.
const MEDIAN_UNIT: f64 = 0.002;
/// Share by which a frequency must rise from one speed to the next.
const RISE: f64 = 0.004;
/// Weight of two frequencies that are alike, and what all such may cost at most.
const FLAT: [f64; 2] = [0.5, 1.5];

/// Toll of the cells of one table, or of its last cells only.
pub fn part(residuals: &[f64], cells: &[Cell], member: usize) -> f64 {
    let Member { weight, largest, most } = MEMBERS[member];
    let cells = &cells[cells.len() - residuals.len()..];
    let excess: f64 =
        errors(residuals, cells).map(|e| ((e - largest).max(0.0) / 0.01).powi(2).min(most)).sum();
    weight * (Problem::cost(residuals, &[]) + excess)
}

/// Toll of all tables.
pub fn toll(tables: &[Vec<f64>], cells: &[Cell]) -> f64 {
    let parts: f64 = tables.iter().enumerate().map(|(member, r)| part(r, cells, member)).sum();
    let Some(first) = tables.first() else { return f64::INFINITY };
    let mut errors: Vec<f64> = errors(first, cells).collect();
    errors.sort_by(f64::total_cmp);
    let n = errors.len().max(1);
    let median = 0.5 * (errors[n / 2] + errors[(n - 1) / 2]);
    parts + (median - MEDIAN).max(0.0) / MEDIAN_UNIT + flatness(first, cells)
}

/// Magnitudes of the relative errors of the legible cells; a cell that is silent and should not be stands with the
/// residual that it has.
fn errors<'r>(residuals: &'r [f64], cells: &'r [Cell]) -> impl Iterator<Item = f64> + 'r {
    let legible = |cell: &Cell| matches!(cell, Cell::Hz(_));
    residuals.iter().zip(cells).filter(move |(_, c)| legible(c)).map(|(r, _)| r.exp_m1().abs())
}

/// Toll of frequencies that do not rise with the speed by [`RISE`].
fn flatness(residuals: &[f64], cells: &[Cell]) -> f64 {
    let hz: Vec<Option<f64>> =
        residuals.iter().zip(cells).map(|(r, c)| frequency(*r, *c)).collect();
    let sum: f64 = hz
        .chunks(SPEEDS.len())
        .flat_map(|column| column.windows(2))
        .filter_map(|pair| Some(pair[1]? / pair[0]?))
        .map(|ratio| (1.0 + RISE - ratio).max(0.0) / RISE)
        .sum();
    (FLAT[0] * sum).min(FLAT[1])
}

/// Frequency \[Hz\] that a residual stands for; none where the paper's block is silent.
fn frequency(residual: f64, cell: Cell) -> Option<f64> {
    match cell {
        Cell::Hz(paper) => Some(paper * residual.exp()),
        Cell::Between(low, high) => {
            Some(((low * high).sqrt() * (residual / TILT).exp()).clamp(low, high))
        }
        Cell::Silent => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::paper::TABLE_1;

    #[test]
    fn the_papers_own_frequencies_cost_nothing() {
        // Table 1 rises in every column, and its own residuals are zero.
        let cells: Vec<Cell> = TABLE_1.iter().flat_map(|c| c.cells).collect();
        assert_eq!(toll(&vec![vec![0.0; cells.len()]; 3], &cells), 0.0);
    }

    #[test]
    fn a_cell_beyond_the_aim_costs_the_square_of_its_excess() {
        // 7.7 % is two per cent beyond 5.7 %: 2² = 4 beside the cost of the searches, once in the first table.
        let cells = TABLE_1[0].cells;
        let mut residuals = vec![0.0; 7];
        residuals[2] = 1.077_f64.ln();
        let more = part(&residuals, &cells, 0) - Problem::cost(&residuals, &[]);
        assert!((more - 4.0).abs() < 1e-9, "{more}");
    }

    #[test]
    fn two_frequencies_that_are_alike_cost_half() {
        let mut residuals = vec![0.0; 7];
        residuals[3] = (787.0_f64 / 1195.0).ln();
        assert!((flatness(&residuals, &TABLE_1[0].cells) - 0.5).abs() < 1e-9);
    }
}
