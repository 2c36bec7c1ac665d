//! Scores answers against labels.

use crate::error::Fault;
use crate::metrics::median;
use serde_json::{json, Value as Json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// One answer beside its label.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name of the campaign.
    pub id: String,
    /// True effects; empty: none.
    pub truth: Vec<String>,
    /// Rough severity: 1 is typical of the effect's prior.
    pub severity: f64,
    /// Kind of the decision.
    pub kind: String,
    /// Effects of the decision.
    pub answer: Vec<String>,
    /// Probability on the truth.
    pub on_truth: f64,
    /// Most probable cause and its probability.
    pub top: (Vec<String>, f64),
    /// Closed fraction that was told \[-\].
    pub closed: f64,
    /// Wall-clock time \[s\].
    pub seconds: f64,
}

impl Case {
    fn is_unknown(&self) -> bool {
        self.truth.iter().any(|t| t.starts_with("x_"))
    }

    /// What a right answer would be.
    fn wanted(&self) -> Vec<String> {
        if self.is_unknown() {
            vec!["unknown".to_string()]
        } else {
            sorted(&self.truth)
        }
    }

    fn right(&self) -> bool {
        sorted(&self.top.0) == self.wanted()
    }
}

fn sorted(names: &[String]) -> Vec<String> {
    let mut out = names.to_vec();
    out.sort();
    out
}

fn strings(value: &Json) -> Vec<String> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter().filter_map(|v| v.as_str().map(str::to_string)).collect()
}

fn read(path: &Path) -> Result<Json, Fault> {
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
    serde_json::from_str(&text).map_err(|e| Fault::unusable(path, e))
}

/// Where the answer to a campaign is: ID/diagnosis.json, or ID.json.
pub fn answer_path(answers: &Path, id: &str) -> PathBuf {
    let folder = answers.join(id).join("diagnosis.json");
    if folder.exists() {
        folder
    } else {
        answers.join(format!("{id}.json"))
    }
}

/// Reads `labels` and the answers ID/diagnosis.json or ID.json in `answers`; campaigns without an
/// answer are left out.
///
/// # Errors
/// Files that cannot be read.
pub fn cases(answers: &Path, labels: &Path) -> Result<Vec<Case>, Fault> {
    let labels = read(labels)?;
    let mut out = Vec::new();
    for (id, label) in labels.as_object().into_iter().flatten() {
        let path = answer_path(answers, id);
        if path.exists() {
            out.push(case(id, label, &read(&path)?));
        }
    }
    Ok(out)
}

/// An answer beside its label.
fn case(id: &str, label: &Json, answer: &Json) -> Case {
    let mut case = Case {
        id: id.to_string(),
        truth: strings(&label["effects"]),
        severity: label["severity"].as_f64().unwrap_or(1.0),
        kind: answer["decision"]["kind"].as_str().unwrap_or("undecidable").to_string(),
        answer: strings(&answer["decision"]["effects"]),
        on_truth: 0.0,
        top: (Vec::new(), 0.0),
        closed: answer["gap"]["closed_fraction"]["value"].as_f64().unwrap_or(0.0),
        seconds: answer["provenance"]["seconds"].as_f64().unwrap_or(0.0),
    };
    let wanted = case.wanted();
    for hypothesis in answer["hypotheses"].as_array().into_iter().flatten() {
        let effects = strings(&hypothesis["effects"]);
        let probability = hypothesis["probability"].as_f64().unwrap_or(0.0);
        if sorted(&effects) == wanted {
            case.on_truth += probability;
        }
        if probability > case.top.1 {
            case.top = (effects, probability);
        }
    }
    case
}

/// Wilson's 95 % interval of `hits` in `count`.
pub fn wilson(hits: usize, count: usize) -> [f64; 2] {
    if count == 0 {
        return [0.0, 1.0];
    }
    let (n, p, z) = (count as f64, hits as f64 / count as f64, 1.96_f64);
    let centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    [(centre - half).max(0.0), (centre + half).min(1.0)]
}

