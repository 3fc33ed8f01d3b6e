//! Clients that listen to events: a bounded number of them, which all end when the process stops.

use std::sync::Arc;
use std::time::Duration;

use stickslip_wire::EndReason;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};

/// How long a listener waits at most before it reads again.
const PAUSE: Duration = Duration::from_secs(1);

/// What a listener receives.
#[derive(Clone, Debug, PartialEq)]
pub enum StreamEvent<T> {
    /// The state, now that it has changed.
    State(T),
    /// The last event.
    End(EndReason),
}

/// The listeners of a kind.
pub struct Listeners {
    places: Arc<Semaphore>,
    limit: usize,
    ending: watch::Sender<bool>,
}

/// A listener to what is watched of one contact or job.
pub struct Listener<T = ()> {
    changed: watch::Receiver<T>,
    ending: watch::Receiver<bool>,
    // Frees the place when the listener is dropped.
    _place: OwnedSemaphorePermit,
}

impl Listeners {
    /// At most `limit` listeners at a time.
    pub fn new(limit: usize) -> Listeners {
        Listeners { places: Arc::new(Semaphore::new(limit)), limit, ending: watch::Sender::new(false) }
    }

    /// How many listen.
    pub fn count(&self) -> usize {
        self.limit - self.places.available_permits()
    }

    /// A place for another listener; none if there are as many as there may be.
    #[must_use]
    pub fn place(&self) -> Option<OwnedSemaphorePermit> {
        Arc::clone(&self.places).try_acquire_owned().ok()
    }

    /// Listens in a place.
    pub fn listen<T>(&self, place: OwnedSemaphorePermit, changed: watch::Receiver<T>) -> Listener<T> {
        Listener { changed, ending: self.ending(), _place: place }
    }

    /// Becomes true when the process is about to stop.
    pub fn ending(&self) -> watch::Receiver<bool> {
        self.ending.subscribe()
    }

    /// Ends all listeners, present and future.
    pub fn end(&self) {
        self.ending.send_replace(true);
    }
}

impl<T> Listener<T> {
    /// What is watched now. Later changes wake the listener.
    pub fn newest(&mut self) -> watch::Ref<'_, T> {
        self.changed.borrow_and_update()
    }

    /// Whether the process is about to stop.
    pub fn is_ending(&self) -> bool {
        *self.ending.borrow()
    }

    /// Waits until something may have changed.
    pub async fn wait(&mut self) {
        let woken = tokio::select! {
            changed = self.changed.changed() => changed.is_ok(),
            _ = self.ending.wait_for(|ending| *ending) => true,
        };
        if !woken {
            self.pause(PAUSE).await;
        }
    }

    /// Waits for a time, or until the process is about to stop.
    pub async fn pause(&mut self, time: Duration) {
        tokio::select! {
            () = tokio::time::sleep(time) => {}
            _ = self.ending.wait_for(|ending| *ending) => {}
        }
    }
}
