//! The bodies and replies of `/contacts`: contacts that the server keeps.

use super::definition::{Adhesion, PRONY_TERMS, PronyTerm};
use super::document::checked_alone;
use super::limits::Characters;
use super::line_profiles::BulkPerForce;
use super::path::TimedPath;
use super::protocol::Relaxation;
use crate::prelude::*;

/// The text by which a client identifies a contact.
pub const LABEL: Characters = Characters(200);
/// The number of a move.
const SEQUENCE: RangeInclusive<u64> = 0..=i64::MAX as u64;

requests! {
/// A contact definition, with an optional label.
#[schema(example = json!({
    "label": "steel ball",
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {"bodies": [
        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
    ]},
    "friction": 0.3,
    "preload": {"normal_force": 10.0}
}))]
pub struct CreateRequest {
    /// A label of your own.
    pub label: Option<String> = LABEL,
    /// The shape of the indenter.
    pub profile: Profile,
    /// The elastic constants.
    pub material: Material,
    /// Coulomb's coefficient of friction μ, a pure number.
    pub friction: f64 = range::FRICTION,
    /// Shear strength τ₀ of the interface, Pa: shear stress stays below τ₀ + μp. Zero if left out; otherwise the load
    /// must stay constant from the first tangential move on.
    pub shear_strength: Option<f64> = range::SHEAR_STRENGTH,
    /// Adhesion of the JKR kind; only with `friction` 0. Load and preload may then pull.
    pub adhesion: Option<Adhesion>,
    /// The normal load that the contact starts with.
    pub preload: Preload,
    /// A bulk stress along x in proportion to the tangential force, which shifts the stick zone: only with a `cylinder`
    /// and under a constant load.
    pub bulk: Option<BulkPerForce>,
    /// The memory of the bodies, a Prony series of 1 to 16 terms: their moduli are those of the instant, and relax as
    /// R(t) = 1 − Σ ratio (1 − exp(−t/time)). Both bodies are alike, or one is rigid. The preload is put on at once at
    /// time 0, and moves have a `duration`.
    pub prony: Option<Vec<PronyTerm>> = Items(PRONY_TERMS),
}

/// A move, with an optional request for the stresses after it.
#[schema(example = json!({"displacement": 1e-7}))]
pub struct MoveRequest: Default {
    /// Tangential displacement of the indenter, m.
    pub displacement: Option<f64> = range::DISPLACEMENT,
    /// Tangential force, N. Its magnitude must stay below the friction limit μ F_N.
    pub force: Option<f64> = range::FORCE,
    /// Indentation, m; below zero the bodies are apart and the slip history is lost.
    pub indentation: Option<f64> = range::INDENTATION,
    /// Normal force, N; below zero, if it is no increment, only with `adhesion`.
    pub normal_force: Option<f64> = range::FORCE,
    /// How long the move takes, s, at an even pace; at once if left out. Only of bodies with `prony`. Without a target
    /// it waits.
    pub duration: Option<f64> = range::DURATION,
    /// Angle of twist about the axis of the contact, rad, since it last touched, in place of `displacement` or `force`.
    pub twist: Option<f64> = range::TWIST,
    /// Torque about the axis of the contact, N·m, in place of `twist`; its magnitude must stay below that of gross
    /// slip.
    pub torque: Option<f64> = range::TORQUE,
    /// Whether the numbers are increments to the present state, instead of the targets themselves.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub relative: bool,
    /// Ask for stresses after the move.
    pub stress: Option<StressRequest>,
    /// Tolerance of results that are not exact, relative to μ F_N, a pure number.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
}

/// A path for a contact, applied as a whole or not at all.
#[schema(example = json!({"path": {"displacement": [1e-7, -1e-7, 0.0]}}))]
pub struct PathRequest {
    /// The path.
    pub path: TimedPath,
    /// Ask for stresses at the end of the path.
    pub stress: Option<StressRequest>,
    /// Which states to return.
    #[serde(default)]
    pub steps: Steps,
    /// Tolerance of results that are not exact, relative to μ F_N, a pure number.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
}

