//! Writes `modelDescription.xml` from the list of variables.

use super::log::Category;
use super::units::{self, BASE};
use super::variables::{self, number, Source, Variable};
use super::MODEL_IDENTIFIER;
use crate::params::table::{DisplayUnit, Item};
use crate::params::{Kind, ParamSpec};
use std::fmt::Write;

/// The highest order of input derivatives that has an effect.
pub const INPUT_DERIVATIVE_ORDER: i32 = 2;
/// The highest order of output derivatives that is given.
pub const OUTPUT_DERIVATIVE_ORDER: i32 = 1;

/// The file as it is shipped.
pub fn xml() -> String {
    let variables = variables::all();
    write(&variables, &guid(&variables))
}

/// The identifier of this very interface: a hash of the description without it, without braces.
///
/// Library and description carry the same identifier because both are made from the same list.
pub fn guid(variables: &[Variable]) -> String {
    let hash = fnv1a(write(variables, "").as_bytes());
    let hex = format!("{hash:032x}");
    [&hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..]].join("-")
}

/// FNV-1a with 128 bit (offset basis and prime of the authors' specification).
fn fnv1a(bytes: &[u8]) -> u128 {
    bytes.iter().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, |hash, byte| {
        (hash ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
    })
}

fn write(variables: &[Variable], guid: &str) -> String {
    let mut out = String::with_capacity(64 * 1024);
    // Writing to a String cannot fail.
    let _ = document(&mut out, variables, guid);
    out
}

fn document(out: &mut String, variables: &[Variable], guid: &str) -> std::fmt::Result {
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(
        out,
        r#"<fmiModelDescription fmiVersion="2.0" modelName="{MODEL_IDENTIFIER}" guid="{guid}" description="{}" version="{}" license="{}" generationTool="tread-block {1}" variableNamingConvention="structured">"#,
        escape(env!("CARGO_PKG_DESCRIPTION")),
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_LICENSE"),
    )?;
    writeln!(
        out,
        r#"  <CoSimulation modelIdentifier="{MODEL_IDENTIFIER}" canHandleVariableCommunicationStepSize="true" canInterpolateInputs="true" maxOutputDerivativeOrder="{OUTPUT_DERIVATIVE_ORDER}" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>"#
    )?;
    unit_definitions(out, variables)?;
    type_definitions(out, variables)?;
    writeln!(out, "  <LogCategories>")?;
    for category in Category::ALL {
        writeln!(
            out,
            r#"    <Category name="{}" description="{}"/>"#,
            category.name(),
            category.doc()
        )?;
    }
    writeln!(out, "  </LogCategories>")?;
    writeln!(
        out,
        r#"  <DefaultExperiment startTime="0.0" stopTime="0.03" tolerance="0.001" stepSize="1e-5"/>"#
    )?;
    writeln!(out, "  <ModelVariables>")?;
    for (reference, variable) in variables.iter().enumerate() {
        scalar_variable(out, reference, variable)?;
    }
    writeln!(out, "  </ModelVariables>")?;
    structure(out, variables)?;
    writeln!(out, "</fmiModelDescription>")
}

