//! What the laws of every computation begin with.

use std::borrow::Borrow as _;

use stickslip_compute::computations::{self, Computation, Task};
use stickslip_compute::{Flag, Nanoseconds};
use stickslip_wire::{Document, parse};

use super::harness::{Outcome, refused};

/// Parses and checks the body of a computation, and if it costs no more than that, holds the laws against its task and
/// its reply.
///
/// # Panics
/// If a law does not hold.
pub fn answered<C: Computation<Request: Document<Checked: Clone>>>(
    body: &[u8],
    most: Nanoseconds,
    laws: impl FnOnce(Task<C>, &<C::Outcome as computations::Outcome>::Reply),
) -> Outcome {
    let task = match parse::<C::Request>(body).and_then(C::Request::check) {
        Ok(task) => task,
        Err(rejection) => return refused(body, rejection.into()),
    };
    if C::cost(&task) > most {
        return Outcome::TooExpensive;
    }
    match C::run(task.clone(), &Flag::default()) {
        Ok(found) => {
            laws(task, found.borrow());
            Outcome::Answered
        }
        Err(failure) => refused(body, failure.into()),
    }
}
