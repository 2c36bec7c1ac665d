//! What a run amounts to, as a table for people and as JSON for programs.

use serde_json::json;

use crate::block::OUTPUTS;
use crate::error::{Fault, Problem};
use crate::metrics::{self, Recorder, Trace};
use crate::params::{table, Value};
use crate::scenario::{config::Config, Scenario};

/// Lines of the table: name, unit, value in that unit, meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    lines: Vec<Line>,
}

#[derive(Clone, Debug, PartialEq)]
struct Line {
    name: &'static str,
    unit: &'static str,
    value: f64,
}

/// Fewest rows that have a spectrum, or a period.
const FEWEST_ROWS: usize = 16;

/// Refuses a result that is too short for metrics and pictures.
pub fn enough_rows(rows: usize) -> Result<(), Fault> {
    if rows >= FEWEST_ROWS {
        return Ok(());
    }
    Err(Fault::one(Problem::new(
        "rows of the result",
        rows.to_string(),
        format!("{FEWEST_ROWS} or more"),
        "make run.duration longer or run.communication_step shorter",
    )))
}

/// Summary of a run.
pub fn of(config: &Config, recorder: &Recorder) -> Summary {
    let trace = recorder.trace();
    let line = |name, unit, value| Line { name, unit, value };
    let lines = match &config.scenario {
        Scenario::Slide(slide) => return of_sliding(&trace, slide.speed),
        Scenario::Roll(_) => vec![
            line(
                "displacement, peak to peak",
                "um",
                1e6 * metrics::peak_to_peak(trace.displacement),
            ),
            line("velocity, peak to peak", "mm/s", 1e3 * metrics::peak_to_peak(trace.velocity)),
            line("largest friction", "1", trace.friction.iter().fold(0.0, |a, f| f.abs().max(a))),
        ],
    };
    Summary { lines }
}

/// Summary of a sliding run at a road speed [m/s].
pub fn of_sliding(trace: &Trace, speed: f64) -> Summary {
    let found = metrics::stick_slip(trace, speed);
    let line = |name, unit, value| Line { name, unit, value };
    let lines = vec![
        line("stick-slip frequency", "Hz", found.frequency),
        line("regularity", "1", found.regularity),
        line("displacement, peak to peak", "um", 1e6 * found.displacement_amplitude),
        line("velocity, peak to peak", "mm/s", 1e3 * found.velocity_amplitude),
        line("mean friction", "1", found.mean_friction),
        line("stick fraction", "1", found.stick_fraction),
        line("settled from", "ms", 1e3 * found.settled_from),
    ];
    Summary { lines }
}

impl Summary {
    /// The table as text.
    pub fn text(&self) -> String {
        self.lines
            .iter()
            .map(|l| {
                let unit = if l.unit == "1" { "" } else { l.unit };
                format!("{:<28}{:>12.4} {unit}\n", l.name, l.value)
            })
            .collect()
    }

    /// The table as a JSON object.
    pub fn json(&self) -> serde_json::Value {
        let lines = self.lines.iter().map(|l| {
            let value = json!({ "value": l.value, "unit": l.unit });
            (l.name.to_string(), value)
        });
        serde_json::Value::Object(lines.collect())
    }
}

/// A run as JSON: version, parameters, units, summary, columns.
pub fn json(
    config: &Config,
    summary: &Summary,
    names: &[String],
    cells: &[Vec<f64>],
) -> serde_json::Value {
    let parameters: serde_json::Map<_, _> = table::specs()
        .map(|spec| {
            let value = match (spec.get)(&config.params) {
                Value::Real(x) => json!(x),
                Value::Boolean(b) => json!(b),
                other => json!(table::show(spec, &other)),
            };
            (spec.name.to_string(), value)
        })
        .collect();
    let columns: serde_json::Map<_, _> = names
        .iter()
        .zip(cells)
        .map(|(name, values)| (name.clone(), json!({ "unit": unit(name), "values": values })))
        .collect();
    json!({
        "tread_block": env!("CARGO_PKG_VERSION"),
        "parameters": parameters,
        "summary": summary.json(),
        "columns": columns,
    })
}

/// SI unit of a column.
pub fn unit(column: &str) -> &'static str {
    let name = column.split('[').next().unwrap_or(column);
    if name == "time" {
        return "s";
    }
    OUTPUTS.iter().find(|spec| spec.name == name).map_or("1", |spec| spec.unit)
}
