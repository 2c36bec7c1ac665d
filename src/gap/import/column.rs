//! Where a quantity stands in a table, and what one count of it is worth.

use super::plan::TimeColumn;
use super::table::Table;
use super::units::{self, Dimension};
use crate::error::Problem;

/// Place and scale of a column, or all that is wrong with it.
pub(super) type Found = Result<(usize, f64), Vec<Problem>>;

/// Places and scales of both columns, or the problems of both.
pub(super) fn both(value: Found, time: Found) -> Result<([usize; 2], [f64; 2]), Vec<Problem>> {
    match (value, time) {
        (Ok(v), Ok(t)) => Ok(([v.0, t.0], [v.1, t.1])),
        (v, t) => Err([v.err(), t.err()].into_iter().flatten().flatten().collect()),
    }
}

/// The same of a time column.
pub(super) fn time_column(table: &Table, time: &TimeColumn) -> Found {
    column(table, "channels.time", &time.column, time.unit.as_deref(), Dimension::Time)
}

/// Where a column stands and what one count is worth: the plan's unit, or the header's.
pub(super) fn column(
    table: &Table,
    what: &str,
    name: &str,
    unit: Option<&str>,
    dimension: Dimension,
) -> Found {
    let place = table.place(what, name).map_err(|p| vec![p])?;
    let header = table.header[place].1.as_deref();
    let problem = |value: String, allowed: &str, remedy: &str| {
        Err(vec![Problem::new(format!("{}: unit of {name}", table.file), value, allowed, remedy)])
    };
    let Some(text) = unit.or(header) else {
        let remedy = "give unit = … in the plan";
        return problem(
            "neither in the plan nor in the header".into(),
            dimension.allowed(),
            remedy,
        );
    };
    let Some(scale) = units::si(dimension, text) else {
        return problem(format!("{text:?}"), dimension.allowed(), "name the column's unit");
    };
    // A header whose unit is known and another one than the plan's: one of the two is wrong.
    let said = header.and_then(|h| units::si(dimension, h));
    if let Some(said) = said.filter(|said| (said.abs() / scale.abs() - 1.0).abs() > 1e-9) {
        let value = format!("{text:?} in the plan, worth {scale}, against {said} in the header");
        return problem(value, "the same in both", "find out which is right, and mend the other");
    }
    Ok((place, scale))
}
