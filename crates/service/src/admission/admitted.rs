//! What a request has been admitted to, from its head to the last byte of its reply: one value, which work for the
//! request on other threads owns too.

use std::future::Future;
use std::sync::Arc;

use parking_lot::Mutex;

use super::{Client, Deadline, Pool, PoolError, RequestPermit, Reservation, Share, StopOnDrop};

tokio::task_local! {
    /// Of the request that this task serves.
    static CURRENT: Arc<Admission>;
}

/// What a request holds. All of it is free when the last owner is gone: the reply, or work that outlives it.
#[derive(Debug)]
pub struct Admission {
    /// On whose behalf.
    pub client: Client,
    /// The limit of all work for it, and whether its client still waits.
    pub deadline: Deadline,
    /// The memory of its body, then of its work and reply.
    pub memory: Reservation,
    // Locked for a moment.
    turn: Mutex<Turn>,
}

/// What only a reply that ends keeps until then.
#[derive(Debug, Default)]
struct Turn {
    share: Option<Share>,
    permit: Option<RequestPermit>,
    encoder: Option<Reservation>,
}

/// A request that is under way: when the last clone is dropped, the work for it is told to end.
#[derive(Clone)]
pub struct UnderWay(Arc<(Arc<Admission>, StopOnDrop)>);

impl UnderWay {
    /// What the request holds.
    pub fn admission(&self) -> &Arc<Admission> {
        &self.0.0
    }
}

impl Admission {
    /// A request that holds nothing, and has no limit.
    pub(super) fn of(client: Client) -> Admission {
        Admission { client, deadline: Deadline::none(), memory: Reservation::default(), turn: Mutex::default() }
    }

    /// A request of this client, with its share of the requests.
    pub fn begin(pool: &Pool, client: Client, share: Option<Share>) -> UnderWay {
        let (deadline, guard) = pool.deadline();
        let turn = Mutex::new(Turn { share, ..Turn::default() });
        UnderWay(Arc::new((Arc::new(Admission { client, deadline, memory: Reservation::empty(), turn }), guard)))
    }

    /// That of the request that this task serves.
    pub fn current() -> Option<Arc<Admission>> {
        CURRENT.try_with(Arc::clone).ok()
    }

    /// Waits for the permit to be served. The body has arrived by then.
    ///
    /// # Errors
    /// As [`Pool::wait`].
    pub async fn admit(&self, pool: &Pool) -> Result<(), PoolError> {
        let permit = pool.admit_request().await?;
        self.turn.lock().permit = Some(permit);
        Ok(())
    }

    /// Keeps the memory of an encoder until the reply is sent.
    pub fn keep_encoder(&self, memory: Reservation) {
        self.turn.lock().encoder = Some(memory);
    }

    /// Frees its permit and its share: its reply has no end, a limit of its own, and occupies no solver.
    pub fn become_endless(&self) {
        let Turn { share, permit, .. } = &mut *self.turn.lock();
        (*share, *permit) = (None, None);
    }

    /// Does a piece of work that does not wait for this request.
    pub fn within<T>(self: &Arc<Admission>, work: impl FnOnce() -> T) -> T {
        CURRENT.sync_scope(Arc::clone(self), work)
    }

    /// Does the work for this request.
    pub fn serve<F: Future>(self: Arc<Admission>, work: F) -> impl Future<Output = F::Output> {
        CURRENT.scope(self, work)
    }
}
