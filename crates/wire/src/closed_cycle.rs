//! The reply of `/contacts/{id}/cycles`: the closed cycles of a contact's past.

use crate::prelude::*;

replies! {
/// A closed cycle: the displacement went from one turning point to the opposite one and came back. Smaller cycles
/// within it are cycles of their own.
pub struct Cycle {
    /// The number of the move after which the cycle began, at its first turning point.
    pub from: u64,
    /// The number of the move that closed the cycle.
    pub to: u64,
    /// Half the distance between its turning points, m.
    pub displacement_amplitude: f64,
    /// Amplitude of the tangential force, N.
    pub force_amplitude: f64,
    /// Friction work, J, without that of the cycles within it.
    pub dissipated_energy: f64,
    /// Force amplitude over displacement amplitude, N/m; `null` if it is too large for a number.
    pub secant_stiffness: Option<f64>,
    /// Displacement at zero force over the displacement amplitude, both measured from the middle of the loop, a pure
    /// number; `null` without friction, and if the cycle is not steady. A cycle is not steady if the load changed
    /// within it, or so shortly before it that the force does not return with the displacement; amplitude and work are
    /// then those of the recorded states.
    pub sliding_ratio: Option<f64>,
}

/// The newest closed cycles of a contact, oldest first.
pub struct CyclePage: Default {
    /// The cycles, in the order in which they closed; if one move closed several, the inner ones first.
    pub items: Vec<Cycle>,
}
}
