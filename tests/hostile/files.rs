//! Files as people and programs break them: parameters, runs, measured campaigns.

use super::config;
use proptest::prelude::*;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use tread_block::block::TreadBlock;
use tread_block::drive::{Pose, Segment};
use tread_block::gap::campaign::Campaign;
use tread_block::params::{check, load, Params};
use tread_block::scenario;

/// One way to break a text, line by line.
#[derive(Clone, Debug)]
enum Break {
    Delete { line: usize },
    Double { line: usize },
    Value { line: usize, value: String },
    Swap { line: usize, with: usize },
    Insert { at: usize, text: String },
    Cut { at: usize },
}

fn value() -> impl Strategy<Value = String> {
    let odd = [
        "nan",
        "-inf",
        "inf",
        "1e400",
        "-0.0",
        "0",
        "-1",
        "1e-320",
        "9223372036854775807",
        "\"\"",
        "\"%s%n\"",
        "[]",
        "[[1]]",
        "{}",
        "true",
        "1979-05-27",
        "'",
        "1_000",
        "0x10",
        "1e",
        "",
    ];
    prop_oneof![
        prop::sample::select(odd.map(String::from).to_vec()),
        (-400..400_i32).prop_map(|exponent| format!("1e{exponent}")),
        (1e-12..1e12_f64).prop_map(|x| format!("{x:?}")),
        (0.0..2.0_f64).prop_map(|x| format!("{x:?}")),
        "\\PC{0,20}",
    ]
}

fn breaks() -> impl Strategy<Value = Vec<Break>> {
    let line = || 0..200_usize;
    let one = prop_oneof![
        2 => line().prop_map(|line| Break::Delete { line }),
        1 => line().prop_map(|line| Break::Double { line }),
        8 => (line(), value()).prop_map(|(line, value)| Break::Value { line, value }),
        1 => (line(), line()).prop_map(|(line, with)| Break::Swap { line, with }),
        1 => (any::<usize>(), "\\PC{0,12}|\n\\[\\PC{0,8}\\]\n|\u{0}|\u{feff}")
            .prop_map(|(at, text)| Break::Insert { at, text }),
        1 => any::<usize>().prop_map(|at| Break::Cut { at }),
    ];
    prop::collection::vec(one, 1..6)
}

fn broken(text: &str, breaks: &[Break]) -> String {
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    for one in breaks {
        let n = lines.len().max(1);
        match one {
            Break::Delete { line } if !lines.is_empty() => drop(lines.remove(line % n)),
            Break::Double { line } if !lines.is_empty() => lines.push(lines[line % n].clone()),
            Break::Value { line, value } if !lines.is_empty() => {
                // The next line that has a value, or all breaks would meet comments and headers.
                let places = (0..n).map(|k| (line + k) % n);
                if let Some(at) = places.into_iter().find(|at| lines[*at].contains(['=', ','])) {
                    let cut = lines[at].find(['=', ',']).unwrap() + 1;
                    lines[at] = format!("{} {value}", &lines[at][..cut]);
                }
            }
            Break::Swap { line, with } if !lines.is_empty() => lines.swap(line % n, with % n),
            Break::Insert { at, text } => {
                let whole = lines.join("\n");
                let at = floor(&whole, at % (whole.len() + 1));
                let joined = format!("{}{text}{}", &whole[..at], &whole[at..]);
                lines = joined.lines().map(String::from).collect();
            }
            Break::Cut { at } => {
                let whole = lines.join("\n");
                let at = floor(&whole, at % (whole.len() + 1));
                lines = whole[..at].lines().map(String::from).collect();
            }
            _ => {}
        }
    }
    lines.join("\n")
}

