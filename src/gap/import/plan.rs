//! The import plan: a campaign file that also says where each channel comes from.

use serde::Deserialize;
use toml::{Table as Toml, Value};

use super::table::Dialect;
use super::units::{self, Dimension};
use crate::error::{Fault, Problem};
use crate::gap::campaign::CHANNELS;

/// First line of a plan.
pub const FORMAT: &str = "tread-block-import/1";
/// What a campaign file has and a plan must have, too.
const TABLES: [&str; 5] = ["block", "rig", "channels", "nominal", "runs"];

/// A column and its unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeColumn {
    /// Name in the header.
    pub column: String,
    /// Unit; that of the header if not given.
    pub unit: Option<String>,
}

/// Where a channel comes from.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Name in the header.
    pub column: String,
    /// Unit; that of the header if not given.
    pub unit: Option<String>,
    /// Time column of its own, for loggers with several rates.
    pub time: Option<TimeColumn>,
    /// How much later the channel shows what happened, as a time with its unit.
    pub delay: Option<String>,
    /// Standard deviation of the noise, SI or with unit.
    noise_std: Value,
    /// For people.
    meaning: Option<String>,
}

/// When the road starts: the first crossing of a level.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trigger {
    /// Column that rises when the road starts.
    pub column: String,
    /// Level of its magnitude, in the column's own unit.
    pub above: f64,
}

/// Where a run comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSource {
    /// File of the campaign.
    pub file: String,
    /// File of the logger.
    pub from: String,
    /// Instant of the start in the logger's time \[s\].
    pub start: Option<f64>,
    /// Length \[s\]; as far as the record goes if not given.
    pub duration: Option<f64>,
    /// Is the block struck instead of dragged?
    pub ringdown: bool,
}

/// A plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The campaign file to be written; durations of runs may be missing.
    pub campaign: Toml,
    /// How the CSV files are written.
    pub dialect: Dialect,
    /// Samples per second of the campaign \[Hz\].
    pub rate: f64,
    /// The time column of channels without their own.
    pub time: TimeColumn,
    /// Sources by channel.
    pub channels: Vec<(usize, Source)>,
    /// Delays \[s\] of `channels`.
    pub delays: Vec<f64>,
    /// What starts a sliding run without `start`.
    pub trigger: Option<Trigger>,
    /// Runs.
    pub runs: Vec<RunSource>,
}

/// Collects what is wrong.
struct Told(Vec<Problem>);

impl Told {
    fn add(&mut self, what: impl Into<String>, value: &str, allowed: &str, remedy: &str) {
        self.0.push(Problem::new(what, value, allowed, remedy));
    }

    /// A part of the plan as what it should be.
    fn part<'a, T: Deserialize<'a>>(&mut self, what: &str, value: Value) -> Option<T> {
        let reason = match value.try_into() {
            Ok(part) => return Some(part),
            Err(e) => toml::de::Error::to_string(&e),
        };
        let allowed = "as docs/src/own-campaign.md has it";
        self.add(what, reason.trim(), allowed, "compare the table with the page");
        None
    }

    /// A time with its unit \[s\].
    fn time(&mut self, what: String, text: &str) -> Option<f64> {
        let value = units::quantity(Dimension::Time, text);
        if value.is_none() {
            let allowed = "a number with a unit of time such as \"12.5 ms\"";
            self.add(what, &format!("{text:?}"), allowed, "write number, blank, unit");
        }
        value
    }
}

/// Reads a plan.
///
/// # Errors
/// All that is wrong with it.
pub fn parse(text: &str, shown: &str) -> Result<Plan, Fault> {
    let unread = |e: toml::de::Error| Fault::unusable(shown, e.to_string().trim());
    let mut file: Toml = text.parse().map_err(unread)?;
    let mut told = Told(Vec::new());
    let format = file.get("format").and_then(Value::as_str).unwrap_or("missing").to_string();
    if format != FORMAT {
        told.add("format", &format, FORMAT, "see docs/src/own-campaign.md");
    }
    for name in TABLES.iter().filter(|name| !file.contains_key(**name)) {
        told.add(*name, "missing", "a table as in campaign.toml", "see docs/src/own-campaign.md");
    }
    let known = ["format", "id", "source", "start"];
    for key in file.keys().filter(|k| !known.contains(&k.as_str()) && !TABLES.contains(&k.as_str()))
    {
        told.add(
            key.clone(),
            "unknown key",
            "format, id, source, start and the campaign's",
            "remove it",
        );
    }
    let dialect = file.remove("source").and_then(|v| told.part("source", v)).unwrap_or_default();
    let trigger = file.remove("start").and_then(|v| told.part("start", v));
    let (rate, time, channels) = channels(&mut file, &mut told);
    let delays = channels
        .iter()
        .map(|(c, source)| {
            let what = format!("channels.{}.delay", CHANNELS[*c]);
            source.delay.as_ref().and_then(|d| told.time(what, d)).unwrap_or(0.0)
        })
        .collect();
    let runs = runs(&mut file, trigger.is_some(), &mut told);
    file.insert("format".into(), "tread-block-campaign/1".into());
    match (time, told.0.is_empty()) {
        (Some(time), true) => {
            Ok(Plan { campaign: file, dialect, rate, time, channels, delays, trigger, runs })
        }
        _ => Err(Fault::Invalid(told.0)),
    }
}

