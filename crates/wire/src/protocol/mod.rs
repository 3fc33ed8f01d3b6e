//! The bodies of `POST /protocols` and `POST /contacts/{id}/relax`.

mod reply;

use serde::{Deserialize, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;
use uuid::Uuid;

use stickslip_mechanics::protocol::{AmplitudeLaw, PathEnd};
use stickslip_mechanics::range::{DISPLACEMENT, Quantity, Range};

use super::check::{Faults, JsonPath, Rejection};
use super::definition::{ContactDefinition, DefinedProfile, SharedSetup};
use super::document::Document;
use super::limits::{PROTOCOL_REVERSALS, limits};
use super::prepare::Prepare;
use super::simulate::Steps;
use super::single_key::{not_null, single_key};

pub use reply::{
    Comparison, DisplacementPath, FirstStroke, Gap, JudgedReply, Outcome, PressureUnit, ProtocolReply, RelaxReply,
    RobustnessReply, StartReply,
};

/// A contact, and how it is to be moved so that little shear stress remains. The number of reversals is given, or
/// follows from a target.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "reversals": 20,
    "kind": "minimax"
}))]
pub struct ProtocolRequest {
    /// The contact; may be left out where `start` names one on the server.
    pub contact: Option<ContactDefinition>,
    /// Number of reversals N_R; this or `target`.
    pub reversals: Option<usize>,
    /// The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
    /// infinite): the smallest number of reversals that reaches it is found.
    pub target: Option<f64>,
    /// The law of the amplitudes.
    #[serde(default)]
    pub kind: ProtocolKind,
    /// What the reversals begin from; left out, gross slip at its full amplitude.
    pub start: Option<ProtocolStart>,
    /// Where the path ends.
    #[serde(default)]
    pub end: ProtocolEnd,
    /// Ask what remains if the protocol is not followed exactly.
    pub robustness: Option<Robustness>,
}

/// How a contact on the server is to be relaxed; `reversals` or `target` is needed, all else has a default.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({"reversals": 20, "dry_run": true}))]
pub struct RelaxRequest {
    /// Number of reversals N_R, at the most; this or `target`. The path begins with a stroke more.
    pub reversals: Option<usize>,
    /// The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
    /// infinite): the smallest number of reversals that reaches it is found.
    pub target: Option<f64>,
    /// The law of the amplitudes.
    #[serde(default)]
    pub kind: ProtocolKind,
    /// Where the path ends.
    #[serde(default)]
    pub end: ProtocolEnd,
    /// Whether the path is only to be shown, and nothing changed. No reply of a dry run is kept for a retry.
    #[serde(default)]
    pub dry_run: bool,
    /// Ask for the states along the path.
    pub steps: Option<Steps>,
}

/// The law of the amplitudes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProtocolKind {
    /// They fall linearly (eq. 20 of the paper).
    Linear,
    /// They leave equal peaks on the profile of the contact, by steps proportional to x/g'(x).
    EqualPeaks,
    /// They minimise the largest stress that remains, as far as a search finds.
    #[default]
    Minimax,
}

/// What the reversals begin from, one key.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProtocolStart {
    /// This displacement of a contact that has never moved, m; the path begins with it.
    Displacement(f64),
    /// The present state of the contact of this identifier, whatever its history.
    ContactId(Uuid),
}
single_key!(ProtocolStart { "displacement" => Displacement, "contact_id" => ContactId });
limits!(enum ProtocolStart { Displacement "displacement": DISPLACEMENT });

/// Where a path ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProtocolEnd {
    /// At displacement zero.
    #[default]
    DisplacementZero,
    /// Without a tangential force.
    ForceZero,
    /// Wherever the least stress remains.
    Free,
}

/// Errors with which a protocol is followed: it is tried many times, each with errors of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({"amplitude_error": 0.01, "friction_error": 0.05, "samples": 100, "seed": 1}))]
pub struct Robustness {
    /// Standard deviation of each displacement, relative to itself, a pure number; normally distributed.
    #[serde(default)]
    pub amplitude_error: f64,
    /// The fraction that the coefficient of friction may be off either way, a pure number; evenly distributed. Not for
    /// a start from a contact on the server, whose history belongs to its own coefficient.
    #[serde(default)]
    pub friction_error: f64,
    /// How many times it is tried.
    #[serde(default = "samples")]
    pub samples: usize,
    /// Where the sequence of random numbers begins: the same seed gives the same reply.
    #[serde(default)]
    pub seed: u64,
}
limits!(Robustness {
    amplitude_error: Range { quantity: Quantity::AmplitudeError, unit: "", min: 0.0, max: 1.0 },
    friction_error: Range { quantity: Quantity::FrictionError, unit: "", min: 0.0, max: 0.9 },
    samples: 2..=10_000_usize,
    // Integers that every JSON parser reads exactly.
    seed: 0..=0x1f_ffff_ffff_ffff_u64,
});

