//! States, reset, step sequences: the same bits where the same bits are due.

#[path = "common/fmi.rs"]
mod fmi;

use fmi::*;
use std::ptr::null_mut;
use tread_block::block::{TreadBlock, OUTPUTS};
use tread_block::drive::{Pose, Predictor};
use tread_block::fmi::exports::*;
use tread_block::Params;

const H: f64 = 1e-5;

/// Serializes the state of `fmu`.
fn bytes_of(fmu: &Fmu) -> Vec<i8> {
    let mut state = null_mut();
    let mut size = 0;
    unsafe {
        assert_eq!(fmi2GetFMUstate(fmu.c, &mut state), OK);
        assert_eq!(fmi2SerializedFMUstateSize(fmu.c, state, &mut size), OK);
        let mut bytes = vec![0; size];
        assert_eq!(fmi2SerializeFMUstate(fmu.c, state, bytes.as_mut_ptr().cast(), size), OK);
        assert_eq!(fmi2FreeFMUstate(fmu.c, &mut state), OK);
        bytes
    }
}

/// Puts `fmu` where `bytes` say.
fn resume(fmu: &Fmu, bytes: &[i8]) -> u32 {
    let mut state = null_mut();
    unsafe {
        let status = fmi2DeSerializeFMUstate(fmu.c, bytes.as_ptr().cast(), bytes.len(), &mut state);
        if status != OK {
            return status;
        }
        let status = fmi2SetFMUstate(fmu.c, state);
        fmi2FreeFMUstate(fmu.c, &mut state);
        status
    }
}

#[test]
fn the_fmu_gives_the_bits_of_the_library() {
    let mut params = Params::default();
    (params.solver.elements_along, params.solver.elements_up) = (3, 2);
    let mut block = TreadBlock::new(&params).unwrap();
    block.initialize(0.0, Pose { load: 56.25, ..Pose::default() }).unwrap();
    let mut predictor = Predictor::default();
    let results = Fmu::ready().slide(0, 300, H);
    for (k, row) in results.iter().enumerate() {
        let t = k as f64 * H;
        let pose = Pose { x: belt_x(t), load: 56.25, ..Pose::default() };
        block.advance(H, &predictor.segment(t, H, Predictor::known(pose))).unwrap();
        let expected: Vec<f64> = OUTPUTS
            .iter()
            .flat_map(|spec| (0..spec.size).map(|i| (spec.get)(block.outputs(), i)))
            .collect();
        assert_eq!(*row, expected, "step {k}");
    }
    let moved = results.last().unwrap()[5].abs();
    assert!(moved > 1e-5, "the edge moved by {moved} m, so there was something to compare");
}

#[test]
fn a_restored_state_continues_bit_for_bit_also_in_another_instance() {
    let fmu = Fmu::ready();
    fmu.slide(0, 150, H);
    let bytes = bytes_of(&fmu);
    let expected = fmu.slide(150, 100, H);
    assert_eq!(resume(&fmu, &bytes), OK);
    assert_eq!(fmu.slide(150, 100, H), expected, "in the same instance");
    let other = Fmu::new();
    assert_eq!(resume(&other, &bytes), OK, "{:?}", other.messages);
    assert_eq!(other.slide(150, 100, H), expected, "in another instance");
    assert_eq!(bytes_of(&other), bytes_of(&Fmu::from_bytes(&bytes_of(&other))), "the bytes too");
}

impl Fmu {
    fn from_bytes(bytes: &[i8]) -> Self {
        let fmu = Self::new();
        assert_eq!(resume(&fmu, bytes), OK);
        fmu
    }
}

#[test]
fn a_state_heals_an_instance_in_error() {
    let fmu = Fmu::ready();
    fmu.slide(0, 20, H);
    let bytes = bytes_of(&fmu);
    assert_eq!(fmu.step(99.0, H), ERROR);
    assert_eq!(fmu.step(20.0 * H, H), ERROR, "an instance in error does not step");
    assert_eq!(resume(&fmu, &bytes), OK);
    fmu.slide(20, 5, H);
}

#[test]
fn tuned_parameters_are_part_of_the_state() {
    let fmu = Fmu::ready();
    fmu.slide(0, 50, H);
    assert_eq!(fmu.set("friction.mu_inf", 0.8), OK);
    fmu.slide(50, 50, H);
    let bytes = bytes_of(&fmu);
    let expected = fmu.slide(100, 50, H);
    let other = Fmu::from_bytes(&bytes);
    assert_eq!(other.get("friction.mu_inf"), 0.8);
    assert_eq!(other.slide(100, 50, H), expected);
}

#[test]
fn damaged_states_are_refused_and_change_nothing() {
    let fmu = Fmu::ready();
    fmu.slide(0, 20, H);
    let good = bytes_of(&fmu);
    let mut wrong: Vec<Vec<i8>> = vec![vec![], vec![0; 10], good[..good.len() - 1].to_vec()];
    for at in [0, 8, 12, 48, 56, 60, good.len() / 2, good.len() - 1] {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        wrong.push(bytes);
    }
    for bytes in &wrong {
        let fmu = Fmu::from_bytes(&good);
        let before = fmu.outputs();
        assert_eq!(resume(&fmu, bytes), ERROR);
        assert!(fmu.last_message().contains("FMU state"), "{}", fmu.last_message());
        assert_eq!(fmu.outputs(), before);
    }
}

#[test]
fn reset_is_a_new_instance_bit_for_bit() {
    let fresh = Fmu::ready().slide(0, 100, H);
    let fmu = Fmu::ready();
    fmu.set("friction.mu_inf", 0.9);
    fmu.slide(0, 37, 2.0 * H);
    fmu.call(|c| unsafe { fmi2Reset(c) });
    fmu.initialize();
    assert_eq!(fmu.slide(0, 100, H), fresh);
}

