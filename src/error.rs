//! What can go wrong, as values: each names what, its value, the allowed range and the way out.

use std::fmt;
use std::io;
use std::path::Path;

/// One thing that is wrong with an input: a parameter, a key of a file, a column, a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Name of the offender, e.g. `rubber.poisson_ratio` or `column belt_x_m`.
    pub what: String,
    /// The value found, as the user wrote it.
    pub value: String,
    /// What would be accepted.
    pub allowed: String,
    /// What the user can do about it.
    pub remedy: String,
}

impl Problem {
    /// A problem from its four parts.
    pub fn new(
        what: impl Into<String>,
        value: impl Into<String>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            what: what.into(),
            value: value.into(),
            allowed: allowed.into(),
            remedy: remedy.into(),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: allowed is {}; {}", self.what, self.value, self.allowed, self.remedy)
    }
}

/// Why the model could not do what it was asked to.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// All problems of an input at once.
    #[error("{}", list(.0))]
    Invalid(Vec<Problem>),
    /// The contact solver found no solution at any admissible step size.
    #[error(
        "no convergence at t = {time} s with a step of {step} s (residual {residual} m/s after \
         {iterations} iterations): lower solver.max_step or check the inputs for jumps"
    )]
    NoConvergence {
        /// Time \[s\] up to which the solution is good.
        time: f64,
        /// Step size \[s\] that failed.
        step: f64,
        /// Remaining residual of the sliding velocities \[m/s\].
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
    /// The state left the range of finite numbers.
    #[error("{what} is not finite at t = {time} s: check the inputs for jumps")]
    NotFinite {
        /// First quantity found to be not finite.
        what: String,
        /// Time \[s\].
        time: f64,
    },
    /// A file could not be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// The system's reason.
        reason: String,
    },
}

impl Fault {
    /// A fault of one problem.
    pub fn one(problem: Problem) -> Self {
        Self::Invalid(vec![problem])
    }

    /// A file that could not be read or written: the system's reason, and what to do about it.
    pub fn file(path: &Path, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            io::ErrorKind::NotFound => "; look at its name, and at the folder that you are in",
            io::ErrorKind::IsADirectory => "; name a file in it",
            io::ErrorKind::NotADirectory => "; name a folder",
            io::ErrorKind::PermissionDenied => "; ask for the right, or choose another place",
            io::ErrorKind::InvalidData => "; save it as text in UTF-8",
            _ => "",
        };
        Self::unusable(path, format!("{error}{remedy}"))
    }

    /// A file, or what stands for one (`threads`, `standard output`), that is there and cannot be used.
    pub fn unusable(path: impl AsRef<Path>, reason: impl fmt::Display) -> Self {
        Self::File { path: path.as_ref().display().to_string(), reason: reason.to_string() }
    }
}

/// A number as short as it can be without losing a bit.
pub fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

fn list(problems: &[Problem]) -> String {
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("\n")
}
