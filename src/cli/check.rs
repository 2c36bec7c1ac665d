//! `tread check`: all problems of a file at once.

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::error::{Fault, Problem};
use crate::gap::campaign::Campaign;
use crate::params::load;
use crate::scenario::{belt_csv, config, Roll};
use crate::sweep;

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A run (TOML with a [run] table), a sweep (with a [sweep] table, too), a parameter file (TOML without
    /// them), a belt path (CSV), or a measured campaign (its folder, campaign.toml or zip)
    file: PathBuf,
    /// Tell the problems as JSON
    #[arg(long)]
    json: bool,
}

/// Checks the file; problems go to the standard output, for they are what was asked for.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let file = &arguments.file;
    let (kind, result) = if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
        ("belt path", belt_csv::read(file).and_then(|s| Roll::through(&s)).map(|_| ()))
    } else if let Some(place) = campaign(file) {
        ("campaign", check_campaign(place))
    } else {
        check_toml(file)?
    };
    let problems = match result {
        Ok(()) => Vec::new(),
        Err(Fault::Invalid(problems)) => problems,
        Err(other) => return Err(other.into()),
    };
    tell(file, kind, &problems, arguments.json)
}

/// Tells the problems of a file, or that there are none.
pub fn tell(file: &Path, kind: &str, problems: &[Problem], as_json: bool) -> Result<Done, Stop> {
    let text = if as_json { json(kind, problems) } else { plain(file, kind, problems) };
    output::to_stdout(text.as_bytes())?;
    Ok(if problems.is_empty() { Done::Fine } else { Done::Problems })
}

/// Folder or zip of a campaign, if the file is one.
fn campaign(file: &Path) -> Option<&Path> {
    let zip = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("zip"));
    if file.is_dir() || zip {
        return Some(file);
    }
    let folder = file.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    (file.file_name()? == "campaign.toml").then_some(folder)
}

/// What the diagnosis would tell about the data before it begins.
fn check_campaign(place: &Path) -> Result<(), Fault> {
    if place.is_dir() && !place.join("campaign.toml").exists() {
        return Err(Fault::one(Problem::new(
            place.display().to_string(),
            "a folder without campaign.toml",
            "a file, or the folder of a campaign",
            "name a file in it; `tread gap import` makes a campaign",
        )));
    }
    let warnings = Campaign::load(place)?.warnings;
    if warnings.is_empty() {
        Ok(())
    } else {
        Err(Fault::Invalid(warnings))
    }
}

/// What kind of file a TOML file is, and what is wrong with it.
fn check_toml(file: &Path) -> Result<(&'static str, Result<(), Fault>), Fault> {
    let text = config::read_text(file)?;
    let document = text.parse::<toml::Table>().unwrap_or_default();
    Ok(if document.contains_key("sweep") {
        ("sweep", check_sweep(file))
    } else if document.contains_key("run") {
        ("run", config::read(file, &[]).map(|_| ()))
    } else {
        ("parameter file", load::from_toml(&text).map(|_| ()))
    })
}

/// The plan, and the run of every point up to the first that is wrong.
fn check_sweep(file: &Path) -> Result<(), Fault> {
    let plan = sweep::Plan::read(file)?;
    (0..plan.points.len()).try_for_each(|point| plan.config(point).map(|_| ()))
}

/// The problems for people.
fn plain(file: &Path, kind: &str, problems: &[Problem]) -> String {
    let file = file.display();
    match problems.len() {
        0 => format!("{file}: a good {kind}\n"),
        n => {
            let plural = if n == 1 { "" } else { "s" };
            let lines: String = problems.iter().map(|p| format!("  {p}\n")).collect();
            format!("{file}: a {kind} with {n} problem{plural}\n{lines}")
        }
    }
}

/// The problems for programs.
fn json(kind: &str, problems: &[Problem]) -> String {
    let list: Vec<_> = problems
        .iter()
        .map(|p| {
            serde_json::json!({
                "what": p.what, "value": p.value, "allowed": p.allowed, "remedy": p.remedy,
            })
        })
        .collect();
    format!("{}\n", serde_json::json!({ "kind": kind, "problems": list }))
}
