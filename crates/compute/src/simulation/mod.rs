//! The parts that computations and stored contacts share: a solver follows a path, stresses, warnings, sweeps, and the
//! failures of requests.
//!
//! Nothing here depends on HTTP or storage. Long loops check a [`Stop`] between moves and between radii. [`cost`] and
//! [`bytes`] estimate the work.

pub mod bytes;
pub mod cost;
mod plane;
mod prepare;
mod prepared_profiles;
mod run;
mod solver;
mod stated_accuracy;
mod stress_below;
mod sweep;
#[cfg(test)]
mod tests;
mod trace;
mod trace_in_plane;
mod warnings;

pub use plane::{follow_in_plane, simulate_any};
pub use prepare::{Anew, check, check_parsed, cost_of_preparation};
pub use prepared_profiles::{ProfileCache, ProfileKey, Profiles};
pub use run::{
    contact, cycle_moves, equal_peaks, follow, reason_for, refused_at, residual, sampled, simulate, spring_foundation,
    stresses,
};
pub use solver::Solver;
pub use stated_accuracy::{Timer, accuracy};
pub use stress_below::subsurface;
pub use sweep::{Sweep, SweepResult, Worker};
pub use trace::{Point, trace, trace_simulation};
pub use trace_in_plane::trace_in_plane;
pub use warnings::{
    FarMove, HUGE_TABLE_RADIUS, MAX_SLOPE, annulus_warning, bulk_warning, excess_error, excess_error_of_springs,
    new_warnings, present_warnings, warnings_at,
};

use std::time::Duration;

use stickslip_measured::{loops, scan};
use stickslip_mechanics::{self as mechanics, range::Quantity};
use stickslip_wire::{Code, limits};

use crate::{Interrupted, Stop};

/// Why a request has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{pointer}{}{cause}", if pointer.is_empty() { "" } else { ": " })]
pub struct Failure {
    /// JSON pointer to the member whose request has no answer; empty for the request as a whole.
    pub pointer: String,
    /// What is wrong with it.
    pub cause: Cause,
}

/// What is wrong with a request that has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Cause {
    /// The mechanics has no answer to the request.
    #[error(transparent)]
    Refused(#[from] mechanics::Error),
    /// The scan yields no profile, or none that reaches the edge of the contact.
    #[error(transparent)]
    Scan(#[from] scan::Error),
    /// The loops determine nothing, or not the free quantities.
    #[error(transparent)]
    Loops(#[from] loops::Error),
    /// The slip history would exceed its limit.
    #[error("the slip history of the contact would have {depth} pieces: allowed are {}", limits::MEMORY_DEPTH)]
    MemoryFull {
        /// The pieces that it would have.
        depth: usize,
    },
    /// The states of a cycle are too many, or too large, to be held together.
    #[error(
        "the states of this cycle take too much memory: use fewer moves, or moves that are straight in displacement \
         and indentation"
    )]
    CycleTooLarge,
    /// The work exceeds the time limit of one request, or the client no longer waits for the result.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
    /// The profile cannot be prepared within the time limit of one request.
    #[error(
        "preparing this profile is estimated at {:.3} s, and {} s are allowed: give fewer points",
        estimate.as_secs_f64(), allowed.as_secs_f64()
    )]
    Preparation {
        /// The estimate.
        estimate: Duration,
        /// How long work may take.
        allowed: Duration,
    },
    /// The work cannot be done within the time limit of one request.
    #[error(
        "this is estimated at {:.0} s, and {} s are allowed: ask for fewer moves or places, or for less accuracy",
        estimate.as_secs_f64(), allowed.as_secs_f64()
    )]
    Work {
        /// The estimate.
        estimate: Duration,
        /// How long work may take.
        allowed: Duration,
    },
    /// The extrema cannot be found within the time limit of one request.
    #[error(
        "finding the extrema of a slip history of up to {depth} pieces is estimated at {estimate} s, and {} s are \
            allowed: up to {fits} pieces are possible",
        allowed.as_secs_f64()
    )]
    Search {
        /// The estimate, s.
        estimate: u64,
        /// Pieces of slip history.
        depth: usize,
        /// The most pieces that would not be refused.
        fits: usize,
        /// How long work may take.
        allowed: Duration,
    },
    /// A contact that is to be relaxed does not touch.
    #[error("the indenter is lifted off, so there is no stress to relax: move it back into contact first")]
    Lifted,
    /// The request names a stored contact, which only a server has.
    #[error("needs a running service")]
    NeedsServer,
}

