//! Serialized states that were damaged: with a wrong checksum they are refused, with a right one the
//! content has to make sense or is refused. Either way the instance goes on.

use super::config;
use crate::swallow::{donors, sealed, swallow, HEADER};
use proptest::prelude::*;

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
            swallow(&sealed(&bytes[..HEADER], &payload)).map_err(TestCaseError::fail)?;
        } else {
            swallow(&damaged(bytes.clone(), &damages)).map_err(TestCaseError::fail)?;
        }
    }
}
