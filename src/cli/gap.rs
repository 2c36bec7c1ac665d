//! `tread gap`: diagnose the gap between measurements and the model.

use std::io::{IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::output::{self, Done, Stop};
use super::threads;
use crate::error::Fault;
use crate::gap::diagnose::{self, Settings};
use crate::gap::hypotheses::Method;
use crate::gap::{
    campaign, friction_fit, friction_record, friction_told, import, json, packed, predict, report,
    score, suite, verify,
};

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

/// A step of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Step {
    /// Recalibration of the base model.
    Recalibration,
    /// The base model once more, from what the effects found.
    EqualEffort,
    /// All forms of an effect but the first.
    Families,
    /// Runs that no fit sees.
    HoldOut,
    /// What the data say without a model.
    Symmetries,
}

/// The method without some steps.
fn settings(seed: u64, without: &[Step]) -> Settings {
    let kept = |step: Step| !without.contains(&step);
    let method = Method {
        recalibrate: kept(Step::Recalibration),
        equal_effort: kept(Step::EqualEffort),
        families: kept(Step::Families),
        symmetries: kept(Step::Symmetries),
    };
    Settings { seed, method, hold_out: kept(Step::HoldOut) }
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
            return run_diagnose(campaign, out, *jobs, settings(*seed, without), *quiet);
        }
        Command::MakeSuite { out, template, count, seed } => {
            suite::make(template.as_deref(), out, *count, *seed)?;
            eprintln!("{count} campaigns in {}", out.display());
        }
        Command::Import { plan, out, json } => {
            let imported = import::import(plan, out)?;
            let text = if *json { imported.json() } else { imported.table() };
            output::to_stdout(text.as_bytes())?;
        }
        Command::Pack { campaigns, out } => pack(campaigns, out)?,
        Command::Friction { records, json } => return friction(records, *json),
        Command::Predict { diagnosis, campaign, model, out } => {
            let count = predict::predict(diagnosis, campaign, model.name(), out)?;
            eprintln!("{count} runs written to {}", out.display());
        }
        Command::Export { diagnosis, fmu, model } => export(diagnosis, fmu, *model)?,
        Command::Check { folder, out } => check(folder, out)?,
        Command::Score { answers, labels, held_out, json } => {
            tell_score(answers, labels, *json)?;
            if let Some(further) = held_out {
                tell_closed(answers, labels, further)?;
            }
        }
    }
    Ok(Done::Fine)
}

fn tell_score(answers: &Path, labels: &Path, json: bool) -> Result<(), Stop> {
    let cases = score::cases(answers, labels)?;
    let figures = serde_json::to_string_pretty(&score::figures(&cases)).unwrap_or_default();
    let table = if json { String::new() } else { score::table(&cases) };
    output::to_stdout(format!("{table}{figures}\n").as_bytes())
}

fn tell_closed(answers: &Path, labels: &Path, further: &Path) -> Result<(), Stop> {
    let mut all = Vec::new();
    for case in score::cases(answers, labels)? {
        let packed = further.join(format!("{}.zip", case.id));
        let campaign = if packed.exists() { packed } else { further.join(&case.id) };
        // Where nothing was named, nothing was promised.
        if campaign.exists() && case.kind == "named" {
            let answer = score::answer_path(answers, &case.id);
            all.push(verify::closed(&case.id, &answer, &campaign)?);
        }
    }
    output::to_stdout(verify::table(&all).as_bytes())
}

/// One campaign after the other; one that cannot be used is told and does not stop the others.
fn check(folder: &Path, out: &Path) -> Result<(), Stop> {
    let entries = std::fs::read_dir(folder).map_err(|e| Fault::file(folder, &e))?;
    let mut campaigns: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    campaigns.retain(|path| {
        path.join("campaign.toml").exists() || path.extension().is_some_and(|e| e == "zip")
    });
    campaigns.sort();
    for campaign in &campaigns {
        let name = campaign.file_stem().unwrap_or_default();
        eprintln!("{}", name.to_string_lossy());
        match run_diagnose(campaign, &out.join(name), 0, Settings::default(), true) {
            Err(Stop::Fault(fault)) => eprintln!("{fault}"),
            Err(stop) => return Err(stop),
            Ok(_) => {}
        }
    }
    let labels = folder.join("labels.json");
    if labels.exists() {
        tell_score(out, &labels, false)?;
    }
    Ok(())
}

