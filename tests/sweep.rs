//! `tread sweep` from outside: what it promises about threads, stops, failures and files.
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// 18 short runs of two shapes, two of them with a parameter out of its range.
const PLAN: &str = "
[run]
duration = 0.002
communication_step = 2e-5
[run.slide]
speed = 0.3
mean_pressure = 250e3
[solver]
elements_along = 6
elements_up = 4
[sweep]
method = \"grid\"
[sweep.vary]
\"block.length\" = [0.010, 0.015, 0.5]
\"friction.mu_inf\" = { from = 0.4, to = 0.6, count = 3 }
\"run.slide.speed\" = [0.1, 0.3]
";

struct Folder(PathBuf);

impl Folder {
    fn new(test: &str, plan: &str) -> Self {
        let path = std::env::temp_dir().join(format!("tread-sweep-{test}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("plan.toml"), plan).unwrap();
        Self(path)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tread"));
        command.arg("sweep").arg("plan.toml").args(arguments).current_dir(&self.0);
        command
    }

    fn sweep(&self, code: i32, arguments: &[&str]) -> Output {
        let output = self.command(arguments).output().unwrap();
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}\n{talk}");
        output
    }

    fn read(&self, path: &str) -> String {
        fs::read_to_string(self.0.join(path)).unwrap()
    }

    fn bytes(&self, path: &str) -> Vec<u8> {
        fs::read(self.0.join(path)).unwrap()
    }

    /// Rows of a result as cells, the header first.
    fn rows(&self, path: &str) -> Vec<Vec<String>> {
        let mut reader =
            csv::ReaderBuilder::new().has_headers(false).from_path(self.0.join(path)).unwrap();
        let cells = |row: csv::StringRecord| row.iter().map(str::to_string).collect();
        reader.records().map(|row| cells(row.unwrap())).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let folder = Folder::new("threads", PLAN);
    folder.sweep(1, &["--out", "one", "--jobs", "1"]);
    for jobs in ["2", "5"] {
        folder.sweep(1, &["--out", jobs, "--jobs", jobs]);
        for file in ["sweep.csv", "sweep.parquet"] {
            let (one, many) = (format!("one/{file}"), format!("{jobs}/{file}"));
            assert!(folder.bytes(&one) == folder.bytes(&many), "{file} with {jobs} threads");
        }
    }
}

#[test]
fn a_failed_point_is_a_row_with_its_reason_and_stops_no_other() {
    let folder = Folder::new("failed", PLAN);
    let output = folder.sweep(1, &["--out", "out"]);
    assert!(stderr(&output).contains("18 points, 6 failed"), "{}", stderr(&output));
    let rows = folder.rows("out/sweep.csv");
    let column = |name: &str| rows[0].iter().position(|c| c == name).unwrap();
    assert_eq!(rows.len(), 19);
    for row in &rows[1..] {
        let failed = row[column("block.length")] == "0.5";
        assert_eq!(row[column("status")], if failed { "failed" } else { "ok" });
        assert_eq!(row[column("reason")].contains("block.length = 0.5"), failed, "{row:?}");
        assert_eq!(row[column("mean_friction_1")].is_empty(), failed);
    }
}

#[test]
fn a_killed_sweep_resumes_without_loss_and_without_repeating() {
    let plan = PLAN.replace("duration = 0.002", "duration = 0.02");
    let folder = Folder::new("killed", &plan);
    folder.sweep(1, &["--out", "whole"]);
    // Twice: what a resumed sweep leaves can be resumed, too.
    let mut before = 0;
    for _ in 0..2 {
        kill_after(&folder, before + 3);
        before = folder.read("out/journal.jsonl").lines().count();
        assert!(before < 19, "the sweep ended before it was killed");
    }
    // What a kill within a write leaves.
    let mut journal = folder.read("out/journal.jsonl");
    let kept = journal[..=journal.rfind('\n').unwrap()].to_string();
    journal = kept.clone() + "{\"point\":17,\"measu";
    fs::write(folder.0.join("out/journal.jsonl"), journal).unwrap();
    let output = folder.sweep(1, &["--out", "out", "--resume"]);
    let done = kept.lines().count() - 1;
    assert!(stderr(&output).contains(&format!("{done} of 18 points are done")));
    for file in ["sweep.csv", "sweep.parquet"] {
        let (whole, resumed) = (format!("whole/{file}"), format!("out/{file}"));
        assert!(folder.bytes(&whole) == folder.bytes(&resumed), "{file}");
    }
    let journal = folder.read("out/journal.jsonl");
    assert!(journal.starts_with(&kept), "what was done is kept");
    assert_eq!(journal.lines().count(), 19, "every point has one line: none ran twice");
}

/// Starts or resumes the sweep and kills it when its journal has `lines`.
fn kill_after(folder: &Folder, lines: usize) {
    let mut command = folder.command(&["--out", "out", "--jobs", "1", "--resume"]);
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    let journal = folder.0.join("out/journal.jsonl");
    let start = Instant::now();
    while fs::read_to_string(&journal).map_or(0, |text| text.lines().count()) < lines {
        assert!(start.elapsed() < Duration::from_secs(60), "no points within a minute");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_point_gives_what_a_run_of_its_parameters_gives() {
    let folder = Folder::new("point", &PLAN.replace("duration = 0.002", "duration = 0.02"));
    folder.sweep(1, &["--out", "out"]);
    let run = PLAN.split("[sweep]").next().unwrap().replace("0.002", "0.02");
    fs::write(folder.0.join("run.toml"), run).unwrap();
    let sets = ["block.length=0.015", "friction.mu_inf=0.5", "run.slide.speed=0.3"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_tread"));
    command.args(["simulate", "run.toml", "--json", "--set", "run.inputs=sampled"]);
    for set in sets {
        command.args(["--set", set]);
    }
    let output = command.current_dir(&folder.0).output().unwrap();
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = folder.rows("out/sweep.csv");
    // Lengths, frictions, speeds in the order of a grid: 1 · 6 + 1 · 2 + 1, and the header.
    let row = &rows[1 + 6 + 2 + 1];
    for (name, column, scale) in
        [("stick-slip frequency", "frequency_hz", 1.0), ("mean friction", "mean_friction_1", 1.0)]
    {
        let expected = result["summary"][name]["value"].as_f64().unwrap() * scale;
        let at = rows[0].iter().position(|c| c == column).unwrap();
        assert_eq!(row[at].parse::<f64>().unwrap(), expected, "{name}");
        assert!(expected > 0.1, "{name}: there is something to compare");
    }
}

#[test]
fn a_started_sweep_is_not_overwritten_nor_mixed_with_another() {
    let folder = Folder::new("mixed", &PLAN.replace("0.5]", "0.02]"));
    folder.sweep(0, &["--out", "out"]);
    assert!(stderr(&folder.sweep(2, &["--out", "out"])).contains("--resume"));
    fs::write(folder.0.join("plan.toml"), PLAN.replace("250e3", "300e3")).unwrap();
    assert!(stderr(&folder.sweep(2, &["--out", "out", "--resume"])).contains("of this plan"));
}

#[test]
fn a_finished_sweep_resumes_to_the_same_tables_at_once() {
    let folder = Folder::new("finished", PLAN);
    folder.sweep(1, &["--out", "out"]);
    let (csv, journal) = (folder.bytes("out/sweep.csv"), folder.bytes("out/journal.jsonl"));
    fs::remove_file(folder.0.join("out/sweep.csv")).unwrap();
    folder.sweep(1, &["--out", "out", "--resume"]);
    assert!(folder.bytes("out/sweep.csv") == csv && folder.bytes("out/journal.jsonl") == journal);
}

#[test]
fn all_problems_of_a_plan_are_told_at_once() {
    let plan = "[run.slide]\nspeed = 0.3\n[sweep]\nmethod = \"gird\"\npoint = 3\n[sweep.vary]\n\
                \"friction.mu\" = [1.0]\n\"friction.form\" = [1.0]\n";
    let folder = Folder::new("problems", plan);
    let told = stderr(&folder.sweep(2, &[]));
    for part in ["gird", "sweep.point ", "friction.mu ", "friction.form ", "one_at_a_time"] {
        assert!(told.contains(part), "{part} is not told in:\n{told}");
    }
}

#[test]
fn points_only_prints_the_points_of_every_method() {
    for (method, more, points) in [
        ("grid", "", 18),
        ("one_at_a_time", "", 9),
        ("latin_hypercube", "points = 20\n", 20),
        ("sobol", "points = 32\nseed = 3\n", 32),
    ] {
        let plan = PLAN.replace("method = \"grid\"\n", &format!("method = {method:?}\n{more}"));
        let folder = Folder::new(&format!("points-{method}"), &plan);
        let output = folder.sweep(0, &["--points-only"]);
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.starts_with("point,block.length,friction.mu_inf,run.slide.speed\n"), "{text}");
        assert_eq!(text.lines().count(), 1 + points, "{method}");
        assert!(!Path::new(&folder.0).join("out").exists(), "nothing is run");
    }
}

#[test]
fn the_example_is_a_plan() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/sweep.toml");
    let folder = Folder::new("example", &fs::read_to_string(example).unwrap());
    let output = folder.sweep(0, &["--points-only"]);
    assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 1 + 27);
}
