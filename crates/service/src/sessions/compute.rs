//! Computing the moves of a request on a loaded session, and the reply to them: what needs a processor and no store.

use jiff::Timestamp;

use crate::store::{Measured, Record, Reply};
use stickslip_compute::computations::{Moved, OnContact as _, make_moves, shown_states};
use stickslip_compute::simulation::bytes::{of_moves, of_records, of_stress};
use stickslip_compute::simulation::cost::{self, MEMORY_MOVE_COST, Work};
use stickslip_wire::session::Advance;
use stickslip_wire::{MoveReply, Observation, PathReply, Plan, RelaxReply, State, Steps, limits};

use super::observations::check_plausible;
use super::prelude::*;

/// The most pieces that one straight move can add to the slip history, with a margin.
const PIECES_OF_A_MOVE: usize = 8;

/// Moves that have been made and are not stored yet.
pub(super) struct Computed {
    /// The state after them.
    pub(super) live: Box<LoadedSession>,
    pub(super) records: Vec<Record>,
    pub(super) reply: Reply,
}

/// Bytes that moves take, with their records and the reply; rather too many than too few.
pub fn bytes_of_moves(advance: &Advance) -> usize {
    let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
    advance.relax.map_or(0, |relax| relax.task.bytes())
        + of_moves(&advance.plan, advance.steps)
        + of_records(advance.plan.length())
        + of_stress(radii)
}

/// Makes moves after the state in the guard. The guard keeps the state before them, or, if it has been used up,
/// nothing.
///
/// # Errors
/// [`SessionError`].
pub(super) async fn compute(
    sessions: &Sessions,
    guard: &mut Guard,
    advance: &Arc<Advance>,
    stop: &Deadline,
) -> Result<Computed, SessionError> {
    let depth = guard.live.as_ref().map_or(0, |live| live.contact.memory_depth());
    // A single move that the mechanics refuses has changed nothing, so that it needs no copy to fall back on; and a
    // copy costs as much as the slip history is deep. A move that another process may have overtaken needs the copy.
    let in_place = matches!(advance.plan, Plan::Single(step) if !step.is_curved())
        && advance.stress.is_none()
        && depth + PIECES_OF_A_MOVE <= limits::MEMORY_DEPTH
        && guard.live.as_ref().is_some_and(|live| !live.shared);
    // A copy can be large, and many requests may be under way.
    let copied = guard.live.as_ref().filter(|_| !in_place).map_or(0, |live| live.contact.memory_bytes());
    let _held = if copied > 0 { sessions.reserve_copy(guard, copied).await? } else { Reservation::default() };
    let live = if in_place { guard.live.take() } else { guard.live.clone() };
    let mut live = live.ok_or(SessionError::NotFound(guard.id()))?;
    let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
    let (moves, curved) = (advance.plan.length(), advance.plan.curved());
    let profile = live.contact.profile();
    let sought = advance.relax.map_or(0, |relax| relax.task.cost(profile, depth));
    let work = Work { moves, curved, depth, radii, residual: false };
    let steps = if live.contact.has_memory() { moves as u64 * MEMORY_MOVE_COST } else { 0 };
    let twists = advance.plan.twists() || live.contact.is_twisted();
    let twisted = if twists { cost::of_twist(moves) } else { 0 };
    let cost = work.cost(profile).saturating_add(sought).saturating_add(steps).saturating_add(twisted);
    let solve = {
        let (advance, by, stop) = (Arc::clone(advance), sessions.by.clone(), stop.clone());
        move || {
            let made = make(&mut live, &advance, by.as_ref(), &stop);
            (live, made)
        }
    };
    let (mut live, made) = sessions.pool.run(cost, solve).await?;
    let (records, mut reply) = match made {
        Ok(made) => made,
        Err(error) => {
            if in_place && matches!(error, SessionError::Failure(_)) {
                guard.live = Some(live);
            }
            return Err(error);
        }
    };
    if let Plan::Observations(_) = advance.plan {
        reply.body = Box::pin(sessions.observed(guard, &mut live, &records, stop)).await?;
    }
    Ok(Computed { live, records, reply })
}

/// Makes the moves, and writes the reply: the part of the work that needs a processor.
fn make(
    live: &mut LoadedSession,
    advance: &Advance,
    by: Option<&Arc<str>>,
    stop: &Deadline,
) -> Result<(Vec<Record>, Reply), SessionError> {
    let solving = otlp::part!("solve").entered();
    let now = Timestamp::now();
    let mut records: Vec<Record> = Vec::with_capacity(advance.plan.length());
    let mut sequence = live.session.sequence;
    let tolerance = advance.tolerance;
    let observations = if let Plan::Observations(observations) = &advance.plan { &observations[..] } else { &[] };
    check_plausible(observations, live.contact.normal_force())?;
    let moved = make_moves(&mut live.contact, advance, stop, |step, state| {
        sequence += 1;
        let measured = observations.get(records.len()).map(|&Observation { force, at, .. }| Measured { force, at });
        records.push(Record { sequence, step, tolerance, state, measured, by: by.cloned(), at: now });
    })?;
    let Moved { stress, protocol, relaxed, accuracy, warnings, followed_in } = moved;
    live.replay_cost.add(records.len(), followed_in);
    live.session.sequence = sequence;
    live.session.updated_at = records.last().map_or(live.session.updated_at, |last| last.at);
    let id = live.session.id;
    drop(solving);
    let state: State = live.contact.state().into();
    let shown = |steps: Steps| shown_states(steps, records.iter().map(|record| record.state), state);
    let body = match &advance.plan {
        _ if let (Some(relax), Some(protocol)) = (advance.relax, relaxed) => {
            written(&RelaxReply { id, sequence, dry_run: false, steps: relax.steps.map(shown), protocol })?
        }
        Plan::Single(_) => written(&MoveReply { id, sequence, state, stress, accuracy, warnings })?,
        // Written once the past has been read, for the estimate that is in it.
        Plan::Observations(_) => Vec::new(),
        _ => {
            let steps = shown(advance.steps);
            written(&PathReply { id, sequence, steps, stress, protocol, accuracy, warnings })?
        }
    };
    Ok((records, Reply { created: None, sequence, body }))
}
