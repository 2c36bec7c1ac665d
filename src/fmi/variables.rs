//! The one list of variables, composed from the tables of parameters, inputs and outputs.

use super::calculated::{Calculated, CALCULATED};
use crate::block::{InputSpec, OutputSpec, INPUTS, OUTPUTS};
use crate::params::table::{self, DisplayUnit};
use crate::params::{Kind, ParamSpec, Params, Variability};

/// Name of the String parameter that names a parameter file.
pub const PARAMETER_FILE: &str = "parameter_file";

/// Where a variable's value lives.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// An input; position in [`INPUTS`].
    Input(usize, &'static InputSpec),
    /// Element of an output, counted from 0.
    Output(&'static OutputSpec, usize),
    /// A parameter; position in the table of parameters.
    Parameter(usize, &'static ParamSpec),
    /// A calculated parameter.
    Calculated(&'static Calculated),
    /// The parameter file's name.
    ParameterFile,
}

/// The type of the functions that get and set a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// fmi2Real
    Real,
    /// fmi2Integer; enumerations too.
    Integer,
    /// fmi2Boolean
    Boolean,
    /// fmi2String
    Text,
}

impl Type {
    /// Name of the type in the standard's function names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::Text => "String",
        }
    }
}

/// One scalar variable; its value reference is its place in the list.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Name, an array's element with its index from 1, e.g. `contact.pressure[3]`.
    pub name: String,
    /// What it is.
    pub doc: &'static str,
    /// Where its value lives.
    pub source: Source,
}

/// All variables: inputs, outputs, calculated parameters, parameter file, parameters.
///
/// Parameters come last, those of effects at the very end: a new effect moves no value reference.
pub fn all() -> Vec<Variable> {
    let inputs = INPUTS.iter().enumerate().map(|(i, spec)| Variable {
        name: spec.name.to_string(),
        doc: spec.doc,
        source: Source::Input(i, spec),
    });
    let outputs = OUTPUTS.iter().flat_map(elements);
    let calculated = CALCULATED.iter().map(|spec| Variable {
        name: spec.name.to_string(),
        doc: spec.doc,
        source: Source::Calculated(spec),
    });
    let file = Variable {
        name: PARAMETER_FILE.to_string(),
        doc: "TOML file of parameters, absolute or relative to the FMU's resources; single parameters that are set win over it",
        source: Source::ParameterFile,
    };
    let parameters = table::specs().enumerate().map(|(i, spec)| Variable {
        name: spec.name.to_string(),
        doc: spec.doc,
        source: Source::Parameter(i, spec),
    });
    inputs.chain(outputs).chain(calculated).chain([file]).chain(parameters).collect()
}

fn elements(spec: &'static OutputSpec) -> impl Iterator<Item = Variable> {
    (0..spec.size).map(move |i| Variable {
        name: if spec.size == 1 { spec.name.into() } else { format!("{}[{}]", spec.name, i + 1) },
        doc: spec.doc,
        source: Source::Output(spec, i),
    })
}

impl Variable {
    /// The type of the functions that reach it.
    pub fn kind(&self) -> Type {
        match self.source {
            Source::Input(..) | Source::Output(..) | Source::Calculated(_) => Type::Real,
            Source::ParameterFile => Type::Text,
            Source::Parameter(_, spec) => match spec.kind {
                Kind::Real { .. } => Type::Real,
                Kind::Integer { .. } | Kind::Enumeration { .. } => Type::Integer,
                Kind::Boolean => Type::Boolean,
                Kind::Text => Type::Text,
            },
        }
    }

    /// Causality in the standard's words.
    pub fn causality(&self) -> &'static str {
        match self.source {
            Source::Input(..) => "input",
            Source::Output(..) => "output",
            Source::Parameter(..) | Source::ParameterFile => "parameter",
            Source::Calculated(_) => "calculatedParameter",
        }
    }

    /// Variability in the standard's words.
    pub fn variability(&self) -> &'static str {
        match self.source {
            Source::Input(..) | Source::Output(..) => "continuous",
            Source::Parameter(_, spec) if spec.variability == Variability::Tunable => "tunable",
            Source::Parameter(..) | Source::ParameterFile | Source::Calculated(_) => "fixed",
        }
    }

    /// The standard's attribute `initial`; an input has none.
    pub fn initial(&self) -> Option<&'static str> {
        match self.source {
            Source::Input(..) => None,
            Source::Output(..) | Source::Calculated(_) => Some("calculated"),
            Source::Parameter(..) | Source::ParameterFile => Some("exact"),
        }
    }

    /// Unit and display unit of a real variable.
    pub fn unit(&self) -> Option<(&'static str, Option<DisplayUnit>)> {
        match self.source {
            Source::Input(_, spec) => Some((spec.unit, spec.display)),
            Source::Output(spec, _) => Some((spec.unit, spec.display)),
            Source::Calculated(spec) => Some((spec.unit, None)),
            Source::Parameter(_, ParamSpec { kind: Kind::Real { unit, display, .. }, .. }) => {
                Some((unit, *display))
            }
            _ => None,
        }
    }

    /// Start value as the description writes it; what is calculated has none.
    pub fn start(&self) -> Option<String> {
        use crate::params::Value;
        match self.source {
            Source::Input(_, spec) => Some(number((spec.get)(&Default::default()))),
            Source::ParameterFile => Some(String::new()),
            Source::Parameter(_, spec) => Some(match (spec.get)(&Params::default()) {
                Value::Real(x) => number(x),
                Value::Integer(i) => i.to_string(),
                Value::Boolean(b) => b.to_string(),
                Value::Text(t) => t,
            }),
            Source::Output(..) | Source::Calculated(_) => None,
        }
    }
}

/// A number in the shortest form that reads back to the same bits.
pub fn number(x: f64) -> String {
    format!("{x:?}")
}
