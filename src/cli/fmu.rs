//! `tread fmu`: build, describe and check the FMU.

use super::output::{Done, Stop};
use crate::error::{Fault, Problem};

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Pack out/TreadBlock.fmu
    Build,
    /// List all variables
    Describe,
    /// Check an FMU
    Check,
}

/// Does what was typed.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    let name = format!("{:?}", arguments.command).to_lowercase();
    Err(Fault::one(Problem::new(format!("tread fmu {name}"), "not there yet", "later", "wait")).into())
}
