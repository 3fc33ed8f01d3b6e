//! Changes that wait at the same time share a transaction, and so the wait for the disk.

use tokio::sync::mpsc;

/// Changes in a transaction.
const CHANGES: usize = 512;
/// Rows that they may write before no other is added.
const ROWS: usize = 10_000;

/// A change with those that wait behind it, as many as go in one transaction; `rows` says how many each writes,
/// roughly.
pub(super) fn collect<T>(first: T, queue: &mut mpsc::Receiver<T>, rows: impl Fn(&T) -> usize) -> Vec<T> {
    let mut written = rows(&first);
    let mut batch = vec![first];
    while batch.len() < CHANGES
        && written < ROWS
        && let Ok(next) = queue.try_recv()
    {
        written = rows(&next).saturating_add(written);
        batch.push(next);
    }
    batch
}
