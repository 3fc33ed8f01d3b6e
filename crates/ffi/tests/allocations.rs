//! A step allocates nothing once the history has its memory. A program of its own, whose allocator counts.

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_ffi::exports::*;
use support::{BALL, fresh};

struct Counted;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the allocator of the system, counted.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(place, layout) };
    }
}

#[global_allocator]
static COUNTED: Counted = Counted;

#[test]
fn a_step_and_a_trial_allocate_nothing_once_the_history_has_its_memory() {
    let contact = fresh(BALL);
    let mut random = fastrand::Rng::with_seed(77);
    let mut path = |count: usize| {
        for index in 0..count {
            let (to, force) = (1e-7 * (2.0 * random.f64() - 1.0), 5.0 + 5.0 * random.f64());
            let load = if index % 3 == 0 { SS_NORMAL_FORCE } else { SS_CONSTANT_LOAD };
            let mut forces = [0.0; 2];
            // SAFETY: one displacement and two forces.
            let codes = unsafe {
                let trial = ss_trial(contact, load, force, &raw const to, forces.as_mut_ptr());
                [trial, ss_commit(contact), ss_step(contact, load, force, &raw const to, forces.as_mut_ptr())]
            };
            assert_eq!(codes, [SS_OK; 3]);
            // Gross slip wipes out the history, which else grows without bound.
            if index % 20 == 0 {
                let far = 1e-6;
                // SAFETY: as above.
                let code = unsafe { ss_step(contact, SS_CONSTANT_LOAD, 0.0, &raw const far, forces.as_mut_ptr()) };
                assert_eq!(code, SS_OK);
            }
        }
    };
    path(2000);
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    path(2000);
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed) - before, 0);
}
