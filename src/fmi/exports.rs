//! The C functions of FMI 2.0 co-simulation: thin, each through one guard.
//!
//! # Safety
//! All functions take what the standard says: a component is NULL or came from [`fmi2Instantiate`]
//! and is not yet freed, arrays hold as many elements as announced, texts end with a zero byte, and
//! one instance is used by one thread at a time.
#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use super::instance::Instance;
use super::log::Log;
use super::phase::{self, Call, Phase};
use super::state::{self, Stored};
use super::stepping;
use super::variables::Type;
use super::{uri, Refusal, Status};
use crate::params::Value;
use fmi_sys::fmi2::*;
use std::cell::Cell;
use std::ffi::{c_char, CStr, CString};
use std::panic::{catch_unwind, AssertUnwindSafe};

/// More variables than this in one call are a slip of the importer, not a request.
const MAX_COUNT: usize = 1 << 20;

thread_local! {
    /// Is this thread inside a function of the FMU? Then a panic is the FMU's own.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Keeps panics inside the FMU off stderr; their text goes to the importer's logger instead.
fn silence_panics() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !INSIDE.get() {
                others(info);
            }
        }));
    });
}

/// Runs `body`; a panic becomes its text.
fn contained<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    let outer = INSIDE.replace(true);
    let result = catch_unwind(AssertUnwindSafe(body));
    INSIDE.set(outer);
    result.map_err(|panic| {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
    })
}

/// The one way into an instance: checks that the call is allowed, runs it, reports its failure.
pub(super) unsafe fn guarded(
    component: fmi2Component,
    call: Call,
    body: impl FnOnce(&mut Instance) -> Result<(), Refusal>,
) -> fmi2Status {
    let Some(instance) = (unsafe { component.cast::<Instance>().as_mut() }) else {
        return Status::Error.code();
    };
    if !phase::allows(instance.phase, call) {
        return refuse_call(instance, call).code();
    }
    match contained(|| body(instance)) {
        Ok(Ok(())) => Status::Ok.code(),
        Ok(Err(refusal)) => report(instance, call, &refusal).code(),
        Err(panic) => {
            instance.phase = Phase::Fatal;
            instance.log.reason(Status::Fatal, &format!("internal fault in {call:?}: {panic}"));
            Status::Fatal.code()
        }
    }
}

fn refuse_call(instance: &mut Instance, call: Call) -> Status {
    let text = format!(
        "{call:?} is not allowed in the state \"{}\": allowed is {}",
        instance.phase.name(),
        phase::where_allowed(call)
    );
    let status = if instance.phase == Phase::Fatal { Status::Fatal } else { Status::Error };
    report(instance, call, &Refusal { status, reason: text })
}

/// Logs the reason and moves to the state that the answer means.
fn report(instance: &mut Instance, call: Call, refusal: &Refusal) -> Status {
    instance.log.reason(refusal.status, &refusal.reason);
    match refusal.status {
        Status::Fatal => instance.phase = Phase::Fatal,
        Status::Error => instance.phase = Phase::Error,
        Status::Discard if call == Call::DoStep => instance.phase = Phase::StepFailed,
        _ => {}
    }
    refusal.status
}

/// Text of a C string; `None` for NULL.
unsafe fn text(pointer: *const c_char) -> Option<String> {
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

fn count(n: usize, null: bool, what: &str) -> Result<(), Refusal> {
    if n > MAX_COUNT {
        return Err(Refusal::error(format!("{n} {what} at once: allowed are {MAX_COUNT}")));
    }
    if null && n > 0 {
        return Err(Refusal::error(format!("the array of {n} {what} is NULL")));
    }
    Ok(())
}

/// The importer's array to read; empty arrays may be NULL.
unsafe fn read<'a, T>(pointer: *const T, n: usize, what: &str) -> Result<&'a [T], Refusal> {
    count(n, pointer.is_null(), what)?;
    Ok(if n == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, n) } })
}

/// The importer's array to write; empty arrays may be NULL.
unsafe fn write<'a, T>(pointer: *mut T, n: usize, what: &str) -> Result<&'a mut [T], Refusal> {
    count(n, pointer.is_null(), what)?;
    Ok(if n == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, n) } })
}

