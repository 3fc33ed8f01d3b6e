//! Turns on the solver threads: who works next, and when long work gives way.
//!
//! Work is in a lane: that of its client and its kind. While somebody waits, each lane is charged for the time that its work has
//! held a thread, divided by the weight of its kind, and the lane that has been charged least is next; within it, the work that came
//! first. So lanes share the threads by weight, whatever they ask for, and no lane starves (start-time fair queueing: Goyal, Vin
//! and Cheng 1996). Work that has held a thread for a slice gives way at its next check of a [`Stop`](super::Stop), if another
//! lane is next, and waits on its own thread of the blocking pool. A thread whose work has not checked for [`OVERDUE`] does not
//! count for interactive work, which then shares the processors with it.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::oneshot;
use tokio::time::timeout;

use super::Client;

/// How long work holds a thread while others wait for one.
pub const SLICE: Duration = Duration::from_millis(5);
/// How long interactive work waits at most for a check of others.
pub const OVERDUE: Duration = Duration::from_millis(50);
/// Work that holds a thread for longer in all, or is estimated to, is long.
pub const INTERACTIVE: Duration = Duration::from_secs(1);

/// What work is for, from the most urgent on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Somebody waits for it, and it is short.
    Interactive,
    /// Somebody waits for it.
    Long,
    /// Nobody waits for it. It never holds the last thread if there are several.
    Job,
}

impl Kind {
    /// The share of a lane of this kind.
    const fn weight(self) -> u64 {
        match self {
            Kind::Interactive => 64,
            Kind::Long => 8,
            Kind::Job => 1,
        }
    }
}

type Lane = (Client, Kind);

/// The turns on a number of threads. Clones share it.
#[derive(Clone, Debug)]
pub struct Turnstile(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    threads: usize,
    // How many wait, for a look without the lock.
    waiting: AtomicUsize,
    // A std mutex: held for a moment, and never across an await.
    lanes: Mutex<Lanes>,
}

#[derive(Debug, Default)]
struct Lanes {
    /// Since when each turn is taken, by the number of its work.
    taken: HashMap<u64, Instant>,
    /// How many of them are jobs'.
    jobs: usize,
    /// Numbers the work by its arrival.
    arrivals: u64,
    /// What an idle lane is taken to have been charged: as much as the least charged of the others.
    clock: u64,
    /// Since when somebody has been waiting without a break.
    contended: Option<Instant>,
    all: HashMap<Lane, Queue>,
}

/// The work of a lane.
#[derive(Debug, Default)]
struct Queue {
    /// Weighted nanoseconds.
    charged: u64,
    running: usize,
    waiting: BTreeMap<u64, oneshot::Sender<Turn>>,
}

/// Work in the queue of a lane.
struct Waiter {
    lane: Lane,
    arrival: u64,
    turn: oneshot::Receiver<Turn>,
}

/// Takes the work out of its queue when dropped. A turn that it was given meanwhile is dropped with the receiver.
struct Leaving<'a> {
    turnstile: &'a Turnstile,
    waiter: Waiter,
}

/// A thread for a piece of work, until dropped.
#[derive(Debug)]
pub struct Turn(Option<Held>);

#[derive(Debug)]
struct Held {
    turnstile: Turnstile,
    lane: Lane,
    arrival: u64,
    since: Instant,
    /// How long it has worked before.
    worked: Duration,
}

thread_local! {
    /// The turn of the work on this thread.
    static TURN: RefCell<Turn> = const { RefCell::new(Turn(None)) };
}

/// Lets others work if they are next, and then waits; returns how long. To be called by work at each of its checks.
pub(super) fn give_way() -> Duration {
    TURN.with_borrow_mut(|turn| turn.0.as_mut().map_or(Duration::ZERO, Held::give_way))
}

impl Turn {
    /// A turn on a thread that nobody else waits for.
    #[must_use]
    pub fn alone() -> Turn {
        Turn(None)
    }

