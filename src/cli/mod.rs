//! The command line: what was typed, and one file per command.
//!
//! Data goes to the standard output, talk to the standard error. Exit codes: 0 done (also when the
//! reader of a pipe has left), 1 a check found problems or a comparison missed its limit, 2 wrong use
//! or a fault.

mod belt;
mod check;
mod field;
mod fmu;
mod gap;
mod identify;
mod init;
mod metrics;
mod output;
mod plot;
mod reference;
mod simulate;
mod study;
mod summary;
mod sweep;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

pub use output::{Done, Stop};

const EXAMPLES: &str = "\
Examples:
  tread init slide > slide.toml          a commented file of a sliding run
  tread simulate slide.toml --out run.csv
  tread plot run.csv                     draws run.svg
  tread simulate slide.toml --set run.slide.speed=0.15 --set friction.mu_inf=0.6 > other.csv
  tread belt --speed 15 --slip 0.02 > belt.csv
  tread fmu build                        leaves out/TreadBlock.fmu

Exit codes:
  0  done
  1  a check found problems, or a comparison missed its limit
  2  wrong use, or the model could not go on";

/// A tyre's tread block that sticks, slips and squeals: simulate it, plot it, pack it as an FMU.
///
/// Numbers are in SI units everywhere. Parameters have dotted names such as friction.mu_inf; the same
/// names serve TOML files, --set and the FMU.
#[derive(Debug, Parser)]
#[command(name = "tread", version, after_long_help = EXAMPLES, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a block on a road as a TOML file says, and write everything that the FMU outputs as CSV
    Simulate(simulate::Arguments),
    /// Make the path of a flattened tyre belt through the contact patch, as CSV
    Belt(belt::Arguments),
    /// Write a commented TOML file to start from
    Init(init::Arguments),
    /// Tell all problems of a TOML file or belt path at once
    Check(check::Arguments),
    /// Draw the result of a run, or spectra of several, as SVG or PNG
    Plot(plot::Arguments),
    /// Print stick-slip frequency, amplitude, mean friction and stick fraction of a sliding run
    Metrics(metrics::Arguments),
    /// Fit friction, contact and damping to the paper's table of stick-slip frequencies
    Identify(identify::Arguments),
    /// Repeat the paper's studies on this model
    Study(study::Arguments),
    /// Run many points over any parameters: grid, one at a time, Latin hypercube, Sobol
    Sweep(sweep::Arguments),
    /// Build, describe or check the FMU
    Fmu(fmu::Arguments),
    /// Diagnose the gap between measurements and the model: where, which effect, how far
    Gap(gap::Arguments),
    /// Write the book's reference pages: command line, parameters, run files, signals
    Reference(reference::Arguments),
    /// Write a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// Parses the arguments, runs the command and says how it went.
pub fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Belt(arguments) => belt::run(&arguments),
        Command::Init(arguments) => init::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Metrics(arguments) => metrics::run(&arguments),
        Command::Identify(arguments) => identify::run(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Fmu(arguments) => fmu::run(&arguments),
        Command::Gap(arguments) => gap::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments, Arguments::command()),
        Command::Completions { shell } => completions(shell),
    };
    output::exit_code(result)
}

fn completions(shell: clap_complete::Shell) -> Result<Done, Stop> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "tread", &mut script);
    output::to_stdout(&script)?;
    Ok(Done::Fine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
