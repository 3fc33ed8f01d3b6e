//! Applying moves to a session: the one place where its state changes.

use std::pin::pin;
use std::sync::Arc;

use tracing::Instrument as _;
use uuid::Uuid;

use crate::admission::{Deadline, Reservation};
use crate::otlp;
use crate::store::{IdempotentRequest, Reply, RequestKey, StoreError, Usage};
use stickslip_compute::Stop as _;
use stickslip_compute::computations::{OnContact as _, dry_run_relax};
use stickslip_compute::simulation::bytes::{of_moves, of_records, of_stress};
use stickslip_compute::simulation::cost::Work;
use stickslip_wire::protocol::Relaxation;
use stickslip_wire::session::Advance;
use stickslip_wire::{Plan, RelaxReply, limits};

use super::attempt::{Done, PIECES_OF_A_MOVE, attempt};
use super::cache::Guard;
use super::changes::answer_once;
use super::expected::Expected;
use super::group::{GroupResult, lock_or_join, may_join};
use super::loaded::LoadedSession;
use super::observations::Observations;
use super::replay::Replay;
use super::run_to_end::run_to_end;
use super::{ATTEMPTS, SessionError, written};

/// Bytes that moves take, with their records and the reply; rather too many than too few.
#[must_use]
pub fn bytes_of_moves(advance: &Advance) -> usize {
    let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
    advance.relax.map_or(0, |relax| relax.task.bytes())
        + of_moves(&advance.plan, advance.steps)
        + of_records(advance.plan.length())
        + of_stress(radii)
}

/// Moves of the sessions of a tenant, for requests that come with the key of the name `by`.
#[derive(Clone)]
pub struct Mover {
    pub(super) replay: Replay,
    pub(super) by: Option<Arc<str>>,
}

impl Mover {
    /// Applies moves to a session, all or none of them, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has changed then.
    pub async fn apply(
        &self,
        id: Uuid,
        advance: Advance,
        expected: Option<Expected>,
        key: Option<RequestKey>,
    ) -> Result<Reply, SessionError> {
        let request = self.replay.request(key);
        answer_once(&request, pin!(self.apply_anew(id, Arc::new(advance), expected, &request))).await
    }

    async fn apply_anew(
        &self,
        id: Uuid,
        advance: Arc<Advance>,
        expected: Option<Expected>,
        request: &IdempotentRequest<'_>,
    ) -> Result<Reply, SessionError> {
        // A client that hangs up in the queue leaves it.
        let mut guard = if !request.has_key() && may_join(&advance) {
            match lock_or_join(&self.replay, self.by.as_ref(), id, &advance, expected).await? {
                GroupResult::Locked(guard) => guard,
                GroupResult::Answered(answer) => return answer,
            }
        } else {
            self.replay.lock(id).await?
        };
        let (stop, _raised_at_the_end) = self.replay.common.pool.deadline();
        let move_bytes = self.replay.common.store.move_bytes();
        let mut reservation =
            self.replay.reserve_storage(Usage::of(0, advance.plan.length() as u64 * move_bytes, None)).await?;
        // A cached state may be behind the store, and its label too. A refusal counts only once the state has caught
        // up.
        let mut caught_up = guard.live.is_none() || expected.is_some_and(|expected| expected.label.is_some());
        let mut found = 0;
        for _ in 0..ATTEMPTS {
            // Again, because the same request, sent twice, may have been done here or elsewhere while this one waited.
            if let Some(reply) = request.earlier_reply().await? {
                return Ok(reply);
            }
            let live =
                if caught_up { self.replay.current(&mut guard).await? } else { self.replay.cached(&mut guard).await? };
            let sequence = live.session.sequence;
            if let Some(Err(refusal)) = expected.map(|it| it.check(sequence, live.session.label.as_deref())) {
                if !caught_up {
                    caught_up = true;
                    continue;
                }
                return Err(refusal);
            }
            stop.flag().charge(std::mem::take(&mut guard.loading));
            let (mut live, Done { records, mut reply }) = match self.compute(&advance, &mut guard, &stop).await {
                Ok(done) => done,
                Err(SessionError::Failure(_) | SessionError::Rejected(_))
                    if !caught_up && Box::pin(self.replay.catch_up(&mut guard, u64::MAX)).await? =>
                {
                    caught_up = true;
                    continue;
                }
                Err(error) => return Err(error),
            };
            if let Plan::Observations(_) = advance.plan {
                reply.body =
                    Box::pin(Observations::of(&self.replay).observed(&mut guard, &mut live, &records, &stop)).await?;
            }
            // Until the store has answered the new state is in doubt. What the guard holds meanwhile is the state
            // before, or nothing: if the store fails, the next request asks the store.
            let moves = records.len() as u64;
            let receipt = request.receipt(&reply);
            let added = Usage::of(0, moves * move_bytes, receipt.as_ref());
            if added.bytes > reservation.bytes() {
                drop(reservation);
                reservation = self.replay.reserve_storage(added).await?;
            }
            let common = Arc::clone(&self.replay.common);
            let append = async move {
                let stored = common.store.append(guard.id(), sequence, records, receipt);
                let stored = stored.instrument(otlp::part!("store")).await;
                if stored.is_ok() {
                    common.metrics.moves.inc_by(moves);
                    reservation.used(added);
                    common.snapshots.offer(&mut live);
                    guard.live = Some(live);
                }
                (guard, reservation, stored)
            };
            let stored;
            (guard, reservation, stored) = run_to_end(append).await;
            match stored {
                Ok(()) => return Ok(reply),
                Err(error @ (StoreError::NotFound | StoreError::Expired(_))) => {
                    return Err(self.replay.store_failure(&mut guard, error));
                }
                Err(StoreError::Stale { found: moved }) => {
                    (caught_up, found) = (true, moved);
                    self.replay.current(&mut guard).await?.shared = true;
                }
                Err(other) => return Err(other.into()),
            }
        }
        Err(SessionError::Overtaken { found })
    }