    /// Does the work within the turn, which ends with it.
    pub fn work<T>(self, work: impl FnOnce() -> T) -> T {
        /// Ends the turn, after a panic too.
        struct End;
        impl Drop for End {
            fn drop(&mut self) {
                drop(TURN.replace(Turn(None)));
            }
        }
        drop(TURN.replace(self));
        let _end = End;
        work()
    }
}

impl Turnstile {
    /// At least one thread.
    pub(super) fn new(threads: usize) -> Turnstile {
        Turnstile(Arc::new(Shared { threads: threads.max(1), waiting: AtomicUsize::new(0), lanes: Mutex::default() }))
    }

    /// Turns that are taken.
    pub(super) fn taken(&self) -> usize {
        self.lanes().taken.len()
    }

    /// A turn for a piece of work; it is lost to others if the future is dropped.
    pub(super) async fn turn(&self, client: Client, kind: Kind) -> Turn {
        let waiter = {
            let mut lanes = self.lanes();
            let arrival = lanes.arrivals;
            lanes.arrivals += 1;
            self.queue((client, kind), arrival, &mut lanes)
        };
        let mut leaving = Leaving { turnstile: self, waiter };
        loop {
            match timeout(OVERDUE, &mut leaving.waiter.turn).await {
                // The sender is kept until it is used.
                Ok(turn) => return turn.unwrap_or(Turn(None)),
                Err(_) => self.admit(&mut self.lanes()),
            }
        }
    }

    /// Another turn for the same work, if nobody waits for it.
    pub(super) fn another(&self, client: &Client, kind: Kind) -> Option<Turn> {
        let mut lanes = self.lanes();
        if self.0.waiting.load(Ordering::Relaxed) > 0 || !self.has_room(&lanes, kind) {
            return None;
        }
        let arrival = lanes.arrivals;
        lanes.arrivals += 1;
        Some(self.begin((client.clone(), kind), arrival, &mut lanes))
    }

    fn lanes(&self) -> MutexGuard<'_, Lanes> {
        self.0.lanes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a thread is free for work of this kind.
    fn has_room(&self, lanes: &Lanes, kind: Kind) -> bool {
        let (threads, taken) = (self.0.threads, lanes.taken.len());
        match kind {
            Kind::Interactive => taken < threads || taken < threads + lanes.overdue().min(threads),
            Kind::Long => taken < threads,
            Kind::Job => taken < threads && lanes.jobs < threads.saturating_sub(1).max(1),
        }
    }

    fn queue(&self, lane: Lane, arrival: u64, lanes: &mut Lanes) -> Waiter {
        let (sender, turn) = oneshot::channel();
        let clock = lanes.clock();
        let queue = lanes.all.entry(lane.clone()).or_default();
        if !queue.is_busy() {
            queue.charged = queue.charged.max(clock);
        }
        queue.waiting.insert(arrival, sender);
        if self.0.waiting.fetch_add(1, Ordering::Relaxed) == 0 {
            lanes.contended = Some(Instant::now());
        }
        self.admit(lanes);
        Waiter { lane, arrival, turn }
    }

    /// Gives free threads to those who are next.
    fn admit(&self, lanes: &mut Lanes) {
        while let Some(lane) = self.next(lanes) {
            let Some((arrival, sender)) = lanes.all.get_mut(&lane).and_then(|queue| queue.waiting.pop_first()) else {
                return;
            };
            self.0.waiting.fetch_sub(1, Ordering::Relaxed);
            let mut turn = self.begin(lane, arrival, lanes);
            // Who left while it was his turn passes it on.
            if let Err(unused) = sender.send(turn) {
                turn = unused;
                if let Some(held) = turn.0.take() {
                    lanes.end(&held);
                }
            }
        }
        if self.0.waiting.load(Ordering::Relaxed) == 0 {
            lanes.contended = None;
        }
        // An idle lane that has been charged no more than a new one need not be remembered.
        let clock = lanes.clock();
        lanes.all.retain(|_, queue| queue.is_busy() || queue.charged > clock);
    }

