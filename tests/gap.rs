//! The gap diagnosis: data that cannot be trusted, rules that need no model, answers that keep their schema.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tread_block::error::Fault;
use tread_block::gap::campaign::Campaign;
use tread_block::gap::packed::Source;
use tread_block::gap::problem::{Bench, Look};
use tread_block::gap::symmetry::{self, Rule};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn open(number: usize) -> PathBuf {
    data(&format!("campaigns/open/open-{number:02}.zip"))
}

/// A campaign unpacked into a folder of its own, to be damaged.
struct Unpacked(PathBuf);

impl Unpacked {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("tread-gap-{}-{name}", std::process::id()));
        let Source::Packed(files) = Source::open(&open(12)).unwrap() else { panic!("not packed") };
        for (file, bytes) in files {
            let target = folder.join(file);
            std::fs::create_dir_all(target.parent().unwrap()).unwrap();
            std::fs::write(target, bytes).unwrap();
        }
        Self(folder)
    }

    /// Changes the cells of a column of a run.
    fn change(&self, run: &str, column: &str, cell: impl Fn(usize, f64) -> String) {
        let path = self.0.join("runs").join(run);
        let text = std::fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        let at = header.split(',').position(|h| h == column).unwrap();
        let mut out = format!("{header}\n");
        for (row, line) in lines.enumerate() {
            let mut cells: Vec<String> = line.split(',').map(str::to_string).collect();
            cells[at] = cell(row, cells[at].parse().unwrap());
            out.push_str(&(cells.join(",") + "\n"));
        }
        std::fs::write(path, out).unwrap();
    }

    fn load(&self) -> Result<Campaign, Fault> {
        Campaign::load(&self.0)
    }

    /// The warning that mentions both.
    fn told(&self, run: &str, word: &str) {
        let warnings = self.load().unwrap().warnings;
        let texts: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        assert!(
            texts.iter().any(|t| t.contains(run) && t.contains(word)),
            "{run}, {word}: {texts:?}"
        );
    }
}

