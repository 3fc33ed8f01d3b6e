//! Applying moves to a session: the one place where it changes.

use std::sync::Arc;

use jiff::Timestamp;
use tracing::Instrument as _;
use uuid::Uuid;

use crate::admission::{Reservation, Stop};
use crate::computations::{Moved, OnContact as _, make_moves, shown_states};
use crate::otlp;
use crate::simulation::bytes::{RECORD_BYTES, of_moves, of_stress};
use crate::simulation::cost::Work;
use crate::store::{IdempotentRequest, Measured, Record, Reply, RequestKey, StoreError, Usage};
use stickslip_wire::session::Advance;
use stickslip_wire::{MoveReply, Observation, PathReply, Plan, RelaxReply, State, Steps, limits};

use super::cache::Guard;
use super::group::{GroupResult, may_join};
use super::loaded::LoadedSession;
use super::observe::check_plausible;
use super::{ATTEMPTS, SessionError, Sessions, unless_answered, written};

/// The results of a computation that are to be stored.
pub(super) struct Done {
    pub(super) records: Vec<Record>,
    pub(super) reply: Reply,
}

/// The most pieces that one straight move can add to the slip history, with a margin.
pub(super) const PIECES_OF_A_MOVE: usize = 8;

impl Sessions {
    /// Bytes that moves take, with their records and the reply; rather too many than too few.
    #[must_use]
    pub fn bytes_of_moves(advance: &Advance) -> usize {
        let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
        advance.relax.map_or(0, |relax| relax.task.bytes())
            + of_moves(&advance.plan, advance.steps)
            + advance.plan.length() * RECORD_BYTES
            + of_stress(radii)
    }

    /// Applies moves to a session, all or none of them, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has changed then.
    pub async fn apply_moves(
        &self,
        id: Uuid,
        advance: Advance,
        expected: Option<u64>,
        key: Option<RequestKey>,
    ) -> Result<Reply, SessionError> {
        let request = self.request(key);
        // Before anything else: a retry gets its reply even if the session has been deleted or has moved on.
        if let Some(reply) = request.earlier_reply().await? {
            return Ok(reply);
        }
        let made = self.apply_anew(id, Arc::new(advance), expected, &request).await;
        unless_answered(&request, made).await
    }

    async fn apply_anew(
        &self,
        id: Uuid,
        advance: Arc<Advance>,
        expected: Option<u64>,
        request: &IdempotentRequest<'_>,
    ) -> Result<Reply, SessionError> {
        // A client that hangs up in the queue leaves it.
        let mut guard = if !request.has_key() && may_join(&advance) {
            match self.lock_or_join(id, &advance, expected).await? {
                GroupResult::Locked(guard) => guard,
                GroupResult::Answered(answer) => return answer,
            }
        } else {
            self.lock(id).await?
        };
        let (stop, _raised_at_the_end) = self.common.pool.deadline();
        let move_bytes = self.common.store.move_bytes();
        let mut reservation =
            self.reserve_storage(Usage::of(0, advance.plan.length() as u64 * move_bytes, None)).await?;
        // A cached state may be behind the store. A refusal counts only once the state has caught up.
        let mut caught_up = guard.live.is_none();
        let mut found = 0;
        for _ in 0..ATTEMPTS {
            // Again, because the same request, sent twice, may have been done here or elsewhere while this one waited.
            if let Some(reply) = request.earlier_reply().await? {
                return Ok(reply);
            }
            let live = if caught_up { self.current(&mut guard).await? } else { self.cached(&mut guard).await? };
            let sequence = live.session.sequence;
            if let Some(expected) = expected.filter(|expected| *expected != sequence) {
                if !caught_up {
                    caught_up = true;
                    continue;
                }
                return Err(SessionError::Stale { expected, found: sequence });
            }
            stop.count(std::mem::take(&mut guard.loading));
            let (mut live, Done { records, mut reply }) = match self.compute(&advance, &mut guard, &stop).await {
                Ok(done) => done,
                Err(SessionError::Failure(_) | SessionError::Rejected(_))
                    if !caught_up && Box::pin(self.catch_up(&mut guard, u64::MAX)).await? =>
                {
                    caught_up = true;
                    continue;
                }
                Err(error) => return Err(error),
            };
            if let Plan::Observations(_) = advance.plan {
                reply.body = Box::pin(self.observed(&mut guard, &mut live, &records, &stop)).await?;
            }
            // Until the store has answered the new state is in doubt. What the guard holds meanwhile is the state
            // before, or nothing: if the store fails or the client hangs up, the next request asks the store.
            let moves = records.len() as u64;
            let receipt = request.receipt(&reply);
            let added = Usage::of(0, moves * move_bytes, receipt.as_ref());
            if added.bytes > reservation.bytes() {
                drop(reservation);
                reservation = self.reserve_storage(added).await?;
            }
            let stored = self.common.store.append(guard.id(), sequence, records, receipt);
            match stored.instrument(otlp::part!("store")).await {
                Ok(()) => {
                    self.common.metrics.moves.inc_by(moves);
                    reservation.used(added);
                    self.offer_snapshot(&mut live);
                    guard.live = Some(live);
                    return Ok(reply);
                }
                Err(error @ (StoreError::NotFound | StoreError::Expired(_))) => {
                    return Err(self.store_failure(&mut guard, error));
                }
                Err(StoreError::Stale { found: moved }) => {
                    (caught_up, found) = (true, moved);
                    self.current(&mut guard).await?.shared = true;
                }
                Err(other) => return Err(other.into()),
            }
        }
        Err(SessionError::Overtaken { found })
    }

