//! Columns of numbers from a CSV file, by their names.

use std::path::Path;

use crate::error::{Fault, Problem};

/// Most problems told of one file: a file that is wrong in every row needs no thousand lines.
const MOST: usize = 20;

/// Reads the columns `names` of a CSV file with a header; their order in the file does not matter,
/// and other columns are left alone. `remedy` tells who writes good files.
///
/// # Errors
/// [`Fault::File`], or all missing columns and unreadable cells (at most 20).
pub fn read(path: &Path, names: &[&str], remedy: &str) -> Result<Vec<Vec<f64>>, Fault> {
    let fault = |reason: String| Fault::File { path: path.display().to_string(), reason };
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| fault(reason(&e)))?;
    let header = reader.headers().map_err(|e| fault(reason(&e)))?.clone();
    let file = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let places = places(&file, names, &header, remedy)?;
    let mut columns = vec![Vec::new(); names.len()];
    let mut problems = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(reason(&e)))?;
        let line = record.position().map_or(0, csv::Position::line);
        for ((column, &place), name) in columns.iter_mut().zip(&places).zip(names) {
            let cell = record.get(place).unwrap_or("missing");
            match cell.parse::<f64>() {
                Ok(number) if number.is_finite() => column.push(number),
                _ => problems.push(Problem::new(
                    format!("{file}: column {name}, line {line}"),
                    cell,
                    "a finite number with a decimal point",
                    "mend the cell or drop the line",
                )),
            }
        }
        if problems.len() >= MOST {
            break;
        }
    }
    if problems.is_empty() {
        Ok(columns)
    } else {
        Err(Fault::Invalid(problems))
    }
}

/// Where in the header each name stands; all missing ones are told at once.
fn places(
    file: &str,
    names: &[&str],
    header: &csv::StringRecord,
    remedy: &str,
) -> Result<Vec<usize>, Fault> {
    let place = |name: &str| header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
    let missing: Vec<Problem> = names
        .iter()
        .filter(|name| place(name).is_none())
        .map(|name| {
            let found = header.iter().take(8).collect::<Vec<_>>().join(",");
            Problem::new(
                format!("{file}: column {name}"),
                format!("missing; the header begins with {found:?}"),
                "a column of that name, separated by commas",
                remedy,
            )
        })
        .collect();
    if missing.is_empty() {
        Ok(names.iter().filter_map(|name| place(name)).collect())
    } else {
        Err(Fault::Invalid(missing))
    }
}

/// The system's own words where the file could not be read.
fn reason(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Io(io) => io.to_string(),
        _ => error.to_string(),
    }
}
