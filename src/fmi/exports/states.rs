//! States of an instance: kept, restored, as bytes.
#![allow(non_snake_case, clippy::missing_safety_doc)]

use super::super::phase::Call;
use super::super::state::{self, Stored};
use super::super::Refusal;
use super::guard::{guarded, read, write};
use fmi_sys::fmi2::*;

/// Keeps the state of an instance in `*FMUstate` (made if it is NULL, else overwritten).
#[no_mangle]
pub unsafe extern "C" fn fmi2GetFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::GetState, |instance| {
            let slot = FMUstate.as_mut().ok_or_else(|| Refusal::error("FMUstate is NULL"))?;
            keep(slot, state::store(instance));
            Ok(())
        })
    }
}

unsafe fn keep(slot: &mut fmi2FMUstate, stored: Stored) {
    match unsafe { slot.cast::<Stored>().as_mut() } {
        Some(old) => *old = stored,
        None => *slot = Box::into_raw(Box::new(stored)).cast(),
    }
}

unsafe fn stored<'a>(state: fmi2FMUstate) -> Result<&'a Stored, Refusal> {
    unsafe { state.cast::<Stored>().as_ref() }.ok_or_else(|| {
        Refusal::error("FMUstate is NULL: make one with fmi2GetFMUstate or fmi2DeSerializeFMUstate")
    })
}

/// Puts the instance where it was when the state was kept.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    unsafe { guarded(c, Call::SetState, |instance| state::restore(instance, stored(FMUstate)?)) }
}

/// Frees a kept state and sets the pointer to NULL; NULL is ignored.
#[no_mangle]
pub unsafe extern "C" fn fmi2FreeFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::FreeState, |_| {
            if let Some(slot) = FMUstate.as_mut().filter(|slot| !slot.is_null()) {
                drop(Box::from_raw(slot.cast::<Stored>()));
                *slot = std::ptr::null_mut();
            }
            Ok(())
        })
    }
}

/// Size of a kept state in bytes.
#[no_mangle]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SerializeState, |_| {
            let size = size.as_mut().ok_or_else(|| Refusal::error("size is NULL"))?;
            *size = stored(FMUstate)?.0.len();
            Ok(())
        })
    }
}

/// Writes a kept state as bytes.
#[no_mangle]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SerializeState, |_| {
            let bytes = &stored(FMUstate)?.0;
            if size < bytes.len() {
                return Err(Refusal::error(format!(
                    "size = {size}: allowed is {} or more, see fmi2SerializedFMUstateSize",
                    bytes.len()
                )));
            }
            let buffer = write(serializedState.cast::<u8>(), bytes.len(), "bytes")?;
            buffer.copy_from_slice(bytes);
            Ok(())
        })
    }
}

/// Makes a state from bytes; wrong or damaged bytes are refused.
#[no_mangle]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: usize,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SerializeState, |instance| {
            let slot = FMUstate.as_mut().ok_or_else(|| Refusal::error("FMUstate is NULL"))?;
            let bytes = read(serializedState.cast::<u8>(), size, "bytes")?;
            state::payload(&instance.guid, bytes)?;
            keep(slot, Stored(bytes.to_vec()));
            Ok(())
        })
    }
}
