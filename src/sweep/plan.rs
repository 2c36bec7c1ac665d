//! The plan: a run's file with a `[sweep]` table, and the points that it stands for.

use std::path::{Path, PathBuf};

use toml::Value;

use super::axis::{fitting, Axis, Column};
use super::design::{self, Method, SOBOL_LIMITS};
use crate::error::{Fault, Problem};
use crate::params::{load, table, Params};
use crate::scenario::config::{self, Config};
use crate::scenario::run_table::KEYS;

/// Most points of a plan: the journal of one is then about a gigabyte.
const MOST_POINTS: usize = 5_000_000;

/// A plan and its points.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What is varied, in the order of the names.
    pub axes: Vec<Axis>,
    /// Values of every point, axis by axis.
    pub points: Vec<Vec<Value>>,
    /// The run's file without the sweep.
    base: String,
    folder: PathBuf,
}

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// [`Fault::File`], or all problems of the `[sweep]` table at once.
    pub fn read(path: &Path) -> Result<Self, Fault> {
        let text = config::read_text(path)?;
        Self::from_toml(&text, path.parent().unwrap_or(Path::new(".")))
    }

    /// As [`Self::read`], of a text; files that it names are looked for in `folder`.
    ///
    /// # Errors
    /// See [`Self::read`].
    pub fn from_toml(text: &str, folder: &Path) -> Result<Self, Fault> {
        let mut document: toml::Table = text.parse().map_err(|e| load::syntax(&e))?;
        let Some(Value::Table(sweep)) = document.remove("sweep") else {
            return Err(Fault::one(Problem::new(
                "sweep",
                "missing",
                "a table [sweep] with method and [sweep.vary]",
                "see examples/sweep.toml",
            )));
        };
        // As an FMI master gives them, so that the FMU on any machine gives the same bits.
        if let Some(Value::Table(run)) = document.get_mut("run") {
            run.entry("inputs").or_insert_with(|| Value::String("sampled".to_string()));
        }
        let mut reader = Reader { problems: Vec::new() };
        let design = reader.read(&sweep, &document);
        let Some(design) = design.filter(|_| reader.problems.is_empty()) else {
            return Err(Fault::Invalid(reader.problems));
        };
        let Design { method, points, seed, axes, base } = design;
        Ok(Self {
            points: design::points(method, &axes, &base, points, seed),
            axes,
            base: document.to_string(),
            folder: folder.to_path_buf(),
        })
    }

    /// The run of point `index`.
    ///
    /// # Errors
    /// What is wrong with that point's parameters.
    pub fn config(&self, index: usize) -> Result<Config, Fault> {
        let values = self.axes.iter().zip(&self.points[index]);
        let sets: Vec<String> = values.map(|(a, value)| format!("{}={value}", a.name)).collect();
        config::from_toml(&self.base, &self.folder, &sets)
    }

    /// A number that changes with anything that the plan says (FNV-1a over its base and points).
    pub fn fingerprint(&self) -> String {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut eat = |text: &str| {
            for byte in text.bytes().chain([0]) {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        eat(&self.base);
        self.axes.iter().for_each(|axis| eat(&axis.name));
        self.points.iter().flatten().for_each(|value| eat(&value.to_string()));
        format!("{hash:016x}")
    }
}

/// What a `[sweep]` table asks for.
struct Design {
    method: Method,
    points: usize,
    seed: u64,
    axes: Vec<Axis>,
    base: Vec<Value>,
}

struct Reader {
    problems: Vec<Problem>,
}

impl Reader {
    fn complain(&mut self, key: &str, value: &str, allowed: &str, remedy: &str) {
        self.problems.push(Problem::new(format!("sweep.{key}"), value, allowed, remedy));
    }

    fn read(&mut self, sweep: &toml::Table, document: &toml::Table) -> Option<Design> {
        let known = ["method", "points", "seed", "vary"];
        for (key, value) in sweep.iter().filter(|(key, _)| !known.contains(&key.as_str())) {
            self.complain(key, &value.to_string(), "method, points, seed, vary", "mend the key");
        }
        let method = self.method(sweep);
        let axes = self.axes(sweep);
        let base = axes.iter().map(|axis| self.base(axis, document, method)).collect();
        let method = method?;
        let points = self.points(sweep, method, &axes);
        let seed = match sweep.get("seed") {
            None => 1,
            Some(Value::Integer(i)) if *i >= 0 => *i as u64,
            Some(other) => {
                let allowed = "a whole number from 0";
                self.complain("seed", &other.to_string(), allowed, "leave it out for 1");
                1
            }
        };
        Some(Design { method, points, seed, axes, base })
    }

    fn method(&mut self, sweep: &toml::Table) -> Option<Method> {
        let given = sweep.get("method").and_then(Value::as_str).unwrap_or("missing");
        let found = Method::ALL.iter().find(|(name, _)| *name == given).map(|(_, method)| *method);
        if found.is_none() {
            let names = Method::ALL.map(|(name, _)| name).join(", ");
            self.complain("method", given, &names, "choose one of these");
        }
        found
    }

    fn axes(&mut self, sweep: &toml::Table) -> Vec<Axis> {
        let mut axes = Vec::new();
        match sweep.get("vary") {
            Some(Value::Table(vary)) if !vary.is_empty() => {
                for (name, value) in vary {
                    match Axis::read(name, value) {
                        Ok(axis) => axes.push(axis),
                        Err(problem) => self.problems.push(problem),
                    }
                }
            }
            _ => self.complain(
                "vary",
                "missing",
                "a table [sweep.vary] with at least one name",
                "write for example \"friction.mu_inf\" = [0.4, 0.5, 0.6]",
            ),
        }
        axes
    }

    /// The file's own value of an axis, or its default; a one-at-a-time plan cannot do without.
    fn base(&mut self, axis: &Axis, document: &toml::Table, method: Option<Method>) -> Value {
        let mut at = Some(document);
        let mut found = None;
        for part in axis.name.split('.') {
            found = at.and_then(|table| table.get(part));
            at = found.and_then(Value::as_table);
        }
        let given = found.and_then(|value| fitting(value, axis.column));
        if let Some(value) = given.or_else(|| default(axis)) {
            return value;
        }
        if method == Some(Method::OneAtATime) {
            let what = format!("vary.{}", axis.name);
            let allowed = "a name whose own value the file gives, for one_at_a_time";
            self.complain(&what, "no base value", allowed, "give it in the file");
        }
        axis.level(0)
    }

    fn points(&mut self, sweep: &toml::Table, method: Method, axes: &[Axis]) -> usize {
        let points = match sweep.get("points") {
            Some(Value::Integer(i)) if *i >= 1 && method.samples() => *i as usize,
            None if !method.samples() => 0,
            other => {
                let value = other.map_or("missing".to_string(), Value::to_string);
                let allowed = "a whole number from 1 for latin_hypercube and sobol, none else";
                self.complain("points", &value, allowed, "write for example points = 256");
                return 0;
            }
        };
        let (most_axes, most_points) = SOBOL_LIMITS;
        if method == Method::Sobol && (axes.len() > most_axes || points > most_points) {
            let allowed = format!("at most {most_points} points over {most_axes} names for sobol");
            self.complain("points", &points.to_string(), &allowed, "take latin_hypercube");
        }
        match design::count(method, axes, points) {
            Some(count) if count <= MOST_POINTS => {}
            _ => {
                let allowed = format!("a plan of at most {MOST_POINTS} points");
                self.complain("vary", "more points", &allowed, "lower a count");
            }
        }
        if self.problems.is_empty() {
            points
        } else {
            0
        }
    }
}

/// The model's own value where the file gives none.
fn default(axis: &Axis) -> Option<Value> {
    if let Some(key) = axis.name.strip_prefix("run.") {
        return KEYS.iter().find(|k| k.name == key)?.default.map(Value::Float);
    }
    use crate::params::Value as Of;
    let spec = table::find(&axis.name)?;
    Some(match (spec.get)(&Params::default()) {
        Of::Real(x) => Value::Float(x),
        Of::Boolean(b) => Value::Boolean(b),
        Of::Integer(i) if axis.column == Column::Integer => Value::Integer(i64::from(i)),
        other => Value::String(table::show(spec, &other)),
    })
}
