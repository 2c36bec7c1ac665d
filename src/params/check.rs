//! Checks of parameters: all problems at once, each with its range and the way out.

use super::table::{self, Kind, ParamSpec, Value};
use super::Params;
use crate::error::{number, Fault, Problem};

/// What is wrong with `value` for the parameter `spec`, if anything.
pub fn value(spec: &ParamSpec, value: &Value) -> Option<Problem> {
    let complain = |allowed: String, remedy: &str| {
        Some(Problem::new(spec.name, table::show(spec, value), allowed, remedy))
    };
    match (spec.kind, value) {
        (Kind::Real { unit, min, max, .. }, Value::Real(x)) => {
            if x.is_finite() && (min..=max).contains(x) {
                return None;
            }
            let unit = if unit == "1" { "" } else { unit };
            complain(
                format!("{} to {} {unit}", number(min), number(max)).trim().to_string(),
                "give a value in SI units inside that range",
            )
        }
        (Kind::Integer { min, max }, Value::Integer(i)) => {
            if (min..=max).contains(i) {
                return None;
            }
            complain(format!("{min} to {max}"), "give a whole number inside that range")
        }
        (Kind::Enumeration { items, .. }, Value::Integer(i)) => {
            if (1..=items.len() as i32).contains(i) {
                return None;
            }
            let names: Vec<_> = items.iter().map(|item| item.name).collect();
            complain(names.join(", "), "choose one of these")
        }
        (Kind::Boolean, Value::Boolean(_)) | (Kind::Text, Value::Text(_)) => None,
        (kind, _) => complain(format!("{} value", kind_name(kind)), "give a value of that kind"),
    }
}

/// What people call a kind of value.
pub fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real { .. } => "a number",
        Kind::Integer { .. } => "a whole number",
        Kind::Enumeration { .. } => "one of the names",
        Kind::Boolean => "true or false",
        Kind::Text => "a text",
    }
}

/// All problems of a parameter set: each value by itself, then what must fit together.
pub fn problems(params: &Params) -> Vec<Problem> {
    let mut found: Vec<Problem> =
        table::specs().filter_map(|spec| value(spec, &(spec.get)(params))).collect();
    found.extend(contact_points(params.solver.contact_points, params.solver.elements_along));
    if params.friction.mu_inf + params.friction.mu_drop < 0.0 {
        found.push(Problem::new(
            "friction.mu_inf + friction.mu_drop",
            format!("{}", params.friction.mu_inf + params.friction.mu_drop),
            "0 or more: friction at low speed cannot push the block",
            "raise friction.mu_inf or friction.mu_drop",
        ));
    }
    if params.solver.min_step > params.solver.max_step {
        found.push(Problem::new(
            "solver.min_step",
            format!("{}", params.solver.min_step),
            format!("at most solver.max_step = {}", params.solver.max_step),
            "lower solver.min_step or raise solver.max_step",
        ));
    }
    let slenderness = params.block.length / params.block.height;
    let sized = |problem: &Problem| problem.what.starts_with("block.");
    if !found.iter().any(sized) && !(0.2..=20.0).contains(&slenderness) {
        found.push(Problem::new(
            "block.length / block.height",
            format!("{slenderness}"),
            "0.2 to 20",
            "a block of that shape is a lamella or a mat; change block.length or block.height",
        ));
    }
    found
}

/// The parameters, if nothing is wrong with them.
pub fn checked(params: &Params) -> Result<(), Fault> {
    let found = problems(params);
    if found.is_empty() {
        Ok(())
    } else {
        Err(Fault::Invalid(found))
    }
}

/// Most contact points on a face whose mesh was not given.
const MOST_POINTS: usize = 40;

/// Elements along the face on whose nodes the polynomials through `points` Gauss-Lobatto points can be told apart.
///
/// With N evenly spaced nodes for n points the least singular value of the interpolation stays above 0.08 as long as
/// N ≥ n + 2 and n ≤ 3.5 √N. Beyond, some motion of the points moves no node: it has neither mass nor stiffness, and the
/// contact solver finds no solution.
pub fn elements_for(points: usize) -> usize {
    let nodes = (points + 2).max((4 * points * points).div_ceil(49));
    nodes / 2
}

/// What is wrong with a number of contact points on `along` elements (0: chosen), if anything.
fn contact_points(points: usize, along: usize) -> Option<Problem> {
    let most = (4..=MOST_POINTS).rev().find(|n| along == 0 || elements_for(*n) <= along);
    let fits = points == 0 || most.is_some_and(|most| (4..=most).contains(&points));
    (!fits).then(|| {
        let few = most.map_or(String::new(), |most| format!(", or 4 to {most}"));
        Problem::new(
            "solver.contact_points",
            points.to_string(),
            format!("0{few}: more cannot be told apart on the elements along the face"),
            "leave it at 0 for the nodes of the elements, or solver.elements_along at 0",
        )
    })
}
