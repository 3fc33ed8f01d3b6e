//! The way of a move: lock, load, compute, store, publish. This is the one place where the state of a session changes.

use std::pin::pin;

use jiff::Timestamp;

use crate::store::{IdempotentRequest, Reply, RequestKey, Usage};
use stickslip_compute::Stop as _;
use stickslip_compute::computations::{OnContact as _, dry_run_relax};
use stickslip_wire::RelaxReply;
use stickslip_wire::protocol::Relaxation;
use stickslip_wire::session::Advance;

use super::changes::answer_once;
use super::common::ATTEMPTS;
use super::compute::{Computed, compute};
use super::expected::Expected;
use super::prelude::*;
use super::published::UNVERIFIED;
use super::run_to_end::run_to_end;
use super::storage_reservation::StorageReservation;

impl Sessions {
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
        let request = self.request(key);
        answer_once(&request, pin!(self.apply_anew(id, Arc::new(advance), expected, &request))).await
    }

    async fn apply_anew(
        &self,
        id: Uuid,
        advance: Arc<Advance>,
        expected: Option<Expected>,
        request: &IdempotentRequest<'_>,
    ) -> Result<Reply, SessionError> {
        // A client that hangs up while it waits leaves the queue.
        let mut guard = self.lock(id).await?;
        let (stop, _raised_at_the_end) = self.pool.deadline();
        let bytes = advance.plan.length() as u64 * self.store.move_bytes();
        let mut reservation = self.reserve_storage(Usage::of(0, bytes, None)).await?;
        // A cached state may be behind the store, and its label too.
        let mut is_current = guard.live.is_none()
            || guard.version.is_some()
            || expected.is_some_and(|expected| expected.label.is_some());
        let mut found = 0;
        for _ in 0..ATTEMPTS {
            // Again, because the same request, sent twice, may have been done here or elsewhere while this one waited.
            if let Some(reply) = request.earlier_reply().await? {
                return Ok(reply);
            }
            let past = self.load_expected(&mut guard, expected, &mut is_current).await?;
            stop.flag().charge(std::mem::take(&mut guard.loading));
            let computed = match compute(self, &mut guard, &advance, &stop).await {
                Err(SessionError::Failure(_) | SessionError::Rejected(_))
                    if !is_current && Box::pin(self.catch_up(&mut guard, u64::MAX)).await? =>
                {
                    is_current = true;
                    continue;
                }
                computed => computed?,
            };
            let stored;
            (guard, reservation, stored) = self.store(guard, past, computed, request, reservation).await?;
            match stored {
                Ok(reply) => return Ok(reply),
                Err(error @ (StoreError::NotFound | StoreError::Expired(_))) => {
                    return Err(self.store_failure(&mut guard, error));
                }
                Err(StoreError::Stale { found: moved }) => {
                    (is_current, found) = (true, moved);
                    self.current(&mut guard).await?.shared = true;
                }
                Err(other) => return Err(other.into()),
            }
        }
        Err(SessionError::Overtaken { found })
    }

    /// Brings the state of a session into the guard, and returns its sequence and when it last moved, if it is at the
    /// sequence that the client expects. A refusal counts only once the state has caught up with the store.
    async fn load_expected(
        &self,
        guard: &mut Guard,
        expected: Option<Expected>,
        is_current: &mut bool,
    ) -> Result<(u64, Option<Timestamp>), SessionError> {
        let check = |live: &LoadedSession| {
            let (sequence, label) = (live.session.sequence, live.session.label.as_deref());
            expected.map_or(Ok(()), |expected| expected.check(sequence, label))?;
            Ok((sequence, Some(live.session.updated_at)))
        };
        if !*is_current {
            if let Ok(sequence) = check(self.cached(guard).await?) {
                return Ok(sequence);
            }
            *is_current = true;
        }
        check(self.current(guard).await?)
    }

    /// Stores moves after the past that they were computed for, and publishes them, even if the client hangs up
    /// meanwhile. Until the store has answered it is unknown whether the new state is stored. What the guard holds
    /// meanwhile is the state before, or nothing: if the store fails, the next request asks the store.
    async fn store(
        &self,
        guard: Guard,
        past: (u64, Option<Timestamp>),
        computed: Computed,
        request: &IdempotentRequest<'_>,
        mut reservation: StorageReservation,
    ) -> Result<(Guard, StorageReservation, Result<Reply, StoreError>), SessionError> {
        let Computed { live, records, reply } = computed;
        let moves = records.len() as u64;
        let receipt = request.receipt(&reply);
        let added = Usage::of(0, moves * self.store.move_bytes(), receipt.as_ref());
        if added.bytes > reservation.bytes() {
            drop(reservation);
            reservation = self.reserve_storage(added).await?;
        }
        let common = Arc::clone(&self.common);
        let append = async move {
            let mut guard = guard;
            let stored = common.store.append_after(guard.id(), past, records, receipt).await.map(|()| {
                reservation.used(added);
                // The change itself counts.
                guard.version = Some(guard.version.map_or(UNVERIFIED, |version| version.saturating_add(1)));
                publish(&common, &mut guard, live, moves);
                reply
            });
            (guard, reservation, stored)
        };
        Ok(run_to_end(append).await)
    }

    /// What [`Sessions::apply`] would do to relax a session at the sequence that the client expects; nothing changes.
    /// The memory of the request becomes what that takes.
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
        let (stop, _raised_at_the_end) = self.pool.deadline();
        self.pool.resize(memory, task.bytes()).await?;
        let (contact, sequence, state) = self.copy(id, None, &stop).await?;
        if let Some(expected) = expected {
            let label = if expected.label.is_some() { self.extent(id).await?.label } else { None };
            expected.check(sequence, label.as_deref())?;
        }
        let cost = task.cost(contact.profile(), contact.memory_depth());
        let work = move || {
            let _state = state;
            let (steps, protocol) = dry_run_relax(contact, &relaxation, &stop)?;
            written(&RelaxReply { id, sequence, dry_run: true, steps, protocol })
        };
        Ok((sequence, self.pool.run(cost, work).await??))
    }
}

/// Publishes stored moves: the state after them is what the next request finds, and a snapshot if one is due. The store
/// has woken those who listen.
fn publish(common: &Common, guard: &mut Guard, mut live: Box<LoadedSession>, moves: u64) {
    common.metrics.moves.inc_by(moves);
    common.offer_snapshot(&mut live);
    guard.live = Some(live);
}
