//! The reply of `/contacts/{id}/loop`: the way of a session as columns.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::reply::State;

/// A page of the hysteresis loop of a session, oldest first. The first page begins with the virgin contact, sequence nought;
/// pages put one after the other are the whole loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LoopPage {
    /// The move that a point is on or at the end of.
    pub sequence: Vec<u64>,
    /// How far on that move, 1 at its end.
    pub part: Vec<f64>,
    /// Tangential displacement U of the indenter, m.
    pub displacement: Vec<f64>,
    /// Tangential force F, N.
    pub force: Vec<f64>,
    /// What to give as `after` for the next page; `null` on the last.
    pub next: Option<u64>,
}

impl LoopPage {
    /// A page without moves as yet, beyond a move.
    #[must_use]
    pub fn after(after: u64) -> LoopPage {
        let mut page = LoopPage::default();
        if after == 0 {
            page.push(0, 1.0, 0.0, 0.0);
        }
        page
    }

    /// Adds a point on the way.
    pub fn push(&mut self, sequence: u64, part: f64, displacement: f64, force: f64) {
        self.sequence.push(sequence);
        self.part.push(part);
        self.displacement.push(displacement);
        self.force.push(force);
    }

    /// Adds the end of a move.
    pub fn push_end(&mut self, sequence: u64, state: &State) {
        self.push(sequence, 1.0, state.displacement, state.force);
    }
}
