//! `tread gap import`: a campaign's folder from what laboratories have.
//!
//! A plan (a campaign file that also names columns, units and starts) and CSV files → units to SI → time
//! shifted so that the road starts at 0 → rows at the campaign's rate → `campaign.toml` and `runs/*.csv`.
//! Whatever is done to a channel is told; what cannot be told apart is refused. See the book,
//! `own-campaign.md`.

mod column;
pub mod plan;
pub mod resample;
mod run;
pub mod table;
pub mod told;
pub mod units;

use std::path::Path;

use run::one_run;
use told::Imported;
use toml::Value;

use super::campaign;
use crate::error::Fault;

/// Reads a plan and its files, and writes the campaign below `out` if nothing is wrong with them.
///
/// # Errors
/// All that is wrong with the plan, or all that is wrong with its files; then nothing is written.
pub fn import(plan_file: &Path, out: &Path) -> Result<Imported, Fault> {
    let shown = plan_file.display().to_string();
    let text = std::fs::read_to_string(plan_file).map_err(|e| Fault::file(plan_file, &e))?;
    let plan = plan::parse(&text, &shown)?;
    let folder = plan_file.parent().unwrap_or(Path::new(""));
    let (mut problems, mut files, mut told) = (Vec::new(), Vec::new(), Vec::new());
    let mut campaign_file = plan.campaign.clone();
    for (at, run) in plan.runs.iter().enumerate() {
        match one_run(&plan, run, folder) {
            Ok((csv, duration, run_told)) => {
                let runs = campaign_file.get_mut("runs").and_then(Value::as_array_mut);
                if let Some(Value::Table(entry)) = runs.and_then(|r| r.get_mut(at)) {
                    entry.insert("duration_s".into(), duration.into());
                }
                files.push((run.file.clone(), csv));
                told.push(run_told);
            }
            Err(mut wrong) => problems.append(&mut wrong),
        }
    }
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    let header = format!("# Made by `tread gap import {shown}`; import.json says how.\n");
    let failed = |e: toml::ser::Error| Fault::unusable(plan_file, e);
    let campaign_text = header + &toml::to_string(&campaign_file).map_err(failed)?;
    // Sizes, pressures and the datasheet are judged as those of any campaign.
    campaign::parse_plan(&campaign_text, &shown)?;
    let imported = Imported { rate: plan.rate, runs: told };
    files.push(("campaign.toml".to_string(), campaign_text));
    files.push(("import.json".to_string(), imported.json()));
    for (name, text) in &files {
        write(&out.join(name), text)?;
    }
    Ok(imported)
}

/// Writes a file; its folder is made.
fn write(path: &Path, text: &str) -> Result<(), Fault> {
    let failed = |e: std::io::Error| Fault::file(path, &e);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    std::fs::write(path, text).map_err(failed)
}
