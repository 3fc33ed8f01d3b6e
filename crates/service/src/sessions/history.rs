//! The moves of sessions as they are stored.

use tracing::Instrument as _;

use stickslip_wire::{HistoryItem, HistoryPage, PrepareAnew};

use super::prelude::*;
use super::replay::damaged;

impl Sessions {
    /// The number of moves of a session.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn sequence(&self, id: Uuid) -> Result<u64, SessionError> {
        match self.shown(id, |shown| shown.session.sequence).await? {
            Some(shown) => Ok(shown),
            None => Ok(self.extent(id).await?.sequence),
        }
    }

    /// Checks that the first `end` moves of a session are all stored.
    ///
    /// # Errors
    /// [`SessionError::Store`] with [`StoreError::Damaged`](crate::store::StoreError::Damaged) if they are not, or a
    /// failure of the store.
    pub async fn check_complete(&self, id: Uuid, end: u64) -> Result<(), SessionError> {
        let count = self.store.count_moves(id, end).await;
        if count.map_err(|error| self.store_error(id, error))? == end {
            return Ok(());
        }
        // Which one is missing is found by reading them.
        let mut at = 0;
        while at < end {
            at += self.page(id, at, end).await?.len() as u64;
        }
        Err(damaged(id, &format_args!("some of its {end} moves are missing")))
    }

    /// A page of a session's moves, oldest first.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn history(&self, id: Uuid, after: u64, limit: usize) -> Result<HistoryPage, SessionError> {
        if self.entries.published(&self.tenant, id, |_| ()).is_none() {
            self.extent(id).await?;
        }
        self.own_history(id, after, limit).await
    }

    /// The same of a session that is known to belong to the tenant.
    pub(super) async fn own_history(&self, id: Uuid, after: u64, limit: usize) -> Result<HistoryPage, SessionError> {
        let found = self.store.history(id, after, limit + 1).instrument(otlp::part!("store")).await;
        let mut found = found.map_err(|error| self.store_error(id, error))?;
        let more = found.len() > limit;
        found.truncate(limit);
        let next = found.last().filter(|_| more).map(|record| record.sequence);
        let items = found.into_iter().map(|record| HistoryItem {
            sequence: record.sequence,
            step: record.step,
            state: record.state,
            cycle: None,
            observation: record.observation(),
            by: record.by.filter(|_| self.names_makers()).as_deref().map(str::to_owned),
            at: record.at,
        });
        Ok(HistoryPage { items: items.collect(), next })
    }

    /// Adds to the states of a page what follows from the rest of a state and is not stored: where the part that stuck
    /// was, if a bulk stress comes with the force, the conductances, if the bodies conduct, and the energy of surfaces
    /// that adhere.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store.
    pub async fn mark_centres(&self, id: Uuid, page: &mut HistoryPage) -> Result<(), SessionError> {
        let session = self.find_own(id).await?;
        let definition = &session.definition;
        if definition.bulk.is_some() || definition.material.conducts() || definition.adhesion.is_some() {
            let first = LoadedSession::of_stored(session, &PrepareAnew).map_err(|error| damaged(id, &error))?;
            mark_centres(page, &first.contact);
        }
        Ok(())
    }
}

/// The same for the contact of the page.
pub(super) fn mark_centres(page: &mut HistoryPage, contact: &Contact) {
    for HistoryItem { state, .. } in &mut page.items {
        *state = contact.completed((*state).into()).into();
        state.adhesion_loss = None;
    }
}
