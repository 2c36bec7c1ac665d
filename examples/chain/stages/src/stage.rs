//! What a stage is: a table of real variables, and how they move on.

/// Role of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Fixed before initialization.
    Parameter,
    /// Set by the master at communication points.
    Input,
    /// Told at communication points.
    Output,
}

/// One variable; its value reference is its place in the table.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Dotted name.
    pub name: String,
    /// Role.
    pub role: Role,
    /// SI unit.
    pub unit: &'static str,
    /// Start value [unit]; of an output 0.
    pub start: f64,
    /// Smallest and largest accepted value [unit].
    pub range: (f64, f64),
    /// What it is.
    pub doc: String,
}

impl Variable {
    /// A parameter.
    pub fn parameter(
        name: &str,
        unit: &'static str,
        start: f64,
        range: (f64, f64),
        doc: &str,
    ) -> Self {
        Self { name: name.into(), role: Role::Parameter, unit, start, range, doc: doc.into() }
    }

    /// An input.
    pub fn input(name: &str, unit: &'static str, doc: &str) -> Self {
        let range = (f64::MIN, f64::MAX);
        Self { name: name.into(), role: Role::Input, unit, start: 0.0, range, doc: doc.into() }
    }

    /// An output.
    pub fn output(name: &str, unit: &'static str, doc: &str) -> Self {
        Self { role: Role::Output, ..Self::input(name, unit, doc) }
    }
}

/// A model between inputs and outputs.
pub trait Stage: Clone + Send + Sized {
    /// Name of the model and of its library.
    const IDENTIFIER: &'static str;
    /// One sentence.
    const DESCRIPTION: &'static str;
    /// Highest order of [`Stage::derivative`].
    const DERIVATIVES: u32;
    /// Do input derivatives that the master sets have an effect?
    const TAKES_DERIVATIVES: bool;
    /// Communication step [s] that serves best.
    const STEP: f64;

    /// All variables.
    fn table() -> Vec<Variable>;

    /// The model at the start `time` [s]; writes the outputs into `values`, which follow the table.
    ///
    /// # Errors
    /// What is wrong with the parameters.
    fn start(values: &mut [f64], time: f64) -> Result<Self, String>;

    /// Moves on by `h` [s] and writes the outputs. `rates` are the derivatives that the master set.
    ///
    /// # Errors
    /// Why it cannot.
    fn step(
        &mut self,
        values: &mut [f64],
        rates: &[Option<f64>],
        time: f64,
        h: f64,
    ) -> Result<(), String>;

    /// Derivative of an output at the present communication point.
    fn derivative(&self, _output: usize, _order: u32) -> Option<f64> {
        None
    }
}