fn run_diagnose(
    campaign: &Path,
    out: &Path,
    jobs: usize,
    settings: Settings,
    quiet: bool,
) -> Result<Done, Stop> {
    let began = Instant::now();
    let shown = !quiet && std::io::stderr().is_terminal();
    let progress = |share: f64, what: &str| {
        if !quiet && !shown {
            eprintln!("{:5.1} s  {what}", began.elapsed().as_secs_f64());
        }
        if shown {
            let gone = began.elapsed().as_secs_f64();
            let left = if share > 0.05 { gone * (1.0 - share) / share } else { f64::NAN };
            eprint!("\r{:3.0} %  {what}, about {left:.0} s left          ", 100.0 * share);
        }
    };
    let pool = threads::pool(jobs)?;
    let diagnosis = pool.install(|| diagnose::diagnose(campaign, settings, &progress))?;
    if shown {
        eprintln!();
    }
    for problem in diagnose::flags(&diagnosis) {
        eprintln!("note: {problem}");
    }
    let document = json::document(&diagnosis);
    let text = serde_json::to_string_pretty(&document).unwrap_or_default();
    output::to(Some(&out.join("diagnosis.json")), text.as_bytes())?;
    let page = pool.install(|| report::page(&diagnosis));
    output::to(Some(&out.join("report.html")), page.as_bytes())?;
    output::to_stdout(format!("{}\n", diagnose::verdict(&diagnosis)).as_bytes())?;
    Ok(Done::Code(diagnosis.decision.kind.exit_code()))
}

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

/// Every record on its own; one that cannot be used is told and does not stop the others.
fn friction(records: &[PathBuf], json: bool) -> Result<Done, Stop> {
    let (mut text, mut all, mut failed) = (String::new(), Vec::new(), None);
    for path in records {
        match friction_record::read(path) {
            Ok(record) => {
                let verdict = friction_fit::explain(&record);
                text.push_str(&friction_told::table(&record, &verdict));
                all.push(friction_told::document(&record, &verdict));
            }
            Err(fault) => {
                eprintln!("{fault}");
                failed = Some(fault);
            }
        }
    }
    if json {
        text = serde_json::to_string_pretty(&all).unwrap_or_default() + "\n";
    }
    output::to_stdout(text.as_bytes())?;
    match failed {
        Some(_) => Ok(Done::Code(2)),
        None => Ok(Done::Fine),
    }
}

/// The FMU as `tread fmu build` packs it, with the fitted values in its resources.
fn export(diagnosis: &Path, fmu: &Path, model: Model) -> Result<(), Stop> {
    let params = json::read_model(diagnosis, model.name())?;
    let plain = crate::fmi::package::pack(&[super::fmu::beside_this_program()?])?;
    let failed = |e: std::io::Error| Fault::file(fmu, &e);
    let broken = |e: zip::result::ZipError| Fault::unusable(fmu, e);
    let mut from = zip::ZipArchive::new(std::io::Cursor::new(plain)).map_err(broken)?;
    let mut to = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    for at in 0..from.len() {
        let mut entry = from.by_index(at).map_err(broken)?;
        let name = entry.name().map_err(broken)?.to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).map_err(failed)?;
        if name == "resources/parameters.toml" {
            bytes = crate::params::load::to_toml(&params).into_bytes();
        }
        to.start_file(name, options).map_err(broken)?;
        to.write_all(&bytes).map_err(failed)?;
    }
    let packed = to.finish().map_err(broken)?.into_inner();
    output::to(Some(fmu), &packed)?;
    eprintln!("packed {}", fmu.display());
    Ok(())
}
