//! Memory for bodies, work and replies, by classes, so that its sum is bounded.
//!
//! What takes no more than [`FREE`] is bounded by the number of requests, and waits for nothing. Beyond that a request
//! takes one place of a [`Class`], before it does the work, and keeps it until the last byte of its reply has been
//! read. No client has more than half of a class: whatever one client asks for, and however slowly it reads, others
//! find a place.
//!
//! # Why requests never wait for each other in a circle
//!
//! A request goes from a class to a larger one and never waits for a smaller one. What else requests wait for comes in
//! one order, and nobody waits for what comes before something that it holds:
//!
//! 1. the bytes of a body that is arriving, which are taken once, and its class;
//! 2. the permit of a request;
//! 3. the class of its work;
//! 4. the lock of a contact;
//! 5. memory for states that are loaded or copied ([`Pool::reserve_states`]);
//! 6. a thread of the solver, the store, or the client that reads a reply, each of which has a time limit.
//!
//! So the request that holds what comes last goes on, and then the one before it. Memory that a request can do without
//! is not waited for at all ([`Pool::try_reserve`]).

use std::collections::HashMap;
use std::pin::pin;
use std::sync::Arc;

use parking_lot::Mutex;
use tokio::sync::{Notify, OwnedSemaphorePermit};

use super::{Capacity, Client, Permits, Pool, PoolError};

/// Bytes of the largest requests at a time by default.
pub const BYTES: usize = 512 * 1024 * 1024;
/// Bytes that one request takes at most, whatever it asks for: measured, with a margin.
pub const LARGEST: usize = 256 * 1024 * 1024;
/// Bytes of the largest body, and of a request of the smaller class.
pub const LARGEST_BODY: usize = 16 * 1024 * 1024;
/// Bytes of a request that the number of requests bounds.
pub const FREE: usize = 1024 * 1024;
/// Bytes of a body that the number of connections bounds.
pub const UNCOUNTED: usize = 16 * 1024;
/// Bytes that an encoder takes until its reply is sent: zstd at its fastest has a window of 512 KiB, held twice, and
/// tables.
pub const ENCODER: usize = 2 * 1024 * 1024;

/// The divisor of the bytes of work that gives those of the states that work loads and copies, which come on top.
pub const STATES_SHARE: usize = 4;
/// The divisor that gives those of bodies up to [`FREE`] that are arriving.
pub const ARRIVING_SHARE: usize = 4;
/// The divisor that gives those of encoders.
pub const ENCODERS_SHARE: usize = 8;

/// Bytes are counted in units of this size.
const UNIT: usize = 1024;

/// What a request that takes more than [`FREE`] has one place of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Up to [`LARGEST_BODY`].
    Medium,
    /// Up to [`LARGEST`].
    Large,
}

impl Class {
    /// The class of so many bytes, if they need one.
    pub fn of(bytes: usize) -> Option<Class> {
        (bytes > FREE).then_some(if bytes <= LARGEST_BODY { Class::Medium } else { Class::Large })
    }

    /// Bytes of a place.
    pub const fn bytes(self) -> usize {
        match self {
            Class::Medium => LARGEST_BODY,
            Class::Large => LARGEST,
        }
    }
}

impl Capacity {
    /// Places of a class: those of the larger have all bytes of work, those of the smaller half as many beside them.
    pub fn places(&self, class: Class) -> usize {
        match class {
            Class::Medium => (self.bytes / 2 / LARGEST_BODY).max(1),
            Class::Large => (self.bytes / LARGEST).max(1),
        }
    }

    /// Places of a class that one client may have.
    pub fn places_of_client(&self, class: Class) -> usize {
        (self.places(class) / 2).max(1)
    }

    /// Bytes of bodies, work and replies at most.
    pub fn reservable_bytes(&self) -> usize {
        let classes = [Class::Medium, Class::Large].map(|class| self.places(class).saturating_mul(class.bytes()));
        let beside = [self.bytes / ARRIVING_SHARE, self.bytes / ENCODERS_SHARE, self.requests.saturating_mul(FREE)];
        classes.into_iter().chain(beside).fold(0, usize::saturating_add)
    }

    /// Bytes of the states that work loads and copies at a time.
    pub fn state_bytes(&self) -> usize {
        (self.bytes / STATES_SHARE).min(u32::MAX as usize)
    }
}

