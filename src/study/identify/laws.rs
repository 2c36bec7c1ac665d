//! Friction laws compared at equal effort: each begins at its least-squares fit to the curve of the start and gets
//! the same search.

use std::fmt::Write;

use nalgebra::{Matrix2, Vector2};
use serde_json::{json, Value};

use super::objective::{Fineness, Problem};
use super::run::{self, Identified, Task};
use super::space::{set, unknowns, Unknown};
use crate::block::Reductions;
use crate::contact::friction::{FrictionLaw, Law};
use crate::error::Fault;
use crate::params::{table, Friction, FrictionForm, Params};
use crate::study::start::Start;
use crate::study::table_one::TableOne;

/// The laws in closed form.
const LAWS: [FrictionForm; 4] = [
    FrictionForm::TwoExponentials,
    FrictionForm::Exponential,
    FrictionForm::Rational,
    FrictionForm::LogBell,
];

/// Sliding speeds \[m/s\] over which a law is fitted to a curve: from stick-slip's slowest to its fastest.
const SPEEDS: (f64, f64) = (0.02, 2.0);
/// Points of the curve, evenly over the logarithm of the speed.
const POINTS: usize = 60;
/// Points of the grid over each nonlinear parameter, and how often it is drawn anew around the best.
const GRID: (i32, usize) = (10, 12);
/// Share of the grid that is left each time.
const ZOOM: f64 = 0.4;

/// How far a law got.
#[derive(Clone, Debug)]
pub struct Tried {
    /// Name of the law.
    pub law: &'static str,
    /// Its unknowns.
    pub unknowns: usize,
    /// Root mean square distance of its first guess to the start's curve \[-\].
    pub rms: f64,
    /// Table 1 of the first guess.
    pub first: TableOne,
    /// Table 1 at the end.
    pub table: TableOne,
    /// Cost at the end.
    pub cost: f64,
}

/// Name of a law as parameter files have it.
fn name(form: FrictionForm) -> &'static str {
    match table::find("friction.form").map(|spec| spec.kind) {
        Some(table::Kind::Enumeration { items, .. }) => items[form as usize].name,
        _ => "",
    }
}

/// Tries all laws by the search that `task` asks for; `found` is what it found for its own law. `told(name)` hears of
/// each before it starts.
///
/// # Errors
/// What stops a search.
pub fn compare(
    task: &Task,
    found: &Identified,
    reductions: &Reductions,
    mut told: impl FnMut(&str),
) -> Result<Vec<Tried>, Fault> {
    let fineness = Fineness::choose(task.coarse);
    let simulate = |params: &Params| {
        TableOne::simulate(params, &task.columns, &fineness, Start::Braking, reductions)
    };
    let mut out = Vec::new();
    for form in LAWS {
        told(name(form));
        let (start, rms) = fit(&task.start, form);
        let first = simulate(&start);
        let own = form == task.start.friction.form;
        let task = Task { start, unknowns: unknowns(form), ..task.clone() };
        let params = if own { found.params.clone() } else { run::fit(&task, reductions)? };
        let table = simulate(&params);
        out.push(Tried {
            law: name(form),
            unknowns: task.unknowns.len(),
            rms,
            first,
            cost: cost(&params, &task, &fineness, reductions),
            table,
        });
    }
    out.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    Ok(out)
}

/// Cost of the searches.
fn cost(params: &Params, task: &Task, fineness: &Fineness, reductions: &Reductions) -> f64 {
    let (unknowns, columns, fineness) = (&task.unknowns, &task.columns, *fineness);
    let problem = Problem { base: params, unknowns, columns, fineness, reductions };
    Problem::cost(&problem.residuals_of(params), &[])
}

/// The parameters of `base` with the law `form` that is nearest to its curve by least squares, and the root mean square
/// distance.
fn fit(base: &Params, form: FrictionForm) -> (Params, f64) {
    if form == base.friction.form {
        return (base.clone(), 0.0);
    }
    let target = curve(&base.friction);
    let unknowns = unknowns(form);
    let bent = |name: &str| unknowns.iter().find(|u| u.name == name).copied();
    let shape = match form {
        FrictionForm::Rational => "friction.rational_exponent",
        FrictionForm::LogBell => "friction.bell_steepness",
        _ => "friction.decay_exponent",
    };
    let mut base = base.clone();
    base.friction.form = form;
    let (Some(speed), Some(shape)) = (bent("friction.decay_speed"), bent(shape)) else {
        return (base, f64::INFINITY);
    };
    let (mut best, mut least, mut width) = ([0.5, 0.5], f64::INFINITY, 0.5);
    for _ in 0..GRID.1 {
        let middle = best;
        for i in -GRID.0..=GRID.0 {
            for j in -GRID.0..=GRID.0 {
                let step = |k: i32| width * f64::from(k) / f64::from(GRID.0);
                let place = [middle[0] + step(i), middle[1] + step(j)].map(|x| x.clamp(0.0, 1.0));
                let mut there = base.clone();
                set(&mut there, speed.name, speed.value(place[0]));
                set(&mut there, shape.name, shape.value(place[1]));
                let distance = levels(&mut there, &unknowns, &target);
                if distance < least {
                    (best, least, base) = (place, distance, there);
                }
            }
        }
        width *= ZOOM;
    }
    (base, least)
}

