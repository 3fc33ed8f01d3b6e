//! The state of a session: the cached one, or a replay of its newest snapshot and the moves after it.

use std::time::Instant;

use crate::store::{Extent, RECORD_BYTES, Record, Session, Snapshot, Whole};
use stickslip_compute::simulation::{
    Failure, Timer,
    cost::{MEMORY_MOVE_COST, Work},
};
use stickslip_compute::{Interrupted, Stop as _};
use stickslip_wire::{ContactDefinition, limits};

use super::prelude::*;
use super::published::UNVERIFIED;

/// Moves that are fetched from the store at a time.
pub(super) const PAGE: usize = 10_000;
/// Pieces of slip history that a move leaves, as an estimate for a state that is not loaded yet.
const PIECES: usize = 4;
/// Bytes of one piece.
pub(super) const PIECE_BYTES: usize = 96;
/// A state that grows has room for up to twice its pieces; a copy has none to spare.
const COPIES: usize = 3;
/// Bytes that a byte of a definition becomes while it is read and prepared: a point of a table is a few digits, and
/// then a series.
const PREPARED: usize = 100;
/// Bytes of a definition that holds no table.
const SHORT_DEFINITION: u64 = 1_024;
/// Work between two snapshots of a replay, which is lost where the client hangs up.
const KEPT_EVERY: Duration = Duration::from_secs(1);
/// Moves that are read together with the session that made them: with their records they take less than a small
/// request.
const SMALL_HISTORY: u64 = 64;