fn unit_definitions(out: &mut String, variables: &[Variable]) -> std::fmt::Result {
    let mut found: Vec<(&str, Vec<DisplayUnit>)> = Vec::new();
    for (unit, display) in variables.iter().filter_map(Variable::unit) {
        let at = found.iter().position(|(name, _)| *name == unit).unwrap_or_else(|| {
            found.push((unit, Vec::new()));
            found.len() - 1
        });
        if let Some(display) = display.filter(|d| !found[at].1.contains(d)) {
            found[at].1.push(display);
        }
    }
    writeln!(out, "  <UnitDefinitions>")?;
    for (unit, displays) in found {
        writeln!(out, r#"    <Unit name="{}">"#, escape(unit))?;
        let powers: String = units::exponents(unit)
            .unwrap_or_default()
            .iter()
            .zip(BASE)
            .filter(|(power, _)| **power != 0)
            .map(|(power, name)| format!(r#" {name}="{power}""#))
            .collect();
        writeln!(out, "      <BaseUnit{powers}/>")?;
        for DisplayUnit { name, factor } in displays {
            let (name, factor) = (escape(name), number(factor));
            writeln!(out, r#"      <DisplayUnit name="{name}" factor="{factor}"/>"#)?;
        }
        writeln!(out, "    </Unit>")?;
    }
    writeln!(out, "  </UnitDefinitions>")
}

fn type_definitions(out: &mut String, variables: &[Variable]) -> std::fmt::Result {
    let mut found: Vec<(&str, &[Item])> = Vec::new();
    for variable in variables {
        let Source::Parameter(_, ParamSpec { kind, .. }) = variable.source else { continue };
        if let Kind::Enumeration { type_name, items } = kind {
            if !found.iter().any(|(name, _)| name == type_name) {
                found.push((type_name, items));
            }
        }
    }
    writeln!(out, "  <TypeDefinitions>")?;
    for (name, items) in found {
        writeln!(out, r#"    <SimpleType name="{name}">"#)?;
        writeln!(out, "      <Enumeration>")?;
        for (i, item) in items.iter().enumerate() {
            writeln!(
                out,
                r#"        <Item name="{}" value="{}" description="{}"/>"#,
                escape(item.name),
                i + 1,
                escape(item.doc)
            )?;
        }
        writeln!(out, "      </Enumeration>")?;
        writeln!(out, "    </SimpleType>")?;
    }
    writeln!(out, "  </TypeDefinitions>")
}

fn scalar_variable(out: &mut String, reference: usize, variable: &Variable) -> std::fmt::Result {
    write!(
        out,
        r#"    <ScalarVariable name="{}" valueReference="{reference}" description="{}" causality="{}" variability="{}""#,
        escape(&variable.name),
        escape(variable.doc),
        variable.causality(),
        variable.variability(),
    )?;
    if let Some(initial) = variable.initial() {
        write!(out, r#" initial="{initial}""#)?;
    }
    writeln!(out, ">")?;
    writeln!(out, "      <{}/>", typed(variable))?;
    writeln!(out, "    </ScalarVariable>")
}

/// Element of a variable's type with its attributes.
fn typed(variable: &Variable) -> String {
    let mut text = match variable.source {
        Source::Parameter(_, ParamSpec { kind: Kind::Enumeration { type_name, .. }, .. }) => {
            format!(r#"Enumeration declaredType="{type_name}""#)
        }
        _ => variable.kind().name().to_string(),
    };
    if let Some((unit, display)) = variable.unit() {
        text += &format!(r#" unit="{}""#, escape(unit));
        if let Some(display) = display {
            text += &format!(r#" displayUnit="{}""#, escape(display.name));
        }
    }
    text += &range(variable);
    if let Some(start) = variable.start() {
        text += &format!(r#" start="{}""#, escape(&start));
    }
    text
}

fn range(variable: &Variable) -> String {
    let real = |min: f64, max: f64, nominal: Option<f64>| {
        let nominal = nominal.map_or(String::new(), |n| format!(r#" nominal="{}""#, number(n)));
        format!(r#" min="{}" max="{}"{nominal}"#, number(min), number(max))
    };
    match variable.source {
        Source::Input(_, spec) => real(spec.min, spec.limit, None),
        Source::Output(spec, _) => format!(r#" nominal="{}""#, number(spec.nominal)),
        Source::Calculated(spec) => format!(r#" nominal="{}""#, number(spec.nominal)),
        Source::Parameter(_, spec) => match spec.kind {
            Kind::Real { min, max, nominal, .. } => real(min, max, Some(nominal)),
            Kind::Integer { min, max } => format!(r#" min="{min}" max="{max}""#),
            Kind::Enumeration { items, .. } => format!(r#" min="1" max="{}""#, items.len()),
            Kind::Boolean | Kind::Text => String::new(),
        },
        Source::ParameterFile => String::new(),
    }
}

/// Outputs and what they depend on. At a communication point an output tells what the last step
/// reached and depends on no input of that point; in initialization mode see [`known_at_start`].
fn structure(out: &mut String, variables: &[Variable]) -> std::fmt::Result {
    writeln!(out, "  <ModelStructure>")?;
    writeln!(out, "    <Outputs>")?;
    for (i, variable) in variables.iter().enumerate() {
        if matches!(variable.source, Source::Output(..)) {
            writeln!(out, r#"      <Unknown index="{}" dependencies=""/>"#, i + 1)?;
        }
    }
    writeln!(out, "    </Outputs>")?;
    writeln!(out, "    <InitialUnknowns>")?;
    for (i, variable) in variables.iter().enumerate() {
        if variable.initial() == Some("calculated") {
            let known: Vec<String> = variables
                .iter()
                .enumerate()
                .filter(|(_, known)| known_at_start(variable, known))
                .map(|(k, _)| (k + 1).to_string())
                .collect();
            let known = known.join(" ");
            writeln!(out, r#"      <Unknown index="{}" dependencies="{known}"/>"#, i + 1)?;
        }
    }
    writeln!(out, "    </InitialUnknowns>")?;
    writeln!(out, "  </ModelStructure>")
}

/// Does `unknown` depend on `known` in initialization mode? The block rests in frictionless static
/// equilibrium: what is a speed, a friction or a wear is zero, all else follows from the pose, the
/// load, the shape, the stiffnesses and the mesh.
fn known_at_start(unknown: &Variable, known: &Variable) -> bool {
    match unknown.source {
        Source::Calculated(spec) => {
            spec.depends.contains(&known.name.as_str())
                || matches!(known.source, Source::ParameterFile)
        }
        Source::Output(spec, _) if is_zero_at_rest(spec.name) => false,
        Source::Output(..) => match known.source {
            Source::Input(_, input) => input.name != "belt.x",
            Source::ParameterFile => true,
            Source::Parameter(_, spec) => shapes_equilibrium(spec.name),
            Source::Output(..) | Source::Calculated(_) => false,
        },
        _ => false,
    }
}

fn is_zero_at_rest(name: &str) -> bool {
    name.contains(".velocity.")
        || name.starts_with("wear.")
        || ["contact.friction_power", "contact.sliding_speed"].contains(&name)
}

fn shapes_equilibrium(name: &str) -> bool {
    let bystanders = [
        "friction.",
        "wear.",
        "carriage.",
        "solver.tolerance",
        "solver.max_step",
        "solver.min_step",
    ];
    !bystanders.iter().any(|b| name.starts_with(b))
        && !["rubber.density", "rubber.stiffness_damping"].contains(&name)
}

/// Text as it may stand in an attribute.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
