//! Memory for bodies, work and replies: reserved before it is used, so that its sum is bounded.
//!
//! A request has one reservation, which is resized as its needs become known. Most of the memory is ordinary: shared
//! by all. Beside it each [`Stage`] has a reserve, which belongs to one request at a time: that one has the turn.
//!
//! # Why requests never wait for each other in a circle
//!
//! Whoever waits for memory waits for the turn too, in the order of arrival, and takes what comes first. The request
//! that has the turn finds in the reserve all that its stage may still ask for, so that it never waits for memory. What
//! else requests wait for comes in one order, and nobody waits for what comes before something that it holds:
//!
//! 1. the turn of a body, while its client sends the rest, which has a time limit;
//! 2. the permit of a request;
//! 3. the turn of work;
//! 4. the lock of a contact;
//! 5. memory for states that are loaded or copied ([`Pool::reserve_states`]);
//! 6. a thread of the solver, the store, or the client that reads a reply, each of which has a time limit.
//!
//! So the request that holds what comes last goes on, and then the one before it. Memory that a request can do without
//! is not waited for at all ([`Pool::try_reserve`]).
//!
//! Small needs have a share of their own, so that they do not wait behind large ones.

use std::sync::Arc;

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::{Capacity, Permits, Pool, PoolError};

/// Bytes of bodies, work and replies at a time by default.
pub const BYTES: usize = 512 * 1024 * 1024;
/// Bytes that one request takes at most, whatever it asks for: measured, with a margin.
pub const LARGEST: usize = 256 * 1024 * 1024;
/// Bytes of the largest body.
pub const LARGEST_BODY: usize = 16 * 1024 * 1024;
/// Reservations up to this are not counted: the number of requests bounds them.
pub const UNCOUNTED: usize = 16 * 1024;

/// The divisor of the bytes of work that gives those of the states that work loads and copies, which come on top.
pub const STATES_SHARE: usize = 4;

/// The divisor of the bytes of work that gives those beside them for small reservations, so that these do not wait
/// behind large ones, which have to wait for much.
pub const SMALL_SHARE: usize = 8;
/// The most bytes of a small reservation.
pub const SMALL: usize = 1024 * 1024;

/// Bytes are counted in units of this size.
pub(super) const UNIT: usize = 1024;

/// What a request needs memory for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Its body, while that arrives.
    Body,
    /// All that comes then.
    Work,
}

impl Capacity {
    /// Bytes of the reserve of a stage: as many as one request takes there at most.
    pub fn reserve_bytes(&self, stage: Stage) -> usize {
        let largest = match stage {
            Stage::Body => LARGEST_BODY,
            Stage::Work => LARGEST,
        };
        largest.min(self.bytes)
    }

    /// Bytes of bodies, work and replies at most: the ordinary ones, the reserves, and those for small needs.
    pub fn reservable_bytes(&self) -> usize {
        let reserves = self.reserve_bytes(Stage::Body) + self.reserve_bytes(Stage::Work);
        self.bytes.saturating_add(reserves).saturating_add(self.small_bytes())
    }

    /// Bytes of the states that work loads and copies at a time.
    pub fn state_bytes(&self) -> usize {
        (self.bytes / STATES_SHARE).min(u32::MAX as usize)
    }

    /// Bytes beside those of the work for small reservations, when the others are taken.
    pub fn small_bytes(&self) -> usize {
        (self.bytes / SMALL_SHARE).min(u32::MAX as usize)
    }
}

/// The memory of a pool.
#[derive(Debug)]
pub(super) struct Memory {
    ordinary: Permits,
    small: Permits,
    states: Permits,
    /// By their stages.
    reserves: [Reserve; 2],
}

/// The reserve of a stage.
#[derive(Debug)]
struct Reserve {
    /// One permit.
    turn: Arc<Semaphore>,
    /// Taken by whoever has the turn.
    units: Permits,
}

impl Memory {
    pub(super) fn new(capacity: Capacity) -> Memory {
        let reserves = [Stage::Body, Stage::Work].map(|stage| Reserve {
            turn: Arc::new(Semaphore::new(1)),
            units: Permits::new(capacity.reserve_bytes(stage) / UNIT),
        });
        let [ordinary, small, states] =
            [capacity.bytes, capacity.small_bytes(), capacity.state_bytes()].map(|bytes| Permits::new(bytes / UNIT));
        Memory { ordinary, small, states, reserves }
    }

    /// Bytes that are reserved, without those of states.
    pub(super) fn taken(&self) -> usize {
        let reserves = self.reserves.iter().map(|reserve| reserve.units.taken()).sum::<usize>();
        UNIT * (self.ordinary.taken() + self.small.taken() + reserves)
    }
}

/// Reserved bytes, held until dropped; none if they are too few to be counted.
#[derive(Debug, Default)]
pub struct Reservation {
    /// Ordinary ones, or those of states.
    shared: Option<OwnedSemaphorePermit>,
    /// Of those for small reservations.
    small: Option<OwnedSemaphorePermit>,
    turn: Option<Turn>,
}

/// The turn of a stage.
#[derive(Debug)]
struct Turn {
    stage: Stage,
    /// Of its reserve. Dropped before the turn: the next one finds all of it.
    units: Option<OwnedSemaphorePermit>,
    _turn: OwnedSemaphorePermit,
}

impl Reservation {
    fn of_shared(permit: OwnedSemaphorePermit) -> Reservation {
        Reservation { shared: Some(permit), ..Reservation::default() }
    }

    /// Adds one that was not waited for.
    pub fn add(&mut self, other: Reservation) {
        merge(&mut self.shared, other.shared);
        merge(&mut self.small, other.small);
        self.turn = other.turn.or(self.turn.take());
    }

