//! What readers are shown of a contact: its state after its last stored move. They wait for no change.

use stickslip_wire::{ContactSummary, SessionReply, State};

use crate::store::{Extent, Record, Session};

use super::loaded::Derived;
use super::prelude::*;

/// A version at which nothing is known to be the stored state: that in the store has to be looked at.
pub(super) const UNVERIFIED: u64 = u64::MAX;

/// The state of a contact as readers are shown it.
pub(super) struct Published {
    pub(super) session: Session,
    derived: Arc<Derived>,
    state: State,
    /// The version of the contact in this process at which this was the stored state.
    pub(super) version: u64,
}

impl Published {
    /// Publishes a state that is the stored one at a version.
    pub(super) fn update(published: &mut Option<Published>, live: &LoadedSession, version: u64) {
        let LoadedSession { session, derived, contact, .. } = live;
        match published {
            Some(shown) if shown.is_of(live) => shown.version = version,
            Some(shown) if shown.session.label == session.label => {
                (shown.session.sequence, shown.session.updated_at) = (session.sequence, session.updated_at);
                (shown.state, shown.version) = (contact.state().into(), version);
            }
            published => {
                let (session, derived, state) = (session.clone(), Arc::clone(derived), contact.state().into());
                *published = Some(Published { session, derived, state, version });
            }
        }
    }

    /// Whether it is the state of a loaded contact.
    pub(super) fn is_of(&self, live: &LoadedSession) -> bool {
        let Session { label, sequence, updated_at, .. } = &live.session;
        self.session.sequence == *sequence && self.session.updated_at == *updated_at && self.session.label == *label
    }

    /// Whether it is the state that a store has.
    pub(super) fn is_stored(&self, stored: &Extent) -> bool {
        let Session { label, sequence, updated_at, .. } = &self.session;
        *sequence == stored.sequence && *label == stored.label && stored.is_moved_at(*updated_at)
    }

    /// Whether moves are stored after it, the last of which says what the state is. Where the part that stuck was, if a
    /// bulk stress comes with the force, is not stored.
    pub(super) fn is_behind(&self, stored: &Extent) -> bool {
        self.session.sequence < stored.sequence && self.session.definition.bulk.is_none()
    }

    /// Publishes the state after the last stored move instead.
    pub(super) fn advance(&mut self, stored: &Extent, last: &Record) {
        if last.sequence == stored.sequence && self.is_behind(stored) {
            (self.session.sequence, self.session.updated_at) = (last.sequence, last.at);
            self.session.label.clone_from(&stored.label);
            (self.state, self.version) = (last.state, UNVERIFIED);
        }
    }

    /// The reply that presents the contact.
    pub(super) fn reply(&self) -> SessionReply {
        presented(&self.session, &self.derived.summary, self.state)
    }
}

/// The reply that presents a contact in a state.
pub(super) fn presented(session: &Session, contact: &ContactSummary, state: State) -> SessionReply {
    let Session { id, ref label, sequence, created_at, updated_at, .. } = *session;
    let (label, contact) = (label.clone(), contact.clone());
    SessionReply { id, label, sequence, contact, state, created_at, updated_at }
}