    /// Computes the moves. The guard keeps the state before them, or, if it has been used up, nothing.
    async fn compute(
        &self,
        advance: &Arc<Advance>,
        guard: &mut Guard,
        stop: &Stop,
    ) -> Result<(Box<LoadedSession>, Done), SessionError> {
        let depth = guard.live.as_ref().map_or(0, |live| live.contact.memory_depth());
        // A single move that the mechanics refuses has changed nothing, so that it needs no copy to fall back on; and a
        // copy costs as much as the slip history is deep. A move that another process may have overtaken needs the
        // copy.
        let in_place = matches!(advance.plan, Plan::Single(step) if !step.is_curved())
            && advance.stress.is_none()
            && depth + PIECES_OF_A_MOVE <= limits::MEMORY_DEPTH
            && guard.live.as_ref().is_some_and(|live| !live.shared);
        // A copy can be large, and many requests may be under way.
        let copied = guard.live.as_ref().filter(|_| !in_place).map_or(0, |live| live.contact.memory_bytes());
        let _held = if copied > 0 { self.reserve_copy(guard, copied).await? } else { Reservation::default() };
        let live = if in_place { guard.live.take() } else { guard.live.clone() };
        let live = live.ok_or(SessionError::NotFound(guard.id()))?;
        let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
        let (moves, curved) = (advance.plan.length(), advance.plan.curved());
        let profile = live.contact.profile();
        let sought = advance.relax.map_or(0, |relax| relax.task.cost(profile, depth));
        let work = Work { moves, curved, depth, radii, residual: false };
        let cost = work.cost(profile).saturating_add(sought);
        let (advance, stop) = (Arc::clone(advance), stop.clone());
        let by = self.by.clone();
        let (live, result) = self.common.pool.run(cost, move || attempt(live, &advance, by.as_ref(), &stop)).await?;
        match result {
            Ok(done) => Ok((live, done)),
            Err(error) => {
                if in_place && matches!(error, SessionError::Failure(_)) {
                    guard.live = Some(live);
                }
                Err(error)
            }
        }
    }
}

/// Makes the moves, and returns the state whether they are made or refused.
pub(super) fn attempt(
    mut live: Box<LoadedSession>,
    advance: &Advance,
    by: Option<&Arc<str>>,
    stop: &Stop,
) -> (Box<LoadedSession>, Result<Done, SessionError>) {
    let result = make(&mut live, advance, by, stop);
    (live, result)
}

/// Makes the moves, and writes the reply: the part of the work that needs a processor.
fn make(live: &mut LoadedSession, advance: &Advance, by: Option<&Arc<str>>, stop: &Stop) -> Result<Done, SessionError> {
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
    live.session.updated_at = now;
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
    Ok(Done { records, reply: Reply { created: None, sequence, body } })
}
