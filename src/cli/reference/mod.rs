//! `tread reference`: pages of the book that are made from the code and so cannot drift from it.

mod formats;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::block::{INPUTS, OUTPUTS};
use crate::error::number;
use crate::params::{table, Kind, ParamSpec, Params, Value, Variability};
use crate::scenario::run_table::{KEYS, TEXT_KEYS};

/// What was typed.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Folder to write the pages to
    #[arg(default_value = "docs/src/reference")]
    folder: PathBuf,
}

/// Writes all pages.
pub fn run(arguments: &Arguments, command: clap::Command) -> Result<Done, Stop> {
    let pages = [
        ("command-line.md", command_line(command)),
        ("parameters.md", parameters()),
        ("run-files.md", run_files()),
        ("signals.md", signals()),
        ("campaigns.md", formats::campaigns()),
        ("diagnosis.md", formats::diagnosis()),
    ];
    for (name, text) in pages {
        let file = arguments.folder.join(name);
        output::to(Some(Path::new(&file)), text.as_bytes())?;
        eprintln!("{}", file.display());
    }
    Ok(Done::Fine)
}

/// The help of all commands.
fn command_line(command: clap::Command) -> String {
    let mut page =
        String::from("# Command line\n\nWhat `tread --help` and the commands' own help say.\n");
    let mut command = command.term_width(92);
    command.build();
    help(&mut command, "", &mut page);
    page
}

/// The long help of a command and of those below it.
fn help(command: &mut clap::Command, above: &str, page: &mut String) {
    let name = format!("{above}{}", command.get_name());
    let text = command.render_long_help().to_string();
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let _ = write!(page, "\n## {name}\n\n```text\n{}\n```\n", lines.join("\n").trim_end());
    for inner in command.get_subcommands_mut().filter(|c| c.get_name() != "help") {
        help(inner, &format!("{name} "), page);
    }
}

fn parameters() -> String {
    let mut page = String::from(
        "# Parameters\n\nDotted names serve TOML files, `--set` and the FMU alike. All values are in SI \
         units. *Tunable* parameters may change between communication steps, the others are fixed \
         once a run has begun.\n",
    );
    let defaults = Params::default();
    let mut section = "";
    for spec in table::specs() {
        let head = spec.name.rsplit_once('.').map_or("", |(head, _)| head);
        if head != section {
            let _ = write!(
                page,
                "\n## {head}\n\n| name | unit | default | allowed | | meaning |\n|---|---|---|---|---|---|\n"
            );
            section = head;
        }
        let _ = writeln!(page, "{}", parameter_row(spec, &defaults));
    }
    page
}

fn parameter_row(spec: &ParamSpec, defaults: &Params) -> String {
    let (unit, allowed) = match spec.kind {
        Kind::Real { unit, min, max, .. } => (unit, format!("{} to {}", number(min), number(max))),
        Kind::Integer { min, max } => ("1", format!("{min} to {max}")),
        Kind::Enumeration { .. } => ("", "one of these".to_string()),
        Kind::Boolean => ("", "true, false".to_string()),
        Kind::Text => ("", "text".to_string()),
    };
    let default = match (spec.get)(defaults) {
        Value::Real(x) => number(x),
        other => table::show(spec, &other),
    };
    let default = if default.is_empty() { "none".to_string() } else { format!("`{default}`") };
    let tunable = if spec.variability == Variability::Tunable { "tunable" } else { "" };
    let doc = escape(&meaning(spec));
    format!("| `{}` | {unit} | {default} | {allowed} | {tunable} | {doc} |", spec.name)
}

/// What a parameter is, and what each of its choices is.
fn meaning(spec: &ParamSpec) -> String {
    let Kind::Enumeration { items, .. } = spec.kind else { return spec.doc.to_string() };
    let items: Vec<String> = items.iter().map(|i| format!("`{}`: {}", i.name, i.doc)).collect();
    format!("{}. {}", spec.doc, items.join("; "))
}

fn run_files() -> String {
    let mut page = String::from(
        "# Files of runs\n\nA run is a TOML file with the [parameters](parameters.md) that differ from \
         their defaults and a table `[run]`, with `[run.slide]` or `[run.roll]` in it. \
         `tread init` writes one, `tread check` tells all its problems.\n\n\
         | key | unit | default | allowed | meaning |\n|---|---|---|---|---|\n",
    );
    for key in KEYS {
        let default = key.default.map_or(String::new(), |d| format!("`{}`", number(d)));
        let _ = writeln!(
            page,
            "| `run.{}` | {} | {default} | {} to {} | {} |",
            key.name,
            key.unit,
            number(key.min),
            number(key.max),
            escape(key.doc)
        );
    }
    for (name, allowed, doc) in TEXT_KEYS {
        let _ = writeln!(page, "| `run.{name}` | | | {allowed} | {} |", escape(doc));
    }
    page
}

fn signals() -> String {
    let mut page = String::from(
        "# Inputs and outputs\n\nOf the FMU, and columns of the CSV that `tread simulate` writes.\n\n\
         ## Inputs\n\n| name | unit | meaning |\n|---|---|---|\n",
    );
    for spec in INPUTS {
        let _ = writeln!(page, "| `{}` | {} | {} |", spec.name, spec.unit, escape(spec.doc));
    }
    page.push_str("\n## Outputs\n\n| name | unit | meaning |\n|---|---|---|\n");
    for spec in OUTPUTS {
        let index = if spec.size > 1 { format!("[1..{}]", spec.size) } else { String::new() };
        let doc = escape(spec.doc);
        let _ = writeln!(page, "| `{}{index}` | {} | {doc} |", spec.name, spec.unit);
    }
    page
}

/// Text within a cell of a Markdown table.
fn escape(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_key_and_signal_is_on_its_page() {
        let page = parameters();
        assert!(table::specs().all(|spec| page.contains(&format!("| `{}` |", spec.name))));
        let page = run_files();
        assert!(KEYS.iter().all(|key| page.contains(&format!("| `run.{}` |", key.name))));
        let page = signals();
        assert!(OUTPUTS.iter().all(|spec| page.contains(&format!("| `{}", spec.name))));
    }
}
