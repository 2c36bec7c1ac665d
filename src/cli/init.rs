//! `tread init`: a commented TOML file to start from.

use std::path::PathBuf;

use super::output::{self, Done, Stop};
use crate::params::{load, NormalDrive, Params};
use crate::scenario::run_table::{Key, KEYS, TEXT_KEYS};

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// What is done to the block
    #[arg(default_value = "slide")]
    kind: Kind,
    /// File to write; the standard output if not given
    #[arg(long, short)]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// Dragged over a road under a load
    Slide,
    /// Rolled through the contact patch of a tyre
    Roll,
}

/// Writes the file.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    output::to(arguments.out.as_deref(), text(arguments.kind).as_bytes())?;
    Ok(Done::Fine)
}

fn text(kind: Kind) -> String {
    let (table, given): (_, &[(&str, &str)]) = match kind {
        Kind::Slide => (
            "slide",
            &[("duration", "0.03"), ("slide.speed", "0.3"), ("slide.mean_pressure", "250e3")],
        ),
        Kind::Roll => ("roll", &[("roll.belt_speed", "15.0"), ("roll.slip", "0.02")]),
    };
    let mut out = String::from(
        "# A run of the tread block. Numbers are in SI units. `tread check` tells all problems of this\n\
         # file at once, `tread simulate` runs it. Keys that are commented out show their defaults or\n\
         # an alternative; any key may be left out but those of [run] that have no default.\n\n[run]\n",
    );
    out.push_str(&number_lines("", given));
    out.push_str(&text_lines(""));
    out.push_str(&format!("\n[run.{table}]\n"));
    out.push_str(&number_lines(&format!("{table}."), given));
    out.push_str(&text_lines(&format!("{table}.")));
    let mut params = Params::default();
    params.drive.normal = match kind {
        Kind::Slide => NormalDrive::Load,
        Kind::Roll => NormalDrive::Trajectory,
    };
    out.push('\n');
    out.push_str(&load::to_toml(&params));
    out
}

fn number_lines(prefix: &str, given: &[(&str, &str)]) -> String {
    own(prefix)
        .map(|(key, short)| {
            let unit = if key.unit == "1" { String::new() } else { format!("[{}] ", key.unit) };
            let value = given.iter().find(|(name, _)| *name == key.name).map(|g| g.1.to_string());
            let comment = if value.is_some() { "" } else { "# " };
            let value = value
                .or_else(|| key.default.map(|d| format!("{d:?}")))
                .unwrap_or_else(|| "...".to_string());
            format!("{comment}{short} = {value}  # {unit}{}\n", key.doc)
        })
        .collect()
}

/// Keys directly in the table of this prefix, with their names in it.
fn own(prefix: &str) -> impl Iterator<Item = (&'static Key, &'static str)> + '_ {
    KEYS.iter()
        .filter_map(move |key| key.name.strip_prefix(prefix).map(|short| (key, short)))
        .filter(|(_, short)| !short.contains('.'))
}

fn text_lines(prefix: &str) -> String {
    TEXT_KEYS
        .iter()
        .filter_map(|(name, allowed, doc)| name.strip_prefix(prefix).map(|s| (s, allowed, doc)))
        .filter(|(short, ..)| !short.contains('.'))
        .map(|(short, allowed, doc)| {
            let first = allowed.split(',').next().unwrap_or("");
            format!("# {short} = {first:?}  # {doc} ({allowed})\n")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::config;

    #[test]
    fn what_init_writes_can_be_read() {
        for kind in [Kind::Slide, Kind::Roll] {
            let config = config::from_toml(&text(kind), std::path::Path::new("."), &[]).unwrap();
            assert_eq!(config.params.drive.normal, config.scenario.normal_drive());
        }
    }
}
