//! Reading sessions. A read changes nothing, and waits at most for the move under way.

use std::sync::Arc;

use tracing::Instrument as _;
use uuid::Uuid;

use crate::admission::{Reservation, Stop};
use crate::computations::{OnContact, Shown};
use crate::otlp;
use crate::simulation::{bytes, cost};
use stickslip_mechanics::Contact;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{ContactDefinition, HistoryItem, HistoryPage, SessionPage, SessionReply, SubsurfaceRequest};

use super::cache::Guard;
use super::replay::{PAGE, damaged};
use super::{SessionError, Sessions, written};

impl Sessions {
    /// A session with its state.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn get(&self, id: Uuid) -> Result<SessionReply, SessionError> {
        let mut guard = self.lock(id).await?;
        Ok(self.current(&mut guard).await?.reply())
    }

    /// The definition of a session as it was sent, as JSON, and the memory that it takes.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn definition(&self, id: Uuid) -> Result<(Vec<u8>, Reservation), SessionError> {
        let definition = {
            let mut guard = self.lock(id).await?;
            // It does not depend on the state, which is not loaded for it.
            match guard.live {
                Some(_) => Arc::clone(&self.current(&mut guard).await?.session.definition),
                None => self.find_own(id).await?.definition,
            }
        };
        let points = definition.profile.points();
        let held = self.common.pool.reserve(points * bytes::WRITTEN_POINT_BYTES).await?;
        let work = move || written(&*definition);
        Ok((self.common.pool.run(cost::writing_table(points), work).await??, held))
    }

    /// The reply of a computation on a session, which `said` to have this definition, with the sequence that it belongs
    /// to and the memory that it takes.
    ///
    /// # Errors
    /// [`SessionError`], among them [`SessionError::OtherDefinition`].
    pub async fn compute_on<T: OnContact>(
        &self,
        id: Uuid,
        said: Option<ContactDefinition>,
        task: T,
        shown: Shown,
    ) -> Result<(u64, Vec<u8>, Reservation), SessionError> {
        let (stop, _guard) = self.common.pool.deadline();
        let held = self.common.pool.reserve(task.bytes() + shown.bytes(task.rows())).await?;
        let (contact, sequence, state) = self.copy(id, said, &stop).await?;
        let cost = task.cost(contact.profile(), contact.memory_depth()).saturating_add(shown.format.cost());
        let work = move || {
            let _state = state;
            let outcome = otlp::part!("solve").in_scope(|| task.run(contact, sequence, &stop))?;
            Ok::<_, SessionError>(shown.write(&outcome)?)
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }

    /// The stresses below the surface that a request asks for, checked against the definition of the session.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], a request that does not fit the definition, or a
    /// failure of the store.
    pub async fn subsurface_task(&self, id: Uuid, request: SubsurfaceRequest) -> Result<SubsurfaceTask, SessionError> {
        let mut guard = self.lock(id).await?;
        Ok(request.of_contact(&self.current(&mut guard).await?.session.definition)?)
    }

    /// A copy of the contact, which `said` to have this definition, with its sequence and memory for it; `stop` counts
    /// what loading it takes. The lock is held for the copy alone, so that the session can move on meanwhile.
    pub(super) async fn copy(
        &self,
        id: Uuid,
        said: Option<ContactDefinition>,
        stop: &Stop,
    ) -> Result<(Contact, u64, Reservation), SessionError> {
        let mut guard = self.lock(id).await?;
        let live = self.current(&mut guard).await?;
        if said.is_some_and(|said| said != *live.session.definition) {
            return Err(SessionError::OtherDefinition(id));
        }
        let (contact, sequence) = (live.contact.memory_bytes(), live.session.sequence);
        let mut held = self.reserve_copy(&mut guard, contact).await?;
        held.shrink(contact);
        stop.count(guard.loading);
        let live = guard.live.as_ref().ok_or(SessionError::NotFound(id))?;
        Ok((live.contact.clone(), sequence, held))
    }

    /// Memory for a copy of the state in a guard: that of a state which was brought from the store has it already, so
    /// that nobody waits for memory while he holds some.
    pub(super) async fn reserve_copy(&self, guard: &mut Guard, bytes: usize) -> Result<Reservation, SessionError> {
        if guard.held.is_counted() {
            return Ok(std::mem::take(&mut guard.held));
        }
        Ok(self.common.pool.reserve_states(bytes).await?)
    }

    /// A page of sessions, oldest first; of those alone whose label contains `label`.
    ///
    /// # Errors
    /// A failure of the store.
    pub async fn list(
        &self,
        label: Option<String>,
        after: Option<Uuid>,
        limit: usize,
    ) -> Result<SessionPage, SessionError> {
        // One more than requested shows whether there is a next page.
        let mut found = self.common.store.list(Some(self.tenant.clone()), label, after, limit + 1).await?;
        let more = found.len() > limit;
        found.truncate(limit);
        let next = found.last().filter(|_| more).map(|session| session.id);
        Ok(SessionPage { items: found, next })
    }

    /// The number of moves of a session.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn sequence(&self, id: Uuid) -> Result<u64, SessionError> {
        if !self.common.cache.holds(&self.tenant, id) {
            return Ok(self.find_own(id).await?.sequence);
        }
        let heading = self.common.store.heading(id).await;
        heading.map(|heading| heading.sequence).map_err(|error| self.store_error(id, error))
    }

    /// Checks that the first `end` moves of a session are all stored.
    ///
    /// # Errors
    /// [`SessionError::Store`] with [`StoreError::Damaged`](crate::store::StoreError::Damaged) if they are not, or a
    /// failure of the store.
    pub async fn check_complete(&self, id: Uuid, end: u64) -> Result<(), SessionError> {
        let store = &self.common.store;
        if store.count_moves(id, end).await.map_err(|error| self.store_error(id, error))? == end {
            return Ok(());
        }
        // Which one is missing is found by reading them.
        let mut at = 0;
        while at < end {
            let page = store.history(id, at, PAGE).await.map_err(|error| self.store_error(id, error))?;
            let Some(last) = page.last() else { break };
            at = last.sequence;
        }
        Err(damaged(id, &format_args!("of its {end} moves some are missing")))
    }

    /// A page of a session's moves, oldest first.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<HistoryPage, SessionError> {
        if !self.common.cache.holds(&self.tenant, id) {
            self.find_own(id).await?;
        }
        self.history_page(id, after, limit).await
    }

    /// The same of a session that is known to belong to the tenant.
    pub(super) async fn history_page(&self, id: Uuid, after: u64, limit: usize) -> Result<HistoryPage, SessionError> {
        let found = self.common.store.history(id, after, limit + 1).instrument(otlp::part!("store")).await;
        let mut found = found.map_err(|error| self.store_error(id, error))?;
        let more = found.len() > limit;
        found.truncate(limit);
        let next = found.last().filter(|_| more).map(|record| record.sequence);
        let items = found.into_iter().map(|record| HistoryItem {
            sequence: record.sequence,
            step: record.step,
            state: record.state,
            cycle: None,
            observation: record.observation(),
            by: record.by.filter(|_| self.names_makers()).as_deref().map(str::to_owned),
            at: record.at,
        });
        Ok(HistoryPage { items: items.collect(), next })
    }
}
