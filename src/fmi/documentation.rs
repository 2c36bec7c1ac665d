//! `documentation/index.html` of the FMU, made from the list of variables.

use super::model_description::escape;
use super::variables::{self, Source, Variable};
use super::MODEL_IDENTIFIER;
use crate::params::{Kind, ParamSpec};

/// The page.
pub fn html() -> String {
    let variables = variables::all();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{MODEL_IDENTIFIER}</title>\n\
         <style>{STYLE}</style></head>\n<body>\n<h1>{MODEL_IDENTIFIER}</h1>\n<p>{}.</p>\n\
         <p>Version {}, revision {}.</p>\n{RULES}\n{}{}{}{}</body>\n</html>\n",
        escape(env!("CARGO_PKG_DESCRIPTION")),
        env!("CARGO_PKG_VERSION"),
        env!("TREAD_REVISION"),
        table("Inputs", &variables, "input"),
        table("Outputs", &variables, "output"),
        table("Calculated parameters", &variables, "calculatedParameter"),
        table("Parameters", &variables, "parameter"),
    )
}

const STYLE: &str = "body{font-family:sans-serif;max-width:75em;margin:2em auto;padding:0 1em}\
table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.2em .5em;text-align:left;\
vertical-align:top}code{white-space:nowrap}";

const RULES: &str = "\
<h2>Signs and frames</h2>
<p>Road frame: x forward, z up, the road at z = 0 and at rest. A positive angle lifts the +x side. The
run-in edge is the end of the tread face at local &minus;x: in rolling it touches first, in sliding
(<code>belt.x</code> falls) it meets fresh road. <code>force.*</code> act on the belt,
<code>contact.force.*</code> on the block. Displacements and velocities are relative to the clamped
face, in the block's turning frame. <code>moment.y</code> = z F<sub>x</sub> &minus; x F<sub>z</sub>
about the middle of the clamped face.</p>
<h2>Start</h2>
<p>In <code>load</code> drive the block rests in frictionless static equilibrium under the initial
<code>normal_load</code> (<code>belt.z</code> is ignored). In <code>trajectory</code> drive it is
undeformed, or in static equilibrium where <code>belt.z</code> already presses it.</p>
<h2>What the inputs do within a step</h2>
<p>With <code>fmi2SetRealInputDerivatives</code> (orders 1 and 2, valid for the next step) the value
expected at the end of the step follows from Taylor's formula; without, rate and curvature are those
of the parabola through the last three values. Within the step the motion is the cubic that starts
where the last one ended, with its rate, and ends at the expected value and rate: velocity is always
the derivative of position and neither jumps. What is not known at the first communication point,
the rate, is taken from the first increment, as if the motion had always had it. A belt faster than
200 m/s is taken for a jump and refused.</p>
<h2>Steps</h2>
<p>Communication steps may vary freely, up to 10 s; 1 &micro;s to 1 ms serve best. The model divides
them into internal steps of at most <code>solver.max_step</code>, which
<code>solver.tolerance</code> shortens down to <code>solver.min_step</code>. The tolerance of
fmi2SetupExperiment is not used. A step that finds no solution answers fmi2Discard;
fmi2LastSuccessfulTime tells how far it came, and the outputs are those of that time.</p>
<p>Outputs hold at the last communication point. Their first derivative
(<code>fmi2GetRealOutputDerivatives</code>) is the velocity for the displacements, and the difference
over the last communication step for all else.</p>
<h2>Parameters</h2>
<p>In this order, each over the one before: the model's defaults, <code>resources/parameters.toml</code>,
the file named by <code>parameter_file</code>, single parameters. Fixed parameters may be set until
fmi2ExitInitializationMode, tunable ones between steps too.</p>
<h2>Errors</h2>
<p>The reason of each failure goes to the importer's logger, whatever is switched on: it names the
variable, its value, what is allowed and the way out. After fmi2Error values can be read,
and fmi2Reset, fmi2SetFMUstate and fmi2FreeInstance are allowed.</p>
";

fn table(title: &str, variables: &[Variable], causality: &str) -> String {
    let rows: String = variables
        .iter()
        .filter(|variable| variable.causality() == causality)
        .filter_map(row)
        .collect();
    format!(
        "<h2>{title}</h2>\n<table>\n<tr><th>Name</th><th>Unit</th><th>Start</th><th>Range</th>\
         <th>Variability</th><th>Meaning</th></tr>\n{rows}</table>\n"
    )
}

/// A row; an array has one row for all its elements.
fn row(variable: &Variable) -> Option<String> {
    let mut name = variable.name.clone();
    if let Source::Output(spec, i) = variable.source {
        if i > 0 {
            return None;
        }
        if spec.size > 1 {
            name = format!("{}[1..{}]", spec.name, spec.size);
        }
    }
    let unit = variable.unit().map_or("", |(unit, _)| if unit == "1" { "" } else { unit });
    let shown = variable.unit().and_then(|(_, display)| display);
    let unit = shown.map_or(unit.to_string(), |d| format!("{unit} (shown in {})", d.name));
    Some(format!(
        "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape(&name),
        escape(&unit),
        escape(&variable.start().unwrap_or_default()),
        escape(&range(variable)),
        variable.variability(),
        escape(variable.doc),
    ))
}

/// Range or choices, for a person.
pub fn range(variable: &Variable) -> String {
    match variable.source {
        Source::Input(_, spec) => format!("{} to {}", spec.min, spec.limit),
        Source::Parameter(_, ParamSpec { kind, .. }) => match kind {
            Kind::Real { min, max, .. } => format!("{min:?} to {max:?}"),
            Kind::Integer { min, max } => format!("{min} to {max}"),
            Kind::Enumeration { items, .. } => {
                let choices =
                    items.iter().enumerate().map(|(i, x)| format!("{} {}", i + 1, x.name));
                choices.collect::<Vec<_>>().join(", ")
            }
            Kind::Boolean | Kind::Text => String::new(),
        },
        _ => String::new(),
    }
}