/// The memory of a pool.
#[derive(Debug)]
pub(super) struct Memory {
    classes: [Arc<Places>; 2],
    arriving: Permits,
    states: Permits,
    encoders: Permits,
}

impl Memory {
    pub(super) fn new(capacity: &Capacity) -> Memory {
        let classes = [Class::Medium, Class::Large].map(|class| {
            let (all, per_client) = (capacity.places(class), capacity.places_of_client(class));
            Arc::new(Places { class, all, per_client, taken: Mutex::default(), freed: Notify::new() })
        });
        Memory {
            classes,
            arriving: Permits::new(capacity.bytes / ARRIVING_SHARE / UNIT),
            states: Permits::new(capacity.state_bytes() / UNIT),
            encoders: Permits::new(capacity.bytes / ENCODERS_SHARE / ENCODER),
        }
    }

    fn places(&self, class: Class) -> &Arc<Places> {
        &self.classes[class as usize]
    }

    /// Bytes of the places that are taken.
    pub(super) fn taken(&self) -> usize {
        self.classes.iter().map(|places| places.taken.lock().values().sum::<usize>() * places.class.bytes()).sum()
    }
}

/// The places of a class.
#[derive(Debug)]
struct Places {
    class: Class,
    all: usize,
    per_client: usize,
    // By their clients. Locked for a moment, and never across an await.
    taken: Mutex<HashMap<Client, usize>>,
    freed: Notify,
}

/// A place of a class, until dropped.
#[derive(Debug)]
struct Place {
    places: Arc<Places>,
    client: Client,
}

impl Places {
    fn try_take(self: &Arc<Places>, client: &Client) -> Option<Place> {
        let mut taken = self.taken.lock();
        let mine = taken.get(client).copied().unwrap_or(0);
        if mine >= self.per_client || taken.values().sum::<usize>() >= self.all {
            return None;
        }
        taken.insert(client.clone(), mine + 1);
        Some(Place { places: Arc::clone(self), client: client.clone() })
    }

    async fn take(self: &Arc<Places>, client: &Client) -> Place {
        loop {
            let mut freed = pin!(self.freed.notified());
            // From here on nothing that is freed is missed.
            freed.as_mut().enable();
            if let Some(place) = self.try_take(client) {
                return place;
            }
            freed.await;
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut taken = self.places.taken.lock();
        if let Some(mine) = taken.get_mut(&self.client) {
            *mine -= 1;
            if *mine == 0 {
                taken.remove(&self.client);
            }
        }
        drop(taken);
        self.places.freed.notify_waiters();
    }
}

/// The memory of a request or of a piece of work. Clones share it; it is free when the last is dropped.
#[derive(Clone, Debug, Default)]
pub struct Reservation(Option<Arc<Mutex<Reserved>>>);

#[derive(Debug, Default)]
struct Reserved {
    /// Bytes that were asked for.
    bytes: usize,
    place: Option<Place>,
    /// Of those that are counted one by one.
    units: Option<OwnedSemaphorePermit>,
}

impl Reservation {
    /// One of nothing yet, whose clones will share what it becomes.
    pub fn empty() -> Reservation {
        Reservation(Some(Arc::default()))
    }

    fn of_units(units: OwnedSemaphorePermit) -> Reservation {
        let bytes = units.num_permits() * UNIT;
        Reservation(Some(Arc::new(Mutex::new(Reserved { bytes, place: None, units: Some(units) }))))
    }

    /// Bytes that were asked for.
    pub fn bytes(&self) -> usize {
        self.0.as_ref().map_or(0, |reserved| reserved.lock().bytes)
    }

    /// The class of its place, if it has one.
    pub fn class(&self) -> Option<Class> {
        self.0.as_ref().and_then(|reserved| reserved.lock().place.as_ref().map(|place| place.places.class))
    }

    /// Whether it is large enough to be counted.
    pub fn is_counted(&self) -> bool {
        self.0.as_ref().is_some_and(|reserved| {
            let reserved = reserved.lock();
            reserved.place.is_some() || reserved.units.is_some()
        })
    }

