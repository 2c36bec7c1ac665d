//! Sliding runs that differ in one thing, their traces and their pictures.

use rayon::prelude::*;

use super::identify::objective::Fineness;
use super::paper::PRESSURE;
use super::plot::{Panel, Series};
use super::report::{change, csv, Verdict};
use super::slides::{slide, sticking, Point};
use super::start::Start;
use super::watch::{self, SILENCE};
use crate::block::Reductions;
use crate::error::Fault;
use crate::metrics::{stick_slip, Recorder, StickSlip};
use crate::params::Params;

/// Height and length \[m\] of the base case: the only column of Table 1 with 2550 Hz at 300 mm/s.
pub const BASE: (f64, f64) = (0.010, 0.045);
/// Speed of the base case \[m/s\].
pub const SPEED: f64 = 0.300;
/// Length of the runs at their speed \[s\].
pub const DURATION: f64 = 20e-3;
/// Distance of rows \[s\].
const STEP: f64 = 2e-5;

/// A station sticks while it slides slower than this share of the road speed.
pub const STUCK: f64 = 0.15;

/// Displacement over the block's height from which on a run is beyond the theory, as where a soft block sticks for
/// good and is dragged along; it is named and not drawn.
const BEYOND: f64 = 0.1;

/// A run of the block with its label.
#[derive(Clone, Debug)]
pub struct Run {
    /// Label in the legend.
    pub label: String,
    /// What was changed, SI.
    pub value: f64,
    /// Parameters.
    pub params: Params,
    /// Road speed \[m/s\].
    pub speed: f64,
    /// Mean pressure \[Pa\].
    pub pressure: f64,
}

impl Run {
    /// What slides, with rows every `step` \[s\].
    pub fn point(&self, step: f64) -> Point {
        let (speed, pressure) = (self.speed, self.pressure);
        Point { speed, pressure, start: Start::Braking, duration: DURATION, step }
    }
}

/// Traces of the edges and what they amount to.
#[derive(Clone, Debug, Default)]
pub struct Traces {
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Run-in edge: displacement \[m\], velocity \[m/s\].
    pub run_in: Vec<[f64; 2]>,
    /// Run-out edge.
    pub run_out: Vec<[f64; 2]>,
    /// Share of the contact that sticks.
    pub stick: Vec<f64>,
}

/// A run with its traces and what they amount to.
pub type Ran = (Run, Traces, StickSlip);

/// The base case on `compound`.
pub fn base(compound: &Params, fineness: &Fineness) -> Run {
    let mut params = compound.clone();
    (params.block.height, params.block.length) = BASE;
    params.wear.coefficient = 0.0;
    fineness.apply(&mut params);
    Run { label: String::new(), value: 0.0, params, speed: SPEED, pressure: PRESSURE }
}

/// Runs all, in parallel.
pub fn run_all(runs: Vec<Run>) -> Result<Vec<Ran>, Fault> {
    let reductions = Reductions::default();
    runs.into_par_iter().map(|run| simulate(run, &reductions)).collect()
}

fn simulate(run: Run, reductions: &Reductions) -> Result<Ran, Fault> {
    let (mut traces, mut recorder) = (Traces::default(), Recorder::default());
    slide(&run.params, reductions, run.point(STEP), |time, block| {
        let o = block.outputs();
        recorder.push(time, o);
        traces.time.push(time);
        traces.run_in.push([o.run_in_displacement[0], o.run_in_velocity[0]]);
        traces.run_out.push([o.run_out_displacement[0], o.run_out_velocity[0]]);
        traces.stick.push(sticking(o, STUCK * run.speed));
        Ok(())
    })?;
    let trace = recorder.trace();
    let mut metrics = stick_slip(&trace, run.speed);
    if metrics.velocity_amplitude > SILENCE * run.speed {
        let first = trace.time.partition_point(|t| *t < metrics.settled_from);
        metrics.frequency = watch::stick_slip(&trace.time[first..], &trace.velocity[first..]);
    }
    Ok((run, traces, metrics))
}

/// Does the block leave small strain?
fn beyond(run: &Run, traces: &Traces) -> bool {
    traces.run_in.iter().any(|x| x[0].abs() > BEYOND * run.params.block.height)
}

/// One study of figures 5 to 7: runs that differ in one thing.
pub struct Variation {
    /// Name of the study's files.
    pub name: &'static str,
    /// Column of what was changed.
    pub header: &'static str,
    /// Title of the picture.
    pub title: String,
    /// The runs.
    pub runs: Vec<Ran>,
}

