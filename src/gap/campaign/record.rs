//! The data of a run: its CSV as channels.

use super::plan::{Plan, RunSpec};
use super::{CHANNELS, CHANNEL_COUNT};
use crate::error::Problem;
use crate::gap::packed::Source;
use crate::gap::quality;

/// A record: time and channels of equal length.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Record {
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Channels; `None` where a channel is missing or unusable.
    pub channel: [Option<Vec<f64>>; CHANNEL_COUNT],
    /// Step of the measured time column over that of the sampling rate; 0 where nothing was measured.
    pub clock: f64,
}

impl Record {
    /// The record up to `end` \[s\].
    pub fn until(&self, end: f64) -> Self {
        let count = self.time.iter().take_while(|t| **t <= end + 1e-6).count();
        let cut = |column: &Vec<f64>| column[..count].to_vec();
        Self {
            time: cut(&self.time),
            channel: std::array::from_fn(|c| self.channel[c].as_ref().map(cut)),
            clock: self.clock,
        }
    }
}

/// Where [`hash_step`] begins.
pub(super) const HASH_START: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a of more bytes.
pub(super) fn hash_step(start: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(start, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3))
}

/// Reads a run's file; what is wrong with single channels goes to `warnings`. Returns the hash of its bytes, too.
pub(super) fn read(
    source: &Source,
    plan: &Plan,
    spec: &RunSpec,
    warnings: &mut Vec<Problem>,
) -> Result<(Record, u64), Problem> {
    let unreadable = |reason: String| {
        Problem::new(
            &spec.file,
            reason,
            "a readable CSV file",
            "the run is left out; restore its file",
        )
    };
    let bytes = source.bytes(&spec.file).map_err(unreadable)?;
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes.as_slice());
    let header = reader.headers().map_err(|e| unreadable(e.to_string()))?.clone();
    let place = |name: &str| header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
    let mut record = Record::default();
    let places = CHANNELS.map(place);
    let at_time = place("time_s").ok_or_else(|| unreadable("no column time_s".into()))?;
    for (slot, at) in record.channel.iter_mut().zip(places) {
        *slot = at.map(|_| Vec::new());
    }
    for row in reader.records() {
        let row = row.map_err(|e| unreadable(e.to_string()))?;
        let cell = |at: usize| row.get(at).and_then(|c| c.parse::<f64>().ok()).unwrap_or(f64::NAN);
        record.time.push(cell(at_time));
        for (slot, at) in record.channel.iter_mut().zip(places) {
            if let (Some(column), Some(at)) = (slot.as_mut(), at) {
                column.push(cell(at));
            }
        }
    }
    quality::of_record(&mut record, plan, spec, warnings)?;
    Ok((record, hash_step(HASH_START, &bytes)))
}
