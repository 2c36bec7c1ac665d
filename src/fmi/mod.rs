//! The FMI 2.0 co-simulation face of the block: what an importer sees of it.
//!
//! One table of variables feeds the getters and setters, `modelDescription.xml`, `tread fmu describe`
//! and the documentation. The C functions are thin; the state machine is a table in the order of the
//! standard's own.

pub mod calculated;
pub mod documentation;
#[allow(unsafe_code)]
pub mod exports;
mod inputs;
mod instance;
mod log;
mod model;
pub mod model_description;
#[cfg(feature = "cli")]
pub mod package;
pub mod phase;
#[cfg(feature = "cli")]
pub mod reference;
mod settings;
mod state;
mod stepping;
pub mod units;
pub mod uri;
pub mod variables;

/// Name of the model and of its binaries.
pub const MODEL_IDENTIFIER: &str = "TreadBlock";

/// What a function of the interface answers, as the standard's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Done.
    Ok,
    /// Done, with something that the user should know.
    Warning,
    /// Done in part (a step) or not available (a status inquiry).
    Discard,
    /// Not done; the values are those of before.
    Error,
    /// The instance is beyond repair.
    Fatal,
}

impl Status {
    /// The number that goes through the C interface.
    pub fn code(self) -> fmi_sys::fmi2::fmi2Status {
        use fmi_sys::fmi2 as c;
        match self {
            Self::Ok => c::fmi2Status_fmi2OK,
            Self::Warning => c::fmi2Status_fmi2Warning,
            Self::Discard => c::fmi2Status_fmi2Discard,
            Self::Error => c::fmi2Status_fmi2Error,
            Self::Fatal => c::fmi2Status_fmi2Fatal,
        }
    }
}

/// Why a call was not done: what it answers and what the log says.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The answer.
    pub status: Status,
    /// The reason, for a person.
    pub reason: String,
}

impl Refusal {
    /// An error.
    pub fn error(reason: impl Into<String>) -> Self {
        Self { status: Status::Error, reason: reason.into() }
    }

    /// Something that cannot be given.
    pub fn discard(reason: impl Into<String>) -> Self {
        Self { status: Status::Discard, reason: reason.into() }
    }

    /// Done, but worth a word.
    pub fn warning(reason: impl Into<String>) -> Self {
        Self { status: Status::Warning, reason: reason.into() }
    }
}

impl From<crate::error::Fault> for Refusal {
    fn from(fault: crate::error::Fault) -> Self {
        Self::error(fault.to_string())
    }
}
