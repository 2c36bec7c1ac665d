//! A sequence of calls played on an instance, whoever thought of it: a property test or a fuzzer.
#![allow(dead_code)]

use crate::fmi::*;
use std::ptr::{null, null_mut};
use tread_block::fmi::exports::*;

/// What a hostile input must not do.
pub fn ensure(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds {
        Ok(())
    } else {
        Err(otherwise())
    }
}

/// One call with everything that it may need.
#[derive(Clone, Debug)]
pub struct Call {
    pub kind: u8,
    pub reference: u32,
    pub real: f64,
    pub other: f64,
    pub integer: i32,
    pub at: usize,
    /// After an error: go on from a good place, or most calls would meet the error state.
    pub recover: bool,
}

/// What a sequence has gathered.
#[derive(Default)]
struct Memory {
    states: Vec<Vec<u8>>,
    /// End of the last step [s].
    time: f64,
}

unsafe fn act(call: &Call, fmu: &Fmu, memory: &mut Memory) -> u32 {
    let c = fmu.c;
    let (vr, x, i) = (call.reference, call.real, call.integer);
    let (mut real, mut integer, mut text) = (0.0, 0, null());
    let texts = [c"".as_ptr(), c"/nowhere/at all.toml".as_ptr(), c"%s%n%d".as_ptr(), null()];
    match call.kind {
        0 => fmi2SetupExperiment(c, 1, x, x, i & 1, call.other),
        1 | 2 => fmi2EnterInitializationMode(c),
        3 | 4 => fmi2ExitInitializationMode(c),
        5 => fmi2SetReal(c, &vr, 1, &x),
        6 => fmi2GetReal(c, &vr, 1, &mut real),
        7 => fmi2SetInteger(c, &vr, 1, &i),
        8 => fmi2GetInteger(c, &vr, 1, &mut integer),
        9 => fmi2SetBoolean(c, &vr, 1, &i),
        10 => fmi2GetString(c, &vr, 1, &mut text),
        11 => fmi2SetString(c, &vr, 1, &texts[call.at % texts.len()]),
        12 => fmi2SetRealInputDerivatives(c, &(vr % 5), 1, &i, &x),
        13 => fmi2GetRealOutputDerivatives(c, &vr, 1, &i, &mut real),
        14 => fmi2GetRealStatus(c, i as u32, &mut real),
        15 => fmi2GetReal(c, null(), usize::MAX, &mut real),
        16 => fmi2Terminate(c),
        17 => {
            memory.time = 0.0;
            fmi2Reset(c)
        }
        18 => keep(c, memory),
        19 if !memory.states.is_empty() => go_back(call, c, memory),
        20 => fmi2DoStep(c, memory.time, x.min(1e-3), 1),
        21 => fmi2DoStep(c, x, 1e-5, 1),
        22 => fmi2SetReal(c, &(vr % 4), 1, &x),
        23 => fmi2GetBooleanStatus(c, i as u32, &mut integer),
        _ => {
            let status = fmi2DoStep(c, memory.time, 1e-5, 1);
            memory.time += if status == OK { 1e-5 } else { 0.0 };
            status
        }
    }
}

unsafe fn keep(c: fmi2Component, memory: &mut Memory) -> u32 {
    let (mut state, mut size) = (null_mut(), 0);
    let status = fmi2GetFMUstate(c, &mut state);
    if status == OK && fmi2SerializedFMUstateSize(c, state, &mut size) == OK {
        let mut bytes = vec![0_u8; size];
        fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr().cast(), size);
        memory.states.push(bytes);
    }
    fmi2FreeFMUstate(c, &mut state);
    status
}

unsafe fn go_back(call: &Call, c: fmi2Component, memory: &mut Memory) -> u32 {
    let mut state = null_mut();
    let bytes = &memory.states[call.at % memory.states.len()];
    let length = if call.recover { bytes.len() } else { call.at % bytes.len() };
    let status = fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), length, &mut state);
    if status != OK {
        return status;
    }
    let status = fmi2SetFMUstate(c, state);
    fmi2FreeFMUstate(c, &mut state);
    fmi2GetRealStatus(c, 2, &mut memory.time);
    status
}

/// Plays calls on a new instance; `Err` tells what must not happen.
pub fn play(calls: &[Call]) -> Result<(), String> {
    let fmu = Fmu::new();
    fmu.coarse();
    let mut memory = Memory::default();
    for call in calls {
        let told = fmu.messages.lock().unwrap().len();
        let status = unsafe { act(call, &fmu, &mut memory) };
        ensure(status <= ERROR, || format!("{status}: {}", fmu.last_message()))?;
        if status != OK {
            let now = fmu.messages.lock().unwrap().len();
            ensure(now > told, || format!("{status} without a reason: {call:?}"))?;
        }
        if status == ERROR && call.recover {
            unsafe { fmi2Reset(fmu.c) };
            memory.time = 0.0;
            if call.at % 3 == 0 {
                fmu.coarse();
            } else {
                fmu.initialize();
            }
        }
    }
    if unsafe { fmi2Reset(fmu.c) } == OK {
        fmu.initialize();
        let finite = fmu.outputs().iter().all(|x| x.is_finite());
        ensure(finite, || "outputs after a reset are not finite".to_string())?;
    }
    Ok(())
}