/// Fills `values` by asking for each reference; on refusal nothing is written.
unsafe fn get_each<T: Copy>(
    component: fmi2Component,
    vr: *const fmi2ValueReference,
    n: usize,
    values: *mut T,
    get: impl Fn(&mut Instance, fmi2ValueReference) -> Result<T, Refusal>,
) -> fmi2Status {
    unsafe {
        guarded(component, Call::Get, |instance| {
            let references = read(vr, n, "value references")?;
            let values = write(values, n, "values")?;
            for reference in references {
                get(instance, *reference)?;
            }
            for (value, reference) in values.iter_mut().zip(references) {
                *value = get(instance, *reference)?;
            }
            Ok(())
        })
    }
}

/// Hands each reference with its value to `set`.
unsafe fn set_each<T: Copy>(
    component: fmi2Component,
    vr: *const fmi2ValueReference,
    n: usize,
    values: *const T,
    set: impl Fn(&mut Instance, fmi2ValueReference, T) -> Result<(), Refusal>,
) -> fmi2Status {
    unsafe {
        guarded(component, Call::Set, |instance| {
            let references = read(vr, n, "value references")?;
            for (reference, value) in references.iter().zip(read(values, n, "values")?) {
                set(instance, *reference, *value)?;
            }
            Ok(())
        })
    }
}

/// The platform's types.
#[no_mangle]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    fmi2TypesPlatform.as_ptr().cast()
}

/// The standard's version.
#[no_mangle]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    fmi2Version.as_ptr().cast()
}

/// A new instance, or NULL with the reason in the log.
#[no_mangle]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    let Some(functions) = (unsafe { functions.as_ref() }) else { return std::ptr::null_mut() };
    silence_panics();
    let name = unsafe { text(instanceName) }.unwrap_or_default();
    let log = Log::new(functions, CString::new(name.clone()).unwrap_or_default(), loggingOn != 0);
    let built = contained(|| {
        let guid = unsafe { text(fmuGUID) };
        let resources = unsafe { text(fmuResourceLocation) };
        instantiate(&name, fmuType, guid, resources, log.clone())
    });
    match built {
        Ok(Ok(instance)) => Box::into_raw(instance).cast(),
        Ok(Err(refusal)) => {
            log.reason(Status::Error, &refusal.reason);
            std::ptr::null_mut()
        }
        Err(panic) => {
            log.reason(Status::Fatal, &format!("internal fault in fmi2Instantiate: {panic}"));
            std::ptr::null_mut()
        }
    }
}

fn instantiate(
    name: &str,
    kind: fmi2Type,
    guid: Option<String>,
    resources: Option<String>,
    log: Log,
) -> Result<Box<Instance>, Refusal> {
    if name.trim().is_empty() {
        return Err(Refusal::error("instanceName is empty: give the instance a name"));
    }
    if kind != fmi2Type_fmi2CoSimulation {
        return Err(Refusal::error(format!(
            "fmuType = {kind}: allowed is fmi2CoSimulation (1); this FMU offers no model exchange"
        )));
    }
    let resources = resources.and_then(|location| uri::folder(&location));
    let instance = Instance::new(log, resources)?;
    match guid {
        Some(guid) if guid == instance.guid => Ok(Box::new(instance)),
        other => Err(Refusal::error(format!(
            "fmuGUID = {}: allowed is {}; the modelDescription.xml in use belongs to another build, \
             unpack the FMU anew",
            other.as_deref().unwrap_or("NULL"),
            instance.guid
        ))),
    }
}

/// Frees an instance; NULL is ignored.
#[no_mangle]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    if !c.is_null() {
        let instance = unsafe { Box::from_raw(c.cast::<Instance>()) };
        // A panic while dropping has nobody left to be told to.
        let _ = contained(|| drop(instance));
    }
}

/// Which categories are logged.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SetDebugLogging, |instance| {
            let names = read(categories, nCategories, "categories")?;
            let names: Vec<String> = names.iter().filter_map(|name| text(*name)).collect();
            let unknown = instance.log.listen(loggingOn != 0, &names);
            if unknown.is_empty() {
                return Ok(());
            }
            let known: Vec<_> = super::log::Category::ALL.iter().map(|c| c.name()).collect();
            Err(Refusal::warning(format!(
                "unknown log category {}: allowed are {}; the others are set",
                unknown.join(", "),
                known.join(", ")
            )))
        })
    }
}

