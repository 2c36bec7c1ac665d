//! What has gone wrong in other FMUs, by name.

use crate::fmi::*;
use std::ffi::CString;
use std::ptr::{null, null_mut};
use tread_block::fmi::exports::*;
use tread_block::fmi::variables;

#[test]
fn unknown_references_are_named_whatever_they_are_asked_for() {
    let unknown = variables::all().len() as u32;
    for reference in [unknown, unknown + 1, i32::MAX as u32, u32::MAX] {
        let (real, integer, text) = (0.0, 0, null());
        let asked: [&dyn Fn(fmi2Component) -> u32; 10] = [
            &|c| unsafe { fmi2GetReal(c, &reference, 1, &mut { real }) },
            &|c| unsafe { fmi2GetInteger(c, &reference, 1, &mut { integer }) },
            &|c| unsafe { fmi2GetBoolean(c, &reference, 1, &mut { integer }) },
            &|c| unsafe { fmi2GetString(c, &reference, 1, &mut { text }) },
            &|c| unsafe { fmi2SetReal(c, &reference, 1, &1.0) },
            &|c| unsafe { fmi2SetInteger(c, &reference, 1, &1) },
            &|c| unsafe { fmi2SetBoolean(c, &reference, 1, &1) },
            &|c| unsafe { fmi2SetString(c, &reference, 1, &c"x".as_ptr()) },
            &|c| unsafe { fmi2SetRealInputDerivatives(c, &reference, 1, &1, &1.0) },
            &|c| unsafe { fmi2GetRealOutputDerivatives(c, &reference, 1, &1, &mut { real }) },
        ];
        for (number, ask) in asked.iter().enumerate() {
            let fmu = Fmu::ready();
            fmu.slide(0, 1, 1e-5);
            assert_eq!(ask(fmu.c), ERROR, "function {number}, reference {reference}");
            assert!(
                fmu.last_message().contains(&reference.to_string()),
                "function {number}: {}",
                fmu.last_message()
            );
        }
    }
}

#[test]
fn absurd_sizes_are_refused_before_anything_is_read() {
    let one = 0_u32;
    for n in [usize::MAX, usize::MAX / 8, 1 << 40, (1 << 20) + 1] {
        let fmu = Fmu::ready();
        let mut value = 0.0;
        assert_eq!(unsafe { fmi2GetReal(fmu.c, &one, n, &mut value) }, ERROR);
        assert!(fmu.last_message().contains(&n.to_string()), "{}", fmu.last_message());
        let fmu = Fmu::ready();
        let mut state = null_mut();
        let byte = 0_i8;
        let status = unsafe { fmi2DeSerializeFMUstate(fmu.c, &byte, n, &mut state) };
        assert_eq!(status, ERROR, "{n} bytes");
        assert!(state.is_null());
    }
}

#[test]
fn steps_that_are_none_change_nothing() {
    let absurd = [0.0, -0.0, -1e-5, f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, 5e-324];
    for h in absurd {
        let fmu = Fmu::ready();
        let before = fmu.slide(0, 5, 1e-5).pop().unwrap();
        assert_eq!(fmu.step(5e-5, h), ERROR, "{h}");
        assert!(fmu.last_message().contains("communicationStepSize"), "{}", fmu.last_message());
        assert_eq!(fmu.outputs(), before, "{h}");
    }
    for t in [f64::NAN, f64::INFINITY, -1.0, 1e300, 0.0] {
        let fmu = Fmu::ready();
        let before = fmu.slide(0, 5, 1e-5).pop().unwrap();
        assert_eq!(fmu.step(t, 1e-5), ERROR, "{t}");
        assert!(fmu.last_message().contains("currentCommunicationPoint"), "{}", fmu.last_message());
        assert_eq!(fmu.outputs(), before, "{t}");
    }
}

#[test]
fn numbers_that_are_none_are_refused_by_name_for_every_input_and_parameter() {
    for (reference, variable) in variables::all().iter().enumerate() {
        if variable.unit().is_none() || !["input", "parameter"].contains(&variable.causality()) {
            continue;
        }
        for x in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            let fmu = Fmu::new();
            let status = unsafe { fmi2SetReal(fmu.c, &(reference as u32), 1, &x) };
            assert_eq!(status, ERROR, "{} = {x}", variable.name);
            assert!(fmu.last_message().contains(&variable.name), "{}", fmu.last_message());
        }
    }
}

