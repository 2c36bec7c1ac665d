//! Writes what a diagnosed model says of runs that were never measured.

use super::campaign::{self, Plan, Record, RunSpec, CHANNELS};
use super::json;
use super::simulate::{mount, road_speed, Simulator};
use crate::error::Fault;
use std::io::Write;
use std::path::Path;

/// Simulates all runs of the campaign file `plan` with `model` of `diagnosis` into `out`/runs.
///
/// # Errors
/// Files that cannot be read or written, and what stops the block.
pub fn predict(diagnosis: &Path, plan: &Path, model: &str, out: &Path) -> Result<usize, Fault> {
    let mut params = json::read_model(diagnosis, model)?;
    let plan = campaign::read_plan(plan)?;
    mount(&mut params, &plan);
    let simulator = Simulator::new(&plan)?;
    for spec in &plan.runs {
        let record = simulator.run(&params, spec, spec.duration_s)?;
        let target = out.join(&spec.file);
        write(&target, &plan, spec, &record).map_err(|e| Fault::file(&target, &e))?;
    }
    Ok(plan.runs.len())
}

/// Writes a record with the columns of a measurement.
///
/// # Errors
/// What the system says.
pub fn write(target: &Path, plan: &Plan, spec: &RunSpec, record: &Record) -> std::io::Result<()> {
    if let Some(folder) = target.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = std::io::BufWriter::new(std::fs::File::create(target)?);
    writeln!(file, "time_s,road_speed_m_s,{}", CHANNELS.join(","))?;
    for (row, t) in record.time.iter().enumerate() {
        write!(file, "{t:.7},{:.9}", road_speed(plan, spec, *t))?;
        for channel in &record.channel {
            match channel.as_ref().and_then(|c| c.get(row)) {
                Some(value) => write!(file, ",{value:.9}")?,
                None => write!(file, ",")?,
            }
        }
        writeln!(file)?;
    }
    file.flush()
}
