//! The closed cycles that have been found in the states of a session.

use std::collections::VecDeque;

use crate::store::RECORD_BYTES;
use stickslip_compute::Nanoseconds;
use stickslip_wire::{State, limits};

use super::cycle_scan::{ClosedCycle, CycleScan};
use super::replay::PAGE;

/// Looking at one recorded state.
pub(super) const STATE_COST: Nanoseconds = 50;
/// What has been found in the states of a session so far. It stays with the cached session, so that later requests read
/// the new states alone.
#[derive(Clone, Default)]
pub(super) struct CycleLog {
    scan: CycleScan,
    /// The last state that has been looked at.
    pub(super) sequence: u64,
    /// As many as a reply can have.
    pub(super) newest: VecDeque<ClosedCycle>,
    /// The move that closed the last cycle that is no longer among them.
    pub(super) dropped: u64,
}

impl CycleLog {
    /// That of a session before its first move.
    pub(super) fn new(virgin: &State) -> CycleLog {
        let mut log = CycleLog::default();
        log.push(0, virgin);
        log
    }

    /// Looks at the next state; returns the outermost of the cycles that it closes.
    pub(super) fn push(&mut self, sequence: u64, state: &State) -> Option<ClosedCycle> {
        self.sequence = sequence;
        let (newest, dropped) = (&mut self.newest, &mut self.dropped);
        let mut outermost = None;
        self.scan.push(sequence, state, |cycle| {
            if newest.len() == *limits::CYCLES.end() {
                *dropped = newest.pop_front().map_or(0, |oldest| oldest.to);
            }
            newest.push_back(cycle);
            outermost = Some(cycle);
        });
        outermost
    }

    /// The outermost of the cycles that a move closed, if it is among the newest.
    pub(super) fn closed_by(&self, sequence: u64) -> Option<ClosedCycle> {
        let end = self.newest.partition_point(|cycle| cycle.to <= sequence);
        let last = end.checked_sub(1).map(|index| self.newest[index]);
        last.filter(|cycle| cycle.to == sequence)
    }

    /// Bytes of memory.
    pub(super) fn bytes(&self) -> usize {
        size_of::<CycleLog>() + self.scan.heap_bytes() + self.newest.capacity() * size_of::<ClosedCycle>()
    }

    /// Bytes that it and so many records take while they are looked at.
    pub(super) fn bytes_with(&self, records: usize) -> usize {
        self.bytes_of_log(records) + records * RECORD_BYTES
    }

    /// Bytes that it takes while it grows by so many states.
    fn bytes_of_log(&self, states: usize) -> usize {
        self.scan.heap_bytes_after(states) + 2 * limits::CYCLES.end() * size_of::<ClosedCycle>()
    }

    /// Bytes that it takes to know all cycles up to a move, with the records that are read for it.
    pub(super) fn bytes_to_read(known: Option<&CycleLog>, sequence: u64) -> usize {
        let new = sequence.saturating_sub(known.map_or(0, |known| known.sequence));
        let new = usize::try_from(new).unwrap_or(usize::MAX);
        let page = new.min(PAGE) * RECORD_BYTES;
        known.map_or_else(|| CycleLog::default().bytes_of_log(new), |known| known.bytes_of_log(new)) + page
    }

    /// Gives back the memory that it does not use.
    pub(super) fn shrink(&mut self) {
        self.scan.shrink();
    }
}
