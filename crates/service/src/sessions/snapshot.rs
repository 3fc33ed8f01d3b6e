//! Snapshots: states kept in the store, so that opening a session need not replay all of its moves.
//!
//! A snapshot is a cache, not a record: one that is damaged, or of another version of the engine, is ignored, and
//! the session replayed from its beginning. It is due once what it spares a replay outweighs what it costs to write and
//! read, which bounds both the time to open a session and the bytes written for a move.

use std::time::Instant;

use crate::store::Snapshot;

use super::prelude::*;

/// Snapshots that are being stored at a time. A session for which there is no room tries again with its next move.
pub(super) const AT_ONCE: usize = 2;
/// Bytes of the checksum at the end.
const CHECKSUM: usize = 4;
/// No replay shorter than this is worth a snapshot.
const LEAST_REPLAY: Duration = Duration::from_millis(20);
/// Estimated cost of fetching a move from the store: 10 000 moves cost [`LEAST_REPLAY`].
const FETCH: Duration = Duration::from_micros(2);
/// Estimated cost of writing and reading a byte of a snapshot.
const BYTE: Duration = Duration::from_nanos(3);

impl Common {
    /// Stores a snapshot of a stored state in the background, if one is due.
    pub(super) fn offer_snapshot(&self, live: &mut LoadedSession) {
        if !live.replay_cost.is_worth_snapshot(live.contact.packed_length()) {
            return;
        }
        let Ok(permit) = self.snapshots.clone().try_acquire_owned() else { return };
        live.replay_cost = ReplayCost::default();
        let (store, contact) = (self.store.clone(), live.contact.clone());
        let (id, sequence, unreadable) = (live.session.id, live.session.sequence, live.unreadable.take());
        tokio::spawn(async move {
            let _permit = permit;
            let Ok(state) = tokio::task::spawn_blocking(move || with_checksum(&contact)).await else { return };
            // The session is unaffected: only the next replay is longer.
            if let Err(error) = store.save_snapshot(id, Snapshot { sequence, state }, unreadable).await {
                tracing::warn!(%id, sequence, %error, "a snapshot was not stored");
            }
        });
    }

    /// The contact after some stored move and the number of that move; `initial` and 0 if there is no snapshot to read,
    /// and the number of the move of one that is there all the same. `loading` is increased by the time that it takes.
    pub(super) async fn load_snapshot(
        &self,
        loading: &mut Duration,
        snapshot: Result<Option<Snapshot>, StoreError>,
        initial: Contact,
        last: u64,
    ) -> Result<(Contact, u64, Option<u64>), SessionError> {
        let snapshot = match snapshot {
            Ok(Some(snapshot)) if snapshot.sequence <= last => snapshot,
            Ok(_) => return Ok((initial, 0, None)),
            Err(error) => {
                tracing::warn!(%error, "a snapshot was not read");
                return Ok((initial, 0, None));
            }
        };
        // Reading a byte is below a nanosecond.
        let cost = snapshot.state.len() as u64;
        let read = self.pool.run(cost, move || {
            let begin = Instant::now();
            let read = match checked(&snapshot.state).and_then(|state| initial.unpack(state)) {
                Some(contact) => (contact, snapshot.sequence, None),
                None => (initial, 0, Some(snapshot.sequence)),
            };
            (read, begin.elapsed())
        });
        let (read, work) = read.await?;
        *loading += work;
        Ok(read)
    }
}

fn with_checksum(contact: &Contact) -> Vec<u8> {
    let mut bytes = contact.pack();
    bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
    bytes
}

/// The packed state, if its checksum is right.
fn checked(bytes: &[u8]) -> Option<&[u8]> {
    let (state, checksum) = bytes.split_last_chunk::<CHECKSUM>()?;
    (crc32fast::hash(state) == u32::from_le_bytes(*checksum)).then_some(state)
}

/// Compares a snapshot with the state that it should be, to the last bit. Returns whether this engine made it, as
/// others are never read; or what is wrong with it.
pub(super) fn compare(state: &Contact, snapshot: &[u8]) -> Result<bool, &'static str> {
    match checked(snapshot) {
        None => Err("is damaged; it is not used"),
        Some(packed) if !Contact::is_current_packing(packed) => Ok(false),
        Some(_) if snapshot == with_checksum(state) => Ok(true),
        Some(_) => Err("is not the state after that move"),
    }
}

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
        spared >= LEAST_REPLAY.max(BYTE.saturating_mul(u32::try_from(bytes).unwrap_or(u32::MAX)))
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