    /// Gives back all but this many of the bytes that are counted one by one.
    pub fn shrink(&self, bytes: usize) {
        let Some(reserved) = &self.0 else { return };
        let mut reserved = reserved.lock();
        if let Some(units) = &mut reserved.units {
            drop(units.split(units.num_permits().saturating_sub(bytes.div_ceil(UNIT))));
        }
        reserved.bytes = reserved.bytes.min(bytes);
    }

    /// Holds what another one holds, in place of what it had: to take a second place beside the first would have
    /// requests wait for each other.
    pub fn take_over(&mut self, other: &Reservation) {
        let mut held = other.0.as_ref().map(|other| std::mem::take(&mut *other.lock())).unwrap_or_default();
        // What it had is given back after the lock.
        std::mem::swap(&mut *self.0.get_or_insert_default().lock(), &mut held);
    }

    fn set(&mut self, bytes: usize, place: Option<Place>) {
        let mut reserved = self.0.get_or_insert_default().lock();
        reserved.bytes = bytes;
        // The place that it had is given back after the lock.
        let _had = std::mem::replace(&mut reserved.place, place);
        drop(reserved);
    }
}

impl Pool {
    /// Reserves bytes, but at most [`LARGEST`], for the client that this task serves.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve(&self, bytes: usize) -> Result<Reservation, PoolError> {
        let mut reservation = Reservation::default();
        self.resize(&mut reservation, bytes).await?;
        Ok(reservation)
    }

    /// Grows or shrinks a reservation. The request may hold no lock of a contact when it grows. If no smaller place is
    /// free at once, it keeps the one that it has.
    ///
    /// # Errors
    /// As [`Pool::wait`]; the reservation is unchanged then.
    pub async fn resize(&self, reservation: &mut Reservation, bytes: usize) -> Result<(), PoolError> {
        self.resize_for(&Client::current(), reservation, bytes).await
    }

    /// The same for a client.
    ///
    /// # Errors
    /// As [`Pool::resize`].
    pub async fn resize_for(
        &self,
        client: &Client,
        reservation: &mut Reservation,
        bytes: usize,
    ) -> Result<(), PoolError> {
        let (had, wanted) = (reservation.class(), Class::of(bytes));
        if had == wanted {
            if bytes > 0 || reservation.0.is_some() {
                reservation.0.get_or_insert_default().lock().bytes = bytes;
            }
            return Ok(());
        }
        let Some(class) = wanted else {
            reservation.set(bytes, None);
            return Ok(());
        };
        let places = self.memory().places(class);
        match places.try_take(client) {
            Some(place) => reservation.set(bytes, Some(place)),
            None if had > wanted => {}
            // In a box, so that a request that need not wait is not as large as one that does.
            None => reservation.set(bytes, Some(Box::pin(self.wait(places.take(client))).await?)),
        }
        Ok(())
    }

    /// Reserves bytes for a body of up to [`FREE`] that is arriving. They are taken once.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve_arriving(&self, bytes: usize) -> Result<Reservation, PoolError> {
        let arriving = &self.memory().arriving;
        self.permits(arriving, bytes.min(FREE).div_ceil(UNIT).min(arriving.all)).await.map(Reservation::of_units)
    }

    /// Reserves bytes for all the states that a piece of work loads or copies, but at most all that there are for
    /// states. Nothing else may be waited for until they are released, except a thread and the store.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve_states(&self, bytes: usize) -> Result<Reservation, PoolError> {
        if bytes <= UNCOUNTED {
            return Ok(Reservation::default());
        }
        let states = &self.memory().states;
        self.permits(states, bytes.div_ceil(UNIT).min(states.all)).await.map(Reservation::of_units)
    }

    /// Reserves bytes if they are free now.
    #[must_use]
    pub fn try_reserve(&self, bytes: usize) -> Option<Reservation> {
        let mut reservation = Reservation::empty();
        let place = Class::of(bytes).map(|class| self.memory().places(class).try_take(&Client::current()));
        reservation.set(bytes, place.map_or(Some(None), |taken| taken.map(Some))?);
        Some(reservation)
    }

    /// The memory of an encoder of a reply, if it is free now.
    pub fn try_reserve_encoder(&self) -> Option<Reservation> {
        self.memory().encoders.try_take(1).map(Reservation::of_units)
    }
}
