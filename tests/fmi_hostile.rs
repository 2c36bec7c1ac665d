//! Hostile hands: random calls with random arguments. The process lives, answers stay within the
//! standard's numbers, outputs stay finite, every refusal has a reason, and a bystander instance keeps
//! its bits. A fixed seed makes a failure repeatable; TREAD_FUZZ_SEQUENCES asks for more sequences.

#[path = "common/fmi.rs"]
mod fmi;

use fmi::*;
use std::ptr::{null, null_mut};
use tread_block::fmi::exports::*;
use tread_block::fmi::variables;

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
    /// Mostly small numbers, sometimes absurd ones.
    fn real(&mut self) -> f64 {
        let usual = [0.0, 1e-5, -1e-5, 1e-4, 0.01, 0.5, 1.0, 30.0, -1.0];
        let absurd = [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, -1e300, 5e-324];
        match self.below(8) {
            0 => absurd[self.below(absurd.len())],
            _ => usual[self.below(usual.len())],
        }
    }
    fn reference(&mut self, count: usize) -> u32 {
        match self.below(12) {
            0 => self.next() as u32,
            _ => self.below(count) as u32,
        }
    }
}

/// One random call; `time` follows the steps that were done.
fn act(random: &mut Random, fmu: &Fmu, states: &mut Vec<Vec<u8>>, time: &mut f64) -> u32 {
    let c = fmu.c;
    let count = variables::all().len();
    let (vr, x) = (random.reference(count), random.real());
    let (mut real, mut integer, mut text, mut size) = (0.0, 0, null(), 0);
    let texts = [c"".as_ptr(), c"/nowhere/at all.toml".as_ptr(), c"%s%n%d".as_ptr(), null()];
    let mut state = null_mut();
    unsafe {
        match random.below(24) {
            0 => fmi2SetupExperiment(c, 1, x, x, (vr % 2) as i32, random.real()),
            1 | 2 => fmi2EnterInitializationMode(c),
            3 | 4 => fmi2ExitInitializationMode(c),
            5 => fmi2SetReal(c, &vr, 1, &x),
            6 => fmi2GetReal(c, &vr, 1, &mut real),
            7 => fmi2SetInteger(c, &vr, 1, &(random.below(5) as i32 - 1)),
            8 => fmi2GetInteger(c, &vr, 1, &mut integer),
            9 => fmi2SetBoolean(c, &vr, 1, &(random.next() as i32)),
            10 => fmi2GetString(c, &vr, 1, &mut text),
            11 => fmi2SetString(c, &vr, 1, &texts[random.below(texts.len())]),
            12 => fmi2SetRealInputDerivatives(c, &vr, 1, &(random.below(4) as i32), &x),
            13 => fmi2GetRealOutputDerivatives(c, &vr, 1, &(random.below(3) as i32), &mut real),
            14 => fmi2GetRealStatus(c, random.below(6) as u32, &mut real),
            15 => fmi2GetReal(c, null(), usize::MAX, &mut real),
            16 => fmi2Terminate(c),
            17 => {
                *time = 0.0;
                fmi2Reset(c)
            }
            18 => {
                let status = fmi2GetFMUstate(c, &mut state);
                if status == OK && fmi2SerializedFMUstateSize(c, state, &mut size) == OK {
                    let mut bytes = vec![0_u8; size];
                    fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr().cast(), size);
                    states.push(bytes);
                }
                fmi2FreeFMUstate(c, &mut state);
                status
            }
            19 if !states.is_empty() => {
                let mut bytes = states[random.below(states.len())].clone();
                if random.below(2) == 0 {
                    let at = random.below(bytes.len());
                    bytes[at] ^= 1 << random.below(8);
                }
                bytes.truncate(bytes.len() - random.below(2) * random.below(bytes.len()));
                let pointer = bytes.as_ptr().cast();
                let status = fmi2DeSerializeFMUstate(c, pointer, bytes.len(), &mut state);
                if status != OK {
                    return status;
                }
                let status = fmi2SetFMUstate(c, state);
                fmi2FreeFMUstate(c, &mut state);
                fmi2GetRealStatus(c, 2, time);
                status
            }
            20 => fmi2DoStep(c, *time, x.min(1e-3), 1),
            _ => {
                let status = fmi2DoStep(c, *time, 1e-5, 1);
                if status == OK {
                    *time += 1e-5;
                }
                status
            }
        }
    }
}

#[test]
fn no_sequence_of_calls_harms_the_process_or_a_bystander() {
    let sequences = std::env::var("TREAD_FUZZ_SEQUENCES").ok().and_then(|n| n.parse().ok());
    let expected = Fmu::ready().slide(0, 50, 1e-5);
    let mut random = Random(0x5EED_5EED_5EED_5EED);
    let (mut calls, mut refusals) = (0, 0);
    for sequence in 0..sequences.unwrap_or(60) {
        let fmu = Fmu::new();
        fmu.coarse();
        let (mut states, mut time) = (Vec::new(), 0.0);
        for _ in 0..60 {
            let told = fmu.messages.lock().unwrap().len();
            let status = act(&mut random, &fmu, &mut states, &mut time);
            assert!(status <= ERROR, "sequence {sequence}: {status}: {}", fmu.last_message());
            if status != OK {
                refusals += 1;
                let now = fmu.messages.lock().unwrap().len();
                assert!(now > told, "sequence {sequence}: a refusal without a reason");
            }
            if status == ERROR && random.below(2) == 0 {
                // Go on from a good place, or most calls would meet the error state.
                unsafe { fmi2Reset(fmu.c) };
                time = 0.0;
                if random.below(3) == 0 {
                    fmu.coarse();
                } else {
                    fmu.initialize();
                }
            }
            calls += 1;
        }
        if unsafe { fmi2Reset(fmu.c) } == OK {
            fmu.initialize();
            assert!(fmu.outputs().iter().all(|x| x.is_finite()));
        }
    }
    eprintln!("{calls} calls, {refusals} refusals with a reason");
    assert_eq!(Fmu::ready().slide(0, 50, 1e-5), expected);
}
