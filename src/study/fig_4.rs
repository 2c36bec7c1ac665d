//! Figure 4: the edges' motion, and limit cycles up the run-in edge.

use super::identify::objective::Fineness;
use super::plot::{svg, Panel, Series};
use super::report::{csv, Study, Verdict};
use super::slides::slide;
use super::variation::{base, run_all, Run, Traces, DURATION};
use crate::block::Reductions;
use crate::error::Fault;
use crate::params::Params;
use crate::reduction::Reduction;

/// Figure 4.
///
/// # Errors
/// What stops the block.
pub fn fig_4(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let run = base(compound, fineness);
    let cycles = edge_cycles(&run)?;
    let all = run_all(vec![run])?;
    let (_, traces, metrics) = &all[0];
    let panels = [edges(traces), limit_cycles(&cycles)];
    Ok(Study {
        name: "fig-4",
        title: "Displacement of the edges and limit cycles up the run-in edge",
        notes: "Base case taken as h = 10 mm, l = 45 mm: the only geometry whose frequency at 300 mm/s \
                in Table 1 is near 2550 Hz."
            .to_string(),
        tables: vec![("fig-4-edges.csv".to_string(), edges_table(traces))],
        pictures: vec![("fig-4.svg".to_string(), svg(&panels, 2)?)],
        verdicts: verdicts(metrics.frequency, &cycles),
    })
}

/// Displacement of both edges over the last 3 ms.
fn edges(traces: &Traces) -> Panel {
    let last = |edge: &[[f64; 2]]| -> Vec<(f64, f64)> {
        traces
            .time
            .iter()
            .zip(edge)
            .filter(|(time, _)| **time > DURATION - 3e-3)
            .map(|(time, x)| (1e3 * time, 1e6 * x[0]))
            .collect()
    };
    Panel::new(
        "h 10 mm, l 45 mm, 0.25 N/mm2, 300 mm/s",
        ["time [ms]", "displacement [um]"],
        vec![
            Series::line("run-in edge", 0, last(&traces.run_in)),
            Series::line("run-out edge", 1, last(&traces.run_out)),
        ],
    )
}

fn limit_cycles(cycles: &[Cycle]) -> Panel {
    let series = cycles.iter().enumerate().map(|(i, cycle)| {
        let points = cycle.points.iter().map(|[x, v]| (1e6 * x, 1e3 * v)).collect();
        Series::line(format!("{:.1} mm above the road", 1e3 * cycle.height), i, points)
    });
    let axes = ["displacement [um]", "velocity [mm/s]"];
    Panel::new("limit cycles up the run-in edge", axes, series.collect())
}

/// Motion of both edges and share of the contact that sticks, as CSV.
fn edges_table(traces: &Traces) -> String {
    let rows = (0..traces.time.len()).map(|i| {
        let (a, b) = (traces.run_in[i], traces.run_out[i]);
        vec![traces.time[i], a[0], a[1], b[0], b[1], traces.stick[i]]
    });
    csv("time_s,run_in_x_m,run_in_v_m_s,run_out_x_m,run_out_v_m_s,stick_fraction", rows)
}

fn verdicts(frequency: f64, cycles: &[Cycle]) -> Vec<Verdict> {
    let falling = cycles.windows(2).all(|w| w[0].swing > w[1].swing);
    let swing = |node: usize| cycles.get(node).map_or(0.0, |cycle| 1e6 * cycle.swing);
    vec![
        Verdict::new(
            "the block vibrates with 2550 Hz (within 10 %)",
            (frequency / 2550.0 - 1.0).abs() <= 0.10,
            format!("{frequency:.0} Hz"),
        ),
        Verdict::new(
            "the largest oscillations are closest to the contact",
            falling && cycles.len() > 2,
            format!(
                "{:.0} um at the road, {:.0} um half way up",
                swing(0),
                swing(cycles.len() / 2)
            ),
        ),
    ]
}

/// Settled motion of a node.
struct Cycle {
    /// Height above the tread face \[m\].
    height: f64,
    /// Displacement \[m\], velocity \[m/s\].
    points: Vec<[f64; 2]>,
    /// Displacement from peak to peak \[m\].
    swing: f64,
}

impl Cycle {
    /// Of displacements \[m\] every `step` \[s\].
    fn of(height: f64, x: &[f64], step: f64) -> Self {
        let points = x.windows(3).map(|w| [w[1], (w[2] - w[0]) / (2.0 * step)]).collect();
        Self { height, points, swing: crate::metrics::peak_to_peak(x) }
    }
}

/// Limit cycles of the nodes up the run-in edge from the road upward.
fn edge_cycles(run: &Run) -> Result<Vec<Cycle>, Fault> {
    /// Distance of rows \[s\].
    const FINE_STEP: f64 = 5e-6;
    let reductions = Reductions::default();
    let nodes = run_in_nodes(&*reductions.of(&run.params)?);
    let mut motion: Vec<Vec<f64>> = vec![Vec::new(); nodes.len()];
    slide(&run.params, &reductions, run.point(FINE_STEP), |time, block| {
        if time > DURATION - 2e-3 {
            let field = block.field();
            for (trace, (node, _)) in motion.iter_mut().zip(&nodes) {
                trace.push(field[*node][0]);
            }
        }
        Ok(())
    })?;
    let cycles = nodes.iter().zip(&motion);
    Ok(cycles.map(|((_, height), x)| Cycle::of(*height, x, FINE_STEP)).collect())
}

/// Corner nodes of the elements along the run-in edge from the road upward, without the clamped one,
/// with their heights above the tread face \[m\].
fn run_in_nodes(reduction: &Reduction) -> Vec<(usize, f64)> {
    let mesh = &reduction.mesh;
    let left = mesh.x[0];
    let mut found: Vec<(usize, f64)> = (0..reduction.dof.len() / 2)
        .map(|node| (node, mesh.position(node)))
        .filter(|(_, p)| (p[0] - left).abs() < 1e-9)
        .map(|(node, p)| (node, p[1]))
        .collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    let lowest = found.first().map_or(0.0, |f| f.1);
    let count = found.len();
    found
        .into_iter()
        .take(count.saturating_sub(1))
        .step_by(2)
        .map(|(n, z)| (n, z - lowest))
        .collect()
}
