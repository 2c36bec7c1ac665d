//! FMI 2.0 co-simulation for any [`Stage`]: [`crate::export`] writes the C functions, which come here.
//!
//! # Safety
//! As for the block: a component is NULL or came from `fmi2Instantiate` and is not yet freed, arrays
//! hold as many elements as announced, texts end with a zero byte, one thread per instance at a time.

use crate::description;
use crate::stage::{Role, Stage, Variable};
use fmi_sys::fmi2::*;
use std::ffi::{c_char, CStr, CString};
use std::panic::{catch_unwind, AssertUnwindSafe};

const OK: fmi2Status = fmi2Status_fmi2OK;
const ERROR: fmi2Status = fmi2Status_fmi2Error;

/// Where an instance stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Instantiated,
    Initialization,
    Stepping,
    Terminated,
}

/// An instance of a stage.
pub struct Instance<S> {
    table: Vec<Variable>,
    values: Vec<f64>,
    rates: Vec<Option<f64>>,
    stage: Option<S>,
    time: f64,
    phase: Phase,
    name: CString,
    logger: fmi2CallbackLogger,
    environment: fmi2ComponentEnvironment,
}

/// What `fmi2GetFMUstate` keeps.
struct Kept<S> {
    values: Vec<f64>,
    rates: Vec<Option<f64>>,
    stage: Option<S>,
    time: f64,
    phase: Phase,
}

impl<S: Stage> Instance<S> {
    fn new(name: CString, functions: &fmi2CallbackFunctions) -> Self {
        let table = S::table();
        let mut made = Self {
            values: Vec::new(),
            rates: vec![None; table.len()],
            stage: None,
            time: 0.0,
            phase: Phase::Instantiated,
            name,
            logger: functions.logger,
            environment: functions.componentEnvironment,
            table,
        };
        made.clear();
        made
    }

    /// As new.
    pub fn reset(&mut self) -> Result<(), String> {
        self.clear();
        Ok(())
    }

    fn clear(&mut self) {
        self.values = self.table.iter().map(|variable| variable.start).collect();
        self.rates.fill(None);
        (self.stage, self.time, self.phase) = (None, 0.0, Phase::Instantiated);
    }

    /// `fmi2SetupExperiment`.
    pub fn set_up(&mut self, start: f64) -> Result<(), String> {
        self.time = start;
        if start.is_finite() {
            Ok(())
        } else {
            Err(format!("startTime = {start}: is not finite"))
        }
    }

    /// `fmi2EnterInitializationMode`.
    pub fn enter(&mut self) -> Result<(), String> {
        self.expect(Phase::Instantiated)?;
        self.phase = Phase::Initialization;
        self.begin()
    }

    /// `fmi2ExitInitializationMode`.
    pub fn exit(&mut self) -> Result<(), String> {
        self.expect(Phase::Initialization)?;
        self.begin()?;
        self.phase = Phase::Stepping;
        Ok(())
    }

    fn begin(&mut self) -> Result<(), String> {
        self.stage = Some(S::start(&mut self.values, self.time)?);
        Ok(())
    }

