//! `tread gap score`: answers beside the labels, and closed fractions beside those of further runs.

use std::path::Path;

use crate::cli::output::{self, Stop};
use crate::error::Fault;
use crate::gap::score::{self, Case};
use crate::gap::verify::{self, Closed};

/// Scores the answers; with further runs of the same blocks also what was told of the closed fractions.
pub fn tell(answers: &Path, labels: &Path, further: Option<&Path>, json: bool) -> Result<(), Stop> {
    let cases = score::cases(answers, labels)?;
    let figures = serde_json::to_string_pretty(&score::figures(&cases)).unwrap_or_default();
    let table = if json { String::new() } else { score::table(&cases) };
    output::to_stdout(format!("{table}{figures}\n").as_bytes())?;
    if let Some(further) = further {
        output::to_stdout(verify::table(&closed(answers, &cases, further)?).as_bytes())?;
    }
    Ok(())
}

/// Told and true closed fractions of the named cases of which `further` has runs.
fn closed(answers: &Path, cases: &[Case], further: &Path) -> Result<Vec<Closed>, Fault> {
    let mut all = Vec::new();
    for case in cases {
        let packed = further.join(format!("{}.zip", case.id));
        let campaign = if packed.exists() { packed } else { further.join(&case.id) };
        // Where nothing was named, nothing was promised.
        if campaign.exists() && case.kind == "named" {
            let answer = score::answer_path(answers, &case.id);
            all.push(verify::closed(&case.id, &answer, &campaign)?);
        }
    }
    Ok(all)
}
