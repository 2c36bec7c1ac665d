//! The state machine: every function in every state, through the C functions themselves.

#[path = "common/fmi.rs"]
mod fmi;

use fmi::*;
use fmi_sys::fmi2::*;
use std::ptr::{null, null_mut};
use tread_block::fmi::exports::*;
use tread_block::fmi::phase::{allows, Call, Phase, ALLOWED};

/// Brings a new instance into `phase`; `None` for phases that a synchronous FMU never reaches.
fn in_phase(phase: Phase) -> Option<Fmu> {
    let fmu = Fmu::new();
    let c = fmu.c;
    fmu.coarse();
    unsafe {
        match phase {
            Phase::Instantiated => {}
            Phase::Initialization => fmu.call(|c| fmi2EnterInitializationMode(c)),
            Phase::StepComplete => fmu.initialize(),
            Phase::Terminated => {
                fmu.initialize();
                fmu.call(|c| fmi2Terminate(c));
            }
            Phase::Error => {
                fmu.initialize();
                assert_eq!(fmi2DoStep(c, 0.0, -1.0, 1), ERROR);
            }
            _ => return None,
        }
    }
    Some(fmu)
}

/// Makes `call` with arguments that are fine by themselves.
fn make(call: Call, fmu: &Fmu, state: fmi2FMUstate) -> u32 {
    let c = fmu.c;
    let (force, load) = (vr("force.x"), vr("normal_load"));
    let (mut real, mut size, mut slot) = (1.0, 0, null_mut());
    unsafe {
        match call {
            Call::SetDebugLogging => fmi2SetDebugLogging(c, 0, 0, null()),
            Call::SetupExperiment => fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0),
            Call::EnterInitializationMode => fmi2EnterInitializationMode(c),
            Call::ExitInitializationMode => fmi2ExitInitializationMode(c),
            Call::Terminate => fmi2Terminate(c),
            Call::Reset => fmi2Reset(c),
            Call::Get => fmi2GetReal(c, &force, 1, &mut real),
            Call::Set => fmi2SetReal(c, &load, 1, &real),
            Call::GetState => {
                let status = fmi2GetFMUstate(c, &mut slot);
                fmi2FreeFMUstate(Fmu::new().c, &mut slot);
                status
            }
            Call::SetState => fmi2SetFMUstate(c, state),
            Call::FreeState => fmi2FreeFMUstate(c, &mut slot),
            Call::SerializeState => fmi2SerializedFMUstateSize(c, state, &mut size),
            Call::SetInputDerivatives => fmi2SetRealInputDerivatives(c, &load, 1, &1, &real),
            Call::GetOutputDerivatives => fmi2GetRealOutputDerivatives(c, &force, 1, &1, &mut real),
            Call::DoStep => fmi2DoStep(c, 0.0, 1e-5, 1),
            Call::CancelStep => fmi2CancelStep(c),
            Call::GetStatus => {
                fmi2GetRealStatus(c, fmi2StatusKind_fmi2LastSuccessfulTime, &mut real)
            }
            Call::ModelExchange => fmi2EnterEventMode(c),
            Call::FreeInstance | Call::GetDirectionalDerivative => OK,
        }
    }
}

#[test]
fn every_function_answers_in_every_state_as_the_standards_table_says() {
    let donor = Fmu::ready();
    let mut state = null_mut();
    assert_eq!(unsafe { fmi2GetFMUstate(donor.c, &mut state) }, OK);
    let mut tried = 0;
    for phase in Phase::ALL {
        for (call, _) in ALLOWED {
            // Freeing is done by every instance here; directional derivatives are not offered.
            if matches!(call, Call::FreeInstance | Call::GetDirectionalDerivative) {
                continue;
            }
            let Some(fmu) = in_phase(phase) else { continue };
            let status = make(*call, &fmu, state);
            let expected = if allows(phase, *call) { OK } else { ERROR };
            assert_eq!(status, expected, "{call:?} in {phase:?}: {:?}", fmu.messages);
            if expected == ERROR {
                let reason = fmu.last_message();
                assert!(reason.contains("not allowed in the state"), "{call:?}: {reason}");
            }
            tried += 1;
        }
    }
    assert_eq!(tried, 5 * 18, "five states are reachable without asynchronous steps or a fault");
    assert_eq!(unsafe { fmi2FreeFMUstate(donor.c, &mut state) }, OK);
    assert!(state.is_null());
}

#[test]
fn a_null_component_is_an_error_and_freeing_it_does_nothing() {
    unsafe {
        fmi2FreeInstance(null_mut());
        assert_eq!(fmi2DoStep(null_mut(), 0.0, 1e-5, 1), ERROR);
        assert_eq!(fmi2Reset(null_mut()), ERROR);
        assert_eq!(fmi2GetReal(null_mut(), null(), 0, null_mut()), ERROR);
    }
}

#[test]
fn no_variables_may_come_as_null_pointers_but_some_may_not() {
    let fmu = Fmu::ready();
    unsafe {
        assert_eq!(fmi2GetReal(fmu.c, null(), 0, null_mut()), OK);
        assert_eq!(fmi2SetString(fmu.c, null(), 0, null()), OK);
        assert_eq!(fmi2GetReal(fmu.c, null(), 3, null_mut()), ERROR);
        assert!(fmu.last_message().contains("NULL"));
    }
}

