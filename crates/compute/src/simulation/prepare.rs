//! Checking a document as work: what prepares its profile is estimated, may end, and counts.

use std::any::Any;
use std::time::Duration;

use stickslip_wire::DefinedProfile;

use crate::documents::Parsed;
use crate::prelude::*;

/// Prepares every profile anew, until the flag is raised.
pub struct Anew<'a>(pub &'a dyn Stop);

impl Prepare for Anew<'_> {
    fn keep_going(&self) -> bool {
        self.0.check().is_ok()
    }
}

/// The cost of preparing a profile, unless that cannot end in time.
///
/// # Errors
/// [`Cause::Preparation`] with the estimate.
pub fn cost_of_preparation(defined: &DefinedProfile<'_>, allowed: Duration) -> Result<Nanoseconds, Failure> {
    let cost = cost::of_preparation(defined.profile);
    let estimate = Duration::from_nanos(cost);
    if estimate > allowed.saturating_mul(cost::MARGIN) {
        return Err(Failure::at(defined.pointer, Cause::Preparation { estimate, allowed }));
    }
    Ok(cost)
}

/// Checks a document, and has `stop` count the time that it takes.
///
/// # Errors
/// [`Cause::Interrupted`] if `stop` has ended the preparation of its profile; within, as
/// [`Document::check_with`].
pub fn check<T: Document>(
    document: T,
    profiles: &dyn Prepare,
    stop: &dyn Stop,
) -> Result<Result<T::Checked, Rejection>, Failure> {
    let pointer = document.profile().map_or("", |defined| defined.pointer);
    counted(pointer, stop, || document.check_with(profiles))
}

/// The same of a document without its type.
///
/// # Errors
/// As [`check`].
pub fn check_parsed(
    document: Box<dyn Parsed>,
    profiles: &dyn Prepare,
    stop: &dyn Stop,
) -> Result<Result<Box<dyn Any + Send>, Rejection>, Failure> {
    let pointer = document.profile().map_or("", |defined| defined.pointer);
    counted(pointer, stop, || document.check(profiles))
}

fn counted<T>(
    pointer: &str,
    stop: &dyn Stop,
    check: impl FnOnce() -> Result<T, Rejection>,
) -> Result<Result<T, Rejection>, Failure> {
    let timer = Timer::start(stop);
    let checked = check();
    if checked.is_err() {
        stop.check().map_err(|interrupted| Failure::interrupted(interrupted, pointer))?;
    }
    let spent = timer.elapsed();
    stop.flag().count(spent.saturating_sub(stop.flag().before()));
    Ok(checked)
}