#[test]
fn an_instance_is_made_without_a_logger_and_refuses_silently() {
    let messages = Messages::default();
    let mut functions = callbacks(&messages);
    functions.logger = None;
    let (name, guid) = (c"block", CString::new(guid()).unwrap());
    unsafe {
        let c = fmi2Instantiate(name.as_ptr(), 1, guid.as_ptr(), null(), &functions, 0, 1);
        assert!(!c.is_null());
        assert_eq!(fmi2DoStep(c, 0.0, 1e-5, 1), ERROR);
        fmi2FreeInstance(c);
        let null_name = fmi2Instantiate(null(), 1, guid.as_ptr(), null(), &functions, 0, 1);
        assert!(null_name.is_null());
        let null_guid = fmi2Instantiate(name.as_ptr(), 1, null(), null(), &functions, 0, 1);
        assert!(null_guid.is_null());
    }
}

#[test]
fn resources_are_found_in_every_spelling_of_their_place() {
    let folder = std::env::temp_dir().join(format!("tread fmu Glätte {}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("parameters.toml"), "[friction]\nmu_inf = 0.625\n").unwrap();
    let plain = folder.to_str().unwrap().to_string();
    let escaped = plain.replace(' ', "%20").replace('ä', "%C3%A4");
    let spellings = [
        format!("file://{escaped}"),
        format!("file:{escaped}"),
        format!("file://localhost{escaped}"),
        format!("FILE://{escaped}/"),
        format!("file://{plain}"),
        plain.clone(),
    ];
    let found: Vec<_> = spellings
        .iter()
        .map(|spelling| {
            let fmu = Fmu::try_new("block", 1, &guid(), Some(spelling));
            assert!(!fmu.c.is_null(), "{spelling}: {}", fmu.last_message());
            fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
            fmu.get("friction.mu_inf")
        })
        .collect();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(found, vec![0.625; spellings.len()]);
    for nowhere in
        ["", "  ", "https://somewhere/resources", "file:///no/such/folder", "file:", "%%%"]
    {
        let fmu = Fmu::try_new("block", 1, &guid(), Some(nowhere));
        assert!(!fmu.c.is_null(), "a missing folder is no reason to refuse: {nowhere:?}");
    }
}

#[test]
fn a_call_that_sets_many_sets_all_or_none() {
    let names = ["normal_load", "friction.mu_inf"];
    let references = names.map(vr);
    for bad in [[80.0, 99.0], [f64::NAN, 0.5]] {
        let fmu = Fmu::new();
        let before = names.map(default_of);
        assert_eq!(unsafe { fmi2SetReal(fmu.c, references.as_ptr(), 2, bad.as_ptr()) }, ERROR);
        // Reading is allowed in the error state, setting is not.
        assert_eq!(names.map(|name| fmu.get(name)), before, "{bad:?}");
    }
    let fmu = Fmu::ready();
    let inputs = [vr("belt.x"), vr("normal_load")];
    let status = unsafe { fmi2SetReal(fmu.c, inputs.as_ptr(), 2, [1e-3, -5.0].as_ptr()) };
    assert_eq!((status, fmu.get("belt.x")), (ERROR, 0.0));
}

fn default_of(name: &str) -> f64 {
    let fmu = Fmu::new();
    fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
    fmu.get(name)
}

/// A pipe would keep the importer waiting, a device would fill its memory.
#[cfg(unix)]
#[test]
fn a_parameter_file_that_is_none_is_refused_at_once() {
    let film = std::env::temp_dir().join(format!("tread-film-{}", std::process::id()));
    std::fs::File::create(&film).unwrap().set_len(5 << 30).unwrap();
    for path in ["/dev/zero", "/dev/stdin", "/", "/no/such/file", film.to_str().unwrap()] {
        let fmu = Fmu::new();
        let text = CString::new(path).unwrap();
        let file = vr(variables::PARAMETER_FILE);
        assert_eq!(unsafe { fmi2SetString(fmu.c, &file, 1, &text.as_ptr()) }, ERROR, "{path}");
        assert!(fmu.last_message().contains(path), "{}", fmu.last_message());
    }
    std::fs::remove_file(&film).unwrap();
}
