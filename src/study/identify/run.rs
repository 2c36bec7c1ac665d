//! The identification from start to end: modulus, global search, local search.

use super::cma::Cma;
use super::gauss_newton::{improve, Local};
use super::hops::Hops;
use super::objective::{modulus_over_density, Fineness, Problem};
use super::space::{places, Unknown};
use super::walk::Walk;
use crate::block::Reductions;
use crate::error::Fault;
use crate::params::Params;
use crate::study::paper::{Column, TABLE_1};

/// What an identification is asked for.
#[derive(Clone, Debug)]
pub struct Task {
    /// Start, and values of what is not unknown.
    pub start: Params,
    /// Unknowns.
    pub unknowns: Vec<Unknown>,
    /// Columns of Table 1 to fit.
    pub columns: Vec<Column>,
    /// Simulated tables in the global search; 0: local only.
    pub evaluations: usize,
    /// First standard deviation of the global search, in unit intervals.
    pub spread: f64,
    /// Candidates per generation; 0: by the number of unknowns.
    pub population: usize,
    /// Hops of the global search, each followed by a local one.
    pub hops: usize,
    /// Steps of a walk downhill; 0: none.
    pub walk: usize,
    /// Rounds of a local search.
    pub rounds: usize,
    /// Solve the local search coarsely, too.
    pub coarse: bool,
    /// Solve the global search finely, too.
    pub fine: bool,
    /// Seed of the global search.
    pub seed: u64,
}

/// A step of the identification as it is told.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// `global`, `hop`, `walk` or `local`.
    pub stage: &'static str,
    /// Tables simulated so far in the global search, or hops or steps of the walk made.
    pub evaluations: usize,
    /// Best cost so far; of a walk its toll.
    pub cost: f64,
    /// Parameters of the best.
    pub best: &'a Params,
}

/// What it found.
#[derive(Clone, Debug)]
pub struct Identified {
    /// Best parameters.
    pub params: Params,
    /// End of the local search.
    pub local: Local,
    /// Cost.
    pub cost: f64,
}

/// Identifies.
///
/// # Errors
/// What stops the reduction of a geometry.
pub fn identify(
    task: &Task,
    reductions: &Reductions,
    mut told: impl FnMut(&Progress<'_>),
) -> Result<Identified, Fault> {
    let base = base(task, reductions)?;
    let x = search(task, &base, reductions, &mut told);
    let fine = problem(task, &base, Fineness::choose(task.coarse), reductions);
    let local = improve(&fine, x, task.rounds, |x, cost| {
        let best = &fine.params(x);
        told(&Progress { stage: "local", evaluations: task.evaluations, cost, best });
    });
    let mut params = fine.params(&local.x);
    params.wear = task.start.wear.clone();
    let cost = Problem::cost(&local.residuals, &local.x);
    Ok(Identified { params, local, cost })
}

/// Identifies without saying how well the data pin the parameters down; returns them.
///
/// # Errors
/// What stops the reduction of a geometry.
pub fn fit(task: &Task, reductions: &Reductions) -> Result<Params, Fault> {
    if task.rounds > 0 {
        return identify(task, reductions, |_| {}).map(|found| found.params);
    }
    let base = base(task, reductions)?;
    let x = search(task, &base, reductions, &mut |_| {});
    Ok(problem(task, &base, Fineness::FINE, reductions).params(&x))
}

/// The start without wear and with the modulus that Table 1's eigenfrequencies ask for.
fn base(task: &Task, reductions: &Reductions) -> Result<Params, Fault> {
    let mut base = task.start.clone();
    base.wear.coefficient = 0.0;
    base.rubber.young_modulus =
        base.rubber.density * modulus_over_density(&base, &TABLE_1, reductions)?;
    Ok(base)
}

fn problem<'a>(
    task: &'a Task,
    base: &'a Params,
    fineness: Fineness,
    reductions: &'a Reductions,
) -> Problem<'a> {
    Problem { base, unknowns: &task.unknowns, columns: &task.columns, fineness, reductions }
}

/// All that comes before the local search; returns where it ends.
fn search(
    task: &Task,
    base: &Params,
    reductions: &Reductions,
    told: &mut impl FnMut(&Progress<'_>),
) -> Vec<f64> {
    let mut x = places(&task.unknowns, base);
    let searched = problem(task, base, Fineness::choose(!task.fine), reductions);
    if task.evaluations > 0 {
        x = global(task, &searched, x, told);
    }
    if task.hops > 0 {
        x = hop(task, &searched, x, told);
    }
    if task.walk > 0 {
        x = walk(task, &problem(task, base, Fineness::choose(task.coarse), reductions), x, told);
    }
    x
}

/// Hops from `start`; returns the best place seen.
fn hop(
    task: &Task,
    problem: &Problem<'_>,
    start: Vec<f64>,
    told: &mut impl FnMut(&Progress<'_>),
) -> Vec<f64> {
    let mut hops = Hops::new(improve(problem, start, task.rounds, |_, _| {}), task.seed);
    for evaluations in 1..=task.hops {
        hops.hop(problem, task.rounds);
        let (best, cost) = hops.best();
        let best = &problem.params(&best.x);
        told(&Progress { stage: "hop", evaluations, cost, best });
    }
    hops.best().0.x.clone()
}

/// Walks downhill from `start`; returns where it ends.
fn walk(
    task: &Task,
    problem: &Problem<'_>,
    start: Vec<f64>,
    told: &mut impl FnMut(&Progress<'_>),
) -> Vec<f64> {
    let mut walk = Walk::new(problem, start, task.seed);
    for evaluations in 1..=task.walk {
        walk.step();
        let (x, cost) = walk.place();
        told(&Progress { stage: "walk", evaluations, cost, best: &problem.params(x) });
    }
    walk.place().0.to_vec()
}

/// Covariance matrix adaptation from `start`; returns the best place seen.
fn global(
    task: &Task,
    problem: &Problem<'_>,
    start: Vec<f64>,
    told: &mut impl FnMut(&Progress<'_>),
) -> Vec<f64> {
    let population = match task.population {
        0 => 4 + (3.0 * (start.len() as f64).ln()) as usize,
        given => given,
    };
    let mut search = Cma::new(&start, task.spread, population, task.seed);
    let mut best = start.clone();
    let mut cost = Problem::cost(&problem.residuals(&start), &start);
    let mut evaluations = 1;
    while evaluations < task.evaluations && search.sigma() > 1e-3 {
        let candidates = search.ask();
        let costs: Vec<f64> =
            candidates.iter().map(|x| Problem::cost(&problem.residuals(x), x)).collect();
        evaluations += candidates.len();
        for (candidate, c) in candidates.iter().zip(&costs) {
            if *c < cost {
                (best, cost) = (candidate.iter().map(|x| x.clamp(0.0, 1.0)).collect(), *c);
            }
        }
        search.tell(&candidates, &costs);
        let params = &problem.params(&best);
        told(&Progress { stage: "global", evaluations, cost, best: params });
    }
    best
}
