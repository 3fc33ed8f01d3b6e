//! What would relax a session, without touching it.

use uuid::Uuid;

use crate::admission::Reservation;
use crate::computations::{OnContact as _, find_from_state};
use crate::simulation::{Failure, follow};
use stickslip_mechanics::DEFAULT_TOLERANCE;
use stickslip_wire::protocol::Relaxation;
use stickslip_wire::{Plan, RelaxReply, Steps};

use super::{SessionError, Sessions, written};

/// The failure of a move that the client did not send itself.
pub(super) fn without_step(failure: Failure) -> Failure {
    match failure {
        Failure::Refused { error, .. } => Failure::Refused { pointer: String::new(), error },
        Failure::MemoryFull { depth, .. } => Failure::MemoryFull { pointer: String::new(), depth },
        Failure::TooLong { allowed, .. } => Failure::TooLong { pointer: "/reversals".to_owned(), allowed },
        // A contact that moves has its profile, no cycle to be rated, no scan and no measured loop.
        Failure::Stopped
        | Failure::Search { .. }
        | Failure::Lifted
        | Failure::NeedsServer { .. }
        | Failure::CycleTooLarge { .. }
        | Failure::Preparation { .. }
        | Failure::Scan { .. }
        | Failure::Loops { .. } => failure,
    }
}

impl Sessions {
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
        let (stop, _raised_at_the_end) = self.common.pool.deadline();
        let held = self.common.pool.reserve(task.bytes()).await?;
        let (mut contact, sequence, state) = self.copy(id, None, &stop).await?;
        if let Some(expected) = expected.filter(|expected| *expected != sequence) {
            return Err(SessionError::Stale { expected, found: sequence });
        }
        let cost = task.cost(contact.profile(), contact.memory_depth());
        let work = move || {
            let _state = state;
            let protocol = find_from_state(&contact, &task, &stop)?;
            let plan = Plan::Displacement(protocol.path.displacement.clone());
            let mut states = Vec::new();
            if steps.is_some() {
                follow(&mut contact, &plan, None, DEFAULT_TOLERANCE, &stop, |_, contact| {
                    states.push(contact.state().into());
                })
                .map_err(without_step)?;
            }
            if steps == Some(Steps::Last) {
                states.drain(..states.len().saturating_sub(1));
            }
            written(&RelaxReply { id, sequence, dry_run: true, steps: steps.map(|_| states), protocol })
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }
}
