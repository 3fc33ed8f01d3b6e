//! Living contacts: one writer for each, a cache of states, and a replay of the moves if a state is not cached.
//!
//! Moves of one session queue at its lock in the order of their arrival, and those that wait together are made together
//! (`group`); sessions do not wait for each other. A move is computed, appended to the store, and only then visible: a
//! read shows a state that is stored. A client that hangs up while its move is computed leaves no trace; one that hangs
//! up later has its move stored or not, as a client that loses its connection must expect. What follows from a stored
//! change, in the cache and in the quotas, is done without the client (`run_to_end`).
//!
//! Other processes may work on the same store. A cached state is always one that the session has been in, so that
//! the moves stored after it lead to the current one: a read applies them first, and a move whose sequence another
//! process has taken applies them and tries again. The store also says what has been deleted or has expired, whatever
//! is cached.
//!
//! A handle works for one tenant ([`Sessions::for_tenant`]) and does not see what belongs to others: their states and
//! locks have other keys, and the tenant of what comes from the store is checked before it is used.

mod apply;
mod attempt;
mod cache;
mod changes;
mod check;
mod cycles;
mod error;
mod events;
mod expected;
mod expiry;
mod group;
mod history;
mod loaded;
mod metrics;
mod observations;
mod replay;
mod replay_cost;
mod run_to_end;
mod snapshot;
mod storage_reservation;
mod trace;

use std::sync::Arc;

use uuid::Uuid;

use crate::admission::{Deadline, Pool, Reservation, STREAMS};
use crate::otlp;
use crate::store::{Listeners, Page, Store, Tenant};
use stickslip_compute::computations::{OnContact, Shown};
use stickslip_compute::formats;
use stickslip_compute::simulation::{ProfileCache, ProfileKey, Profiles, bytes, cost};
use stickslip_mechanics::Profile;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{ContactDefinition, SessionPage, SessionReply, SubsurfaceRequest};

pub use apply::{Mover, bytes_of_moves};
pub use cache::CAPACITY;
use cache::Cache;
pub use changes::Changes;
pub use check::{CheckEvent, Checked, Finding, check, count_moves};
pub use cycles::ClosedCycles;
pub use error::SessionError;
pub use events::events;
pub use expected::{Expected, label_checksum};
pub use expiry::run_expiry_loop;
pub use history::History;
pub use metrics::{Readings, SessionMetrics};
pub use observations::Observations;
use replay::Replay;
use snapshot::Snapshots;
use storage_reservation::UsageByTenant;
pub use trace::{bytes_of_trace, trace};

/// How often a change is tried if other processes move the contact first. Each time, one of them has made progress.
const ATTEMPTS: usize = 100;

/// The sessions of a tenant. Clones, and those of other tenants, are handles on the same.
#[derive(Clone)]
pub struct Sessions {
    replay: Replay,
    /// The name of the key that the requests come with, where keys are in use.
    by: Option<Arc<str>>,
}

struct Common {
    store: Arc<dyn Store>,
    pool: Pool,
    cache: Arc<Cache>,
    snapshots: Snapshots,
    listeners: Listeners,
    metrics: SessionMetrics,
    usage: UsageByTenant,
}

impl Common {
    fn profiles(self: &Arc<Common>, stop: &Deadline) -> Profiles<Deadline> {
        Profiles::new(self.clone(), stop.clone(), self.pool.capacity().deadline)
    }
}

/// The profiles that requests share are kept in the cache of the states, within one bound.
impl ProfileCache for Common {
    fn holds(&self, key: &ProfileKey) -> bool {
        self.cache.profile(key).is_some()
    }

    fn get(&self, key: &ProfileKey) -> Option<Arc<Profile>> {
        self.cache.profile(key).inspect(|_| self.metrics.profiles_shared.inc())
    }

    fn keep(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile> {
        self.metrics.profiles_prepared.inc();
        self.cache.keep_profile(key, profile, bytes)
    }
}

impl Sessions {
    /// Sessions in a store, of the tenant without a name. At most `capacity` bytes of states are cached; the rest is
    /// replayed when needed.
    #[must_use]
    pub fn new(store: Arc<dyn Store>, pool: Pool, capacity: usize) -> Sessions {
        let metrics = SessionMetrics::default();
        let common = Common {
            snapshots: Snapshots::new(Arc::clone(&store), pool.clone()),
            cache: Arc::new(Cache::new(capacity, metrics.hits.clone())),
            store,
            pool,
            listeners: Listeners::new(STREAMS),
            metrics,
            usage: UsageByTenant::default(),
        };
        Sessions { replay: Replay { tenant: Tenant::default(), common: Arc::new(common) }, by: None }
    }

    /// The sessions of another tenant, for requests that come with the key of this name.
    #[must_use]
    pub fn for_tenant(&self, tenant: Tenant, key: Arc<str>) -> Sessions {
        Sessions { replay: Replay { tenant, common: Arc::clone(&self.replay.common) }, by: Some(key) }
    }

    /// Making, copying, naming and deleting them.
    #[must_use]
    pub fn changes(&self) -> Changes {
        Changes { replay: self.replay.clone() }
    }

    /// Their moves to come.
    #[must_use]
    pub fn moves(&self) -> Mover {
        Mover { replay: self.replay.clone(), by: self.by.clone() }
    }

    /// Their moves of the past.
    #[must_use]
    pub fn history(&self) -> History {
        History { replay: self.replay.clone(), names_makers: self.names_makers() }
    }