    /// What [`Mover::apply`] would do to relax a session at the sequence that the client expects; nothing changes. The
    /// memory of the request becomes what that takes.
    ///
    /// # Errors
    /// [`SessionError`].
    pub async fn dry_run_relax(
        &self,
        id: Uuid,
        relaxation: Relaxation,
        expected: Option<Expected>,
        memory: &mut Reservation,
    ) -> Result<(u64, Vec<u8>), SessionError> {
        let task = relaxation.task;
        let (stop, _raised_at_the_end) = self.replay.common.pool.deadline();
        self.replay.common.pool.resize(memory, task.bytes()).await?;
        let (contact, sequence, state) = self.replay.copy(id, None, &stop).await?;
        if let Some(expected) = expected {
            let label = if expected.label.is_some() { self.replay.extent(id).await?.label } else { None };
            expected.check(sequence, label.as_deref())?;
        }
        let cost = task.cost(contact.profile(), contact.memory_depth());
        let work = move || {
            let _state = state;
            let (steps, protocol) = dry_run_relax(contact, &relaxation, &stop)?;
            written(&RelaxReply { id, sequence, dry_run: true, steps, protocol })
        };
        Ok((sequence, self.replay.common.pool.run(cost, work).await??))
    }

    /// Computes the moves. The guard keeps the state before them, or, if it has been used up, nothing.
    async fn compute(
        &self,
        advance: &Arc<Advance>,
        guard: &mut Guard,
        stop: &Deadline,
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
        let _held = if copied > 0 { self.replay.reserve_copy(guard, copied).await? } else { Reservation::default() };
        let live = if in_place { guard.live.take() } else { guard.live.clone() };
        let mut live = live.ok_or(SessionError::NotFound(guard.id()))?;
        let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
        let (moves, curved) = (advance.plan.length(), advance.plan.curved());
        let profile = live.contact.profile();
        let sought = advance.relax.map_or(0, |relax| relax.task.cost(profile, depth));
        let work = Work { moves, curved, depth, radii, residual: false };
        let cost = work.cost(profile).saturating_add(sought);
        let (advance, stop) = (Arc::clone(advance), stop.clone());
        let by = self.by.clone();
        let solve = move || {
            let result = attempt(&mut live, &advance, by.as_ref(), &stop);
            (live, result)
        };
        let (live, result) = self.replay.common.pool.run(cost, solve).await?;
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
