//! Runs the points that are not done yet, on as many threads as there are.

use std::collections::VecDeque;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use rayon::prelude::*;

use super::journal::{Journal, Record};
use super::measures::{Traces, COLUMNS};
use super::plan::Plan;
use crate::block::{Shape, TreadBlock};
use crate::error::Fault;
use crate::params::Params;
use crate::reduction::Reduction;
use crate::scenario;

/// Runs all points of `plan` that `done` lacks, writes each to `journal` and shows it to `visit`;
/// returns the records of all points in their order.
///
/// # Errors
/// A journal that cannot be written, threads that cannot be had. What stops a point is its record.
pub fn run(
    plan: &Plan,
    done: Vec<Record>,
    jobs: usize,
    journal: Journal,
    visit: impl Fn(&Record) + Sync,
) -> Result<Vec<Record>, Fault> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|e| Fault::unusable("threads", e))?;
    let mut known = vec![false; plan.points.len()];
    done.iter().for_each(|record| known[record.point] = true);
    let pending: Vec<usize> = (0..known.len()).filter(|i| !known[*i]).collect();
    let reductions = Reductions::default();
    let shared = Mutex::new((journal, done));
    pool.install(|| {
        // One point at a time: what a point costs varies with its speed and its failure.
        pending.par_iter().with_max_len(1).try_for_each(|&index| {
            let record = point(plan, index, &reductions);
            let mut shared = lock(&shared);
            shared.0.append(&record.line())?;
            visit(&record);
            shared.1.push(record);
            Ok::<(), Fault>(())
        })
    })?;
    let (_, mut records) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    records.sort_by_key(|record| record.point);
    Ok(records)
}

/// Runs one point. Even a panic, which would be an error of ours, costs this point only.
fn point(plan: &Plan, index: usize, reductions: &Reductions) -> Record {
    let outcome = catch_unwind(AssertUnwindSafe(|| simulate(plan, index, reductions)));
    let outcome = match outcome {
        Ok(result) => result.map_err(|fault| fault.to_string()),
        Err(_) => Err("the model panicked: please report this point".to_string()),
    };
    Record { point: index, outcome }
}

fn simulate(
    plan: &Plan,
    index: usize,
    reductions: &Reductions,
) -> Result<[f64; COLUMNS.len()], Fault> {
    let config = plan.config(index)?;
    let reduction = reductions.of(&config.params)?;
    let mut block = TreadBlock::with_reduction(&config.params, reduction)?;
    let mut traces = Traces::default();
    scenario::run(&mut block, &config.scenario, &config.plan, |time, block| {
        traces.push(time, block.outputs());
        Ok(())
    })?;
    Ok(traces.measures(&config))
}

/// Shapes whose reductions are kept: a plan over the geometry would else fill the memory.
const KEPT: usize = 64;

type Made = Arc<OnceLock<Result<Arc<Reduction>, Fault>>>;

/// Reductions shared by the blocks of one [`Shape`]; threads wait only for the shape that they need.
#[derive(Debug, Default)]
struct Reductions {
    kept: Mutex<VecDeque<(Shape, Made)>>,
}

impl Reductions {
    fn of(&self, params: &Params) -> Result<Arc<Reduction>, Fault> {
        let shape = Shape::of(params);
        let made = self.place(shape);
        made.get_or_init(|| shape.reduce().map(Arc::new)).clone()
    }

    fn place(&self, shape: Shape) -> Made {
        let mut kept = lock(&self.kept);
        if let Some((_, made)) = kept.iter().find(|(known, _)| *known == shape) {
            return made.clone();
        }
        if kept.len() == KEPT {
            kept.pop_front();
        }
        let made = Made::default();
        kept.push_back((shape, made.clone()));
        made
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
