//! Memory for bodies, work and replies: reserved before it is used, so that its sum is bounded.
//!
//! Large needs wait in a line. Small ones have a share beside it, so that they do not wait behind the large ones.

use std::sync::Arc;

use tokio::sync::OwnedSemaphorePermit;

use super::{Capacity, Pool, PoolError};

/// Bytes of bodies, work and replies at a time by default.
pub const BYTES: usize = 512 * 1024 * 1024;
/// Bytes that one request takes at most, whatever it asks for: measured, with a margin.
pub const LARGEST: usize = 256 * 1024 * 1024;
/// Reservations up to this are not counted: the number of requests bounds them.
pub const UNCOUNTED: usize = 16 * 1024;

/// The divisor of the bytes of work that gives those of the states that work loads and copies, which come on top. A
/// request that holds memory for its body waits for memory for a state; one that holds memory for a state waits for
/// none, so that requests never wait for each other in a circle.
pub const STATES_SHARE: usize = 4;

/// The divisor of the bytes of work that gives those beside them for small reservations, so that these do not wait
/// behind large ones, which have to wait for much.
pub const SMALL_SHARE: usize = 8;
/// The most bytes of a small reservation.
pub const SMALL: usize = 1024 * 1024;

/// Bytes are counted in units of this size.
pub(super) const UNIT: usize = 1024;

impl Capacity {
    /// Bytes of the states that work loads and copies at a time.
    #[must_use]
    pub fn state_bytes(&self) -> usize {
        (self.bytes / STATES_SHARE).min(u32::MAX as usize)
    }

    /// Bytes beside those of the work for small reservations, when the others are taken.
    #[must_use]
    pub fn small_bytes(&self) -> usize {
        (self.bytes / SMALL_SHARE).min(u32::MAX as usize)
    }
}

/// Reserved bytes, held until dropped; none if they are too few to be counted.
#[derive(Debug, Default)]
pub struct Reservation {
    work: Option<OwnedSemaphorePermit>,
    /// Of those for small reservations.
    small: Option<OwnedSemaphorePermit>,
}

impl Reservation {
    fn of_work(permit: OwnedSemaphorePermit) -> Reservation {
        Reservation { work: Some(permit), small: None }
    }

    /// This and another one, as one.
    #[must_use]
    pub fn with(self, other: Reservation) -> Reservation {
        let both = |one: Option<OwnedSemaphorePermit>, other: Option<OwnedSemaphorePermit>| match (one, other) {
            (Some(mut permit), Some(more)) => {
                permit.merge(more);
                Some(permit)
            }
            (one, other) => one.or(other),
        };
        Reservation { work: both(self.work, other.work), small: both(self.small, other.small) }
    }

    /// Gives back all but this many bytes.
    pub fn shrink(&mut self, bytes: usize) {
        let kept = bytes.div_ceil(UNIT);
        let keep = |permit: &mut Option<OwnedSemaphorePermit>, kept: usize| {
            if let Some(permit) = permit {
                drop(permit.split(permit.num_permits().saturating_sub(kept)));
            }
        };
        keep(&mut self.small, kept.saturating_sub(held(&self.work)));
        keep(&mut self.work, kept);
    }

    /// Whether it is large enough to be counted.
    #[must_use]
    pub fn is_counted(&self) -> bool {
        self.units() > 0
    }

    fn units(&self) -> usize {
        held(&self.work) + held(&self.small)
    }
}

fn held(permit: &Option<OwnedSemaphorePermit>) -> usize {
    permit.as_ref().map_or(0, OwnedSemaphorePermit::num_permits)
}

impl Pool {
    /// Reserves bytes, but at most [`LARGEST`] and all that there are.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve(&self, bytes: usize) -> Result<Reservation, PoolError> {
        let mut reservation = Reservation::default();
        self.resize(&mut reservation, bytes).await?;
        Ok(reservation)
    }

    /// Reserves bytes for all the states that a piece of work loads or copies, but at most all that there are for
    /// states. Nothing else may be waited for until they are released, except a thread.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn reserve_states(&self, bytes: usize) -> Result<Reservation, PoolError> {
        if bytes <= UNCOUNTED {
            return Ok(Reservation::default());
        }
        let wanted = bytes.div_ceil(UNIT).min((self.0.capacity.state_bytes() / UNIT).max(1));
        self.permits(&self.0.states, wanted as u32).await.map(Reservation::of_work)
    }

    /// Reserves bytes if they are free now.
    #[must_use]
    pub fn try_reserve(&self, bytes: usize) -> Option<Reservation> {
        let units = u32::try_from(bytes.div_ceil(UNIT)).ok()?;
        Arc::clone(&self.0.units).try_acquire_many_owned(units).ok().map(Reservation::of_work)
    }

    /// Grows or shrinks a reservation. A small one never waits behind a large one.
    ///
    /// # Errors
    /// As [`Pool::wait`]; the reservation is unchanged then.
    pub async fn resize(&self, reservation: &mut Reservation, bytes: usize) -> Result<(), PoolError> {
        if bytes <= UNCOUNTED {
            *reservation = Reservation::default();
            return Ok(());
        }
        let most = (self.0.capacity.bytes.min(LARGEST) / UNIT).clamp(1, u32::MAX as usize);
        let wanted = bytes.div_ceil(UNIT).min(most);
        let Some(more) = wanted.checked_sub(reservation.units()).filter(|more| *more > 0) else {
            reservation.shrink(wanted * UNIT);
            return Ok(());
        };
        let small = wanted <= self.0.capacity.small_bytes().min(SMALL) / UNIT;
        let more = match Arc::clone(&self.0.units).try_acquire_many_owned(more as u32) {
            Ok(permit) => Reservation::of_work(permit),
            Err(_) if small => Reservation { work: None, small: Some(self.permits(&self.0.small, more as u32).await?) },
            Err(_) => Reservation::of_work(self.permits(&self.0.units, more as u32).await?),
        };
        *reservation = std::mem::take(reservation).with(more);
        Ok(())
    }
}
