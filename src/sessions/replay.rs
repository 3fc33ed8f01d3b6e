//! From what is stored to a state: the newest snapshot, and the moves after it.

use std::time::Instant;

use uuid::Uuid;

use crate::simulation::cost::Work;
use crate::store::{Record, Session, StoreError};
use stickslip_wire::limits;

use super::cache::Guard;
use super::loaded::LoadedSession;
use super::{SessionError, Sessions};

/// Moves that are fetched from the store at a time.
pub(super) const PAGE: usize = 10_000;
/// Pieces of slip history that a move leaves, as an estimate for a state that is not loaded yet.
const PIECES: usize = 4;
/// Bytes of one piece.
pub(super) const PIECE_BYTES: usize = 96;

impl Sessions {
    /// The session as it is cached, or else as it is stored. Other processes may have moved or deleted it since: the
    /// result is to be checked against the store.
    pub(super) async fn cached<'a>(&self, guard: &'a mut Guard) -> Result<&'a mut LoadedSession, SessionError> {
        if guard.live.is_none() {
            self.load(guard).await?;
        }
        let id = guard.id();
        guard.live.as_deref_mut().ok_or(SessionError::NotFound(id))
    }

    /// The session as it is stored: with what other processes have done to it up to now.
    pub(super) async fn current<'a>(&self, guard: &'a mut Guard) -> Result<&'a mut LoadedSession, SessionError> {
        if let Some(cached) = guard.live.as_ref().map(|live| live.session.sequence) {
            let stored =
                self.common.store.sequence(guard.id()).await.map_err(|error| self.store_failure(guard, error))?;
            if stored > cached {
                self.catch_up(guard).await?;
            } else if stored < cached {
                // The store has been restored from a backup.
                guard.live = None;
            }
        }
        self.cached(guard).await
    }

    /// Applies the moves that are stored after the cached state; returns whether there were any.
    pub(super) async fn catch_up(&self, guard: &mut Guard) -> Result<bool, SessionError> {
        let id = guard.id();
        let mut moved = false;
        while let Some(sequence) = guard.live.as_ref().map(|live| live.session.sequence) {
            let page = match self.common.store.history(id, sequence, PAGE).await {
                Ok(page) => page,
                Err(error) => return Err(self.store_failure(guard, error)),
            };
            let (first, last_page) = (page.first().map(|record| record.sequence), page.len() < PAGE);
            if let Some(first) = first
                && first != sequence + 1
            {
                return Err(broken(guard, &format_args!("move {} is missing", sequence + 1)));
            }
            if first.is_some()
                && let Some(live) = guard.live.take()
            {
                guard.live = Some(self.follow(live, page).await?);
                moved = true;
            }
            if last_page {
                break;
            }
        }
        if let Some(live) = guard.live.as_mut().filter(|_| moved) {
            live.shared = true;
            self.offer_snapshot(live);
        }
        Ok(moved)
    }

    /// Loads a session that is not cached from the store.
    async fn load(&self, guard: &mut Guard) -> Result<(), SessionError> {
        let (id, begin) = (guard.id(), Instant::now());
        // The snapshot first: taken later, it might be of a move that the session found has not made yet.
        let snapshot = self.common.store.snapshot(id).await;
        let session = self.find_own(id).await?;
        let (sequence, updated_at) = (session.sequence, session.updated_at);
        let pieces = usize::try_from(sequence).unwrap_or(usize::MAX).saturating_mul(PIECES).min(limits::MEMORY_DEPTH);
        guard.held = self.common.pool.reserve(pieces * PIECE_BYTES).await?;
        let mut live = Box::new(LoadedSession::of_stored(session).map_err(|error| broken(guard, &error))?);
        (live.contact, live.session.sequence) = self.load_snapshot(snapshot, live.contact, sequence).await?;
        guard.live = Some(live);
        self.catch_up(guard).await?;
        if let Some(live) = guard.live.as_mut() {
            let reached = live.session.sequence;
            if reached < sequence {
                guard.live = None;
                return Err(broken(guard, &format_args!("moves are missing after {reached}")));
            }
            if reached == sequence {
                live.session.updated_at = updated_at;
            }
            live.shared = false;
        }
        self.common.metrics.open.observe(begin.elapsed().as_secs_f64());
        Ok(())
    }

    /// Applies stored moves.
    async fn follow(
        &self,
        mut live: Box<LoadedSession>,
        page: Vec<Record>,
    ) -> Result<Box<LoadedSession>, SessionError> {
        let curved = page.iter().filter(|record| record.step.is_curved()).count();
        let cost = Work { moves: page.len(), curved, ..Work::default() }.cost(live.contact.profile());
        let replayed = self.common.pool.run(cost, move || {
            let begin = Instant::now();
            for record in &page {
                live.contact.apply_within(&record.step.step(), record.tolerance)?;
                live.session.sequence = record.sequence;
                live.session.updated_at = record.at;
            }
            live.replay_cost.add(page.len(), begin.elapsed());
            Ok(live)
        });
        replayed.await?.map_err(|error: stickslip_mechanics::Error| {
            SessionError::Broken(format!("a stored move cannot be made again: {error}"))
        })
    }

    /// The session as it is stored, if it belongs to the tenant.
    pub(super) async fn find_own(&self, id: Uuid) -> Result<Session, SessionError> {
        match self.common.store.find(id).await {
            Ok(session) if session.tenant == self.tenant => Ok(session),
            Ok(_) => Err(SessionError::NotFound(id)),
            Err(error) => Err(self.store_error(id, error)),
        }
    }

    /// Converts a failure of the store. If the session is gone, its cached state is removed too.
    pub(super) fn store_failure(&self, guard: &mut Guard, error: StoreError) -> SessionError {
        if matches!(error, StoreError::NotFound | StoreError::Expired(_)) {
            guard.live = None;
        }
        self.store_error(guard.id(), error)
    }

    /// Converts a failure of the store.
    pub(super) fn store_error(&self, id: Uuid, error: StoreError) -> SessionError {
        match error {
            StoreError::Expired(tenant) if tenant == self.tenant => SessionError::Expired(id),
            StoreError::NotFound | StoreError::Expired(_) => SessionError::NotFound(id),
            other => SessionError::Store(other),
        }
    }
}

fn broken(guard: &Guard, error: &dyn std::fmt::Display) -> SessionError {
    SessionError::Broken(format!("contact {} cannot be replayed: {error}", guard.id()))
}
