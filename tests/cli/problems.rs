//! What is told when something is wrong: what, value, allowed, way out; all at once.

use super::folder::{stderr, Folder};
use super::{tells, SLIDE};

#[test]
fn a_sweep_is_checked_with_the_run_of_each_point() {
    let folder = Folder::new("check-sweep");
    let plan = format!("{SLIDE}[sweep]\nmethod = \"grid\"\n[sweep.vary]\n");
    let vary = "\"rubber.poisson_ratio\" = [0.45, 0.49]\n";
    folder.write("good.toml", &format!("{plan}{vary}"));
    assert!(folder.fine(&["check", "good.toml"]).contains("a good sweep"));
    folder.write("bad.toml", &format!("{plan}{}", vary.replace("0.49", "0.6")));
    let checked = folder.tread(&["check", "bad.toml"]);
    assert_eq!(checked.status.code(), Some(1), "{}", stderr(&checked));
    tells(&String::from_utf8_lossy(&checked.stdout), &["rubber.poisson_ratio", "0.6"]);
}

#[test]
fn all_problems_of_a_file_are_told_at_once() {
    let folder = Folder::new("problems");
    folder.write(
        "bad.toml",
        "[run]\nduration = -1.0\ncolour = \"red\"\n[run.slide]\nspeed = \"fast\"\n\
         [rubber]\npoisson_ratio = 0.5\nyoung_moduls = 5e7\n[friction]\nform = \"linear\"\n",
    );
    let text = folder.refused(&["simulate", "bad.toml", "--set", "block.length=0"]);
    tells(&text, &["run.duration", "-1", "1e-6 to 10000 s"]);
    tells(&text, &["run.colour", "red", "one of", "drop"]);
    tells(&text, &["run.slide.speed", "fast", "-50 to 50 m/s", "SI units"]);
    tells(&text, &["run.slide.mean_pressure", "missing", "a number [Pa]", "mean_pressure = 250e3"]);
    tells(&text, &["rubber.poisson_ratio", "0.5", "0 to 0.4999"]);
    tells(&text, &["rubber.young_moduls", "did you mean rubber.young_modulus?"]);
    tells(&text, &["friction.form", "linear", "rational, log_bell, table", "choose"]);
    tells(&text, &["block.length = 0", "0.001 to 0.2 m"]);
    let output = folder.tread(&["check", "bad.toml", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["problems"].as_array().unwrap().len() >= 7);
}

#[test]
fn a_run_that_says_nothing_or_too_much_is_refused() {
    let folder = Folder::new("nothing");
    folder.write("empty.toml", "[block]\nlength = 0.02\n");
    tells(&folder.refused(&["simulate", "empty.toml"]), &["run = missing", "[run.slide]", "init"]);
    folder.write("both.toml", &format!("{SLIDE}[run.roll]\nbelt_speed = 10\n"));
    tells(&folder.refused(&["simulate", "both.toml"]), &["run.slide or roll", "exactly one"]);
    folder.write("drive.toml", &format!("{SLIDE}[drive]\nnormal = \"trajectory\"\n"));
    let text = folder.refused(&["simulate", "drive.toml"]);
    tells(&text, &["drive.normal", "trajectory", "load", "leave it out"]);
    folder.write("broken.toml", "[run\n");
    tells(&folder.refused(&["simulate", "broken.toml"]), &["TOML"]);
    tells(
        &folder.refused(&["simulate", "absent.toml"]),
        &["absent.toml", "No such file", "its name"],
    );
    tells(&folder.refused(&["simulate", "both.toml", "--set", "nonsense"]), &["nonsense"]);
}

#[test]
fn the_wrong_file_is_one_problem_with_a_way_out() {
    let folder = Folder::new("wrong-file");
    folder.write("run.toml", SLIDE);
    folder.write("empty.csv", "");
    folder.write("header.csv", "time\n");
    for command in [&["plot", "empty.csv"][..], &["metrics", "empty.csv", "--speed", "0.3"]] {
        let text = folder.refused(command);
        assert_eq!(text.lines().count(), 1, "{text}");
        tells(&text, &["empty.csv = an empty file", "time, run_in", "`tread simulate` writes"]);
    }
    let text = folder.refused(&["plot", "header.csv"]);
    assert_eq!(text.lines().count(), 1, "{text}");
    // 6 columns beside 21 stations; time is there, 6 are named.
    tells(&text, &["header.csv: columns run_in.displacement.x", "and 20 more", "has time"]);
    tells(
        &folder.refused(&["simulate", "header.csv"]),
        &["TOML, line 1", "\"time\"", "right file"],
    );
    tells(&folder.refused(&["simulate", "."]), &["Is a directory", "name a file in it"]);
    let output = folder.tread(&["check", "."]);
    assert_eq!(output.status.code(), Some(1));
    tells(&String::from_utf8_lossy(&output.stdout), &["campaign.toml", "tread gap import"]);
    let text = folder.refused(&["metrics", "header.csv", "--speed", "0"]);
    tells(&text, &["--speed", "not 0", "for example 0.3"]);
}

#[test]
fn a_mistyped_name_is_answered_with_the_right_one() {
    let folder = Folder::new("mistyped");
    folder.write("run.toml", &SLIDE.replace("run.slide", "run.sliding"));
    tells(&folder.refused(&["simulate", "run.toml"]), &["did you mean run.slide.mean_pressure?"]);
    folder.write("run.toml", SLIDE);
    let sets =
        ["--set", "rubber.E=5e7", "--set", "block.height=-0.01", "--set", "block.hight=0.01"];
    let text = folder.refused(&[&["simulate", "run.toml"], &sets[..]].concat());
    // E is near to nothing: the whole table instead of a wild guess.
    tells(&text, &["rubber.E = 5", "rubber has young_modulus, poisson_ratio"]);
    tells(&text, &["block.hight", "did you mean block.height?"]);
    // The shape follows from the height, which is wrong itself: no problem of its own.
    tells(&text, &["block.height = -0.01", "0.001 to 0.1 m"]);
    assert!(text.contains("3 problems"), "{text}");
}

#[test]
fn without_a_terminal_nothing_is_coloured() {
    let folder = Folder::new("colours");
    folder.write("run.toml", SLIDE);
    for command in [&["--help"][..], &["simulat"], &["simulate", "run.toml"], &["check", "nix"]] {
        let output = folder.tread(command);
        let all = [output.stdout, output.stderr].concat();
        assert!(!all.contains(&0x1b), "{command:?}");
    }
}

#[test]
fn a_malformed_belt_path_is_told_by_column_and_line() {
    let folder = Folder::new("belt");
    folder.write("run.toml", "[run.roll]\nbelt_file = \"belt.csv\"\n");
    tells(&folder.refused(&["simulate", "run.toml"]), &["run.roll.belt_file", "belt.csv"]);
    folder.write("belt.csv", "time,belt_x_m,belt_z_m\n0,0,0\n");
    let text = folder.refused(&["simulate", "run.toml"]);
    tells(&text, &["columns time_s, belt_angle_rad", "missing", "tread belt"]);
    let header = "time_s,belt_x_m,belt_z_m,belt_angle_rad\n";
    folder.write("belt.csv", &format!("{header}0,0,0.01,0\n1e-5,x,0.01,0\n2e-5,0,nan\n"));
    let text = folder.refused(&["simulate", "run.toml"]);
    tells(&text, &["column belt_x_m, line 3", "x", "a finite number"]);
    tells(&text, &["column belt_z_m, line 4", "nan"]);
    tells(&text, &["column belt_angle_rad, line 4", "missing"]);
    let still = "1e-5,0,0.01,0\n2e-5,0,0.01,0\n3e-5,0,0.01,0\n3e-5,9,0.01,0\n";
    folder.write("belt.csv", &format!("{header}0,0,0.01,0\n{still}"));
    let output = folder.tread(&["check", "belt.csv"]);
    assert_eq!(output.status.code(), Some(1));
    tells(&String::from_utf8_lossy(&output.stdout), &["time_s, sample 5", "more than 0.00003"]);
}
