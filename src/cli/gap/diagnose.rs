//! `tread gap diagnose`, and `tread gap check`: the same for all campaigns of a folder.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::json;

use super::score;
use crate::cli::output::{self, Done, Stop};
use crate::error::Fault;
use crate::gap::diagnose::{self, Diagnosis, Settings};
use crate::gap::hypotheses::Method;
use crate::gap::score::{cases, figures};
use crate::gap::{json, report};
use crate::threads;

/// A step of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Step {
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
pub fn settings(seed: u64, without: &[Step]) -> Settings {
    let kept = |step: Step| !without.contains(&step);
    let method = Method {
        recalibrate: kept(Step::Recalibration),
        equal_effort: kept(Step::EqualEffort),
        families: kept(Step::Families),
        symmetries: kept(Step::Symmetries),
    };
    Settings { seed, method, hold_out: kept(Step::HoldOut) }
}

/// Diagnoses one campaign and tells the verdict; the exit code says its kind.
pub fn run(
    campaign: &Path,
    out: &Path,
    jobs: usize,
    settings: Settings,
    quiet: bool,
) -> Result<Done, Stop> {
    let diagnosis = one(campaign, out, jobs, settings, quiet)?;
    output::to_stdout(format!("{}\n", diagnose::verdict(&diagnosis)).as_bytes())?;
    Ok(Done::Code(diagnosis.decision.kind.exit_code()))
}

/// One campaign after the other; one that cannot be used is told and does not stop the others.
pub fn check(folder: &Path, out: &Path, as_json: bool) -> Result<Done, Stop> {
    let mut told = Vec::new();
    let mut done = Done::Fine;
    for campaign in campaigns(folder)? {
        let name = campaign.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        eprintln!("{name}");
        match one(&campaign, &out.join(&name), 0, Settings::default(), true) {
            Ok(diagnosis) => {
                if !as_json {
                    output::to_stdout(format!("{}\n", diagnose::verdict(&diagnosis)).as_bytes())?;
                }
                told.push(json!({"campaign": name, "decision": json::decision(&diagnosis)}));
            }
            Err(Stop::Fault(fault)) => {
                eprintln!("{fault}");
                told.push(json!({"campaign": name, "fault": fault.to_string()}));
                done = Done::Code(2);
            }
            Err(stop) => return Err(stop),
        }
    }
    let labels = folder.join("labels.json");
    let cases = labels.exists().then(|| cases(out, &labels)).transpose()?;
    match cases {
        _ if as_json => {
            let score = cases.map(|cases| figures(&cases));
            output::json_to_stdout(&json!({"campaigns": told, "score": score}))?;
        }
        Some(cases) => score::tell(&cases)?,
        None => {}
    }
    Ok(done)
}

/// Folders and zips of campaigns in a folder, by name.
fn campaigns(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    let entries = std::fs::read_dir(folder).map_err(|e| Fault::file(folder, &e))?;
    let mut campaigns: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    campaigns.retain(|path| {
        path.join("campaign.toml").exists() || path.extension().is_some_and(|e| e == "zip")
    });
    campaigns.sort();
    Ok(campaigns)
}

/// Diagnoses one campaign and leaves `diagnosis.json` and `report.html` in `out`.
fn one(
    campaign: &Path,
    out: &Path,
    jobs: usize,
    settings: Settings,
    quiet: bool,
) -> Result<Diagnosis, Stop> {
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
    let text = serde_json::to_string_pretty(&json::document(&diagnosis)).unwrap_or_default();
    output::to(Some(&out.join("diagnosis.json")), text.as_bytes())?;
    let page = pool.install(|| report::page(&diagnosis));
    output::to(Some(&out.join("report.html")), page.as_bytes())?;
    Ok(diagnosis)
}
