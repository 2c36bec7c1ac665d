//! Figures 8 and 9: a block of a rolling tyre passes through the contact patch.

use super::identify::objective::Fineness;
use super::paper::PRESSURE;
use super::plot::{svg, Panel, Series};
use super::report::{csv, Study, Verdict};
use super::slides::sticking;
use super::variation::STUCK;
use crate::block::Reductions;
use crate::block::TreadBlock;
use crate::drive::Pose;
use crate::error::Fault;
use crate::params::{NormalDrive, Params};
use crate::scenario::{self, BeltPath, Inputs, Plan, Roll, Scenario};

/// Distance of rows \[s\].
const STEP: f64 = 2e-5;

/// One row of the passage.
struct Row {
    /// Since the block began to come in \[s\].
    time: f64,
    /// Place of the clamped face's middle from that of the patch \[m\].
    contact_x: f64,
    /// Of the run-in edge, in x and z \[m\].
    displacement: [f64; 2],
    /// Of the run-in edge, in x and z \[m/s\].
    velocity: [f64; 2],
    /// Share of the touching stations that stick \[-\].
    stick: f64,
    /// Share of the face that touches \[-\].
    area: f64,
    /// Nodes of the deformed block, see [`shape`] \[m\].
    shape: Vec<[f64; 2]>,
}

/// The passage of the block through the patch.
struct Passage {
    rows: Vec<Row>,
    /// Length of the patch \[m\].
    length: f64,
    /// Elements along the block.
    along: usize,
    /// Elements over its height.
    up: usize,
}

/// A tyre that brakes: 10 m/s with 2 % slip, so that the block slides with 200 mm/s where it slides
/// steadily, pressed by 0.25 N/mm² in the middle of the patch. The paper gives no numbers.
fn path(height: f64) -> BeltPath {
    BeltPath {
        radius: 0.3,
        contact_length: 0.12,
        speed: 10.0,
        slip: 0.02,
        height,
        blend_length: 0.03,
        lead: 0.05,
    }
}

fn passage(compound: &Params, fineness: &Fineness) -> Result<Passage, Fault> {
    let mut params = compound.clone();
    (params.block.height, params.block.length) = (0.010, 0.015);
    params.wear.coefficient = 0.0;
    fineness.apply(&mut params);
    let reductions = Reductions::default();
    let reduction = reductions.of(&params)?;
    let path = path(pressed_height(&params, &reductions)?);
    let scenario = Scenario::Roll(Roll::through(&path.samples(1e-5)?)?);
    params.drive.normal = NormalDrive::Trajectory;
    let mut block = TreadBlock::with_reduction(&params, reduction)?;
    let (along, up) = block.reduction().mesh.elements();
    let plan = Plan { step: STEP, duration: path.duration(), inputs: Inputs::Exact };
    let mut rows = Vec::new();
    scenario::run(&mut block, &scenario, &plan, |time, block| {
        let o = block.outputs();
        let pose = scenario.pose(time);
        rows.push(Row {
            time,
            contact_x: path.speed * (time - 0.5 * path.duration()),
            displacement: o.run_in_displacement,
            velocity: o.run_in_velocity,
            stick: sticking(o, STUCK * path.slip * path.speed),
            area: o.area_fraction,
            shape: shape(block, pose),
        });
        Ok(())
    })?;
    Ok(Passage { rows, length: path.contact_length, along, up })
}

/// Height of the clamped face \[m\] at which the mean pressure is the base case's.
fn pressed_height(params: &Params, reductions: &Reductions) -> Result<f64, Fault> {
    let mut params = params.clone();
    params.drive.normal = NormalDrive::Load;
    let mut block = TreadBlock::with_reduction(&params, reductions.of(&params)?)?;
    let load = PRESSURE * params.block.length * params.block.width;
    block.initialize(0.0, Pose { load, ..Pose::default() })?;
    Ok(block.outputs().carriage_z)
}

/// Nodes of the deformed block, road frame, relative to the belt's x \[m\].
fn shape(block: &TreadBlock, pose: Pose) -> Vec<[f64; 2]> {
    let mesh = &block.reduction().mesh;
    let height = block.params().block.height;
    let (sin, cos) = pose.angle.sin_cos();
    block
        .field()
        .iter()
        .enumerate()
        .map(|(node, u)| {
            let [x, z] = mesh.position(node);
            let (x, z) = (x + u[0], z - height + u[1]);
            [cos * x - sin * z, pose.z + sin * x + cos * z]
        })
        .collect()
}

impl Passage {
    /// The rows of the four phases: run-in, sticking, sliding, snap-out.
    fn phases(&self) -> [usize; 4] {
        let touching: Vec<usize> =
            (0..self.rows.len()).filter(|i| self.rows[*i].area > 0.0).collect();
        let (first, last) =
            (touching.first().copied().unwrap_or(0), touching.last().copied().unwrap_or(0));
        let full = (first..=last).find(|i| self.rows[*i].area > 0.99).unwrap_or(first);
        let stuck = (full..=last).find(|i| self.rows[*i].stick > 0.5).unwrap_or(full);
        let free = (stuck..=last).find(|i| self.rows[*i].stick <= 0.5).unwrap_or(last);
        let leaving = (free..=last).find(|i| self.rows[*i].area < 0.99).unwrap_or(last);
        [(first + full) / 2, (stuck + free) / 2, (free + leaving) / 2, (leaving + last) / 2]
    }

