//! From a checked path to the moves that a contact makes.

use stickslip_mechanics::protocol;
use stickslip_wire::{Move, Plan, Protocol};

use super::{Failure, Solver, quantity};

/// The displacements of a plan that follows the law of equal peaks, for the contact in its present state.
///
/// # Errors
/// [`Failure::Refused`] for a cut-off radius that the contact does not allow.
pub fn equal_peaks<S: Solver>(plan: &Plan, solver: &S) -> Result<Option<Protocol>, Failure> {
    let Plan::EqualPeaks(peaks) = plan else { return Ok(None) };
    let protocol::EqualPeaks { displacements, cutoff_radius } =
        protocol::equal_peaks(solver.exact(), peaks.reversals, peaks.cutoff_radius)
            .map_err(|error| Failure::Refused { pointer: plan.place_of(0, quantity(&error)), error })?;
    Ok(Some(Protocol { displacement: displacements, cutoff_radius }))
}

/// The moves of a plan. `gross_slip` is the displacement of gross slip, m, of the contact that will follow them, and
/// `protocol` the result of [`equal_peaks`] for it.
pub(super) fn moves<'a>(
    plan: &'a Plan,
    gross_slip: f64,
    protocol: Option<&'a Protocol>,
) -> Box<dyn Iterator<Item = Move> + Send + 'a> {
    match plan {
        Plan::Moves(moves) => Box::new(moves.iter().copied()),
        Plan::Displacement(targets) => Box::new(targets.iter().map(|target| Move::displacement(*target))),
        Plan::Force(targets) => Box::new(targets.iter().map(|target| Move::force(*target))),
        Plan::FallingAmplitude(fall) => {
            let amplitude = fall.amplitude.unwrap_or(gross_slip);
            Box::new(protocol::falling_amplitude(fall.reversals, amplitude).map(Move::displacement))
        }
        Plan::EqualPeaks(_) => {
            let displacements = protocol.into_iter().flat_map(|protocol| &protocol.displacement);
            Box::new(displacements.copied().map(Move::displacement))
        }
        Plan::Single(step) => Box::new(std::iter::once(*step)),
    }
}
