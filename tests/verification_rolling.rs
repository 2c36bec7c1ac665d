//! Rolling against the independent solutions of tests/data/verification.
//!
//! Traces within 3 % of their range up to the first slip of the whole face, then frequency within 1 %
//! and amplitude within 3 % as for sliding.

use tread_block::params::NormalDrive;
use tread_block::scenario::{self, belt_csv, Roll, Scenario};
use tread_block::{Params, TreadBlock};

/// A case: height [m], end of the first stick [s], stick-slip window [s], direction of the slips.
struct Case {
    name: &'static str,
    height: f64,
    first_slip: f64,
    window: (f64, f64),
    sign: f64,
}

const CASES: [Case; 2] = [
    Case {
        name: "roll-1",
        height: 0.010,
        first_slip: 6.1e-3,
        window: (6.5e-3, 11.8e-3),
        sign: -1.0,
    },
    Case {
        name: "roll-2",
        height: 0.008,
        first_slip: 4.4e-3,
        window: (8.5e-3, 21.2e-3),
        sign: 1.0,
    },
];

/// Time, tangential and normal force of the road, displacement of the run-in edge.
type Row = [f64; 4];

fn data(file: &str) -> String {
    format!("{}/tests/data/verification/{file}", env!("CARGO_MANIFEST_DIR"))
}

fn reference(case: &Case) -> Vec<Row> {
    let text = std::fs::read_to_string(data(&format!("{}.csv", case.name))).unwrap();
    let numbers = |line: &str| line.split(',').map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    text.lines().skip(1).map(numbers).map(|r| [r[0], r[4], r[5], r[6]]).collect()
}

fn model(case: &Case) -> Vec<Row> {
    let mut params = Params::default();
    params.block.height = case.height;
    params.wear.coefficient = 0.0;
    params.drive.normal = NormalDrive::Trajectory;
    let samples = belt_csv::read(data(&format!("{}-belt.csv", case.name)).as_ref()).unwrap();
    let roll = Roll::through(&samples).unwrap();
    let (start, end) = roll.span();
    let mut rows = Vec::new();
    let mut block = TreadBlock::new(&params).unwrap();
    scenario::simulate(&mut block, &Scenario::Roll(roll), 20e-6, end - start, |t, o| {
        rows.push([t, o.contact_force[0], o.contact_force[1], o.run_in_displacement[0]]);
    })
    .unwrap();
    rows
}

/// Frequency of the crossings of the mean in the slip direction [Hz], and peak-to-peak [m].
fn stick_slip(rows: &[Row], case: &Case) -> (f64, f64) {
    let inside: Vec<&Row> =
        rows.iter().filter(|r| r[0] > case.window.0 && r[0] < case.window.1).collect();
    let mean = inside.iter().map(|r| r[3]).sum::<f64>() / inside.len() as f64;
    let mut crossings = Vec::new();
    for pair in inside.windows(2) {
        let (a, b) = (case.sign * (pair[0][3] - mean), case.sign * (pair[1][3] - mean));
        if a < 0.0 && b >= 0.0 {
            crossings.push(pair[0][0] + a / (a - b) * (pair[1][0] - pair[0][0]));
        }
    }
    let last = crossings.len() - 1;
    let high = inside.iter().map(|r| r[3]).fold(f64::MIN, f64::max);
    let low = inside.iter().map(|r| r[3]).fold(f64::MAX, f64::min);
    (last as f64 / (crossings[last] - crossings[0]), high - low)
}

#[test]
fn rolling_is_the_independent_solution_within_the_tolerances_of_the_project() {
    for case in &CASES {
        let (expected, found) = (reference(case), model(case));
        for (column, name) in [(1, "Fx"), (2, "Fz"), (3, "run-in edge")] {
            let values = || expected.iter().map(|r| r[column]);
            let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
            let worst = expected
                .iter()
                .zip(&found)
                .filter(|(r, _)| r[0] < case.first_slip)
                .map(|(r, f)| (r[column] - f[column]).abs() / range)
                .fold(0.0, f64::max);
            println!(
                "{} {name} up to the first slip: {:.2} % of the range",
                case.name,
                100.0 * worst
            );
            assert!(worst < 0.03, "{} {name}: {worst}", case.name);
        }
        let ((f_expected, a_expected), (f, a)) =
            (stick_slip(&expected, case), stick_slip(&found, case));
        let (f_error, a_error) = (f / f_expected - 1.0, a / a_expected - 1.0);
        println!(
            "{}: frequency {:+.2} %, amplitude {:+.2} %",
            case.name,
            100.0 * f_error,
            100.0 * a_error
        );
        assert!(f_error.abs() < 0.01, "{}: {f} Hz for {f_expected}", case.name);
        assert!(a_error.abs() < 0.03, "{}: {a} m for {a_expected}", case.name);
    }
}