/// Sets μ_∞ and Δμ by linear least squares, within their ranges; returns the root mean square distance.
fn levels(params: &mut Params, unknowns: &[Unknown], target: &[f64]) -> f64 {
    let part =
        |mu_inf: f64, mu_drop: f64| curve(&Friction { mu_inf, mu_drop, ..params.friction.clone() });
    let (level, fall) = (part(1.0, 0.0), part(0.0, 1.0));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let normal = Matrix2::new(
        dot(&level, &level),
        dot(&level, &fall),
        dot(&level, &fall),
        dot(&fall, &fall),
    );
    let right = Vector2::new(dot(&level, target), dot(&fall, target));
    let Some(inverse) = normal.try_inverse() else { return f64::INFINITY };
    let solution = inverse * right;
    for (name, value) in [("friction.mu_inf", solution[0]), ("friction.mu_drop", solution[1])] {
        if let Some(unknown) = unknowns.iter().find(|u| u.name == name) {
            // A range searched by logarithms has no place for what is not positive.
            let place = if value > 0.0 { unknown.place(value) } else { 0.0 };
            set(params, name, unknown.value(place));
        }
    }
    let there = curve(&params.friction);
    let square: f64 = there.iter().zip(target).map(|(a, b)| (a - b).powi(2)).sum();
    (square / POINTS as f64).sqrt()
}

/// μ at the reference pressure over [`SPEEDS`].
fn curve(friction: &Friction) -> Vec<f64> {
    let law = Law::new(friction, None);
    let (low, high) = SPEEDS;
    (0..POINTS)
        .map(|i| low * (high / low).powf(i as f64 / (POINTS - 1) as f64))
        .map(|v| law.at(friction.reference_pressure, v)[0])
        .collect()
}

/// Columns of the comparison's CSV.
pub const CSV_HEADER: &str =
    "law,unknowns,fit_rms,first_median,first_largest,first_wrong_cells,cost,median,largest,wrong_cells";

/// The comparison as CSV, the best first.
pub fn csv(tried: &[Tried]) -> String {
    let mut out = format!("{CSV_HEADER}\n");
    for t in tried {
        let _ = writeln!(
            out,
            "{},{},{:.4},{:.4},{:.4},{},{:.3},{:.4},{:.4},{}",
            t.law,
            t.unknowns,
            t.rms,
            t.first.median_error(),
            t.first.max_error(),
            t.first.disagreements().len(),
            t.cost,
            t.table.median_error(),
            t.table.max_error(),
            t.table.disagreements().len()
        );
    }
    out
}

/// The comparison as JSON, an object per law with the figures of [`csv()`].
pub fn json(tried: &[Tried]) -> Value {
    let of = |t: &Tried| {
        json!({
            "law": t.law, "unknowns": t.unknowns, "rms": t.rms, "cost": t.cost,
            "first": t.first.figures(), "end": t.table.figures(),
        })
    };
    tried.iter().map(of).collect()
}

/// The comparison as a section of the report.
pub fn markdown(tried: &[Tried]) -> String {
    let mut out = String::from(
        "\n## Friction laws at equal effort\n\nEach law began at its least-squares fit to the curve of the start and \
         got the same search.\n\n| law | unknowns | distance of the first guess | its median, largest, wrong cells | \
         cost | median | largest | wrong cells |\n|---|---|---|---|---|---|---|---|\n",
    );
    for t in tried {
        let wrong: Vec<String> = t.table.disagreements().iter().map(|c| c.place()).collect();
        let [first, first_largest, median, largest] = [
            t.first.median_error(),
            t.first.max_error(),
            t.table.median_error(),
            t.table.max_error(),
        ]
        .map(|x| 100.0 * x);
        let _ = writeln!(
            out,
            "| {} | {} | {:.4} | {first:.1} %, {first_largest:.1} %, {} | {:.2} | {median:.1} % | {largest:.1} % | {} |",
            t.law,
            t.unknowns,
            t.rms,
            t.first.disagreements().len(),
            t.cost,
            if wrong.is_empty() { "none".to_string() } else { wrong.join(", ") }
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::identify::space::get;

    #[test]
    fn the_levels_of_a_law_come_from_its_curve() {
        // Linear least squares on the rational law's own curve: both levels to rounding.
        let truth = Friction {
            form: FrictionForm::Rational,
            mu_inf: 0.4,
            mu_drop: 0.9,
            decay_speed: 0.7,
            rational_exponent: 1.3,
            ..Friction::default()
        };
        let friction = Friction { mu_inf: 0.1, mu_drop: 0.2, ..truth.clone() };
        let mut there = Params { friction, ..Params::default() };
        let unknowns = unknowns(FrictionForm::Rational);
        assert!(levels(&mut there, &unknowns, &curve(&truth)) < 1e-12);
        let told = ["friction.mu_inf", "friction.mu_drop"].map(|name| get(&there, name));
        assert!((told[0] - 0.4).abs() < 1e-10 && (told[1] - 0.9).abs() < 1e-10, "{told:?}");
    }

    #[test]
    fn an_exponential_is_found_beside_two() {
        // Two exponentials of which the slow one has no share are one: the distance must vanish but for the grid.
        let friction = Friction {
            form: FrictionForm::TwoExponentials,
            decay_speed: 0.6,
            decay_exponent: 0.8,
            slow_share: 0.0,
            ..Friction::default()
        };
        let base = Params { friction, ..Params::default() };
        let (found, rms) = fit(&base, FrictionForm::Exponential);
        assert!(rms < 1e-4, "{rms}");
        assert!((found.friction.decay_speed / 0.6 - 1.0).abs() < 1e-2);
        assert!((found.friction.decay_exponent / 0.8 - 1.0).abs() < 1e-2);
    }
}
