//! Hostile hands: whatever comes through the C interface or out of a file, the process lives, the reason
//! is told, and nobody else is disturbed.
//!
//! `hands` tries by name what has gone wrong in other FMUs; `calls`, `states` and `files` try what nobody
//! thought of. They are property tests: a failure is shrunk to its smallest form and kept in
//! `tests/hostile/corpus/`, which every later run tries first. TREAD_FUZZ=20000 asks for that many inputs
//! of each kind (`make fuzz`); without it a short share runs, other inputs each time.
#![cfg(feature = "cli")]

#[path = "../common/fmi.rs"]
mod fmi;
#[path = "../common/play.rs"]
mod play;
#[path = "../common/swallow.rs"]
mod swallow;

mod calls;
mod files;
mod hands;
mod states;

use proptest::test_runner::{Config, FileFailurePersistence};

/// How many inputs, and where the failures among them are kept.
fn config(corpus: &'static str, share: u32) -> Config {
    let asked = std::env::var("TREAD_FUZZ").ok().and_then(|n| n.parse().ok());
    Config {
        cases: asked.unwrap_or(share),
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(corpus))),
        max_shrink_iters: 2000,
        ..Config::default()
    }
}

/// Mostly numbers as they come, sometimes absurd ones, sometimes any bits.
fn real() -> impl proptest::strategy::Strategy<Value = f64> {
    use proptest::prelude::*;
    let usual = vec![0.0, 1e-5, -1e-5, 1e-4, 0.01, 0.5, 1.0, 30.0, -1.0];
    let absurd = vec![f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, -1e300, 5e-324, -0.0];
    prop_oneof![
        12 => proptest::sample::select(usual),
        2 => proptest::sample::select(absurd),
        1 => any::<u64>().prop_map(f64::from_bits),
    ]
}
