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

/// Settled motion (displacement \[m\], velocity \[m/s\]) of a node.
type Cycle = Vec<[f64; 2]>;

/// Limit cycles of the nodes up the run-in edge, with their heights \[m\], and their swings \[m\].
fn edge_cycles(run: &Run) -> Result<(Vec<(f64, Cycle)>, Vec<f64>), Fault> {
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
    let cycle = |x: &Vec<f64>| -> Cycle {
        x.windows(3).map(|w| [w[1], (w[2] - w[0]) / (2.0 * FINE_STEP)]).collect()
    };
    let spans = motion.iter().map(|x| crate::metrics::peak_to_peak(x)).collect();
    let cycles = nodes.iter().zip(&motion).map(|((_, height), x)| (*height, cycle(x))).collect();
    Ok((cycles, spans))
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
