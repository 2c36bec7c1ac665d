//! `tread fmu`: build, describe and check the FMU.

use std::path::{Path, PathBuf};

use super::output::{self, Done, Stop};
use crate::error::{Fault, Problem};
use crate::fmi::package::{self, Library};
use crate::fmi::variables::{self, Variable};
use crate::fmi::{documentation, model_description};

const EXAMPLES: &str = "\
Examples:
  tread fmu build                                     packs the library beside `tread`
  tread fmu build --library linux64=a.so --library win64=b.dll --out out/TreadBlock.fmu
  tread fmu describe                                  all variables as a table
  tread fmu describe --format xml                     modelDescription.xml
  tread fmu check out/TreadBlock.fmu";

/// What was typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Pack the FMU; `make fmu` does it with a library for old systems too
    Build(Build),
    /// List all variables with unit, start, range and meaning
    Describe {
        /// table, csv, xml (modelDescription.xml) or html (the FMU's documentation)
        #[arg(long, default_value = "table", conflicts_with = "json")]
        format: Format,
        /// Print JSON instead of a table
        #[arg(long)]
        json: bool,
    },
    /// Say what is wrong with an FMU of this model
    Check {
        /// The FMU
        #[arg(default_value = "out/TreadBlock.fmu")]
        fmu: PathBuf,
        /// Tell the problems as JSON
        #[arg(long)]
        json: bool,
    },
}

/// What goes into the FMU.
#[derive(Debug, clap::Args)]
pub struct Build {
    /// A library to pack; may be repeated. If none is given: the one built along with `tread`
    #[arg(long, value_name = "PLATFORM=FILE")]
    library: Vec<String>,
    /// The FMU to write
    #[arg(long, default_value = "out/TreadBlock.fmu")]
    out: PathBuf,
}

/// How the variables are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// For reading.
    Table,
    /// For a spreadsheet.
    Csv,
    /// `modelDescription.xml`.
    Xml,
    /// `documentation/index.html`.
    Html,
}

/// Does what was typed.
pub fn run(arguments: &Arguments) -> Result<Done, Stop> {
    match &arguments.command {
        Command::Build(options) => {
            let path = build(options)?;
            eprintln!("packed {}", path.display());
        }
        Command::Describe { json: true, .. } => {
            output::to_stdout(json(&variables::all()).as_bytes())?;
        }
        Command::Describe { format, .. } => output::to_stdout(describe(*format)?.as_bytes())?,
        Command::Check { fmu, json } => {
            return super::check::tell(fmu, "FMU", &package::problems(fmu)?, *json)
        }
    }
    Ok(Done::Fine)
}

/// Packs the FMU and says where it is.
pub fn build(options: &Build) -> Result<PathBuf, Fault> {
    let libraries = if options.library.is_empty() {
        vec![beside_this_program()?]
    } else {
        options.library.iter().map(|text| library(text)).collect::<Result<_, _>>()?
    };
    let bytes = package::pack(&libraries)?;
    let failed = |e: std::io::Error| Fault::file(&options.out, &e);
    if let Some(folder) = options.out.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    std::fs::write(&options.out, bytes).map_err(failed)?;
    Ok(options.out.clone())
}

/// A library as `--library` names it.
fn library(text: &str) -> Result<Library, Fault> {
    let Some((platform, file)) = text.split_once('=') else {
        return Err(Fault::one(Problem::new(
            "--library",
            text,
            "PLATFORM=FILE",
            "write for example linux64=target/release/libtread_block.so",
        )));
    };
    Ok(Library { platform: platform.to_string(), file: file.into() })
}

/// The library that cargo builds along with this program.
pub(super) fn beside_this_program() -> Result<Library, Fault> {
    let (platform, name) = if cfg!(windows) {
        ("win64", "tread_block.dll")
    } else if cfg!(target_os = "macos") {
        ("darwin64", "libtread_block.dylib")
    } else {
        ("linux64", "libtread_block.so")
    };
    let folder = std::env::current_exe().ok().and_then(|exe| exe.parent().map(Path::to_path_buf));
    let file = folder.unwrap_or_default().join(name);
    if file.is_file() {
        return Ok(Library { platform: platform.to_string(), file });
    }
    Err(Fault::one(Problem::new(
        "library",
        file.display().to_string(),
        "an existing file",
        "run `cargo build --release` first, or name it with --library",
    )))
}

/// All variables in the wanted format.
pub fn describe(format: Format) -> Result<String, Fault> {
    Ok(match format {
        Format::Xml => model_description::xml(),
        Format::Html => documentation::html(),
        Format::Table => table(&variables::all()),
        Format::Csv => csv(&variables::all())?,
    })
}

fn unit(variable: &Variable) -> &'static str {
    variable.unit().map_or("", |(unit, _)| unit)
}

fn table(variables: &[Variable]) -> String {
    let mut out = String::new();
    let mut causality = "";
    for variable in variables {
        if variable.causality() != causality {
            causality = variable.causality();
            out += &format!("\n{causality}s\n");
        }
        out += &format!(
            "  {:<32} {:<6} {:>9}  {}\n",
            variable.name,
            unit(variable),
            variable.start().unwrap_or_default(),
            variable.doc
        );
        let range = documentation::range(variable);
        if !range.is_empty() {
            out += &format!("  {:<32} {}, {range}\n", "", variable.variability());
        }
    }
    out.trim_start().to_string()
}

fn csv(variables: &[Variable]) -> Result<String, Fault> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = [
        "name",
        "reference",
        "type",
        "causality",
        "variability",
        "unit",
        "start",
        "range",
        "meaning",
    ];
    let failed = |e: csv::Error| Fault::unusable("standard output", e);
    writer.write_record(header).map_err(failed)?;
    for (reference, variable) in variables.iter().enumerate() {
        let record = [
            variable.name.clone(),
            reference.to_string(),
            variable.kind().name().to_string(),
            variable.causality().to_string(),
            variable.variability().to_string(),
            unit(variable).to_string(),
            variable.start().unwrap_or_default(),
            documentation::range(variable),
            variable.doc.to_string(),
        ];
        writer.write_record(record).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|e| Fault::unusable("standard output", e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn json(variables: &[Variable]) -> String {
    let list: Vec<_> = variables
        .iter()
        .enumerate()
        .map(|(reference, variable)| {
            serde_json::json!({
                "name": variable.name,
                "reference": reference,
                "type": variable.kind().name(),
                "causality": variable.causality(),
                "variability": variable.variability(),
                "unit": unit(variable),
                "start": variable.start(),
                "range": documentation::range(variable),
                "meaning": variable.doc,
            })
        })
        .collect();
    format!("{}\n", serde_json::Value::from(list))
}
