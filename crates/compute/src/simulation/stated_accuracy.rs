//! What a reply states about itself: its solver, its errors, and the time that it took.

use std::time::Duration;

use super::warnings::assumption;
use crate::prelude::*;
use crate::stop::processor_time;

/// The bound at the round-off of Dundurs' beta for similar bodies.
const BOUND_ROUND_OFF: f64 = 1e-24;

/// Measures the processor time of this thread for a request, with what its [`Stop`] has counted before.
#[derive(Clone, Copy)]
pub struct Timer<'a> {
    stop: &'a dyn Stop,
    begin: Duration,
}

impl Timer<'_> {
    /// Starts now.
    #[must_use]
    pub fn start(stop: &dyn Stop) -> Timer<'_> {
        Timer { stop, begin: processor_time() }
    }

    /// The time up to now.
    pub fn elapsed(&self) -> Duration {
        self.stop.flag().before() + processor_time().saturating_sub(self.begin)
    }
}

/// What the coupling of normal and tangential contact could add to the normal stiffness, relative, where Dundurs' beta
/// is not zero; none within for a contact whose bound is not known.
pub fn coupling_bound(contact: &Contact) -> Option<Option<f64>> {
    let bound = contact.elasticity().coupling_bound().filter(|bound| *bound > BOUND_ROUND_OFF)?;
    let profile = contact.profile();
    Some((profile.has_stress_field() && profile.line().is_none()).then_some(bound))
}

/// The solver that was used, its errors, and the time that it took.
pub fn accuracy<S: Solver>(solver: &S, timer: Timer<'_>, reason: &str) -> Accuracy {
    let estimate = solver.accuracy(&|| timer.stop.check().is_ok());
    let assumed = assumption(solver.exact().profile()).map(|(_, assumed)| format!("; {assumed}"));
    let (count, steps) = solver.exact().count_and_steps().unzip();
    Accuracy {
        solver: if count.is_some() { SolverKind::Springs } else { S::KIND },
        reason: format!("{reason}{}", assumed.unwrap_or_default()),
        force_error: estimate.force_error,
        stress_error: estimate.stress_error,
        coupling_bound: coupling_bound(solver.exact()),
        count,
        steps,
        compute_time: timer.elapsed().as_secs_f64(),
        ..Accuracy::default()
    }
}
