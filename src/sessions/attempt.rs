//! The moves of a request on a loaded session, and the reply to them: what needs a processor and no store.

use std::sync::Arc;

use jiff::Timestamp;

use crate::admission::Deadline;
use crate::otlp;
use crate::store::{Measured, Record, Reply};
use stickslip_compute::computations::{Moved, make_moves, shown_states};
use stickslip_wire::session::Advance;
use stickslip_wire::{MoveReply, Observation, PathReply, Plan, RelaxReply, State, Steps};

use super::loaded::LoadedSession;
use super::observations::check_plausible;
use super::{SessionError, written};

/// The results of a computation that are to be stored.
pub(super) struct Done {
    pub(super) records: Vec<Record>,
    pub(super) reply: Reply,
}

/// The most pieces that one straight move can add to the slip history, with a margin.
pub(super) const PIECES_OF_A_MOVE: usize = 8;

/// Makes the moves, and writes the reply: the part of the work that needs a processor.
pub(super) fn attempt(
    live: &mut LoadedSession,
    advance: &Advance,
    by: Option<&Arc<str>>,
    stop: &Deadline,
) -> Result<Done, SessionError> {
    let solving = otlp::part!("solve").entered();
    let now = Timestamp::now();
    let mut records: Vec<Record> = Vec::with_capacity(advance.plan.length());
    let mut sequence = live.session.sequence;
    let tolerance = advance.tolerance;
    let observations = if let Plan::Observations(observations) = &advance.plan { &observations[..] } else { &[] };
    check_plausible(observations, live.contact.normal_force())?;
    let moved = make_moves(&mut live.contact, advance, stop, |step, state| {
        sequence += 1;
        let measured = observations.get(records.len()).map(|&Observation { force, at, .. }| Measured { force, at });
        records.push(Record { sequence, step, tolerance, state, measured, by: by.cloned(), at: now });
    })?;
    let Moved { stress, protocol, relaxed, accuracy, warnings, followed_in } = moved;
    live.replay_cost.add(records.len(), followed_in);
    live.session.sequence = sequence;
    live.session.updated_at = now;
    let id = live.session.id;
    drop(solving);
    let state: State = live.contact.state().into();
    let shown = |steps: Steps| shown_states(steps, records.iter().map(|record| record.state), state);
    let body = match &advance.plan {
        _ if let (Some(relax), Some(protocol)) = (advance.relax, relaxed) => {
            written(&RelaxReply { id, sequence, dry_run: false, steps: relax.steps.map(shown), protocol })?
        }
        Plan::Single(_) => written(&MoveReply { id, sequence, state, stress, accuracy, warnings })?,
        // Written once the past has been read, for the estimate that is in it.
        Plan::Observations(_) => Vec::new(),
        _ => {
            let steps = shown(advance.steps);
            written(&PathReply { id, sequence, steps, stress, protocol, accuracy, warnings })?
        }
    };
    Ok(Done { records, reply: Reply { created: None, sequence, body } })
}
