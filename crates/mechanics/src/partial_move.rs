//! The first part of a move, so that its path can be drawn point by point.

use super::contact::Contact;
use super::state::{Move, Normal, Tangential};

impl Contact {
    /// The move, with absolute targets, to the fraction `part` (0 to 1) of `step`. It is straight in the same
    /// quantities: a sequence of such moves with rising fractions follows the same line.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// let half = contact.partial_move(&slide(0.002), 0.5);
    /// assert_eq!(half.tangential, Some(Tangential::Displacement(0.001)));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn partial_move(&self, step: &Move, part: f64) -> Move {
        let towards = |from: f64, target: f64| from + part * if step.relative { target } else { target - from };
        Move {
            tangential: step.tangential.map(|target| match target {
                Tangential::Displacement(to) => Tangential::Displacement(towards(self.displacement.value(), to)),
                Tangential::Force(to) => Tangential::Force(towards(self.force(), to)),
            }),
            normal: step.normal.map(|target| match target {
                Normal::Indentation(to) => Normal::Indentation(towards(self.indentation(), to)),
                Normal::NormalForce(to) => Normal::NormalForce(towards(self.normal_force(), to)),
            }),
            relative: false,
        }
    }
}
