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

/// The grids of all studies.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    /// Friction coefficient.
    pub friction: Grid,
    /// Wear rate: mass worn per area and sliding distance.
    pub wear: Grid,
}

/// Example of a measured characteristic: made up from a falling characteristic with 3 % scatter, only to
/// show the format.
const FRICTION: &str = include_str!("../../examples/friction-grid.csv");
/// Example of a measured wear rate: made up around the published range, only to show the format.
const WEAR: &str = include_str!("../../examples/wear-rate.csv");

impl Measurements {
    /// The grids of these files (CSV with a header line: pressure_pa, speed_m_s, and mu or
    /// rate_kg_m3), the examples where none is given.
    ///
    /// # Errors
    /// [`Fault::File`] for a file that cannot be read, [`Fault::Invalid`] with all its bad lines.
    pub fn new(friction: Option<&Path>, wear: Option<&Path>) -> Result<Self, Fault> {
        Ok(Self { friction: grid(friction, FRICTION)?, wear: grid(wear, WEAR)? })
    }
}

fn grid(path: Option<&Path>, example: &str) -> Result<Grid, Fault> {
    let Some(path) = path else {
        let origin =
            "an example made up to show the format; the paper's own data are not published";
        return Ok(Grid { points: points("example", example)?, origin: origin.to_string() });
    };
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|e| Fault::File { path: name.clone(), reason: e.to_string() })?;
    Ok(Grid { points: points(&name, &text)?, origin: name })
}

/// Reads the lines after the header; positive pressures and speeds, finite quantities.
fn points(name: &str, text: &str) -> Result<Vec<[f64; 3]>, Fault> {
    let (mut points, mut problems) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate().skip(1).filter(|(_, l)| !l.trim().is_empty()) {
        let cells: Vec<f64> = line.split(',').filter_map(|c| c.trim().parse().ok()).collect();
        match cells[..] {
            [p, v, value] if p > 0.0 && v > 0.0 && value.is_finite() => points.push([p, v, value]),
            _ => problems.push(Problem::new(
                format!("{name} line {}", number + 1),
                line,
                "pressure [Pa] > 0, sliding speed [m/s] > 0, and the measured number",
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
        let both = Measurements::new(None, None).unwrap();
        assert_eq!(both.friction.points.len(), FRICTION.lines().count() - 1);
        assert_eq!(both.wear.points.len(), WEAR.lines().count() - 1);
        let text = "pressure_pa,speed_m_s,mu\n1e5,0.1,0.9\n1e5,-0.1,0.9\n1e5,fast,1\n";
        let Err(Fault::Invalid(problems)) = points("mine.csv", text) else { panic!("accepted") };
        assert_eq!(problems.len(), 2);
    }
}