#[test]
fn outputs_in_initialization_mode_are_those_after_it_and_follow_the_inputs() {
    let fmu = Fmu::new();
    assert_eq!(fmu.set("normal_load", 20.0), OK);
    fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
    let light = fmu.get("contact.force.z");
    assert_eq!(fmu.set("normal_load", 60.0), OK);
    let heavy = fmu.get("contact.force.z");
    // Static equilibrium: the road carries the load; 1e-6 is the solver's own tolerance.
    assert!(
        (light - 20.0).abs() < 1e-6 * 20.0 && (heavy - 60.0).abs() < 1e-6 * 60.0,
        "{light} {heavy}"
    );
    assert!((fmu.get("block.mass") - 1100.0 * 0.01 * 0.015 * 0.015).abs() < 1e-15);
    fmu.call(|c| unsafe { fmi2ExitInitializationMode(c) });
    assert_eq!(fmu.get("contact.force.z"), heavy);
}

#[test]
fn a_step_that_jitters_in_the_last_digits_is_a_step() {
    let even = Fmu::ready();
    let jittery = Fmu::ready();
    let reference = even.slide(0, 200, H).pop().unwrap();
    let mut t = 0.0;
    for k in 0..200 {
        let next = (k + 1) as f64 * H * (1.0 + if k % 2 == 0 { 2e-14 } else { -2e-14 });
        assert_eq!(jittery.set("belt.x", belt_x(t)), OK);
        assert_eq!(jittery.step(t, next - t), OK, "{:?}", jittery.messages);
        t = next;
    }
    for (a, b) in jittery.outputs().iter().zip(&reference) {
        // Differences of 1e-14 in time, seen through motions of 10 kHz that stick and slip.
        assert!((a - b).abs() <= 1e-6 * b.abs().max(1e-3), "{a} {b}");
    }
}

#[test]
fn input_derivatives_hold_for_one_step() {
    // belt.z in trajectory drive shows through carriage.z what the belt did.
    let fmu = Fmu::new();
    fmu.set_integer("drive.normal", 2);
    fmu.set("belt.z", 0.02);
    fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
    fmu.call(|c| unsafe { fmi2ExitInitializationMode(c) });
    let z = vr("belt.z");
    let h = 1e-4;
    unsafe {
        assert_eq!(
            fmi2SetRealInputDerivatives(
                fmu.c,
                [z, z].as_ptr(),
                2,
                [1, 2].as_ptr(),
                [1.0, 50.0].as_ptr()
            ),
            OK
        );
    }
    assert_eq!(fmu.step(0.0, h), OK);
    // Taylor: 0.02 + 1.0 h + 50 h²/2.
    let expected = 0.02 + h + 25.0 * h * h;
    assert!((fmu.get("carriage.z") - expected).abs() < 1e-15);
}

#[test]
fn output_derivatives_are_velocities_or_differences() {
    let fmu = Fmu::ready();
    fmu.slide(0, 60, H);
    let before = fmu.get("force.x");
    fmu.slide(60, 1, H);
    let references = [vr("force.x"), vr("run_in.displacement.x")];
    let mut rates = [f64::NAN; 2];
    unsafe {
        assert_eq!(
            fmi2GetRealOutputDerivatives(
                fmu.c,
                references.as_ptr(),
                2,
                [1, 1].as_ptr(),
                rates.as_mut_ptr()
            ),
            OK
        );
        assert_eq!(rates[0], (fmu.get("force.x") - before) / H);
        assert_eq!(rates[1], fmu.get("run_in.velocity.x"));
        assert_eq!(
            fmi2GetRealOutputDerivatives(
                fmu.c,
                references.as_ptr(),
                1,
                [0].as_ptr(),
                rates.as_mut_ptr()
            ),
            ERROR
        );
    }
}

#[test]
fn instances_in_threads_do_not_disturb_each_other() {
    let alone = Fmu::ready().slide(0, 100, H);
    std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..4).map(|_| scope.spawn(|| Fmu::ready().slide(0, 100, H))).collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), alone);
        }
    });
}

#[test]
fn a_parameter_file_is_read_and_single_parameters_win() {
    let folder = std::env::temp_dir().join(format!("tread block resources {}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("parameters.toml"), "[friction]\nmu_inf = 0.3\nmu_drop = 0.1\n")
        .unwrap();
    std::fs::write(
        folder.join("other.toml"),
        "[friction]\nmu_inf = 0.4\n[wear]\ncoefficient = 1.0\n",
    )
    .unwrap();
    std::fs::write(folder.join("bad.toml"), "[friction]\nmu_fin = 0.4\nmu_drop = 'a'\n").unwrap();
    let uri = format!("file://{}", folder.display()).replace(' ', "%20");
    let fmu = Fmu::try_new("a", 1, &guid(), Some(&uri));
    let set_file = |name: &std::ffi::CStr| unsafe {
        fmi2SetString(fmu.c, &vr("parameter_file"), 1, &name.as_ptr())
    };
    assert_eq!(fmu.set("wear.coefficient", 2.0), OK);
    assert_eq!(set_file(c"other.toml"), OK);
    fmu.call(|c| unsafe { fmi2EnterInitializationMode(c) });
    assert_eq!(fmu.get("friction.mu_inf"), 0.4, "from parameter_file");
    assert_eq!(fmu.get("friction.mu_drop"), 0.1, "from resources");
    assert_eq!(fmu.get("wear.coefficient"), 2.0, "set by hand");
    assert_eq!(set_file(c"bad.toml"), ERROR);
    let reason = fmu.last_message();
    assert!(
        reason.contains("mu_fin") && reason.contains("mu_drop"),
        "all problems at once: {reason}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
