//! Moves of a contact, and what a reply says of them: the same for contacts on a server and in a process of their own.

use std::time::{Duration, Instant};

use stickslip_mechanics::DEFAULT_TOLERANCE;
use stickslip_wire::ProtocolReply;
use stickslip_wire::protocol::Relaxation;
use stickslip_wire::session::Advance;

use super::find_from_state;
use crate::computations::prelude::*;
use crate::simulation::{FarMove, annulus_warning, equal_peaks, follow, new_warnings, reason_for, stresses};

/// The reason for the exact solver on a contact with a history.
const REASON: &str = "stored contacts use the exact solver";

/// The result of moves besides the states after them.
pub struct Moved {
    /// The stresses at the end, if they are asked for.
    pub stress: Option<Stress>,
    /// The path, if it follows the law of equal peaks.
    pub protocol: Option<Protocol>,
    /// The protocol that has been found and followed, if the contact was to be relaxed.
    pub relaxed: Option<ProtocolReply>,
    /// Errors and time.
    pub accuracy: Accuracy,
    /// Warnings that earlier replies have not given.
    pub warnings: Vec<Warning>,
    /// How long the moves themselves took.
    pub followed_in: Duration,
}

/// Makes moves, and shows each with the state after it to `each`.
///
/// # Errors
/// [`Failure`] at the first move without an answer; the moves before it have been made.
pub fn make_moves(
    contact: &mut Contact,
    advance: &Advance,
    stop: &dyn Stop,
    mut each: impl FnMut(Move, State),
) -> Result<Moved, Failure> {
    let timer = Timer::start(stop);
    let tolerance = advance.tolerance;
    if advance.relax.is_some() || matches!(advance.plan, Plan::EqualPeaks(_)) {
        contact.check_coulomb("a protocol").map_err(|error| Failure::at("", error))?;
    }
    if let Plan::Observations(_) = advance.plan {
        contact.check_elastic("the friction of observations").map_err(|error| Failure::at("", error))?;
    }
    let relaxed = advance.relax.map(|relax| find_from_state(contact, &relax.task, stop)).transpose()?;
    let plan = relaxed.as_ref().map(|found| Plan::Displacement(found.path.displacement.clone()));
    let plan = plan.as_ref().unwrap_or(&advance.plan);
    let protocol = equal_peaks(plan, contact)?;
    let (before, error_before) = (contact.contact_radius(), contact.path_error());
    let (mut largest, mut error, mut path_error) = (before, 0.0f64, 0.0f64);
    let (mut far, beyond) = (FarMove::from(contact), contact.beyond_annulus());
    let begin = Instant::now();
    let followed = follow(contact, plan, protocol.as_ref(), tolerance, stop, |step, contact| {
        largest = largest.max(contact.contact_radius());
        error = error.max(contact.path_error() - error_before);
        if advance.steps == Steps::All {
            path_error = path_error.max(contact.path_error());
        }
        far.reach(contact);
        each(step, contact.state().into());
    });
    followed.map_err(|failure| if advance.relax.is_some() { without_step(failure) } else { failure })?;
    let followed_in = begin.elapsed();
    let stress = advance.stress.as_ref().map(|sampling| stresses(contact, sampling, stop)).transpose()?;
    let mut accuracy = accuracy(contact, timer, reason_for(contact, REASON));
    // Gross slip erases the error of a curved path, but not that of the states before it.
    accuracy.force_error += path_error.max(contact.path_error()) - contact.path_error();
    let of_springs = excess_error_of_springs(contact, accuracy.force_error, advance.asked_tolerance);
    let excess = excess_error(error, contact.tolerance(tolerance), advance.plan.curved()).or(of_springs);
    let mut warnings = new_warnings(contact, before, largest, excess);
    warnings.extend(far.warning().into_iter().chain(annulus_warning(beyond, contact)));
    Ok(Moved { stress, protocol, relaxed, accuracy, warnings, followed_in })
}

/// The states that a reply shows of those after each move; `end` is the one at the end.
pub fn shown_states(steps: Steps, all: impl Iterator<Item = State>, end: State) -> Vec<State> {
    match steps {
        Steps::All => all.collect(),
        Steps::Last => vec![end],
    }
}

/// The protocol that would relax a contact, and the states along it if they are asked for; the contact is consumed.
///
/// # Errors
/// [`Failure`] if no protocol reaches the target, or the work was stopped.
pub fn dry_run_relax(
    mut contact: Contact,
    relaxation: &Relaxation,
    stop: &dyn Stop,
) -> Result<(Option<Vec<State>>, ProtocolReply), Failure> {
    contact.check_coulomb("a protocol").map_err(|error| Failure::at("", error))?;
    let protocol = find_from_state(&contact, &relaxation.task, stop)?;
    let plan = Plan::Displacement(protocol.path.displacement.clone());
    let Some(steps) = relaxation.steps else { return Ok((None, protocol)) };
    let mut states = Vec::new();
    follow(&mut contact, &plan, None, DEFAULT_TOLERANCE, stop, |_, contact| states.push(contact.state().into()))
        .map_err(without_step)?;
    Ok((Some(shown_states(steps, states.into_iter(), contact.state().into())), protocol))
}

/// The failure of a move that the client did not send itself.
fn without_step(failure: Failure) -> Failure {
    let pointer = if matches!(failure.cause, Cause::Interrupted(_)) { "/reversals" } else { "" };
    Failure::at(pointer, failure.cause)
}