/// Options of a fork; the body may be empty.
#[schema(example = json!({"label": "what if"}))]
pub struct ForkRequest: Default {
    /// A label for the new contact; if left out, that of the original.
    pub label: Option<String> = LABEL,
    /// Number of moves of the original that the new contact starts with; if left out, all of them. Its history has
    /// these moves and no later ones.
    pub sequence: Option<u64> = SEQUENCE,
}

/// The properties of a contact that can be changed without a move.
#[schema(example = json!({"label": "steel ball, third run"}))]
pub struct RenameRequest {
    /// The new label, or `null` for none.
    #[serialize_always]
    #[serde_with(skip_apply)]
    #[serde(deserialize_with = "serde::Deserialize::deserialize")]
    #[schema(required = true)]
    pub label: Option<String> = LABEL,
}
}

words! {
/// The order of a list of contacts.
pub enum ContactOrder {
    /// The oldest first.
    Oldest = "oldest",
    /// The newest first.
    Newest = "newest",
}
}

replies! {
/// A contact that has just been created.
pub struct NewSession {
    /// Its identifier.
    pub id: Uuid,
    /// Its label, if it has one.
    pub label: Option<String>,
    /// Number of moves so far: zero, or those of the contact that it was forked from.
    pub sequence: u64,
    /// Quantities that follow from the definition at the preload.
    pub contact: ContactSummary,
    /// Its state.
    pub state: State,
    /// Warnings about its results.
    pub warnings: Vec<Warning>,
}

/// A contact.
pub struct SessionReply {
    /// Its identifier.
    pub id: Uuid,
    /// Its label, if it has one.
    pub label: Option<String>,
    /// Number of moves so far.
    pub sequence: u64,
    /// Quantities that follow from the definition at the preload.
    pub contact: ContactSummary,
    /// Its state after the last move.
    pub state: State,
    /// When it was created (ISO 8601, UTC).
    pub created_at: Timestamp,
    /// When it was last moved (ISO 8601, UTC).
    pub updated_at: Timestamp,
}

/// A contact as an item of a list.
pub struct SessionSummary {
    /// Its identifier.
    pub id: Uuid,
    /// Its label, if it has one.
    pub label: Option<String>,
    /// Number of moves so far.
    pub sequence: u64,
    /// When it was created (ISO 8601, UTC).
    pub created_at: Timestamp,
    /// When it was last moved (ISO 8601, UTC).
    pub updated_at: Timestamp,
}

/// A page of contacts, in the order that the query asks for.
pub struct SessionPage {
    /// The contacts.
    pub items: Vec<SessionSummary>,
    /// The value of `after` for the next page; `null` on the last page.
    pub next: Option<Uuid>,
}

/// The result of a move.
pub struct MoveReply omits Option {
    /// The identifier of the contact.
    pub id: Uuid,
    /// The number of this move, which is the number of moves so far.
    pub sequence: u64,
    /// The state after it.
    pub state: State,
    /// The stresses after it, if asked for.
    pub stress: Option<Stress>,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings that apply from this move on and that earlier replies have not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub warnings: Vec<Warning>,
}

/// The result of a path.
pub struct PathReply omits Option {
    /// The identifier of the contact.
    pub id: Uuid,
    /// The number of the last move, which is the number of moves so far.
    pub sequence: u64,
    /// The states along the path: all of them, or the last.
    pub steps: Vec<State>,
    /// The stresses at the end, if asked for.
    pub stress: Option<Stress>,
    /// The path, if it follows the law of equal peaks.
    pub protocol: Option<Protocol>,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings that apply from this path on and that earlier replies have not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub warnings: Vec<Warning>,
}

/// The stresses of a contact, and their extrema if asked for.
pub struct StressReply omits Option {
    /// The stresses.
    #[serde(flatten)]
    pub stress: Stress,
    /// The extrema of the shear stress, if asked for.
    pub residual: Option<Residual>,
}
}

