//! Protocols for sessions: what would relax one, without touching it.

use uuid::Uuid;

use crate::admission::{Reservation, Stop};
use crate::simulation::{self, Failure, Subject, bytes, cost, follow};
use stickslip_mechanics::DEFAULT_TOLERANCE;
use stickslip_wire::protocol::{ProtocolTask, Relaxation};
use stickslip_wire::{ContactDefinition, Plan, ProtocolReply, RelaxReply, Steps};

use super::loaded::LoadedSession;
use super::{SessionError, Sessions, written};

/// The protocol that begins from the present state of a session.
pub(super) fn find_protocol(live: &LoadedSession, task: &ProtocolTask, stop: &Stop) -> Result<ProtocolReply, Failure> {
    if live.contact.contact_radius() <= 0.0 {
        return Err(Failure::Lifted);
    }
    simulation::protocol(&Subject { contact: &live.contact, first: None, setup: None }, task, stop)
}

/// The failure of a move that the client did not send itself.
pub(super) fn without_step(failure: Failure) -> Failure {
    match failure {
        Failure::Refused { error, .. } => Failure::Refused { pointer: String::new(), error },
        Failure::MemoryFull { depth, .. } => Failure::MemoryFull { pointer: String::new(), depth },
        Failure::TooLong { allowed, .. } => Failure::TooLong { pointer: "/reversals".to_owned(), allowed },
        // A contact has no cycle to be rated, no scan and no measured loop.
        Failure::Stopped
        | Failure::Search { .. }
        | Failure::Lifted
        | Failure::CycleTooLarge { .. }
        | Failure::Scan { .. }
        | Failure::Loops { .. } => failure,
    }
}

impl Sessions {
    /// The protocol that begins from the present state of a session, which `said` to have this definition, and the
    /// sequence that it belongs to, with the memory that it takes.
    ///
    /// # Errors
    /// [`SessionError`], among them [`SessionError::OtherDefinition`].
    pub async fn protocol(
        &self,
        id: Uuid,
        said: Option<ContactDefinition>,
        task: ProtocolTask,
    ) -> Result<(u64, Vec<u8>, Reservation), SessionError> {
        self.with_copy(id, said, None, task, move |live, stop| written(&find_protocol(live, &task, stop)?)).await
    }

    /// What [`Sessions::apply_moves`] would do to relax a session at the sequence that the client expects; nothing
    /// changes.
    ///
    /// # Errors
    /// [`SessionError`].
    pub async fn dry_run_relax(
        &self,
        id: Uuid,
        relaxation: Relaxation,
        expected: Option<u64>,
    ) -> Result<(u64, Vec<u8>, Reservation), SessionError> {
        let Relaxation { task, steps, .. } = relaxation;
        let work = move |live: &mut LoadedSession, stop: &Stop| {
            let protocol = find_protocol(live, &task, stop)?;
            let plan = Plan::Displacement(protocol.path.displacement.clone());
            let mut states = Vec::new();
            if steps.is_some() {
                follow(&mut live.contact, &plan, None, DEFAULT_TOLERANCE, stop, |_, contact| {
                    states.push(contact.state().into());
                })
                .map_err(without_step)?;
            }
            if steps == Some(Steps::Last) {
                states.drain(..states.len().saturating_sub(1));
            }
            let (sequence, steps) = (live.session.sequence, steps.map(|_| states));
            written(&RelaxReply { id, sequence, dry_run: true, steps, protocol })
        };
        self.with_copy(id, None, expected, task, work).await
    }

    /// Works on a copy of a session: the lock is held for the copy alone, so that the session can move on meanwhile.
    async fn with_copy(
        &self,
        id: Uuid,
        said: Option<ContactDefinition>,
        expected: Option<u64>,
        task: ProtocolTask,
        work: impl FnOnce(&mut LoadedSession, &Stop) -> Result<Vec<u8>, SessionError> + Send + 'static,
    ) -> Result<(u64, Vec<u8>, Reservation), SessionError> {
        let (stop, _raised_at_the_end) = self.common.pool.deadline();
        let held = self.common.pool.reserve(bytes::of_protocol(&task)).await?;
        let (mut live, state) = {
            let mut guard = self.lock(id).await?;
            let live = self.current(&mut guard).await?;
            let found = live.session.sequence;
            if let Some(expected) = expected.filter(|expected| *expected != found) {
                return Err(SessionError::Stale { expected, found });
            }
            if said.is_some_and(|said| said != *live.session.definition) {
                return Err(SessionError::OtherDefinition(id));
            }
            let bytes = live.contact.memory_bytes();
            let state = self.reserve_copy(&mut guard, bytes).await?;
            (guard.live.clone().ok_or(SessionError::NotFound(id))?, state)
        };
        let sequence = live.session.sequence;
        let cost = cost::of_protocol(live.contact.profile(), &task, live.contact.memory_depth());
        let work = move || {
            let _state = state;
            work(&mut live, &stop)
        };
        let body = self.common.pool.run(cost, work).await??;
        Ok((sequence, body, held))
    }
}
