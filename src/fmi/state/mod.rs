//! The FMU state as bytes: what `fmi2GetFMUstate` keeps is what `fmi2SerializeFMUstate` writes.
//!
//! A header and the payload. Numbers are stored by their bits, so a run resumes bit for bit.

mod bytes;
mod header;

pub use header::payload;

use super::inputs::Inputs;
use super::instance::Instance;
use super::phase::Phase;
use super::stepping::Clock;
use super::Refusal;
use crate::drive::{Pose, Predictor};
use crate::params::{table, Params};
use bytes::{Reader, Writer};
use header::with_header;

/// A stored state.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored(pub Vec<u8>);

/// Everything of `instance` that can change.
pub fn store(instance: &Instance) -> Stored {
    let mut payload = Writer::default();
    payload.u8(instance.phase as u8);
    let Clock { start, stop, time, last_successful, last_step } = instance.clock;
    payload.reals(&[start, time, last_successful, last_step]);
    payload.option(stop);
    payload.pose(instance.inputs.pose);
    for derivative in instance.inputs.derivatives.iter().flatten() {
        payload.option(*derivative);
    }
    payload.option(instance.inputs.last.map(|(time, _)| time));
    payload.pose(instance.inputs.last.map_or(Pose::default(), |(_, pose)| pose));
    let mut numbers = Vec::with_capacity(Predictor::SAVED);
    instance.predictor.save(&mut numbers);
    payload.list(&numbers);
    payload.list(&instance.before);
    payload.text(instance.settings.file());
    for (spec, given) in table::specs().zip(instance.settings.given()) {
        payload.u8(u8::from(*given));
        payload.value(&instance.settings.get(spec));
    }
    // In initialization mode the block follows from the inputs and is built again when needed.
    let running = !matches!(instance.phase, Phase::Instantiated | Phase::Initialization);
    let block = instance.model.block().filter(|_| running);
    payload.u8(u8::from(block.is_some()));
    if let Some(block) = block {
        for spec in table::specs() {
            payload.value(&(spec.get)(block.params()));
        }
        let mut numbers = Vec::new();
        block.save(&mut numbers);
        payload.list(&numbers);
    }
    Stored(with_header(&instance.guid, &payload.0))
}

/// Puts `instance` where it was when `stored` was made; on refusal it is left as it was.
pub fn restore(instance: &mut Instance, stored: &Stored) -> Result<(), Refusal> {
    let bytes = payload(&instance.guid, &stored.0)?;
    let damaged = || Refusal::error("no usable FMU state: its content does not fit this FMU");
    let read = Contents::read(&mut Reader(bytes), instance.before.len()).ok_or_else(damaged)?;
    match &read.block {
        Some((params, numbers)) => instance.model.resume(params, numbers)?,
        None => instance.model.forget(),
    }
    instance.phase = read.phase;
    instance.clock = read.clock;
    instance.inputs = read.inputs;
    instance.predictor = read.predictor;
    instance.before.copy_from_slice(&read.before);
    instance.settings.restore(read.params, read.given, read.file);
    Ok(())
}

/// What a payload says, in its order.
struct Contents {
    phase: Phase,
    clock: Clock,
    inputs: Inputs,
    predictor: Predictor,
    before: Vec<f64>,
    file: String,
    params: Params,
    given: Vec<bool>,
    block: Option<(Params, Vec<f64>)>,
}

impl Contents {
    fn read(from: &mut Reader<'_>, outputs: usize) -> Option<Self> {
        let phase = Phase::from_number(from.u8()?)?;
        let [start, time, last_successful, last_step] = from.reals()?;
        let clock = Clock { start, stop: from.option()?, time, last_successful, last_step };
        let mut inputs = Inputs { pose: from.pose()?, ..Inputs::default() };
        for derivative in inputs.derivatives.iter_mut().flatten() {
            *derivative = from.option()?;
        }
        let last_time = from.option()?;
        let last_pose = from.pose()?;
        inputs.last = last_time.map(|time| (time, last_pose));
        let predictor = Predictor::restore(&from.list()?)?;
        let before = from.list().filter(|list| list.len() == outputs)?;
        let file = from.text()?;
        let (mut params, mut given) = (Params::default(), Vec::new());
        for spec in table::specs() {
            given.push(from.u8()? != 0);
            from.value().filter(|value| (spec.set)(&mut params, value))?;
        }
        let block = match from.u8()? {
            0 => None,
            _ => {
                let mut params = Params::default();
                for spec in table::specs() {
                    from.value().filter(|value| (spec.set)(&mut params, value))?;
                }
                Some((params, from.list()?))
            }
        };
        let needs_block = !matches!(phase, Phase::Instantiated | Phase::Initialization);
        let complete =
            from.0.is_empty() && (block.is_some() || !needs_block || phase == Phase::Error);
        complete.then_some(Self {
            phase,
            clock,
            inputs,
            predictor,
            before,
            file,
            params,
            given,
            block,
        })
    }
}
