//! Belt paths as CSV: time_s, belt_x_m, belt_z_m, belt_angle_rad.

use std::io::Write;
use std::path::Path;

use super::BeltSample;
use crate::error::{Fault, Problem};

/// Columns of a belt file, in the order in which they are written; read in any order.
pub const COLUMNS: [&str; 4] = ["time_s", "belt_x_m", "belt_z_m", "belt_angle_rad"];

/// Most problems told of one file: a file that is wrong in every row needs no thousand lines.
const MOST: usize = 20;

/// Reads a belt file.
///
/// # Errors
/// [`Fault::File`], or all missing columns and unreadable cells.
pub fn read(path: &Path) -> Result<Vec<BeltSample>, Fault> {
    let file_fault = |reason: String| Fault::File { path: path.display().to_string(), reason };
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| file_fault(e.to_string()))?;
    let header = reader.headers().map_err(|e| file_fault(e.to_string()))?.clone();
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let places = columns(&name, &header)?;
    let mut samples = Vec::new();
    let mut problems = Vec::new();
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|e| file_fault(e.to_string()))?;
        let mut cells = [0.0; 4];
        for ((cell, &place), column) in cells.iter_mut().zip(&places).zip(COLUMNS) {
            let text = record.get(place).unwrap_or("missing");
            match text.parse::<f64>() {
                Ok(number) if number.is_finite() => *cell = number,
                _ => problems.push(Problem::new(
                    format!("{name}: column {column}, line {}", row + 2),
                    text,
                    "a finite number with a decimal point",
                    "mend the cell or drop the line",
                )),
            }
        }
        let [time, x, z, angle] = cells;
        samples.push(BeltSample { time, x, z, angle });
        if problems.len() >= MOST {
            break;
        }
    }
    if problems.is_empty() {
        Ok(samples)
    } else {
        Err(Fault::Invalid(problems))
    }
}

fn columns(file: &str, header: &csv::StringRecord) -> Result<[usize; 4], Fault> {
    let mut places = [0; 4];
    let mut problems = Vec::new();
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        match header.iter().position(|h| h.trim_start_matches('\u{feff}') == column) {
            Some(at) => *place = at,
            None => problems.push(Problem::new(
                format!("{file}: column {column}"),
                format!("missing; the header is {:?}", header.iter().collect::<Vec<_>>().join(",")),
                COLUMNS.join(", "),
                "name the columns so, separated by commas; `tread belt` writes such a file",
            )),
        }
    }
    if problems.is_empty() {
        Ok(places)
    } else {
        Err(Fault::Invalid(problems))
    }
}

/// Writes a belt path.
///
/// # Errors
/// What the writer says.
pub fn write(samples: &[BeltSample], out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "{}", COLUMNS.join(","))?;
    for s in samples {
        writeln!(out, "{:.9},{:.12},{:.12},{:.12}", s.time, s.x, s.z, s.angle)?;
    }
    Ok(())
}