    /// Lines of the mesh of a deformed block.
    fn outline(&self, row: usize, color: usize, name: &str) -> Vec<Series> {
        let tall = 2 * self.up + 1;
        let at = |i: usize, j: usize| {
            let [x, z] = self.rows[row].shape[i * tall + j];
            (1e3 * x, 1e3 * z)
        };
        let (columns, lines) = (2 * self.along, 2 * self.up);
        let upright = (0..=self.along).map(|i| (0..=lines).map(|j| at(2 * i, j)).collect());
        let level = (0..=self.up).map(|j| (0..=columns).map(|i| at(i, 2 * j)).collect());
        let mut out: Vec<Series> =
            upright.chain(level).map(|points: Vec<_>| Series::line("", color, points)).collect();
        if let Some(first) = out.first_mut() {
            first.name = name.to_string();
        }
        out.push(Series::line("", 6, vec![(-12.0, 0.0), (12.0, 0.0)]));
        out
    }
}

/// Figures 8: the deformed block in the four phases.
///
/// # Errors
/// What stops the block.
pub fn fig_8(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let passage = passage(compound, fineness)?;
    let names = ["run-in", "sticking phase", "sliding phase", "snap-out"];
    let phases = passage.phases();
    let panels: Vec<Panel> = names
        .iter()
        .zip(phases)
        .enumerate()
        .map(|(i, (name, row))| {
            let title = format!("{name}, x = {:.1} mm", 1e3 * passage.rows[row].contact_x);
            let axes = ["x from the middle of the clamped face [mm]", "height [mm]"];
            let mut panel = Panel::new(title, axes, passage.outline(row, i, ""));
            panel.to_scale = true;
            panel
        })
        .collect();
    let nodes = names.iter().zip(phases).enumerate().flat_map(|(i, (_, row))| {
        let shape = &passage.rows[row].shape;
        shape.iter().map(move |[x, z]| vec![i as f64 + 1.0, *x, *z]).collect::<Vec<_>>()
    });
    let ordered = phases.windows(2).all(|w| w[0] < w[1]);
    Ok(Study {
        name: "fig-8",
        title: "A rolling tyre's block in four phases",
        notes: "10 m/s, 2 % braking slip, patch 120 mm, belt radius 0.3 m, 0.25 N/mm2 in the middle; the \
                paper names no numbers. The belt carries the block from left to right through the \
                patch's coordinate; shapes are to scale. The face lies below the road by what the \
                contact springs, its roughness, are compressed."
            .to_string(),
        tables: vec![("fig-8-shapes.csv".to_string(), csv("phase,x_m,z_m", nodes))],
        pictures: vec![("fig-8.svg".to_string(), svg(&panels, 2)?)],
        verdicts: vec![Verdict::new(
            "run-in, sticking, sliding and snap-out follow each other",
            ordered && passage.rows[phases[1]].stick > 0.5,
            phases
                .map(|row| format!("{:.0} mm", 1e3 * passage.rows[row].contact_x))
                .join(", "),
        )],
    })
}

/// Figure 9: displacement and velocity of the run-in edge over the contact coordinate.
///
/// # Errors
/// What stops the block.
pub fn fig_9(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let passage = passage(compound, fineness)?;
    let series = |pick: &dyn Fn(&Row) -> f64, factor: f64| {
        passage.rows.iter().map(|r| (1e3 * r.contact_x, factor * pick(r))).collect::<Vec<_>>()
    };
    let axes = ["contact coordinate [mm]", "displacement [um]"];
    let displacement = Panel::new(
        "run-in edge, along the road",
        axes,
        vec![Series::line("", 0, series(&|r| r.displacement[0], 1e6))],
    );
    let axes = ["contact coordinate [mm]", "velocity [mm/s]"];
    let velocity = Panel::new(
        "run-in edge, along the road",
        axes,
        vec![Series::line("", 1, series(&|r| r.velocity[0], 1e3))],
    );
    let rows = passage.rows.iter().map(|r| {
        let (x, v) = (r.displacement, r.velocity);
        vec![r.time, r.contact_x, x[0], x[1], v[0], v[1], r.stick, r.area]
    });
    let header = "time_s,contact_x_m,run_in_x_m,run_in_z_m,run_in_vx_m_s,run_in_vz_m_s,\
                  stick_fraction,area_fraction";
    let reversals = reversals(&passage);
    Ok(Study {
        name: "fig-9",
        title: "Displacement and velocity over the contact coordinate",
        notes: format!("The patch reaches from -{0:.0} to {0:.0} mm.", 0.5e3 * passage.length),
        tables: vec![("fig-9.csv".to_string(), csv(header, rows))],
        pictures: vec![("fig-9.svg".to_string(), svg(&[displacement, velocity], 2)?)],
        verdicts: vec![Verdict::new(
            "stick-slip vibrations occur in the sliding phase",
            reversals >= 3,
            format!("{reversals} snaps after the sticking phase"),
        )],
    })
}

/// Snaps after the sticking phase: from stuck (more than half of the contact) to sliding.
fn reversals(passage: &Passage) -> usize {
    let [_, sticking, _, last] = passage.phases();
    let stuck: Vec<bool> = passage.rows[sticking..=last].iter().map(|r| r.stick > 0.5).collect();
    stuck.windows(2).filter(|w| w[0] && !w[1]).count()
}