/// How many times a protocol is tried with errors by default.
fn samples() -> usize {
    200
}

/// A number of reversals, or what they are to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// This many reversals.
    Reversals(usize),
    /// The fewest that leave at most this stress, over the unit of stress.
    Target(f64),
}

/// The members by which a protocol and a relaxation name their aim; exactly one of the two is given.
struct AimMembers {
    reversals: Option<usize>,
    target: Option<f64>,
}
limits!(AimMembers {
    reversals: PROTOCOL_REVERSALS,
    target: Range { quantity: Quantity::ProtocolTarget, unit: "", min: 1e-4, max: 10.0 },
});
limits!(ProtocolRequest and AimMembers);
limits!(RelaxRequest and AimMembers);

impl AimMembers {
    fn check(&self, faults: &mut Faults) -> Option<Aim> {
        let at = JsonPath::Root;
        let aim = match (self.reversals, self.target) {
            (Some(reversals), None) => Aim::Reversals(reversals),
            (None, Some(target)) => Aim::Target(target),
            (None, None) => {
                faults.add(at.member("reversals"), "missing: name `reversals` or `target`");
                return None;
            }
            (Some(_), Some(_)) => {
                faults.add(at.member("target"), "conflicts with `reversals`: one of the two is allowed");
                return None;
            }
        };
        self.check_members(at, faults);
        Some(aim)
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

    fn check_with(self, profiles: &dyn Prepare) -> Result<Self::Checked, Rejection> {
        let mut faults = Faults::default();
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.as_ref().and_then(|contact| contact.check(at("contact"), profiles, &mut faults));
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
                faults.add(
                    at("contact"),
                    "missing: it may be left out only where `start` names a contact by `contact_id`",
                );
                None
            }
            (start, Some(definition), setup) => {
                let first = start.and_then(|start| start.check(at("start"), &mut faults));
                setup.map(|setup| ProtocolSubject::Virgin(Box::new((definition, setup)), first))
            }
        };
        let aim = AimMembers { reversals: self.reversals, target: self.target }.check(&mut faults);
        if let Some(robustness) = &self.robustness {
            robustness.check_members(at("robustness"), &mut faults);
        }
        let task = aim.map(|aim| ProtocolTask { aim, kind: self.kind, end: self.end, robustness: self.robustness });
        faults.done(subject.zip(task))
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

    fn check_with(self, _: &dyn Prepare) -> Result<Relaxation, Rejection> {
        let mut faults = Faults::default();
        let aim = AimMembers { reversals: self.reversals, target: self.target }.check(&mut faults);
        let task = aim.map(|aim| ProtocolTask { aim, kind: self.kind, end: self.end, robustness: None });
        faults.done(task.map(|task| Relaxation { task, dry_run: self.dry_run, steps: self.steps }))
    }
}

impl ProtocolStart {
    /// The displacement to begin with, if it is one.
    fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<f64> {
        let ProtocolStart::Displacement(first) = *self else { return None };
        self.check_members(at, faults);
        if first.abs() <= 0.0 {
            faults.add(at.member("displacement"), "must not be 0: allowed is any other displacement");
        }
        Some(first)
    }
}

impl From<ProtocolKind> for AmplitudeLaw {
    fn from(kind: ProtocolKind) -> AmplitudeLaw {
        match kind {
            ProtocolKind::Linear => AmplitudeLaw::Linear,
            ProtocolKind::EqualPeaks => AmplitudeLaw::EqualPeaks,
            ProtocolKind::Minimax => AmplitudeLaw::Minimax,
        }
    }
}

impl From<ProtocolEnd> for PathEnd {
    fn from(end: ProtocolEnd) -> PathEnd {
        match end {
            ProtocolEnd::DisplacementZero => PathEnd::DisplacementZero,
            ProtocolEnd::ForceZero => PathEnd::ForceZero,
            ProtocolEnd::Free => PathEnd::Free,
        }
    }
}
