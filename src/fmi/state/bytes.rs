//! Values as bytes, little endian, numbers by their bits: what [`Writer`] appends, [`Reader`] takes in the same order.

use crate::drive::Pose;
use crate::params::Value;

/// Appends values.
#[derive(Default)]
pub(super) struct Writer(pub(super) Vec<u8>);

impl Writer {
    pub(super) fn u8(&mut self, byte: u8) {
        self.0.push(byte);
    }
    pub(super) fn u64(&mut self, number: u64) {
        self.0.extend(number.to_le_bytes());
    }
    pub(super) fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.u64(x.to_bits()));
    }
    pub(super) fn list(&mut self, numbers: &[f64]) {
        self.u64(numbers.len() as u64);
        self.reals(numbers);
    }
    pub(super) fn option(&mut self, number: Option<f64>) {
        self.u8(u8::from(number.is_some()));
        self.reals(&[number.unwrap_or(0.0)]);
    }
    pub(super) fn pose(&mut self, pose: Pose) {
        self.reals(&[pose.x, pose.z, pose.angle, pose.load]);
    }
    pub(super) fn text(&mut self, text: &str) {
        self.u64(text.len() as u64);
        self.0.extend(text.bytes());
    }
    pub(super) fn value(&mut self, value: &Value) {
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

/// Takes values from its front; `None` where there are too few bytes, or they are no such value.
pub(super) struct Reader<'a>(pub(super) &'a [u8]);

impl Reader<'_> {
    pub(super) fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*head)
    }
    pub(super) fn u8(&mut self) -> Option<u8> {
        self.take::<1>().map(|[byte]| byte)
    }
    pub(super) fn real(&mut self) -> Option<f64> {
        self.take().map(|bytes| f64::from_bits(u64::from_le_bytes(bytes)))
    }
    pub(super) fn reals<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.real()?;
        }
        Some(numbers)
    }
    pub(super) fn length(&mut self, size: usize) -> Option<usize> {
        let length = usize::try_from(u64::from_le_bytes(self.take()?)).ok()?;
        (length <= self.0.len() / size).then_some(length)
    }
    pub(super) fn list(&mut self) -> Option<Vec<f64>> {
        let length = self.length(8)?;
        (0..length).map(|_| self.real()).collect()
    }
    pub(super) fn option(&mut self) -> Option<Option<f64>> {
        let some = self.u8()? != 0;
        let number = self.real()?;
        Some(some.then_some(number))
    }
    pub(super) fn pose(&mut self) -> Option<Pose> {
        let [x, z, angle, load] = self.reals()?;
        Some(Pose { x, z, angle, load })
    }
    pub(super) fn text(&mut self) -> Option<String> {
        let length = self.length(1)?;
        let (text, rest) = self.0.split_at_checked(length)?;
        let text = String::from_utf8(text.to_vec()).ok()?;
        self.0 = rest;
        Some(text)
    }
    pub(super) fn value(&mut self) -> Option<Value> {
        match self.u8()? {
            0 => self.real().map(Value::Real),
            1 => self.take().map(|bytes| Value::Integer(i32::from_le_bytes(bytes))),
            2 => self.u8().map(|b| Value::Boolean(b != 0)),
            3 => self.text().map(Value::Text),
            _ => None,
        }
    }
}
