//! What a diagnosis is worth on runs of the same block that were measured besides: the closed fraction
//! that it told against the one that comes true.

use super::campaign::Campaign;
use super::held_out;
use super::json;
use super::problem::{Bench, Look};
use crate::error::Fault;
use crate::metrics::median;
use serde_json::{json, Value as Json};
use std::path::Path;

/// Told and true closed fraction of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    /// Name of the campaign.
    pub id: String,
    /// G of the datasheet, the recalibrated model and the one with the effect on the further runs.
    pub gaps: [f64; 3],
    /// Closed fraction on them.
    pub actual: f64,
    /// Closed fraction that the diagnosis told.
    pub told: f64,
    /// Lower and upper end of its interval.
    pub interval: [f64; 2],
}

/// Judges the diagnosis in `answer` on the further runs of the same block in `campaign`.
///
/// # Errors
/// Files that cannot be read, and what stops the block.
pub fn closed(id: &str, answer: &Path, campaign: &Path) -> Result<Closed, Fault> {
    let text = std::fs::read_to_string(answer).map_err(|e| Fault::file(answer, &e))?;
    let document: Json = serde_json::from_str(&text).unwrap_or_default();
    let campaign = Campaign::load(campaign)?;
    let mut bench = Bench::new(&campaign, crate::effects::fit_specs(), Look::Whole)?;
    let all: Vec<usize> = (0..bench.runs.len()).collect();
    bench.measure_floor(&json::read_model(answer, "recalibrated")?, &all)?;
    let squares = |model: &str| -> Result<Vec<f64>, Fault> {
        let residuals = bench.residuals_of(&json::read_model(answer, model)?, &all);
        Ok(held_out::squares(&bench, &residuals, &all))
    };
    let [nominal, before, after] =
        [squares("nominal")?, squares("recalibrated")?, squares("with-effect")?];
    let fraction = &document["gap"]["closed_fraction"];
    let number = |key: &str| fraction[key].as_f64().unwrap_or(0.0);
    Ok(Closed {
        id: id.to_string(),
        gaps: [&nominal, &before, &after].map(|s| held_out::gap(s)),
        actual: held_out::closed(&before, &after),
        told: number("value"),
        interval: [number("lo"), number("hi")],
    })
}

/// Median of |told - on further runs|, `None` without campaigns, and how many fractions lie inside their interval.
fn errors(all: &[Closed]) -> (Option<f64>, usize) {
    let errors = all.iter().map(|c| (c.told - c.actual).abs()).collect();
    let inside = |c: &&Closed| c.interval[0] <= c.actual && c.actual <= c.interval[1];
    (median(errors), all.iter().filter(inside).count())
}

/// A table for people, and the median error.
pub fn table(all: &[Closed]) -> String {
    let mut out = String::from(
        "campaign   nominal recalibrated with-effect   closed: told [interval], on further runs\n",
    );
    for c in all {
        let [n, r, e] = c.gaps;
        out.push_str(&format!(
            "{:<10} {n:7.2} {r:12.2} {e:11.2}   {:.2} [{:.2}, {:.2}]  {:.2}\n",
            c.id, c.told, c.interval[0], c.interval[1], c.actual
        ));
    }
    if let (Some(median), inside) = errors(all) {
        out.push_str(&format!(
            "median |told - on further runs| {median:.3}; inside the interval {inside} of {}\n",
            all.len()
        ));
    }
    out
}

/// The same for programs.
pub fn document(all: &[Closed]) -> Json {
    let (median, inside) = errors(all);
    let campaigns: Vec<Json> = all
        .iter()
        .map(|c| {
            let [nominal, recalibrated, with_effect] = c.gaps;
            json!({
                "campaign": c.id,
                "gap": {
                    "nominal": nominal, "recalibrated": recalibrated, "with_effect": with_effect,
                },
                "closed_fraction": {
                    "told": c.told, "lo": c.interval[0], "hi": c.interval[1],
                    "on_further_runs": c.actual,
                },
            })
        })
        .collect();
    json!({"campaigns": campaigns, "median_error": median, "inside_interval": inside})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_and_json_tell_the_same_error() {
        let closed = |told: f64, actual: f64| Closed {
            id: "a".into(),
            gaps: [9.0, 3.0, 1.5],
            actual,
            told,
            interval: [told - 0.2, told + 0.2],
        };
        // Errors 0.1, 0.3 and 0.15: the median is 0.15, and 0.3 is outside of ±0.2.
        let all = [closed(0.8, 0.9), closed(0.8, 0.5), closed(0.5, 0.65)];
        let document = document(&all);
        assert!((document["median_error"].as_f64().unwrap() - 0.15).abs() < 1e-12);
        assert_eq!(document["inside_interval"], 2);
        assert!(table(&all).contains("0.150; inside the interval 2 of 3"));
    }
}
