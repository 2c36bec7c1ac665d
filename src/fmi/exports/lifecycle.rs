//! From `fmi2Instantiate` to `fmi2FreeInstance`.
#![allow(non_snake_case, clippy::missing_safety_doc)]

use super::super::instance::Instance;
use super::super::log::{Category, Log};
use super::super::phase::{Call, Phase};
use super::super::{uri, Refusal, Status};
use super::guard::{contained, guarded, read, silence_panics, text};
use fmi_sys::fmi2::*;
use std::ffi::{c_char, CString};

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
            let known: Vec<_> = Category::ALL.iter().map(|c| c.name()).collect();
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
