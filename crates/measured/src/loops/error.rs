//! Why loops cannot be fitted, in words of the bench.

use super::{FEWEST_POINTS, Parameter};

/// Why loops cannot be fitted; `record` counts from zero.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A record is too short, or its columns differ in length.
    #[error("a record needs {FEWEST_POINTS} points or more, with a displacement and a force each")]
    TooFewPoints {
        /// Which record.
        record: usize,
    },
    /// The displacement never turns.
    #[error("the displacement never turns back: a single branch cannot separate friction from stiffness")]
    SingleBranch {
        /// Which record.
        record: usize,
    },
    /// The force has no range.
    #[error("the force is the same at all points")]
    ConstantForce {
        /// Which record.
        record: usize,
    },
    /// The displacement has no range.
    #[error("the displacement is the same at all points")]
    ConstantDisplacement {
        /// Which record.
        record: usize,
    },
    /// The loop is run through against its sense.
    #[error(
        "the loop turns the wrong way: at the same displacement the force is {} N lower on the way up than on the way \
         down, so that friction would do work; are the columns swapped, or has one the wrong sign?",
        number(*difference)
    )]
    WrongWay {
        /// Which record.
        record: usize,
        /// By how much the force is lower, N.
        difference: f64,
    },
    /// The force is a magnitude.
    #[error(
        "the force looks rectified (its magnitude alone, as instruments log it beside the coefficient of friction): \
         it never changes its sign, and is the same whichever way the displacement goes. Give the signed force: \
         against the motion from each turn of the displacement to the next zero of the force, and with the motion \
         from there to the next turn"
    )]
    Rectified {
        /// Which record.
        record: usize,
    },
    /// The force is out of proportion to the load.
    #[error(
        "forces of {} N at a normal force of {} N would be a friction coefficient of {}: check the unit",
        number(*force), number(*normal_force), number(*force / *normal_force)
    )]
    ForceUnit {
        /// Which record.
        record: usize,
        /// Half the range of the force, N.
        force: f64,
        /// The normal force, N.
        normal_force: f64,
    },
    /// The stiffness is out of proportion to the contact.
    #[error(
        "just after a reversal the loop has a stiffness of {} N/m, but the contact one of {} N/m: check the units and \
         the contact",
        number(*measured), number(*expected)
    )]
    StiffnessUnit {
        /// Which record.
        record: usize,
        /// Of the data, N/m.
        measured: f64,
        /// Of the contact as defined, N/m.
        expected: f64,
    },
    /// A parameter that only times determine was asked for of a record without times.
    #[error("`{}` needs the times of the points", parameter.name())]
    NoTime {
        /// Which parameter.
        parameter: Parameter,
        /// Which record.
        record: usize,
    },
    /// No loop separates the two.
    #[error(
        "`{}` and `{}` cannot be separated: loops determine only `{combination}`, at any load; hold one of them, \
         or give it in `known` with its standard error",
        parameter.name(), with.name()
    )]
    Inseparable {
        /// The later of the two.
        parameter: Parameter,
        /// The earlier.
        with: Parameter,
        /// What is determined.
        combination: String,
    },
    /// The contact has no such parameter that could be fitted.
    #[error("`{}` cannot be fitted on this profile", parameter.name())]
    NotOfProfile {
        /// Which.
        parameter: Parameter,
    },
    /// The contact carries no tangential force.
    #[error(
        "a contact without friction or load has no loop: a friction coefficient and a normal force above zero are \
            needed"
    )]
    NoContact {
        /// Which record; none where it is the contact itself.
        record: Option<usize>,
    },
    /// The search found no minimum.
    #[error("no contact of this kind fits these loops, as the search does not converge: check `contact` and the units")]
    NoSolution,
    /// The mechanics refuses a load.
    #[error(transparent)]
    Refused(#[from] stickslip_mechanics::Error),
    /// The work was ended.
    #[error("stopped")]
    Interrupted,
}

/// A number with four significant digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}
