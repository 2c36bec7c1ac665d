//! What a walk minimises: the cost of the searches, and what exceeds the aims, also one per cent beside.

use super::objective::{Problem, TILT};
use crate::study::paper::{Cell, SPEEDS};

/// What is asked of a table.
struct Aim {
    /// Largest error of a cell that costs nothing more.
    largest: f64,
    /// What a cell can cost more at most, and what a wrong one costs: a jump to another limit cycle is no worse than a
    /// large error.
    most: f64,
    /// Weight.
    weight: f64,
}

/// Of the table as it is.
const AS_IT_IS: Aim = Aim { largest: 0.057, most: 40.0, weight: 1.0 };
/// Of a table with friction or damping changed by one per cent.
const CHANGED: Aim = Aim { largest: 0.095, most: 5.0, weight: 0.5 };

/// Median error that costs nothing more: of the table as it is, and of one with friction or damping changed.
const MEDIANS: [f64; 2] = [0.0195, 0.035];
/// Excess of the median that costs as much as an excess of one per cent of a cell.
const MEDIAN_UNIT: f64 = 0.002;
/// Share by which a frequency must rise from one speed to the next.
const RISE: f64 = 0.004;
/// Weight of two frequencies that are alike, and what all such may cost at most.
const FLAT: [f64; 2] = [0.5, 1.5];

/// Toll of the cells of a table, or of its last cells only; the first table is that as it is.
pub fn part(residuals: &[f64], cells: &[Cell], table: usize) -> f64 {
    let cells = &cells[cells.len() - residuals.len()..];
    let (aim, cost) = match table {
        0 => (AS_IT_IS, Problem::cost(residuals, &[])),
        _ => (CHANGED, 0.0),
    };
    let excess: f64 = residuals.iter().zip(cells).map(|(r, cell)| aim.excess(*r, *cell)).sum();
    aim.weight * (cost + excess)
}

/// Toll of a whole table beyond that of its cells: of the median, and of frequencies that do not rise in the first table,
/// which is that as it is.
pub fn whole(residuals: &[f64], cells: &[Cell], table: usize) -> f64 {
    let legible = residuals.iter().zip(cells).filter(|(_, c)| matches!(c, Cell::Hz(_)));
    let mut errors: Vec<f64> = legible.map(|(r, _)| r.exp_m1().abs()).collect();
    errors.sort_by(f64::total_cmp);
    let median = match errors.len() {
        0 => 0.0,
        n => 0.5 * (errors[n / 2] + errors[(n - 1) / 2]),
    };
    match table {
        0 => (median - MEDIANS[0]).max(0.0) / MEDIAN_UNIT + flatness(residuals, cells),
        _ => CHANGED.weight * (median - MEDIANS[1]).max(0.0) / MEDIAN_UNIT,
    }
}

impl Aim {
    /// What a cell costs beyond the aim: one for the first per cent, four for two.
    fn excess(&self, residual: f64, cell: Cell) -> f64 {
        let error = residual.exp_m1().abs();
        match cell {
            Cell::Hz(_) => ((error - self.largest).max(0.0) / 0.01).powi(2).min(self.most),
            // The residual of a cell that is right is none, or a little where digits are lost.
            Cell::Between(..) | Cell::Silent if error > self.largest => self.most,
            Cell::Between(..) | Cell::Silent => 0.0,
        }
    }
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
        let none = vec![0.0; cells.len()];
        assert_eq!(part(&none, &cells, 0) + part(&none, &cells, 1) + whole(&none, &cells, 0), 0.0);
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
