//! Sweeps: many simulations that differ in a few numbers.
//!
//! A sweep is computed in slices of some milliseconds. Between two slices it has no thread, so that others wait for a
//! slice and not for a sweep; its threads have a lower priority than those that serve connections.

mod compute;
mod plan;
mod result;
mod shared;
mod uncertainty;

use stickslip_wire::sweep::CheckedSweep;

pub use compute::Worker;
pub use result::SweepResult;
use shared::Shared;

use crate::prelude::*;

/// Work of one chunk: what is stored at a time, and what a killed process loses.
const CHUNK_COST: Nanoseconds = 1_000_000_000;
/// The most numbers that are stored at a time.
const CHUNK_NUMBERS: usize = 65_536;
/// The most chunks that a sweep is stored in, roughly.
const CHUNKS: usize = 10_000;
/// A sweep whose axes stay within the ranges of their fields and whose outputs exist.
#[derive(Debug)]
pub struct Sweep {
    checked: CheckedSweep,
    base: Value,
    /// The parts that the points share, if no axis changes the profile; the base then has a sphere in its place.
    shared: Option<Shared>,
    cost_per_point: Nanoseconds,
    bytes: usize,
}

impl Sweep {
    /// The sweep as requested, with its axes.
    pub fn checked(&self) -> &CheckedSweep {
        &self.checked
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.checked.points
    }

    /// The largest cost of a point.
    pub fn cost_per_point(&self) -> Nanoseconds {
        self.cost_per_point
    }

    /// The largest cost of all points together.
    pub fn cost(&self) -> Nanoseconds {
        self.cost_per_point.saturating_mul(self.checked.points as u64)
    }

    /// Numbers in the result of this many points.
    pub fn numbers(&self, points: usize) -> usize {
        points * self.checked.outputs.len()
    }

    /// Bytes that computing takes on this many threads, without the result.
    pub fn bytes(&self, threads: usize) -> usize {
        self.bytes.saturating_mul(threads + 1)
    }

    /// Points that are stored at a time.
    pub fn chunk(&self) -> usize {
        let worth = usize::try_from(CHUNK_COST / self.cost_per_point.max(1)).unwrap_or(usize::MAX);
        let most = CHUNK_NUMBERS / self.checked.outputs.len().max(1);
        worth.max(self.checked.points.div_ceil(CHUNKS)).clamp(1, most)
    }
}
