//! Functions that this FMU does not offer. Some importers look all of them up before they ask for any,
//! so they are there: each answers fmi2Error and says why.
#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use super::super::phase::Call;
use super::super::Refusal;
use super::guard::guarded;
use fmi_sys::fmi2::*;

/// Not offered: the description does not announce it.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    _vUnknown_ref: *const fmi2ValueReference,
    _nUnknown: usize,
    _vKnown_ref: *const fmi2ValueReference,
    _nKnown: usize,
    _dvKnown: *const fmi2Real,
    _dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::GetDirectionalDerivative, |_| {
            Err(Refusal::error(
                "directional derivatives are not offered (providesDirectionalDerivative is absent); \
                 use differences between runs from one FMU state",
            ))
        })
    }
}

unsafe fn not_offered(c: fmi2Component) -> fmi2Status {
    unsafe { guarded(c, Call::ModelExchange, |_| Ok(())) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2EnterEventMode(c: fmi2Component) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2NewDiscreteStates(
    c: fmi2Component,
    _eventInfo: *mut fmi2EventInfo,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2EnterContinuousTimeMode(c: fmi2Component) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: fmi2Component,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
    _enterEventMode: *mut fmi2Boolean,
    _terminateSimulation: *mut fmi2Boolean,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetTime(c: fmi2Component, _time: fmi2Real) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetContinuousStates(
    c: fmi2Component,
    _x: *const fmi2Real,
    _nx: usize,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetDerivatives(
    c: fmi2Component,
    _derivatives: *mut fmi2Real,
    _nx: usize,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetEventIndicators(
    c: fmi2Component,
    _eventIndicators: *mut fmi2Real,
    _ni: usize,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetContinuousStates(
    c: fmi2Component,
    _x: *mut fmi2Real,
    _nx: usize,
) -> fmi2Status {
    unsafe { not_offered(c) }
}

/// Not offered.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(
    c: fmi2Component,
    _nominals: *mut fmi2Real,
    _nx: usize,
) -> fmi2Status {
    unsafe { not_offered(c) }
}