impl Drop for Unpacked {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_good_campaign_has_nothing_to_complain_of() {
    let campaign = Campaign::load(&open(12)).unwrap();
    assert_eq!(campaign.runs.len(), 16);
    assert!(campaign.warnings.is_empty(), "{:?}", campaign.warnings);
}

#[test]
fn cells_that_are_no_numbers_take_the_channel_out_and_are_told() {
    let made = Unpacked::new("nan");
    made.change("03-v300.csv", "friction_force_n", |row, v| {
        if row > 200 {
            "NaN".into()
        } else {
            v.to_string()
        }
    });
    made.told("03-v300", "no numbers");
}

#[test]
fn a_constant_channel_is_told() {
    let made = Unpacked::new("constant");
    made.change("04-v450.csv", "edge_velocity_m_s", |_, _| "0.1".into());
    made.told("04-v450", "constant");
}

#[test]
fn a_clipped_channel_is_told() {
    let made = Unpacked::new("clipped");
    made.change("05-v600.csv", "friction_force_n", |_, v| v.min(30.0).to_string());
    made.told("05-v600", "30");
}

#[test]
fn a_force_in_kilonewtons_is_told() {
    let made = Unpacked::new("scale");
    made.change("06-p012.csv", "normal_force_n", |_, v| format!("{:.6}", v / 1000.0));
    made.told("06-p012", "normal_force_n");
}

#[test]
fn a_shifted_time_leaves_the_run_out_and_is_told() {
    let made = Unpacked::new("shifted");
    made.change("07-p040.csv", "time_s", |_, t| format!("{:.7}", t + 0.003));
    made.told("07-p040", "starts at");
    assert_eq!(made.load().unwrap().runs.len(), 15);
}

#[test]
fn a_sampling_rate_that_contradicts_the_time_is_told_and_nothing_is_named_for_it() {
    let made = Unpacked::new("clock");
    let runs = made.load().unwrap().runs;
    for run in &runs {
        let name = run.spec.file.strip_prefix("runs/").unwrap().to_string();
        made.change(&name, "time_s", |_, t| format!("{:.7}", 1.06 * t));
    }
    made.told("sampling_rate_hz", "no effect is named");
    assert!(symmetry::beyond_list(&symmetry::findings(&made.load().unwrap())));
}

#[test]
fn a_missing_run_and_a_missing_channel_are_worked_around() {
    let made = Unpacked::new("missing");
    std::fs::remove_file(made.0.join("runs/08-p060.csv")).unwrap();
    let path = made.0.join("runs/02-v200.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("normal_force_n", "other")).unwrap();
    made.told("08-p060", "left out");
    made.told("02-v200", "missing");
}

#[test]
fn two_runs_that_are_the_same_file_are_told() {
    let made = Unpacked::new("twice");
    std::fs::copy(made.0.join("runs/03-v300.csv"), made.0.join("runs/15-repeat-v300.csv")).unwrap();
    made.told("15-repeat-v300", "03-v300");
}

#[test]
fn a_campaign_of_three_runs_decides_nothing() {
    let made = Unpacked::new("small");
    for run in ["04-v450", "05-v600", "06-p012", "07-p040", "08-p060", "09-slow-p040", "10-ramp-up"]
    {
        std::fs::remove_file(made.0.join(format!("runs/{run}.csv"))).unwrap();
    }
    for run in ["11-ramp-down", "12-reverse-v300", "13-dwell", "14-no-dwell", "15-repeat-v300"] {
        std::fs::remove_file(made.0.join(format!("runs/{run}.csv"))).unwrap();
    }
    assert!(matches!(made.load(), Err(Fault::Invalid(_))));
}

#[test]
fn rules_break_in_the_campaigns_whose_labels_break_them_and_in_no_other() {
    let text = std::fs::read_to_string(data("campaigns/open/labels.json")).unwrap();
    let labels: Value = serde_json::from_str(&text).unwrap();
    let breaks = |rule: Rule| -> Vec<&str> {
        match rule {
            Rule::Rest => vec!["friction_ageing"],
            Rule::Mirror => vec!["road_texture", "misalignment", "worn_edge"],
            Rule::Kinematics | Rule::Clock => vec!["x_clock"],
            Rule::Repeat | Rule::Load | Rule::Balance | Rule::Carriage => vec![],
            Rule::Zero | Rule::Forces => vec![],
        }
    };
    for number in 1..=15 {
        let effects = labels[format!("open-{number:02}")]["effects"].as_array().unwrap();
        let campaign = Campaign::load(&open(number)).unwrap();
        for finding in symmetry::findings(&campaign) {
            // With the time column mended, displacement fits velocity again.
            if finding.rule == Rule::Kinematics {
                continue;
            }
            let expected =
                effects.iter().any(|e| breaks(finding.rule).contains(&e.as_str().unwrap()));
            assert_eq!(finding.broken, expected, "open-{number:02}: {}", finding.text);
        }
    }
}

#[test]
fn sensors_that_are_wrong_by_a_little_break_a_rule_that_no_effect_breaks() {
    // A campaign without an effect, damaged: a gain of 1 % of the normal force is 0.01 in the balance of the
    // carriage, 2 % of friction in the normal force 0.02 times friction over load, about 0.7; a friction channel with
    // an offset of 1 N is fifteen of its standard deviations off.
    let runs: Vec<String> = Unpacked::new("runs")
        .load()
        .unwrap()
        .runs
        .iter()
        .skip(1)
        .map(|r| r.spec.file.trim_start_matches("runs/").to_string())
        .collect();
    type Damage = (&'static str, Rule, fn(f64) -> f64);
    let damages: [Damage; 3] = [
        ("normal_force_n", Rule::Balance, |n| 1.01 * n),
        ("friction_force_n", Rule::Zero, |f| f + 1.0),
        ("edge_velocity_m_s", Rule::Kinematics, |v| 0.98 * v),
    ];
    for (column, rule, damage) in damages {
        let made = Unpacked::new(column);
        for run in &runs {
            made.change(run, column, |_, value| format!("{:.9}", damage(value)));
        }
        let findings = symmetry::findings(&made.load().unwrap());
        let broken: Vec<Rule> = findings.iter().filter(|f| f.broken).map(|f| f.rule).collect();
        assert!(broken.contains(&rule), "{column}: {broken:?}");
        assert!(symmetry::beyond_list(&findings));
    }
}

#[test]
fn a_drift_of_one_force_is_no_tilt_and_no_texture() {
    // Friction that drifts by 5 N over a run differs between a run and its reverse; load and approach do not.
    let made = Unpacked::new("drift");
    for run in ["03-v300.csv", "12-reverse-v300.csv", "15-repeat-v300.csv"] {
        made.change(run, "friction_force_n", |row, value| {
            format!("{:.9}", value + 5.0 * row as f64 / 600.0)
        });
    }
    let findings = symmetry::findings(&made.load().unwrap());
    assert!(findings.iter().any(|f| f.rule == Rule::Forces && f.broken), "{findings:?}");
}

#[test]
fn the_answer_does_not_depend_on_the_number_of_threads() {
    let campaign = Campaign::load(&open(12)).unwrap();
    let bench = Bench::new(&campaign, tread_block::effects::fit_specs(), Look::Start).unwrap();
    let points = [vec![0.0; bench.base_size()], vec![0.3; bench.base_size()]];
    let residuals = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bench.residuals(&[], &points, &[0, 3, 5]))
    };
    // The same bits: sums have a fixed order whatever the order of the work.
    assert_eq!(residuals(1), residuals(3));
}

#[test]
fn every_committed_answer_keeps_the_schema() {
    let folder = data("sealed-a-answers");
    let schema = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/diagnosis.schema.json"),
    )
    .unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        if entry.path().extension().is_none_or(|e| e != "json") {
            continue;
        }
        let text = std::fs::read_to_string(entry.path()).unwrap();
        let answer: Value = serde_json::from_str(&text).unwrap();
        let mut problems = Vec::new();
        check(&schema, &answer, "answer", &mut problems);
        assert!(problems.is_empty(), "{}: {problems:?}", entry.path().display());
        let sum: f64 = answer["hypotheses"]
            .as_array()
            .unwrap()
            .iter()
            .map(|h| h["probability"].as_f64().unwrap())
            .sum();
        assert!((sum - 1.0).abs() < 1e-9, "{}: {sum}", entry.path().display());
        count += 1;
    }
    assert_eq!(count, 24);
}

