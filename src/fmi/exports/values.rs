//! Values of variables in and out.
#![allow(non_snake_case, clippy::missing_safety_doc)]

use super::super::instance::Instance;
use super::super::phase::Call;
use super::super::variables::Type;
use super::super::Refusal;
use super::guard::{guarded, read, text, write};
use crate::params::Value;
use fmi_sys::fmi2::*;

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

/// Hands each reference with its value to `set`; on refusal of one none is set.
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
            let values = read(values, n, "values")?;
            let before = instance.settable(references);
            let mut pairs = references.iter().zip(values);
            let result = pairs.try_for_each(|(vr, value)| set(instance, *vr, *value));
            if result.is_err() {
                instance.put_back(before);
            }
            result
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
