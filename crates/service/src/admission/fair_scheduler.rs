//! Slots on the solver threads: which work is next, and when long work yields.
//!
//! Work waits in a queue: that of its client and its kind. While somebody waits, each queue is charged for the time
//! that its work has held a thread, divided by the weight of its kind, and the queue that has been charged least is
//! next; within it, the work that came first. So queues share the threads by weight, whatever they ask for, and none
//! starves (start-time fair queueing: Goyal, Vin and Cheng 1996). Work that has held a thread for a slice yields at
//! its next check of a [`Deadline`](super::Deadline), if another queue is next, and waits on its own thread of the
//! blocking pool. A thread whose work has not checked for [`OVERDUE`] does not count for interactive work, which then
//! shares the processors with it.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use parking_lot::Mutex;
use stickslip_compute::begin_work;
use stickslip_compute::simulation::Worker;
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
    /// The share of a queue of this kind.
    const fn weight(self) -> u64 {
        match self {
            Kind::Interactive => 64,
            Kind::Long => 8,
            Kind::Job => 1,
        }
    }
}

type QueueKey = (Client, Kind);

/// The slots of a number of threads. Clones share it.
#[derive(Clone, Debug)]
pub struct FairScheduler(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    threads: usize,
    // How many wait, for a look without the lock.
    waiting: AtomicUsize,
    // Locked for a moment, and never across an await.
    queues: Mutex<WaitQueues>,
}

#[derive(Debug, Default)]
struct WaitQueues {
    /// Since when each slot is held, by the number of its work.
    taken: HashMap<u64, Instant>,
    /// How many of them are jobs'.
    jobs: usize,
    /// Numbers the work by its arrival.
    arrivals: u64,
    /// What an idle queue is taken to have been charged: as much as the least charged of the others.
    clock: u64,
    /// Since when somebody has been waiting without a break.
    contended: Option<Instant>,
    all: HashMap<QueueKey, WaitQueue>,
}

/// The work of a client and a kind.
#[derive(Debug, Default)]
struct WaitQueue {
    /// Weighted nanoseconds.
    charged: u64,
    running: usize,
    waiting: BTreeMap<u64, oneshot::Sender<SolverSlot>>,
}

/// Takes the work out of its queue when dropped. A slot that it was given meanwhile is dropped with the receiver.
struct Waiter<'a> {
    scheduler: &'a FairScheduler,
    key: QueueKey,
    arrival: u64,
    slot: oneshot::Receiver<SolverSlot>,
}

/// A thread for a piece of work, until dropped.
#[derive(Debug)]
pub struct SolverSlot(Option<Held>);

#[derive(Debug)]
struct Held {
    scheduler: FairScheduler,
    key: QueueKey,
    arrival: u64,
    since: Instant,
    /// How long it has worked before.
    worked: Duration,
}

thread_local! {
    /// The slot of the work on this thread.
    static SLOT: RefCell<SolverSlot> = const { RefCell::new(SolverSlot(None)) };
}

/// Lets others work if they are next, and then waits. To be called by work at each of its checks.
pub(super) fn yield_slot() {
    SLOT.with_borrow_mut(|slot| slot.0.as_mut().map(Held::yield_slot));
}

impl Worker for SolverSlot {
    /// Does the work in the slot, and gives it back.
    fn work<T>(self, work: impl FnOnce() -> T) -> T {
        /// Gives the slot back, after a panic too.
        struct End;
        impl Drop for End {
            fn drop(&mut self) {
                drop(SLOT.replace(SolverSlot(None)));
            }
        }
        drop(SLOT.replace(self));
        begin_work();
        let _end = End;
        work()
    }
}

impl FairScheduler {
    pub(super) fn new(threads: usize) -> FairScheduler {
        FairScheduler(Arc::new(Shared {
            threads: threads.max(1),
            waiting: AtomicUsize::new(0),
            queues: Mutex::default(),
        }))
    }

    pub(super) fn taken(&self) -> usize {
        self.0.queues.lock().taken.len()
    }

    /// A slot for a piece of work; it is lost to others if the future is dropped.
    pub(super) async fn wait_for_slot(&self, client: Client, kind: Kind) -> SolverSlot {
        let key = (client, kind);
        let mut waiter = {
            let mut queues = self.0.queues.lock();
            let arrival = queues.arrive();
            let slot = self.queue(key.clone(), arrival, &mut queues);
            Waiter { scheduler: self, key, arrival, slot }
        };
        loop {
            match timeout(OVERDUE, &mut waiter.slot).await {
                // The sender is kept until it is used.
                Ok(slot) => return slot.unwrap_or(SolverSlot(None)),
                Err(_) => self.admit(&mut self.0.queues.lock()),
            }
        }
    }

    /// Another slot for the same work, if nobody waits for it.
    pub(super) fn another(&self, client: &Client, kind: Kind) -> Option<SolverSlot> {
        let mut queues = self.0.queues.lock();
        if self.0.waiting.load(Ordering::Relaxed) > 0 || !self.has_room(&queues, kind) {
            return None;
        }
        let arrival = queues.arrive();
        Some(self.begin((client.clone(), kind), arrival, &mut queues))
    }

