//! Sequences of calls on the C interface: answers stay within the standard's numbers, every refusal has
//! a reason, outputs stay finite, and a bystander instance keeps its bits.

use super::{config, real};
use crate::fmi::*;
use crate::play::{play, Call};
use proptest::prelude::*;
use tread_block::fmi::variables;

fn call() -> impl Strategy<Value = Call> {
    let count = variables::all().len() as u32;
    let reference = prop_oneof![12 => 0..count, 1 => any::<u32>()];
    let integer = prop_oneof![8 => -1..6_i32, 1 => any::<i32>()];
    (0..30_u8, reference, real(), real(), integer, any::<usize>(), any::<bool>()).prop_map(
        |(kind, reference, real, other, integer, at, recover)| Call {
            kind,
            reference,
            real,
            other,
            integer,
            at,
            recover,
        },
    )
}

#[test]
fn no_sequence_of_calls_harms_the_process_or_a_bystander() {
    let expected = Fmu::ready().slide(0, 50, 1e-5);
    let bystander = Fmu::ready();
    let mut done = bystander.slide(0, 25, 1e-5);
    let mut runner =
        proptest::test_runner::TestRunner::new(config("tests/hostile/corpus/calls.txt", 60));
    let sequences = prop::collection::vec(call(), 1..80);
    runner
        .run(&sequences, |calls| play(&calls).map_err(TestCaseError::fail))
        .unwrap_or_else(|e| panic!("{e}"));
    done.extend(bystander.slide(25, 25, 1e-5));
    assert_eq!(done, expected);
}
