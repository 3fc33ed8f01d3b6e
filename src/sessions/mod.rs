//! A contact that lives: one writer a session, a cache of states, and the past replayed where the cache has none.
//!
//! Moves of one session queue at its lock in the order of their arrival; sessions do not wait for each other. A move is
//! computed, appended to the store, and only then visible: whoever reads a state reads one that is stored. From the
//! moment a move begins it no longer depends on the client: it runs in a task of its own, to its end, unless the client
//! hangs up while it is still being computed, when it ends without a trace.

mod advance;
mod cache;
mod current;
mod idempotency;
mod read;

use std::sync::Arc;

use jiff::Timestamp;
use tokio::sync::OwnedMutexGuard;
use uuid::Uuid;

use crate::mechanics::{Contact, Setup};
use crate::simulation::{self, Pool, PoolError, Seen, cost, warnings};
use crate::store::{Reply, RequestKey, Session, Store, StoreError};
use crate::wire::session::Creation;
use crate::wire::{At, ContactDefinition, Faults, Figures, NewSession, Warning};

pub use cache::CAPACITY;
use cache::{Cache, Slot};

/// Moves that are fetched from the store at a time for a replay.
const REPLAY_PAGE: usize = 10_000;

/// How often a change is computed anew when other processes get in before it.
const ATTEMPTS: usize = 16;

/// Why a session did not do what it was asked for. Nothing has changed then.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// There is no such session.
    #[error("there is no contact {0}")]
    NotFound(Uuid),
    /// There was such a session, and it has expired.
    #[error("the contact {0} has expired")]
    Expired(Uuid),
    /// The sequence is not the one that the client expects.
    #[error("the contact is at sequence {found}, not at {expected}")]
    Stale {
        /// What the client expects.
        expected: u64,
        /// What it is.
        found: u64,
    },
    /// Another process has moved the session on.
    #[error("the contact has moved on to sequence {found} meanwhile")]
    Overtaken {
        /// What its sequence is.
        found: u64,
    },
    /// The mechanics has no answer, or nobody waits for it.
    #[error(transparent)]
    Failure(#[from] simulation::Failure),
    /// The idempotency key belongs to another request.
    #[error("the idempotency key has been used for another request")]
    KeyReused,
    /// No solver is free, or one failed.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The storage failed.
    #[error(transparent)]
    Store(StoreError),
    /// What is stored cannot be replayed, or a reply not be written: a fault of this program.
    #[error("{0}")]
    Broken(String),
}

/// All sessions. Clones are handles on the same.
#[derive(Clone)]
pub struct Sessions {
    store: Arc<dyn Store>,
    pool: Pool,
    cache: Arc<Cache>,
}

/// A session in the cache.
#[derive(Clone)]
struct Live {
    session: Session,
    about: Arc<About>,
    contact: Contact,
}

/// What follows from the definition and never changes.
struct About {
    figures: Figures,
    warnings: Vec<Warning>,
}

/// The lock of a session, held.
type Guard = OwnedMutexGuard<Option<Live>>;

impl Sessions {
    /// Sessions in a store. At most about `capacity` of their states are kept at hand; the rest is replayed when needed.
    #[must_use]
    pub fn new(store: Arc<dyn Store>, pool: Pool, capacity: usize) -> Sessions {
        Sessions { store, pool, cache: Arc::new(Cache::new(capacity)) }
    }

    /// Whether the store can serve.
    ///
    /// # Errors
    /// [`SessionError::Store`] if it cannot.
    pub async fn ready(&self) -> Result<(), SessionError> {
        self.store.ready().await.map_err(SessionError::Store)
    }

