//! Where a move is on its way, so that the way can be drawn.

use super::contact::Contact;
use super::double_double::DoubleDouble;
use super::slip_history::Memory;
use super::state::{Move, Normal, Tangential};

impl Contact {
    /// The same contact at its preload, before its first move.
    #[must_use]
    pub fn anew(&self) -> Contact {
        Contact {
            profile: self.profile.clone(),
            elasticity: self.elasticity,
            friction: self.friction,
            memory: Memory::new(&self.profile, DoubleDouble::from(self.initial.indentation)),
            displacement: DoubleDouble::ZERO,
            normal_force: self.initial.normal_force,
            dissipated: DoubleDouble::ZERO,
            initial: self.initial,
            path_error: 0.0,
            path_kernel: 0.0,
            inverse_scale: self.inverse_scale,
        }
    }

    /// The move, with targets that are absolute, that goes from here as far as `part` of the way of `step`; `part` is between
    /// 0 and 1. What is straight in `step` is so in the shorter move: following one such move after the other leads along the
    /// same line.
    #[must_use]
    pub fn waypoint(&self, step: &Move, part: f64) -> Move {
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

    /// Coulomb's coefficient of friction mu.
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }
}
