//! Runs the points that are not done yet, on as many threads as there are.

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::journal::{Journal, Record};
use super::measures::{Traces, COLUMNS};
use super::plan::Plan;
use crate::block::{Reductions, Shape, TreadBlock, KEPT};
use crate::error::Fault;
use crate::scenario;
use crate::threads;

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
    let pool = threads::pool(jobs)?;
    let mut known = vec![false; plan.points.len()];
    done.iter().for_each(|record| known[record.point] = true);
    let pending: Vec<usize> = (0..known.len()).filter(|i| !known[*i]).collect();
    let reductions = Reductions::default();
    let shared = Mutex::new((journal, done));
    pool.install(|| {
        prepare(plan, &pending, &reductions);
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

/// Points whose shapes are looked at beforehand.
const LOOKED_AT: usize = 1000;

/// Makes the reductions of the pending points side by side, if they are few: points of one shape would else wait for it
/// together, on all cores.
fn prepare(plan: &Plan, pending: &[usize], reductions: &Reductions) {
    let mut shapes: Vec<Shape> = Vec::new();
    for config in pending.iter().take(LOOKED_AT).filter_map(|&index| plan.config(index).ok()) {
        let shape = Shape::of(&config.params);
        if !shapes.contains(&shape) {
            shapes.push(shape);
        }
        if shapes.len() > KEPT {
            return;
        }
    }
    // What stops a reduction, be it a panic, is told by its points.
    shapes.par_iter().with_max_len(1).for_each(|shape| {
        drop(catch_unwind(AssertUnwindSafe(|| reductions.of_shape(*shape))));
    });
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

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