/// Start and stop time; the model's own tolerance is the parameter `solver.tolerance`.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    unsafe {
        guarded(c, Call::SetupExperiment, |instance| {
            if toleranceDefined != 0 {
                instance
                    .log
                    .event(|| format!("tolerance {tolerance} is not used, solver.tolerance holds"));
            }
            instance.clock.set_up(startTime, (stopTimeDefined != 0).then_some(stopTime))
        })
    }
}

/// Inputs and fixed parameters settle the block's rest from here on.
#[no_mangle]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
    unsafe {
        guarded(c, Call::EnterInitializationMode, |instance| {
            instance.phase = Phase::Initialization;
            Ok(())
        })
    }
}

/// Puts the block at rest.
#[no_mangle]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
    unsafe { guarded(c, Call::ExitInitializationMode, Instance::exit_initialization) }
}

/// Ends the simulation; values can still be read.
#[no_mangle]
pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> fmi2Status {
    unsafe {
        guarded(c, Call::Terminate, |instance| {
            instance.phase = Phase::Terminated;
            Ok(())
        })
    }
}

/// As new.
#[no_mangle]
pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> fmi2Status {
    unsafe {
        guarded(c, Call::Reset, |instance| {
            instance.reset();
            Ok(())
        })
    }
}

/// Real values.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> fmi2Status {
    unsafe { get_each(c, vr, nvr, value, |instance, vr| instance.real(vr)) }
}

/// Integer and enumeration values.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> fmi2Status {
    unsafe {
        get_each(c, vr, nvr, value, |instance, vr| match instance.value(vr, Type::Integer)? {
            Value::Integer(i) => Ok(i),
            _ => Err(Refusal::error(format!("value reference {vr} holds no integer"))),
        })
    }
}

/// Boolean values.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    unsafe {
        get_each(c, vr, nvr, value, |instance, vr| match instance.value(vr, Type::Boolean)? {
            Value::Boolean(b) => Ok(fmi2Boolean::from(b)),
            _ => Err(Refusal::error(format!("value reference {vr} holds no boolean"))),
        })
    }
}

/// Texts; they live until the next call on this instance.
#[no_mangle]
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2String,
) -> fmi2Status {
    unsafe { get_each(c, vr, nvr, value, |instance, vr| instance.text(vr)) }
}

/// Sets inputs and parameters.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> fmi2Status {
    unsafe { set_each(c, vr, nvr, value, |instance, vr, x| instance.set_real(vr, x)) }
}

/// Sets integer parameters and enumerations.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> fmi2Status {
    unsafe {
        set_each(c, vr, nvr, value, |instance, vr, i| {
            instance.set_value(vr, Type::Integer, &Value::Integer(i))
        })
    }
}

/// Sets boolean parameters; everything but 0 is true.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Boolean,
) -> fmi2Status {
    unsafe {
        set_each(c, vr, nvr, value, |instance, vr, b| {
            instance.set_value(vr, Type::Boolean, &Value::Boolean(b != 0))
        })
    }
}

/// Sets text parameters.
#[no_mangle]
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2String,
) -> fmi2Status {
    unsafe {
        set_each(c, vr, nvr, value, |instance, vr, pointer| {
            let Some(text) = text(pointer) else {
                return Err(Refusal::error(format!("the text for value reference {vr} is NULL")));
            };
            instance.set_value(vr, Type::Text, &Value::Text(text))
        })
    }
}

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

/// Derivatives of inputs for the next step.
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
            let orders = read(order, nvr, "orders")?.iter();
            let values = orders.zip(read(value, nvr, "values")?);
            for (reference, (order, value)) in read(vr, nvr, "value references")?.iter().zip(values)
            {
                instance.set_input_derivative(*reference, *order, *value)?;
            }
            Ok(())
        })
    }
}

/// Derivatives of outputs at the end of the last step.
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
            let orders = read(order, nvr, "orders")?;
            let values = write(value, nvr, "values")?.iter_mut().zip(orders);
            for (reference, (value, order)) in read(vr, nvr, "value references")?.iter().zip(values)
            {
                *value = instance.output_derivative(*reference, *order)?;
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

/// fmi2LastSuccessfulTime: the time [s] up to which the solution is good.
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
