//! Figure 3: wear rate over pressure and speed, and the worn block after 25 m by five laws.

use rayon::prelude::*;

use super::cycle_jump::{Wearing, Worn};
use super::identify::objective::Fineness;
use super::measured::Measurements;
use super::paper::PRESSURE;
use super::plot::{svg, Panel, Series};
use super::report::{csv, Study, Verdict};
use super::wear_laws::{
    fit, generalised_rate, published, Measured, WearLaw, REFERENCE, SPECIFIC_WEAR,
};
use crate::block::Reductions;
use crate::contact::friction::{FrictionLaw, Law};
use crate::error::Fault;
use crate::params::Params;

/// Sliding distance of the paper's worn block \[m\].
const DISTANCE: f64 = 25.0;
/// Error of the depth allowed per jump \[m\].
const TOLERANCE: f64 = 4e-6;
/// Brute force wears this much faster, so that a short distance shows a profile.
const HASTE: f64 = 40.0;
/// Distance of the brute force \[m\]; with [`HASTE`] worth 40 times as much.
const CHECKED: f64 = 0.06;
/// Place of Fleischer's law among those of [`published`].
const FLEISCHER: usize = 1;

/// Figure 3.
///
/// # Errors
/// What stops the block.
pub fn fig_3(
    compound: &Params,
    fineness: &Fineness,
    measured: &Measurements,
) -> Result<Study, Fault> {
    let measured = &measured.wear;
    let points: Vec<Measured> = measured
        .points
        .iter()
        .map(|[pressure, speed, rate]| Measured { pressure: *pressure, speed: *speed, rate: *rate })
        .collect();
    let generalised = fit(&points).unwrap_or([1.0, 1.0, 0.0]);
    let [k1, k2, k3] = generalised;
    let faces = Faces::worn(compound, fineness, published([k2, k3]))?;
    let fleischer = &faces.by_law[FLEISCHER].1;
    let panels = [rates(&points, generalised), profiles(&faces.by_law), check(&faces)];
    Ok(Study {
        name: "fig-3",
        title: "Wear rate, and the block after 25 m by five laws",
        notes: format!(
            "All laws wear alike at 0.25 N/mm2 and 300 mm/s ({:.2} mm3/(N m)), so that only their \
             shapes compare. Generalised law by least squares of the measured data ({}): k1 = {k1:.3} kg/m3, \
             k2 = {k2:.2}, k3 = {k3:.2}. Cycle-jump: {} jumps for Fleischer's law, estimated error \
             {:.1} um.",
            1e9 * SPECIFIC_WEAR,
            measured.origin,
            fleischer.jumps,
            1e6 * fleischer.error
        ),
        tables: tables(&points, generalised, &faces),
        pictures: vec![("fig-3.svg".to_string(), svg(&panels, 2)?)],
        verdicts: verdicts(&faces),
    })
}

/// Worn tread faces of the block.
struct Faces {
    /// After [`DISTANCE`], by law.
    by_law: Vec<(WearLaw, Worn)>,
    /// After [`CHECKED`] with [`HASTE`] by Fleischer's law, by cycle-jump.
    jumped: Worn,
    /// The same in full.
    brute: Worn,
}

impl Faces {
    /// Lets the block of figure 3 wear.
    fn worn(compound: &Params, fineness: &Fineness, laws: [WearLaw; 5]) -> Result<Self, Fault> {
        let mut params = compound.clone();
        (params.block.height, params.block.length) = (0.010, 0.015);
        params.wear.coefficient = 0.0;
        fineness.apply(&mut params);
        let mu = Law::new(&params.friction, None).at(REFERENCE.0, REFERENCE.1)[0];
        let reductions = Reductions::default();
        let wearing = |law: WearLaw, factor: f64| Wearing {
            params: &params,
            reductions: &reductions,
            law,
            factor,
            speed: REFERENCE.1,
            pressure: PRESSURE,
            reference_mu: mu,
        };
        let by_law = laws
            .par_iter()
            .map(|law| Ok((*law, wearing(*law, 1.0).over(DISTANCE, TOLERANCE)?)))
            .collect::<Result<_, Fault>>()?;
        let (jumped, brute) = rayon::join(
            || wearing(laws[FLEISCHER], HASTE).over(CHECKED, TOLERANCE),
            || wearing(laws[FLEISCHER], HASTE).brute_force(CHECKED),
        );
        Ok(Self { by_law, jumped: jumped?, brute: brute? })
    }
}

