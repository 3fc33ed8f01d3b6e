//! What a contact has done: its moves, and its hysteresis loop.

use super::closed_cycle::Cycle;
use super::observation::ObservedForce;
use crate::prelude::*;

replies! {
/// A move that has been applied.
pub struct HistoryItem omits Option {
    /// Its number, counted from 1.
    pub sequence: u64,
    /// The move as it was given.
    #[serde(rename = "move")]
    pub step: Move,
    /// The state after it.
    pub state: State,
    /// The cycle that it closed; the outermost if several.
    pub cycle: Option<Cycle>,
    /// The measurement, if the move is an observation.
    pub observation: Option<ObservedForce>,
    /// The name of the key that made it. Left out for a move that was made without a key, and where no keys are in use.
    pub by: Option<String>,
    /// When it was applied (ISO 8601, UTC).
    pub at: Timestamp,
}

/// A page of the history of a contact, oldest first.
pub struct HistoryPage {
    /// The moves.
    pub items: Vec<HistoryItem>,
    /// The value of `after` for the next page; `null` on the last page.
    pub next: Option<u64>,
}

/// A page of the hysteresis loop of a contact, oldest first. The first page begins with the virgin contact at sequence
/// zero; the pages in sequence are the whole loop.
pub struct LoopPage: Default {
    /// The number of the move that a point belongs to.
    pub sequence: Vec<u64>,
    /// Fraction of that move at the point, a pure number: 1 at its end.
    pub part: Vec<f64>,
    /// Tangential displacement U of the indenter, m; positive along x; `null` while the contact is twisted.
    pub displacement: Vec<Option<f64>>,
    /// Tangential force F_x, N; `null` while the contact is twisted.
    pub force: Vec<Option<f64>>,
    /// Angle of twist, rad, `null` while the contact is not twisted; left out if the page has no twist.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub twist: Vec<Option<f64>>,
    /// Torque, N·m, as `twist`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub torque: Vec<Option<f64>>,
    /// Force that was measured at each point, N, `null` where none was measured; left out if the page has no measured
    /// force.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub observed_force: Vec<Option<f64>>,
    /// The value of `after` for the next page; `null` on the last page.
    pub next: Option<u64>,
}
}

impl LoopPage {
    /// A page without moves yet, of those after the move `after`.
    pub fn after(after: u64) -> LoopPage {
        let mut page = LoopPage::default();
        if after == 0 {
            page.push(0, 1.0, &State { displacement: Some(0.0), force: Some(0.0), ..State::default() });
        }
        page
    }

    /// Adds a point within a move.
    pub fn push(&mut self, sequence: u64, part: f64, state: &State) {
        if state.twist.is_some() || !self.twist.is_empty() {
            for (all, value) in [(&mut self.twist, state.twist), (&mut self.torque, state.torque)] {
                all.resize(self.sequence.len(), None);
                all.push(value);
            }
        }
        self.sequence.push(sequence);
        self.part.push(part);
        self.displacement.push(state.displacement);
        self.force.push(state.force);
    }

    /// Adds the end of a move, with the force that was measured there, N, if one was.
    pub fn push_end(&mut self, sequence: u64, state: &State, observed_force: Option<f64>) {
        if observed_force.is_some() || !self.observed_force.is_empty() {
            self.observed_force.resize(self.force.len(), None);
            self.observed_force.push(observed_force);
        }
        self.push(sequence, 1.0, state);
    }

    /// The force that was measured at a point, N, if one was.
    pub fn observed_force(&self, point: usize) -> Option<f64> {
        self.observed_force.get(point).copied().flatten()
    }
}
