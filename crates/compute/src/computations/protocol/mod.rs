//! `protocol`: paths that leave little shear stress.

mod design;

use stickslip_mechanics::range;
use stickslip_wire::protocol::{Aim, ProtocolSubject, ProtocolTask};
use stickslip_wire::{ProtocolReply, ProtocolRequest};

use super::OfStored;
use crate::computations::prelude::*;
use crate::simulation::bytes::of_records;
use crate::simulation::cost::MOVE_COST;
use design::{Subject, protocol};

/// One pair of kinks of a protocol on a sphere, over all evaluations and all three laws.
const KINK_PAIR_COST: u64 = 10_000;
/// The same on a table, over that on a sphere; other shapes are within a half of it.
const TABLE: u64 = 50;
/// The least that a protocol costs.
const PROTOCOL_COST: u64 = 200_000;
/// Reversals that a target is assumed to need.
const ASSUMED_REVERSALS: usize = 100;

/// A path of few reversals that leaves little shear stress.
pub struct FindProtocol;

impl Computation for FindProtocol {
    const ABOUT: About = About {
        name: "protocol",
        route: Some(Route { path: "/protocols", operation: "find_protocol", tag: "protocols" }),
        title: "Find a protocol",
        description: "Finds displacements that leave little shear stress, in a given number of reversals or in the \
                      fewest that reach a target. States the stress that remains, how far it may be from the optimum, \
                      and the stress that the other laws would leave. Nothing is stored or changed.",
        reply: "The path, and the stress that remains",
        ..About::DOCUMENT
    };

    const TAKES_STORED: bool = true;

    type Request = ProtocolRequest;
    type Outcome = ProtocolReply;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "best",
                "The least that 20 reversals can leave on a sphere",
                json!({
                    "contact": ContactDefinition::example(),
                    "reversals": 20, "kind": "minimax", "end": "free"
                }),
            ),
            example(
                "target",
                "The fewest reversals that leave a quarter, and how robust they are with a coarse actuator",
                json!({
                    "contact": example_contact(
                        json!({"type": "power_law", "exponent": 3.0, "coefficient": 1e4}),
                        json!({"normal_force": 10.0})
                    ),
                    "target": 0.25, "kind": "equal_peaks",
                    "robustness": {"amplitude_error": 0.01, "friction_error": 0.05, "samples": 100, "seed": 1}
                }),
            ),
        ]
    }

    fn bytes((subject, task): &Task<Self>) -> usize {
        let shape = match subject {
            ProtocolSubject::Virgin(made, _) => of_shape(&made.0.profile),
            ProtocolSubject::Living(..) => 0,
        };
        task.bytes() + shape
    }

    fn cost((subject, task): &Task<Self>) -> Nanoseconds {
        match subject {
            ProtocolSubject::Virgin(made, _) => task.cost(&made.1.profile, 0),
            ProtocolSubject::Living(..) => 0,
        }
    }

    fn run((subject, task): Task<Self>, stop: &dyn Stop) -> Result<ProtocolReply, Failure> {
        let ProtocolSubject::Virgin(made, first) = subject else {
            return Err(Failure::at("/start/contact_id", Cause::NeedsServer));
        };
        let setup = &made.1;
        let contact = &contact(setup.clone(), "/contact")?;
        let full = contact.gross_slip_displacement();
        if first.is_none() {
            // What the request does not have cannot be at fault: the contact is.
            range::DISPLACEMENT.check(full).map_err(|error| Failure::at("/contact", error))?;
        }
        protocol(&Subject { contact, first: first.or(Some(full)), setup: Some(setup) }, &task, stop)
    }

    fn stored((subject, task): Task<Self>) -> Result<OfStored, Task<Self>> {
        match subject {
            ProtocolSubject::Living(id, definition) => {
                Ok((id, definition.map(|definition| *definition), Box::new(task)))
            }
            virgin @ ProtocolSubject::Virgin(..) => Err((virgin, task)),
        }
    }
}

impl OnContact for ProtocolTask {
    type Outcome = ProtocolReply;

    /// With its reply and, on a contact, its moves.
    fn bytes(&self) -> usize {
        let most = reversals(self, *limits::PROTOCOL_REVERSALS.end());
        let tried = self.robustness.map_or(0, |robustness| robustness.samples);
        // A reversal in a reply: its displacement, a peak for each of three laws, and a state.
        (most + 2) * (2 * OBJECT + ROW) + of_records(most + 2) + tried * NUMBER
    }

    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds {
        let reversals = reversals(self, ASSUMED_REVERSALS);
        let tried = self.robustness.map_or(0, |robustness| robustness.samples as u64);
        let once = Work { moves: reversals + 1, residual: true, ..Work::default() };
        let once = MOVE_COST.saturating_mul(once.moves as u64).saturating_add(once.stresses());
        let pairs = (reversals * (reversals + depth.min(ASSUMED_REVERSALS))) as u64;
        let searched = (pairs * KINK_PAIR_COST).saturating_mul(relative_cost(profile));
        on_profile(profile, PROTOCOL_COST + 3 * tried.saturating_mul(once), true).saturating_add(searched)
    }

    fn run(self, contact: Contact, _: u64, stop: &dyn Stop) -> Result<ProtocolReply, Failure> {
        find_from_state(&contact, &self, stop)
    }
}

impl Outcome for ProtocolReply {
    type Reply = ProtocolReply;
}

/// The protocol that begins from the present state of a contact.
///
/// # Errors
/// [`Cause::Lifted`] if it does not touch, or as the search on a new contact.
pub fn find_from_state(contact: &Contact, task: &ProtocolTask, stop: &dyn Stop) -> Result<ProtocolReply, Failure> {
    if contact.contact_radius() <= 0.0 {
        return Err(Failure::at("", Cause::Lifted));
    }
    protocol(&Subject { contact, first: None, setup: None }, task, stop)
}

/// What a search costs on a profile over that on a sphere.
fn relative_cost(profile: &Profile) -> u64 {
    match profile {
        Profile::Tabulated(_) => TABLE,
        Profile::Sum(sum) => sum.parts().iter().map(relative_cost).sum(),
        Profile::Sphere(_) => 1,
        _ => 2,
    }
}

/// Reversals that a protocol has at the most.
fn reversals(task: &ProtocolTask, sought: usize) -> usize {
    match task.aim {
        Aim::Reversals(reversals) => reversals,
        Aim::Target(_) => sought,
    }
}
