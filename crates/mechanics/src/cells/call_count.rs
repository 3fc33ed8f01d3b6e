//! Counts of calls of the costly functions, in tests alone.

use std::cell::Cell;

/// Calls since the count began, on this thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Calls {
    /// Integrals over a ring: what a move costs.
    pub(crate) moments: usize,
    /// Shares of a stress.
    pub(crate) kernel: usize,
    /// Their slopes: what the search for extrema costs.
    pub(crate) kernel_slope: usize,
    /// Shares of a displacement of the surface.
    pub(crate) displacement_integral: usize,
    /// States of a contact.
    pub(crate) states: usize,
    /// Copies of a slip history.
    pub(crate) copies: usize,
    /// Sums over the asperities near a level.
    pub(crate) asperities: usize,
}

thread_local! {
    static CALLS: Cell<Calls> = Cell::new(Calls::default());
}

/// A member of a struct whose copies are counted.
#[derive(Debug, Default)]
pub(crate) struct CountedCopies;

impl Clone for CountedCopies {
    fn clone(&self) -> CountedCopies {
        add(|calls| &mut calls.copies);
        CountedCopies
    }
}

/// Counts a call.
pub(crate) fn add(which: impl Fn(&mut Calls) -> &mut usize) {
    let mut calls = CALLS.get();
    *which(&mut calls) += 1;
    CALLS.set(calls);
}

/// The calls that `work` makes.
pub(crate) fn during<T>(work: impl FnOnce() -> T) -> (Calls, T) {
    CALLS.set(Calls::default());
    let result = work();
    (CALLS.get(), result)
}

/// The calls since the count began.
pub(crate) fn so_far() -> Calls {
    CALLS.get()
}