    /// Whether a thread is free for work of this kind.
    fn has_room(&self, queues: &WaitQueues, kind: Kind) -> bool {
        let (threads, taken) = (self.0.threads, queues.taken.len());
        match kind {
            Kind::Interactive => taken < threads || taken < threads + queues.overdue().min(threads),
            Kind::Long => taken < threads,
            Kind::Job => taken < threads && queues.jobs < threads.saturating_sub(1).max(1),
        }
    }

    fn queue(&self, key: QueueKey, arrival: u64, queues: &mut WaitQueues) -> oneshot::Receiver<SolverSlot> {
        let (sender, slot) = oneshot::channel();
        let clock = queues.clock();
        let queue = queues.all.entry(key).or_default();
        if !queue.is_busy() {
            queue.charged = queue.charged.max(clock);
        }
        queue.waiting.insert(arrival, sender);
        if self.0.waiting.fetch_add(1, Ordering::Relaxed) == 0 {
            queues.contended = Some(Instant::now());
        }
        self.admit(queues);
        slot
    }

    /// Gives free threads to those who are next.
    fn admit(&self, queues: &mut WaitQueues) {
        while let Some(key) = self.next(queues) {
            let Some((arrival, sender)) = queues.all.get_mut(&key).and_then(|queue| queue.waiting.pop_first()) else {
                return;
            };
            self.0.waiting.fetch_sub(1, Ordering::Relaxed);
            // A waiter that has left passes its slot on.
            if let Err(mut unused) = sender.send(self.begin(key, arrival, queues))
                && let Some(held) = unused.0.take()
            {
                queues.end(&held);
            }
        }
        if self.0.waiting.load(Ordering::Relaxed) == 0 {
            queues.contended = None;
        }
        // An idle queue that has been charged no more than a new one need not be remembered.
        let clock = queues.clock();
        queues.all.retain(|_, queue| queue.is_busy() || queue.charged > clock);
    }

    fn begin(&self, key: QueueKey, arrival: u64, queues: &mut WaitQueues) -> SolverSlot {
        let since = Instant::now();
        queues.taken.insert(arrival, since);
        queues.jobs += usize::from(key.1 == Kind::Job);
        queues.all.entry(key.clone()).or_default().running += 1;
        let scheduler = self.clone();
        SolverSlot(Some(Held { scheduler, key, arrival, since, worked: Duration::ZERO }))
    }

    /// The queue whose work is next, if there is a thread for it.
    fn next(&self, queues: &WaitQueues) -> Option<QueueKey> {
        let waiting =
            queues.all.iter().filter(|((_, kind), queue)| !queue.waiting.is_empty() && self.has_room(queues, *kind));
        let next = waiting.min_by_key(|((_, kind), queue)| {
            (queue.charged, *kind, queue.waiting.first_key_value().map(|(arrival, _)| *arrival))
        });
        next.map(|(key, _)| key.clone())
    }
}

impl WaitQueue {
    fn is_busy(&self) -> bool {
        self.running > 0 || !self.waiting.is_empty()
    }
}

impl WaitQueues {
    /// The number of a new piece of work.
    fn arrive(&mut self) -> u64 {
        self.arrivals += 1;
        self.arrivals
    }

    /// Moves on to the least charged of the queues at work or waiting, or to the most charged of all if all are idle.
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

    /// Gives a slot back. Time in which nobody waited costs nothing.
    fn end(&mut self, held: &Held) {
        self.taken.remove(&held.arrival);
        self.jobs -= usize::from(held.key.1 == Kind::Job);
        if let Some(queue) = self.all.get_mut(&held.key) {
            queue.running -= 1;
            let used = self.contended.map_or(Duration::ZERO, |contended| held.since.max(contended).elapsed());
            let unit = Kind::Interactive.weight() / held.key.1.weight();
            queue.charged = queue.charged.saturating_add((used.as_nanos() as u64).saturating_mul(unit));
        }
    }
}

impl Held {
    fn yield_slot(&mut self) {
        if self.scheduler.0.waiting.load(Ordering::Relaxed) == 0 {
            return;
        }
        let held = self.since.elapsed();
        if held < SLICE {
            return;
        }
        let scheduler = self.scheduler.clone();
        let mut queues = scheduler.0.queues.lock();
        queues.end(self);
        let worked = self.worked + held;
        if self.key.1 == Kind::Interactive && worked > INTERACTIVE {
            self.key.1 = Kind::Long;
        }
        let slot = scheduler.queue(self.key.clone(), self.arrival, &mut queues);
        drop(queues);
        if let Ok(mut slot) = slot.blocking_recv()
            && let Some(held) = slot.0.take()
        {
            *self = Held { worked, ..held };
        }
    }
}

impl Drop for Waiter<'_> {
    fn drop(&mut self) {
        let mut queues = self.scheduler.0.queues.lock();
        if queues.all.get_mut(&self.key).is_some_and(|queue| queue.waiting.remove(&self.arrival).is_some()) {
            self.scheduler.0.waiting.fetch_sub(1, Ordering::Relaxed);
            self.scheduler.admit(&mut queues);
        }
    }
}

impl Drop for SolverSlot {
    fn drop(&mut self) {
        if let Some(held) = self.0.take() {
            let mut queues = held.scheduler.0.queues.lock();
            queues.end(&held);
            held.scheduler.admit(&mut queues);
        }
    }
}
