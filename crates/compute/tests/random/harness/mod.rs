//! What must hold for any bytes as the document of a simulation: shared by this program and `fuzz/`.

mod laws;
mod refusals;

use stickslip_compute::simulation::{Failure, cost, simulate};
use stickslip_compute::{Flag, Refusal};
use stickslip_wire::{Document as _, Profile, Rejection, SimulateReply, SimulateRequest, parse};

/// The largest estimated cost of a body that is run: each that is answered runs several times.
const MAX_COST: stickslip_compute::Nanoseconds = 30_000_000;

/// The fate of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It was answered, and all laws hold.
    Answered,
    /// It was refused as it should be.
    Refused,
    /// It is sound, but costs more than `MAX_COST`.
    TooExpensive,
}

/// Parses, checks and simulates a body.
///
/// # Panics
/// If a law does not hold.
pub fn examine(body: &[u8]) -> Outcome {
    let request = match parse::<SimulateRequest>(body) {
        Ok(request) => request,
        Err(rejection) => return refused(body, rejection.into()),
    };
    let simulation = match request.clone().check() {
        Ok(simulation) => simulation,
        Err(rejection) => return refused(body, rejection.into()),
    };
    // Curved moves leave a slip history whose length is not known beforehand, of which the search for extrema costs the
    // square; and where a load has no closed inverse, each of their many chords costs a search.
    let searched = matches!(
        request.contact.profile,
        Profile::Sum(_) | Profile::Tabulated(_) | Profile::Asperities(_) | Profile::LoadCurve(_)
    );
    let slow = simulation.plan.curved() > 0 && (simulation.residual || searched);
    if slow || cost::of_simulation(&simulation) > MAX_COST {
        return Outcome::TooExpensive;
    }
    match simulate(&simulation, &Flag::default()) {
        Ok(reply) => {
            laws::check(&request, &simulation, &reply);
            Outcome::Answered
        }
        Err(failure) => refused(body, failure.into()),
    }
}

/// Checks the refusal of a body.
pub fn refused(body: &[u8], refusal: Refusal) -> Outcome {
    refusals::check(body, refusal);
    Outcome::Refused
}

/// Checks and simulates a request as the service does.
fn run(request: &SimulateRequest) -> Result<SimulateReply, Unanswered> {
    let simulation = request.clone().check().map_err(Unanswered::Rejected)?;
    simulate(&simulation, &Flag::default()).map_err(Unanswered::Failed)
}

/// Why a variation of a sound request is refused: by its check, or by the solver.
#[derive(Debug)]
#[expect(dead_code, reason = "shown in full when a law is broken")]
enum Unanswered {
    Rejected(Rejection),
    Failed(Failure),
}