#[test]
fn an_instance_that_cannot_be_made_says_why() {
    let cases = [
        (Fmu::try_new("", 1, &guid(), None), "instanceName"),
        (Fmu::try_new("a", 0, &guid(), None), "fmuType"),
        (Fmu::try_new("a", 1, "wrong", None), "fmuGUID = wrong"),
    ];
    for (fmu, reason) in cases {
        assert!(fmu.c.is_null());
        assert!(fmu.last_message().contains(reason), "{}", fmu.last_message());
    }
    let name = c"a";
    let c = unsafe { fmi2Instantiate(name.as_ptr(), 1, name.as_ptr(), null(), null(), 0, 0) };
    assert!(c.is_null(), "no callbacks, no instance");
}

#[test]
fn bad_input_is_named_and_leaves_the_values_as_they_were() {
    let cases: [(&str, &dyn Fn(&Fmu) -> u32); 8] = [
        ("belt.x", &|f| f.set("belt.x", f64::NAN)),
        ("normal_load", &|f| f.set("normal_load", -1.0)),
        ("normal_load", &|f| f.set("normal_load", f64::INFINITY)),
        ("block.length is a fixed parameter", &|f| f.set("block.length", 0.02)),
        ("friction.mu_inf", &|f| f.set("friction.mu_inf", 99.0)),
        ("communicationStepSize = 0", &|f| f.step(1e-4, 0.0)),
        ("currentCommunicationPoint", &|f| f.step(0.5, 1e-5)),
        ("belt.x", &|f| {
            assert_eq!(f.set("belt.x", 0.1), OK);
            f.step(1e-4, 1e-5)
        }),
    ];
    for (reason, act) in cases {
        let fmu = Fmu::ready();
        let before = fmu.slide(0, 10, 1e-5).pop().unwrap();
        assert_eq!(act(&fmu), ERROR, "{reason}");
        assert!(fmu.last_message().contains(reason), "{reason}: {}", fmu.last_message());
        assert_eq!(fmu.outputs(), before, "{reason}");
    }
}

#[test]
fn a_stop_time_is_kept_but_rounding_is_forgiven() {
    let fmu = Fmu::new();
    let stop = 3.0 / 60.0;
    unsafe {
        assert_eq!(fmi2SetupExperiment(fmu.c, 0, 0.0, 0.0, 1, stop), OK);
        fmu.call(|c| fmi2EnterInitializationMode(c));
        fmu.call(|c| fmi2ExitInitializationMode(c));
        let h = 1.0 / 60.0;
        for t in [0.0, h, h + h] {
            assert_eq!(fmi2DoStep(fmu.c, t, h, 1), OK, "{:?}", fmu.messages);
        }
        assert_eq!(fmi2DoStep(fmu.c, 3.0 * h, h, 1), ERROR);
        assert!(fmu.last_message().contains("stopTime"));
    }
}

#[test]
fn the_status_functions_answer_as_for_a_synchronous_fmu() {
    let fmu = Fmu::ready();
    fmu.slide(0, 3, 1e-5);
    let (mut time, mut flag, mut status) = (f64::NAN, 7, 7);
    let mut text = null();
    unsafe {
        let last = fmi2StatusKind_fmi2LastSuccessfulTime;
        assert_eq!(fmi2GetRealStatus(fmu.c, last, &mut time), OK);
        assert!((time - 3e-5).abs() < 1e-18);
        assert_eq!(fmi2GetBooleanStatus(fmu.c, fmi2StatusKind_fmi2Terminated, &mut flag), OK);
        assert_eq!(flag, 0);
        assert_eq!(fmi2GetStatus(fmu.c, fmi2StatusKind_fmi2DoStepStatus, &mut status), DISCARD);
        let pending = fmi2StatusKind_fmi2PendingStatus;
        assert_eq!(fmi2GetStringStatus(fmu.c, pending, &mut text), DISCARD);
        assert_eq!(fmu.step(3e-5, 1e-5), OK, "asking is no failure");
    }
}

#[test]
fn an_unknown_log_category_is_a_warning_that_names_it() {
    let fmu = Fmu::new();
    let names = [c"logAll".as_ptr(), c"logNonsense".as_ptr()];
    assert_eq!(unsafe { fmi2SetDebugLogging(fmu.c, 1, 2, names.as_ptr()) }, WARNING);
    assert!(fmu.last_message().contains("logNonsense"));
}

#[test]
fn the_committed_description_is_what_the_code_writes() {
    let committed = include_str!("../modelDescription/modelDescription.xml");
    let written = tread_block::fmi::model_description::xml();
    assert!(
        committed == written,
        "run `tread fmu describe --format xml > modelDescription/modelDescription.xml`"
    );
    assert!(written.contains(&guid()));
    assert!(!guid().contains('{'));
}

#[test]
fn every_unit_of_the_table_is_known() {
    for variable in tread_block::fmi::variables::all() {
        if let Some((unit, _)) = variable.unit() {
            assert!(
                tread_block::fmi::units::exponents(unit).is_some(),
                "{}: {unit}",
                variable.name
            );
        }
    }
}
