//! The bodies of `POST /protocols` and `POST /contacts/{id}/relax`.

mod reply;

use stickslip_mechanics::protocol::{AmplitudeLaw, PathEnd};
use stickslip_mechanics::range::DISPLACEMENT;

use crate::limits::PROTOCOL_REVERSALS;
use crate::prelude::*;

pub use reply::{
    Comparison, DisplacementPath, FirstStroke, Gap, JudgedReply, Outcome, PressureUnit, ProtocolReply, RelaxReply,
    RobustnessReply, StartReply,
};

/// The largest stress that may remain, over the unit of stress.
const TARGET: Range = Range { quantity: Quantity::ProtocolTarget, unit: "", min: 1e-4, max: 10.0 };

requests! {
/// A contact, and how it is to be moved so that little shear stress remains. The number of reversals is given, or
/// follows from a target.
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "reversals": 20,
    "kind": "minimax"
}))]
pub struct ProtocolRequest {
    /// The contact; may be left out where `start` names one on the server.
    pub contact: Option<ContactDefinition>,
    /// Number of reversals N; give this or `target`.
    pub reversals: Option<usize> = PROTOCOL_REVERSALS,
    /// The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
    /// infinite): the smallest number of reversals that reaches it is found.
    pub target: Option<f64> = TARGET,
    /// The law of the amplitudes.
    #[serde(default)]
    pub kind: ProtocolKind,
    /// The state that the reversals begin from; if left out, gross slip at its full amplitude.
    pub start: Option<ProtocolStart>,
    /// Where the path ends.
    #[serde(default)]
    pub end: ProtocolEnd,
    /// Ask for the stress that remains if the protocol is not followed exactly.
    pub robustness: Option<Robustness>,
}

/// How a contact on the server is to be relaxed; `reversals` or `target` is needed, everything else has a default.
#[schema(example = json!({"reversals": 20, "dry_run": true}))]
pub struct RelaxRequest {
    /// Largest number of reversals N; give this or `target`. The path begins with one more stroke.
    pub reversals: Option<usize> = PROTOCOL_REVERSALS,
    /// The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
    /// infinite): the smallest number of reversals that reaches it is found.
    pub target: Option<f64> = TARGET,
    /// The law of the amplitudes.
    #[serde(default)]
    pub kind: ProtocolKind,
    /// Where the path ends.
    #[serde(default)]
    pub end: ProtocolEnd,
    /// Whether to compute the path without applying it. The reply of a dry run is not kept for a retry.
    #[serde(default)]
    pub dry_run: bool,
    /// Ask for the states along the path.
    pub steps: Option<Steps>,
}

/// Errors with which a protocol is followed. It is tried many times, each time with different random errors.
#[schema(example = json!({"amplitude_error": 0.01, "friction_error": 0.05, "samples": 100, "seed": 1}))]
pub struct Robustness: Copy {
    /// Standard deviation of each displacement, relative to itself, a pure number; normally distributed.
    #[serde(default)]
    pub amplitude_error: f64 = Range { quantity: Quantity::AmplitudeError, unit: "", min: 0.0, max: 1.0 },
    /// Largest relative error of the coefficient of friction, up or down, a pure number; uniformly distributed. Not for
    /// a start from a contact on the server, whose history belongs to its own coefficient.
    #[serde(default)]
    pub friction_error: f64 = Range { quantity: Quantity::FrictionError, unit: "", min: 0.0, max: 0.9 },
    /// Number of trials.
    #[serde(default = "samples")]
    pub samples: usize = 2..=10_000_usize,
    /// Seed of the random numbers: the same seed gives the same reply.
    #[serde(default)]
    // Integers that every JSON parser reads exactly.
    pub seed: u64 = 0..=0x1f_ffff_ffff_ffff_u64,
}
}

words! {
/// The law of the amplitudes.
pub enum ProtocolKind: Default of AmplitudeLaw {
    /// The amplitudes fall linearly (eq. 20 of the paper).
    Linear = "linear",
    /// The amplitudes leave equal peaks on the profile of the contact, by steps proportional to x/g'(x).
    EqualPeaks = "equal_peaks",
    /// The amplitudes minimise the largest stress that remains, as far as a search finds.
    #[default]
    Minimax = "minimax",
}
}

choices! {
/// The state that the reversals begin from, one key.
pub enum ProtocolStart {
    /// This displacement of a contact that has never moved, m; the path begins with it.
    "displacement" => Displacement(f64) = DISPLACEMENT,
    /// The present state of the contact of this identifier, whatever its history.
    "contact_id" => ContactId(Uuid),
}
}