/// The words of JSON Schema that the project's schema uses.
fn check(schema: &Value, value: &Value, at: &str, problems: &mut Vec<String>) {
    let mut wrong = |what: String| problems.push(format!("{at}: {what}"));
    let is = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    };
    match &schema["type"] {
        Value::String(name) if !is(name) => wrong(format!("is no {name}")),
        Value::Array(names) if !names.iter().any(|n| is(n.as_str().unwrap_or(""))) => {
            wrong("is of none of the types".into());
        }
        _ => {}
    }
    if schema.get("const").is_some_and(|c| c != value) {
        wrong("is not the constant".into());
    }
    if schema["enum"].as_array().is_some_and(|e| !e.contains(value)) {
        wrong(format!("{value} is not in the list"));
    }
    if let (Some(least), Some(x)) = (schema["minimum"].as_f64(), value.as_f64()) {
        if x < least {
            wrong(format!("{x} is below {least}"));
        }
    }
    if let (Some(most), Some(x)) = (schema["maximum"].as_f64(), value.as_f64()) {
        if x > most {
            wrong(format!("{x} is above {most}"));
        }
    }
    for name in schema["required"].as_array().into_iter().flatten() {
        if value.get(name.as_str().unwrap_or("")).is_none() {
            wrong(format!("{name} is missing"));
        }
    }
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        if let Some(found) = value.get(name) {
            check(inner, found, &format!("{at}.{name}"), problems);
        }
    }
    if let (Some(inner), Some(items)) = (schema.get("items"), value.as_array()) {
        for (k, item) in items.iter().enumerate() {
            check(inner, item, &format!("{at}[{k}]"), problems);
        }
    }
}
