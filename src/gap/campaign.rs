//! A measured campaign: `campaign.toml` and one CSV per run.

use super::packed::Source;
use super::quality;
use crate::error::{Fault, Problem};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Measured quantities, in the order of [`CHANNELS`].
pub const CHANNEL_COUNT: usize = 5;
/// Columns of a measurement: friction force, normal force, edge velocity, edge displacement, approach.
pub const CHANNELS: [&str; CHANNEL_COUNT] = [
    "friction_force_n",
    "normal_force_n",
    "edge_velocity_m_s",
    "edge_displacement_m",
    "carriage_z_m",
];
/// Index of the friction force.
pub const FRICTION: usize = 0;
/// Index of the normal force.
pub const NORMAL: usize = 1;
/// Index of the velocity of the run-in edge.
pub const VELOCITY: usize = 2;
/// Index of the displacement of the run-in edge.
pub const DISPLACEMENT: usize = 3;
/// Index of the approach of the carriage.
pub const APPROACH: usize = 4;

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

/// Size of the block \[m\].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct BlockSize {
    /// Length.
    pub length_m: f64,
    /// Height.
    pub height_m: f64,
    /// Width.
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
    /// Median.
    pub value: f64,
    /// Relative standard deviation, log-normal.
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
    /// Samples per second.
    pub sampling_rate: f64,
    /// Standard deviation of the noise per channel; `None` for a channel that the file does not name.
    pub noise: [Option<f64>; CHANNEL_COUNT],
    /// Datasheet by the names of the campaign file.
    pub nominal: BTreeMap<String, Datum>,
    /// Runs.
    pub runs: Vec<RunSpec>,
}

/// A record: time and channels of equal length.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Record {
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Channels; `None` where a channel is missing or unusable.
    pub channel: [Option<Vec<f64>>; CHANNEL_COUNT],
    /// Step of the measured time column over that of the sampling rate; 0 where nothing was measured.
    pub clock: f64,
}

impl Record {
    /// The record up to `end` \[s\].
    pub fn until(&self, end: f64) -> Self {
        let count = self.time.iter().take_while(|t| **t <= end + 1e-6).count();
        let cut = |column: &Vec<f64>| column[..count].to_vec();
        Self {
            time: cut(&self.time),
            channel: std::array::from_fn(|c| self.channel[c].as_ref().map(cut)),
            clock: self.clock,
        }
    }
}

/// A run with its data.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Settings.
    pub spec: RunSpec,
    /// Data.
    pub record: Record,
    /// Hash of the file's bytes.
    pub hash: u64,
}

/// A campaign with its data and what is wrong with them.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// Settings.
    pub plan: Plan,
    /// Runs that can be used.
    pub runs: Vec<Run>,
    /// Problems that were worked around.
    pub warnings: Vec<Problem>,
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

impl Campaign {
    /// Reads a campaign's folder, or its zip made by `tread gap pack`; what can be worked around becomes a warning.
    ///
    /// # Errors
    /// A campaign file that cannot be read, or data from which nothing can be concluded.
    pub fn load(folder: &Path) -> Result<Self, Fault> {
        let source = Source::open(folder)?;
        let shown = folder.join("campaign.toml").display().to_string();
        let plan = match &source {
            Source::Folder(folder) => read_plan(&folder.join("campaign.toml"))?,
            Source::Packed(_) => {
                let unread = |reason| Fault::unusable(&shown, reason);
                let bytes = source.bytes("campaign.toml").map_err(unread)?;
                parse_plan(&String::from_utf8_lossy(&bytes), &shown)?
            }
        };
        let (mut runs, mut warnings) = (Vec::new(), Vec::new());
        for spec in &plan.runs {
            match read_record(&source, &plan, spec, &mut warnings) {
                Ok((record, hash)) => runs.push(Run { spec: spec.clone(), record, hash }),
                Err(problem) => warnings.push(problem),
            }
        }
        quality::across_runs(&mut runs, &mut warnings);
        let campaign = Self { plan, runs, warnings };
        quality::enough(&campaign)?;
        Ok(campaign)
    }

    /// Hash over all data.
    pub fn hash(&self) -> u64 {
        self.runs.iter().fold(HASH_START, |h, run| hash_step(h, &run.hash.to_le_bytes()))
    }
}

const HASH_START: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a.
fn hash_step(start: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(start, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3))
}

fn read_record(
    source: &Source,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(Record, u64), Problem> {
    let unreadable = |reason: String| {
        Problem::new(
            &spec.file,
            reason,
            "a readable CSV file",
            "the run is left out; restore its file",
        )
    };
    let bytes = source.bytes(&spec.file).map_err(unreadable)?;
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes.as_slice());
    let header = reader.headers().map_err(|e| unreadable(e.to_string()))?.clone();
    let place = |name: &str| header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
    let mut record = Record::default();
    let places = CHANNELS.map(place);
    let at_time = place("time_s").ok_or_else(|| unreadable("no column time_s".into()))?;
    for (slot, at) in record.channel.iter_mut().zip(places) {
        *slot = at.map(|_| Vec::new());
    }
    for row in reader.records() {
        let row = row.map_err(|e| unreadable(e.to_string()))?;
        let cell = |at: usize| row.get(at).and_then(|c| c.parse::<f64>().ok()).unwrap_or(f64::NAN);
        record.time.push(cell(at_time));
        for (slot, at) in record.channel.iter_mut().zip(places) {
            if let (Some(column), Some(at)) = (slot.as_mut(), at) {
                column.push(cell(at));
            }
        }
    }
    quality::of_record(&mut record, plan, spec, warnings)?;
    Ok((record, hash_step(HASH_START, &bytes)))
}
