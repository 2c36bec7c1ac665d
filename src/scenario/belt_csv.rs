//! Belt paths as CSV: time_s, belt_x_m, belt_z_m, belt_angle_rad.

use std::io::Write;
use std::path::Path;

use super::BeltSample;
use crate::columns;
use crate::error::Fault;

/// Columns of a belt file, in the order in which they are written; read in any order.
pub const COLUMNS: [&str; 4] = ["time_s", "belt_x_m", "belt_z_m", "belt_angle_rad"];

/// Reads a belt file.
///
/// # Errors
/// [`Fault::File`], or all missing columns and unreadable cells.
pub fn read(path: &Path) -> Result<Vec<BeltSample>, Fault> {
    let columns = columns::read(path, &COLUMNS, "`tread belt` writes such a file")?;
    let sample = |i: usize| BeltSample {
        time: columns[0][i],
        x: columns[1][i],
        z: columns[2][i],
        angle: columns[3][i],
    };
    Ok((0..columns[0].len()).map(sample).collect())
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