impl Variation {
    /// Peak-to-peak displacement of each run \[m\]; 0 where silent.
    pub fn amplitudes(&self) -> Vec<f64> {
        let of = |m: &StickSlip| if m.frequency > 0.0 { m.displacement_amplitude } else { 0.0 };
        self.runs.iter().map(|r| of(&r.2)).collect()
    }

    /// Frequency of each run \[Hz\]; 0 where silent.
    pub fn frequencies(&self) -> Vec<f64> {
        self.runs.iter().map(|r| r.2.frequency).collect()
    }

    /// One row per run: file name and CSV.
    pub fn summary(&self) -> (String, String) {
        let rows = self.runs.iter().map(|(run, _, m)| {
            vec![
                run.value,
                m.frequency,
                m.displacement_amplitude,
                m.velocity_amplitude,
                m.stick_fraction,
            ]
        });
        let header = format!(
            "{},model_hz,displacement_peak_to_peak_m,velocity_peak_to_peak_m_s,stick_fraction",
            self.header
        );
        (format!("{}.csv", self.name), csv(&header, rows))
    }

    /// All traces: file name and CSV.
    pub fn traces(&self) -> (String, String) {
        let rows = self.runs.iter().flat_map(|(run, t, _)| {
            let value = run.value;
            (0..t.time.len()).map(move |i| {
                vec![
                    value,
                    t.time[i],
                    t.run_in[i][0],
                    t.run_in[i][1],
                    t.run_out[i][0],
                    t.run_out[i][1],
                ]
            })
        });
        let header =
            format!("{},time_s,run_in_x_m,run_in_v_m_s,run_out_x_m,run_out_v_m_s", self.header);
        (format!("{}-traces.csv", self.name), csv(&header, rows.collect::<Vec<_>>()))
    }

    /// The runs that leave small strain, as a sentence; nothing where none does.
    pub fn beyond_small_strain(&self) -> String {
        let labels: Vec<&str> =
            self.runs.iter().filter(|r| beyond(&r.0, &r.1)).map(|r| r.0.label.as_str()).collect();
        if labels.is_empty() {
            return String::new();
        }
        format!(
            "Not drawn, because the block sticks for good there and leaves small strain: {}. ",
            labels.join(", ")
        )
    }

    /// Displacement over the last 3 ms.
    pub fn displacements(&self) -> Panel {
        let series = self.runs.iter().enumerate().map(|(i, (run, t, _))| {
            if beyond(run, t) {
                let label = format!("{}: beyond small strain", run.label);
                return Series::line(label, i, Vec::new());
            }
            let points = t
                .time
                .iter()
                .zip(&t.run_in)
                .filter(|(time, _)| **time >= DURATION - 3e-3)
                .map(|(time, x)| (1e3 * time, 1e6 * x[0]))
                .collect();
            Series::line(run.label.clone(), i, points)
        });
        let axes = ["time [ms]", "displacement of the run-in edge [um]"];
        Panel::new(self.title.clone(), axes, series.collect())
    }

    /// Limit cycles of the run-in edge.
    pub fn limit_cycles(&self) -> Panel {
        let series = self.runs.iter().enumerate().map(|(i, (run, t, m))| {
            let points = t
                .time
                .iter()
                .zip(&t.run_in)
                .filter(|(time, _)| **time >= m.settled_from.max(DURATION - 8e-3))
                .map(|(_, x)| (1e6 * x[0], 1e3 * x[1]))
                .collect();
            Series::line(run.label.clone(), i, points)
        });
        let axes = ["displacement [um]", "velocity relative to the clamped face [mm/s]"];
        Panel::new("limit cycle of the run-in edge", axes, series.collect())
    }
}

/// Verdicts on how amplitude and frequency go with a quantity, over the runs that oscillate; `rises`:
/// amplitude, frequency.
pub fn trend(runs: &[Ran], quantity: &str, rises: [bool; 2]) -> Vec<Verdict> {
    let loud: Vec<&Ran> = runs.iter().filter(|r| r.2.frequency > 0.0).collect();
    let values = [
        ("amplitude", loud.iter().map(|r| r.2.displacement_amplitude).collect::<Vec<_>>()),
        ("frequency", loud.iter().map(|r| r.2.frequency).collect()),
    ];
    values
        .into_iter()
        .zip(rises)
        .map(|((what, values), rises)| {
            let word = if rises { "rises" } else { "falls" };
            let steps = values.windows(2).all(|w| (w[1] > w[0]) == rises);
            let number = match (values.first(), values.last()) {
                (Some(a), Some(b)) if values.len() > 1 => change(*a, *b),
                _ => "fewer than two runs oscillate".to_string(),
            };
            Verdict::new(
                format!("{what} {word} with {quantity}"),
                steps && values.len() > 1,
                number,
            )
        })
        .collect()
}