/// All figures.
pub fn figures(cases: &[Case]) -> Json {
    let single = |c: &&Case| c.truth.len() == 1 && !c.is_unknown() && c.severity >= 1.0;
    let singles: Vec<&Case> = cases.iter().filter(single).collect();
    let nulls: Vec<&Case> = cases.iter().filter(|c| c.truth.is_empty()).collect();
    let unknowns: Vec<&Case> = cases.iter().filter(|c| c.is_unknown()).collect();
    let pairs: Vec<&Case> =
        cases.iter().filter(|c| c.truth.len() == 2 && !c.is_unknown()).collect();
    let share = |of: &[&Case], good: fn(&Case) -> bool| {
        let hits = of.iter().filter(|c| good(c)).count();
        let value = hits as f64 / of.len().max(1) as f64;
        json!({"hits": hits, "of": of.len(), "value": value, "wilson": wilson(hits, of.len())})
    };
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let all: Vec<&Case> = cases.iter().collect();
    let strong: Vec<&Case> =
        cases.iter().filter(|c| c.right() && !c.truth.is_empty() && c.severity >= 1.5).collect();
    let closed = strong.iter().filter(|c| !c.is_unknown()).map(|c| c.closed).collect();
    json!({
        "cases": cases.len(),
        "top1_singles": share(&singles, Case::right),
        "probability_on_truth_singles": mean(singles.iter().map(|c| c.on_truth).collect()),
        "truth_in_answer_singles": share(&singles, |c| c.answer.contains(&c.truth[0])),
        "mean_answer_size_singles": mean(singles.iter().map(|c| c.answer.len() as f64).collect()),
        "false_alarms": share(&nulls, |c| c.kind == "named" || c.kind == "class"),
        "unknown_rejected": share(&unknowns, |c| c.kind == "unknown"),
        "pairs_both": share(&pairs, |c| c.truth.iter().all(|t| c.answer.contains(t))),
        "pairs_one": share(&pairs, |c| c.truth.iter().any(|t| c.answer.contains(t))),
        "wrong_and_confident": share(&all, |c| {
            !c.right() && c.top.1 >= 0.8 && !c.top.0.is_empty() && c.top.0 != ["unknown"]
        }),
        "median_closed_fraction": median(closed),
        "ece": ece(cases),
        "reliability": reliability(cases),
        "brier": mean(cases.iter().map(|c| (1.0 - c.on_truth).powi(2)).collect()),
        "mean_seconds": mean(cases.iter().map(|c| c.seconds).collect()),
        "confusion": confusion(cases),
    })
}

/// Ten bins of the highest probability: how often the answer was right.
fn bins(cases: &[Case]) -> Vec<(usize, f64, f64)> {
    let mut bins = vec![(0, 0.0, 0.0); 10];
    for case in cases {
        let at = ((case.top.1 * 10.0) as usize).min(9);
        bins[at].0 += 1;
        bins[at].1 += case.top.1;
        bins[at].2 += f64::from(u8::from(case.right()));
    }
    bins
}

/// Expected calibration error: mean distance of probability and share of right answers over the bins.
fn ece(cases: &[Case]) -> f64 {
    bins(cases).iter().map(|(_, p, hits)| (p - hits).abs()).sum::<f64>() / cases.len().max(1) as f64
}

/// The bins that have cases.
fn reliability(cases: &[Case]) -> Vec<Json> {
    bins(cases)
        .iter()
        .filter(|b| b.0 > 0)
        .map(|(n, p, hits)| {
            let n64 = *n as f64;
            json!({"cases": n, "mean_probability": p / n64, "right": hits / n64})
        })
        .collect()
}

/// Most probable cause by truth.
fn confusion(cases: &[Case]) -> Json {
    let mut out: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    let name = |names: &[String]| {
        if names.is_empty() {
            "none".to_string()
        } else {
            sorted(names).join("+")
        }
    };
    for case in cases {
        *out.entry(name(&case.truth)).or_default().entry(name(&case.top.0)).or_default() += 1;
    }
    json!(out)
}

/// A table for people.
pub fn table(cases: &[Case]) -> String {
    let mut out = String::from(
        "campaign   truth -> most probable (probability; on truth) decision closed seconds\n",
    );
    for c in cases {
        let name = |n: &[String]| if n.is_empty() { "none".to_string() } else { n.join("+") };
        out.push_str(&format!(
            "{:<10} {} {} -> {} ({:.2}; {:.2}) {} [{}] {:.2} {:.0}\n",
            c.id,
            if c.right() { "+" } else { "-" },
            name(&c.truth),
            name(&c.top.0),
            c.top.1,
            c.on_truth,
            c.kind,
            c.answer.join(","),
            c.closed,
            c.seconds
        ));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_of_nine_in_ten() {
        // Closed form, tabulated: 0.596 to 0.982.
        let [lo, hi] = wilson(9, 10);
        assert!((lo - 0.596).abs() < 1e-3 && (hi - 0.982).abs() < 1e-3, "{lo} {hi}");
    }

    #[test]
    fn a_right_and_sure_answer_has_no_calibration_error() {
        let answer = json!({
            "decision": {"kind": "named", "effects": ["adhesion"]},
            "hypotheses": [{"effects": ["adhesion"], "probability": 1.0}],
        });
        let label = json!({"effects": ["adhesion"], "severity": 2});
        let cases = [case("a", &label, &answer)];
        assert_eq!(ece(&cases), 0.0);
        assert!(cases[0].right());
    }
}
