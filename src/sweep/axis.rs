//! What a plan varies: one name and the values that it may take.

use toml::Value;

use crate::error::Problem;
use crate::params::{check, table, Kind};
use crate::scenario::run_table::{KEYS, TEXT_KEYS};

/// A varied parameter or key of the `[run]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Dotted name, e.g. `friction.mu_inf` or `run.slide.speed`.
    pub name: String,
    /// Its values.
    pub levels: Levels,
    /// What kind of column it makes.
    pub column: Column,
}

/// Values of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// Just these.
    Listed(Vec<Value>),
    /// A range of numbers.
    Range {
        /// First value, in the parameter's unit.
        from: f64,
        /// Last value, in the parameter's unit.
        to: f64,
        /// Levels of a grid or one-at-a-time plan.
        count: usize,
        /// Equal ratios instead of equal distances.
        logarithmic: bool,
    },
}

/// Kind of the column of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Real numbers in this SI unit.
    Real(&'static str),
    /// Whole numbers.
    Integer,
    /// true or false.
    Boolean,
    /// Names.
    Text,
}

const REMEDY: &str = "write [1.0, 2.0] or { from = 1.0, to = 2.0, count = 5, scale = \"log\" }";

impl Axis {
    /// Reads `"name" = [values]` or `"name" = { from, to, count, scale }`.
    ///
    /// # Errors
    /// An unknown name, values of the wrong kind, a range that is none.
    pub fn read(name: &str, value: &Value) -> Result<Self, Problem> {
        let column = column(name).ok_or_else(|| {
            let allowed = "a parameter of the model or a key of the [run] table";
            let remedy = "`tread reference` lists all names; quote the dotted name";
            Problem::new(format!("sweep.vary.{name}"), value.to_string(), allowed, remedy)
        })?;
        let levels = match value {
            Value::Array(values) => listed(values, column),
            Value::Table(range) => ranged(range, column),
            _ => Err("a list of values or a range".to_string()),
        };
        let levels = levels.map_err(|allowed| {
            Problem::new(format!("sweep.vary.{name}"), value.to_string(), allowed, REMEDY)
        })?;
        Ok(Self { name: name.to_string(), levels, column })
    }

    /// Levels of a grid or one-at-a-time plan.
    pub fn count(&self) -> usize {
        match &self.levels {
            Levels::Listed(values) => values.len(),
            Levels::Range { count, .. } => *count,
        }
    }

    /// Level `i` of [`Self::count`].
    pub fn level(&self, i: usize) -> Value {
        match &self.levels {
            Levels::Listed(values) => values[i].clone(),
            Levels::Range { count: 1, .. } => self.at(0.0),
            // The ends exactly, whatever rounding does to a ratio.
            Levels::Range { to, count, .. } if i + 1 == *count => self.number(*to),
            Levels::Range { count, .. } => self.at(i as f64 / (*count - 1) as f64),
        }
    }

    /// Value at a share `u` in [0, 1) of the way from the first to the last.
    pub fn at(&self, u: f64) -> Value {
        match &self.levels {
            Levels::Listed(values) => {
                let at = (u * values.len() as f64) as usize;
                values[at.min(values.len() - 1)].clone()
            }
            Levels::Range { from, .. } if u == 0.0 => self.number(*from),
            Levels::Range { from, to, logarithmic: true, .. } => {
                self.number(from * (u * (to / from).ln()).exp())
            }
            Levels::Range { from, to, .. } => self.number(from + u * (to - from)),
        }
    }

    fn number(&self, x: f64) -> Value {
        match self.column {
            Column::Integer => Value::Integer(x.round() as i64),
            _ => Value::Float(x),
        }
    }
}

/// Column of a parameter or key; `None` for an unknown name.
fn column(name: &str) -> Option<Column> {
    if let Some(key) = name.strip_prefix("run.") {
        let number = KEYS.iter().find(|k| k.name == key).map(|k| Column::Real(k.unit));
        return number.or_else(|| TEXT_KEYS.iter().any(|k| k.0 == key).then_some(Column::Text));
    }
    Some(match table::find(name)?.kind {
        Kind::Real { unit, .. } => Column::Real(unit),
        Kind::Integer { .. } => Column::Integer,
        Kind::Boolean => Column::Boolean,
        Kind::Enumeration { .. } | Kind::Text => Column::Text,
    })
}

