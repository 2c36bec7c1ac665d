use super::*;

type Signal = Box<dyn Fn(f64) -> f64>;

/// `n` samples every `dt` of a function of time.
fn sampled(n: usize, dt: f64, f: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let time: Vec<f64> = (0..n).map(|i| i as f64 * dt).collect();
    let values = time.iter().map(|t| f(*t)).collect();
    (time, values)
}

/// A stick-slip velocity: stuck at the road speed 0.3 m/s for most of the period, then snapping back.
fn stick_and_snap(t: f64, f: f64) -> f64 {
    let phase = (t * f).fract();
    if phase < 0.8 {
        0.3
    } else {
        -1.2 * 0.5 * (1.0 - ((phase - 0.8) / 0.2 * std::f64::consts::TAU).cos()) * 2.0 + 0.3
    }
}

/// A sawtooth that falls within an eighth of its period: a sudden fall is above any sampling rate.
fn sawtooth(t: f64, f: f64) -> f64 {
    let phase = (t * f).fract();
    (phase / 0.875).min((1.0 - phase) / 0.125)
}

#[test]
fn a_sine_a_sawtooth_and_a_snap_of_known_period_are_met_to_a_thousandth() {
    let known = 1783.7;
    for dt in [40e-6, 20e-6, 5e-6] {
        let n = (0.02 / dt) as usize;
        let signals: [(&str, Signal); 3] = [
            ("sine", Box::new(move |t| (std::f64::consts::TAU * known * t).sin())),
            ("sawtooth", Box::new(move |t| sawtooth(t, known))),
            ("snap", Box::new(move |t| stick_and_snap(t, known))),
        ];
        for (name, signal) in signals {
            let (time, values) = sampled(n, dt, signal);
            let found = frequency(&time, &values).unwrap().frequency;
            let error = (found / known - 1.0).abs();
            assert!(error < 1e-3, "{name} at {dt}: {found} Hz, off by {error}");
        }
    }
}

#[test]
fn alternating_cycles_are_still_one_cycle_each() {
    // Every other snap 10 % weaker: the ear and the paper call this the snap rate.
    let f = 1000.0;
    let (time, values) = sampled(4000, 5e-6, |t| {
        let weaker = if ((t * f) as usize).is_multiple_of(2) { 1.0 } else { 0.9 };
        weaker * stick_and_snap(t, f)
    });
    let found = frequency(&time, &values).unwrap().frequency;
    assert!((found / f - 1.0).abs() < 1e-3, "{found}");
}

/// A trace of one signal and a friction coefficient; what is not asked about is one of them, too.
fn of_one<'a>(time: &'a [f64], signal: &'a [f64], friction: &'a [f64]) -> Trace<'a> {
    Trace { time, displacement: signal, velocity: signal, friction, stick: friction }
}

#[test]
fn a_steady_slide_is_silent_and_keeps_its_mean_friction() {
    let (time, velocity) = sampled(1200, 20e-6, |t| 0.5 * (-t / 1e-3).exp());
    let friction = vec![0.8; time.len()];
    let found = stick_slip(&of_one(&time, &velocity, &friction), 0.3);
    assert_eq!(found.frequency, 0.0);
    assert!((found.mean_friction - 0.8).abs() < 1e-12);
}

#[test]
fn means_are_taken_over_whole_periods() {
    // Closed form: the mean of 0.7 + 0.2 sin over whole periods is 0.7.
    let f = 517.0;
    let (time, velocity) = sampled(2000, 10e-6, |t| (std::f64::consts::TAU * f * t).sin());
    let friction: Vec<f64> = velocity.iter().map(|v| 0.7 + 0.2 * v).collect();
    let found = stick_slip(&of_one(&time, &velocity, &friction), 0.3);
    assert!((found.mean_friction - 0.7).abs() < 1e-3, "{}", found.mean_friction);
    assert!((found.displacement_amplitude - 2.0).abs() < 1e-3);
}

#[test]
fn a_growing_vibration_counts_from_where_it_is_grown() {
    let (_, velocity) =
        sampled(2400, 10e-6, |t| (t / 8e-3).min(1.0) * (std::f64::consts::TAU * 1500.0 * t).sin());
    let from = settled_from(&velocity);
    assert!((600..=1000).contains(&from), "settled from sample {from}");
}

/// A column of a file of the independent solutions.
fn column(file: &str, name: &str) -> Vec<f64> {
    let path = format!("{}/tests/data/verification/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let at = text.lines().next().unwrap().split(',').position(|c| c == name).unwrap();
    text.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

#[test]
fn the_independent_solutions_have_the_frequencies_that_counting_snaps_gives() {
    // Origin of the expected values: snaps of the edge counted in the settled part of each file, see
    // `snap_rate`; 1 % because single periods differ by more than that.
    for file in ["slide-1.csv", "slide-2.csv", "slide-3.csv", "slide-4.csv"] {
        let (time, velocity) = (column(file, "t"), column(file, "edge_in_vx"));
        let from = settled_from(&velocity);
        let found = frequency(&time[from..], &velocity[from..]).unwrap();
        let counted = snap_rate(&time[from..], &column(file, "edge_in_x")[from..]);
        let error = (found.frequency / counted - 1.0).abs();
        assert!(error < 0.01, "{file}: {} Hz, counted {counted} Hz", found.frequency);
    }
}

/// Rate of downward crossings of the displacement through its mean, the first to the last one.
fn snap_rate(time: &[f64], displacement: &[f64]) -> f64 {
    let mean = displacement.iter().sum::<f64>() / displacement.len() as f64;
    let crossings: Vec<f64> = (1..time.len())
        .filter(|&i| displacement[i - 1] > mean && displacement[i] <= mean)
        .map(|i| {
            let (before, after) = (displacement[i - 1], displacement[i]);
            time[i - 1] + (time[i] - time[i - 1]) * (before - mean) / (before - after)
        })
        .collect();
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0])
}
