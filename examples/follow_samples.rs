//! The library driven as an importer drives the FMU: inputs known at communication points only.
//!
//! Reads a CSV `time,belt.x,belt.z,belt.angle,normal_load` from stdin, writes the outputs at the end
//! of each step to stdout, with all digits. Arguments set parameters: `friction.mu_inf=0.6`.
//! The tests compare importers with this, to 1e-12.
//!
//!     cargo run --release --example follow_samples -- friction.mu_inf=0.6 < inputs.csv

use std::io::{self, BufRead, BufWriter, Write};
use tread_block::block::{TreadBlock, OUTPUTS};
use tread_block::drive::{Pose, Predictor};
use tread_block::params::load;
use tread_block::Params;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut params = Params::default();
    for assignment in std::env::args().skip(1) {
        if let Some(problem) = load::assign_text(&assignment, &mut params) {
            return Err(problem.to_string().into());
        }
    }
    let rows = io::stdin().lock().lines().skip(1).map(|line| sample(&line?));
    let samples = rows.collect::<Result<Vec<_>, Box<dyn std::error::Error>>>()?;
    let Some((start, pose)) = samples.first().copied() else { return Ok(()) };

    let mut block = TreadBlock::new(&params)?;
    block.initialize(start, pose)?;
    let mut predictor = Predictor::default();
    let mut out = BufWriter::new(io::stdout().lock());
    for pair in samples.windows(2) {
        let [(time, pose), (next, _)] = [pair[0], pair[1]];
        let h = next - time;
        block.advance(h, &predictor.segment(time, h, Predictor::known(pose)))?;
        write!(out, "{next:?}")?;
        for spec in OUTPUTS {
            for i in 0..spec.size {
                write!(out, ",{:?}", (spec.get)(block.outputs(), i))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

fn sample(line: &str) -> Result<(f64, Pose), Box<dyn std::error::Error>> {
    let cells = line.split(',').map(|cell| cell.trim().parse());
    let cells = cells.collect::<Result<Vec<f64>, _>>()?;
    match cells[..] {
        [time, x, z, angle, load] => Ok((time, Pose { x, z, angle, load })),
        _ => Err(format!("{line}: five columns are needed").into()),
    }
}
