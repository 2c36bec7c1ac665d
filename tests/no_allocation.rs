//! A step allocates nothing: counted by the allocator itself, over 1000 steps of set, step and get.

#[path = "common/fmi.rs"]
mod fmi;

use fmi::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use tread_block::block::TreadBlock;
use tread_block::drive::{Pose, Predictor};
use tread_block::fmi::exports::*;
use tread_block::Params;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        System.alloc(layout)
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        System.dealloc(pointer, layout)
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        System.realloc(pointer, layout, size)
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of this thread while `f` runs.
fn allocations(f: impl FnOnce()) -> usize {
    let before = COUNT.get();
    f();
    COUNT.get() - before
}

#[test]
fn do_step_and_its_setters_and_getters_allocate_nothing() {
    let fmu = Fmu::ready();
    fmu.slide(0, 5, 1e-5);
    let (x, force) = (vr("belt.x"), vr("force.x"));
    let mut value = 0.0;
    let count = allocations(|| {
        for k in 5..1005 {
            let t = k as f64 * 1e-5;
            unsafe {
                assert_eq!(fmi2SetReal(fmu.c, &x, 1, &belt_x(t)), OK);
                assert_eq!(fmi2SetRealInputDerivatives(fmu.c, &x, 1, &1, &-0.3), OK);
                assert_eq!(fmi2DoStep(fmu.c, t, 1e-5, 1), OK);
                assert_eq!(fmi2GetReal(fmu.c, &force, 1, &mut value), OK);
                assert_eq!(fmi2GetRealOutputDerivatives(fmu.c, &force, 1, &1, &mut value), OK);
            }
        }
    });
    assert_eq!(count, 0);
    assert!(allocations(|| drop(std::hint::black_box(vec![1]))) > 0, "the counter counts");
}

#[test]
fn the_library_advances_without_allocation() {
    let mut params = Params::default();
    (params.solver.elements_along, params.solver.elements_up) = (3, 2);
    let mut block = TreadBlock::new(&params).unwrap();
    block.initialize(0.0, Pose { load: 56.25, ..Pose::default() }).unwrap();
    let mut predictor = Predictor::default();
    let count = allocations(|| {
        for k in 0..1000 {
            let t = f64::from(k) * 1e-5;
            let pose = Pose { x: belt_x(t), load: 56.25, ..Pose::default() };
            block.advance(1e-5, &predictor.segment(t, 1e-5, Predictor::known(pose))).unwrap();
        }
    });
    assert_eq!(count, 0);
}
