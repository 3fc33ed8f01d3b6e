//! The friction with which a contact is nearest to the newest of its closed cycles whose forces were measured.
//!
//! A cycle counts if all of its moves were measured under one load. Noise closes cycles too: those with few moves are
//! passed over, and so are those that are small beside others.

use std::collections::VecDeque;

use stickslip_mechanics::Contact;
use stickslip_mechanics::closed_cycles::ClosedCycle;

use super::loops::{Error, Known, LoopFit, Noise, Note, Parameter, Record, Start, Task, fit};

/// Moves that a cycle must have.
const MOVES: u64 = 8;
/// Newest cycles of so many moves that are compared; of less than half the largest amplitude are small ones.
const COMPARED: usize = 100;
/// Indentations are the same load if they agree to this part.
const SAME_LOAD: f64 = 1e-12;

/// The newest cycle that is not a small one; the last of `cycles` is the newest.
#[must_use]
pub fn newest_large(cycles: &VecDeque<ClosedCycle>) -> Option<&ClosedCycle> {
    let long = || cycles.iter().rev().filter(|cycle| cycle.to - cycle.from >= MOVES).take(COMPARED);
    let largest = long().map(|cycle| cycle.displacement_amplitude).fold(0.0, f64::max);
    long().find(|cycle| cycle.displacement_amplitude >= 0.5 * largest)
}

/// The measurements of a cycle, as far as they have been read.
#[derive(Clone, Debug, Default)]
pub struct MeasuredCycle {
    displacement: Vec<f64>,
    force: Vec<f64>,
    /// Indentation, m, and normal force, N.
    load: Option<(f64, f64)>,
}

impl MeasuredCycle {
    /// Adds a displacement, m, and the force, N, measured there, under a load: indentation, m, and normal force, N.
    /// Returns whether it is the load of those before.
    pub fn push(&mut self, displacement: f64, force: f64, load: (f64, f64)) -> bool {
        let (indentation, _) = *self.load.get_or_insert(load);
        self.displacement.push(displacement);
        self.force.push(force);
        (load.0 - indentation).abs() <= SAME_LOAD * indentation.abs()
    }

    /// The coefficient of friction with its 95 % interval, if the cycle determines it; `virgin` is the contact before
    /// its first move.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if `keep_going` has returned false.
    pub fn friction(self, virgin: Contact, keep_going: &dyn Fn() -> bool) -> Result<Option<(f64, [f64; 2])>, Error> {
        let MeasuredCycle { displacement, force, load } = self;
        let normal_force = load.map(|(_, normal_force)| normal_force);
        let record = Record { displacement, force, time: None, normal_force, start: Some(Start::Steady), weight: 1.0 };
        let stiff = Known { parameter: Parameter::MachineCompliance, value: 0.0, standard_error: 0.0 };
        let task = Task {
            contact: virgin,
            records: vec![record],
            free: vec![Parameter::Friction, Parameter::ForceOffset],
            known: vec![stiff],
            noise: Noise::default(),
        };
        match fit(&task, keep_going) {
            Ok(found) => Ok(determined(&found)),
            Err(Error::Interrupted) => Err(Error::Interrupted),
            Err(_) => Ok(None),
        }
    }
}

/// The friction of a fit with its interval, unless the contact does not slide as a whole or the interval is as wide as
/// that.
fn determined(found: &LoopFit) -> Option<(f64, [f64; 2])> {
    let friction = found.estimates.first()?;
    let [Some(low), Some(high)] = friction.interval else { return None };
    let slides = !found.notes.contains(&Note::PartialSlipOnly);
    (slides && !friction.at_bound && high - low <= friction.value).then_some((friction.value, [low, high]))
}

#[cfg(test)]
mod tests {
    use stickslip_mechanics::closed_cycles::{Answer, ClosedCycle};

    #[test]
    fn noise_and_what_was_long_ago_hide_no_cycle() {
        let newest_large = |cycles: &[(u64, u64, f64)]| {
            let answer = Answer::Steady { indentation: 1.0 };
            let cycle = |&(from, to, displacement_amplitude)| ClosedCycle { from, to, displacement_amplitude, answer };
            super::newest_large(&cycles.iter().map(cycle).collect()).map(|cycle| (cycle.from, cycle.to))
        };
        assert_eq!(newest_large(&[]), None);
        // Of few moves, or small beside others.
        assert_eq!(newest_large(&[(1, 4, 9.0)]), None);
        assert_eq!(newest_large(&[(1, 30, 1.0), (30, 60, 0.6), (45, 55, 0.2), (60, 63, 2.0)]), Some((30, 60)));
        // After a hundred smaller ones a larger one is forgotten.
        let later = |count: u64| (1..=count).map(|index| (30 * index, 30 * index + 30, 0.4));
        let cycles: Vec<_> = std::iter::once((1, 30, 1.0)).chain(later(99)).collect();
        assert_eq!(newest_large(&cycles), Some((1, 30)));
        let cycles: Vec<_> = std::iter::once((1, 30, 1.0)).chain(later(100)).collect();
        assert_eq!(newest_large(&cycles), Some((3_000, 3_030)));
    }
}
