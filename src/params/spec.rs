//! What a parameter is: kind of value, range, units, meaning, and the shorthands that write it as a line of a table.

use super::Params;

/// Value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in SI units.
    Real(f64),
    /// A count, or an item of an enumeration (counted from 1, as in FMI).
    Integer(i32),
    /// A switch.
    Boolean(bool),
    /// Text, e.g. a file name.
    Text(String),
}

/// A unit in which numbers are shown: `shown = si * factor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name of the unit, e.g. `mm`.
    pub name: &'static str,
    /// Units shown per SI unit.
    pub factor: f64,
}

/// Named choice of an enumeration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Item {
    /// Name used in TOML files and in the FMU's type.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// What kind of value a parameter takes and in which range.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A real number.
    Real {
        /// SI unit; `1` where there is none.
        unit: &'static str,
        /// Unit in which people read it.
        display: Option<DisplayUnit>,
        /// Smallest allowed value \[unit\].
        min: f64,
        /// Largest allowed value \[unit\].
        max: f64,
        /// Typical size \[unit\].
        nominal: f64,
    },
    /// A count.
    Integer {
        /// Smallest allowed value.
        min: i32,
        /// Largest allowed value.
        max: i32,
    },
    /// A choice.
    Enumeration {
        /// Name of the type.
        type_name: &'static str,
        /// The choices; the value of the first is 1.
        items: &'static [Item],
    },
    /// A switch.
    Boolean,
    /// Text.
    Text,
}

/// May a parameter change while the block moves?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Fixed at initialization: mesh, geometry, mass.
    Fixed,
    /// May change between communication steps: friction, contact, wear.
    Tunable,
}

/// One parameter of the table.
#[derive(Clone, Copy, Debug)]
pub struct ParamSpec {
    /// Dotted name, e.g. `rubber.young_modulus`.
    pub name: &'static str,
    /// Kind and range.
    pub kind: Kind,
    /// Fixed or tunable.
    pub variability: Variability,
    /// What it is, in one sentence.
    pub doc: &'static str,
    /// Reads the value.
    pub get: fn(&Params) -> Value,
    /// Writes the value; a value of the wrong kind is left alone and `false` returned.
    pub set: fn(&mut Params, &Value) -> bool,
}

/// A real parameter at a field of [`Params`].
#[macro_export]
macro_rules! real_param {
    ($name:literal, $($field:ident).+, $unit:literal, $display:expr, $min:expr, $max:expr,
     $nominal:expr, $variability:ident, $doc:literal) => {
        $crate::params::ParamSpec {
            name: $name,
            kind: $crate::params::Kind::Real {
                unit: $unit, display: $display, min: $min, max: $max, nominal: $nominal,
            },
            variability: $crate::params::Variability::$variability,
            doc: $doc,
            get: |p| $crate::params::Value::Real(p.$($field).+),
            set: |p, v| match v {
                $crate::params::Value::Real(x) => { p.$($field).+ = *x; true }
                $crate::params::Value::Integer(i) => { p.$($field).+ = f64::from(*i); true }
                _ => false,
            },
        }
    };
}

/// A switch at a field of [`Params`].
#[macro_export]
macro_rules! bool_param {
    ($name:literal, $($field:ident).+, $variability:ident, $doc:literal) => {
        $crate::params::ParamSpec {
            name: $name,
            kind: $crate::params::Kind::Boolean,
            variability: $crate::params::Variability::$variability,
            doc: $doc,
            get: |p| $crate::params::Value::Boolean(p.$($field).+),
            set: |p, v| match v {
                $crate::params::Value::Boolean(b) => { p.$($field).+ = *b; true }
                _ => false,
            },
        }
    };
}

/// An enumeration at a field of [`Params`] whose type lists its variants in `ALL`.
#[macro_export]
macro_rules! enum_param {
    ($name:literal, $($field:ident).+, $type:path, $type_name:literal, $items:expr,
     $variability:ident, $doc:literal) => {
        $crate::params::ParamSpec {
            name: $name,
            kind: $crate::params::Kind::Enumeration { type_name: $type_name, items: $items },
            variability: $crate::params::Variability::$variability,
            doc: $doc,
            get: |p| {
                let at = <$type>::ALL.iter().position(|x| *x == p.$($field).+).unwrap_or(0);
                $crate::params::Value::Integer(at as i32 + 1)
            },
            set: |p, v| match v {
                $crate::params::Value::Integer(i) => {
                    let item = usize::try_from(*i - 1).ok().and_then(|at| <$type>::ALL.get(at));
                    match item {
                        Some(x) => { p.$($field).+ = *x; true }
                        None => false,
                    }
                }
                _ => false,
            },
        }
    };
}
