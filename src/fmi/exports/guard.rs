//! The one way from C into an instance: state check, panics, arrays, texts, log.

use super::super::instance::Instance;
use super::super::phase::{self, Call, Phase};
use super::super::{Refusal, Status};
use fmi_sys::fmi2::*;
use std::cell::Cell;
use std::ffi::{c_char, CStr};
use std::panic::{catch_unwind, AssertUnwindSafe, PanicHookInfo};
use std::sync::OnceLock;

/// More variables than this in one call are a slip of the importer, not a request.
const MAX_COUNT: usize = 1 << 20;

thread_local! {
    /// Is this thread inside a function of the FMU? Then a panic is the FMU's own.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Send + Sync>;

/// What panics met before: the compiler's own hook, but where the library is part of a program.
///
/// It is kept here and not in a closure, because that would lie on the heap and be lost whenever a host
/// unloads the library.
static OTHERS: OnceLock<Hook> = OnceLock::new();

/// Keeps panics inside the FMU off stderr; their text goes to the importer's logger instead.
pub(super) fn silence_panics() {
    OTHERS.get_or_init(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(|info| {
            if let Some(others) = OTHERS.get().filter(|_| !INSIDE.get()) {
                others(info);
            }
        }));
        others
    });
}

/// Runs `body`; a panic becomes its text.
pub(super) fn contained<T>(body: impl FnOnce() -> T) -> Result<T, String> {
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
pub(super) unsafe fn text(pointer: *const c_char) -> Option<String> {
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
pub(super) unsafe fn read<'a, T>(
    pointer: *const T,
    n: usize,
    what: &str,
) -> Result<&'a [T], Refusal> {
    count(n, pointer.is_null(), what)?;
    Ok(if n == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, n) } })
}

/// The importer's array to write; empty arrays may be NULL.
pub(super) unsafe fn write<'a, T>(
    pointer: *mut T,
    n: usize,
    what: &str,
) -> Result<&'a mut [T], Refusal> {
    count(n, pointer.is_null(), what)?;
    Ok(if n == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, n) } })
}