/// A value as its column has it; `None` if it is of another kind.
pub fn fitting(value: &Value, column: Column) -> Option<Value> {
    match (column, value) {
        (Column::Real(_), Value::Integer(i)) => Some(Value::Float(*i as f64)),
        (Column::Real(_), Value::Float(_))
        | (Column::Integer, Value::Integer(_))
        | (Column::Boolean, Value::Boolean(_))
        | (Column::Text, Value::String(_)) => Some(value.clone()),
        _ => None,
    }
}

fn listed(values: &[Value], column: Column) -> Result<Levels, String> {
    let fitting: Option<Vec<Value>> = values.iter().map(|v| fitting(v, column)).collect();
    match fitting {
        Some(values) if !values.is_empty() => Ok(Levels::Listed(values)),
        _ => Err(format!("a list of at least one value, each {}", kind(column))),
    }
}

fn ranged(range: &toml::Table, column: Column) -> Result<Levels, String> {
    if !matches!(column, Column::Real(_) | Column::Integer) {
        return Err("a list: only numbers have ranges".to_string());
    }
    if let Some(key) =
        range.keys().find(|k| !["from", "to", "count", "scale"].contains(&k.as_str()))
    {
        return Err(format!("from, to, count and scale, not {key}"));
    }
    let number = |key: &str| match range.get(key) {
        Some(Value::Float(x)) if x.is_finite() => Ok(*x),
        Some(Value::Integer(i)) => Ok(*i as f64),
        _ => Err(format!("a range with a number {key}")),
    };
    let (from, to) = (number("from")?, number("to")?);
    let count = match range.get("count") {
        None => 5,
        Some(Value::Integer(i)) if *i >= 1 => *i as usize,
        Some(_) => return Err("a count of 1 or more".to_string()),
    };
    let logarithmic = match range.get("scale").map(Value::as_str) {
        None | Some(Some("linear")) => false,
        Some(Some("log")) => true,
        Some(_) => return Err("a scale linear or log".to_string()),
    };
    if logarithmic && (from <= 0.0 || to <= 0.0) {
        return Err("positive ends where the scale is log".to_string());
    }
    Ok(Levels::Range { from, to, count, logarithmic })
}

fn kind(column: Column) -> &'static str {
    match column {
        Column::Real(_) => "a number",
        Column::Integer => "a whole number",
        Column::Boolean => check::kind_name(Kind::Boolean),
        Column::Text => "a text in quotes",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(name: &str, text: &str) -> Result<Axis, Problem> {
        let table: toml::Table = format!("v = {text}").parse().unwrap();
        Axis::read(name, &table["v"])
    }

    #[test]
    fn a_range_has_its_ends_exactly_and_equal_steps_or_ratios() {
        let linear = axis("friction.mu_inf", "{ from = 0.1, to = 0.7, count = 4 }").unwrap();
        let values: Vec<f64> = (0..4).map(|i| linear.level(i).as_float().unwrap()).collect();
        assert_eq!((values[0], values[3]), (0.1, 0.7));
        assert!((values[1] - 0.3).abs() < 1e-15, "{values:?}");
        let log =
            axis("rubber.young_modulus", "{ from = 1e6, to = 1e8, count = 3, scale = \"log\" }")
                .unwrap();
        // By hand: the middle of 1e6 and 1e8 in equal ratios is 1e7, but for rounding of exp and ln.
        assert!((log.level(1).as_float().unwrap() / 1e7 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn wrong_names_and_kinds_are_told() {
        assert!(axis("friction.mu", "[1.0]").unwrap_err().to_string().contains("friction.mu"));
        for (name, text) in [
            ("friction.form", "{ from = 1, to = 2 }"),
            ("friction.mu_inf", "[\"high\"]"),
            ("friction.mu_inf", "{ from = 0.0, to = 2.0, scale = \"log\" }"),
            ("run.slide.speed", "{ from = 0.0, until = 2.0 }"),
            ("solver.elements_up", "[1.5]"),
        ] {
            assert!(axis(name, text).is_err(), "{name} {text}");
        }
    }
}
