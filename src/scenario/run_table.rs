//! The `[run]` table: which keys it may hold, and what a given one holds.

use crate::error::{number, Problem};
use crate::params::load;

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

/// What a `[run]` table holds, and what is wrong with it.
pub(super) struct Reader {
    numbers: Vec<(&'static str, f64)>,
    texts: Vec<(&'static str, String)>,
    /// What is wrong so far.
    pub problems: Vec<Problem>,
}

impl Reader {
    /// Reads a table; `problems` are those that were found before.
    pub fn of(run: &toml::Table, problems: Vec<Problem>) -> Self {
        let mut reader = Self { numbers: Vec::new(), texts: Vec::new(), problems };
        reader.take("", run);
        reader
    }

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
                let (allowed, remedy) = known(&name);
                self.complain(&name, &value.to_string(), &allowed, &remedy);
            }
        }
    }

    fn number(&mut self, key: &Key, value: &toml::Value) {
        let given = match value {
            toml::Value::Float(x) => *x,
            toml::Value::Integer(i) => *i as f64,
            _ => f64::NAN,
        };
        if given >= key.min && given <= key.max {
            self.numbers.push((key.name, given));
        } else {
            let unit = if key.unit == "1" { String::new() } else { format!(" {}", key.unit) };
            let allowed = format!("a number from {} to {}{unit}", number(key.min), number(key.max));
            self.complain(key.name, &value.to_string(), &allowed, "give it in SI units");
        }
    }

    /// Notes a problem of the key `name`.
    pub fn complain(&mut self, name: &str, value: &str, allowed: &str, remedy: &str) {
        self.problems.push(Problem::new(format!("run.{name}"), value, allowed, remedy));
    }

    /// The number of a key, if it is there and good.
    pub fn given(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    /// The number of a key, or its default.
    pub fn or_default(&self, name: &str) -> f64 {
        let default = KEYS.iter().find(|k| k.name == name).and_then(|k| k.default);
        self.given(name).or(default).unwrap_or(0.0)
    }

    /// The number of a key that has to be there.
    pub fn needed(&mut self, name: &str, remedy: &str) -> Option<f64> {
        let value = self.given(name);
        let unreadable = self.problems.iter().any(|p| p.what == format!("run.{name}"));
        if value.is_none() && !unreadable {
            let unit = KEYS.iter().find(|k| k.name == name).map_or("", |k| k.unit);
            self.complain(name, "missing", &format!("a number [{unit}]"), remedy);
        }
        value
    }

    /// The text of a key.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.texts.iter().find(|(known, _)| *known == name).map(|(_, text)| text.as_str())
    }
}

/// What is allowed instead of an unknown key: the one that was probably meant, or all of them.
fn known(name: &str) -> (String, String) {
    let names = || KEYS.iter().map(|k| k.name).chain(TEXT_KEYS.iter().map(|k| k.0));
    match load::nearest(name, names()) {
        Some(near) => {
            let allowed = "one of the keys that `tread init` writes".to_string();
            (allowed, format!("did you mean run.{near}?"))
        }
        None => {
            let all: Vec<&str> = names().collect();
            (format!("one of {}", all.join(", ")), "mend the key or drop it".to_string())
        }
    }
}
