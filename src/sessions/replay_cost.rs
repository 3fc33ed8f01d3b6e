//! When a snapshot is due.

use std::time::Duration;

/// No replay shorter than this is worth a snapshot.
const LEAST: Duration = Duration::from_millis(20);
/// Estimated cost of fetching a move from the store: 10 000 moves cost [`LEAST`].
const FETCH: Duration = Duration::from_micros(2);
/// Estimated cost of writing and reading a byte of a snapshot.
const BYTE: Duration = Duration::from_nanos(3);

/// The cost of a replay from the last snapshot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ReplayCost {
    moves: u32,
    work: Duration,
}

impl ReplayCost {
    /// Adds moves and the time that computing them took.
    pub(super) fn add(&mut self, moves: usize, work: Duration) {
        self.moves = self.moves.saturating_add(u32::try_from(moves).unwrap_or(u32::MAX));
        self.work = self.work.saturating_add(work);
    }

    /// Whether a snapshot of this many bytes costs less than the replay that it spares.
    pub(super) fn is_worth_snapshot(self, bytes: usize) -> bool {
        let spared = self.work.saturating_add(FETCH.saturating_mul(self.moves));
        spared >= LEAST.max(BYTE.saturating_mul(u32::try_from(bytes).unwrap_or(u32::MAX)))
    }
}

#[cfg(test)]
mod tests {
    use super::ReplayCost;
    use std::time::Duration;

    #[test]
    fn snapshots_are_rare_where_they_are_large_and_frequent_where_moves_are_dear() {
        let after = |moves, micros| {
            let mut cost = ReplayCost::default();
            cost.add(moves, Duration::from_micros(micros));
            cost
        };
        assert!(!after(5_000, 2_000).is_worth_snapshot(1_000));
        assert!(after(10_000, 0).is_worth_snapshot(1_000));
        assert!(after(10, 30_000).is_worth_snapshot(1_000) && !after(10, 30_000).is_worth_snapshot(20_000_000));
        assert!(after(usize::MAX, u64::MAX).is_worth_snapshot(usize::MAX));
    }
}
