//! Figures 4 to 7: vibrations of a sliding block and what changes them.

use rayon::prelude::*;

use super::identify::objective::Fineness;
use super::paper::PRESSURE;
use super::plot::{svg, Panel, Series};
use super::report::{change, csv, Study, Verdict};
use super::slides::Reductions;
use crate::block::TreadBlock;
use crate::error::Fault;
use crate::metrics::{stick_slip, Recorder, StickSlip};
use crate::params::Params;
use crate::scenario::{self, Inputs, Plan, Scenario, Slide};

/// Height and length [m] of the base case: the only column of Table 1 with 2550 Hz at 300 mm/s.
pub const BASE: (f64, f64) = (0.010, 0.045);
/// Speed of the base case [m/s].
pub const SPEED: f64 = 0.300;
/// Length of the runs [s].
const DURATION: f64 = 20e-3;
/// Distance of rows [s].
const STEP: f64 = 2e-5;

/// A run of the block with its label.
#[derive(Clone, Debug)]
pub struct Run {
    /// Label in the legend.
    pub label: String,
    /// What was changed, SI.
    pub value: f64,
    /// Parameters.
    pub params: Params,
    /// Road speed [m/s].
    pub speed: f64,
    /// Mean pressure [Pa].
    pub pressure: f64,
}

/// Traces of the edges and what they amount to.
#[derive(Clone, Debug, Default)]
pub struct Traces {
    /// Time [s].
    pub time: Vec<f64>,
    /// Run-in edge: displacement [m], velocity [m/s].
    pub run_in: Vec<[f64; 2]>,
    /// Run-out edge.
    pub run_out: Vec<[f64; 2]>,
    /// Share of the contact that sticks.
    pub stick: Vec<f64>,
}

/// A run with its result.
pub type Result_ = Result<(Run, Traces, StickSlip), Fault>;

/// The base case on `compound`.
pub fn base(compound: &Params, fineness: &Fineness) -> Run {
    let mut params = compound.clone();
    (params.block.height, params.block.length) = BASE;
    params.wear.coefficient = 0.0;
    fineness.apply(&mut params);
    Run { label: String::new(), value: 0.0, params, speed: SPEED, pressure: PRESSURE }
}

/// Runs all, in parallel.
pub fn run_all(runs: Vec<Run>) -> Result<Vec<(Run, Traces, StickSlip)>, Fault> {
    let reductions = Reductions::default();
    runs.into_par_iter().map(|run| simulate(run, &reductions)).collect()
}

fn simulate(run: Run, reductions: &Reductions) -> Result_ {
    let load = run.pressure * run.params.block.length * run.params.block.width;
    let scenario = Scenario::Slide(Slide::constant(run.speed, load));
    let mut block = TreadBlock::with_reduction(&run.params, reductions.of(&run.params)?)?;
    let (mut traces, mut recorder) = (Traces::default(), Recorder::default());
    let plan = Plan { step: STEP, duration: DURATION, inputs: Inputs::Exact };
    scenario::run(&mut block, &scenario, &plan, |time, block| {
        let o = block.outputs();
        recorder.push(time, o);
        traces.time.push(time);
        traces.run_in.push([o.run_in_displacement[0], o.run_in_velocity[0]]);
        traces.run_out.push([o.run_out_displacement[0], o.run_out_velocity[0]]);
        traces.stick.push(o.stick_fraction);
        Ok(())
    })?;
    let metrics = stick_slip(&recorder.trace(), run.speed);
    Ok((run, traces, metrics))
}

/// One study of figures 5 to 7: runs that differ in one thing.
struct Variation {
    name: &'static str,
    header: &'static str,
    title: String,
    runs: Vec<(Run, Traces, StickSlip)>,
}

impl Variation {
    /// Peak-to-peak displacement of each run [m]; 0 where silent.
    fn amplitudes(&self) -> Vec<f64> {
        let of = |m: &StickSlip| if m.frequency > 0.0 { m.displacement_amplitude } else { 0.0 };
        self.runs.iter().map(|r| of(&r.2)).collect()
    }

    fn frequencies(&self) -> Vec<f64> {
        self.runs.iter().map(|r| r.2.frequency).collect()
    }

    fn summary(&self) -> (String, String) {
        let rows = self.runs.iter().map(|(run, _, m)| {
            vec![run.value, m.frequency, m.displacement_amplitude, m.velocity_amplitude, m.stick_fraction]
        });
        let header = format!(
            "{},model_hz,displacement_peak_to_peak_m,velocity_peak_to_peak_m_s,stick_fraction",
            self.header
        );
        (format!("{}.csv", self.name), csv(&header, rows))
    }

