//! The line of changes whose contacts other transactions hold. They are tried again together, on a connection of their
//! own, until they are made or have waited for as long as they may; the writer goes on without them.
//!
//! Changes of one contact stay in the order of their arrival, as do those with one idempotency key: what comes after a
//! change in the line joins the line.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;
use std::time::Instant;

use parking_lot::Mutex;
use tokio::sync::Notify;
use tokio::task::JoinHandle;
use tokio::time::timeout_at;
use uuid::Uuid;

use super::committer::{Committer, without_overdue};
use super::request::{WriteRequest, collect_batch};

/// Changes that wait for locks at a time. A further one is refused at once, so that those that wait leave the others
/// room among the requests that a server has in progress.
const LENGTH: usize = 256;

/// The writer's side of the line, whose other side is a task.
pub(super) struct LockLine {
    shared: Arc<Shared>,
    task: JoinHandle<()>,
}

/// What both sides see.
#[derive(Default)]
struct Shared {
    // Locked for a pass over the line, never across an await.
    line: Mutex<Line>,
    pushed: Notify,
}

#[derive(Default)]
struct Line {
    waiting: VecDeque<WriteRequest>,
    /// What is being tried.
    tried: Names,
    ended: bool,
}

/// Contacts and idempotency keys of changes.
#[derive(Default)]
struct Names {
    ids: HashSet<Uuid>,
    keys: HashSet<String>,
}

impl Names {
    fn of<'a>(requests: impl Iterator<Item = &'a WriteRequest>) -> Names {
        let mut names = Names::default();
        requests.for_each(|request| names.add(request));
        names
    }

    fn add(&mut self, request: &WriteRequest) {
        self.ids.insert(request.id());
        self.keys.extend(request.key().map(str::to_owned));
    }

    fn name(&self, request: &WriteRequest) -> bool {
        self.ids.contains(&request.id()) || request.key().is_some_and(|key| self.keys.contains(key))
    }
}

impl LockLine {
    /// An empty line, whose changes this committer makes.
    pub(super) fn start(committer: Committer) -> LockLine {
        let shared = Arc::new(Shared::default());
        let task = tokio::spawn(Arc::clone(&shared).run(committer));
        LockLine { shared, task }
    }

    /// Takes those changes of the writer's that come after one in the line.
    pub(super) fn take_followers(&self, backlog: &mut VecDeque<WriteRequest>) {
        let mut line = self.shared.line.lock();
        if line.waiting.is_empty() && line.tried.ids.is_empty() {
            return;
        }
        let mut names = Names::of(line.waiting.iter());
        for request in std::mem::take(backlog) {
            if names.name(&request) || line.tried.name(&request) {
                names.add(&request);
                line.push(request);
            } else {
                backlog.push_back(request);
            }
        }
    }

    /// Puts changes into the line that are held.
    pub(super) fn push(&self, held: Vec<WriteRequest>) {
        if !held.is_empty() {
            let mut line = self.shared.line.lock();
            held.into_iter().for_each(|request| line.push(request));
            self.shared.pushed.notify_one();
        }
    }

    /// Waits until the line is empty, and ends it.
    pub(super) async fn end(self) {
        self.shared.line.lock().ended = true;
        self.shared.pushed.notify_one();
        // It ends with an error only if the process does.
        let _ = self.task.await;
    }
}

impl Line {
    fn push(&mut self, mut request: WriteRequest) {
        if self.waiting.len() >= LENGTH {
            return request.refuse_as_locked();
        }
        request.postpone();
        self.waiting.push_back(request);
    }

    /// Puts changes that are still held back in front of those that came after them.
    fn put_back(&mut self, held: Vec<WriteRequest>) {
        for mut request in held.into_iter().rev() {
            request.postpone();
            self.waiting.push_front(request);
        }
        self.tried = Names::default();
    }

    /// Takes the changes that are to be tried now, none of which comes after another one that waits; and when others
    /// are.
    fn take_due(&mut self) -> (VecDeque<WriteRequest>, Option<Instant>) {
        let (now, mut next) = (Instant::now(), None::<Instant>);
        let (mut due, mut passed) = (VecDeque::new(), Names::default());
        for request in std::mem::take(&mut self.waiting) {
            let follows = passed.name(&request);
            passed.add(&request);
            if !follows && request.due <= now {
                due.push_back(request);
                continue;
            }
            if !follows {
                next = Some(next.map_or(request.due, |next| next.min(request.due)));
            }
            self.waiting.push_back(request);
        }
        self.tried = Names::of(due.iter());
        (due, next)
    }
}

impl Shared {
    /// Tries changes again until the line has ended.
    async fn run(self: Arc<Self>, mut committer: Committer) {
        loop {
            let ((mut due, next), ended) = {
                let mut line = self.line.lock();
                (line.take_due(), line.ended)
            };
            if due.is_empty() {
                match next {
                    // Whatever comes first.
                    Some(next) => drop(timeout_at(next.into(), self.pushed.notified()).await),
                    None if ended => return,
                    None => self.pushed.notified().await,
                }
                continue;
            }
            let mut held = Vec::new();
            while !due.is_empty() {
                held.extend(committer.commit(collect_batch(&mut due)).await);
            }
            self.line.lock().put_back(without_overdue(held));
        }
    }
}
