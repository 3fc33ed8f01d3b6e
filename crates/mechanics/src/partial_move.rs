//! Where a move is on its way, so that the way can be drawn.

use super::contact::Contact;
use super::state::{Move, Normal, Tangential};

impl Contact {
    /// The move, with targets that are absolute, that goes from here as far as `part` of the way of `step`; `part` is between
    /// 0 and 1. What is straight in `step` is so in the shorter move: following one such move after the other leads along the
    /// same line.
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
