//! What the mechanics refuses, and why. It knows no status codes.

use thiserror::Error as ThisError;

use super::range::short;

/// A request that has no answer. Nothing has changed when one is returned.
#[derive(Clone, Debug, PartialEq, ThisError)]
pub enum Error {
    /// A number outside what is accepted.
    #[error("{quantity} = {} is out of range: allowed is {allowed}", short(*value))]
    OutOfRange {
        /// The name that clients know the quantity by.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// The range, in words.
        allowed: String,
    },
    /// No quasi-static state carries this tangential force: the contact would slide away.
    #[error(
        "friction holds no more than mu F_N = {} N, which the tangential force would meet {:.3} % of the way to {} N",
        short(*limit), part * 100.0, short(*target)
    )]
    ForceExceedsFriction {
        /// The tangential force that the move was to lead to, N.
        target: f64,
        /// Friction coefficient times normal force where the tangential force first meets it, N.
        limit: f64,
        /// Where along the move that is, from 0 to 1.
        part: f64,
    },
    /// The solver cannot follow this pair of targets.
    #[error("{what}")]
    Unsupported {
        /// What cannot be followed.
        what: &'static str,
    },
}
