//! What an identification says about its parameters: values, uncertainty, what cannot be told apart.

use std::fmt::Write;

use serde_json::{json, Map, Value};

use super::run::{Identified, Task};
use super::space::{get, Unknown};

/// Components of a direction that are worth naming.
const NAMED: f64 = 0.3;
/// Standard deviation, in unit intervals, from which on a direction is not determined: a uniform
/// distribution over the whole range has 0.29.
const UNDETERMINED: f64 = 0.15;

/// A parameter and how well the data pin it down.
struct Row {
    name: &'static str,
    /// SI.
    value: f64,
    /// One standard deviation down and up, SI.
    within: [f64; 2],
    /// Standard deviation as a share of the range of the search \[-\].
    deviation: f64,
}

fn rows<'a>(task: &'a Task, found: &'a Identified) -> impl Iterator<Item = Row> + 'a {
    let places = found.local.x.iter().zip(found.local.deviations());
    task.unknowns.iter().zip(places).map(|(unknown, (x, deviation))| Row {
        name: unknown.name,
        value: get(&found.params, unknown.name),
        within: [x - deviation, x + deviation].map(|x| unknown.value(x)),
        deviation,
    })
}

/// All of it for machines: cost, parameters and directions.
pub fn document(task: &Task, found: &Identified) -> Value {
    let columns: Vec<&str> = task.columns.iter().map(|c| c.name).collect();
    let parameters: Vec<Value> = rows(task, found)
        .map(|row| {
            let [from, to] = row.within;
            json!({ "parameter": row.name, "value": row.value, "from": from, "to": to,
                    "share_of_range": row.deviation })
        })
        .collect();
    let names = || task.unknowns.iter().map(|unknown| unknown.name);
    let directions: Vec<Value> = (found.local.directions().iter())
        .map(|direction| {
            let components: Map<String, Value> = names()
                .map(String::from)
                .zip(direction.components.iter().map(|c| json!(c)))
                .collect();
            json!({ "pinned_down": direction.deviation < UNDETERMINED,
                    "deviation": direction.deviation, "components": components })
        })
        .collect();
    json!({ "columns": columns, "cost": found.cost, "scatter": found.local.variance().sqrt(),
            "parameters": parameters, "directions": directions })
}

/// The report as Markdown.
pub fn markdown(task: &Task, found: &Identified) -> String {
    let mut out = String::from("# Identification from Table 1\n\n");
    let columns: Vec<&str> = task.columns.iter().map(|c| c.name).collect();
    let _ = writeln!(out, "Columns: {}. Cost {:.3}.\n", columns.join(", "), found.cost);
    let _ = writeln!(
        out,
        "Uncertainty: one standard deviation from the Jacobian of the residuals at the end of the local \
         search and the scatter that the fit leaves ({:.1} %), together with the range of the search as \
         prior knowledge.\n",
        100.0 * found.local.variance().sqrt()
    );
    out.push_str("| parameter | value | from | to | share of the range |\n|---|---|---|---|---|\n");
    for Row { name, value, within: [from, to], deviation } in rows(task, found) {
        let share = 100.0 * deviation;
        let _ = writeln!(out, "| `{name}` | {value:.4e} | {from:.4e} | {to:.4e} | {share:.1} % |");
    }
    out.push_str("\n## Directions of the parameters, the best determined first\n\n");
    out.push_str("Components in unit intervals of the search ranges.\n\n");
    for direction in found.local.directions() {
        let verdict =
            if direction.deviation < UNDETERMINED { "pinned down" } else { "not told apart" };
        let _ = writeln!(
            out,
            "- {verdict} (deviation {:.3}): {}",
            direction.deviation,
            combination(&task.unknowns, &direction.components)
        );
    }
    out
}

/// The parameters with their uncertainty as CSV: one standard deviation down and up.
pub fn parameters_csv(task: &Task, found: &Identified) -> String {
    let mut out = String::from("parameter,value,from,to,share_of_range\n");
    for Row { name, value, within: [from, to], deviation } in rows(task, found) {
        let _ = writeln!(out, "{name},{value:.6e},{from:.3e},{to:.3e},{deviation:.3}");
    }
    out
}

/// What the data pin down as CSV: directions in unit intervals, the best determined first.
pub fn directions_csv(task: &Task, found: &Identified) -> String {
    let mut out = String::from("pinned_down,deviation,direction\n");
    for direction in found.local.directions() {
        let pinned = if direction.deviation < UNDETERMINED { "yes" } else { "no" };
        let words = combination(&task.unknowns, &direction.components);
        let _ = writeln!(out, "{pinned},{:.3},{words}", direction.deviation);
    }
    out
}

/// The main parts of a direction in words.
fn combination(unknowns: &[Unknown], components: &[f64]) -> String {
    let mut parts: Vec<(f64, &str)> =
        components.iter().copied().zip(unknowns.iter().map(|u| u.name)).collect();
    parts.retain(|(c, _)| c.abs() >= NAMED);
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let words: Vec<String> = parts.iter().map(|(c, name)| format!("{c:+.2} {name}")).collect();
    words.join(" ")
}
