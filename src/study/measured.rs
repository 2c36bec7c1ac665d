//! Measured grids that the studies draw beside the model: the user's own, or the project's examples.

use std::path::Path;

use crate::error::{Fault, Problem};

/// A quantity over pressure and sliding speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Pressure \[Pa\], sliding speed \[m/s\], quantity (μ \[-\], or wear rate \[kg/m³\]).
    pub points: Vec<[f64; 3]>,
    /// Where it comes from, as a sentence for the report.
    pub origin: String,
}

/// A measured approach of a block and the force that presses it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Approach \[m\], force \[N\].
    pub points: Vec<[f64; 2]>,
    /// Where it comes from.
    pub origin: String,
}

/// What is measured, for all studies.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    /// Friction coefficient.
    pub friction: Grid,
    /// Wear rate: mass worn per area and sliding distance.
    pub wear: Grid,
    /// Contact stiffness of a block of h 10 mm, l 15 mm.
    pub stiffness: Curve,
}

/// Example of a measured characteristic: made up from a falling characteristic with 3 % scatter, only to
/// show the format.
const FRICTION: &str = include_str!("../../examples/friction-grid.csv");
/// Example of a measured wear rate: made up around the published range, only to show the format.
const WEAR: &str = include_str!("../../examples/wear-rate.csv");
/// Example of a measured stiffness: made up from a power of the approach with 3 % scatter, only to show the format.
const STIFFNESS: &str = include_str!("../../examples/stiffness.csv");

/// What is said of an example.
const MADE_UP: &str =
    "an example made up to show the format; the paper's own data are not published";

impl Measurements {
    /// The data of these files (CSV with a header line: pressure_pa, speed_m_s, and mu or rate_kg_m3; or
    /// approach_m, force_n), the examples where none is given.
    ///
    /// # Errors
    /// [`Fault::File`] for a file that cannot be read, [`Fault::Invalid`] with all its bad lines.
    pub fn new(
        friction: Option<&Path>,
        wear: Option<&Path>,
        stiffness: Option<&Path>,
    ) -> Result<Self, Fault> {
        let (points, origin) = data(stiffness, STIFFNESS, stiffness_line)?;
        let stiffness = Curve { points, origin };
        Ok(Self { friction: grid(friction, FRICTION)?, wear: grid(wear, WEAR)?, stiffness })
    }
}

fn grid(path: Option<&Path>, example: &str) -> Result<Grid, Fault> {
    let (points, origin) = data(path, example, grid_line)?;
    Ok(Grid { points, origin })
}

/// A line of a grid: positive pressure and speed, a finite quantity.
fn grid_line(cells: &[f64]) -> Result<[f64; 3], &'static str> {
    match *cells {
        [p, v, value] if p > 0.0 && v > 0.0 && value.is_finite() => Ok([p, v, value]),
        _ => Err("pressure [Pa] > 0, sliding speed [m/s] > 0, and the measured number"),
    }
}

/// A line of a stiffness.
fn stiffness_line(cells: &[f64]) -> Result<[f64; 2], &'static str> {
    match *cells {
        [u, force] if u.is_finite() && force >= 0.0 => Ok([u, force]),
        _ => Err("approach [m] and force [N], not negative"),
    }
}

/// The points of a file, or of the example, and where they come from.
fn data<const N: usize>(
    path: Option<&Path>,
    example: &str,
    line: fn(&[f64]) -> Result<[f64; N], &'static str>,
) -> Result<(Vec<[f64; N]>, String), Fault> {
    let Some(path) = path else {
        return Ok((points("example", example, line)?, MADE_UP.to_string()));
    };
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
    Ok((points(&name, &text, line)?, name))
}

/// Reads the lines after the header.
fn points<const N: usize>(
    name: &str,
    text: &str,
    read: fn(&[f64]) -> Result<[f64; N], &'static str>,
) -> Result<Vec<[f64; N]>, Fault> {
    let (mut points, mut problems) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate().skip(1).filter(|(_, l)| !l.trim().is_empty()) {
        // A cell that is no number makes the line bad, wherever it stands.
        let cells: Vec<f64> =
            line.split(',').map(|c| c.trim().parse().unwrap_or(f64::NAN)).collect();
        match read(&cells) {
            Ok(point) => points.push(point),
            Err(allowed) => problems.push(Problem::new(
                format!("{name} line {}", number + 1),
                line,
                allowed,
                "mend or delete the line",
            )),
        }
    }
    if points.is_empty() {
        problems.push(Problem::new(name, "no points", "one or more lines", "give measured lines"));
    }
    if problems.is_empty() {
        Ok(points)
    } else {
        Err(Fault::Invalid(problems))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_are_read_whole_and_every_bad_line_is_named() {
        let both = Measurements::new(None, None, None).unwrap();
        assert_eq!(both.friction.points.len(), FRICTION.lines().count() - 1);
        assert_eq!(both.wear.points.len(), WEAR.lines().count() - 1);
        assert_eq!(both.stiffness.points.len(), STIFFNESS.lines().count() - 1);
        let text = "pressure_pa,speed_m_s,mu\n1e5,0.1,0.9\n1e5,-0.1,0.9\n1e5,fast,1\n";
        let Err(Fault::Invalid(problems)) = points("mine.csv", text, grid_line) else {
            panic!("accepted")
        };
        assert_eq!(problems.len(), 2);
    }
}
