//! The reply of `/contacts/{id}/loop`: displacement and force of a contact, as columns.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::reply::State;

/// A page of the hysteresis loop of a contact, oldest first. The first page begins with the virgin contact at sequence zero; the
/// pages in sequence are the whole loop.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LoopPage {
    /// The number of the move that a point belongs to.
    pub sequence: Vec<u64>,
    /// Fraction of that move, 1 at its end.
    pub part: Vec<f64>,
    /// Tangential displacement U of the indenter, m.
    pub displacement: Vec<f64>,
    /// Tangential force F, N.
    pub force: Vec<f64>,
    /// What to give as `after` for the next page; `null` on the last.
    pub next: Option<u64>,
}

impl LoopPage {
    /// A page without moves yet, of those after the move `after`.
    #[must_use]
    pub fn after(after: u64) -> LoopPage {
        let mut page = LoopPage::default();
        if after == 0 {
            page.push(0, 1.0, 0.0, 0.0);
        }
        page
    }

    /// Adds a point within a move.
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
