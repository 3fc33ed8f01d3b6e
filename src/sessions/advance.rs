//! Moving a session on: the one place where it changes.

use std::sync::Arc;

use jiff::Timestamp;
use uuid::Uuid;

use crate::mechanics::protocol::equal_peaks;
use crate::simulation::{Stop, Timer, accuracy, cost, follow, stresses};
use crate::store::{Record, Reply, RequestKey, StoreError};
use crate::wire::session::Advance;
use crate::wire::{MoveReply, PathReply, Plan, Steps, limits};

use super::{ATTEMPTS, Guard, Live, SessionError, Sessions, agree, idempotency, written};

/// Why the exact solver answers for a session.
const REASON: &str = "a session keeps its exact memory";

/// What a computation leaves to be stored.
struct Done {
    records: Vec<Record>,
    reply: Reply,
}

/// The most pieces that one straight move can add to the memory, with room to spare.
const PIECES_OF_A_MOVE: usize = 8;

impl Sessions {
    /// Applies moves to a session, all or none of them, if it is at the sequence that the client expects.
    ///
    /// # Errors
    /// [`SessionError`]; nothing has changed then.
    pub async fn advance(
        &self,
        id: Uuid,
        advance: Advance,
        expected: Option<u64>,
        key: Option<RequestKey>,
    ) -> Result<Reply, SessionError> {
        // Before anything else: a retry is owed its reply even when the session is gone or has moved on.
        if let Some(reply) = self.earlier(key.as_ref()).await? {
            return Ok(reply);
        }
        // Whoever hangs up in the queue has left it.
        let guard = self.lock(id).await;
        let (stop, _raised_at_the_end) = Stop::guarded();
        let (sessions, advance) = (self.clone(), Arc::new(advance));
        let task = tokio::spawn(async move { sessions.advance_locked(id, advance, expected, key, guard, stop).await });
        task.await.unwrap_or_else(|_| Err(SessionError::Broken("a move panicked".to_owned())))
    }

    async fn advance_locked(
        &self,
        id: Uuid,
        advance: Arc<Advance>,
        expected: Option<u64>,
        key: Option<RequestKey>,
        mut guard: Guard,
        stop: Stop,
    ) -> Result<Reply, SessionError> {
        let (mut found, mut checked) = (0, false);
        for _ in 0..ATTEMPTS {
            // Again, now that a twin of this request that stood before it in the queue, here or elsewhere, is done.
            if let Some(reply) = self.earlier(key.as_ref()).await? {
                return Ok(reply);
            }
            let cached = self.present(id, &mut guard).await?.session.sequence;
            checked |= expected.is_some_and(|expected| expected != cached);
            let live = if checked { self.current(id, &mut guard).await? } else { self.present(id, &mut guard).await? };
            let sequence = live.session.sequence;
            agree(expected, sequence)?;
            let (live, Done { records, reply }) = match self.compute(id, &advance, &mut guard, &stop).await {
                Err(SessionError::Failure(_))
                    if self.store.is_shared()
                        && !std::mem::replace(&mut checked, true)
                        && self.current(id, &mut guard).await?.session.sequence != sequence =>
                {
                    // Refused because of a state of the past.
                    continue;
                }
                computed => computed?,
            };

            // Between here and the end the state is in doubt. The slot stays empty meanwhile: whoever finds it so, because
            // the store failed or this task died, asks the store what is true.
            let before = guard.take();
            let receipt = idempotency::receipt(key.clone(), &reply);
            match self.store.append(id, sequence, records, receipt).await {
                Ok(()) => {
                    *guard = Some(live);
                    return Ok(reply);
                }
                Err(StoreError::Stale { found: sequence }) => found = sequence,
                Err(error @ (StoreError::NotFound | StoreError::Expired)) => return Err(self.failed(id, error)),
                Err(other) => return self.lost(other, key).await,
            }
            // Another process was faster, and its moves come first.
            (*guard, checked) = (before, true);
        }
        Err(SessionError::Overtaken { found })
    }

    /// Computes the moves. A failure leaves the slot with the state before them, or, at worst, empty.
    async fn compute(
        &self,
        id: Uuid,
        advance: &Arc<Advance>,
        guard: &mut Guard,
        stop: &Stop,
    ) -> Result<(Live, Done), SessionError> {
        let depth = guard.as_ref().map_or(0, |live| live.contact.memory_depth());
        // A single move that the mechanics refuses has changed nothing, so that it needs no copy to fall back on; and a
        // copy costs as much as the memory is deep. Where others may be faster, the move may be for nothing.
        let in_place = !self.store.is_shared()
            && matches!(advance.plan, Plan::Single(step) if !step.is_curved())
            && advance.stress.is_none()
            && depth + PIECES_OF_A_MOVE <= limits::MEMORY_DEPTH;
        let live = if in_place { guard.take() } else { (**guard).clone() };
        let live = live.ok_or(SessionError::NotFound(id))?;
        let radii = advance.stress.as_ref().map_or(0, |stress| stress.length());
        let cost = cost::estimated_cost(advance.plan.length(), advance.plan.curved(), depth, radii, false);
        let (advance, stop) = (Arc::clone(advance), stop.clone());
        let (live, result) = self.pool.run(cost, move || attempt(live, &advance, &stop)).await?;
        match result {
            Ok(done) => Ok((live, done)),
            Err(error) => {
                if in_place && matches!(error, SessionError::Failure(_)) {
                    **guard = Some(live);
                }
                Err(error)
            }
        }
    }
}

fn attempt(mut live: Live, advance: &Advance, stop: &Stop) -> (Live, Result<Done, SessionError>) {
    let result = make(&mut live, advance, stop);
    (live, result)
}

/// Makes the moves, and writes the reply: all that needs a processor.
fn make(live: &mut Live, advance: &Advance, stop: &Stop) -> Result<Done, SessionError> {
    let timer = Timer::start();
    let now = Timestamp::now();
    let mut records: Vec<Record> = Vec::with_capacity(advance.plan.length());
    let mut sequence = live.session.sequence;
    let tolerance = advance.tolerance;
    let law = |reversals, cutoff_radius| equal_peaks(&live.contact, reversals, cutoff_radius);
    let protocol = advance.plan.protocol(&law);
    follow(&mut live.contact, &advance.plan, tolerance, stop, |step, state| {
        sequence += 1;
        records.push(Record { sequence, step, tolerance, state, at: now });
    })?;
    live.session.sequence = sequence;
    live.session.updated_at = now;
    let stress = advance.stress.as_ref().map(|sampling| stresses(&live.contact, sampling, stop)).transpose()?;
    let accuracy = accuracy(&live.contact, timer, REASON);
    let id = live.session.id;
    let states = records.iter().map(|record| record.state);
    let body = match (&advance.plan, advance.steps) {
        (Plan::Single(_), _) => {
            let state = live.contact.state().into();
            written(&MoveReply { id, sequence, state, stress, accuracy })?
        }
        (_, Steps::All) => {
            let steps = states.collect();
            written(&PathReply { id, sequence, steps, stress, protocol, accuracy })?
        }
        (_, Steps::Last) => {
            let steps = vec![live.contact.state().into()];
            written(&PathReply { id, sequence, steps, stress, protocol, accuracy })?
        }
    };
    Ok(Done { records, reply: Reply { created: None, sequence, body } })
}
