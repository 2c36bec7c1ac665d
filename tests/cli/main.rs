//! The command line from outside: the real binary, in a folder of its own per test.
#![cfg(feature = "cli")]

mod folder;
mod problems;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use folder::{stderr, Folder};

fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

const SLIDE: &str = "[run]\nduration = 0.002\n[run.slide]\nspeed = 0.3\nmean_pressure = 250e3\n";

/// Every part of a message that a user needs: name, value, allowed, way out.
fn tells(text: &str, parts: &[&str]) {
    let line = text.lines().find(|line| line.contains(parts[0]));
    let line = line.unwrap_or_else(|| panic!("{:?} is not named in:\n{text}", parts[0]));
    for part in parts {
        assert!(line.contains(part), "{part:?} is not told in: {line}");
    }
}

#[test]
fn what_init_writes_is_checked_simulated_and_plotted() {
    for kind in ["slide", "roll"] {
        let folder = Folder::new(&format!("chain-{kind}"));
        folder.fine(&["init", kind, "--out", "run.toml"]);
        assert!(folder.fine(&["check", "run.toml"]).contains("a good run"));
        let short = ["--set", "run.duration=0.001"];
        folder.fine(&["simulate", "run.toml", "--out", "run.csv", short[0], short[1]]);
        folder.fine(&["plot", "run.csv"]);
        let svg = std::fs::read_to_string(folder.0.join("run.svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("displacement [µm]"));
        assert!(!svg.contains("NaN"), "a coordinate is not a number");
    }
}

#[test]
fn the_csv_has_the_outputs_of_the_fmu_and_a_row_per_communication_step() {
    let folder = Folder::new("columns");
    folder.write("run.toml", SLIDE);
    let csv = folder.fine(&["simulate", "run.toml", "--set", "run.communication_step=1e-4"]);
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    // The FMU has a variable for each output, an array's elements counted one by one.
    let outputs: usize = tread_block::block::OUTPUTS.iter().map(|spec| spec.size).sum();
    assert_eq!(header.len(), outputs + 1, "{header:?}");
    assert_eq!(header[0], "time");
    for name in ["force.x", "contact.pressure[1]", "contact.sliding_speed[21]", "carriage.z"] {
        assert!(header.contains(&name), "{name}");
    }
    let times: Vec<f64> =
        lines.map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(times.len(), 21);
    assert!(times.iter().enumerate().all(|(i, t)| (t - 1e-4 * i as f64).abs() < 1e-12));
}

#[test]
fn fields_are_written_at_the_times_asked_for() {
    let folder = Folder::new("field");
    folder.write("run.toml", SLIDE);
    let out = ["simulate", "run.toml", "--out", "run.csv", "--field", "field.csv"];
    folder.fine(&[&out[..], &["--field-times", "0,1.004e-3"]].concat());
    let text = std::fs::read_to_string(folder.0.join("field.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time,node,x,z,ux,uz"));
    let rows: Vec<Vec<f64>> =
        lines.map(|l| l.split(',').map(|c| c.parse().unwrap()).collect()).collect();
    let nodes = rows.iter().filter(|r| r[0] == 0.0).count();
    assert!(nodes > 20 && rows.len() == 2 * nodes);
    assert!(rows[nodes..].iter().all(|r| r[0] == 1e-3), "the row nearest to 1.004 ms");
    // Clamped: nodes at the top of the mesh (z = height, 10 mm) do not move relative to the clamped face.
    let clamped = rows.iter().filter(|r| (r[3] - 0.01).abs() < 1e-12);
    assert!(clamped.clone().count() > 0 && clamped.clone().all(|r| r[4] == 0.0 && r[5] == 0.0));
    let text = folder.refused(&[&out[..], &["--field-times", "7.0"]].concat());
    tells(&text, &["--field-times", "7", "0 to 0.002 s"]);
}

#[test]
fn json_names_units_and_parameters() {
    let folder = Folder::new("json");
    folder.write("run.toml", SLIDE);
    let text = folder.fine(&["simulate", "run.toml", "--json", "--set", "friction.mu_inf=0.55"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["parameters"]["friction.mu_inf"], 0.55);
    assert_eq!(json["parameters"]["drive.normal"], "load");
    assert_eq!(json["columns"]["contact.pressure[3]"]["unit"], "Pa");
    assert_eq!(json["columns"]["time"]["values"].as_array().unwrap().len(), 201);
    assert_eq!(json["summary"]["stick-slip frequency"]["unit"], "Hz");
}

#[test]
fn what_is_printed_for_people_comes_as_json_too() {
    let folder = Folder::new("for-programs");
    let text = folder.fine(&["fmu", "describe", "--json"]);
    let variables: serde_json::Value = serde_json::from_str(&text).unwrap();
    let load = variables.as_array().unwrap().iter().find(|v| v["name"] == "normal_load").unwrap();
    assert_eq!(load["unit"], "N");
    assert_eq!(load["causality"], "input");
    folder.write("no.fmu", "no zip");
    tells(&folder.refused(&["fmu", "check", "no.fmu", "--json"]), &["no.fmu", "make fmu"]);
}

#[test]
fn an_identification_comes_as_json() {
    // One column, solved coarsely, no search: only what the table pins down at the start.
    let folder = Folder::new("identify-json");
    let text = folder.fine(&[
        "identify",
        "--columns",
        "h6l15",
        "--evaluations",
        "0",
        "--rounds",
        "0",
        "--coarse",
        "--free",
        "friction.mu_drop,contact.depth",
        "--laws",
        "--out",
        "out",
        "--json",
    ]);
    let told: serde_json::Value = serde_json::from_str(&text).unwrap();
    let laws = told["laws"].as_array().unwrap();
    assert_eq!(laws.len(), 4);
    assert!(laws.iter().all(|law| law["end"]["median_error"].is_number()), "{laws:?}");
    assert_eq!(told["columns"], serde_json::json!(["h6l15"]));
    let depth = &told["parameters"][1];
    assert_eq!(depth["parameter"], "contact.depth");
    assert!(depth["from"].as_f64().unwrap() < depth["value"].as_f64().unwrap());
    assert_eq!(told["directions"].as_array().unwrap().len(), 2);
    assert!(told["directions"][0]["components"]["friction.mu_drop"].is_number());
}

#[test]
fn a_gap_check_comes_as_json_though_a_campaign_cannot_be_used() {
    let folder = Folder::new("gap-check");
    for name in ["campaigns/broken", "out"] {
        std::fs::create_dir_all(folder.0.join(name)).unwrap();
    }
    folder.write("campaigns/broken/campaign.toml", "no campaign");
    // A committed answer stands for a diagnosis of minutes: its campaign has the label.
    folder.write(
        "campaigns/labels.json",
        r#"{"a-01": {"effects": ["payne_softening"], "severity": 2}}"#,
    );
    let answer = project("tests/data/sealed-a-answers/a-01.json");
    std::fs::copy(answer, folder.0.join("out/a-01.json")).unwrap();
    let output = folder.tread(&["gap", "check", "campaigns", "--out", "out", "--json"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(told["campaigns"][0]["campaign"], "broken");
    assert!(told["campaigns"][0]["fault"].as_str().unwrap().contains("campaign.toml"));
    let text = folder.fine(&["gap", "score", "out", "campaigns/labels.json", "--json"]);
    let figures: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(told["score"], figures);
    assert_eq!(figures["top1_singles"]["hits"], 1);
}

#[test]
fn the_verdicts_of_a_study_come_as_json() {
    let folder = Folder::new("study-json");
    let text = folder.fine(&["study", "fig-2", "--coarse", "--out", "out", "--json"]);
    let studies: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(studies[0]["study"], "fig-2");
    for file in studies[0]["files"].as_array().unwrap() {
        assert!(folder.0.join("out").join(file.as_str().unwrap()).is_file(), "{file}");
    }
    let verdicts = studies[0]["verdicts"].as_array().unwrap();
    assert!(!verdicts.is_empty() && verdicts.iter().all(|v| v["holds"].is_boolean()));
}

#[test]
fn belt_writes_what_roll_reads() {
    let folder = Folder::new("roll");
    folder.fine(&["belt", "--speed", "15", "--slip", "-0.02", "--out", "belt.csv"]);
    folder.write("run.toml", "[run]\nduration = 1e-3\n[run.roll]\nbelt_file = \"belt.csv\"\n");
    assert_eq!(folder.fine(&["simulate", "run.toml"]).lines().count(), 102);
    tells(&folder.refused(&["belt", "--speed", "-5"]), &["speed", "-5", "0.1 to 150 m/s"]);
}

#[test]
fn the_shipped_examples_are_good() {
    let folder = Folder::new("examples");
    for name in ["examples/slide.toml", "examples/roll.toml"] {
        let file = project(name);
        folder.fine(&["check", file.to_str().unwrap()]);
        let out = ["--set", "run.duration=5e-4", "--out", "run.csv"];
        folder.fine(&[&["simulate", file.to_str().unwrap()], &out[..]].concat());
    }
}

#[test]
fn several_results_make_a_waterfall() {
    let folder = Folder::new("waterfall");
    folder.write("run.toml", SLIDE);
    for speed in ["0.1", "0.2"] {
        let set = format!("run.slide.speed={speed}");
        folder.fine(&["simulate", "run.toml", "--set", &set, "--out", &format!("v{speed}.csv")]);
    }
    folder.fine(&["plot", "v0.1.csv", "v0.2.csv", "--out", "all.svg"]);
    let svg = std::fs::read_to_string(folder.0.join("all.svg")).unwrap();
    assert!(svg.contains("v0.1") && svg.contains("v0.2") && !svg.contains("NaN"));
    let speeds = ["plot", "v0.1.csv", "v0.2.csv", "--speeds", "0.1,0.2", "--out"];
    folder.fine(&[&speeds[..], &["speeds.svg"]].concat());
    let svg = std::fs::read_to_string(folder.0.join("speeds.svg")).unwrap();
    assert!(svg.contains("road speed [m/s]") && !svg.contains("NaN"));
    folder.fine(&[&speeds[..], &["speeds.png", "--width", "500"]].concat());
    let png = std::fs::read(folder.0.join("speeds.png")).unwrap();
    // 1000 x 360 at half the size; PNG specification: eight bytes of signature, width from byte 16.
    assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(png[16..24], [0, 0, 1, 0xf4, 0, 0, 0, 180]);
    let falling = ["plot", "v0.1.csv", "v0.2.csv", "--speeds", "0.2,0.1"];
    assert!(folder.refused(&falling).contains("2 rising speeds"));
    assert!(folder.refused(&["plot", "v0.1.csv", "--out", "run.jpg"]).contains(".svg or .png"));
}

#[test]
fn metrics_of_a_file_are_those_of_its_signal() {
    // Closed form: a sine of 1 kHz, 100 µm peak to peak, on a friction of 0.8.
    let folder = Folder::new("metrics");
    let mut csv = String::from(
        "time,run_in.displacement.x,run_in.velocity.x,contact.friction_coefficient,\
         contact.stick_fraction\n",
    );
    for i in 0..2000 {
        let t = 1e-5 * f64::from(i);
        let (sin, cos) = (std::f64::consts::TAU * 1e3 * t).sin_cos();
        csv.push_str(&format!("{t},{},{},0.8,0.5\n", 50e-6 * sin, 0.314159 * cos));
    }
    folder.write("run.csv", &csv);
    let text = folder.fine(&["metrics", "run.csv", "--speed", "0.3", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let value = |name: &str| json[name]["value"].as_f64().unwrap();
    assert!((value("stick-slip frequency") / 1e3 - 1.0).abs() < 1e-3);
    assert!((value("displacement, peak to peak") / 100.0 - 1.0).abs() < 1e-3);
    assert!((value("mean friction") - 0.8).abs() < 1e-9);
}

#[test]
fn a_reader_that_leaves_is_no_fault() {
    let folder = Folder::new("pipe");
    folder.write("run.toml", SLIDE);
    let mut child = Command::new(env!("CARGO_BIN_EXE_tread"))
        .args(["simulate", "run.toml", "--set", "run.communication_step=1e-6"])
        .current_dir(&folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn help_shows_examples_and_exit_codes_and_completions_know_all_commands() {
    let folder = Folder::new("help");
    let help = folder.fine(&["--help"]);
    for part in ["Examples:", "Exit codes:", "tread init slide", "SI units"] {
        assert!(help.contains(part), "{part}");
    }
    for shell in ["bash", "zsh", "fish"] {
        let script = folder.fine(&["completions", shell]);
        for command in ["simulate", "belt", "init", "check", "plot", "metrics", "fmu"] {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    assert_eq!(folder.tread(&["simulat"]).status.code(), Some(2));
}