    /// `fmi2Terminate`.
    pub fn terminate(&mut self) -> Result<(), String> {
        self.expect(Phase::Stepping)?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// `fmi2DoStep`.
    pub fn step(&mut self, time: f64, h: f64) -> Result<(), String> {
        self.expect(Phase::Stepping)?;
        if !(h > 0.0 && h.is_finite()) || !((time - self.time).abs() <= 1e-3 * h) {
            return Err(format!(
                "a step of {h} s at t = {time} s: allowed is a positive step at {} s",
                self.time
            ));
        }
        let stage = self.stage.as_mut().ok_or("not initialized")?;
        stage.step(&mut self.values, &self.rates, time, h)?;
        self.rates.fill(None);
        self.time = time + h;
        Ok(())
    }

    fn expect(&self, phase: Phase) -> Result<(), String> {
        if self.phase == phase {
            return Ok(());
        }
        Err(format!("not allowed in the state {:?}, only in {phase:?}", self.phase))
    }

    fn variable(&self, reference: u32) -> Result<&Variable, String> {
        self.table
            .get(reference as usize)
            .ok_or(format!("no variable has the reference {reference}"))
    }

    /// One value of `fmi2SetReal`.
    pub fn set(&mut self, reference: u32, value: f64) -> Result<(), String> {
        let variable = self.variable(reference)?;
        let (low, high) = variable.range;
        let name = &variable.name;
        match variable.role {
            Role::Output => return Err(format!("{name} is an output")),
            Role::Parameter if self.phase != Phase::Instantiated => {
                return Err(format!("{name} is fixed after initialization"))
            }
            _ if !(low..=high).contains(&value) => {
                return Err(format!(
                    "{name} = {value}: allowed is {low} to {high} {}",
                    variable.unit
                ))
            }
            _ => self.values[reference as usize] = value,
        }
        Ok(())
    }

    /// One value of `fmi2GetReal`.
    pub fn get(&mut self, reference: u32) -> Result<f64, String> {
        self.variable(reference)?;
        Ok(self.values[reference as usize])
    }

    /// One value of `fmi2SetRealInputDerivatives`.
    pub fn set_rate(&mut self, reference: u32, order: i32, value: f64) -> Result<(), String> {
        let variable = self.variable(reference)?;
        if !S::TAKES_DERIVATIVES || variable.role != Role::Input || order != 1 {
            return Err(format!("derivative {order} of {} has no effect", variable.name));
        }
        self.rates[reference as usize] = Some(value).filter(|v| v.is_finite());
        Ok(())
    }

    /// One value of `fmi2GetRealOutputDerivatives`.
    pub fn rate(&mut self, reference: u32, order: i32) -> Result<f64, String> {
        let found = u32::try_from(order).ok().filter(|order| (1..=S::DERIVATIVES).contains(order));
        found
            .and_then(|order| self.stage.as_ref()?.derivative(reference as usize, order))
            .ok_or(format!("derivative {order} of variable {reference} cannot be given"))
    }

    fn keep(&self) -> Kept<S> {
        Kept {
            values: self.values.clone(),
            rates: self.rates.clone(),
            stage: self.stage.clone(),
            time: self.time,
            phase: self.phase,
        }
    }

    fn resume(&mut self, kept: &Kept<S>) {
        self.values.clone_from(&kept.values);
        self.rates.clone_from(&kept.rates);
        self.stage.clone_from(&kept.stage);
        (self.time, self.phase) = (kept.time, kept.phase);
    }

    fn log(&self, text: &str) {
        let Ok(text) = CString::new(text.replace('\0', " ")) else { return };
        if let Some(logger) = self.logger {
            // SAFETY: the importer's own function, valid until fmi2FreeInstance.
            unsafe {
                let (category, format) = (c"logStatusError".as_ptr(), c"%s".as_ptr());
                logger(
                    self.environment,
                    self.name.as_ptr(),
                    ERROR,
                    category,
                    format,
                    text.as_ptr(),
                );
            }
        }
    }
}

/// # Safety
/// See the module.
pub unsafe fn instantiate<S: Stage>(
    name: fmi2String,
    kind: fmi2Type,
    guid: fmi2String,
    functions: *const fmi2CallbackFunctions,
) -> fmi2Component {
    let text = |p: *const c_char| (!p.is_null()).then(|| unsafe { CStr::from_ptr(p) }.to_owned());
    let Some(functions) = (unsafe { functions.as_ref() }) else { return std::ptr::null_mut() };
    let instance = Box::new(Instance::<S>::new(text(name).unwrap_or_default(), functions));
    let (given, own) = (text(guid).unwrap_or_default(), description::guid::<S>());
    if kind == fmi2Type_fmi2CoSimulation && given.to_bytes() == own.as_bytes() {
        return Box::into_raw(instance).cast();
    }
    instance
        .log(&format!("fmuType {kind}, GUID {given:?}: allowed are co-simulation (1) and {own}"));
    std::ptr::null_mut()
}

/// # Safety
/// See the module.
pub unsafe fn free<S: Stage>(component: fmi2Component) {
    if !component.is_null() {
        drop(unsafe { Box::from_raw(component.cast::<Instance<S>>()) });
    }
}

/// Runs `body` on an instance; what goes wrong, a panic too, is logged and becomes fmi2Error.
///
/// # Safety
/// See the module.
pub unsafe fn with<S: Stage>(
    component: fmi2Component,
    body: impl FnOnce(&mut Instance<S>) -> Result<(), String>,
) -> fmi2Status {
    let Some(instance) = (unsafe { component.cast::<Instance<S>>().as_mut() }) else {
        return ERROR;
    };
    let result = catch_unwind(AssertUnwindSafe(|| body(instance)));
    let Err(reason) = result.unwrap_or_else(|_| Err("internal fault".into())) else { return OK };
    instance.log(&reason);
    ERROR
}

/// Does `body` for each of `n` elements of arrays that may only be NULL if there is none.
pub fn each(
    n: usize,
    null: bool,
    mut body: impl FnMut(usize) -> Result<(), String>,
) -> Result<(), String> {
    if null && n > 0 {
        return Err(format!("an array of {n} elements is NULL"));
    }
    (0..n).try_for_each(&mut body)
}

/// # Safety
/// See the module.
pub unsafe fn get_state<S: Stage>(c: fmi2Component, slot: *mut fmi2FMUstate) -> fmi2Status {
    unsafe {
        with::<S>(c, |instance| {
            let slot = slot.as_mut().ok_or("FMUstate is NULL")?;
            match slot.cast::<Kept<S>>().as_mut() {
                Some(old) => *old = instance.keep(),
                None => *slot = Box::into_raw(Box::new(instance.keep())).cast(),
            }
            Ok(())
        })
    }
}

/// # Safety
/// See the module.
pub unsafe fn set_state<S: Stage>(c: fmi2Component, state: fmi2FMUstate) -> fmi2Status {
    unsafe {
        with::<S>(c, |instance| {
            instance.resume(state.cast::<Kept<S>>().as_ref().ok_or("FMUstate is NULL")?);
            Ok(())
        })
    }
}

/// # Safety
/// See the module.
pub unsafe fn free_state<S: Stage>(c: fmi2Component, slot: *mut fmi2FMUstate) -> fmi2Status {
    unsafe {
        with::<S>(c, |_| {
            if let Some(slot) = slot.as_mut().filter(|slot| !slot.is_null()) {
                drop(Box::from_raw(slot.cast::<Kept<S>>()));
                *slot = std::ptr::null_mut();
            }
            Ok(())
        })
    }
}
