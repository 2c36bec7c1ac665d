//! A run's file: the parameters by their dotted names and a `[run]` table that says what is done.

use std::path::Path;

use super::{belt_csv, BeltPath, Inputs, Plan, Roll, Scenario, Slide};
use crate::error::{Fault, Problem};
use crate::params::{check, load, Params};

/// One key of the `[run]` table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Dotted name below `run`, e.g. `slide.speed`.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Smallest allowed value.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
    /// Value where the key is not given; `None`: see `doc`.
    pub default: Option<f64>,
    /// What it is.
    pub doc: &'static str,
}

/// Numbers of the `[run]` table.
#[rustfmt::skip]
pub const KEYS: &[Key] = &[
    Key { name: "duration", unit: "s", min: 1e-6, max: 1e4, default: None, doc: "Length of the run; needed for slide, the whole path by default for roll" },
    Key { name: "communication_step", unit: "s", min: 1e-8, max: 0.1, default: Some(10e-6), doc: "Distance of the rows, and of the inputs where they are sampled" },
    Key { name: "slide.speed", unit: "m/s", min: -50.0, max: 50.0, default: None, doc: "Road speed; positive drags the block from run-in to run-out edge, negative reverses" },
    Key { name: "slide.speed_end", unit: "m/s", min: -50.0, max: 50.0, default: None, doc: "Road speed at the end of the run, reached linearly; as slide.speed by default" },
    Key { name: "slide.start_ramp", unit: "s", min: 0.0, max: 1.0, default: Some(0.5e-3), doc: "Duration of the linear start" },
    Key { name: "slide.dwell", unit: "s", min: 0.0, max: 1e3, default: Some(0.0), doc: "Rest under load before the road starts" },
    Key { name: "slide.mean_pressure", unit: "Pa", min: 1e3, max: 5e6, default: None, doc: "Load over length times width of the block; this or slide.load is needed" },
    Key { name: "slide.load", unit: "N", min: 1e-2, max: 1e6, default: None, doc: "Normal load; this or slide.mean_pressure is needed" },
    Key { name: "roll.wheel_radius", unit: "m", min: 0.05, max: 2.0, default: Some(0.3), doc: "Radius of the belt outside of the contact patch" },
    Key { name: "roll.contact_length", unit: "m", min: 0.01, max: 0.5, default: Some(0.12), doc: "Length of the flattened belt" },
    Key { name: "roll.belt_speed", unit: "m/s", min: 0.1, max: 150.0, default: None, doc: "Speed of the belt relative to the axle; this or roll.belt_file is needed" },
    Key { name: "roll.slip", unit: "1", min: -1.0, max: 1.0, default: Some(0.0), doc: "Sliding of the flat belt over its speed; positive brakes, negative drives" },
    Key { name: "roll.compression", unit: "m", min: 0.0, max: 0.05, default: Some(0.2e-3), doc: "How much lower than the undeformed block's height the flat belt runs" },
    Key { name: "roll.blend_length", unit: "m", min: 1e-4, max: 0.5, default: Some(0.02), doc: "Length of belt over which the curvature goes from the circle's to zero" },
    Key { name: "roll.lead", unit: "m", min: 1e-4, max: 1.0, default: Some(0.05), doc: "Length of belt before and behind the flat part" },
];

/// Texts of the `[run]` table: name, choices or kind, meaning.
pub const TEXT_KEYS: &[(&str, &str, &str)] = &[
    ("inputs", "exact, sampled", "exact: the motion itself; sampled: values at communication points, as an FMI master gives them"),
    ("roll.belt_file", "a CSV file", "Belt path with the columns time_s, belt_x_m, belt_z_m, belt_angle_rad, relative to this file"),
];

/// A run: block, motion, instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The block's parameters, with the normal drive that the scenario needs.
    pub params: Params,
    /// What is done to it.
    pub scenario: Scenario,
    /// At which instants.
    pub plan: Plan,
}

