//! Moves of several clients on one session that wait for its lock at the same time: whoever gets the lock makes them
//! all, in the order of their arrival, and they share one append to the store. Each has a reply, or a refusal, of its
//! own.
//!
//! Only single straight moves without stresses and without an idempotency key are made for others: they take about a
//! microsecond, and a refused one has changed nothing. Whatever a group does not finish, its client does alone, as if
//! it had not waited.

use std::sync::Arc;

use tokio::sync::oneshot;
use tracing::{Instrument as _, Span};
use uuid::Uuid;

use crate::admission::Client;
use crate::otlp;
use crate::store::{Reply, StoreError, Usage};
use stickslip_compute::simulation::cost::Work;
use stickslip_wire::session::Advance;
use stickslip_wire::{Plan, limits};

use super::SessionError;
use super::attempt::{Done, PIECES_OF_A_MOVE, attempt};
use super::cache::{Guard, WaitingMove};
use super::expected::Expected;
use super::loaded::LoadedSession;
use super::replay::Replay;

/// Moves that are made together at most.
const GROUP: usize = 64;

/// Who makes a move.
pub(super) enum GroupResult {
    /// Whoever has asked.
    Locked(Guard),
    /// Another one has made it.
    Answered(Result<Reply, SessionError>),
}

struct Group {
    replay: Replay,
    guard: Guard,
    moves: Vec<WaitingMove>,
}

/// Whether a move may be made together with others.
pub(super) fn may_join(advance: &Advance) -> bool {
    matches!(advance.plan, Plan::Single(step) if !step.is_curved())
        && advance.stress.is_none()
        && advance.relax.is_none()
}

/// Waits until the session is free for this move, or until another one has made it.
///
/// # Errors
/// [`SessionError`]; nothing has changed then.
pub(super) async fn lock_or_join(
    replay: &Replay,
    by: Option<&Arc<str>>,
    id: Uuid,
    advance: &Arc<Advance>,
    expected: Option<Expected>,
) -> Result<GroupResult, SessionError> {
    match replay.common.cache.try_lock(&replay.tenant, id) {
        Some(guard) => Ok(GroupResult::Locked(guard)),
        // In a box, so that a move that need not wait is not as large as one that does.
        None => Box::pin(join_queue(replay, by, id, advance, expected)).await,
    }
}

async fn join_queue(
    replay: &Replay,
    by: Option<&Arc<str>>,
    id: Uuid,
    advance: &Arc<Advance>,
    expected: Option<Expected>,
) -> Result<GroupResult, SessionError> {
    let reservation = replay.reserve_storage(Usage::of(0, replay.common.store.move_bytes(), None)).await?;
    let (advance, by) = (Arc::clone(advance), by.cloned());
    let (answer, answered) = oneshot::channel();
    let waiting_move = WaitingMove { advance, expected, by, reservation, span: Span::current(), answer };
    let mut position = replay.common.cache.enqueue(&replay.tenant, id, Some(waiting_move));
    let locked = match replay.common.pool.wait(&mut position.lock).await {
        Err(busy) if position.leave() => return Err(busy.into()),
        Err(_) => (&mut position.lock).await,
        Ok(locked) => locked,
    };
    if let Ok((lock, own)) = locked {
        let guard = lock.guard();
        // If the state is there, and no other process is likely to move the session first.
        let is_own = guard.live.as_ref().is_some_and(|live| !live.shared && !live.is_behind);
        let others = if is_own { guard.take_moves(GROUP - 1) } else { Vec::new() };
        if others.is_empty() {
            return Ok(GroupResult::Locked(guard));
        }
        let group = Group { replay: replay.clone(), guard, moves: own.into_iter().chain(others).collect() };
        // In a task of its own: whose client leaves does not take the others with it.
        tokio::spawn(Client::current().serve(group.make().in_current_span()));
    }
    match answered.await {
        Ok(Some(answer)) => Ok(GroupResult::Answered(answer)),
        Ok(None) => Ok(GroupResult::Locked(replay.lock(id).await?)),
        Err(_) => Err(StoreError::Unavailable("the move was given up with others".to_owned()).into()),
    }
}

impl Group {
    /// Makes the moves, stores them, and tells each waiting move what has become of its own. The guard is dropped last.
    async fn make(mut self) {
        let common = &self.replay.common;
        // Until the store has answered the new state is in doubt, as for a move that is made alone.
        let Some(live) = self.guard.live.take() else {
            return self.moves.into_iter().for_each(decline);
        };
        let before = live.session.sequence;
        let Some((mut live, outcomes)) = self.compute(live).await else {
            return self.moves.into_iter().for_each(decline);
        };
        let (mut made, mut records) = (Vec::with_capacity(outcomes.len()), Vec::with_capacity(outcomes.len()));
        for (taken, done) in self.moves.into_iter().zip(outcomes) {
            match done {
                Some(Done { records: more, reply }) => {
                    records.extend(more);
                    made.push((taken, reply));
                }
                None => decline(taken),
            }
        }
        if records.is_empty() {
            self.guard.live = Some(live);
            return;
        }
        let moves = records.len() as u64;
        let stored = common.store.append(self.guard.id(), before, records, None);
        match stored.instrument(otlp::part!("store")).await {
            Ok(()) => {
                common.metrics.moves.inc_by(moves);
                common.snapshots.offer(&mut live);
                self.guard.live = Some(live);
                let added = Usage::of(0, common.store.move_bytes(), None);
                for (taken, reply) in made {
                    taken.reservation.used(added);
                    let _ = taken.answer.send(Some(Ok(reply)));
                }
            }
            // Nothing has changed: each finds out for itself what is wrong.
            Err(StoreError::Stale { .. } | StoreError::NotFound | StoreError::Expired(_)) => {
                made.into_iter().for_each(|(taken, _)| decline(taken));
            }
            Err(error) => made.into_iter().for_each(|(taken, _)| {
                let _ = taken.answer.send(Some(Err(error.clone().into())));
            }),
        }
    }

    /// Makes the moves one after the other. Returns the state after them, and what each has done, unless it is refused;
    /// nothing if one of them has spoiled the state.
    async fn compute(&self, mut live: Box<LoadedSession>) -> Option<(Box<LoadedSession>, Vec<Option<Done>>)> {
        let pool = &self.replay.common.pool;
        let (stop, _raised_at_the_end) = pool.deadline();
        let work = Work { moves: self.moves.len(), depth: live.contact.memory_depth(), ..Work::default() };
        let cost = work.cost(live.contact.profile());
        let question =
            |taken: &WaitingMove| (Arc::clone(&taken.advance), taken.expected, taken.by.clone(), taken.span.clone());
        let asked: Vec<_> = self.moves.iter().map(question).collect();
        let solve = move || {
            let mut outcomes = Vec::with_capacity(asked.len());
            for (advance, expected, by, span) in asked {
                // A refusal counts only once the store has been asked, which its client does alone.
                let joins = expected.is_none_or(|expected| expected == live.session.sequence.into())
                    && live.contact.memory_depth() + PIECES_OF_A_MOVE <= limits::MEMORY_DEPTH;
                let done = joins.then(|| span.in_scope(|| attempt(&mut live, &advance, by.as_ref(), &stop)));
                outcomes.push(match done.transpose() {
                    Err(SessionError::Failure(_)) => None,
                    done => done.ok()?,
                });
            }
            Some((live, outcomes))
        };
        pool.run(cost, solve).await.ok().flatten()
    }
}

/// Leaves a move to its client, who may have left.
fn decline(taken: WaitingMove) {
    let _ = taken.answer.send(None);
}
