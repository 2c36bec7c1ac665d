//! Programs of `make bench` on our own side; benches/bench.py runs them and does the arithmetic.
//!
//!     block run LENGTH_MM [key=value …]       our integrator: times, metrics, work, as JSON
//!     block full LENGTH_MM DURATION           unreduced finite elements, explicit
//!     block export LENGTH_MM FILE             the reduced equations as numbers, for the peers
//!
//! The case is the issue's: h 10, l 15 or 45 mm, 0.25 N/mm², 0.3 m/s, without wear.

mod equations;
mod full;

use std::error::Error;
use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use tread_block::metrics::{stick_slip, Recorder};
use tread_block::scenario::{self, Inputs, Plan, Scenario, Slide};
use tread_block::{Params, TreadBlock};

/// Mean pressure [Pa] and road speed [m/s] of the case.
pub const PRESSURE: f64 = 250e3;
/// Road speed [m/s].
pub const SPEED: f64 = 0.3;

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> Outcome {
    // `cargo bench` adds --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["run", length, settings @ ..] => run(length.parse()?, settings),
        ["full", length, duration] => full::run(length.parse()?, duration.parse()?),
        ["export", length, file] => Ok(fs::write(file, equations::export(length.parse()?)?)?),
        _ => {
            Err("run LENGTH_MM [key=value …], full LENGTH_MM DURATION, export LENGTH_MM FILE"
                .into())
        }
    }
}

/// Parameters of the case for a block of `length` [mm].
pub fn case(length: f64) -> (Params, Scenario) {
    let mut params = Params::default();
    params.block.length = 1e-3 * length;
    params.wear.coefficient = 0.0;
    let load = PRESSURE * params.block.length * params.block.width;
    let scenario = Scenario::Slide(Slide::constant(SPEED, load));
    (scenario.fit(&params), scenario)
}

/// Seconds that the processor has spent on this thread: what a clock on the wall would show if nobody else
/// were on the machine. The kernel's own count, or the wall's where there is none.
pub fn busy() -> f64 {
    let spent = fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = spent.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    let wall = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |t| t.as_secs_f64());
    nanoseconds.map_or_else(wall, |ns| 1e-9 * ns)
}

/// Runs our integrator `repeats` times.
fn run(length: f64, settings: &[&str]) -> Outcome {
    let (mut params, scenario) = case(length);
    let mut plan = Plan { step: 20e-6, duration: 0.03, inputs: Inputs::Exact };
    let (mut repeats, mut trace) = (1, None);
    for setting in settings {
        let (key, value) = setting.split_once('=').ok_or("settings are key=value")?;
        match key {
            "duration" => plan.duration = value.parse()?,
            "step" => plan.step = value.parse()?,
            "repeats" => repeats = value.parse()?,
            "trace" => trace = Some(value),
            _ => {
                if let Some(problem) = tread_block::params::load::assign_text(setting, &mut params)
                {
                    return Err(problem.to_string().into());
                }
            }
        }
    }
    let mut block = TreadBlock::new(&params)?;
    let mut seconds = Vec::new();
    let mut recorder = Recorder::default();
    for _ in 0..repeats {
        recorder = Recorder::default();
        let mut start = None;
        scenario::run(&mut block, &scenario, &plan, |time, block| {
            // The first call comes after the block was set up: only motion is timed.
            start.get_or_insert_with(busy);
            recorder.push(time, block.outputs());
            Ok(())
        })?;
        seconds.push(busy() - start.unwrap_or_else(busy));
    }
    let found = stick_slip(&recorder.trace(), SPEED);
    let work = block.statistics();
    let nodes = block.reduction().contact_nodes();
    if let Some(file) = trace {
        fs::write(file, rows(&recorder))?;
    }
    println!(
        "{{\"seconds\": {seconds:?}, \"duration\": {}, \"nodes\": {nodes}, \"modes\": {}, \"frequency\": {}, \
         \"friction\": {}, \"steps\": {}, \"rejected\": {}, \"iterations\": {}}}",
        plan.duration,
        block.reduction().modes(),
        found.frequency,
        found.mean_friction,
        work.steps,
        work.rejected,
        work.iterations
    );
    Ok(())
}

/// A trace as `tread metrics` reads it.
pub fn rows(recorder: &Recorder) -> String {
    let trace = recorder.trace();
    let mut text = String::from(
        "time,run_in.displacement.x,run_in.velocity.x,contact.friction_coefficient,contact.stick_fraction\n",
    );
    for k in 0..trace.time.len() {
        let (x, v) = (trace.displacement[k], trace.velocity[k]);
        let (mu, stick) = (trace.friction[k], trace.stick[k]);
        text += &format!("{:?},{x:?},{v:?},{mu:?},{stick:?}\n", trace.time[k]);
    }
    text
}
