//! What must hold for any bytes whatever that come as the body of `POST /simulate`: shared by `tests/fuzz.rs` and `fuzz/`.

mod balance;
mod laws;
mod refusals;

use stickslip::admission::Stop;
use stickslip::simulation::{Failure, cost, simulate};
use stickslip_wire::{Document as _, Profile, Rejection, SimulateReply, SimulateRequest, parse};

/// What a body may cost to be tried, estimated nanoseconds: each that is answered runs several times.
const DEAREST: stickslip::admission::Nanoseconds = 30_000_000;

/// What came of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It was answered, and all laws hold.
    Answered,
    /// It was refused as it should be.
    Refused,
    /// It is sound, but asks for more work than there is time for.
    Dear,
}

/// Sends a body through both gates and the engine.
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
    // Curved moves leave a memory that is not known beforehand, of which the search for extrema costs the square; and where a
    // load has no closed inverse, each of their many chords costs a search.
    let searched = matches!(request.contact.profile, Profile::Sum(_) | Profile::Tabulated(_));
    let slow = simulation.plan.curved() > 0 && (simulation.residual || searched);
    if slow || cost::of_simulation(&simulation) > DEAREST {
        return Outcome::Dear;
    }
    let (stop, _guard) = Stop::guarded();
    match simulate(&simulation, &stop) {
        Ok(reply) => {
            laws::check(&request, &simulation, &reply);
            Outcome::Answered
        }
        Err(failure) => refused(body, failure.into()),
    }
}

fn refused(body: &[u8], problem: stickslip::api::Problem) -> Outcome {
    refusals::check(body, problem);
    Outcome::Refused
}

/// Asks the engine the way that the service does.
fn ask(request: &SimulateRequest) -> Result<SimulateReply, Refusal> {
    let simulation = request.clone().check().map_err(Refusal::AtTheGate)?;
    let (stop, _guard) = Stop::guarded();
    simulate(&simulation, &stop).map_err(Refusal::ByTheEngine)
}

/// Why a variation of a sound request is refused.
#[derive(Debug)]
#[expect(dead_code, reason = "shown in full when a law is broken")]
enum Refusal {
    AtTheGate(Rejection),
    ByTheEngine(Failure),
}
