//! The moves of a request on a loaded session, and the reply to them: what needs a processor and no store.

use std::sync::Arc;
use std::time::Instant;

use jiff::Timestamp;

use crate::admission::Stop;
use crate::computations::find_from_state;
use crate::otlp;
use crate::simulation::{FarMove, Timer, accuracy, equal_peaks, excess_error, follow, new_warnings, stresses};
use crate::store::{Measured, Record, Reply};
use stickslip_wire::session::Advance;
use stickslip_wire::{MoveReply, Observation, PathReply, Plan, RelaxReply, State, Steps};

use super::loaded::LoadedSession;
use super::observe::check_plausible;
use super::relax::without_step;
use super::{SessionError, written};

/// Why the exact solver answers for a session.
const REASON: &str = "stored contacts use the exact solver";

/// The results of a computation that are to be stored.
pub(super) struct Done {
    pub(super) records: Vec<Record>,
    pub(super) reply: Reply,
}

/// The most pieces that one straight move can add to the slip history, with a margin.
pub(super) const PIECES_OF_A_MOVE: usize = 8;

/// Makes the moves, and returns the state whether they are made or refused.
pub(super) fn attempt(
    mut live: Box<LoadedSession>,
    advance: &Advance,
    by: Option<&Arc<str>>,
    stop: &Stop,
) -> (Box<LoadedSession>, Result<Done, SessionError>) {
    let result = make(&mut live, advance, by, stop);
    (live, result)
}

/// Makes the moves, and writes the reply: the part of the work that needs a processor.
fn make(live: &mut LoadedSession, advance: &Advance, by: Option<&Arc<str>>, stop: &Stop) -> Result<Done, SessionError> {
    let solving = otlp::part!("solve").entered();
    let timer = Timer::start(stop);
    let now = Timestamp::now();
    let mut records: Vec<Record> = Vec::with_capacity(advance.plan.length());
    let mut sequence = live.session.sequence;
    let tolerance = advance.tolerance;
    let relaxed = advance.relax.map(|relax| find_from_state(&live.contact, &relax.task, stop)).transpose()?;
    let plan = relaxed.as_ref().map(|found| Plan::Displacement(found.path.displacement.clone()));
    let plan = plan.as_ref().unwrap_or(&advance.plan);
    let protocol = equal_peaks(plan, &live.contact)?;
    let observations = if let Plan::Observations(observations) = plan { &observations[..] } else { &[] };
    check_plausible(observations, live.contact.normal_force())?;
    let (before, error_before) = (live.contact.contact_radius(), live.contact.path_error());
    let (mut largest, mut error) = (before, 0.0f64);
    let mut far = FarMove::from(live.contact.displacement());
    let begin = Instant::now();
    let followed = follow(&mut live.contact, plan, protocol.as_ref(), tolerance, stop, |step, contact| {
        sequence += 1;
        largest = largest.max(contact.contact_radius());
        error = error.max(contact.path_error() - error_before);
        let measured = observations.get(records.len()).map(|&Observation { force, at, .. }| Measured { force, at });
        let state: State = contact.state().into();
        far.reach(state.displacement, contact.gross_slip_displacement(), contact.profile(), state.contact_radius);
        records.push(Record { sequence, step, tolerance, state, measured, by: by.cloned(), at: now });
    });
    followed.map_err(|failure| if advance.relax.is_some() { without_step(failure) } else { failure })?;
    live.replay_cost.add(records.len(), begin.elapsed());
    live.session.sequence = sequence;
    live.session.updated_at = now;
    let stress = advance.stress.as_ref().map(|sampling| stresses(&live.contact, sampling, stop)).transpose()?;
    let accuracy = accuracy(&live.contact, timer, REASON);
    let excess = excess_error(error, tolerance, advance.plan.curved());
    let mut warnings = new_warnings(&live.contact, before, largest, excess);
    warnings.extend(far.warning());
    let id = live.session.id;
    drop(solving);
    let shown = |steps: Steps| match steps {
        Steps::All => records.iter().map(|record| record.state).collect(),
        Steps::Last => vec![live.contact.state().into()],
    };
    let body = match &advance.plan {
        _ if let (Some(relax), Some(protocol)) = (advance.relax, relaxed) => {
            written(&RelaxReply { id, sequence, dry_run: false, steps: relax.steps.map(shown), protocol })?
        }
        Plan::Single(_) => {
            let state = live.contact.state().into();
            written(&MoveReply { id, sequence, state, stress, accuracy, warnings })?
        }
        // Written once the past has been read, for the estimate that is in it.
        Plan::Observations(_) => Vec::new(),
        _ => {
            let steps = shown(advance.steps);
            written(&PathReply { id, sequence, steps, stress, protocol, accuracy, warnings })?
        }
    };
    Ok(Done { records, reply: Reply { created: None, sequence, body } })
}
