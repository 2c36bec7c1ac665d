//! CSV files as loggers write them: any delimiter, decimal comma, lines before the header, units in
//! the header, Latin-1.

use std::path::Path;

use serde::Deserialize;

use crate::error::Problem;

/// Most problems told of one column.
const MOST: usize = 5;

/// How the files are written.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Dialect {
    /// Between cells.
    pub delimiter: char,
    /// Within numbers.
    pub decimal: char,
    /// Lines before the header.
    pub skip_lines: usize,
}

impl Default for Dialect {
    fn default() -> Self {
        Self { delimiter: ',', decimal: '.', skip_lines: 0 }
    }
}

/// A file as rows of text under a header.
#[derive(Clone, Debug)]
pub struct Table {
    /// Name for messages.
    pub file: String,
    /// Names of the columns and their units, where the header has them.
    pub header: Vec<(String, Option<String>)>,
    /// Was it read as Latin-1 because it is no UTF-8?
    pub latin_1: bool,
    rows: Vec<(u64, csv::StringRecord)>,
    decimal: char,
}

/// Reads a file; `name` is what messages call it.
///
/// # Errors
/// What the system or the CSV reader says.
pub fn read(path: &Path, name: &str, dialect: &Dialect) -> Result<Table, Problem> {
    let unreadable = |reason: String| {
        Problem::new(name, reason, "a readable CSV file", "mend the path or [source] of the plan")
    };
    let bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    let (text, latin_1) = match String::from_utf8(bytes) {
        Ok(text) => (text, false),
        // Latin-1 is the first 256 code points.
        Err(e) => (e.as_bytes().iter().map(|b| char::from(*b)).collect(), true),
    };
    let text = text.trim_start_matches('\u{feff}');
    let body: String = text.split_inclusive('\n').skip(dialect.skip_lines).collect();
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(u8::try_from(dialect.delimiter).unwrap_or(b','))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(body.as_bytes());
    let header = reader.headers().map_err(|e| unreadable(e.to_string()))?;
    let header = header.iter().map(name_and_unit).collect();
    let skipped = dialect.skip_lines as u64;
    let mut rows = Vec::new();
    for row in reader.records() {
        let row = row.map_err(|e| unreadable(e.to_string()))?;
        rows.push((skipped + row.position().map_or(0, csv::Position::line), row));
    }
    Ok(Table { file: name.to_string(), header, latin_1, rows, decimal: dialect.decimal })
}

/// `Fx [kN]` or `Fx (kN)` as name and unit.
fn name_and_unit(cell: &str) -> (String, Option<String>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = cell.strip_suffix(close).and_then(|c| c.rsplit_once(open)) {
            let unit = unit.trim();
            return (name.trim().to_string(), Some(unit.to_string()).filter(|u| !u.is_empty()));
        }
    }
    (cell.trim().to_string(), None)
}

impl Table {
    /// Where a column stands; `what` says which key of the plan asks for it.
    ///
    /// # Errors
    /// No column of that name, or several.
    pub fn place(&self, what: &str, column: &str) -> Result<usize, Problem> {
        let places: Vec<usize> =
            (0..self.header.len()).filter(|i| self.header[*i].0 == column).collect();
        match places.as_slice() {
            [place] => Ok(*place),
            [] => {
                let names: Vec<&str> = self.header.iter().map(|h| h.0.as_str()).collect();
                Err(Problem::new(
                    format!("{}: {what}", self.file),
                    format!("no column {column:?}"),
                    format!("one of {}", names.join(", ")),
                    "name the column as the header does",
                ))
            }
            several => Err(Problem::new(
                format!("{}: {what}", self.file),
                format!("{} columns are called {column:?}", several.len()),
                "a name that is there once",
                "rename one of them in the file",
            )),
        }
    }

    /// The numbers of two columns row by row; rows at the end where either is empty end the channel.
    ///
    /// # Errors
    /// Cells that are no finite numbers, at most five and how many more.
    pub fn pairs(&self, places: [usize; 2]) -> Result<[Vec<f64>; 2], Vec<Problem>> {
        let cell = |row: &csv::StringRecord, place: usize| -> Option<f64> {
            let text = row.get(place).unwrap_or("");
            let text =
                if self.decimal == '.' { text.into() } else { text.replace(self.decimal, ".") };
            text.parse::<f64>().ok().filter(|n| n.is_finite())
        };
        let empty =
            |row: &csv::StringRecord| places.iter().any(|p| row.get(*p).unwrap_or("").is_empty());
        let count = self.rows.iter().rposition(|(_, row)| !empty(row)).map_or(0, |last| last + 1);
        let mut columns = [Vec::with_capacity(count), Vec::with_capacity(count)];
        let (mut problems, mut bad) = (Vec::new(), 0);
        for (line, row) in &self.rows[..count] {
            for (column, place) in columns.iter_mut().zip(places) {
                if let Some(number) = cell(row, place) {
                    column.push(number);
                    continue;
                }
                bad += 1;
                if bad <= MOST {
                    problems.push(Problem::new(
                        format!("{}: column {}, line {line}", self.file, self.header[place].0),
                        format!("{:?}", row.get(place).unwrap_or("")),
                        format!("a finite number with a decimal {:?}", self.decimal),
                        "mend the cell; nothing is put in its place",
                    ));
                }
            }
        }
        if bad > MOST {
            problems.push(Problem::new(
                format!("{}: further bad cells", self.file),
                (bad - MOST).to_string(),
                "none",
                "look at [source] of the plan: delimiter, decimal, skip_lines",
            ));
        }
        if problems.is_empty() {
            Ok(columns)
        } else {
            Err(problems)
        }
    }
}
