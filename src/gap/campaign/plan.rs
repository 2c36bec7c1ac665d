//! What a campaign file says: block, rig, channels, datasheet and the settings of the runs.

use super::{CHANNELS, CHANNEL_COUNT};
use crate::error::{Fault, Problem};
use crate::gap::quality;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What is done in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunKind {
    /// Free block, struck.
    Ringdown,
    /// Constant road speed.
    Sliding,
    /// Road speed that changes linearly.
    SpeedRamp,
}

/// Settings of a run, as the campaign file gives them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RunSpec {
    /// File, relative to the campaign's folder.
    pub file: String,
    /// What is done.
    pub kind: RunKind,
    /// Road speed \[m/s\].
    #[serde(default)]
    pub road_speed_m_s: f64,
    /// Road speed at the end of a ramp \[m/s\].
    pub road_speed_end_m_s: Option<f64>,
    /// Mean pressure \[Pa\].
    #[serde(default)]
    pub mean_pressure_pa: f64,
    /// Rest under load before the start \[s\].
    #[serde(default)]
    pub dwell_s: f64,
    /// Length of the record \[s\].
    pub duration_s: f64,
}

/// Size of the block.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct BlockSize {
    /// Length \[m\].
    pub length_m: f64,
    /// Height \[m\].
    pub height_m: f64,
    /// Width \[m\].
    pub width_m: f64,
}

/// The rig.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Rig {
    /// Mass of the carriage \[kg\].
    pub load_carriage_mass_kg: f64,
    /// Damping of the carriage \[N s/m\].
    pub load_carriage_damping_n_s_m: f64,
    /// Linear start of the road \[s\].
    pub start_ramp_s: f64,
}

/// A parameter of the datasheet.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Datum {
    /// Median, in the unit of its name.
    pub value: f64,
    /// Relative standard deviation, log-normal \[-\].
    pub relative_std: f64,
}

/// Everything of a campaign file but the runs' data.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name.
    pub id: String,
    /// Size of the block.
    pub block: BlockSize,
    /// The rig.
    pub rig: Rig,
    /// Samples per second \[Hz\].
    pub sampling_rate: f64,
    /// Standard deviation of the noise per channel, in its unit; `None` for a channel that the file does not name.
    pub noise: [Option<f64>; CHANNEL_COUNT],
    /// Datasheet by the names of the campaign file.
    pub nominal: BTreeMap<String, Datum>,
    /// Runs.
    pub runs: Vec<RunSpec>,
}

#[derive(Deserialize)]
struct PlanFile {
    format: String,
    id: String,
    block: BlockSize,
    rig: Rig,
    channels: toml::Table,
    nominal: BTreeMap<String, Datum>,
    #[serde(default)]
    runs: Vec<RunSpec>,
}

/// Reads a campaign file.
///
/// # Errors
/// [`Fault::File`] or what is wrong with it.
pub fn read_plan(path: &Path) -> Result<Plan, Fault> {
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
    parse_plan(&text, &path.display().to_string())
}

/// The same from the text of a campaign file; `shown` names it.
///
/// # Errors
/// What is wrong with it.
pub fn parse_plan(text: &str, shown: &str) -> Result<Plan, Fault> {
    let file: PlanFile =
        toml::from_str(text).map_err(|e| Fault::unusable(shown, e.to_string().trim()))?;
    let mut problems = Vec::new();
    if file.format != "tread-block-campaign/1" {
        problems.push(Problem::new(
            "format",
            &file.format,
            "tread-block-campaign/1",
            "convert the campaign to this format",
        ));
    }
    let rate = file.channels.get("sampling_rate_hz").and_then(number).unwrap_or(0.0);
    if rate.is_nan() || rate <= 0.0 {
        problems.push(Problem::new(
            "channels.sampling_rate_hz",
            rate.to_string(),
            "more than 0",
            "give the sampling rate",
        ));
    }
    problems.extend(quality::of_plan(&file.block, &file.rig, &file.runs));
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    let noise = CHANNELS
        .map(|name| file.channels.get(name).and_then(|c| c.get("noise_std")).and_then(number));
    Ok(Plan {
        id: file.id,
        block: file.block,
        rig: file.rig,
        sampling_rate: rate,
        noise,
        nominal: file.nominal,
        runs: file.runs,
    })
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}
