//! The time by which a store judges how old something is. What is too old is deleted, so that this time never jumps
//! ahead: it goes on by the clock of the system as long as that is not faster than time passes.

use std::time::{Duration, Instant};

use jiff::Timestamp;

/// A clock that never jumps ahead.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    start: Timestamp,
    started: Instant,
}

impl Clock {
    /// A clock that shows this time now.
    pub fn starting_at(start: Timestamp) -> Clock {
        Clock { start, started: Instant::now() }
    }

    /// The time that a clock which may jump shows, but no more than has passed since the start.
    pub fn bounded(&self, shown: Timestamp) -> Timestamp {
        shown.min(self.start.checked_add(self.started.elapsed()).unwrap_or(Timestamp::MAX))
    }

    /// The time now.
    pub fn now(&self) -> Timestamp {
        self.bounded(Timestamp::now())
    }

    /// The time so long ago.
    pub fn ago(&self, time: Duration) -> Timestamp {
        self.now().checked_sub(time).unwrap_or(Timestamp::MIN)
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;
    use jiff::{SignedDuration, Timestamp};

    #[test]
    fn a_jump_ahead_is_not_followed_and_a_jump_back_is() {
        let year = SignedDuration::from_hours(24 * 365);
        let (now, clock) = (Timestamp::now(), Clock::starting_at(Timestamp::now()));
        assert!(clock.bounded(now + year) < now + SignedDuration::from_mins(10));
        assert_eq!(clock.bounded(now - year), now - year);
        // A clock that is wrong at the start is not believed either: the last write tells the time.
        let written = now - year;
        assert!(Clock::starting_at(written).now() < written + SignedDuration::from_mins(10));
    }
}
