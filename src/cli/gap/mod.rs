//! `tread gap`: diagnose the gap between measurements and the model. What was typed; the commands that do more than
//! one call are in files of their own.

mod diagnose;
mod export;
mod friction;
mod score;

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::gap::{campaign, import, packed, predict, suite};
use diagnose::Step;

const EXAMPLES: &str = "\
Examples:
  tread gap diagnose campaign --out out/campaign
  tread gap predict out/campaign/diagnosis.json other/campaign.toml --model with-effect --out out/p
  tread gap export out/campaign/diagnosis.json --fmu out/Repaired.fmu
  tread gap score out labels.json
  tread gap import plan.toml --out campaign
  tread gap make-suite --count 16 --seed 7 --out out/own
  tread gap friction record.csv

Exit codes of diagnose:
  0   no gap that an effect would be needed for
  10  an effect is named
  11  a class of effects that the data cannot tell apart
  12  none of the candidates
  2   the data cannot be used";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Say where the gap lies, which effect causes it and how far it shrinks
    Diagnose {
        /// Folder with campaign.toml and the runs
        campaign: PathBuf,
        /// Folder for diagnosis.json and report.html
        #[arg(long, short)]
        out: PathBuf,
        /// Threads; 0: all cores. The answer does not depend on it
        #[arg(long, short, default_value_t = 0)]
        jobs: usize,
        /// Seed of the bootstrap
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Leave a step of the method out, to see what it is worth; may be repeated
        #[arg(long)]
        without: Vec<Step>,
        /// No progress on the standard error
        #[arg(long, short)]
        quiet: bool,
    },
    /// Simulate the runs of a campaign file with a diagnosed model
    Predict {
        /// The diagnosis
        diagnosis: PathBuf,
        /// The campaign file; measured data are not needed
        campaign: PathBuf,
        /// Which model
        #[arg(long, default_value = "with-effect")]
        model: Model,
        /// Folder for runs/
        #[arg(long, short)]
        out: PathBuf,
    },
    /// Pack the FMU with the fitted values
    Export {
        /// The diagnosis
        diagnosis: PathBuf,
        /// The FMU to write
        #[arg(long)]
        fmu: PathBuf,
        /// Which model
        #[arg(long, default_value = "with-effect")]
        model: Model,
    },
    /// Diagnose all campaigns of a folder and score those that labels.json knows
    Check {
        /// Folder of campaigns, with labels.json or without
        #[arg(default_value = "tests/data/campaigns/open")]
        folder: PathBuf,
        /// Folder for the answers
        #[arg(long, short, default_value = "out/gap")]
        out: PathBuf,
        /// All decisions and figures as JSON
        #[arg(long)]
        json: bool,
    },
    /// Make campaigns of the own simulator whose effect is known
    MakeSuite {
        /// Folder for the campaigns and labels.json
        #[arg(long, short)]
        out: PathBuf,
        /// Campaign file to make them after; the project's own if not given
        #[arg(long)]
        template: Option<PathBuf>,
        /// How many
        #[arg(long, default_value_t = 16)]
        count: usize,
        /// Seed: the same one gives the same campaigns
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Folder for further runs of the same blocks, as `score --held-out` takes them
        #[arg(long)]
        further: Option<PathBuf>,
    },
    /// Make a campaign's folder from a laboratory's CSV files: columns, units, start and rate as a plan says
    Import {
        /// The plan (TOML)
        plan: PathBuf,
        /// Folder for campaign.toml, runs/ and import.json; nothing is written if anything is wrong
        #[arg(long, short)]
        out: PathBuf,
        /// What was done to every channel as JSON
        #[arg(long)]
        json: bool,
    },
    /// Pack campaigns into one zip each; diagnose and check read them as they read folders
    Pack {
        /// Folders of campaigns
        #[arg(required = true)]
        campaigns: Vec<PathBuf>,
        /// Folder for the zips
        #[arg(long, short)]
        out: PathBuf,
    },
    /// Say which effect explains a friction record without block dynamics
    Friction {
        /// CSV files: time_s with displacement_m and friction_coefficient, or with position_m, force_n
        /// and pressure_pa
        #[arg(required = true)]
        records: Vec<PathBuf>,
        /// All figures as JSON
        #[arg(long)]
        json: bool,
    },
    /// Score answers against labels
    Score {
        /// Folder with ID/diagnosis.json or ID.json
        answers: PathBuf,
        /// The labels
        labels: PathBuf,
        /// Folder with further runs of the same blocks, to check the closed fractions on
        #[arg(long)]
        held_out: Option<PathBuf>,
        /// All figures as JSON
        #[arg(long)]
        json: bool,
    },
}

/// A model of a diagnosis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Model {
    /// At the datasheet's values.
    Nominal,
    /// Recalibrated.
    Recalibrated,
    /// With the most probable effect.
    WithEffect,
}

impl Model {
    const fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Recalibrated => "recalibrated",
            Self::WithEffect => "with-effect",
        }
    }
}

/// Does what was typed.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    match &arguments.command {
        Command::Diagnose { campaign, out, jobs, seed, without, quiet } => {
            let settings = diagnose::settings(*seed, without);
            return diagnose::run(campaign, out, *jobs, settings, *quiet);
        }
        Command::MakeSuite { out, template, count, seed, further } => {
            let folders = suite::Folders { out, further: further.as_deref() };
            suite::make(template.as_deref(), folders, *count, *seed)?;
            eprintln!("{count} campaigns in {}", out.display());
        }
        Command::Import { plan, out, json } => {
            let imported = import::import(plan, out)?;
            let text = if *json { imported.json() } else { imported.table() };
            output::to_stdout(text.as_bytes())?;
        }
        Command::Pack { campaigns, out } => pack(campaigns, out)?,
        Command::Friction { records, json } => return friction::run(records, *json),
        Command::Predict { diagnosis, campaign, model, out } => {
            let count = predict::predict(diagnosis, campaign, model.name(), out)?;
            eprintln!("{count} runs written to {}", out.display());
        }
        Command::Export { diagnosis, fmu, model } => export::run(diagnosis, fmu, model.name())?,
        Command::Check { folder, out, json } => return diagnose::check(folder, out, *json),
        Command::Score { answers, labels, held_out, json } => {
            score::run(answers, labels, held_out.as_deref(), *json)?;
        }
    }
    Ok(Done::Fine)
}

/// Every folder as one zip below `out`.
fn pack(campaigns: &[PathBuf], out: &Path) -> Result<(), Stop> {
    for folder in campaigns {
        let plan = campaign::read_plan(&folder.join("campaign.toml"))?;
        let mut names = vec!["campaign.toml".to_string()];
        names.extend(plan.runs.iter().map(|r| r.file.clone()));
        let name = format!("{}.zip", folder.file_name().unwrap_or_default().to_string_lossy());
        output::to(Some(&out.join(name)), &packed::pack(folder, &names)?)?;
    }
    Ok(())
}