    /// Gives back all but this many bytes, those of a reserve first.
    pub fn shrink(&mut self, bytes: usize) {
        let mut kept = bytes.div_ceil(UNIT);
        let reserved = self.turn.as_mut().map(|turn| &mut turn.units);
        for permit in [&mut self.shared, &mut self.small].into_iter().chain(reserved) {
            if let Some(permit) = permit {
                drop(permit.split(permit.num_permits().saturating_sub(kept)));
            }
            kept = kept.saturating_sub(held(permit));
        }
        self.turn.take_if(|turn| held(&turn.units) == 0);
    }

    /// Whether it is large enough to be counted.
    pub fn is_counted(&self) -> bool {
        self.bytes() > 0
    }

    /// Bytes that are counted.
    pub fn bytes(&self) -> usize {
        UNIT * (self.lasting_units() + self.turn.as_ref().map_or(0, |turn| held(&turn.units)))
    }

    /// Units that are not of a reserve.
    fn lasting_units(&self) -> usize {
        held(&self.shared) + held(&self.small)
    }

    /// Units that it has in a stage: those of the reserve of another are to be given back.
    fn units(&self, stage: Stage) -> usize {
        let turn = self.turn.as_ref().filter(|turn| turn.stage == stage);
        self.lasting_units() + turn.map_or(0, |turn| held(&turn.units))
    }
}

fn held(permit: &Option<OwnedSemaphorePermit>) -> usize {
    permit.as_ref().map_or(0, OwnedSemaphorePermit::num_permits)
}

fn merge(permit: &mut Option<OwnedSemaphorePermit>, more: Option<OwnedSemaphorePermit>) {
    match (permit.as_mut(), more) {
        (Some(permit), Some(more)) => permit.merge(more),
        (None, more) => *permit = more,
        (Some(_), None) => {}
    }
}

impl Pool {
    /// Reserves bytes, but at most [`LARGEST`] and all that there are, for a request that has no reservation yet.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve(&self, bytes: usize) -> Result<Reservation, PoolError> {
        let mut reservation = Reservation::default();
        self.resize(&mut reservation, bytes).await?;
        Ok(reservation)
    }

    /// The same for work in the background, which may take long and leaves the reserve to requests.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve_in_background(&self, bytes: usize) -> Result<Reservation, PoolError> {
        let memory = self.memory();
        let units = bytes.div_ceil(UNIT).min(memory.reserves[Stage::Work as usize].units.all);
        self.permits(&memory.ordinary, units).await.map(Reservation::of_shared)
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
        self.permits(states, bytes.div_ceil(UNIT).min(states.all)).await.map(Reservation::of_shared)
    }

    /// Reserves bytes if they are free now.
    #[must_use]
    pub fn try_reserve(&self, bytes: usize) -> Option<Reservation> {
        self.memory().ordinary.try_take(bytes.div_ceil(UNIT)).map(Reservation::of_shared)
    }

    /// Grows or shrinks the reservation of a request. It may hold no lock of a contact when it grows.
    ///
    /// # Errors
    /// As [`Pool::wait`]; the reservation is unchanged then.
    pub async fn resize(&self, reservation: &mut Reservation, bytes: usize) -> Result<(), PoolError> {
        self.resize_in(Stage::Work, reservation, bytes).await
    }

    /// The same for a body that is still arriving.
    ///
    /// # Errors
    /// As [`Pool::resize`].
    pub async fn resize_in(&self, stage: Stage, reservation: &mut Reservation, bytes: usize) -> Result<(), PoolError> {
        if bytes <= UNCOUNTED {
            *reservation = Reservation::default();
            return Ok(());
        }
        let memory = self.memory();
        let reserve = &memory.reserves[stage as usize];
        let wanted = bytes.div_ceil(UNIT).min(reserve.units.all);
        let Some(more) = wanted.checked_sub(reservation.units(stage)).filter(|more| *more > 0) else {
            reservation.shrink(wanted * UNIT);
            // Others wait for the turn: it is given up as soon as it can be done without.
            if let Some(turn) = &reservation.turn
                && let Some(ordinary) = memory.ordinary.try_take(held(&turn.units))
            {
                reservation.turn = None;
                reservation.add(Reservation::of_shared(ordinary));
            }
            return Ok(());
        };
        // Nobody else takes of the reserve, and nobody has more than there is.
        let of_reserve = || reserve.units.try_take(more).map(Some).ok_or(PoolError::Busy);
        if let Some(turn) = reservation.turn.as_mut().filter(|turn| turn.stage == stage) {
            merge(&mut turn.units, of_reserve()?);
            return Ok(());
        }
        let got = if let Some(permit) = memory.ordinary.try_take(more) {
            Reservation::of_shared(permit)
        } else {
            let is_small = wanted <= self.capacity().small_bytes().min(SMALL) / UNIT;
            let shared = if is_small { &memory.small } else { &memory.ordinary };
            let fits = is_small || more <= memory.ordinary.all;
            // In a box, so that a request that need not wait is not as large as one that does.
            Box::pin(self.wait(async {
                tokio::select! {
                    biased;
                    permit = Arc::clone(&shared.free).acquire_many_owned(more as u32), if fits => {
                        let (small, shared) = if is_small { (permit.ok(), None) } else { (None, permit.ok()) };
                        Ok(Reservation { shared, small, turn: None })
                    }
                    turn = Arc::clone(&reserve.turn).acquire_owned() => {
                        let turn = turn.map_err(|_| PoolError::Busy)?;
                        let turn = Turn { stage, units: of_reserve()?, _turn: turn };
                        Ok(Reservation { turn: Some(turn), ..Reservation::default() })
                    }
                }
            }))
            .await??
        };
        reservation.turn = None;
        reservation.add(got);
        Ok(())
    }
}
