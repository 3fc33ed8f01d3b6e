//! Moves along one line, which the exact contact follows without rings.

use super::field::Field;
use super::follow::{Refusal, Scene};
use super::solution::{PlanarState, Solution};
use super::stiffness::Vector;
use super::{PlanarMove, PlanarTarget};
use crate::contact::Contact;
use crate::contact::state::{Move, State, Tangential};
use crate::path::curved_move::DEFAULT_TOLERANCE;
use crate::range::error::Error;

/// The sine of an angle up to which two directions are one, but for rounding.
const ONE_LINE: f64 = 8.0 * f64::EPSILON;

/// How many of the moves lead along one line from the start, and its direction, the unit vector of the first of them
/// that leads anywhere.
///
/// ```
/// use stickslip_mechanics::rings::{PlanarMove, PlanarTarget, straight_moves};
///
/// let to = |x, y| PlanarMove { tangential: Some(PlanarTarget::Displacement([x, y])), ..PlanarMove::default() };
/// assert_eq!(straight_moves(&[to(3.0, 4.0), to(-6.0, -8.0), to(1.0, 0.0)]), (2, [0.6, 0.8]));
/// ```
#[must_use]
pub fn straight_moves(moves: &[PlanarMove]) -> (usize, [f64; 2]) {
    let mut direction: Option<Vector> = None;
    let mut on_line = |step: &PlanarMove| match step.tangential {
        None => true,
        Some(PlanarTarget::Arc(_)) => false,
        Some(PlanarTarget::Displacement([x, y]) | PlanarTarget::Force([x, y])) => {
            let size = x.hypot(y);
            if size <= 0.0 {
                return true;
            }
            let [along, across] = *direction.get_or_insert([x / size, y / size]);
            (x / size * across - y / size * along).abs() <= ONE_LINE
        }
    };
    let count = moves.iter().take_while(|step| on_line(step)).count();
    (count, direction.unwrap_or([1.0, 0.0]))
}

/// A move on the line of this direction as a move along it.
fn along(step: &PlanarMove, [x, y]: Vector) -> Move {
    let tangential = step.tangential.map(|target| match target {
        PlanarTarget::Displacement(to) => Tangential::Displacement(to[0] * x + to[1] * y),
        PlanarTarget::Force(to) => Tangential::Force(to[0] * x + to[1] * y),
        PlanarTarget::Arc(arc) => Tangential::Displacement(arc.at(1.0)[0] * x + arc.at(1.0)[1] * y),
    });
    Move { tangential, normal: step.normal, relative: step.relative, duration: 0.0 }
}

impl Scene<'_> {
    /// The solution with the exact states of the first moves, as far as they lead along one line.
    pub(super) fn with_exact(
        &self,
        mut solution: Solution,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Solution, Refusal> {
        let (_, direction, states) = self.exact(keep_going)?;
        solution.replace(&states, direction);
        Ok(solution)
    }

    /// The exact contact after the first moves, as far as they lead along one line, that line's direction, and the
    /// states after each of them.
    pub(super) fn exact(&self, keep_going: &dyn Fn() -> bool) -> Result<(Contact, Vector, Vec<State>), Refusal> {
        let (count, direction) = straight_moves(self.moves);
        let mut exact = self.contact.clone();
        let states = self.moves.iter().take(count).enumerate().map(|(index, step)| {
            let refused = |error| Refusal { index: Some(index), error };
            if !keep_going() {
                return Err(refused(Error::Interrupted));
            }
            exact.apply_while(&along(step, direction), DEFAULT_TOLERANCE, keep_going).map_err(refused)?;
            Ok(exact.state())
        });
        let states: Vec<_> = states.collect::<Result<_, _>>()?;
        Ok((exact, direction, states))
    }
}

impl Solution {
    /// A path along one line, by the exact contact after it and the states on the way: without rings.
    pub(super) fn along_line(scene: &Scene<'_>, contact: Contact, direction: Vector, states: &[State]) -> Solution {
        let errors = [contact.path_error(), 0.0];
        let states = states.iter().map(|state| planar(state, direction)).collect();
        let field = Field::along_line(scene, contact, direction);
        Solution { states, count: 0, steps: 0, work_error: errors[0], errors, field }
    }

    /// Puts the exact states of the first moves, along a line, in the place of those of the rings, and begins the work
    /// after them there.
    pub(super) fn replace(&mut self, exact: &[State], direction: Vector) {
        let mut ahead = 0.0;
        for (state, exact) in self.states.iter_mut().zip(exact) {
            ahead = exact.dissipated_energy - state.dissipated_energy;
            *state = planar(exact, direction);
        }
        for later in self.states.iter_mut().skip(exact.len()) {
            later.dissipated_energy += ahead;
            later.work += ahead;
        }
    }
}

/// A state along the line of this direction.
fn planar(exact: &State, direction: Vector) -> PlanarState {
    let pair = |size: f64| direction.map(|component| component * size + 0.0);
    PlanarState {
        displacement: pair(exact.displacement),
        force: pair(exact.force),
        indentation: exact.indentation,
        normal_force: exact.normal_force,
        contact_radius: exact.contact_radius,
        stick_radius: exact.stick_radius,
        regime: exact.regime,
        dissipated_energy: exact.dissipated_energy,
        elastic_energy: exact.elastic_energy,
        work: exact.dissipated_energy + exact.elastic_energy,
    }
}
