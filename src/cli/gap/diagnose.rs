//! `tread gap diagnose`, and `tread gap check`: the same for all campaigns of a folder.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::score;
use crate::cli::output::{self, Done, Stop};
use crate::cli::threads;
use crate::error::Fault;
use crate::gap::diagnose::{self, Settings};
use crate::gap::hypotheses::Method;
use crate::gap::{json, report};

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

/// Diagnoses one campaign, leaves `diagnosis.json` and `report.html` in `out` and tells the verdict.
pub fn run(
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

/// One campaign after the other; one that cannot be used is told and does not stop the others.
pub fn check(folder: &Path, out: &Path) -> Result<(), Stop> {
    let entries = std::fs::read_dir(folder).map_err(|e| Fault::file(folder, &e))?;
    let mut campaigns: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    campaigns.retain(|path| {
        path.join("campaign.toml").exists() || path.extension().is_some_and(|e| e == "zip")
    });
    campaigns.sort();
    for campaign in &campaigns {
        let name = campaign.file_stem().unwrap_or_default();
        eprintln!("{}", name.to_string_lossy());
        match run(campaign, &out.join(name), 0, Settings::default(), true) {
            Err(Stop::Fault(fault)) => eprintln!("{fault}"),
            Err(stop) => return Err(stop),
            Ok(_) => {}
        }
    }
    let labels = folder.join("labels.json");
    if labels.exists() {
        score::tell(out, &labels, None, false)?;
    }
    Ok(())
}
