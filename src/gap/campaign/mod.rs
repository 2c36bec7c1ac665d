//! A measured campaign: `campaign.toml` and one CSV per run.

mod plan;
mod record;

pub use plan::{parse_plan, read_plan, BlockSize, Datum, Plan, Rig, RunKind, RunSpec};
pub use record::Record;

use super::packed::Source;
use super::quality;
use crate::error::{Fault, Problem};
use record::{hash_step, HASH_START};
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
/// Index of the friction force \[N\].
pub const FRICTION: usize = 0;
/// Index of the normal force \[N\].
pub const NORMAL: usize = 1;
/// Index of the velocity of the run-in edge \[m/s\].
pub const VELOCITY: usize = 2;
/// Index of the displacement of the run-in edge \[m\].
pub const DISPLACEMENT: usize = 3;
/// Index of the approach of the carriage \[m\].
pub const APPROACH: usize = 4;

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
            match record::read(&source, &plan, spec, &mut warnings) {
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