/// Takes the sources out of `[channels]` and leaves there what a campaign file has.
fn channels(file: &mut Toml, told: &mut Told) -> (f64, Option<TimeColumn>, Vec<(usize, Source)>) {
    let Some(Value::Table(table)) = file.get_mut("channels") else {
        return (0.0, None, Vec::new());
    };
    let rate = table.get("sampling_rate_hz").and_then(number).unwrap_or(0.0);
    if rate <= 0.0 || !rate.is_finite() {
        let remedy = "give the campaign's rate; that of the logger is best";
        told.add("channels.sampling_rate_hz", &rate.to_string(), "more than 0", remedy);
    }
    let time = match table.remove("time") {
        Some(value) => told.part("channels.time", value),
        None => {
            let allowed = "{ column = \"t\", unit = \"ms\" }";
            told.add("channels.time", "missing", allowed, "name the column with the time");
            None
        }
    };
    let mut found = Vec::new();
    for (c, name) in CHANNELS.iter().enumerate() {
        let Some(value) = table.remove(*name) else { continue };
        let Some((source, kept)) = channel(c, value, told) else { continue };
        table.insert((*name).into(), kept.into());
        found.push((c, source));
    }
    let strange = |k: &&String| *k != "sampling_rate_hz" && !CHANNELS.contains(&k.as_str());
    for key in table.keys().filter(strange) {
        told.add(format!("channels.{key}"), "unknown channel", &CHANNELS.join(", "), "rename it");
    }
    if !found.iter().any(|(c, _)| *c < 3) {
        told.add("channels", "none of force and edge velocity", &CHANNELS.join(", "), "map one");
    }
    (rate, time, found)
}

/// Where the channel `c` comes from, and what a campaign file says of it.
fn channel(c: usize, value: Value, told: &mut Told) -> Option<(Source, Toml)> {
    let what = format!("channels.{}", CHANNELS[c]);
    let source: Source = told.part(&what, value)?;
    let noise = match &source.noise_std {
        Value::String(text) => units::quantity(Dimension::OF_CHANNELS[c], text),
        other => number(other),
    };
    let Some(noise) = noise.filter(|n| *n >= 0.0) else {
        let allowed = "0 or more, in SI or with a unit such as \"0.25 N\"";
        told.add(format!("{what}.noise_std"), &source.noise_std.to_string(), allowed, "mend it");
        return None;
    };
    let meaning = source.meaning.clone().unwrap_or_else(|| format!("column {}", source.column));
    let mut kept = Toml::new();
    kept.insert("noise_std".into(), noise.into());
    kept.insert("meaning".into(), meaning.into());
    Some((source, kept))
}

/// Takes `from` and `start` out of `[[runs]]`.
fn runs(file: &mut Toml, triggered: bool, told: &mut Told) -> Vec<RunSource> {
    let Some(Value::Array(runs)) = file.get_mut("runs") else { return Vec::new() };
    let mut found: Vec<RunSource> = Vec::new();
    for (at, run) in runs.iter_mut().enumerate() {
        let Value::Table(run) = run else { continue };
        let text = |run: &Toml, key: &str| run.get(key).and_then(Value::as_str).map(str::to_string);
        let (name, from) = (text(run, "file"), text(run, "from"));
        let file = name.unwrap_or_else(|| format!("runs/{at:02}.csv"));
        let Some(from) = from else {
            let allowed = "path of a CSV file, relative to the plan";
            told.add(format!("{file}: from"), "missing", allowed, "say where the run comes from");
            continue;
        };
        let inside = std::path::Path::new(&file)
            .components()
            .all(|c| matches!(c, std::path::Component::Normal(_)));
        if !inside || !file.ends_with(".csv") || found.iter().any(|r| r.file == file) {
            let allowed = "a path of its own below the campaign's folder that ends in .csv";
            told.add(format!("{file}: file"), &file, allowed, "choose another name");
        }
        let ringdown = run.get("kind").and_then(Value::as_str) == Some("ringdown");
        let start = text(run, "start").map(|t| told.time(format!("{file}: start"), &t));
        if start.is_none() && (ringdown || !triggered) {
            let allowed = "an instant such as \"12.5 ms\" in the file's own time";
            let remedy = if ringdown {
                "say when the block is struck; [start] serves sliding runs only"
            } else {
                "say when the road starts, or give a level of a column in [start]"
            };
            told.add(format!("{file}: start"), "missing", allowed, remedy);
        }
        let duration = run.get("duration_s").and_then(number);
        run.remove("from");
        run.remove("start");
        run.insert("file".into(), file.clone().into());
        found.push(RunSource { file, from, start: start.flatten(), duration, ringdown });
    }
    found
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}
