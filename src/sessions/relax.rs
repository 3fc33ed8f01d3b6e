//! What would relax a session, without touching it.

use uuid::Uuid;

use crate::admission::Reservation;
use crate::computations::{OnContact as _, rehearse_relax};
use stickslip_wire::RelaxReply;
use stickslip_wire::protocol::Relaxation;

use super::{SessionError, Sessions, written};

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
        let task = relaxation.task;
        let (stop, _raised_at_the_end) = self.common.pool.deadline();
        let held = self.common.pool.reserve(task.bytes()).await?;
        let (contact, sequence, state) = self.copy(id, None, &stop).await?;
        if let Some(expected) = expected.filter(|expected| *expected != sequence) {
            return Err(SessionError::Stale { expected, found: sequence });
        }
        let cost = task.cost(contact.profile(), contact.memory_depth());
        let work = move || {
            let _state = state;
            let (steps, protocol) = rehearse_relax(contact, &relaxation, &stop)?;
            written(&RelaxReply { id, sequence, dry_run: true, steps, protocol })
        };
        Ok((sequence, self.common.pool.run(cost, work).await??, held))
    }
}
