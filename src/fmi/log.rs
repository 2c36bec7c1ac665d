//! Messages to the importer, in the standard's categories.

use super::Status;
use fmi_sys::fmi2;
use std::ffi::{CStr, CString};

/// Category of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// What happens: initialization, changed parameters, read files.
    Events,
    /// Answers fmi2Warning.
    Warning,
    /// Answers fmi2Discard.
    Discard,
    /// Answers fmi2Error.
    Error,
    /// Answers fmi2Fatal.
    Fatal,
    /// Everything.
    All,
}

impl Category {
    /// All categories, as the model description lists them.
    pub const ALL: [Self; 6] =
        [Self::Events, Self::Warning, Self::Discard, Self::Error, Self::Fatal, Self::All];

    /// The standard's name.
    pub fn name(self) -> &'static str {
        self.c_name().to_str().unwrap_or_default()
    }

    fn c_name(self) -> &'static CStr {
        match self {
            Self::Events => c"logEvents",
            Self::Warning => c"logStatusWarning",
            Self::Discard => c"logStatusDiscard",
            Self::Error => c"logStatusError",
            Self::Fatal => c"logStatusFatal",
            Self::All => c"logAll",
        }
    }

    /// What is told in it.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Events => "Initialization, changed parameters, files that are read",
            Self::Warning => "Reasons of fmi2Warning; always told",
            Self::Discard => "Reasons of fmi2Discard; always told",
            Self::Error => "Reasons of fmi2Error; always told",
            Self::Fatal => "Reasons of fmi2Fatal; always told",
            Self::All => "All messages",
        }
    }
}

/// The importer's logger and what it wants to hear.
#[derive(Clone)]
pub struct Log {
    logger: fmi2::fmi2CallbackLogger,
    environment: fmi2::fmi2ComponentEnvironment,
    name: CString,
    events: bool,
}

impl Log {
    /// A log for the instance `name`.
    pub fn new(functions: &fmi2::fmi2CallbackFunctions, name: CString, events: bool) -> Self {
        Self { logger: functions.logger, environment: functions.componentEnvironment, name, events }
    }

    /// Switches categories on or off; no category means all. Reasons of failures are always told.
    /// Returns the names that are no categories of this FMU.
    pub fn listen(&mut self, on: bool, categories: &[String]) -> Vec<String> {
        let is_named = |c: Category| categories.iter().any(|name| name == c.name());
        if categories.is_empty() || is_named(Category::Events) || is_named(Category::All) {
            self.events = on;
        }
        let known = |name: &&String| !Category::ALL.iter().any(|c| c.name() == name.as_str());
        categories.iter().filter(known).cloned().collect()
    }

    /// Tells what happened, if anyone listens; `text` is only made then.
    pub fn event(&self, text: impl FnOnce() -> String) {
        if self.events {
            self.tell(Status::Ok, Category::Events, &text());
        }
    }

    /// Tells why a call answers `status`.
    pub fn reason(&self, status: Status, text: &str) {
        let category = match status {
            Status::Ok => Category::Events,
            Status::Warning => Category::Warning,
            Status::Discard => Category::Discard,
            Status::Error => Category::Error,
            Status::Fatal => Category::Fatal,
        };
        self.tell(status, category, text);
    }

    #[allow(unsafe_code)]
    fn tell(&self, status: Status, category: Category, text: &str) {
        let Some(logger) = self.logger else { return };
        let clean: Vec<u8> = text.bytes().filter(|b| *b != 0).collect();
        let Ok(message) = CString::new(clean) else { return };
        // SAFETY: the logger is the importer's own function, valid until fmi2FreeInstance; all
        // strings live beyond the call. The message is an argument of "%s", never the format itself.
        unsafe {
            logger(
                self.environment,
                self.name.as_ptr(),
                status.code(),
                category.c_name().as_ptr(),
                c"%s".as_ptr(),
                message.as_ptr(),
            );
        }
    }
}
