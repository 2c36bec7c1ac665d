//! What the paper says in numbers: Kröger and Moldenhauer, ISMA 2010.

/// Sliding speeds of Table 1 \[m/s\].
pub const SPEEDS: [f64; 7] = [0.080, 0.100, 0.200, 0.300, 0.400, 0.500, 0.600];

/// Mean pressure of the paper's base case \[Pa\]; Table 1 states none, so it is taken for it, too.
pub const PRESSURE: f64 = 250e3;

/// One cell of Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// Stick-slip frequency \[Hz\].
    Hz(f64),
    /// The digits are lost; the frequency \[Hz\] lies between these two.
    Between(f64, f64),
    /// No oscillation.
    Silent,
}

impl Cell {
    /// The frequency \[Hz\] where it is legible, 0 where the block is silent.
    pub fn hz(self) -> Option<f64> {
        match self {
            Self::Hz(hz) => Some(hz),
            Self::Silent => Some(0.0),
            Self::Between(..) => None,
        }
    }
}

/// One column of Table 1: a geometry with its frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Short name, as the command line takes it.
    pub name: &'static str,
    /// Height of the block \[m\].
    pub height: f64,
    /// Length of the block \[m\].
    pub length: f64,
    /// First eigenfrequency of the free block \[Hz\]; lost for the first column.
    pub f0: Option<f64>,
    /// Stick-slip at [`SPEEDS`].
    pub cells: [Cell; 7],
}

use Cell::{Between, Hz, Silent};

/// Table 1, "Influence of sliding velocity and geometry on the stick-slip frequency".
pub const TABLE_1: [Column; 4] = [
    Column {
        name: "h10l15",
        height: 0.010,
        length: 0.015,
        f0: None,
        cells: [Hz(299.0), Hz(373.0), Hz(787.0), Hz(1195.0), Hz(1759.0), Hz(2123.0), Hz(2304.0)],
    },
    Column {
        name: "h6l15",
        height: 0.006,
        length: 0.015,
        f0: Some(4590.0),
        cells: [Hz(1492.0), Hz(1961.0), Hz(3953.0), Hz(4546.0), Silent, Silent, Silent],
    },
    Column {
        name: "h10l45",
        height: 0.010,
        length: 0.045,
        f0: Some(2876.0),
        // "Hz" without digits at 400 mm/s: more than at 300 mm/s, less than the eigenfrequency.
        cells: [
            Hz(413.0),
            Hz(565.0),
            Hz(1355.0),
            Hz(2597.0),
            Between(2597.0, 2876.0),
            Silent,
            Silent,
        ],
    },
    Column {
        name: "h6l45",
        height: 0.006,
        length: 0.045,
        f0: Some(4919.0),
        cells: [Hz(2128.0), Hz(2667.0), Hz(4525.0), Hz(4717.0), Silent, Silent, Silent],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_1_has_the_extreme_frequencies_that_the_text_names() {
        // "the frequency range ... is very broad from 299 Hz up to 4717 Hz".
        let all: Vec<f64> = TABLE_1
            .iter()
            .flat_map(|c| c.cells)
            .filter_map(|cell| match cell {
                Hz(hz) => Some(hz),
                _ => None,
            })
            .collect();
        assert_eq!(all.iter().copied().fold(f64::INFINITY, f64::min), 299.0);
        assert_eq!(all.iter().copied().fold(0.0, f64::max), 4717.0);
    }

    #[test]
    fn no_frequency_exceeds_the_free_blocks_eigenfrequency() {
        for column in TABLE_1 {
            for cell in column.cells {
                if let (Hz(hz), Some(f0)) = (cell, column.f0) {
                    assert!(hz <= f0, "{}: {hz} Hz above {f0} Hz", column.name);
                }
            }
        }
    }
}
