//! A run's file: the parameters by their dotted names and a `[run]` table that says what is done.

use std::path::Path;

use super::run_table::Reader;
use super::{belt_csv, BeltPath, Inputs, Plan, Roll, Scenario, Slide};
use crate::error::{Fault, Problem};
use crate::params::{check, load, NormalDrive, Params};

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
    std::fs::read_to_string(path).map_err(|error| Fault::file(path, &error))
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
    let run = take_run(&mut document, &mut problems);
    let chosen = document.get("drive").and_then(|d| d.get("normal")).is_some();
    let (mut params, found) = load::from_table(&document, Params::default());
    problems.extend(found);
    for set in param_sets {
        problems.extend(load::assign_text(set, &mut params));
    }
    let mut reader = Reader::of(&run, problems);
    if run.is_empty() {
        return Err(without_run(reader.problems, &params));
    }
    let built = reader.build(&run, &params, folder);
    let mut problems = reader.problems;
    if let Some((scenario, _)) = &built {
        let needed = scenario.normal_drive();
        if chosen && params.drive.normal != needed {
            problems.push(other_drive(params.drive.normal, needed));
        }
        params.drive.normal = needed;
    }
    problems.extend(check::problems(&params));
    match built {
        Some((scenario, plan)) if problems.is_empty() => Ok(Config { params, scenario, plan }),
        _ => Err(Fault::Invalid(problems)),
    }
}

/// Takes the table `[run]` out of a document; an empty one, and a problem, where there is none.
fn take_run(document: &mut toml::Table, problems: &mut Vec<Problem>) -> toml::Table {
    if let Some(toml::Value::Table(table)) = document.remove("run") {
        return table;
    }
    problems.push(Problem::new(
        "run",
        "missing",
        "a table [run] with [run.slide] or [run.roll]",
        "`tread init` writes an example",
    ));
    toml::Table::new()
}

/// A file that does not say what is done: its other problems, or else that one.
fn without_run(mut problems: Vec<Problem>, params: &Params) -> Fault {
    problems.extend(check::problems(params));
    if problems.is_empty() {
        problems.push(Problem::new(
            "[run]",
            "empty",
            "duration and one of the tables run.slide, run.roll",
            "say what the block does; `tread init slide` writes an example",
        ));
    }
    Fault::Invalid(problems)
}

/// A file that chose another normal drive than its run needs.
fn other_drive(chosen: NormalDrive, needed: NormalDrive) -> Problem {
    Problem::new(
        "drive.normal",
        format!("{chosen:?}").to_lowercase(),
        format!("{needed:?} for this run").to_lowercase(),
        "leave it out: a run sets it",
    )
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

impl Reader {
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
