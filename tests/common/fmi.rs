//! A small importer over the C functions, for the tests.
#![allow(dead_code, unused_imports)]

use std::ffi::{c_char, c_void, CStr, CString};
use std::sync::Mutex;
use tread_block::fmi::exports::*;
use tread_block::fmi::variables;

pub use fmi_sys::fmi2::{
    fmi2CallbackFunctions, fmi2Component, fmi2FMUstate, fmi2Status_fmi2Discard as DISCARD,
    fmi2Status_fmi2Error as ERROR, fmi2Status_fmi2OK as OK, fmi2Status_fmi2Warning as WARNING,
};

/// Messages of an instance: status, category, format, argument.
pub type Messages = Mutex<Vec<(u32, String, String)>>;

// The standard's logger is variadic, which stable Rust can call but not define. On x86-64 and
// aarch64 Linux a function of six plain arguments receives the same registers.
unsafe extern "C" fn logger(
    environment: *mut c_void,
    _name: *const c_char,
    status: u32,
    category: *const c_char,
    format: *const c_char,
    argument: *const c_char,
) {
    assert_eq!(CStr::from_ptr(format), c"%s", "user text must never be a format");
    let text = |p| CStr::from_ptr(p).to_string_lossy().into_owned();
    if let Some(messages) = (environment as *const Messages).as_ref() {
        messages.lock().unwrap().push((status, text(category), text(argument)));
    }
}

type Plain = unsafe extern "C" fn(
    *mut c_void,
    *const c_char,
    u32,
    *const c_char,
    *const c_char,
    *const c_char,
);
type Variadic =
    unsafe extern "C" fn(*mut c_void, *const c_char, u32, *const c_char, *const c_char, ...);

fn as_variadic(plain: Plain) -> Variadic {
    unsafe { std::mem::transmute::<Plain, Variadic>(plain) }
}

/// Callbacks that write to `messages`.
pub fn callbacks(messages: &Messages) -> fmi2CallbackFunctions {
    fmi2CallbackFunctions {
        logger: Some(as_variadic(logger)),
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: messages as *const Messages as *mut c_void,
    }
}

/// An instance with its log.
pub struct Fmu {
    pub c: fmi2Component,
    pub messages: Box<Messages>,
}

impl Drop for Fmu {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.c) }
    }
}

pub fn guid() -> String {
    tread_block::fmi::model_description::guid(&variables::all())
}

/// Value reference of a variable.
pub fn vr(name: &str) -> u32 {
    let all = variables::all();
    all.iter().position(|v| v.name == name).unwrap_or_else(|| panic!("no variable {name}")) as u32
}

impl Fmu {
    /// Calls fmi2Instantiate with these arguments.
    pub fn try_new(name: &str, kind: u32, guid: &str, resources: Option<&str>) -> Self {
        let messages = Box::new(Messages::default());
        let (name, guid) = (CString::new(name).unwrap(), CString::new(guid).unwrap());
        let resources = resources.map(|r| CString::new(r).unwrap());
        let pointer = resources.as_ref().map_or(std::ptr::null(), |r| r.as_ptr());
        let functions = callbacks(&messages);
        let c = unsafe {
            fmi2Instantiate(name.as_ptr(), kind, guid.as_ptr(), pointer, &functions, 0, 0)
        };
        Self { c, messages }
    }

    pub fn new() -> Self {
        let fmu = Self::try_new("test", 1, &guid(), None);
        assert!(!fmu.c.is_null(), "{:?}", fmu.messages);
        fmu
    }

    /// An instance of a coarse block that is ready to step, slid by [`Self::slide`].
    pub fn ready() -> Self {
        let fmu = Self::new();
        fmu.initialize();
        fmu
    }

    /// Coarse mesh, 56.25 N (0.25 N/mm²), initialized at t = 0.
    pub fn initialize(&self) {
        self.coarse();
        assert_eq!(self.set("normal_load", 56.25), OK);
        self.call(|c| unsafe { fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0) });
        self.call(|c| unsafe { fmi2EnterInitializationMode(c) });
        self.call(|c| unsafe { fmi2ExitInitializationMode(c) });
    }

    /// A mesh that is built quickly.
    pub fn coarse(&self) {
        assert_eq!(self.set_integer("solver.elements_along", 3), OK);
        assert_eq!(self.set_integer("solver.elements_up", 2), OK);
    }

    /// A call that must succeed.
    pub fn call(&self, mut f: impl FnMut(fmi2Component) -> u32) {
        assert_eq!(f(self.c), OK, "{:?}", self.messages);
    }

    pub fn set(&self, name: &str, value: f64) -> u32 {
        unsafe { fmi2SetReal(self.c, &vr(name), 1, &value) }
    }

    pub fn set_integer(&self, name: &str, value: i32) -> u32 {
        unsafe { fmi2SetInteger(self.c, &vr(name), 1, &value) }
    }

    pub fn get(&self, name: &str) -> f64 {
        let mut value = f64::NAN;
        assert_eq!(unsafe { fmi2GetReal(self.c, &vr(name), 1, &mut value) }, OK);
        value
    }

    /// All outputs.
    pub fn outputs(&self) -> Vec<f64> {
        let references: Vec<u32> = variables::all()
            .iter()
            .enumerate()
            .filter(|(_, v)| v.causality() == "output")
            .map(|(i, _)| i as u32)
            .collect();
        let mut values = vec![f64::NAN; references.len()];
        let status = unsafe {
            fmi2GetReal(self.c, references.as_ptr(), references.len(), values.as_mut_ptr())
        };
        assert_eq!(status, OK, "{:?}", self.messages);
        values
    }

    pub fn step(&self, t: f64, h: f64) -> u32 {
        unsafe { fmi2DoStep(self.c, t, h, 1) }
    }

    /// Drags the belt to −x at up to 0.3 m/s, `n` steps of `h` from step `from` on.
    pub fn slide(&self, from: usize, n: usize, h: f64) -> Vec<Vec<f64>> {
        (from..from + n)
            .map(|k| {
                let t = k as f64 * h;
                assert_eq!(self.set("belt.x", belt_x(t)), OK, "{:?}", self.messages);
                assert_eq!(self.step(t, h), OK, "{:?}", self.messages);
                self.outputs()
            })
            .collect()
    }

    /// Text of the last message.
    pub fn last_message(&self) -> String {
        self.messages.lock().unwrap().last().map(|m| m.2.clone()).unwrap_or_default()
    }
}

/// Belt position [m]: rest, a linear start over 0.5 ms, then −0.3 m/s.
pub fn belt_x(t: f64) -> f64 {
    let start = 0.5e-3;
    if t < start {
        -0.3 * t * t / (2.0 * start)
    } else {
        -0.3 * (t - 0.5 * start)
    }
}
