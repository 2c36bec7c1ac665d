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
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| fault(path, &e))?;
    let header = reader.headers().map_err(|e| fault(path, &e))?.clone();
    let file = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let places = places(&file, names, &header, remedy)?;
    let mut columns = vec![Vec::new(); names.len()];
    let mut problems = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(path, &e))?;
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

/// Most missing columns told by name.
const MOST_NAMES: usize = 6;

/// Where in the header each name stands; all missing ones are one problem.
fn places(
    file: &str,
    names: &[&str],
    header: &csv::StringRecord,
    remedy: &str,
) -> Result<Vec<usize>, Fault> {
    let place = |name: &str| header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
    let missing: Vec<&str> = names.iter().copied().filter(|name| place(name).is_none()).collect();
    if missing.is_empty() {
        return Ok(names.iter().filter_map(|name| place(name)).collect());
    }
    if header.is_empty() {
        let allowed = format!("a header with {}, and numbers below it", listed(names));
        return Err(Fault::one(Problem::new(file, "an empty file", allowed, remedy)));
    }
    let found: Vec<&str> = header.iter().collect();
    let plural = if missing.len() == 1 { "" } else { "s" };
    Err(Fault::one(Problem::new(
        format!("{file}: column{plural} {}", listed(&missing)),
        format!("missing; the header has {}", listed(&found)),
        "columns of these names, separated by commas",
        remedy,
    )))
}

/// Names with commas between them; the first few where they are many.
fn listed(names: &[&str]) -> String {
    let first = names[..names.len().min(MOST_NAMES)].join(", ");
    match names.len().saturating_sub(MOST_NAMES) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

/// A file that is no CSV, or that the system could not read.
fn fault(path: &Path, error: &csv::Error) -> Fault {
    match error.kind() {
        csv::ErrorKind::Io(io) => Fault::file(path, io),
        _ => Fault::unusable(path, format!("{error}; save it as CSV in UTF-8")),
    }
}
