//! One instance of the FMU: everything that it owns, and what each call does with it.

use super::inputs::Inputs;
use super::log::Log;
use super::model::Model;
use super::model_description::{guid, OUTPUT_DERIVATIVE_ORDER};
use super::phase::Phase;
use super::settings::Settings;
use super::stepping::Clock;
use super::variables::{self, Source, Type, Variable};
use super::Refusal;
use crate::block::{OutputSpec, Outputs, OUTPUTS};
use crate::drive::Predictor;
use crate::params::{Value, Variability};
use std::ffi::CString;
use std::path::PathBuf;

/// An instance.
pub struct Instance {
    /// The importer's ear.
    pub(super) log: Log,
    /// Where it stands in the state machine.
    pub(super) phase: Phase,
    pub(super) variables: Vec<Variable>,
    pub(super) guid: String,
    pub(super) settings: Settings,
    pub(super) inputs: Inputs,
    pub(super) clock: Clock,
    pub(super) predictor: Predictor,
    pub(super) model: Model,
    /// All outputs at the start of the last step.
    pub(super) before: Vec<f64>,
    resources: Option<PathBuf>,
    /// Texts handed out by `fmi2GetString`, one per variable.
    texts: Vec<CString>,
}

impl Instance {
    /// A new instance.
    pub fn new(log: Log, resources: Option<PathBuf>) -> Result<Self, Refusal> {
        let variables = variables::all();
        let settings = Settings::new(resources.as_deref())?;
        Ok(Self {
            log,
            phase: Phase::Instantiated,
            guid: guid(&variables),
            settings,
            inputs: Inputs::default(),
            clock: Clock::default(),
            predictor: Predictor::default(),
            model: Model::default(),
            before: vec![0.0; OUTPUTS.iter().map(|spec| spec.size).sum()],
            resources,
            texts: vec![CString::default(); variables.len()],
            variables,
        })
    }

    /// `fmi2Reset`: as new; only the pristine block is kept, because it is costly and the same.
    pub fn reset(&mut self) {
        self.phase = Phase::Instantiated;
        self.settings.reset();
        self.inputs = Inputs::default();
        self.clock = Clock::default();
        self.predictor = Predictor::default();
        self.model.forget();
        self.before.fill(0.0);
    }

