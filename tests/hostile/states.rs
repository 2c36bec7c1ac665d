//! Serialized states that were damaged: with a wrong checksum they are refused, with a right one the
//! content has to make sense or is refused. Either way the instance goes on.

use super::config;
use crate::fmi::*;
use proptest::prelude::*;
use std::ptr::null_mut;
use std::sync::OnceLock;
use tread_block::fmi::exports::*;

/// Magic, version, GUID, length, checksum.
const HEADER: usize = 8 + 4 + 36 + 8 + 4;

fn serialized(fmu: &Fmu) -> Vec<u8> {
    let (mut state, mut size) = (null_mut(), 0);
    fmu.call(|c| unsafe { fmi2GetFMUstate(c, &mut state as *mut _) });
    unsafe { fmi2SerializedFMUstateSize(fmu.c, state, &mut size) };
    let mut bytes = vec![0_u8; size];
    unsafe {
        fmi2SerializeFMUstate(fmu.c, state, bytes.as_mut_ptr().cast(), size);
        fmi2FreeFMUstate(fmu.c, &mut state);
    }
    bytes
}

/// States of all kinds: new, initializing, sliding, terminated.
fn donors() -> &'static [Vec<u8>] {
    static STATES: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    STATES.get_or_init(|| {
        let new = Fmu::new();
        new.coarse();
        let mut states = vec![serialized(&new)];
        new.call(|c| unsafe { fmi2EnterInitializationMode(c) });
        states.push(serialized(&new));
        let sliding = Fmu::ready();
        sliding.slide(0, 30, 1e-5);
        states.push(serialized(&sliding));
        sliding.call(|c| unsafe { fmi2Terminate(c) });
        states.push(serialized(&sliding));
        states
    })
}

/// One way to damage bytes.
#[derive(Clone, Debug)]
enum Damage {
    Flip { at: usize, bit: u8 },
    Byte { at: usize, value: u8 },
    Number { at: usize, bits: u64 },
    Cut { length: usize },
    Append { bytes: Vec<u8> },
}

fn damage() -> impl Strategy<Value = Damage> {
    let absurd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300, -1e300, 1e-300, 3.0];
    let number = prop_oneof![
        prop::sample::select(absurd.map(f64::to_bits).to_vec()),
        any::<u64>(),
        0..100_u64,
    ];
    prop_oneof![
        4 => (any::<usize>(), 0..8_u8).prop_map(|(at, bit)| Damage::Flip { at, bit }),
        4 => (any::<usize>(), any::<u8>()).prop_map(|(at, value)| Damage::Byte { at, value }),
        6 => (any::<usize>(), number).prop_map(|(at, bits)| Damage::Number { at, bits }),
        1 => any::<usize>().prop_map(|length| Damage::Cut { length }),
        1 => prop::collection::vec(any::<u8>(), 1..40).prop_map(|bytes| Damage::Append { bytes }),
    ]
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        let n = bytes.len().max(1);
        match damage {
            Damage::Flip { at, bit } => bytes[at % n] ^= 1 << bit,
            Damage::Byte { at, value } => bytes[at % n] = *value,
            Damage::Number { at, bits } => {
                for (slot, byte) in bytes[at % n..].iter_mut().zip(bits.to_le_bytes()) {
                    *slot = byte;
                }
            }
            Damage::Cut { length } => bytes.truncate((length % n).max(1)),
            Damage::Append { bytes: more } => bytes.extend(more),
        }
    }
    bytes
}

/// The payload with a header whose length and checksum (CRC-32 of zip) are right.
fn sealed(header: &[u8], payload: &[u8]) -> Vec<u8> {
    let sum = !payload.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    });
    let mut out = header[..48].to_vec();
    out.extend((payload.len() as u64).to_le_bytes());
    out.extend(sum.to_le_bytes());
    out.extend(payload);
    out
}

fn swallow(bytes: &[u8]) -> Result<(), TestCaseError> {
    let fmu = Fmu::ready();
    fmu.slide(0, 3, 1e-5);
    let before = fmu.outputs();
    let mut state = null_mut();
    let c = fmu.c;
    let status =
        unsafe { fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), bytes.len(), &mut state) };
    prop_assert!(status <= ERROR, "deserialize: {}", fmu.last_message());
    if status == OK {
        let status = unsafe { fmi2SetFMUstate(c, state) };
        prop_assert!(status <= ERROR, "set: {}", fmu.last_message());
        if status == OK {
            go_on(&fmu)?;
        } else {
            prop_assert!(!fmu.last_message().is_empty());
            prop_assert_eq!(fmu.outputs(), before, "a refused state changes nothing");
        }
        unsafe { fmi2FreeFMUstate(c, &mut state) };
    }
    if unsafe { fmi2Reset(c) } == OK {
        fmu.initialize();
        prop_assert!(fmu.outputs().iter().all(|x| x.is_finite()));
    }
    Ok(())
}

/// What an importer does next. Answers may be refusals; numbers are never NaN.
fn go_on(fmu: &Fmu) -> Result<(), TestCaseError> {
    let mut time = 0.0;
    unsafe { fmi2GetRealStatus(fmu.c, 2, &mut time) };
    for k in 0..3 {
        let status = fmu.step(time + f64::from(k) * 1e-5, 1e-5);
        prop_assert!(status <= ERROR, "step: {}", fmu.last_message());
        if status != OK {
            return Ok(());
        }
        let finite = fmu.outputs().iter().all(|x| x.is_finite());
        prop_assert!(finite, "step {k} answers OK with outputs that are not finite");
    }
    Ok(())
}

proptest! {
    #![proptest_config(config("tests/hostile/corpus/states.txt", 100))]

    #[test]
    fn a_damaged_state_is_refused_or_makes_sense(
        donor in 0..4_usize,
        damages in prop::collection::vec(damage(), 1..5),
        repaired in prop::bool::weighted(0.8),
    ) {
        let bytes = &donors()[donor];
        if repaired {
            let payload = damaged(bytes[HEADER..].to_vec(), &damages);
            swallow(&sealed(&bytes[..HEADER], &payload))?;
        } else {
            swallow(&damaged(bytes.clone(), &damages))?;
        }
    }
}
