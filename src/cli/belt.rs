//! `tread belt`: the path of a flattened belt.

use std::path::PathBuf;

use super::output::{self, Done, Stop};
use crate::scenario::{belt_csv, BeltPath};

const EXAMPLES: &str = "\
Examples:
  tread belt --speed 15 --slip 0.02 > belt.csv        braking: the block is dragged forwards
  tread belt --speed 8 --slip -0.03 --out drive.csv   driving
  tread belt --radius 0.32 --contact-length 0.14 --speed 22 --compression 0.0004 --block-height 0.008

The columns are time_s, belt_x_m, belt_z_m, belt_angle_rad: position and angle of the middle of the
clamped face in the road frame (x forward, z up, road at z = 0, a positive angle lifts the +x side).
Use the file in a TOML file as [run.roll] belt_file, or feed it to the FMU's inputs belt.*";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Arguments {
    /// Radius of the belt outside of the contact patch [m]
    #[arg(long, default_value_t = 0.3, allow_negative_numbers = true)]
    radius: f64,
    /// Length of the flattened belt [m]
    #[arg(long, default_value_t = 0.12, allow_negative_numbers = true)]
    contact_length: f64,
    /// Speed of the belt relative to the axle [m/s]
    #[arg(long, allow_negative_numbers = true)]
    speed: f64,
    /// Slip: sliding of the flat belt over its speed; positive brakes, negative drives
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    slip: f64,
    /// Height of the block that hangs below the belt [m]
    #[arg(long, default_value_t = 0.01, allow_negative_numbers = true)]
    block_height: f64,
    /// How much lower than the block's height the flat belt runs [m]
    #[arg(long, default_value_t = 0.2e-3, allow_negative_numbers = true)]
    compression: f64,
    /// Length of belt over which the curvature goes from the circle's to zero [m]
    #[arg(long, default_value_t = 0.02, allow_negative_numbers = true)]
    blend_length: f64,
    /// Length of belt before and behind the flat part [m]
    #[arg(long, default_value_t = 0.05, allow_negative_numbers = true)]
    lead: f64,
    /// Distance of the samples [s]
    #[arg(long, default_value_t = 5e-6, allow_negative_numbers = true)]
    step: f64,
    /// File to write; the standard output if not given
    #[arg(long, short)]
    out: Option<PathBuf>,
}

/// Writes the path.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let path = BeltPath {
        radius: arguments.radius,
        contact_length: arguments.contact_length,
        speed: arguments.speed,
        slip: arguments.slip,
        height: arguments.block_height - arguments.compression,
        blend_length: arguments.blend_length,
        lead: arguments.lead,
    };
    let samples = path.samples(arguments.step)?;
    let file = arguments.out.as_deref();
    let mut out = output::writer(file)?;
    belt_csv::write(&samples, &mut out)
        .and_then(|()| out.flush())
        .map_err(|e| output::write_failed(&output::target(file), &e))?;
    eprintln!(
        "{} samples over {:.3} ms; flat from {:.3} to {:.3} ms",
        samples.len(),
        1e3 * path.duration(),
        1e3 * (path.lead + 0.5 * path.blend_length) / path.speed,
        1e3 * (path.lead + path.contact_length - 0.5 * path.blend_length) / path.speed,
    );
    Ok(Done::Fine)
}