    /// Makes a session.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn create(&self, creation: Creation, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        if let Some(reply) = self.earlier(key.as_ref()).await? {
            return Ok(reply);
        }
        let (contact, about) = start(&creation.definition, creation.setup)?;
        let now = Timestamp::now();
        let live = Live {
            session: Session {
                id: Uuid::now_v7(),
                label: creation.label,
                definition: Arc::new(creation.definition),
                sequence: 0,
                created_at: now,
                updated_at: now,
            },
            about,
            contact,
        };
        let reply = live.introduce()?;
        let stored = self.store.create(live.session.clone(), idempotency::receipt(key.clone(), &reply)).await;
        match stored {
            Ok(()) => self.cache.insert(live),
            Err(error) => return self.lost(error, key).await,
        }
        Ok(reply)
    }

    /// Makes a session with the same past.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has been made then.
    pub async fn fork(&self, id: Uuid, label: Option<String>, key: Option<RequestKey>) -> Result<Reply, SessionError> {
        if let Some(reply) = self.earlier(key.as_ref()).await? {
            return Ok(reply);
        }
        let mut guard = self.lock(id).await;
        let mut found = 0;
        for _ in 0..ATTEMPTS {
            let mut copy = self.current(id, &mut guard).await?.clone();
            let now = Timestamp::now();
            copy.session = Session {
                id: Uuid::now_v7(),
                label: label.clone().or(copy.session.label),
                created_at: now,
                updated_at: now,
                ..copy.session
            };
            let reply = copy.introduce()?;
            let stored = self.store.fork(id, copy.session.clone(), idempotency::receipt(key.clone(), &reply)).await;
            match stored {
                Ok(()) => {
                    self.cache.insert(copy);
                    return Ok(reply);
                }
                Err(StoreError::Stale { found: sequence }) => found = sequence,
                Err(error @ (StoreError::NotFound | StoreError::Expired)) => return Err(self.failed(id, error)),
                Err(error) => return self.lost(error, key).await,
            }
        }
        Err(SessionError::Overtaken { found })
    }

    /// Deletes a session, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; it is still there then.
    pub async fn delete(&self, id: Uuid, expected: Option<u64>) -> Result<(), SessionError> {
        let mut guard = self.lock(id).await;
        let mut found = 0;
        for _ in 0..ATTEMPTS {
            found = match guard.as_ref() {
                Some(live) if !self.store.is_shared() => live.session.sequence,
                _ => self.store.sequence(id).await.map_err(|error| self.failed(id, error))?,
            };
            agree(expected, found)?;
            // Emptied first: if this call is abandoned half-way, the next one asks the store what is true.
            *guard = None;
            match self.store.delete(id, found).await {
                Ok(()) => {
                    self.cache.forget(id);
                    return Ok(());
                }
                Err(StoreError::Stale { .. }) => {}
                Err(error) => return Err(self.failed(id, error)),
            }
        }
        Err(SessionError::Overtaken { found })
    }

    /// Waits for the lock of a session.
    async fn lock(&self, id: Uuid) -> Guard {
        let slot: Slot = self.cache.slot(id);
        slot.lock_owned().await
    }

    /// The session behind a lock, replayed from the store if the cache does not have it.
    async fn present<'a>(&self, id: Uuid, guard: &'a mut Guard) -> Result<&'a mut Live, SessionError> {
        if guard.is_none() {
            **guard = Some(self.replay(id).await?);
        }
        guard.as_mut().ok_or(SessionError::NotFound(id))
    }

    /// The state of a stored session, from its definition and all its moves.
    async fn replay(&self, id: Uuid) -> Result<Live, SessionError> {
        let session = self.store.find(id).await.map_err(|error| self.failed(id, error))?;
        let mut faults = Faults::default();
        let setup = session.definition.check(At::Root, &mut faults);
        let setup = faults.done(setup).map_err(|error| broken(id, &error))?;
        let (contact, about) = start(&session.definition, setup).map_err(|error| broken(id, &error))?;
        let to = session.sequence;
        let begin = Session { sequence: 0, ..session };
        let live = self.follow(Live { session: begin, about, contact }, to).await?;
        Ok(Live { session: Session { updated_at: session.updated_at, ..live.session }, ..live })
    }

    /// Takes a state on to a later sequence, by the moves that are stored.
    async fn follow(&self, mut live: Live, to: u64) -> Result<Live, SessionError> {
        let id = live.session.id;
        while live.session.sequence < to {
            let after = live.session.sequence;
            let mut page = self.store.history(id, after, REPLAY_PAGE).await.map_err(|error| self.failed(id, error))?;
            page.retain(|record| record.sequence <= to);
            let Some(last) = page.last() else {
                return Err(broken(id, &format_args!("moves are missing after {after}")));
            };
            (live.session.sequence, live.session.updated_at) = (last.sequence, last.at);
            let curved = page.iter().filter(|record| record.step.is_curved()).count();
            let cost = cost::estimated_cost(page.len(), curved, 0, 0, false);
            let mut contact = live.contact;
            let replayed = self.pool.run(cost, move || {
                let mut steps = page.iter().map(|record| (record.step.step(), record.tolerance));
                steps.try_for_each(|(step, tolerance)| contact.apply_within(&step, tolerance)).map(|()| contact)
            });
            live.contact = replayed.await?.map_err(|error| broken(id, &error))?;
        }
        Ok(live)
    }

    /// What a failure of the store means for a client. Where the session is gone, the cache forgets it too.
    fn failed(&self, id: Uuid, error: StoreError) -> SessionError {
        match error {
            StoreError::NotFound => {
                self.cache.forget(id);
                SessionError::NotFound(id)
            }
            StoreError::Expired => {
                self.cache.forget(id);
                SessionError::Expired(id)
            }
            other => SessionError::Store(other),
        }
    }
}

impl Live {
    /// The reply that presents a session just made.
    fn introduce(&self) -> Result<Reply, SessionError> {
        let Session { id, label, sequence, .. } = &self.session;
        let new = NewSession {
            id: *id,
            label: label.clone(),
            sequence: *sequence,
            contact: self.about.figures.clone(),
            state: self.contact.state().into(),
            warnings: self.about.warnings.clone(),
        };
        Ok(Reply { created: Some(*id), sequence: *sequence, body: written(&new)? })
    }
}

/// A contact at its preload, and what follows from its definition.
fn start(definition: &ContactDefinition, setup: Setup) -> Result<(Contact, Arc<About>), simulation::Failure> {
    let elasticity = setup.elasticity;
    let contact = simulation::contact(setup, "")?;
    let figures: Figures = contact.initial_figures().into();
    let Figures { contact_radius, e_star, indentation, .. } = figures;
    let noise = contact.profile().noise(contact_radius);
    let seen = Seen { contact_radius, e_star, indentation, noise, missed: None };
    let warnings = warnings(&definition.profile, &elasticity, &seen);
    Ok((contact, Arc::new(About { figures, warnings })))
}

fn broken(id: Uuid, error: &dyn std::fmt::Display) -> SessionError {
    SessionError::Broken(format!("contact {id} cannot be replayed: {error}"))
}

/// Holds the sequence against the one that the client expects, if it expects one.
fn agree(expected: Option<u64>, found: u64) -> Result<(), SessionError> {
    match expected {
        Some(expected) if expected != found => Err(SessionError::Stale { expected, found }),
        _ => Ok(()),
    }
}

fn written(reply: &impl serde::Serialize) -> Result<Vec<u8>, SessionError> {
    serde_json::to_vec(reply).map_err(|error| SessionError::Broken(format!("a reply cannot be written: {error}")))
}
