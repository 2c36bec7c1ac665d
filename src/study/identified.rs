//! The compound identified from Table 1, and what its identification said: files that `tread identify` wrote.

use super::identify::laws::CSV_HEADER;
use crate::error::Fault;
use crate::params::{load, Params};

/// The compound: the default of the studies.
pub const PAPER: &str = include_str!("../../compounds/paper.toml");
/// Its parameters with their uncertainty, `parameters.csv` of the identification.
const PARAMETERS: &str = include_str!("../../compounds/paper-parameters.csv");
/// What the table pins down and what not, `directions.csv` of the identification.
const DIRECTIONS: &str = include_str!("../../compounds/paper-directions.csv");
/// Friction laws at equal effort, `laws.csv` of `tread identify --laws`.
const LAWS: &str = include_str!("../../compounds/paper-laws.csv");

/// What the identification of the paper's compound left, for the report.
#[derive(Clone, Debug)]
pub struct Identification {
    /// Which law is the best, in words.
    pub notes: String,
    /// Tables: file name and CSV.
    pub tables: Vec<(String, String)>,
}

/// The paper's compound.
///
/// # Errors
/// What a parameter file can have wrong.
pub fn paper() -> Result<Params, Fault> {
    load::from_toml(PAPER)
}

/// What is known of the identification of `compound`: nothing if it is not the paper's.
pub fn of(compound: &Params) -> Option<Identification> {
    (paper().ok()? == *compound).then(|| Identification {
        notes: best_law(LAWS),
        tables: vec![
            ("table-1-parameters.csv".to_string(), PARAMETERS.to_string()),
            ("table-1-directions.csv".to_string(), DIRECTIONS.to_string()),
            ("table-1-laws.csv".to_string(), LAWS.to_string()),
        ]
        .into_iter()
        .filter(|(_, csv)| csv.lines().count() > 1)
        .collect(),
    })
}

/// The best law and by how much it beats the others, from the comparison's CSV, which has the best first.
fn best_law(csv: &str) -> String {
    let column = |name: &str| CSV_HEADER.split(',').position(|c| c == name).unwrap_or(0);
    let [law, cost, median, largest, wrong] =
        ["law", "cost", "median", "largest", "wrong_cells"].map(column);
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let number = |row: &[&str], at: usize| row[at].parse::<f64>().unwrap_or(f64::NAN);
    let told: Vec<String> = rows
        .iter()
        .map(|row| {
            format!(
                "{} (cost {:.1}, median {:.1} %, largest {:.1} %, {} wrong)",
                row[law],
                number(row, cost),
                100.0 * number(row, median),
                100.0 * number(row, largest),
                row[wrong]
            )
        })
        .collect();
    let Some((best, others)) = told.split_first() else { return String::new() };
    format!("Friction laws at equal effort: the best is {best}; then {}.\n", others.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::identify::space::{get, unknowns};

    #[test]
    fn what_is_told_of_the_identification_is_that_of_the_compound() {
        // The table of parameters was written by the identification of the compound: the same values to the digits that
        // it has. Until one has been run on a new compound, the table has its header only.
        let paper = paper().unwrap();
        let names: Vec<&str> = unknowns(paper.friction.form).iter().map(|u| u.name).collect();
        let rows: Vec<Vec<&str>> =
            PARAMETERS.lines().skip(1).map(|line| line.split(',').collect()).collect();
        if !rows.is_empty() {
            assert_eq!(rows.iter().map(|r| r[0]).collect::<Vec<_>>(), names);
        }
        for row in rows {
            let value: f64 = row[1].parse().unwrap();
            assert!((value / get(&paper, row[0]) - 1.0).abs() < 1e-4, "{row:?}");
        }
    }

    #[test]
    fn the_best_law_is_named_first() {
        let csv =
            format!("{CSV_HEADER}\na,3,0,0,0,0,2.0,0.01,0.05,0\nb,3,0,0,0,0,5.0,0.02,0.1,1\n");
        let told = "Friction laws at equal effort: the best is a (cost 2.0, median 1.0 %, largest 5.0 %, 0 wrong); \
                    then b (cost 5.0, median 2.0 %, largest 10.0 %, 1 wrong).\n";
        assert_eq!(best_law(&csv), told);
    }
}
