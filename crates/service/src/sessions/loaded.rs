//! A loaded session: its state, and the memory that it takes.

use std::cmp::Ordering;

use crate::store::{CONTACT_BYTES, Reply, Session};
use stickslip_compute::formats;
use stickslip_compute::simulation::{self, bytes, present_warnings};
use stickslip_mechanics::closed_cycles::CycleLog;
use stickslip_wire::definition::FrictionSetup;
use stickslip_wire::limits::Limited as _;
use stickslip_wire::{
    ContactSummary, Faults, FrictionEstimate, JsonPath, NewSession, NoFriction, Prepare, SessionReply, Warning,
};

use super::prelude::*;
use super::published::presented;
use super::snapshot::ReplayCost;

/// Bytes of a session besides its pieces, its label and its tables: what is fixed, and its entry with what readers are
/// shown, some 450 of them.
const FIXED: usize = 1536;

/// Bytes that suffice for most replies, so that a buffer need not grow step by step.
const REPLY: usize = 768;
/// Bytes of a definition as JSON besides its tables, and of a number in these.
const DEFINITION: usize = 256;
const NUMBER: usize = 20;

/// A session with its state.
#[derive(Clone)]
pub(super) struct LoadedSession {
    pub(super) session: Session,
    pub(super) derived: Arc<Derived>,
    pub(super) contact: Contact,
    /// The cost of a replay from the last snapshot.
    pub(super) replay_cost: ReplayCost,
    /// Whether other processes have been seen to move it, so that a move is likely to come too late.
    pub(super) shared: bool,
    /// Whether replaying its moves was stopped here, so that more of them are stored.
    pub(super) is_behind: bool,
    /// The move of a stored snapshot that cannot be read: another engine has made it, or it is damaged.
    pub(super) unreadable: Option<u64>,
    /// The closed cycles of its past, once they have been asked for.
    pub(super) cycles: Option<Arc<CycleLog>>,
    /// The same up to an earlier move: up to the page of the history that was read last.
    pub(super) past_cycles: Option<Arc<CycleLog>>,
    /// The friction by its observations, once it has been estimated.
    pub(super) estimated: Option<Estimated>,
    /// Bytes that count for it in the cache: its own, and those of its profile unless others share that.
    pub(super) counted: (usize, usize),
}

/// What a cycle says about the friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimated {
    /// The move after which it began.
    pub(super) from: u64,
    /// The move that closed it.
    pub(super) to: u64,
    /// Or why it says nothing.
    pub(super) friction: Result<FrictionEstimate, NoFriction>,
}

/// Values that follow from the definition and never change.
pub(super) struct Derived {
    pub(super) summary: ContactSummary,
    pub(super) warnings: Vec<Warning>,
}

impl LoadedSession {
    /// A contact at its preload, and what follows from its definition. Whatever the sequence of `session` is, the state
    /// is that before the first move.
    pub(super) fn start(session: Session, setup: FrictionSetup) -> Result<LoadedSession, simulation::Failure> {
        let contact = simulation::contact(setup, "")?;
        let derived = Derived { summary: contact.initial_summary().into(), warnings: present_warnings(&contact) };
        let derived = Arc::new(derived);
        let replay_cost = ReplayCost::default();
        let (shared, is_behind, unreadable) = (false, false, None);
        let (cycles, past_cycles, estimated) = (None, None, None);
        Ok(LoadedSession {
            session,
            derived,
            contact,
            replay_cost,
            shared,
            is_behind,
            unreadable,
            cycles,
            past_cycles,
            estimated,
            counted: (0, 0),
        })
    }

    /// The same of a stored session, or the reason why its definition is invalid.
    pub(super) fn of_stored(session: Session, profiles: &dyn Prepare) -> Result<LoadedSession, String> {
        let mut faults = Faults::default();
        session.definition.check_limits(JsonPath::Root, &mut faults);
        let setup = session.definition.check_any(JsonPath::Root, profiles, &mut faults);
        let setup = faults.done(setup).map_err(|error| error.to_string())?;
        LoadedSession::start(session, setup).map_err(|error| error.to_string())
    }

    /// Bytes of memory without its profile, rather too many than too few: what forks share is counted for each.
    pub(super) fn bytes(&self) -> usize {
        let label = self.session.label.as_ref().map_or(0, String::capacity);
        let warnings: usize = self.derived.warnings.iter().map(|warning| warning.message.capacity()).sum();
        let cycles: usize =
            [&self.cycles, &self.past_cycles].into_iter().flatten().map(|cycles| cycles.memory_bytes()).sum();
        FIXED + self.contact.memory_bytes() + label + warnings + cycles
    }

    /// Bytes of its profile, which other sessions may share.
    pub(super) fn shape_bytes(&self) -> usize {
        bytes::of_shape(&self.session.definition.profile)
    }

    /// Bytes that its definition takes in the store, roughly, without its moves.
    pub(super) fn stored_bytes(&self) -> u64 {
        CONTACT_BYTES + (DEFINITION + NUMBER * 2 * self.session.definition.profile.points()) as u64
    }

    /// The reply that presents a session.
    pub(super) fn reply(&self) -> SessionReply {
        presented(&self.session, &self.derived.summary, self.contact.state().into())
    }

    /// The reply that presents a session just made.
    pub(super) fn created_reply(&self) -> Result<Reply, SessionError> {
        let Session { id, label, sequence, .. } = &self.session;
        let new = NewSession {
            id: *id,
            label: label.clone(),
            sequence: *sequence,
            contact: self.derived.summary.clone(),
            state: self.contact.state().into(),
            warnings: self.derived.warnings.clone(),
        };
        Ok(Reply { created: Some(*id), sequence: *sequence, body: written(&new)? })
    }

    /// The log that has come farthest of those that know every cycle that the moves after this one closed.
    pub(super) fn log_for(&self, after: u64) -> Option<Arc<CycleLog>> {
        let logs = [&self.cycles, &self.past_cycles].into_iter().flatten().filter(|log| log.dropped <= after);
        logs.max_by_key(|log| log.sequence).cloned()
    }

    /// Keeps a log that has come farther than those kept, or the same up to an earlier move.
    pub(super) fn keep_log(&mut self, log: &Arc<CycleLog>) {
        let newest = self.cycles.as_ref().map(|kept| kept.sequence);
        match newest.cmp(&Some(log.sequence)) {
            Ordering::Less => self.cycles = Some(Arc::clone(log)),
            Ordering::Equal => {}
            Ordering::Greater => self.past_cycles = Some(Arc::clone(log)),
        }
    }
}

/// A reply as JSON.
pub(super) fn written(reply: &impl serde::Serialize) -> Result<Vec<u8>, SessionError> {
    Ok(otlp::part!("write").in_scope(|| formats::json(REPLY, reply))?)
}