/// The nearest place at or before `at` where a character starts.
fn floor(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

proptest! {
    #![proptest_config(config("tests/hostile/corpus/parameters.txt", 150))]

    #[test]
    fn parameters_are_refused_with_a_reason_or_make_a_block(breaks in breaks()) {
        let text = broken(&load::to_toml(&Params::default()), &breaks);
        match load::from_toml(&text) {
            Err(fault) => prop_assert!(!fault.to_string().is_empty()),
            Ok(params) => {
                prop_assert!(check::problems(&params).is_empty());
                prop_assert_eq!(&load::from_toml(&load::to_toml(&params)).unwrap(), &params);
                makes_a_block(params)?;
            }
        }
    }
}

/// Accepted parameters give a block that can be built and moved, or a reason why not; never NaN.
fn makes_a_block(mut params: Params) -> Result<(), TestCaseError> {
    (params.solver.elements_along, params.solver.elements_up) = (3, 2);
    // The step that a tiny internal step divides into millions is slow, not wrong.
    params.solver.max_step = params.solver.max_step.max(1e-6);
    params.solver.min_step = params.solver.min_step.max(1e-7).min(params.solver.max_step);
    let Ok(mut block) = TreadBlock::new(&params) else { return Ok(()) };
    let pose = Pose { z: params.block.height, load: 10.0, ..Pose::default() };
    if block.initialize(0.0, pose).is_err() || block.advance(1e-5, &Segment::still(pose)).is_err() {
        return Ok(());
    }
    let out = block.outputs();
    let finite = [out.force[0], out.force[1], out.carriage_z].iter().all(|x| x.is_finite());
    prop_assert!(finite, "outputs are not finite: {:?} {}", out.force, out.carriage_z);
    Ok(())
}

const RUN: &str = "\
[run]
duration = 0.01
communication_step = 1e-5
inputs = \"sampled\"
[run.slide]
speed = 0.3
speed_end = 0.4
start_ramp = 0.0005
dwell = 0.0
mean_pressure = 250000.0
[block]
height = 0.01
[friction]
mu_inf = 0.5
";

const ROLL: &str = "\
[run]
communication_step = 1e-5
[run.roll]
wheel_radius = 0.3
contact_length = 0.12
belt_speed = 10.0
slip = 0.03
compression = 0.0002
blend_length = 0.02
lead = 0.05
";

proptest! {
    #![proptest_config(config("tests/hostile/corpus/runs.txt", 300))]

    #[test]
    fn files_of_runs_are_refused_with_a_reason_or_planned(
        roll in any::<bool>(), breaks in breaks(),
    ) {
        let text = broken(if roll { ROLL } else { RUN }, &breaks);
        match scenario::config::from_toml(&text, Path::new("."), &[]) {
            Err(fault) => prop_assert!(!fault.to_string().is_empty()),
            Ok(config) => {
                prop_assert!(config.plan.check().is_err() || config.plan.rows() > 0);
                let pose = config.scenario.pose(config.scenario.start());
                prop_assert!(pose.x.is_finite() && pose.z.is_finite(), "{pose:?}");
            }
        }
    }
}

const RATE: f64 = 25e3;
const ROWS: usize = 120;

fn campaign() -> String {
    let mut text = format!(
        "format = \"tread-block-campaign/1\"\nid = \"made\"\n\
         [block]\nlength_m = 0.015\nheight_m = 0.01\nwidth_m = 0.015\n\
         [rig]\nload_carriage_mass_kg = 2.0\nload_carriage_damping_n_s_m = 240.0\nstart_ramp_s = 0.0005\n\
         [channels]\nsampling_rate_hz = {RATE}\nfriction_force_n = {{ noise_std = 0.25 }}\n\
         normal_force_n = {{ noise_std = 0.25 }}\nedge_velocity_m_s = {{ noise_std = 0.002 }}\n\
         [nominal]\nyoung_modulus_pa = {{ value = 50000000.0, relative_std = 0.05 }}\n"
    );
    for run in 0..5 {
        let _ = write!(
            text,
            "[[runs]]\nfile = \"run-{run}.csv\"\nkind = \"sliding\"\nroad_speed_m_s = 0.3\n\
             mean_pressure_pa = 250000.0\nduration_s = {}\n",
            ROWS as f64 / RATE
        );
    }
    text
}

fn record(run: usize) -> String {
    let mut text = String::from(
        "time_s,road_speed_m_s,friction_force_n,normal_force_n,edge_velocity_m_s,\
         edge_displacement_m,carriage_z_m\n",
    );
    for k in 0..ROWS {
        let t = k as f64 / RATE;
        let wave = (9e3 * t + run as f64).sin();
        let _ = writeln!(
            text,
            "{t},0.3,{},{},{},{},{}",
            30.0 + 5.0 * wave,
            56.0 + wave,
            0.2 * wave,
            2e-5 * wave,
            3e-6 * wave
        );
    }
    text
}

/// A folder of its own that goes away with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let name = format!("tread-hostile-{test}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn the_campaign_that_is_broken_here_is_whole_before() {
    let folder = Folder::new("whole");
    write(&folder.0, &[], &[]);
    let campaign = Campaign::load(&folder.0).unwrap();
    assert_eq!((campaign.runs.len(), campaign.warnings.len()), (5, 0), "{:?}", campaign.warnings);
}

fn write(folder: &Path, plan: &[Break], data: &[Break]) {
    std::fs::write(folder.join("campaign.toml"), broken(&campaign(), plan)).unwrap();
    for run in 0..5 {
        let text = if run == 0 { broken(&record(run), data) } else { record(run) };
        std::fs::write(folder.join(format!("run-{run}.csv")), text).unwrap();
    }
}

proptest! {
    #![proptest_config(config("tests/hostile/corpus/campaigns.txt", 60))]

    #[test]
    fn campaigns_are_refused_with_a_reason_or_hold_finite_numbers(
        plan in prop::collection::vec(breaks(), 0..2), data in breaks(),
    ) {
        let folder = Folder::new("broken");
        write(&folder.0, &plan.concat(), &data);
        match Campaign::load(&folder.0) {
            Err(fault) => prop_assert!(!fault.to_string().is_empty()),
            Ok(campaign) => {
                for record in campaign.runs.iter().map(|run| &run.record) {
                    prop_assert!(record.time.iter().all(|t| t.is_finite()));
                    for column in record.channel.iter().flatten() {
                        prop_assert_eq!(column.len(), record.time.len());
                        prop_assert!(column.iter().all(|x| x.is_finite()));
                    }
                }
            }
        }
    }
}
