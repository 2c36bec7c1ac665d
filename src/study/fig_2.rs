//! Figure 2: friction characteristic, and contact stiffness as force over approach.

use super::identify::objective::Fineness;
use super::measured::{Curve, Grid, Measurements};
use super::plot::{svg, Panel, Series};
use super::report::{csv, Study, Verdict};
use crate::block::Reductions;
use crate::block::TreadBlock;
use crate::contact::friction::{FrictionLaw, Law};
use crate::drive::Pose;
use crate::error::Fault;
use crate::params::{NormalDrive, Params};

/// Length of the block whose contact stiffness is shown \[m\].
const LENGTH: f64 = 0.015;
/// Pressures of the paper's studies \[Pa\].
const PRESSURES: [f64; 4] = [100e3, 250e3, 400e3, 600e3];

/// Figure 2.
///
/// # Errors
/// What stops the block.
pub fn fig_2(
    compound: &Params,
    fineness: &Fineness,
    measured: &Measurements,
) -> Result<Study, Fault> {
    let law = Law::new(&compound.friction, None);
    let curve = approach(compound, fineness)?;
    let area = LENGTH * compound.block.width;
    let forces = curve.iter().map(|c| vec![c[0], c[1], area * c[1]]);
    let forces = csv("approach_m,mean_pressure_pa,force_n", forces);
    let panels = [friction(&law, &measured.friction), stiffness(&curve, area, &measured.stiffness)];
    Ok(Study {
        name: "fig-2",
        title: "Friction characteristic and contact stiffness",
        notes: format!(
            "Lines: the identified laws. Dots, measured friction: {}. Dots, measured stiffness: {}.",
            measured.friction.origin, measured.stiffness.origin
        ),
        tables: vec![
            ("fig-2-friction.csv".to_string(), friction_table(&law)),
            ("fig-2-stiffness.csv".to_string(), forces),
        ],
        pictures: vec![("fig-2.svg".to_string(), svg(&panels, 2)?)],
        verdicts: verdicts(&law, &curve),
    })
}

/// Speeds over which the characteristic is drawn \[m/s\]: 1 mm/s to 3 m/s, evenly in their logarithm.
fn speeds() -> impl Iterator<Item = f64> {
    (0..80).map(|i| 1e-3 * 3000.0_f64.powf(f64::from(i) / 79.0))
}

/// Friction coefficient over speed at each pressure, of the law and measured.
fn friction(law: &Law, measured: &Grid) -> Panel {
    let mut series = Vec::new();
    for (color, p) in PRESSURES.iter().enumerate() {
        let line = speeds().map(|v| (1e3 * v, law.at(*p, v)[0])).collect();
        series.push(Series::line(format!("{:.2} N/mm2", 1e-6 * p), color, line));
        let dots = measured.points.iter().filter(|m| m[0] == *p).map(|m| (1e3 * m[1], m[2]));
        series.push(Series::dots("", color, dots.collect()));
    }
    let axes = ["sliding speed [mm/s]", "friction coefficient"];
    let mut panel = Panel::new("friction characteristic, dots: measured", axes, series);
    panel.log_x = true;
    panel
}

fn friction_table(law: &Law) -> String {
    let rows = PRESSURES.iter().flat_map(|p| speeds().map(move |v| vec![*p, v, law.at(*p, v)[0]]));
    csv("pressure_pa,speed_m_s,mu", rows)
}

fn verdicts(law: &Law, curve: &[[f64; 2]]) -> Vec<Verdict> {
    let falling = law.at(250e3, 0.3)[1];
    let (soft, stiff) = (slope(curve, 10e3), slope(curve, 400e3));
    vec![
        Verdict::new(
            "friction falls with speed at 0.25 N/mm2 and 300 mm/s",
            falling < 0.0,
            format!("{falling:.2} per m/s"),
        ),
        Verdict::new(
            "the contact is soft at first and stiffens",
            stiff > 2.0 * soft,
            format!("{soft:.1e} to {stiff:.1e} Pa/m from 10 to 400 kPa"),
        ),
    ]
}

/// Mean pressure over approach of a pressed block at rest: approach \[m\], pressure \[Pa\].
fn approach(compound: &Params, fineness: &Fineness) -> Result<Vec<[f64; 2]>, Fault> {
    let mut params = compound.clone();
    (params.block.height, params.block.length) = (0.010, LENGTH);
    params.drive.normal = NormalDrive::Load;
    fineness.apply(&mut params);
    let mut block = TreadBlock::with_reduction(&params, Reductions::default().of(&params)?)?;
    let area = params.block.length * params.block.width;
    (1..=40)
        .map(|i| {
            let pressure = 650e3 * f64::from(i * i) / 1600.0;
            block.initialize(0.0, Pose { load: pressure * area, ..Pose::default() })?;
            Ok([params.block.height - block.outputs().carriage_z, pressure])
        })
        .collect()
}

/// Stiffness per area \[Pa/m\] around a pressure.
fn slope(curve: &[[f64; 2]], pressure: f64) -> f64 {
    let at = curve.partition_point(|c| c[1] < pressure).clamp(1, curve.len() - 1);
    (curve[at][1] - curve[at - 1][1]) / (curve[at][0] - curve[at - 1][0])
}

/// Force over approach, simulated on a nominal `area` \[m²\] and measured.
fn stiffness(curve: &[[f64; 2]], area: f64, measured: &Curve) -> Panel {
    let points = curve.iter().map(|c| (1e6 * c[0], area * c[1])).collect();
    let dots = measured.points.iter().map(|[u, force]| (1e6 * u, *force)).collect();
    let axes = ["approach [um]", "force [N]"];
    let series = vec![
        Series::line("block and contact, simulated", 0, points),
        Series::dots("measured", 1, dots),
    ];
    Panel::new("contact stiffness, h 10 mm, l 15 mm", axes, series)
}
