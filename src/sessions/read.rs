//! Reading sessions. A read changes nothing, and waits at most for the move under way.

use std::sync::Arc;

use tracing::Instrument as _;
use uuid::Uuid;

use crate::admission::{Nanoseconds, Reservation};
use crate::otlp;
use crate::simulation::cost::{self, Work};
use crate::simulation::{self, Timer, bytes, stresses};
use stickslip_mechanics::Contact;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{
    CycleReply, HistoryItem, HistoryPage, Sampling, SessionPage, SessionReply, StressReply, SubsurfaceReply,
    SubsurfaceRequest,
};

use super::cache::Guard;
use super::loaded::table_points;
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
        let points = table_points(&definition.profile);
        let held = self.common.pool.reserve(points * bytes::WRITTEN_POINT_BYTES).await?;
        let work = move || written(&*definition);
        Ok((self.common.pool.run(cost::writing_table(points), work).await??, held))
    }

    /// The reply that `write` makes of the stresses of a session, with the sequence and the reserved memory. Writing
    /// takes at most `more` bytes beyond JSON's columns, and `longer` time.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn stress<T: Send + 'static>(
        &self,
        id: Uuid,
        sampling: Sampling,
        residual: bool,
        (more, longer): (usize, Nanoseconds),
        write: impl FnOnce(&StressReply, &Contact, u64) -> T + Send + 'static,
    ) -> Result<(u64, T, Reservation), SessionError> {
        let (stop, _guard) = self.common.pool.deadline();
        let held = self.common.pool.reserve(bytes::of_stress(sampling.length()) + more).await?;
        let (contact, sequence, state) = self.copy(id).await?;
        let looking = Work { depth: contact.memory_depth(), radii: sampling.length(), residual, ..Work::default() };
        let cost = looking.cost(contact.profile()).saturating_add(longer);
        let work = move || {
            let _state = state;
            let solving = otlp::part!("solve").entered();
            let stress = stresses(&contact, &sampling, &stop)?;
            let reply = StressReply {
                radius: stress.radius,
                pressure: stress.pressure,
                shear: stress.shear,
                slip: stress.slip,
                displacement: stress.displacement,
                residual: residual.then(|| simulation::residual(&contact, &stop)).transpose()?,
            };
            drop(solving);
            Ok::<_, SessionError>(write(&reply, &contact, sequence))
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }

    /// The reply that `write` makes of the steady cycles of a session at its present load, as [`Sessions::stress`].
    ///
    /// # Errors
    /// As [`Sessions::stress`], and a force of μ F_N or more.
    pub async fn cycle<T: Send + 'static>(
        &self,
        id: Uuid,
        task: CycleTask,
        (more, longer): (usize, Nanoseconds),
        write: impl FnOnce(&CycleReply, &Contact, &CycleTask) -> T + Send + 'static,
    ) -> Result<(u64, T, Reservation), SessionError> {
        let (stop, _guard) = self.common.pool.deadline();
        let held = self.common.pool.reserve(bytes::of_cycle(&task) + more).await?;
        let (contact, sequence, state) = self.copy(id).await?;
        let cost = cost::of_cycle(contact.profile(), &task).saturating_add(longer);
        let work = move || {
            let _state = state;
            let contact = contact.without_history();
            let solve = || simulation::cycle(&contact, &task, Timer::start(), &stop);
            let reply = otlp::part!("solve").in_scope(solve)?;
            Ok::<_, SessionError>(write(&reply, &contact, &task))
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }

    /// The reply that `write` makes of the stress below the surface of a session, as [`Sessions::stress`]; for each place it takes
    /// `more` bytes.
    ///
    /// # Errors
    /// As [`Sessions::stress`], and a request that does not fit the definition.
    pub async fn subsurface<T: Send + 'static>(
        &self,
        id: Uuid,
        request: SubsurfaceRequest,
        (more, longer): (impl Fn(usize) -> usize, Nanoseconds),
        write: impl FnOnce(&SubsurfaceReply, &SubsurfaceTask) -> T + Send + 'static,
    ) -> Result<(u64, T, Reservation), SessionError> {
        let (stop, _guard) = self.common.pool.deadline();
        let task = {
            let mut guard = self.lock(id).await?;
            request.of_contact(&self.current(&mut guard).await?.session.definition)?
        };
        let held = self.common.pool.reserve(bytes::of_subsurface(&task) + more(task.places.count())).await?;
        let (contact, sequence, state) = self.copy(id).await?;
        let cost = cost::of_subsurface(contact.profile(), &task, contact.memory_depth()).saturating_add(longer);
        let work = move || {
            let _state = state;
            let solve = || simulation::subsurface_reply(&contact, &task, &stop);
            let reply = otlp::part!("solve").in_scope(solve)?;
            Ok::<_, SessionError>(write(&reply, &task))
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }

    /// A copy of the contact with its sequence, and memory for it. The lock is held for the copy alone, so that the session can
    /// move on meanwhile.
    async fn copy(&self, id: Uuid) -> Result<(Contact, u64, Reservation), SessionError> {
        let mut guard = self.lock(id).await?;
        let live = self.current(&mut guard).await?;
        let (contact, sequence) = (live.contact.memory_bytes(), live.session.sequence);
        let mut held = self.reserve_copy(&mut guard, contact).await?;
        held.shrink(contact);
        let live = guard.live.as_ref().ok_or(SessionError::NotFound(id))?;
        Ok((live.contact.clone(), sequence, held))
    }

    /// Memory for a copy of the state in a guard: that of a state which was brought from the store has it already, so that
    /// nobody waits for memory while he holds some.
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