words! {
/// Where a path ends.
pub enum ProtocolEnd: Default of PathEnd {
    /// At displacement zero.
    #[default]
    DisplacementZero = "displacement_zero",
    /// Without a tangential force.
    ForceZero = "force_zero",
    /// Wherever the least stress remains.
    Free = "free",
}
}

/// How many times a protocol is tried with errors by default.
fn samples() -> usize {
    200
}

/// A number of reversals, or the target that they must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// This many reversals.
    Reversals(usize),
    /// The fewest that leave at most this stress, over the unit of stress.
    Target(f64),
}

/// The aim that a protocol or a relaxation names; exactly one of the two is given.
fn aim(reversals: Option<usize>, target: Option<f64>, faults: &mut Faults) -> Option<Aim> {
    let (at_reversals, at_target) = (JsonPath::Root.member("reversals"), JsonPath::Root.member("target"));
    match (reversals, target) {
        (Some(reversals), None) => Some(Aim::Reversals(reversals)),
        (None, Some(target)) => Some(Aim::Target(target)),
        (None, None) => faults.refuse(at_reversals, "missing: name `reversals` or `target`"),
        (Some(_), Some(_)) => faults.refuse(at_target, "conflicts with `reversals`: one of the two is allowed"),
    }
}

/// The checked options of a protocol.
#[derive(Clone, Copy, Debug)]
pub struct ProtocolTask {
    /// How many reversals.
    pub aim: Aim,
    /// The law.
    pub kind: ProtocolKind,
    /// The end.
    pub end: ProtocolEnd,
    /// The errors for the estimate of robustness.
    pub robustness: Option<Robustness>,
}

/// The checked contact of a protocol.
#[derive(Clone, Debug)]
pub enum ProtocolSubject {
    /// One that has never moved, and the displacement to begin with.
    Virgin(Box<(ContactDefinition, SharedSetup)>, Option<f64>),
    /// One on the server, with the definition in the request, if there is one.
    Living(Uuid, Option<Box<ContactDefinition>>),
}

impl Document for ProtocolRequest {
    type Checked = (ProtocolSubject, ProtocolTask);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        self.contact.as_ref().map(|contact| contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.as_ref().and_then(|contact| contact.check(at("contact"), profiles, faults));
        // Protocols are judged by the stress that they leave.
        faults.needs_stress_field(setup.as_ref(), at("contact").member("profile"));
        let subject = match (self.start, self.contact, setup) {
            (Some(ProtocolStart::ContactId(id)), definition, _) => {
                if self.robustness.is_some_and(|robustness| robustness.friction_error > 0.0) {
                    let detail = "not for a stored contact: its history belongs to its own coefficient of friction";
                    faults.add(at("robustness").member("friction_error"), detail);
                }
                Some(ProtocolSubject::Living(id, definition.map(Box::new)))
            }
            (_, None, _) => {
                let detail = "missing: it may be left out only where `start` names a contact by `contact_id`";
                faults.refuse(at("contact"), detail)
            }
            (start, Some(definition), setup) => {
                let first = start.and_then(|start| start.check(at("start"), faults));
                setup.map(|setup| ProtocolSubject::Virgin(Box::new((definition, setup)), first))
            }
        };
        let aim = aim(self.reversals, self.target, faults);
        let task = aim.map(|aim| ProtocolTask { aim, kind: self.kind, end: self.end, robustness: self.robustness });
        subject.zip(task)
    }
}

/// The checked options of a relaxation.
#[derive(Clone, Copy, Debug)]
pub struct Relaxation {
    /// The protocol.
    pub task: ProtocolTask,
    /// Whether it is a dry run.
    pub dry_run: bool,
    /// Which states are requested.
    pub steps: Option<Steps>,
}

impl Document for RelaxRequest {
    type Checked = Relaxation;

    fn checked(self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let aim = aim(self.reversals, self.target, faults);
        let task = aim.map(|aim| ProtocolTask { aim, kind: self.kind, end: self.end, robustness: None });
        task.map(|task| Relaxation { task, dry_run: self.dry_run, steps: self.steps })
    }
}

impl ProtocolStart {
    /// The displacement to begin with, if it is one.
    fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<f64> {
        let ProtocolStart::Displacement(first) = *self else { return None };
        if first.abs() <= 0.0 {
            faults.add(at.member("displacement"), "must not be 0: allowed is any other displacement");
        }
        Some(first)
    }
}