/// A contact that has passed all checks, to be created.
#[derive(Clone, Debug)]
pub struct Creation {
    /// The label.
    pub label: Option<String>,
    /// The definition as it was sent, to be stored.
    pub definition: ContactDefinition,
    /// The contact.
    pub setup: FrictionSetup,
}

/// Moves that have passed all checks, to be applied to a contact.
#[derive(Clone, Debug)]
pub struct Advance {
    /// The moves.
    pub plan: Plan,
    /// The requested stresses.
    pub stress: Option<StressRequest>,
    /// Which states are requested.
    pub steps: Steps,
    /// The tolerance of results that are not exact.
    pub tolerance: f64,
    /// The tolerance that the request names, to which the stated error of springs is held.
    pub asked_tolerance: Option<f64>,
    /// The protocol that finds the moves, if there is one; `plan` is then empty.
    pub relax: Option<Relaxation>,
}

impl From<Relaxation> for Advance {
    fn from(relaxation: Relaxation) -> Advance {
        let steps = relaxation.steps.unwrap_or(Steps::Last);
        let plan = Plan::Displacement(Vec::new());
        let tolerance = DEFAULT_TOLERANCE;
        Advance { plan, stress: None, steps, tolerance, asked_tolerance: None, relax: Some(relaxation) }
    }
}

impl Document for CreateRequest {
    type Checked = Creation;

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        let CreateRequest { profile, material, .. } = self;
        Some(DefinedProfile { pointer: "/profile", profile, material })
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let CreateRequest { label, profile, material, friction, shear_strength, adhesion, preload, bulk, prony } = self;
        let definition =
            ContactDefinition { profile, material, friction, shear_strength, adhesion, preload, bulk, prony };
        let setup = definition.check_any(JsonPath::Root, profiles, faults);
        setup.map(|setup| Creation { label, definition, setup })
    }
}

impl Document for MoveRequest {
    type Checked = Advance;

    fn checked(self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let step = self.step();
        step.check(JsonPath::Root, faults);
        let MoveRequest { stress, tolerance, .. } = self;
        let stress = stress.and_then(|stress| stress.checked(JsonPath::Root.member("stress"), faults));
        Some(Advance {
            plan: Plan::Single(step),
            stress,
            steps: Steps::Last,
            tolerance: tolerance.unwrap_or(DEFAULT_TOLERANCE),
            asked_tolerance: tolerance,
            relax: None,
        })
    }
}

impl From<Move> for MoveRequest {
    fn from(step: Move) -> Self {
        let Move { displacement, force, indentation, normal_force, duration, twist, torque, relative } = step;
        let (stress, tolerance) = (None, None);
        MoveRequest {
            displacement,
            force,
            indentation,
            normal_force,
            duration,
            twist,
            torque,
            relative,
            stress,
            tolerance,
        }
    }
}

impl MoveRequest {
    fn step(&self) -> Move {
        let MoveRequest { displacement, force, indentation, normal_force, duration, twist, torque, relative, .. } =
            *self;
        Move { displacement, force, indentation, normal_force, duration, twist, torque, relative }
    }
}

impl Document for PathRequest {
    type Checked = Advance;

    fn checked(self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let plan = self.path.check(JsonPath::Root.member("path"), faults);
        let stress = self.stress.and_then(|stress| stress.checked(JsonPath::Root.member("stress"), faults));
        let asked_tolerance = self.tolerance;
        let tolerance = asked_tolerance.unwrap_or(DEFAULT_TOLERANCE);
        plan.map(|plan| Advance { plan, stress, steps: self.steps, tolerance, asked_tolerance, relax: None })
    }
}

checked_alone!(RenameRequest, ForkRequest);