fn verdicts(faces: &Faces) -> Vec<Verdict> {
    let shape = |w: &Worn| -> Vec<f64> {
        let mean = w.depth.iter().sum::<f64>() / w.depth.len() as f64;
        w.depth.iter().map(|d| d / mean).collect()
    };
    let first = shape(&faces.by_law[0].1);
    let spread =
        faces.by_law.iter().map(|(_, w)| largest_difference(&shape(w), &first)).fold(0.0, f64::max);
    let fleischer = &faces.by_law[FLEISCHER].1.depth;
    let (edge, middle) = (fleischer[0], fleischer[fleischer.len() / 2]);
    let difference = largest_difference(&faces.jumped.depth, &faces.brute.depth);
    let deepest = faces.brute.depth.iter().copied().fold(0.0, f64::max);
    vec![
        Verdict::new(
            "all wear laws result in a similar shape",
            spread < 0.25,
            format!("shapes over their means differ by at most {:.0} %", 100.0 * spread),
        ),
        Verdict::new(
            "the run-in edge is rounded",
            edge > 1.05 * middle,
            format!("{:.0} um at the edge, {:.0} um in the middle", 1e6 * edge, 1e6 * middle),
        ),
        Verdict::new(
            "the cycle-jump agrees with brute force within 10 % of the depth",
            difference < 0.1 * deepest,
            format!("{:.2} um of {:.1} um", 1e6 * difference, 1e6 * deepest),
        ),
    ]
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn rates(points: &[Measured], generalised: [f64; 3]) -> Panel {
    let mut pressures: Vec<f64> = points.iter().map(|p| p.pressure).collect();
    pressures.sort_by(f64::total_cmp);
    pressures.dedup();
    let mut series = Vec::new();
    for (color, pressure) in pressures.iter().enumerate() {
        let line = (0..40).map(|i| {
            let v = 0.02 * 50.0_f64.powf(f64::from(i) / 39.0);
            (1e3 * v, generalised_rate(generalised, *pressure, v))
        });
        series.push(Series::line(format!("{:.2} N/mm2", 1e-6 * pressure), color, line.collect()));
        let dots = points.iter().filter(|p| p.pressure == *pressure);
        series.push(Series::dots("", color, dots.map(|p| (1e3 * p.speed, p.rate)).collect()));
    }
    let axes = ["sliding speed [mm/s]", "wear rate over friction [kg/m3]"];
    let mut panel = Panel::new("generalised wear rate, dots: example data", axes, series);
    panel.log_x = true;
    panel
}

fn profiles(by_law: &[(WearLaw, Worn)]) -> Panel {
    let series = by_law.iter().enumerate().map(|(i, (law, w))| {
        let points = w.x.iter().zip(&w.depth).map(|(x, d)| (1e3 * x, -1e3 * d)).collect();
        Series::line(law.name, i, points)
    });
    let axes = ["from run-in to run-out edge [mm]", "worn face [mm]"];
    Panel::new("tread face after 25 m", axes, series.collect())
}

fn check(faces: &Faces) -> Panel {
    let points = |w: &Worn| w.x.iter().zip(&w.depth).map(|(x, d)| (1e3 * x, -1e6 * d)).collect();
    let series = vec![
        Series::line("cycle-jump", 0, points(&faces.jumped)),
        Series::dots("brute force", 1, points(&faces.brute)),
    ];
    let axes = ["from run-in to run-out edge [mm]", "worn face [um]"];
    Panel::new("check: 60 mm at 40 times the wear (Fleischer)", axes, series)
}

fn tables(points: &[Measured], generalised: [f64; 3], faces: &Faces) -> Vec<(String, String)> {
    let rates = points.iter().map(|p| {
        let model = generalised_rate(generalised, p.pressure, p.speed);
        vec![p.pressure, p.speed, p.rate, model]
    });
    let Faces { by_law, jumped, brute } = faces;
    let names: Vec<String> =
        by_law.iter().map(|(l, _)| l.name.to_lowercase().replace('-', "_") + "_m").collect();
    let x = &by_law[0].1.x;
    let rows = (0..x.len())
        .map(|i| std::iter::once(x[i]).chain(by_law.iter().map(|(_, w)| w.depth[i])).collect());
    let checked = (0..brute.x.len()).map(|i| vec![brute.x[i], jumped.depth[i], brute.depth[i]]);
    vec![
        ("fig-3-rate.csv".to_string(), csv("pressure_pa,speed_m_s,rate_kg_m3,model_kg_m3", rates)),
        ("fig-3-profile.csv".to_string(), csv(&format!("x_m,{}", names.join(",")), rows)),
        ("fig-3-check.csv".to_string(), csv("x_m,cycle_jump_m,brute_force_m", checked)),
    ]
}
