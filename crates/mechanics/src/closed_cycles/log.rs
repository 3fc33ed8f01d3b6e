//! The newest of the closed cycles of a path.

use std::collections::VecDeque;

use super::{ClosedCycle, CycleScan, DEPTH, State, TurningPoint};

/// The closed cycles that have been found on a path so far, the newest of them.
#[derive(Clone, Debug, Default)]
pub struct CycleLog {
    scan: CycleScan,
    /// How many are kept.
    most: usize,
    /// The last state that has been looked at.
    pub sequence: u64,
    /// The newest, the last to close at the end.
    pub newest: VecDeque<ClosedCycle>,
    /// The move that closed the last cycle that is no longer among them.
    pub dropped: u64,
}

impl CycleLog {
    /// That of a contact before its first move, with the newest `most` cycles.
    #[must_use]
    pub fn new(virgin: &State, most: usize) -> CycleLog {
        let mut log = CycleLog { most, ..CycleLog::default() };
        log.push(0, virgin);
        log
    }

    /// Looks at the next state; returns the outermost of the cycles that it closes. Bodies with memory close none: they
    /// come back to a displacement in another state.
    pub fn push(&mut self, sequence: u64, state: &State) -> Option<ClosedCycle> {
        self.sequence = sequence;
        if state.time.is_some() {
            return None;
        }
        let (newest, dropped, most) = (&mut self.newest, &mut self.dropped, self.most);
        let mut outermost = None;
        self.scan.push(sequence, state, |cycle| {
            if newest.len() == most {
                *dropped = newest.pop_front().map_or(0, |oldest| oldest.to);
            }
            newest.push_back(cycle);
            outermost = Some(cycle);
        });
        outermost
    }

    /// The outermost of the cycles that a move closed, if it is among the newest.
    #[must_use]
    pub fn closed_by(&self, sequence: u64) -> Option<ClosedCycle> {
        let end = self.newest.partition_point(|cycle| cycle.to <= sequence);
        let last = end.checked_sub(1).map(|index| self.newest[index]);
        last.filter(|cycle| cycle.to == sequence)
    }

    /// Bytes of memory.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let points = self.scan.points.capacity() * size_of::<TurningPoint>();
        size_of::<CycleLog>() + points + self.newest.capacity() * size_of::<ClosedCycle>()
    }

    /// Bytes that it takes while it grows by so many states.
    #[must_use]
    pub fn memory_bytes_after(&self, states: usize) -> usize {
        let points = &self.scan.points;
        let grown = points.capacity().max(points.len().saturating_add(states).min(DEPTH + 2));
        // A deque doubles, and copies itself to do so.
        3 * grown * size_of::<TurningPoint>() + 2 * self.most * size_of::<ClosedCycle>()
    }

    /// Gives back the memory that it does not use.
    pub fn shrink(&mut self) {
        self.scan.points.shrink_to_fit();
    }
}
