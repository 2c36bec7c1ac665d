//! Cases for a master of the FMU: what to set for a point, and what its outputs amount to.
//!
//! A driver that runs the FMU elsewhere asks line by line on the standard input, in JSON, and gets a line
//! for each. So the plan and the measures have one implementation, and a driver writes the very lines
//! of the journal. Arrays of numbers are hexadecimal little-endian doubles: exact, and quick to read.
//!
//! - `{"case": 3}` → `{"point": 3, "time": "…", "parameters": {…}, "inputs": {"belt.x": "…", …}}`, with
//!   those parameters that differ from the FMU's own start values; or `{"point": 3, "line": "…"}`
//!   for a point that cannot run.
//! - `{"measure": 3, "outputs": ["…", …]}` → `{"point": 3, "line": "…"}`, outputs as the greeting names
//!   them, one value per time of the case.
//! - `{"failed": 3, "reason": "…"}` → `{"point": 3, "line": "…"}`.

use std::io::{BufRead, Write};

use serde_json::{json, Map, Value};

use super::journal::{header, Record};
use super::measures::{Traces, OUTPUT_NAMES};
use super::plan::Plan;
use crate::block::INPUTS;
use crate::error::{Fault, Problem};
use crate::params::{table, Params, Value as Of};
use crate::scenario::{config::Config, Inputs};

/// Greets, then answers every line of `questions` until they end.
///
/// # Errors
/// Reading or writing that fails; a line that is no question.
pub fn serve(plan: &Plan, questions: impl BufRead, mut answers: impl Write) -> Result<(), Fault> {
    let pipe = |e: std::io::Error| Fault::unusable("standard input or output", e);
    let greeting = json!({
        "points": plan.points.len(),
        "header": header(plan),
        "outputs": OUTPUT_NAMES,
    });
    writeln!(answers, "{greeting}").and_then(|()| answers.flush()).map_err(pipe)?;
    for line in questions.lines() {
        let line = line.map_err(pipe)?;
        let answer = answer(plan, &line).ok_or_else(|| not_a_question(&line))?;
        writeln!(answers, "{answer}").and_then(|()| answers.flush()).map_err(pipe)?;
    }
    Ok(())
}

fn not_a_question(line: &str) -> Fault {
    let shown: String = line.chars().take(60).collect();
    let allowed =
        "{\"case\": N}, {\"measure\": N, \"outputs\": […]}, {\"failed\": N, \"reason\": …}";
    Fault::one(Problem::new("question", shown, allowed, "see docs/src/sweep.md"))
}

/// The answer to a line; `None` if it is no question.
fn answer(plan: &Plan, line: &str) -> Option<Value> {
    let question: Value = serde_json::from_str(line).ok()?;
    let point = |key: &str| {
        let at = question.get(key).and_then(Value::as_u64)?;
        usize::try_from(at).ok().filter(|at| *at < plan.points.len())
    };
    let closed = |record: Record| json!({ "point": record.point, "line": record.line() });
    if let Some(point) = point("case") {
        return Some(match plan.config(point).and_then(|config| case(point, &config)) {
            Ok(case) => case,
            Err(fault) => closed(Record { point, outcome: Err(fault.to_string()) }),
        });
    }
    if let Some(point) = point("failed") {
        let reason = question.get("reason")?.as_str()?.to_string();
        return Some(closed(Record { point, outcome: Err(reason) }));
    }
    let point = point("measure")?;
    let config = plan.config(point).ok()?;
    let outputs = question.get("outputs")?.as_array()?;
    let columns: Option<Vec<Vec<f64>>> = outputs.iter().map(|o| from_hex(o.as_str()?)).collect();
    let traces = Traces { time: times(&config), outputs: columns?.try_into().ok()? };
    let fits = traces.outputs.iter().all(|column| column.len() == traces.time.len());
    let outcome = Ok(traces.measures(&config));
    fits.then(|| closed(Record { point, outcome }))
}

/// Communication points \[s\], as [`crate::scenario::run`] counts them.
fn times(config: &Config) -> Vec<f64> {
    let (start, plan) = (config.scenario.start(), &config.plan);
    let end = start + plan.duration;
    let later = (1..=plan.rows()).map(|k| (start + k as f64 * plan.step).min(end));
    std::iter::once(start).chain(later).collect()
}

/// # Errors
/// A plan with exact inputs, which no master can give.
fn case(point: usize, config: &Config) -> Result<Value, Fault> {
    if config.plan.inputs != Inputs::Sampled {
        return Err(Fault::one(Problem::new(
            "run.inputs",
            "exact",
            "sampled where a master runs the FMU",
            "leave it out of the plan",
        )));
    }
    config.plan.check()?;
    let times = times(config);
    let inputs: Map<String, Value> = INPUTS
        .iter()
        .map(|spec| {
            let values = times.iter().map(|t| (spec.get)(&config.scenario.pose(*t)));
            (spec.name.to_string(), json!(to_hex(values)))
        })
        .collect();
    Ok(json!({
        "point": point,
        "time": to_hex(times.iter().copied()),
        "parameters": changed(&config.params),
        "inputs": inputs,
    }))
}

/// Parameters that are not the FMU's own start values.
fn changed(params: &Params) -> Map<String, Value> {
    let start = Params::default();
    table::specs()
        .filter(|spec| (spec.get)(params) != (spec.get)(&start))
        .map(|spec| {
            let value = match (spec.get)(params) {
                Of::Real(x) => json!(x),
                Of::Integer(i) => json!(i),
                Of::Boolean(b) => json!(b),
                Of::Text(t) => json!(t),
            };
            (spec.name.to_string(), value)
        })
        .collect()
}

/// Numbers by their bytes, little endian: no digit is lost between two languages.
fn to_hex(values: impl Iterator<Item = f64>) -> String {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    let digits = |byte: u8| [byte >> 4, byte & 15].map(|d| char::from(DIGITS[usize::from(d)]));
    values.flat_map(f64::to_le_bytes).flat_map(digits).collect()
}

/// The numbers of [`to_hex`].
fn from_hex(text: &str) -> Option<Vec<f64>> {
    let digit = |c: &u8| char::from(*c).to_digit(16).map(|d| d as u8);
    let pairs = text.as_bytes().chunks(2);
    let bytes: Option<Vec<u8>> =
        pairs.map(|pair| Some(digit(pair.first()?)? << 4 | digit(pair.get(1)?)?)).collect();
    let number = |eight: &[u8]| Some(f64::from_le_bytes(eight.try_into().ok()?));
    bytes?.chunks(8).map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_numbers_come_back_bit_for_bit() {
        let values = [1.0 / 3.0, -0.0, 5e-324, f64::MAX];
        let back = from_hex(&to_hex(values.into_iter())).unwrap();
        assert_eq!(back.len(), 4);
        assert!(back.iter().zip(values).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert_eq!(from_hex("zz"), None);
        assert_eq!(from_hex("3ff"), None);
    }
}
