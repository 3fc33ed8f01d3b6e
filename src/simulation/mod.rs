//! From a checked request to a reply, by way of the mechanics.
//!
//! The same functions serve `stickslip simulate`, `POST /simulate` and the sessions, independent of HTTP and
//! storage. Long loops check a [`Stop`](crate::admission::Stop) between moves and between radii. [`cost`] estimates the
//! work.

pub mod bytes;
mod compare_solvers;
pub mod cost;
mod cycle;
mod cycle_map;
mod cycle_studies;
mod fretting;
mod fretting_warnings;
mod loop_fit;
mod prepare;
mod profile_fit;
mod protocol;
mod reply_template;
mod run;
mod solver;
mod stated_accuracy;
mod subsurface;
mod sweep;
#[cfg(test)]
mod tests;
mod warnings;

pub use compare_solvers::compare_solvers;
pub use cycle::cycle;
pub use cycle_map::{cycle_of, cycles_under};
pub use fretting::fretting;
pub use loop_fit::fit_loops;
pub use prepare::{check, cost_of_preparation};
pub use profile_fit::fit_profile;
pub use protocol::{Subject, protocol, protocol_for};
pub use run::{contact, equal_peaks, follow, residual, simulate, stresses};
pub use solver::Solver;
pub use stated_accuracy::{Timer, accuracy};
pub use subsurface::{subsurface, subsurface_reply};
pub use sweep::{Sweep, SweepError, SweepResult};
pub use warnings::{FarMove, excess_error, new_warnings, present_warnings};

use std::time::Duration;

use stickslip_measured::{loops, scan};
use stickslip_mechanics::{self as mechanics, range::Quantity};
use stickslip_wire::{Code, limits};

use crate::admission::Interrupted;

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The mechanics has no answer to the request.
    #[error("{}: {error}", if pointer.is_empty() { "the request" } else { pointer.as_str() })]
    Refused {
        /// JSON pointer to the member that it refuses.
        pointer: String,
        /// Why.
        error: mechanics::Error,
    },
    /// The scan yields no profile, or none that reaches the edge of the contact.
    #[error("{pointer}: {error}")]
    Scan {
        /// JSON pointer to what is at fault.
        pointer: &'static str,
        /// Why.
        error: scan::Error,
    },
    /// The loops determine nothing, or not what is free.
    #[error("{pointer}: {error}")]
    Loops {
        /// JSON pointer to what is at fault.
        pointer: String,
        /// Why.
        error: loops::Error,
    },
    /// The slip history would exceed its limit.
    #[error("the slip history of the contact would have {depth} pieces: allowed are {}", limits::MEMORY_DEPTH)]
    MemoryFull {
        /// JSON pointer to the move that would be too much.
        pointer: String,
        /// The pieces that it would have.
        depth: usize,
    },
    /// The states of a cycle are too many, or too large, to be held together.
    #[error(
        "the states of this cycle take too much memory: make it of fewer moves, or straight in displacement and \
            indentation"
    )]
    CycleTooLarge {
        /// JSON pointer to the path.
        pointer: String,
    },
    /// The work exceeds the time limit of one request.
    #[error("this takes longer than the {} s that are allowed", allowed.as_secs_f64())]
    TooLong {
        /// JSON pointer to the member that requests the work, if there is one.
        pointer: String,
        /// How long work may take.
        allowed: Duration,
    },
    /// The profile cannot be prepared within the time limit of one request.
    #[error(
        "preparing this profile is estimated at {:.3} s, and {} s are allowed: give fewer points",
        estimate.as_secs_f64(), allowed.as_secs_f64()
    )]
    Preparation {
        /// JSON pointer to it.
        pointer: &'static str,
        /// The estimate.
        estimate: Duration,
        /// How long work may take.
        allowed: Duration,
    },
    /// The extrema cannot be found within the time limit of one request.
    #[error(
        "finding the extrema of a slip history of up to {depth} pieces is estimated at {estimate} s, and {} s are \
            allowed: up to {fits} pieces fit",
        allowed.as_secs_f64()
    )]
    Search {
        /// JSON pointer to the member that requests them.
        pointer: String,
        /// The estimate, s.
        estimate: u64,
        /// Pieces of slip history.
        depth: usize,
        /// How many would not be refused.
        fits: usize,
        /// How long work may take.
        allowed: Duration,
    },
    /// A contact that is to be relaxed does not touch.
    #[error("the indenter is lifted off, so there is no stress to relax: move it back into contact first")]
    Lifted,
    /// The request names a stored contact, and only a server has any.
    #[error("needs a running service")]
    NeedsServer {
        /// JSON pointer to its name.
        pointer: &'static str,
    },
    /// The client no longer waits for the result.
    #[error("stopped: the client no longer waits for the result")]
    Stopped,
}

impl From<Interrupted> for Failure {
    fn from(interrupted: Interrupted) -> Failure {
        Failure::interrupted(interrupted, "")
    }
}

impl Failure {
    /// The failure for interrupted work that the member at `pointer` requested.
    #[must_use]
    pub fn interrupted(interrupted: Interrupted, pointer: &str) -> Failure {
        match interrupted {
            Interrupted::Abandoned => Failure::Stopped,
            Interrupted::TimeLimit(allowed) => Failure::TooLong { pointer: pointer.to_owned(), allowed },
        }
    }

    /// The code with which `POST /simulate` refuses it.
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Failure::Refused { error, .. } => match error {
                mechanics::Error::OutOfRange { .. }
                | mechanics::Error::Table { .. }
                | mechanics::Error::Curve { .. }
                | mechanics::Error::NoSurface { .. }
                | mechanics::Error::BodiesNeeded
                | mechanics::Error::OpenCycle { .. } => Code::InvalidInput,
                mechanics::Error::NoStressField { .. } => Code::NoStressField,
                mechanics::Error::BeyondProfile { .. } => Code::BeyondProfile,
                mechanics::Error::NotConvexEnough { .. } => Code::ProfileNotConvexEnough,
                mechanics::Error::ForceExceedsFriction { .. } => Code::ForceExceedsFriction,
                mechanics::Error::Interrupted | mechanics::Error::CycleTooLarge => Code::TooMuchWork,
                mechanics::Error::Unsupported { .. } => Code::UnsupportedMove,
            },
            Failure::Scan { error: scan::Error::TooShort { .. }, .. } => Code::BeyondProfile,
            Failure::Scan { .. } | Failure::Loops { .. } | Failure::NeedsServer { .. } => Code::InvalidInput,
            Failure::MemoryFull { .. } | Failure::Lifted => Code::Conflict,
            Failure::TooLong { .. }
            | Failure::Preparation { .. }
            | Failure::Search { .. }
            | Failure::CycleTooLarge { .. } => Code::TooMuchWork,
            Failure::Stopped => Code::Overloaded,
        }
    }
}

/// Refuses what the member at `pointer` asks for, if it needs a stress and the contact is known by its load curve
/// alone.
///
/// # Errors
/// [`Failure::Refused`] with [`Error::NoStressField`](mechanics::Error::NoStressField).
pub fn needs_stress_field(contact: &mechanics::Contact, pointer: &str) -> Result<(), Failure> {
    contact.profile().check_stress_field().map_err(|error| Failure::Refused { pointer: pointer.to_owned(), error })
}

/// The quantity that an error is about, if it is about one.
fn quantity(error: &mechanics::Error) -> Option<Quantity> {
    match error {
        mechanics::Error::OutOfRange { quantity, .. } => Some(*quantity),
        _ => None,
    }
}
