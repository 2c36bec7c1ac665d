//! Where data and talk go, and what the exit code is.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

use crate::error::Fault;

/// How a command ended that could do its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Done {
    /// All is well.
    Fine,
    /// The work is done and its answer is no: a check found problems, a limit was missed.
    Problems,
    /// The work is done and its answer is this exit code.
    Code(u8),
}

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Stop {
    /// Wrong use, or the model could not go on.
    Fault(Fault),
    /// The reader of the standard output has left: nothing is wrong.
    PipeClosed,
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// The result as an exit code; a fault is told on the standard error.
pub fn exit_code(result: Result<Done, Stop>) -> ExitCode {
    match result {
        Ok(Done::Fine) | Err(Stop::PipeClosed) => ExitCode::SUCCESS,
        Ok(Done::Problems) => ExitCode::from(1),
        Ok(Done::Code(code)) => ExitCode::from(code),
        Err(Stop::Fault(fault)) => {
            match &fault {
                Fault::Invalid(problems) if problems.len() > 1 => {
                    eprintln!("tread: {} problems:", problems.len());
                    problems.iter().for_each(|problem| eprintln!("  {problem}"));
                }
                other => eprintln!("tread: {other}"),
            }
            ExitCode::from(2)
        }
    }
}

/// What a failed write to `path` means.
pub fn write_failed(path: &str, error: &io::Error) -> Stop {
    if error.kind() == io::ErrorKind::BrokenPipe {
        return Stop::PipeClosed;
    }
    Stop::Fault(Fault::file(Path::new(path), error))
}

/// A file if one is named (its folder is made), or else the standard output.
pub fn writer(path: Option<&Path>) -> Result<Box<dyn Write>, Stop> {
    let Some(path) = path else {
        return Ok(Box::new(BufWriter::new(io::stdout().lock())));
    };
    let failed = |e: io::Error| write_failed(&path.display().to_string(), &e);
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    Ok(Box::new(BufWriter::new(File::create(path).map_err(failed)?)))
}

/// Name of the target of [`writer`] for messages.
pub fn target(path: Option<&Path>) -> String {
    path.map_or_else(|| "standard output".to_string(), |p| p.display().to_string())
}

/// Writes data to the standard output.
pub fn to_stdout(bytes: &[u8]) -> Result<(), Stop> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| write_failed("standard output", &e))
}

/// Writes a document to the standard output, indented as people read it.
pub fn json_to_stdout(document: &serde_json::Value) -> Result<(), Stop> {
    to_stdout(format!("{document:#}\n").as_bytes())
}

/// Writes data to a file if one is named, or else to the standard output.
pub fn to(path: Option<&Path>, bytes: &[u8]) -> Result<(), Stop> {
    let mut out = writer(path)?;
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| write_failed(&target(path), &e))
}