    fn traces(&self) -> (String, String) {
        let rows = self.runs.iter().flat_map(|(run, t, _)| {
            let value = run.value;
            (0..t.time.len()).map(move |i| {
                vec![value, t.time[i], t.run_in[i][0], t.run_in[i][1], t.run_out[i][0], t.run_out[i][1]]
            })
        });
        let header = format!("{},time_s,run_in_x_m,run_in_v_m_s,run_out_x_m,run_out_v_m_s", self.header);
        (format!("{}-traces.csv", self.name), csv(&header, rows.collect::<Vec<_>>()))
    }

    /// Displacement over the last 3 ms.
    fn displacements(&self) -> Panel {
        let series = self.runs.iter().enumerate().map(|(i, (run, t, _))| {
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

    fn limit_cycles(&self) -> Panel {
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

/// Figure 4.
///
/// # Errors
/// What stops the block.
pub fn fig_4(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let (edge, found) = edge_cycles(&base(compound, fineness))?;
    let mut run = base(compound, fineness);
    run.label = "run-in edge".to_string();
    let all = run_all(vec![run])?;
    let (_, traces, metrics) = &all[0];
    let window = |pick: fn(&Traces) -> &Vec<[f64; 2]>| -> Vec<(f64, f64)> {
        let t = traces;
        t.time
            .iter()
            .zip(pick(t))
            .filter(|(time, _)| **time > DURATION - 3e-3)
            .map(|(time, x)| (1e3 * time, 1e6 * x[0]))
            .collect()
    };
    let edges = Panel::new(
        "h 10 mm, l 45 mm, 0.25 N/mm2, 300 mm/s",
        ["time [ms]", "displacement [um]"],
        vec![
            Series::line("run-in edge", 0, window(|t| &t.run_in)),
            Series::line("run-out edge", 1, window(|t| &t.run_out)),
        ],
    );
    let axes = ["displacement [um]", "velocity [mm/s]"];
    let cycles = edge.iter().enumerate().map(|(i, (height, points))| {
        let points = points.iter().map(|[x, v]| (1e6 * x, 1e3 * v)).collect();
        Series::line(format!("{:.1} mm above the road", 1e3 * height), i, points)
    });
    let cycles = Panel::new("limit cycles up the run-in edge", axes, cycles.collect());
    let spans: Vec<f64> = found;
    let falling = spans.windows(2).all(|w| w[0] > w[1]);
    let rows = (0..traces.time.len()).map(|i| {
        let (a, b) = (traces.run_in[i], traces.run_out[i]);
        vec![traces.time[i], a[0], a[1], b[0], b[1], traces.stick[i]]
    });
    let header = "time_s,run_in_x_m,run_in_v_m_s,run_out_x_m,run_out_v_m_s,stick_fraction";
    Ok(Study {
        name: "fig-4",
        title: "Displacement of the edges and limit cycles up the run-in edge",
        notes: "Base case taken as h = 10 mm, l = 45 mm: the only geometry whose frequency at 300 mm/s \
                in Table 1 is near 2550 Hz."
            .to_string(),
        tables: vec![("fig-4-edges.csv".to_string(), csv(header, rows))],
        pictures: vec![("fig-4.svg".to_string(), svg(&[edges, cycles], 2)?)],
        verdicts: vec![
            Verdict::new(
                "the block vibrates with 2550 Hz (within 10 %)",
                (metrics.frequency / 2550.0 - 1.0).abs() <= 0.10,
                format!("{:.0} Hz", metrics.frequency),
            ),
            Verdict::new(
                "the largest oscillations are closest to the contact",
                falling && spans.len() > 2,
                format!(
                    "{:.0} um at the road, {:.0} um half way up",
                    1e6 * spans.first().unwrap_or(&0.0),
                    1e6 * spans.get(spans.len() / 2).unwrap_or(&0.0)
                ),
            ),
        ],
    })
}

/// Settled motion (displacement [m], velocity [m/s]) of a node.
type Cycle = Vec<[f64; 2]>;

/// Limit cycles of the nodes up the run-in edge, with their heights [m], and their swings [m].
fn edge_cycles(run: &Run) -> Result<(Vec<(f64, Cycle)>, Vec<f64>), Fault> {
    const FINE_STEP: f64 = 5e-6;
    let load = run.pressure * run.params.block.length * run.params.block.width;
    let scenario = Scenario::Slide(Slide::constant(run.speed, load));
    let mut block = TreadBlock::with_reduction(&run.params, Reductions::default().of(&run.params)?)?;
    let nodes = run_in_nodes(&block);
    let mut motion: Vec<Vec<f64>> = vec![Vec::new(); nodes.len()];
    let plan = Plan { step: FINE_STEP, duration: DURATION, inputs: Inputs::Exact };
    scenario::run(&mut block, &scenario, &plan, |time, block| {
        if time > DURATION - 2e-3 {
            let field = block.field();
            for (trace, (node, _)) in motion.iter_mut().zip(&nodes) {
                trace.push(field[*node][0]);
            }
        }
        Ok(())
    })?;
    let cycle = |x: &Vec<f64>| -> Cycle {
        x.windows(3).map(|w| [w[1], (w[2] - w[0]) / (2.0 * FINE_STEP)]).collect()
    };
    let spans = motion.iter().map(|x| crate::metrics::peak_to_peak(x)).collect();
    let cycles = nodes.iter().zip(&motion).map(|((_, height), x)| (*height, cycle(x))).collect();
    Ok((cycles, spans))
}

/// Corner nodes of the elements along the run-in edge from the road upward, without the clamped one,
/// with their heights above the tread face [m].
fn run_in_nodes(block: &TreadBlock) -> Vec<(usize, f64)> {
    let mesh = &block.reduction().mesh;
    let left = mesh.x[0];
    let mut found: Vec<(usize, f64)> = (0..block.field().len())
        .map(|node| (node, mesh.position(node)))
        .filter(|(_, p)| (p[0] - left).abs() < 1e-9)
        .map(|(node, p)| (node, p[1]))
        .collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    let lowest = found.first().map_or(0.0, |f| f.1);
    let count = found.len();
    found.into_iter().take(count.saturating_sub(1)).step_by(2).map(|(n, z)| (n, z - lowest)).collect()
}

/// Figure 5: Young's modulus and damping.
///
/// # Errors
/// What stops the block.
pub fn fig_5(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let base = base(compound, fineness);
    let moduli = [15e6, 30e6, 45e6, 60e6, 75e6].map(|e: f64| {
        let mut run = base.clone();
        run.params.rubber.young_modulus = e;
        Run { label: format!("E = {:.0} N/mm2", 1e-6 * e), value: e, ..run }
    });
    let damping = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0].map(|factor: f64| {
        let mut run = base.clone();
        run.params.rubber.stiffness_damping *= factor;
        let beta = run.params.rubber.stiffness_damping;
        Run { label: format!("beta = {:.0} us", 1e6 * beta), value: beta, ..run }
    });
    let modulus = Variation {
        name: "fig-5-modulus",
        header: "young_modulus_pa",
        title: "Young's modulus".to_string(),
        runs: run_all(moduli.to_vec())?,
    };
    let damping = Variation {
        name: "fig-5-damping",
        header: "stiffness_damping_s",
        title: "Damping factor".to_string(),
        runs: run_all(damping.to_vec())?,
    };
    let mut verdicts = trend(&modulus, "E", [false, true]);
    verdicts.extend(trend(&damping, "beta", [false, true]));
    let silent = damping.frequencies().last().is_some_and(|hz| *hz == 0.0);
    let first = damping.runs.iter().find(|r| r.2.frequency == 0.0).map(|r| r.0.value);
    verdicts.push(Verdict::new(
        "for large damping the oscillation vanishes",
        silent,
        first.map_or("never up to 3 beta".to_string(), |b| format!("from {:.0} us on", 1e6 * b)),
    ));
    Ok(Study {
        name: "fig-5",
        title: "Young's modulus and material damping",
        notes: "The values of beta are lost in the paper; ours run from half to three times the \
                identified one."
            .to_string(),
        tables: vec![modulus.summary(), damping.summary(), modulus.traces(), damping.traces()],
        pictures: vec![(
            "fig-5.svg".to_string(),
            svg(&[modulus.displacements(), damping.displacements()], 2)?,
        )],
        verdicts,
    })
}

/// Verdicts on how amplitude and frequency go with a quantity, over the runs that oscillate; `rises`:
/// amplitude, frequency.
fn trend(variation: &Variation, quantity: &str, rises: [bool; 2]) -> Vec<Verdict> {
    let loud: Vec<&(Run, Traces, StickSlip)> =
        variation.runs.iter().filter(|r| r.2.frequency > 0.0).collect();
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
            Verdict::new(format!("{what} {word} with {quantity}"), steps && values.len() > 1, number)
        })
        .collect()
}

/// Figure 6: sliding speed.
///
/// # Errors
/// What stops the block.
pub fn fig_6(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let runs = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5].map(|speed: f64| Run {
        label: format!("{:.0} mm/s", 1e3 * speed),
        value: speed,
        speed,
        ..base(compound, fineness)
    });
    let speeds = Variation {
        name: "fig-6",
        header: "speed_m_s",
        title: "Sliding speed".to_string(),
        runs: run_all(runs.to_vec())?,
    };
    let hz = speeds.frequencies();
    let stick: Vec<f64> = speeds.runs.iter().map(|r| most_stuck(&r.1, &r.2)).collect();
    let told = |i: usize| match hz[i] {
        hz if hz > 0.0 => format!("{hz:.0} Hz"),
        _ => "silent".to_string(),
    };
    let verdicts = vec![
        Verdict::new("no oscillation at 50 mm/s", hz[0] == 0.0, told(0)),
        Verdict::new(
            "oscillation from 100 to 400 mm/s",
            hz[1..5].iter().all(|f| *f > 0.0),
            format!("{:.0} to {:.0} Hz", hz[1], hz[4]),
        ),
        Verdict::new("no oscillation at 500 mm/s", hz[5] == 0.0, told(5)),
        Verdict::new(
            "a sticking phase at 100, 200 and 300 mm/s",
            stick[1..4].iter().all(|s| *s > 0.5),
            format!("up to {:.0}, {:.0}, {:.0} % stuck", 1e2 * stick[1], 1e2 * stick[2], 1e2 * stick[3]),
        ),
        Verdict::new(
            "no prominent sticking phase at 400 mm/s",
            stick[4] < 0.5,
            format!("up to {:.0} % stuck", 1e2 * stick[4]),
        ),
    ];
    Ok(Study {
        name: "fig-6",
        title: "Sliding speed",
        notes: "A sticking phase: more than half of the contact below the smoothing speed at some time \
                of the settled part."
            .to_string(),
        tables: vec![speeds.summary(), speeds.traces()],
        pictures: vec![(
            "fig-6.svg".to_string(),
            svg(&[speeds.displacements(), speeds.limit_cycles()], 2)?,
        )],
        verdicts,
    })
}

/// Largest share of the contact that sticks at one time of the settled part.
fn most_stuck(traces: &Traces, metrics: &StickSlip) -> f64 {
    traces
        .time
        .iter()
        .zip(&traces.stick)
        .filter(|(t, _)| **t >= metrics.settled_from)
        .map(|(_, s)| *s)
        .fold(0.0, f64::max)
}

/// Figure 7: pressure and geometry.
///
/// # Errors
/// What stops the block.
pub fn fig_7(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let pressures = [0.08e6, 0.16e6, 0.25e6, 0.40e6, 0.63e6].map(|pressure: f64| Run {
        label: format!("{:.2} N/mm2", 1e-6 * pressure),
        value: pressure,
        pressure,
        ..base(compound, fineness)
    });
    let geometries = [(10, 15), (6, 15), (10, 45), (6, 45)].map(|(h, l): (u32, u32)| {
        let mut run = base(compound, fineness);
        run.params.block.height = 1e-3 * f64::from(h);
        run.params.block.length = 1e-3 * f64::from(l);
        fineness.apply(&mut run.params);
        Run { label: format!("h {h} mm, l {l} mm"), value: 1e-3 * f64::from(h), ..run }
    });
    let pressure = Variation {
        name: "fig-7-pressure",
        header: "pressure_pa",
        title: "Mean pressure".to_string(),
        runs: run_all(pressures.to_vec())?,
    };
    let geometry = Variation {
        name: "fig-7-geometry",
        header: "height_m",
        title: "Block geometry".to_string(),
        runs: run_all(geometries.to_vec())?,
    };
    let mut verdicts = trend(&pressure, "pressure", [true, false]);
    verdicts.truncate(1);
    let low = pressure.frequencies()[0];
    verdicts.push(Verdict::new(
        "the oscillation vanishes at small pressure (0.08 N/mm2)",
        low == 0.0,
        if low == 0.0 { "silent".to_string() } else { format!("{low:.0} Hz") },
    ));
    let (x, f) = (geometry.amplitudes(), geometry.frequencies());
    verdicts.push(Verdict::new(
        "amplitude rises with height",
        x[0] > x[1] && x[2] > x[3],
        format!("{} (l 15), {} (l 45) from 6 to 10 mm", change(x[1], x[0]), change(x[3], x[2])),
    ));
    verdicts.push(Verdict::new(
        "amplitude falls with length",
        x[0] > x[2] && x[1] > x[3],
        format!("{} (h 10), {} (h 6) from 15 to 45 mm", change(x[0], x[2]), change(x[1], x[3])),
    ));
    let mut order: Vec<usize> = (0..4).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    verdicts.push(Verdict::new(
        "the frequency falls where the amplitude rises",
        order.windows(2).all(|w| f[w[0]] > f[w[1]]),
        order.iter().map(|i| format!("{:.0} um {:.0} Hz", 1e6 * x[*i], f[*i])).collect::<Vec<_>>().join(", "),
    ));
    Ok(Study {
        name: "fig-7",
        title: "Mean pressure and block geometry",
        notes: String::new(),
        tables: vec![pressure.summary(), geometry.summary(), pressure.traces()],
        pictures: vec![(
            "fig-7.svg".to_string(),
            svg(&[pressure.displacements(), geometry.displacements()], 2)?,
        )],
        verdicts,
    })
}
