//! The parameters as the importer builds them up: defaults, files, then single values on top.

use super::uri;
use super::Refusal;
use crate::error::Fault;
use crate::params::{check, load, table, ParamSpec, Params, Value};
use std::path::Path;

/// Name of the parameter file that is read from the FMU's resources.
pub const RESOURCE_FILE: &str = "parameters.toml";

/// Parameters and where they came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Defaults and the resources' file.
    base: Params,
    /// Parameters in force.
    params: Params,
    /// Which parameters were set one by one.
    given: Vec<bool>,
    /// The parameter `parameter_file`.
    file: String,
}

impl Settings {
    /// Defaults, overlaid with the resources' parameter file where there is one.
    pub fn new(resources: Option<&Path>) -> Result<Self, Refusal> {
        let file = resources.map(|folder| folder.join(RESOURCE_FILE)).filter(|path| path.is_file());
        let base = match file {
            Some(path) => overlay(&path, Params::default())?,
            None => Params::default(),
        };
        let given = vec![false; table::specs().count()];
        Ok(Self { params: base.clone(), base, given, file: String::new() })
    }

    /// Back to what [`Self::new`] gave.
    pub fn reset(&mut self) {
        self.params = self.base.clone();
        self.given.fill(false);
        self.file.clear();
    }

    /// The parameters in force.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Value of one parameter.
    pub fn get(&self, spec: &ParamSpec) -> Value {
        (spec.get)(&self.params)
    }

    /// Sets one parameter; refuses a value out of its range.
    pub fn set(&mut self, index: usize, spec: &ParamSpec, value: &Value) -> Result<(), Refusal> {
        if let Some(problem) = check::value(spec, value) {
            return Err(Refusal::error(problem.to_string()));
        }
        (spec.set)(&mut self.params, value);
        self.given[index] = true;
        Ok(())
    }

    /// The parameter `parameter_file`.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Reads a parameter file; values set one by one stay on top of it.
    pub fn set_file(&mut self, name: &str, resources: Option<&Path>) -> Result<(), Refusal> {
        let mut params = self.base.clone();
        if !name.is_empty() {
            params = overlay(&uri::resolve(name, resources), params)?;
        }
        for (spec, _) in table::specs().zip(&self.given).filter(|(_, given)| **given) {
            (spec.set)(&mut params, &(spec.get)(&self.params));
        }
        self.params = params;
        self.file = name.to_string();
        Ok(())
    }

    /// Which parameters were set one by one.
    pub fn given(&self) -> &[bool] {
        &self.given
    }

    /// Takes over what was stored of another instance's settings.
    pub fn restore(&mut self, params: Params, given: Vec<bool>, file: String) {
        self.params = params;
        self.given = given;
        self.file = file;
    }
}

/// Largest parameter file \[bytes\]; all parameters with a page of comment each are a tenth of it.
const MAX_FILE: u64 = 1 << 20;

fn overlay(path: &Path, params: Params) -> Result<Params, Refusal> {
    let problem = |reason: String| Refusal::error(format!("{}: {reason}", path.display()));
    // A pipe or a device would keep the importer waiting, a film would fill its memory.
    let about = std::fs::metadata(path).map_err(|e| problem(e.to_string()))?;
    if !about.is_file() || about.len() > MAX_FILE {
        return Err(problem(format!(
            "a file of {} bytes: allowed is a regular file of up to {MAX_FILE} bytes; name a file with \
             parameters",
            about.len()
        )));
    }
    let text = std::fs::read_to_string(path).map_err(|e| problem(e.to_string()))?;
    let document: toml::Table = text.parse().map_err(|e| problem(load::syntax(&e).to_string()))?;
    let (params, problems) = load::from_table(&document, params);
    if problems.is_empty() {
        Ok(params)
    } else {
        Err(problem(Fault::Invalid(problems).to_string()))
    }
}