    fn begin(&self, lane: Lane, arrival: u64, lanes: &mut Lanes) -> Turn {
        let since = Instant::now();
        lanes.taken.insert(arrival, since);
        lanes.jobs += usize::from(lane.1 == Kind::Job);
        lanes.all.entry(lane.clone()).or_default().running += 1;
        let turnstile = self.clone();
        Turn(Some(Held { turnstile, lane, arrival, since, worked: Duration::ZERO }))
    }

    /// The lane whose work is next, if there is a thread for it.
    fn next(&self, lanes: &Lanes) -> Option<Lane> {
        let waiting =
            lanes.all.iter().filter(|((_, kind), queue)| !queue.waiting.is_empty() && self.has_room(lanes, *kind));
        let next = waiting.min_by_key(|((_, kind), queue)| {
            (queue.charged, *kind, queue.waiting.first_key_value().map(|(arrival, _)| *arrival))
        });
        next.map(|(lane, _)| lane.clone())
    }
}

impl Queue {
    fn is_busy(&self) -> bool {
        self.running > 0 || !self.waiting.is_empty()
    }
}

impl Lanes {
    /// Moves on to the least charged of the lanes at work or waiting, or to the most charged of all if all are idle.
    fn clock(&mut self) -> u64 {
        let busy = self.all.values().filter(|queue| queue.is_busy()).map(|queue| queue.charged).min();
        let now = busy.or_else(|| self.all.values().map(|queue| queue.charged).max()).unwrap_or(0);
        self.clock = self.clock.max(now);
        self.clock
    }

    /// Threads whose work has not checked for too long.
    fn overdue(&self) -> usize {
        let held = |since: &&Instant| since.elapsed() >= OVERDUE;
        self.contended.map_or(0, |contended| {
            if contended.elapsed() < OVERDUE { 0 } else { self.taken.values().filter(held).count() }
        })
    }

    /// Ends a turn. Time in which nobody waited costs nothing.
    fn end(&mut self, held: &Held) {
        self.taken.remove(&held.arrival);
        self.jobs -= usize::from(held.lane.1 == Kind::Job);
        if let Some(queue) = self.all.get_mut(&held.lane) {
            queue.running -= 1;
            let used = self.contended.map_or(Duration::ZERO, |contended| held.since.max(contended).elapsed());
            let unit = Kind::Interactive.weight() / held.lane.1.weight();
            queue.charged = queue.charged.saturating_add((used.as_nanos() as u64).saturating_mul(unit));
        }
    }
}

impl Held {
    fn give_way(&mut self) -> Duration {
        if self.turnstile.0.waiting.load(Ordering::Relaxed) == 0 {
            return Duration::ZERO;
        }
        let held = self.since.elapsed();
        if held < SLICE {
            return Duration::ZERO;
        }
        let turnstile = self.turnstile.clone();
        let mut lanes = turnstile.lanes();
        lanes.end(self);
        let worked = self.worked + held;
        if self.lane.1 == Kind::Interactive && worked > INTERACTIVE {
            self.lane.1 = Kind::Long;
        }
        let (parked, waiter) = (Instant::now(), turnstile.queue(self.lane.clone(), self.arrival, &mut lanes));
        drop(lanes);
        if let Ok(mut turn) = waiter.turn.blocking_recv()
            && let Some(held) = turn.0.take()
        {
            *self = Held { worked, ..held };
        }
        parked.elapsed()
    }
}

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        let (turnstile, Waiter { lane, arrival, .. }) = (self.turnstile, &self.waiter);
        let mut lanes = turnstile.lanes();
        if lanes.all.get_mut(lane).is_some_and(|queue| queue.waiting.remove(arrival).is_some()) {
            turnstile.0.waiting.fetch_sub(1, Ordering::Relaxed);
            turnstile.admit(&mut lanes);
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(held) = self.0.take() {
            let mut lanes = held.turnstile.lanes();
            lanes.end(&held);
            held.turnstile.admit(&mut lanes);
        }
    }
}
