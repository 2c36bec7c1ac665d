//! The FMU state as bytes: what `fmi2GetFMUstate` keeps is what `fmi2SerializeFMUstate` writes.
//!
//! Layout, little endian: magic `TREADBLK`, version (u32), GUID (36 bytes), length of the payload
//! (u64), its CRC-32 (u32), payload. Numbers are stored by their bits, so a run resumes bit for bit.

use super::inputs::Inputs;
use super::instance::Instance;
use super::phase::Phase;
use super::stepping::Clock;
use super::Refusal;
use crate::drive::{Pose, Predictor};
use crate::params::{table, Params, Value};

const MAGIC: &[u8; 8] = b"TREADBLK";
const VERSION: u32 = 1;
const HEADER: usize = 8 + 4 + 36 + 8 + 4;

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

fn with_header(guid: &str, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(guid.bytes().chain(std::iter::repeat(b' ')).take(36));
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(crc32(payload).to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// Checks that `bytes` are a state of this FMU and undamaged, and returns their payload.
pub fn payload<'a>(guid: &str, bytes: &'a [u8]) -> Result<&'a [u8], Refusal> {
    let refuse = |why: String| {
        Err(Refusal::error(format!("no usable FMU state: {why}; serialize it anew with this FMU")))
    };
    let Some((header, payload)) = bytes.split_at_checked(HEADER) else {
        return refuse(format!("{} bytes are fewer than its header has", bytes.len()));
    };
    if &header[..8] != MAGIC {
        return refuse("it does not start with TREADBLK".to_string());
    }
    let version = header[8..12].try_into().map(u32::from_le_bytes).unwrap_or_default();
    if version != VERSION {
        return refuse(format!("its version is {version}, allowed is {VERSION}"));
    }
    if &header[12..48] != guid.as_bytes() {
        let theirs = String::from_utf8_lossy(&header[12..48]);
        return refuse(format!("it comes from an FMU with GUID {theirs}, this one has {guid}"));
    }
    let length = header[48..56].try_into().map(u64::from_le_bytes).unwrap_or_default();
    if length != payload.len() as u64 {
        return refuse(format!("it announces {length} bytes and holds {}", payload.len()));
    }
    let sum = header[56..60].try_into().map(u32::from_le_bytes).unwrap_or_default();
    if sum != crc32(payload) {
        return refuse("its checksum is wrong, it is damaged".to_string());
    }
    Ok(payload)
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

/// CRC-32 as of ISO-HDLC (the one of zip and png).
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

#[derive(Default)]
struct Writer(Vec<u8>);

impl Writer {
    fn u8(&mut self, byte: u8) {
        self.0.push(byte);
    }
    fn u64(&mut self, number: u64) {
        self.0.extend(number.to_le_bytes());
    }
    fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.u64(x.to_bits()));
    }
    fn list(&mut self, numbers: &[f64]) {
        self.u64(numbers.len() as u64);
        self.reals(numbers);
    }
    fn option(&mut self, number: Option<f64>) {
        self.u8(u8::from(number.is_some()));
        self.reals(&[number.unwrap_or(0.0)]);
    }
    fn pose(&mut self, pose: Pose) {
        self.reals(&[pose.x, pose.z, pose.angle, pose.load]);
    }
    fn text(&mut self, text: &str) {
        self.u64(text.len() as u64);
        self.0.extend(text.bytes());
    }
    fn value(&mut self, value: &Value) {
        match value {
            Value::Real(x) => {
                self.u8(0);
                self.reals(&[*x]);
            }
            Value::Integer(i) => {
                self.u8(1);
                self.0.extend(i.to_le_bytes());
            }
            Value::Boolean(b) => {
                self.u8(2);
                self.u8(u8::from(*b));
            }
            Value::Text(t) => {
                self.u8(3);
                self.text(t);
            }
        }
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*head)
    }
    fn u8(&mut self) -> Option<u8> {
        self.take::<1>().map(|[byte]| byte)
    }
    fn real(&mut self) -> Option<f64> {
        self.take().map(|bytes| f64::from_bits(u64::from_le_bytes(bytes)))
    }
    fn reals<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.real()?;
        }
        Some(numbers)
    }
    fn length(&mut self, size: usize) -> Option<usize> {
        let length = usize::try_from(u64::from_le_bytes(self.take()?)).ok()?;
        (length <= self.0.len() / size).then_some(length)
    }
    fn list(&mut self) -> Option<Vec<f64>> {
        let length = self.length(8)?;
        (0..length).map(|_| self.real()).collect()
    }
    fn option(&mut self) -> Option<Option<f64>> {
        let some = self.u8()? != 0;
        let number = self.real()?;
        Some(some.then_some(number))
    }
    fn pose(&mut self) -> Option<Pose> {
        let [x, z, angle, load] = self.reals()?;
        Some(Pose { x, z, angle, load })
    }
    fn text(&mut self) -> Option<String> {
        let length = self.length(1)?;
        let (text, rest) = self.0.split_at_checked(length)?;
        let text = String::from_utf8(text.to_vec()).ok()?;
        self.0 = rest;
        Some(text)
    }
    fn value(&mut self) -> Option<Value> {
        match self.u8()? {
            0 => self.real().map(Value::Real),
            1 => self.take().map(|bytes| Value::Integer(i32::from_le_bytes(bytes))),
            2 => self.u8().map(|b| Value::Boolean(b != 0)),
            3 => self.text().map(Value::Text),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_one_of_zip() {
        // Check value of CRC-32/ISO-HDLC in the catalogue of parametrised CRC algorithms.
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }
}
