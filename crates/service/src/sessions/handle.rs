//! The handle on the sessions of a tenant, and what it reads of them. The other files of this folder add the moves, the
//! changes, the history, the cycles and the observations.

use std::ops::Deref;

use crate::admission::Pool;
use crate::store::{Commits, Page};
use stickslip_compute::computations::{ContactTask, DisplayOptions};
use stickslip_compute::simulation::{bytes, cost};
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{ContactDefinition, SessionPage, SessionReply, SubsurfaceRequest};

use super::prelude::*;
use super::published::Published;

/// The sessions of a tenant. Clones, and those of other tenants, are handles on the same.
#[derive(Clone)]
pub struct Sessions {
    pub(super) tenant: Tenant,
    pub(super) common: Arc<Common>,
    /// The name of the key that the requests come with, where keys are in use.
    pub(super) by: Option<Arc<str>>,
}

impl Deref for Sessions {
    type Target = Common;

    fn deref(&self) -> &Common {
        &self.common
    }
}

impl Sessions {
    /// Sessions in a store, of the tenant without a name. At most `capacity` bytes of states are cached; the rest is
    /// replayed when needed.
    pub fn new(store: Arc<dyn Store>, pool: Pool, capacity: usize) -> Sessions {
        let common = Arc::new(Common::new(store, pool, capacity));
        Sessions { tenant: Tenant::default(), common, by: None }
    }

    /// The sessions of another tenant, for requests that come with the key of this name.
    pub fn for_tenant(&self, tenant: Tenant, key: Arc<str>) -> Sessions {
        Sessions { tenant, common: Arc::clone(&self.common), by: Some(key) }
    }

    /// Ends all events, present and future: the process is about to stop.
    pub fn end_events(&self) {
        self.listeners.end();
    }

    /// Whether requests come with keys, by whose names the history says who made a move.
    pub fn names_makers(&self) -> bool {
        self.by.is_some()
    }

    /// Whether the store can serve.
    ///
    /// # Errors
    /// [`SessionError::Store`] if it cannot.
    pub async fn ready(&self) -> Result<(), SessionError> {
        Ok(self.store.ready().await?)
    }

    /// Bytes of the cached states, and how many sessions they are.
    pub fn held(&self) -> (usize, usize) {
        self.entries.held()
    }

    /// A session with its state.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn get(&self, id: Uuid) -> Result<SessionReply, SessionError> {
        if let Some(shown) = self.shown(id, Published::reply).await? {
            return Ok(shown);
        }
        let mut guard = self.lock(id).await?;
        Ok(self.current(&mut guard).await?.reply())
    }

    /// The definition of a session as it was sent, as JSON, and the memory that it takes.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn definition(&self, id: Uuid) -> Result<(Vec<u8>, Reservation), SessionError> {
        // It does not depend on the state, which is not loaded for it.
        let definition = match self.shown(id, |shown| Arc::clone(&shown.session.definition)).await? {
            Some(shown) => shown,
            None => self.find_own(id).await?.definition,
        };
        let points = definition.profile.points();
        let held = self.pool.reserve(bytes::of_definition(points)).await?;
        let work = move || written(&*definition);
        Ok((self.pool.run(cost::writing_table(points), work).await??, held))
    }

    /// The reply of a computation on a session, which is `expected` to have this definition, with the sequence that it
    /// belongs to. The memory of the request becomes what that takes.
    ///
    /// # Errors
    /// [`SessionError`], among them [`SessionError::OtherDefinition`].
    pub async fn compute_on(
        &self,
        id: Uuid,
        expected: Option<ContactDefinition>,
        task: Box<dyn ContactTask>,
        shown: DisplayOptions,
        memory: &mut Reservation,
    ) -> Result<(u64, Vec<u8>), SessionError> {
        let (stop, _guard) = self.pool.deadline();
        self.pool.resize(memory, task.bytes(&shown)).await?;
        let (contact, sequence, state) = self.copy(id, expected, &stop).await?;
        let cost = task.cost(contact.profile(), contact.memory_depth(), &shown);
        let work = move || {
            let _state = state;
            let outcome = otlp::part!("solve").in_scope(|| task.run(contact, sequence, &stop))?;
            Ok::<_, SessionError>(otlp::part!("write").in_scope(|| outcome.write(&shown, &stop))??)
        };
        Ok((sequence, self.pool.run(cost, work).await??))
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

    /// A page of sessions; of those alone whose label contains `label`.
    ///
    /// # Errors
    /// A failure of the store, or of the pool if the store does not find it in time.
    pub async fn list(&self, label: Option<String>, page: Page) -> Result<SessionPage, SessionError> {
        let limit = page.limit;
        // One more than requested shows whether there is a next page.
        let page = Page { limit: limit + 1, ..page };
        let listed = self.store.list(Some(self.tenant.clone()), label, page);
        let mut found = self.pool.wait(listed).await??;
        let more = found.len() > limit;
        found.truncate(limit);
        let next = found.last().filter(|_| more).map(|session| session.id);
        Ok(SessionPage { items: found, next })
    }

    /// How many bytes of states may be cached.
    pub fn capacity(&self) -> usize {
        self.entries.capacity()
    }

    /// How many clients listen to events.
    pub fn streams(&self) -> usize {
        self.listeners.count()
    }

    /// Bytes of the log of the store, if it has one.
    pub fn log_bytes(&self) -> Option<u64> {
        self.store.log_bytes()
    }

    /// What the store has committed.
    pub fn commits(&self) -> &Commits {
        self.store.commits()
    }
}
