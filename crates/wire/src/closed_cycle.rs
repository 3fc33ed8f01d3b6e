//! The reply of `/contacts/{id}/cycles`: the closed cycles of a contact's past.

use crate::request::replies;

replies! {
/// A closed cycle: the displacement went from one turning point to the opposite one and came back. Smaller cycles
/// within it are cycles of their own.
pub struct Cycle {
    /// The number of the move after which it began, at its first turning point.
    pub from: u64,
    /// The number of the move that closed it.
    pub to: u64,
    /// Half the distance of its turning points, m.
    pub displacement_amplitude: f64,
    /// Amplitude of the tangential force, N.
    pub force_amplitude: f64,
    /// Friction work, J, without that of the cycles within it.
    pub dissipated_energy: f64,
    /// Force amplitude over displacement amplitude, N/m; `null` beyond all numbers.
    pub secant_stiffness: Option<f64>,
    /// Displacement at zero force over the displacement amplitude, both from the middle of the loop, a pure number;
    /// `null` without friction, and if the cycle is not steady: the load changed within it, or so shortly before that
    /// the force does not come back with the displacement. Amplitude and work are then those of the recorded states.
    pub sliding_ratio: Option<f64>,
}

/// The newest closed cycles of a contact, oldest first.
pub struct CyclePage: Default {
    /// The cycles, in the order in which they closed; of those that one move closed the inner ones first.
    pub items: Vec<Cycle>,
}
}
