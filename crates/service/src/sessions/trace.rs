//! The path between recorded states, computed again in small steps on a copy: the session itself does not move.

use crate::store::{RECORD_BYTES, Record};
use stickslip_compute::Stop as _;
use stickslip_compute::simulation::Failure;
use stickslip_compute::simulation::bytes::ROW;
use stickslip_compute::simulation::cost::Work;
use stickslip_wire::{HistoryItem, LoopPage, limits};

use super::prelude::*;
use super::replay::{PAGE, PIECE_BYTES, damaged};

/// JSON pointer to the number of points.
const POINTS: &str = "/points_per_move";

/// The loop through the earlier moves `past`, of which the first follows the move `after`, with `points` points per
/// move. The memory of the request is more while it is traced.
///
/// # Errors
/// [`SessionError::NotFound`] or [`SessionError::Expired`], a failure of the store or of the pool, or
/// [`SessionError::Failure`] if it takes too long.
pub async fn trace(
    sessions: &Sessions,
    id: Uuid,
    after: u64,
    past: &[HistoryItem],
    points: usize,
    memory: &mut Reservation,
) -> Result<LoopPage, SessionError> {
    let mut page = LoopPage::after(after);
    let (Some(last), true) = (past.last().map(|item| item.sequence), points > 1) else {
        for item in past {
            page.push_end(item.sequence, &item.state, item.observation.map(|observation| observation.force));
        }
        return Ok(page);
    };
    let (stop, _guard) = sessions.pool.deadline();
    // A move is assumed to leave one piece of slip history.
    let pieces = usize::try_from(after).unwrap_or(usize::MAX).min(limits::MEMORY_DEPTH);
    let before = memory.bytes();
    sessions.pool.resize(memory, before + 2 * PIECE_BYTES * pieces + PAGE * RECORD_BYTES).await?;
    let initial = sessions.copies(id, &stop, |live| live.contact.virgin()).await?;
    let snapshot = sessions.store.snapshot(id).await;
    let mut loading = Duration::ZERO;
    let (mut contact, mut at, _) = sessions.load_snapshot(&mut loading, snapshot, initial, after).await?;
    stop.flag().charge(loading);
    while at < last {
        let records = sessions.page(id, at, last).await?;
        let end = at + records.len() as u64;
        let drawn = records.iter().filter(|record| record.sequence > after).count();
        let curved = records.iter().filter(|record| record.step.is_curved()).count();
        let steps = records.len() + drawn * points;
        let depth = contact.memory_depth();
        let drawing = Work { moves: steps, curved: curved * points, depth, ..Work::default() };
        let price = drawing.cost(contact.profile());
        let stop = stop.clone();
        let work = move || {
            for record in &records {
                let wanted = if record.sequence > after { points } else { 1 };
                trace_move((&mut contact, id), record, wanted, &stop, &mut page)?;
                if record.sequence > after {
                    page.push_end(record.sequence, &record.state, record.measured.map(|measured| measured.force));
                }
            }
            Ok::<_, SessionError>((contact, page))
        };
        (contact, page) = sessions.pool.run(price, work).await??;
        at = end;
    }
    sessions.pool.resize(memory, before).await?;
    Ok(page)
}

/// Bytes that a loop of this many points takes.
pub fn bytes_of_trace(points: usize) -> usize {
    points * 2 * ROW
}

/// Applies an earlier move, after adding the points on its way to the page.
fn trace_move(
    (contact, id): (&mut Contact, Uuid),
    record: &Record,
    points: usize,
    stop: &Deadline,
    page: &mut LoopPage,
) -> Result<(), SessionError> {
    let check = || stop.check().map_err(|interrupted| Failure::interrupted(interrupted, POINTS));
    let go_on = || stop.check().is_ok();
    let step = record.step.step();
    // The copy goes in small steps; the contact itself makes the move as it was made, to the last bit.
    let mut copy = (points > 1).then(|| contact.clone());
    let duration = step.duration / points as f64;
    let on_the_way = |contact: &Contact, step: &stickslip_mechanics::Move, part| stickslip_mechanics::Move {
        duration,
        ..contact.partial_move(step, part)
    };
    for index in 1..points {
        check()?;
        let part = index as f64 / points as f64;
        // An intermediate target may be out of range, such as a force of 1e-300 N; then there is no point.
        if let Some(copy) = &mut copy
            && copy.apply_while(&on_the_way(contact, &step, part), record.tolerance, &go_on).is_ok()
        {
            page.push(record.sequence, part, &copy.state().into());
        }
    }
    check()?;
    contact.apply_while(&step, record.tolerance, &go_on).map_err(|error| match check() {
        Err(failure) => failure.into(),
        Ok(()) => damaged(id, &format_args!("a stored move cannot be replayed: {error}")),
    })
}