/// Reads a run's file; `sets` are assignments `name=value` that go over the file's values.
///
/// # Errors
/// [`Fault::File`], or all problems of the file, of `sets` and of a belt file at once.
pub fn read(path: &Path, sets: &[String]) -> Result<Config, Fault> {
    let text = read_text(path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    from_toml(&text, folder, sets)
}

/// Text of a file.
///
/// # Errors
/// [`Fault::File`].
pub fn read_text(path: &Path) -> Result<String, Fault> {
    std::fs::read_to_string(path).map_err(|error| Fault::File {
        path: path.display().to_string(),
        reason: error.to_string(),
    })
}

/// As [`read`], of a text; a belt file is looked for in `folder`.
///
/// # Errors
/// See [`read`].
pub fn from_toml(text: &str, folder: &Path, sets: &[String]) -> Result<Config, Fault> {
    let mut document: toml::Table = text.parse().map_err(|e| load::syntax(&e))?;
    let mut problems = Vec::new();
    let (run_sets, param_sets): (Vec<_>, Vec<_>) =
        sets.iter().partition(|s| s.trim_start().starts_with("run."));
    for set in run_sets {
        problems.extend(set_in(&mut document, set));
    }
    let run = match document.remove("run") {
        Some(toml::Value::Table(table)) => table,
        _ => {
            problems.push(Problem::new(
                "run",
                "missing",
                "a table [run] with [run.slide] or [run.roll]",
                "`tread init` writes an example",
            ));
            toml::Table::new()
        }
    };
    let chosen = document.get("drive").and_then(|d| d.get("normal")).is_some();
    let (mut params, found) = load::from_table(&document, Params::default());
    problems.extend(found);
    for set in param_sets {
        problems.extend(load::assign_text(set, &mut params));
    }
    let mut reader = Reader { numbers: Vec::new(), texts: Vec::new(), problems };
    reader.take("", &run);
    if run.is_empty() {
        reader.problems.extend(check::problems(&params));
        if reader.problems.is_empty() {
            reader.problems.push(Problem::new(
                "[run]",
                "empty",
                "duration and one of the tables run.slide, run.roll",
                "say what the block does; `tread init slide` writes an example",
            ));
        }
        return Err(Fault::Invalid(reader.problems));
    }
    let built = reader.build(&run, &params, folder);
    let mut problems = reader.problems;
    if let Some((scenario, _)) = &built {
        let needed = scenario.normal_drive();
        if chosen && params.drive.normal != needed {
            problems.push(Problem::new(
                "drive.normal",
                format!("{:?}", params.drive.normal).to_lowercase(),
                format!("{needed:?} for this run").to_lowercase(),
                "leave it out: a run sets it",
            ));
        }
        params.drive.normal = needed;
    }
    problems.extend(check::problems(&params));
    match built {
        Some((scenario, plan)) if problems.is_empty() => Ok(Config { params, scenario, plan }),
        _ => Err(Fault::Invalid(problems)),
    }
}

/// Puts `run.x.y=value` of the command line into the document.
fn set_in(document: &mut toml::Table, assignment: &str) -> Option<Problem> {
    let Some((name, value)) = assignment.split_once('=') else {
        return Some(Problem::new(
            "--set",
            assignment,
            "name=value",
            "write for example --set run.slide.speed=0.2",
        ));
    };
    let value = value.trim();
    let parsed: Result<toml::Table, _> = format!("v = {value}").parse();
    let value = parsed
        .ok()
        .and_then(|mut t| t.remove("v"))
        .unwrap_or_else(|| toml::Value::String(value.to_string()));
    let mut table = document;
    let parts: Vec<&str> = name.trim().split('.').collect();
    for part in &parts[..parts.len() - 1] {
        let next = table.entry(*part).or_insert_with(|| toml::Value::Table(toml::Table::new()));
        table = next.as_table_mut()?;
    }
    table.insert(parts[parts.len() - 1].to_string(), value);
    None
}

/// What a `[run]` table holds, and what is wrong with it.
struct Reader {
    numbers: Vec<(&'static str, f64)>,
    texts: Vec<(&'static str, String)>,
    problems: Vec<Problem>,
}

impl Reader {
    fn take(&mut self, prefix: &str, table: &toml::Table) {
        for (key, value) in table {
            let name = format!("{prefix}{key}");
            if let toml::Value::Table(inner) = value {
                self.take(&format!("{name}."), inner);
            } else if let Some(key) = KEYS.iter().find(|k| k.name == name) {
                self.number(key, value);
            } else if let Some((known, allowed, _)) = TEXT_KEYS.iter().find(|k| k.0 == name) {
                match value {
                    toml::Value::String(text) => self.texts.push((known, text.clone())),
                    _ => self.complain(&name, &value.to_string(), allowed, "put it in quotes"),
                }
            } else {
                let keys: Vec<&str> = KEYS.iter().map(|k| k.name).collect();
                let allowed = format!("one of {}, inputs, roll.belt_file", keys.join(", "));
                self.complain(&name, &value.to_string(), &allowed, "mend the key or drop it");
            }
        }
    }

    fn number(&mut self, key: &Key, value: &toml::Value) {
        let number = match value {
            toml::Value::Float(x) => *x,
            toml::Value::Integer(i) => *i as f64,
            _ => f64::NAN,
        };
        if number >= key.min && number <= key.max {
            self.numbers.push((key.name, number));
        } else {
            let allowed = format!("a number from {} to {} {}", key.min, key.max, key.unit);
            self.complain(key.name, &value.to_string(), &allowed, "give it in SI units");
        }
    }

    fn complain(&mut self, name: &str, value: &str, allowed: &str, remedy: &str) {
        self.problems.push(Problem::new(format!("run.{name}"), value, allowed, remedy));
    }

    fn given(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    fn or_default(&self, name: &str) -> f64 {
        let default = KEYS.iter().find(|k| k.name == name).and_then(|k| k.default);
        self.given(name).or(default).unwrap_or(0.0)
    }

    fn needed(&mut self, name: &str, remedy: &str) -> Option<f64> {
        let value = self.given(name);
        let unreadable = self.problems.iter().any(|p| p.what == format!("run.{name}"));
        if value.is_none() && !unreadable {
            let unit = KEYS.iter().find(|k| k.name == name).map_or("", |k| k.unit);
            self.complain(name, "missing", &format!("a number [{unit}]"), remedy);
        }
        value
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.texts.iter().find(|(known, _)| *known == name).map(|(_, text)| text.as_str())
    }

    /// Scenario and plan, if nothing that they need is wrong.
    fn build(
        &mut self,
        run: &toml::Table,
        params: &Params,
        folder: &Path,
    ) -> Option<(Scenario, Plan)> {
        let inputs = match self.text("inputs") {
            None | Some("exact") => Inputs::Exact,
            Some("sampled") => Inputs::Sampled,
            Some(other) => {
                let other = other.to_string();
                self.complain("inputs", &other, "exact, sampled", "choose one of these");
                Inputs::Exact
            }
        };
        let scenario = match (run.contains_key("slide"), run.contains_key("roll")) {
            (true, false) => self.slide(params).map(Scenario::Slide),
            (false, true) => self.roll(params, folder).map(Scenario::Roll),
            (both, _) => {
                let value = if both { "slide and roll" } else { "neither slide nor roll" };
                let remedy = "keep one table: [run.slide] or [run.roll]";
                self.complain("slide or roll", value, "exactly one of them", remedy);
                None
            }
        };
        let whole = match &scenario {
            Some(Scenario::Roll(roll)) => Some(roll.span().1 - roll.span().0),
            _ => None,
        };
        let duration = match self.given("duration").or(whole) {
            Some(duration) => Some(duration),
            None if run.contains_key("roll") => None,
            None => self.needed("duration", "write for example duration = 0.03"),
        };
        let step = self.or_default("communication_step");
        scenario.zip(duration.map(|duration| Plan { step, duration, inputs }))
    }

    fn slide(&mut self, params: &Params) -> Option<Slide> {
        let speed = self.needed("slide.speed", "write for example speed = 0.3");
        let area = params.block.length * params.block.width;
        let load = match (self.given("slide.load"), self.given("slide.mean_pressure")) {
            (Some(_), Some(pressure)) => {
                self.complain(
                    "slide.mean_pressure",
                    &pressure.to_string(),
                    "no pressure where slide.load is given",
                    "keep one of the two",
                );
                None
            }
            (Some(load), None) => Some(load),
            (None, Some(pressure)) => Some(pressure * area),
            (None, None) => self
                .needed("slide.mean_pressure", "write for example mean_pressure = 250e3, or a load")
                .map(|pressure| pressure * area),
        };
        let (speed, load) = (speed?, load?);
        let (start_ramp, dwell) =
            (self.or_default("slide.start_ramp"), self.or_default("slide.dwell"));
        let speed_end = self.given("slide.speed_end").unwrap_or(speed);
        let run = self.given("duration").unwrap_or(0.0) - dwell;
        let sweep = if speed_end == speed { 0.0 } else { run };
        if speed_end != speed && run <= start_ramp {
            self.complain(
                "duration",
                &(run + dwell).to_string(),
                "longer than slide.dwell + slide.start_ramp where the speed changes",
                "lengthen the run",
            );
        }
        Some(Slide { speed, speed_end, sweep, start_ramp, dwell, load })
    }

    fn roll(&mut self, params: &Params, folder: &Path) -> Option<Roll> {
        let samples = if let Some(file) = self.text("roll.belt_file") {
            belt_csv::read(&folder.join(file))
        } else {
            let speed = self.needed(
                "roll.belt_speed",
                "write for example belt_speed = 15.0, or name a belt_file",
            )?;
            let path = BeltPath {
                radius: self.or_default("roll.wheel_radius"),
                contact_length: self.or_default("roll.contact_length"),
                speed,
                slip: self.or_default("roll.slip"),
                height: params.block.height - self.or_default("roll.compression"),
                blend_length: self.or_default("roll.blend_length"),
                lead: self.or_default("roll.lead"),
            };
            path.samples(5e-6)
        };
        match samples.and_then(|samples| Roll::through(&samples)) {
            Ok(roll) => Some(roll),
            Err(Fault::Invalid(found)) => {
                self.problems.extend(found);
                None
            }
            Err(other) => {
                let file = self.text("roll.belt_file").unwrap_or("").to_string();
                self.complain("roll.belt_file", &file, "a readable CSV file", &other.to_string());
                None
            }
        }
    }
}