impl From<Interrupted> for Failure {
    fn from(interrupted: Interrupted) -> Failure {
        Failure::interrupted(interrupted, "")
    }
}

impl Failure {
    /// The failure of what the member at `pointer` asks for.
    pub fn at(pointer: impl Into<String>, cause: impl Into<Cause>) -> Failure {
        Failure { pointer: pointer.into(), cause: cause.into() }
    }

    /// The failure for interrupted work that the member at `pointer` requested.
    pub fn interrupted(interrupted: Interrupted, pointer: &str) -> Failure {
        Failure::at(if interrupted == Interrupted::Abandoned { "" } else { pointer }, interrupted)
    }

    /// This failure, unless `stop` has ended the work that the member at `pointer` requested.
    #[must_use]
    pub fn unless_interrupted(self, stop: &dyn Stop, pointer: &str) -> Failure {
        match stop.check() {
            Err(interrupted) => Failure::interrupted(interrupted, pointer),
            Ok(()) => self,
        }
    }

    /// The code with which `POST /simulate` refuses it.
    pub fn code(&self) -> Code {
        match &self.cause {
            Cause::Refused(error) => match error {
                mechanics::Error::OutOfRange { .. }
                | mechanics::Error::Table { .. }
                | mechanics::Error::Curve { .. }
                | mechanics::Error::NoSurface { .. }
                | mechanics::Error::BodiesNeeded
                | mechanics::Error::LineContact(_)
                | mechanics::Error::OnlyCylinder
                | mechanics::Error::NothingSlides
                | mechanics::Error::RoundContact(_)
                | mechanics::Error::ShearStrength(_)
                | mechanics::Error::Viscoelastic(_)
                | mechanics::Error::NoMemory
                | mechanics::Error::FluidUnderLoad
                | mechanics::Error::Adhesive(_)
                | mechanics::Error::FrictionWithAdhesion
                | mechanics::Error::Twisted(_)
                | mechanics::Error::ShearModulusNeeded
                | mechanics::Error::TooManyCells
                | mechanics::Error::BulkNeedsConstantLoad
                | mechanics::Error::OpenCycle { .. } => Code::InvalidInput,
                mechanics::Error::NoStressField { .. } => Code::NoStressField,
                mechanics::Error::BeyondProfile { .. }
                | mechanics::Error::BeyondReferenceLength { .. }
                | mechanics::Error::WornBeyondProfile { .. } => Code::BeyondProfile,
                mechanics::Error::LoadMustBeConstant => Code::LoadMustBeConstant,
                mechanics::Error::TwistWithShift => Code::TwistWithShift,
                mechanics::Error::BulkTooLarge { .. } => Code::BulkTooLarge,
                mechanics::Error::NotConvexEnough { .. } => Code::ProfileNotConvexEnough,
                mechanics::Error::ForceExceedsFriction { .. } | mechanics::Error::TorqueExceedsFriction { .. } => {
                    Code::ForceExceedsFriction
                }
                mechanics::Error::Interrupted | mechanics::Error::CycleTooLarge => Code::TooMuchWork,
                mechanics::Error::Unsupported { .. } => Code::UnsupportedMove,
            },
            Cause::Scan(scan::Error::TooShort { .. }) => Code::BeyondProfile,
            Cause::Scan(_) | Cause::Loops(_) | Cause::NeedsServer => Code::InvalidInput,
            Cause::MemoryFull { .. } | Cause::Lifted => Code::Conflict,
            Cause::Interrupted(Interrupted::Abandoned) => Code::Overloaded,
            Cause::Interrupted(_)
            | Cause::Preparation { .. }
            | Cause::Work { .. }
            | Cause::Search { .. }
            | Cause::CycleTooLarge => Code::TooMuchWork,
        }
    }
}

/// Refuses what the member at `pointer` asks for, if it needs a stress and the contact is known by its load curve
/// alone.
///
/// # Errors
/// [`Cause::Refused`] with [`Error::NoStressField`](mechanics::Error::NoStressField).
pub fn needs_stress_field(contact: &mechanics::Contact, pointer: &str) -> Result<(), Failure> {
    contact.profile().check_stress_field().map_err(|error| Failure::at(pointer, error))
}

/// The quantity that an error is about, if it is about one.
pub fn quantity(error: &mechanics::Error) -> Option<Quantity> {
    match error {
        mechanics::Error::OutOfRange { quantity, .. } => Some(*quantity),
        mechanics::Error::NoMemory | mechanics::Error::FluidUnderLoad => Some(Quantity::Duration),
        _ => None,
    }
}