impl Sessions {
    /// The cached session, or the stored one. Other processes may have moved or deleted it since: the
    /// result is to be checked against the store.
    pub(super) async fn cached<'a>(&self, guard: &'a mut Guard) -> Result<&'a mut LoadedSession, SessionError> {
        if guard.live.as_ref().is_none_or(|live| live.is_behind) {
            // In a box, so that a request whose session is cached is not as large as one that has to load it.
            Box::pin(self.load(guard)).await?;
        }
        let id = guard.id();
        guard.live.as_deref_mut().ok_or(SessionError::NotFound(id))
    }

    /// The stored session, with the changes that other processes have made up to now.
    pub(super) async fn current<'a>(&self, guard: &'a mut Guard) -> Result<&'a mut LoadedSession, SessionError> {
        let is_current = guard.version.is_some_and(|version| self.is_version(guard.id(), version));
        if let Some(live) = guard.live.as_ref().filter(|_| !is_current) {
            let (cached, moved_at) = (live.session.sequence, live.session.updated_at);
            let version = self.store.changes().version(guard.id()).unwrap_or(UNVERIFIED);
            let stored = self.store.extent(guard.id()).await;
            let stored = stored.map_err(|error| self.store_failure(guard, error))?;
            if let Some(live) = &mut guard.live {
                live.session.label.clone_from(&stored.label);
            }
            if stored.sequence > cached {
                // No further: the label belongs to this sequence.
                Box::pin(self.catch_up(guard, stored.sequence)).await?;
            } else if stored.sequence < cached || !stored.is_moved_at(moved_at) {
                // The store has been restored from a backup.
                guard.live = None;
            }
            guard.version = guard.live.as_ref().map(|_| version);
        }
        self.cached(guard).await
    }

    /// Applies the moves that are stored after the cached state, up to a sequence; returns whether there were any.
    pub(super) async fn catch_up(&self, guard: &mut Guard, last: u64) -> Result<bool, SessionError> {
        let id = guard.id();
        let mut moved = false;
        while let Some(sequence) = guard.live.as_ref().map(|live| live.session.sequence).filter(|at| *at < last) {
            let limit = usize::try_from(last - sequence).map_or(PAGE, |left| left.min(PAGE));
            let page = self.store.history(id, sequence, limit).await;
            let page = page.map_err(|error| self.store_failure(guard, error))?;
            let is_last = page.len() < limit;
            if let Some(live) = guard.live.take_if(|_| !page.is_empty()) {
                let (live, followed) = self.follow(guard, live, page).await?;
                guard.live = Some(live);
                followed?;
                moved = true;
            }
            if is_last {
                break;
            }
        }
        if let Some(live) = &mut guard.live {
            // Of moves that this process began to replay nobody says that another has made them since.
            live.shared |= moved && !live.is_behind;
            live.is_behind = false;
            if moved {
                self.offer_snapshot(live);
            }
        }
        Ok(moved)
    }

    /// Loads a session that is not cached from the store, or goes on where an earlier request has been stopped. What
    /// has been replayed when the time is up stays in the guard.
    async fn load(&self, guard: &mut Guard) -> Result<(), SessionError> {
        if guard.live.is_some() {
            return self.catch_up(guard, u64::MAX).await.map(drop);
        }
        let (id, begin) = (guard.id(), Instant::now());
        let version = self.store.changes().version(id).unwrap_or(UNVERIFIED);
        let (extent, whole) = self.own(id, self.store.load(id, is_small).await, |(extent, _)| &extent.tenant)?;
        // A request that has some of this memory never waits for more of it.
        guard.held = Reservation::default();
        guard.held = self.pool.reserve_states(bytes_to_load(&extent)).await?;
        let ((mut live, followed), updated_at) = match whole {
            Some(Whole { session, moves }) => {
                let updated_at = session.updated_at;
                let first = self.first_state(guard, session).await?;
                (self.follow(guard, first, moves).await?, updated_at)
            }
            None => {
                // First: taken later, it might be of a move that the session found has not made yet.
                let snapshot = self.store.snapshot(id).await;
                let session = self.find_own(id).await?;
                let (last, updated_at) = (session.sequence, session.updated_at);
                if matches!(&snapshot, Ok(Some(snapshot)) if snapshot.sequence > last) {
                    return Err(damaged(id, &format_args!("move {} is missing", last + 1)));
                }
                (self.replayed(guard, session, snapshot, last).await?, updated_at)
            }
        };
        if followed.is_ok() {
            live.session.updated_at = updated_at;
        }
        self.offer_snapshot(&mut live);
        // The state, and a copy of it, which shares the profile.
        guard.held.shrink(2 * live.bytes() + live.shape_bytes());
        guard.live = Some(live);
        followed?;
        guard.version = Some(version);
        self.metrics.open.observe(begin.elapsed().as_secs_f64());
        Ok(())
    }

    /// A stored session after its move `last`, from its snapshot on, or as far as [`Sessions::follow`] came.
    async fn replayed(
        &self,
        guard: &mut Guard,
        session: Session,
        snapshot: Result<Option<Snapshot>, StoreError>,
        last: u64,
    ) -> Result<(Box<LoadedSession>, Result<(), SessionError>), SessionError> {
        let id = session.id;
        let mut live = self.first_state(guard, session).await?;
        (live.contact, live.session.sequence, live.unreadable) =
            self.load_snapshot(&mut guard.loading, snapshot, live.contact, last).await?;
        while live.session.sequence < last {
            let page = self.page(id, live.session.sequence, last).await?;
            let followed;
            (live, followed) = self.follow(guard, live, page).await?;
            if followed.is_err() {
                return Ok((live, followed));
            }
        }
        Ok((live, Ok(())))
    }

    /// A copy of the session after so many of its moves, or after all of them, and the memory of a state that is made
    /// for it.
    ///
    /// # Errors
    /// [`SessionError::NoSuchMove`] if it has made fewer, and as [`Sessions::current`]; damage after
    /// the last of so many moves is no error.
    pub(super) async fn after(
        &self,
        guard: &mut Guard,
        sequence: Option<u64>,
    ) -> Result<(Box<LoadedSession>, Reservation), SessionError> {
        let id = guard.id();
        let (bytes, session) = match self.current(guard).await {
            Ok(now) => (now.contact.memory_bytes(), now.session.clone()),
            // What was made before the damage may be whole.
            Err(SessionError::Store(StoreError::Damaged { .. })) if sequence.is_some() => {
                let extent = self.store.extent(id).await.map_err(|error| self.store_failure(guard, error))?;
                (bytes_to_load(&extent), self.find_own(id).await?)
            }
            Err(error) => return Err(error),
        };
        let found = session.sequence;
        let wanted = sequence.unwrap_or(found);
        if wanted > found {
            return Err(SessionError::NoSuchMove { found });
        }
        let held = self.reserve_copy(guard, bytes).await?;
        if let Some(now) = guard.live.as_ref().filter(|now| now.session.sequence == wanted && wanted == found) {
            return Ok((now.clone(), held));
        }
        let snapshot = self.store.snapshot(id).await;
        let (copy, followed) = self.replayed(guard, session, snapshot, wanted).await?;
        followed?;
        Ok((copy, held))
    }

    /// The first of the moves of a session after the move `after`, up to the move `last`, which is after it: as many as
    /// are fetched at a time.
    ///
    /// # Errors
    /// As [`Sessions::store_error`]; it is damaged if there is none.
    pub(super) async fn page(&self, id: Uuid, after: u64, last: u64) -> Result<Vec<Record>, SessionError> {
        let limit = usize::try_from(last - after).map_or(PAGE, |left| left.min(PAGE));
        let page = self.store.history(id, after, limit).await.map_err(|error| self.store_error(id, error))?;
        if page.is_empty() {
            return Err(damaged(id, &format_args!("move {} is missing", after + 1)));
        }
        Ok(page)
    }

    /// The state of a stored session before its first move. The sequence of the session is that of the store.
    async fn first_state(&self, guard: &mut Guard, session: Session) -> Result<Box<LoadedSession>, SessionError> {
        let id = session.id;
        let (stop, _raised_at_the_end) = self.pool.deadline_after(guard.loading);
        let profiles = self.profiles(&stop);
        let cost = profiles.cost_of(&session.definition.defined_profile(""))?;
        let work = move || {
            let timer = Timer::start(&stop);
            let first = LoadedSession::of_stored(session, &profiles).map(Box::new);
            if first.is_err() {
                stop.check().map_err(Failure::from)?;
            }
            Ok::<_, Failure>((first, timer.elapsed()))
        };
        let first;
        (first, guard.loading) = self.pool.run(cost, work).await??;
        first.map_err(|error| damaged(id, &error))
    }

    /// Makes the moves of a page, as work of the request: the deadline and a client that hangs up end it. Every now and
    /// then, and at the end, the replayed state is offered to the store as a snapshot.
    ///
    /// # Errors
    /// Within, beside the state after as many of the moves as time allowed: [`SessionError::Loading`].
    async fn follow(
        &self,
        guard: &mut Guard,
        mut live: Box<LoadedSession>,
        page: Vec<Record>,
    ) -> Result<(Box<LoadedSession>, Result<(), SessionError>), SessionError> {
        let curved = page.iter().filter(|record| record.step.is_curved()).count();
        let id = live.session.id;
        let steps = if live.contact.has_memory() { page.len() as u64 * MEMORY_MOVE_COST } else { 0 };
        let work = Work { moves: page.len(), curved, ..Work::default() };
        let cost = work.cost(live.contact.profile()).saturating_add(steps);
        let (stop, _raised_at_the_end) = self.pool.deadline_after(guard.loading);
        let common = Arc::clone(&self.common);
        let replay = move || {
            let timer = Timer::start(&stop);
            let followed = replay(&mut live, &page, &stop, timer, &common);
            (live, followed, timer.elapsed())
        };
        let (live, followed, loading) = self.pool.run(cost, replay).await?;
        guard.loading = loading;
        let followed = followed.map_err(|error: stickslip_mechanics::Error| {
            damaged(id, &format_args!("a stored move cannot be replayed: {error}"))
        })?;
        let replayed = live.session.sequence;
        let stopped = |interrupted| match interrupted {
            Interrupted::TimeLimit(allowed) => SessionError::Loading { replayed, allowed },
            Interrupted::Abandoned => Failure::from(interrupted).into(),
        };
        Ok((live, followed.map_err(stopped)))
    }

    /// What `copy` takes of the current state; `stop` counts what loading it takes. The lock is held for that alone, so
    /// that the session can move on meanwhile.
    pub(super) async fn copies<T>(
        &self,
        id: Uuid,
        stop: &Deadline,
        copy: impl FnOnce(&LoadedSession) -> T,
    ) -> Result<T, SessionError> {
        let mut guard = self.lock(id).await?;
        let copies = copy(self.current(&mut guard).await?);
        stop.flag().charge(guard.loading);
        Ok(copies)
    }

    /// A copy of the contact, which is `expected` to have this definition, with its sequence and memory for it; `stop`
    /// counts what loading it takes. The lock is held for the copy alone, so that the session can move on meanwhile.
    pub(super) async fn copy(
        &self,
        id: Uuid,
        expected: Option<ContactDefinition>,
        stop: &Deadline,
    ) -> Result<(Contact, u64, Reservation), SessionError> {
        let mut guard = self.lock(id).await?;
        let live = self.current(&mut guard).await?;
        if expected.is_some_and(|expected| expected != *live.session.definition) {
            return Err(SessionError::OtherDefinition(id));
        }
        let (contact, sequence) = (live.contact.memory_bytes(), live.session.sequence);
        let held = self.reserve_copy(&mut guard, contact).await?;
        held.shrink(contact);
        stop.flag().charge(guard.loading);
        let live = guard.live.as_ref().ok_or(SessionError::NotFound(id))?;
        Ok((live.contact.clone(), sequence, held))
    }

    /// Memory for a copy of the state in a guard. Loading a state from the store has reserved it already, so that no
    /// request waits for memory while it holds some.
    pub(super) async fn reserve_copy(&self, guard: &mut Guard, bytes: usize) -> Result<Reservation, SessionError> {
        if guard.held.is_counted() {
            return Ok(std::mem::take(&mut guard.held));
        }
        Ok(self.pool.reserve_states(bytes).await?)
    }
}