    /// The cycles that they have closed.
    #[must_use]
    pub fn cycles(&self) -> ClosedCycles {
        ClosedCycles { replay: self.replay.clone() }
    }

    /// What a bench has measured beside their moves.
    #[must_use]
    pub fn observations(&self) -> Observations {
        Observations::of(&self.replay)
    }

    /// The shared profiles, for work that ends when this flag is raised.
    #[must_use]
    pub fn profiles(&self, stop: &Deadline) -> Profiles<Deadline> {
        self.replay.common.profiles(stop)
    }

    /// Ends all events, present and future: the process is about to stop.
    pub fn end_events(&self) {
        self.replay.common.listeners.end();
    }

    /// Whether requests come with keys, by whose names the history says who made a move.
    #[must_use]
    pub fn names_makers(&self) -> bool {
        self.by.is_some()
    }

    /// Whether the store can serve.
    ///
    /// # Errors
    /// [`SessionError::Store`] if it cannot.
    pub async fn ready(&self) -> Result<(), SessionError> {
        Ok(self.replay.common.store.ready().await?)
    }

    /// Bytes of the cached states, and how many sessions they are.
    #[must_use]
    pub fn held(&self) -> (usize, usize) {
        self.replay.common.cache.held()
    }

    /// A session with its state.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn get(&self, id: Uuid) -> Result<SessionReply, SessionError> {
        let mut guard = self.replay.lock(id).await?;
        Ok(self.replay.current(&mut guard).await?.reply())
    }

    /// The definition of a session as it was sent, as JSON, and the memory that it takes.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn definition(&self, id: Uuid) -> Result<(Vec<u8>, Reservation), SessionError> {
        let definition = {
            let mut guard = self.replay.lock(id).await?;
            // It does not depend on the state, which is not loaded for it.
            match &guard.live {
                Some(live) if !live.is_behind => Arc::clone(&self.replay.current(&mut guard).await?.session.definition),
                _ => self.replay.find_own(id).await?.definition,
            }
        };
        let points = definition.profile.points();
        let held = self.replay.common.pool.reserve(bytes::of_definition(points)).await?;
        let work = move || written(&*definition);
        Ok((self.replay.common.pool.run(cost::writing_table(points), work).await??, held))
    }

    /// The reply of a computation on a session, which `said` to have this definition, with the sequence that it belongs
    /// to. The memory of the request becomes what that takes.
    ///
    /// # Errors
    /// [`SessionError`], among them [`SessionError::OtherDefinition`].
    pub async fn compute_on<T: OnContact>(
        &self,
        id: Uuid,
        said: Option<ContactDefinition>,
        task: T,
        shown: Shown,
        memory: &mut Reservation,
    ) -> Result<(u64, Vec<u8>), SessionError> {
        let (stop, _guard) = self.replay.common.pool.deadline();
        self.replay.common.pool.resize(memory, task.bytes() + shown.bytes(task.rows())).await?;
        let (contact, sequence, state) = self.replay.copy(id, said, &stop).await?;
        let cost = task.cost(contact.profile(), contact.memory_depth()).saturating_add(shown.format.cost());
        let work = move || {
            let _state = state;
            let outcome = otlp::part!("solve").in_scope(|| task.run(contact, sequence, &stop))?;
            Ok::<_, SessionError>(otlp::part!("write").in_scope(|| shown.write(&outcome, &stop))??)
        };
        Ok((sequence, self.replay.common.pool.run(cost, work).await??))
    }

    /// The stresses below the surface that a request asks for, checked against the definition of the session.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], a request that does not fit the definition, or a
    /// failure of the store.
    pub async fn subsurface_task(&self, id: Uuid, request: SubsurfaceRequest) -> Result<SubsurfaceTask, SessionError> {
        let mut guard = self.replay.lock(id).await?;
        Ok(request.of_contact(&self.replay.current(&mut guard).await?.session.definition)?)
    }

    /// A page of sessions; of those alone whose label contains `label`.
    ///
    /// # Errors
    /// A failure of the store, or of the pool if the store does not find it in time.
    pub async fn list(&self, label: Option<String>, page: Page) -> Result<SessionPage, SessionError> {
        let limit = page.limit;
        // One more than requested shows whether there is a next page.
        let page = Page { limit: limit + 1, ..page };
        let common = &self.replay.common;
        let mut found = common.pool.wait(common.store.list(Some(self.replay.tenant.clone()), label, page)).await??;
        let more = found.len() > limit;
        found.truncate(limit);
        let next = found.last().filter(|_| more).map(|session| session.id);
        Ok(SessionPage { items: found, next })
    }

    /// The metrics of the sessions.
    #[must_use]
    pub fn readings(&self) -> Readings<'_> {
        let (bytes, cached) = self.replay.common.cache.held();
        Readings {
            counted: &self.replay.common.metrics,
            cached,
            bytes,
            capacity: self.replay.common.cache.capacity(),
            streams: self.replay.common.listeners.count(),
            commits: self.replay.common.store.commits(),
        }
    }
}

/// Bytes that suffice for most replies, so that a buffer need not grow step by step.
const REPLY: usize = 768;

fn written(reply: &impl serde::Serialize) -> Result<Vec<u8>, SessionError> {
    Ok(otlp::part!("write").in_scope(|| formats::json(REPLY, reply))?)
}
