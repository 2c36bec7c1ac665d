//! Serialized states given back to an instance, whoever damaged them: a property test or a fuzzer.
#![allow(dead_code)]

use crate::fmi::*;
use crate::play::ensure;
use std::ptr::null_mut;
use std::sync::OnceLock;
use tread_block::fmi::exports::*;

/// Magic, version, GUID, length, checksum.
pub const HEADER: usize = 8 + 4 + 36 + 8 + 4;

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
pub fn donors() -> &'static [Vec<u8>] {
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

/// The payload with a header whose length and checksum (CRC-32 of zip) are right.
pub fn sealed(header: &[u8], payload: &[u8]) -> Vec<u8> {
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

/// Hands `bytes` to an instance as a state and goes on; `Err` tells what must not happen.
pub fn swallow(bytes: &[u8]) -> Result<(), String> {
    let fmu = Fmu::ready();
    fmu.slide(0, 3, 1e-5);
    let before = fmu.outputs();
    let mut state = null_mut();
    let c = fmu.c;
    let status =
        unsafe { fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), bytes.len(), &mut state) };
    ensure(status <= ERROR, || format!("deserialize: {}", fmu.last_message()))?;
    if status == OK {
        let status = unsafe { fmi2SetFMUstate(c, state) };
        ensure(status <= ERROR, || format!("set: {}", fmu.last_message()))?;
        if status == OK {
            go_on(&fmu)?;
        } else {
            ensure(!fmu.last_message().is_empty(), || "refused without a reason".to_string())?;
            ensure(fmu.outputs() == before, || "a refused state has changed outputs".to_string())?;
        }
        unsafe { fmi2FreeFMUstate(c, &mut state) };
    }
    if unsafe { fmi2Reset(c) } == OK {
        fmu.initialize();
        let finite = fmu.outputs().iter().all(|x| x.is_finite());
        ensure(finite, || "outputs after a reset are not finite".to_string())?;
    }
    Ok(())
}

/// What an importer does next. Answers may be refusals; numbers are never NaN.
fn go_on(fmu: &Fmu) -> Result<(), String> {
    let mut time = 0.0;
    unsafe { fmi2GetRealStatus(fmu.c, 2, &mut time) };
    for k in 0..3 {
        let status = fmu.step(time + f64::from(k) * 1e-5, 1e-5);
        ensure(status <= ERROR, || format!("step: {}", fmu.last_message()))?;
        if status != OK {
            return Ok(());
        }
        let finite = fmu.outputs().iter().all(|x| x.is_finite());
        ensure(finite, || format!("step {k} answers OK with outputs that are not finite"))?;
    }
    Ok(())
}
