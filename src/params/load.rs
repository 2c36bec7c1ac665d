//! TOML ↔ parameters: tables nest as the dotted names do, numbers are in SI units.

use super::table::{self, Kind, ParamSpec, Value};
use super::{check, Params};
use crate::error::{Fault, Problem};

/// Reads parameters from a TOML text; keys not given keep their defaults.
///
/// # Errors
/// All unknown keys, values of the wrong kind and values out of range, at once.
pub fn from_toml(text: &str) -> Result<Params, Fault> {
    let document: toml::Table = text.parse().map_err(|e: toml::de::Error| syntax(&e))?;
    let (params, mut problems) = from_table(&document, Params::default());
    problems.extend(check::problems(&params));
    if problems.is_empty() {
        Ok(params)
    } else {
        Err(Fault::Invalid(problems))
    }
}

/// Sets every parameter that `document` names on top of `params`; returns what went wrong.
pub fn from_table(document: &toml::Table, mut params: Params) -> (Params, Vec<Problem>) {
    let mut problems = Vec::new();
    for (name, value) in flatten("", document) {
        match table::find(&name) {
            Some(spec) => problems.extend(assign(spec, value, &mut params)),
            None => problems.push(unknown(&name, value)),
        }
    }
    (params, problems)
}

/// Sets one parameter from text such as `friction.mu_inf=0.6`, as the command line gives it.
pub fn assign_text(assignment: &str, params: &mut Params) -> Option<Problem> {
    let Some((name, text)) = assignment.split_once('=') else {
        return Some(Problem::new(
            "assignment",
            assignment,
            "name=value",
            "write for example friction.mu_inf=0.6",
        ));
    };
    let (name, text) = (name.trim(), text.trim());
    let value = text
        .parse::<i64>()
        .map(toml::Value::Integer)
        .or_else(|_| text.parse::<f64>().map(toml::Value::Float))
        .or_else(|_| text.parse::<bool>().map(toml::Value::Boolean))
        .unwrap_or_else(|_| toml::Value::String(text.trim_matches('"').to_string()));
    match table::find(name) {
        Some(spec) => assign(spec, &value, params),
        None => Some(unknown(name, &value)),
    }
}

/// Writes parameters as TOML, with unit and meaning as comments.
pub fn to_toml(params: &Params) -> String {
    let mut out = String::new();
    let mut section = "";
    for spec in table::specs() {
        let Some((head, key)) = spec.name.rsplit_once('.') else { continue };
        if head != section {
            out.push_str(&format!("\n[{head}]\n"));
            section = head;
        }
        let value = (spec.get)(params);
        let text = match (&value, spec.kind) {
            (Value::Text(t), _) => format!("{t:?}"),
            (_, Kind::Enumeration { .. }) => format!("{:?}", table::show(spec, &value)),
            (Value::Real(x), _) => format!("{x:?}"),
            _ => table::show(spec, &value),
        };
        let unit = match spec.kind {
            Kind::Real { unit, .. } if unit != "1" => format!("[{unit}] "),
            _ => String::new(),
        };
        out.push_str(&format!("{key} = {text}  # {unit}{}\n", spec.doc));
    }
    out.trim_start().to_string()
}

fn assign(spec: &ParamSpec, value: &toml::Value, params: &mut Params) -> Option<Problem> {
    let Some(value) = convert(spec, value) else {
        let (allowed, remedy) = wanted(spec.kind);
        return Some(Problem::new(spec.name, value.to_string(), allowed, remedy));
    };
    (spec.set)(params, &value);
    None
}

/// What a value of a kind looks like, and what to do about one that does not.
fn wanted(kind: Kind) -> (String, &'static str) {
    match kind {
        Kind::Enumeration { items, .. } => {
            let names: Vec<&str> = items.iter().map(|item| item.name).collect();
            (names.join(", "), "choose one of these")
        }
        Kind::Real { unit, .. } if unit != "1" => {
            (format!("a number in {unit}"), "write the number alone")
        }
        kind => (check::kind_name(kind).to_string(), "give a value of that kind"),
    }
}

fn convert(spec: &ParamSpec, value: &toml::Value) -> Option<Value> {
    match (spec.kind, value) {
        (Kind::Real { .. }, toml::Value::Float(x)) => Some(Value::Real(*x)),
        (Kind::Real { .. }, toml::Value::Integer(i)) => Some(Value::Real(*i as f64)),
        (Kind::Integer { .. }, toml::Value::Integer(i)) => {
            i32::try_from(*i).ok().map(Value::Integer)
        }
        (Kind::Boolean, toml::Value::Boolean(b)) => Some(Value::Boolean(*b)),
        (Kind::Text, toml::Value::String(t)) => Some(Value::Text(t.clone())),
        (Kind::Enumeration { items, .. }, toml::Value::String(t)) => {
            items.iter().position(|item| item.name == t).map(|at| Value::Integer(at as i32 + 1))
        }
        _ => None,
    }
}

fn flatten<'a>(prefix: &str, table: &'a toml::Table) -> Vec<(String, &'a toml::Value)> {
    let mut out = Vec::new();
    for (key, value) in table {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        match value {
            toml::Value::Table(inner) => out.extend(flatten(&name, inner)),
            _ => out.push((name, value)),
        }
    }
    out
}

fn unknown(name: &str, value: &toml::Value) -> Problem {
    let remedy = match nearest(name, table::specs().map(|s| s.name)) {
        Some(near) => format!("did you mean {near}? `tread fmu describe` lists all names"),
        None => format!("{}`tread fmu describe` lists all names", neighbours(name)),
    };
    Problem::new(name, value.to_string(), "a parameter of the model", remedy)
}

/// What else the table of this name holds, if it is a table of ours.
fn neighbours(name: &str) -> String {
    let table = name.rsplit_once('.').map_or(name, |(head, _)| head);
    let keys: Vec<&str> = table::specs()
        .filter_map(|s| s.name.strip_prefix(table)?.strip_prefix('.'))
        .filter(|key| !key.contains('.'))
        .collect();
    if keys.is_empty() {
        String::new()
    } else {
        format!("{table} has {}; ", keys.join(", "))
    }
}

/// The name that was probably meant: the nearest one, if no more than a third of it is otherwise.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    known
        .map(|known| (distance(known, name), known))
        .min_by_key(|(far, _)| *far)
        .filter(|(far, known)| 3 * far <= known.len())
        .map(|(_, known)| known)
}

/// Levenshtein distance of two names.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let cost = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = cost.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

/// Most of a wrong line that a message quotes [characters].
const QUOTED: usize = 60;

/// A TOML syntax error as a fault: the parser's words, its place, and the line there.
pub fn syntax(error: &toml::de::Error) -> Fault {
    // The parser shows "TOML parse error at line 2, column 7" first, and then "2 | the line".
    let shown = error.to_string();
    let place = shown.lines().next().and_then(|l| l.rsplit_once(" at ")).map_or("", |l| l.1);
    let quoted = shown.lines().find_map(|l| {
        l.split_once(" | ").filter(|(number, _)| number.trim().parse::<u32>().is_ok())
    });
    let line: String = quoted.map_or("", |l| l.1).trim().chars().take(QUOTED).collect();
    let message = error.message().replace('\n', ", ");
    Fault::one(Problem::new(
        format!("TOML, {place}"),
        format!("{line:?}: {message}"),
        "valid TOML",
        "mend that line; is it the right file?",
    ))
}