    /// `fmi2ExitInitializationMode`: the block rests under the inputs set so far.
    pub fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.outputs_ready()?;
        self.phase = Phase::StepComplete;
        self.log.event(|| format!("initialized at t = {} s", self.clock.time));
        Ok(())
    }

    /// Builds the block if outputs are asked for in initialization mode.
    fn outputs_ready(&mut self) -> Result<&Outputs, Refusal> {
        if self.phase == Phase::Initialization {
            return self.model.at_rest(self.settings.params(), self.clock.start, self.inputs.pose);
        }
        self.model.outputs().ok_or_else(|| {
            Refusal::error("outputs are not known before fmi2ExitInitializationMode")
        })
    }

    fn find(&self, reference: u32, kind: Type) -> Result<usize, Refusal> {
        let at = reference as usize;
        match self.variables.get(at) {
            Some(variable) if variable.kind() == kind => Ok(at),
            Some(variable) => Err(Refusal::error(format!(
                "value reference {reference} is {}, a variable of type {}, not {}; use \
                 fmi2Get{2}/fmi2Set{2} for it",
                variable.name,
                kind_of(variable),
                kind.name()
            ))),
            None => Err(Refusal::error(format!(
                "value reference {reference} is no variable of this FMU: allowed is 0 to {}; see \
                 modelDescription.xml",
                self.variables.len() - 1
            ))),
        }
    }

    /// `fmi2GetReal` of one variable.
    pub fn real(&mut self, reference: u32) -> Result<f64, Refusal> {
        let at = self.find(reference, Type::Real)?;
        match self.variables[at].source {
            Source::Input(_, spec) => Ok((spec.get)(&self.inputs.pose)),
            Source::Output(spec, i) => Ok((spec.get)(self.outputs_ready()?, i)),
            Source::Calculated(spec) => Ok((spec.get)(self.settings.params())),
            Source::Parameter(_, spec) => match self.settings.get(spec) {
                Value::Real(x) => Ok(x),
                _ => Err(Refusal::error(format!("{} holds no number", spec.name))),
            },
            Source::ParameterFile => Err(Refusal::error("parameter_file holds no number")),
        }
    }

    /// `fmi2SetReal` of one variable.
    pub fn set_real(&mut self, reference: u32, value: f64) -> Result<(), Refusal> {
        let at = self.find(reference, Type::Real)?;
        match self.variables[at].source {
            Source::Input(_, spec) => self.inputs.set(spec, value),
            _ => self.set_parameter(at, &Value::Real(value)),
        }
    }

    /// `fmi2GetInteger`, `fmi2GetBoolean` of one variable.
    pub fn value(&self, reference: u32, kind: Type) -> Result<Value, Refusal> {
        let at = self.find(reference, kind)?;
        match self.variables[at].source {
            Source::Parameter(_, spec) => Ok(self.settings.get(spec)),
            _ => Ok(Value::Text(self.settings.file().to_string())),
        }
    }

    /// `fmi2SetInteger`, `fmi2SetBoolean`, `fmi2SetString` of one variable.
    pub fn set_value(&mut self, reference: u32, kind: Type, value: &Value) -> Result<(), Refusal> {
        let at = self.find(reference, kind)?;
        self.set_parameter(at, value)
    }

    /// `fmi2GetString` of one variable; the text lives until the next call.
    pub fn text(&mut self, reference: u32) -> Result<*const std::ffi::c_char, Refusal> {
        let Value::Text(text) = self.value(reference, Type::Text)? else {
            return Err(Refusal::error(format!("value reference {reference} holds no text")));
        };
        let slot = &mut self.texts[reference as usize];
        *slot = CString::new(text).unwrap_or_default();
        Ok(slot.as_ptr())
    }

    fn set_parameter(&mut self, at: usize, value: &Value) -> Result<(), Refusal> {
        let variable = &self.variables[at];
        let running = self.phase == Phase::StepComplete;
        match variable.source {
            Source::Parameter(index, spec) => {
                if running && spec.variability == Variability::Fixed {
                    return Err(self.fixed(at));
                }
                self.settings.set(index, spec, value)
            }
            Source::ParameterFile if running => Err(self.fixed(at)),
            Source::ParameterFile => {
                let Value::Text(name) = value else {
                    return Err(Refusal::error("parameter_file takes a text"));
                };
                self.settings.set_file(name, self.resources.as_deref())?;
                self.log.event(|| format!("parameter_file {name:?} is read"));
                Ok(())
            }
            _ => Err(Refusal::error(format!(
                "{} is {} and cannot be set: allowed are inputs and parameters",
                variable.name,
                if variable.causality() == "output" { "an output" } else { "calculated" }
            ))),
        }
    }

    /// What setting these variables may change, to be put back if one of them is refused. Inputs alone,
    /// as before every step, cost a copy of a few numbers.
    pub(super) fn settable(&self, references: &[u32]) -> (Inputs, Option<Settings>) {
        let is_input = |vr: &u32| {
            let variable = self.variables.get(*vr as usize);
            matches!(variable.map(|v| v.source), Some(Source::Input(..)))
        };
        let only_inputs = references.len() < 2 || references.iter().all(is_input);
        (self.inputs, (!only_inputs).then(|| self.settings.clone()))
    }

    /// Undoes the sets since [`Self::settable`].
    pub(super) fn put_back(&mut self, (inputs, settings): (Inputs, Option<Settings>)) {
        self.inputs = inputs;
        if let Some(settings) = settings {
            self.settings = settings;
        }
    }

    fn fixed(&self, at: usize) -> Refusal {
        Refusal::error(format!(
            "{} is a fixed parameter: it may be set until fmi2ExitInitializationMode; call fmi2Reset \
             to set it anew (tunable parameters may change between steps)",
            self.variables[at].name
        ))
    }

    /// `fmi2SetRealInputDerivatives` of one input.
    pub fn set_input_derivative(
        &mut self,
        reference: u32,
        order: i32,
        value: f64,
    ) -> Result<(), Refusal> {
        let at = self.find(reference, Type::Real)?;
        match self.variables[at].source {
            Source::Input(input, _) => self.inputs.set_derivative(input, order, value),
            _ => Err(Refusal::error(format!("{} is no input", self.variables[at].name))),
        }
    }

    /// `fmi2GetRealOutputDerivatives` of one output: the velocity where there is one, else the
    /// difference over the last communication step; 0 before the first step.
    pub fn output_derivative(&mut self, reference: u32, order: i32) -> Result<f64, Refusal> {
        let at = self.find(reference, Type::Real)?;
        let Source::Output(spec, i) = self.variables[at].source else {
            return Err(Refusal::error(format!("{} is no output", self.variables[at].name)));
        };
        if order != OUTPUT_DERIVATIVE_ORDER {
            return Err(Refusal::error(format!(
                "order {order} of the derivative of {}: allowed is {OUTPUT_DERIVATIVE_ORDER}",
                self.variables[at].name
            )));
        }
        let before = self.before[position(spec, i)];
        let last_step = self.clock.last_step;
        let outputs = self.outputs_ready()?;
        if let Some(velocity) = velocity_of(spec) {
            return Ok((velocity.get)(outputs, i));
        }
        let change = (spec.get)(outputs, i) - before;
        Ok(if last_step > 0.0 { change / last_step } else { 0.0 })
    }
}

fn kind_of(variable: &Variable) -> &'static str {
    variable.kind().name()
}

/// Place of an output's element among all elements of all outputs.
fn position(spec: &OutputSpec, element: usize) -> usize {
    let before = OUTPUTS.iter().take_while(|other| other.name != spec.name);
    before.map(|other| other.size).sum::<usize>() + element
}

/// The output that is the exact rate of `spec`, e.g. `run_in.velocity.x` of `run_in.displacement.x`.
fn velocity_of(spec: &OutputSpec) -> Option<&'static OutputSpec> {
    let (edge, axis) = spec.name.split_once(".displacement.")?;
    OUTPUTS.iter().find(|other| other.name.split_once(".velocity.") == Some((edge, axis)))
}
