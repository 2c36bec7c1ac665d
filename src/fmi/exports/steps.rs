//! Steps, derivatives of inputs and outputs, and what became of a step.
#![allow(non_snake_case, clippy::missing_safety_doc)]

use super::super::phase::Call;
use super::super::{stepping, Refusal};
use super::guard::{guarded, read, write};
use fmi_sys::fmi2::*;

/// Derivatives of inputs for the next step; on refusal of one none is set.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SetInputDerivatives, |instance| {
            let references = read(vr, nvr, "value references")?;
            let orders = read(order, nvr, "orders")?.iter();
            let values = orders.zip(read(value, nvr, "values")?);
            let before = instance.inputs;
            let result = references.iter().zip(values).try_for_each(|(vr, (order, value))| {
                instance.set_input_derivative(*vr, *order, *value)
            });
            if result.is_err() {
                instance.inputs = before;
            }
            result
        })
    }
}

/// Derivatives of outputs at the end of the last step; on refusal nothing is written.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::GetOutputDerivatives, |instance| {
            let references = read(vr, nvr, "value references")?;
            let orders = read(order, nvr, "orders")?;
            let values = write(value, nvr, "values")?;
            for (vr, order) in references.iter().zip(orders) {
                instance.output_derivative(*vr, *order)?;
            }
            for ((value, vr), order) in values.iter_mut().zip(references).zip(orders) {
                *value = instance.output_derivative(*vr, *order)?;
            }
            Ok(())
        })
    }
}

/// One communication step.
#[no_mangle]
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::DoStep, |instance| {
            stepping::do_step(instance, currentCommunicationPoint, communicationStepSize)
        })
    }
}

/// Steps are never in progress.
#[no_mangle]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    unsafe { guarded(c, Call::CancelStep, |_| Ok(())) }
}

fn unavailable(what: &str, kind: fmi2StatusKind) -> Refusal {
    Refusal::discard(format!(
        "{what}({kind}) is not available: steps are never pending; fmi2GetRealStatus gives \
         fmi2LastSuccessfulTime, fmi2GetBooleanStatus gives fmi2Terminated"
    ))
}

/// Always fmi2Discard: no step is ever pending.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Status,
) -> fmi2Status {
    unsafe { guarded(c, Call::GetStatus, |_| Err(unavailable("fmi2GetStatus", s))) }
}

/// fmi2LastSuccessfulTime: the time \[s\] up to which the solution is good.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetRealStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Real,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::GetStatus, |instance| {
            if s != fmi2StatusKind_fmi2LastSuccessfulTime {
                return Err(unavailable("fmi2GetRealStatus", s));
            }
            let value = value.as_mut().ok_or_else(|| Refusal::error("value is NULL"))?;
            *value = instance.clock.last_successful;
            Ok(())
        })
    }
}

/// Always fmi2Discard: there is no such status.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    unsafe { guarded(c, Call::GetStatus, |_| Err(unavailable("fmi2GetIntegerStatus", s))) }
}

/// fmi2Terminated: never, this FMU does not end a simulation by itself.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::GetStatus, |_| {
            if s != fmi2StatusKind_fmi2Terminated {
                return Err(unavailable("fmi2GetBooleanStatus", s));
            }
            let value = value.as_mut().ok_or_else(|| Refusal::error("value is NULL"))?;
            *value = 0;
            Ok(())
        })
    }
}

/// Always fmi2Discard: no step is ever pending.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetStringStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2String,
) -> fmi2Status {
    unsafe { guarded(c, Call::GetStatus, |_| Err(unavailable("fmi2GetStringStatus", s))) }
}
