//! `tread gap score`: answers beside the labels, and closed fractions beside those of further runs.

use std::path::Path;

use crate::cli::output::{self, Stop};
use crate::error::Fault;
use crate::gap::score::{self, Case};
use crate::gap::verify::{self, Closed};

/// Scores the answers; with `further` runs of the same blocks also what was told of the closed fractions.
pub fn run(answers: &Path, labels: &Path, further: Option<&Path>, json: bool) -> Result<(), Stop> {
    let cases = score::cases(answers, labels)?;
    let closed = further.map(|further| closed(answers, &cases, further)).transpose()?;
    if json {
        let mut figures = score::figures(&cases);
        if let Some(closed) = closed {
            figures["further_runs"] = verify::document(&closed);
        }
        return output::json_to_stdout(&figures);
    }
    tell(&cases)?;
    match closed {
        Some(closed) => output::to_stdout(verify::table(&closed).as_bytes()),
        None => Ok(()),
    }
}

/// The cases for people, and all figures of them.
pub fn tell(cases: &[Case]) -> Result<(), Stop> {
    output::to_stdout(score::table(cases).as_bytes())?;
    output::json_to_stdout(&score::figures(cases))
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