/// Makes stored moves, until the flag ends it or one cannot be made. A state is offered as a snapshot whenever
/// [`KEPT_EVERY`] has been worked since the last, and where the flag ends it: after the client has hung up, no request
/// keeps the state.
fn replay(
    live: &mut LoadedSession,
    page: &[Record],
    stop: &Deadline,
    timer: Timer<'_>,
    common: &Common,
) -> Result<Result<(), Interrupted>, stickslip_mechanics::Error> {
    let (mut moves, mut since) = (0, timer.elapsed());
    for record in page {
        let checked = match live.contact.apply_while(&record.step.step(), record.tolerance, &|| stop.check().is_ok()) {
            Ok(()) => {
                live.session.sequence = record.sequence;
                live.session.updated_at = record.at;
                moves += 1;
                stop.check()
            }
            // It has changed nothing.
            Err(stickslip_mechanics::Error::Interrupted) => stop.check().and(Err(Interrupted::Abandoned)),
            Err(error) => return Err(error),
        };
        let worked = timer.elapsed().saturating_sub(since);
        if checked.is_err() || worked >= KEPT_EVERY {
            live.replay_cost.add(moves, worked);
            common.offer_snapshot(live);
            (moves, since) = (0, timer.elapsed());
        }
        if checked.is_err() {
            live.is_behind = true;
            return Ok(checked);
        }
    }
    live.replay_cost.add(moves, timer.elapsed().saturating_sub(since));
    Ok(Ok(()))
}

/// Whether a session takes so little that it may be read before memory is reserved for it.
fn is_small(extent: &Extent) -> bool {
    extent.sequence <= SMALL_HISTORY && extent.definition <= SHORT_DEFINITION && extent.snapshot == 0
}

/// Bytes that a session takes while it is brought from the store, with a copy of its state; rather too many than too
/// few.
fn bytes_to_load(extent: &Extent) -> usize {
    let number = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let pieces = number(extent.sequence).saturating_mul(PIECES).min(limits::MEMORY_DEPTH);
    let page = number(extent.sequence).min(PAGE) * RECORD_BYTES;
    // A definition of more than a few lines is a table, of which each point becomes a series.
    let definition = if extent.definition > SHORT_DEFINITION { number(extent.definition) } else { 0 };
    (COPIES * PIECE_BYTES * pieces)
        .saturating_add(number(extent.snapshot) + page)
        .saturating_add(definition.saturating_mul(PREPARED))
}

/// A session that cannot be replayed from its stored moves.
pub(super) fn damaged(contact: Uuid, why: &dyn std::fmt::Display) -> SessionError {
    StoreError::Damaged { contact, what: why.to_string() }.into()
}
