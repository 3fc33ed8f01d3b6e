//! Moves, and paths of moves.

mod cycles;

use std::ops::RangeInclusive;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;

use stickslip_mechanics::{
    self as mechanics, Normal, Tangential, range,
    range::{Quantity, Range},
};

use super::check::{Faults, JsonPath};
use super::choice::choices;
use super::limits::{Array, Items, Limit, Limited, OfItsMembers, PATH_MOVES};
use super::plane::PlanarPlan;
use super::request::{not_null, object, requests};

pub(crate) use cycles::PHASE;
pub use cycles::{Cycles, CyclicPath, FirstTurn, NormalOscillation};

/// Reversals of an oscillation that dies away; each is one move, and one more ends the path at zero.
const REVERSALS: RangeInclusive<usize> = 1..=99_999;

/// One move, straight to its targets: at most one tangential target (`displacement` or `force`) and one normal target
/// (`indentation` or `normal_force`), at least one in all. Without a tangential target the displacement stays, without
/// a normal one the indentation stays.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, remote = "Self")]
#[schema(example = json!({"displacement": 1e-7}))]
pub struct Move {
    /// Tangential displacement of the indenter, m.
    pub displacement: Option<f64>,
    /// Tangential force, N. Its magnitude must stay below the friction limit μ F_N.
    pub force: Option<f64>,
    /// Indentation, m; below zero the bodies are apart and the slip history is lost.
    pub indentation: Option<f64>,
    /// Normal force, N.
    pub normal_force: Option<f64>,
    /// Whether the numbers are increments to the present state, instead of the targets themselves.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub relative: bool,
}
object!(Move);

choices! {
/// A path, one key: a list of moves, or a short form of one.
#[schema(example = json!({"displacement": [1e-7, -1e-7, 0.0]}))]
pub enum Path {
    /// Moves, one after the other.
    "moves" => Moves(Vec<Move>) = Items(PATH_MOVES),
    /// Tangential displacements of the indenter, m, one move each.
    "displacement" => Displacement(Vec<f64>) = Array(PATH_MOVES, range::DISPLACEMENT),
    /// Tangential forces, N, one move each.
    "force" => Force(Vec<f64>) = Array(PATH_MOVES, range::FORCE),
    /// Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper).
    "falling_amplitude" => FallingAmplitude(FallingAmplitude) = OfItsMembers,
    /// Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
    /// profile of the contact.
    "equal_peaks" => EqualPeaks(EqualPeaks) = OfItsMembers,
    /// Equal cycles about a mean, under a constant load or one that oscillates too.
    "cycles" => Cycles(CyclicPath),
}
}

requests! {
/// A tangential oscillation that dies away by the law of equal peaks; it ends at displacement zero.
#[schema(example = json!({"reversals": 20}))]
pub struct EqualPeaks {
    /// Number of reversals N; the path has one more move.
    pub reversals: usize = REVERSALS,
    /// Radius outside which the peaks are equal, m, up to the contact radius. For a profile whose slope jumps (the tip
    /// of a cone, the rim of a flat) it must lie outside the jump; if left out, it is then a tenth of the way from the
    /// jump to the edge, and zero for other profiles.
    pub cutoff_radius: Option<f64> = range::CONTACT_RADIUS,
}

/// A tangential oscillation that dies away; it ends at displacement zero.
#[schema(example = json!({"reversals": 20}))]
pub struct FallingAmplitude {
    /// Number of reversals N; the path has one more move.
    pub reversals: usize = REVERSALS,
    /// Displacement of the first reversal, m; if left out, the displacement at which the contact just slips as a whole.
    pub amplitude: Option<f64> = range::DISPLACEMENT,
}

/// A displacement and the force that was measured there.
#[schema(example = json!({"displacement": 1e-7, "force": 1.21, "at": "2026-03-01T12:00:00.25Z"}))]
pub struct Observation: Copy {
    /// Tangential displacement of the indenter, m, to which the contact is moved.
    pub displacement: f64 = range::DISPLACEMENT,
    /// Measured tangential force, N.
    pub force: f64 = range::FORCE,
    /// When it was measured (RFC 3339, from 1678 to 2261); not before the measurement that precedes it.
    pub at: Option<Timestamp>,
}
}

impl Limited for Move {
    const SCHEMA: &'static str = "Move";

    /// Those of a relative move: as an increment the normal force may be negative.
    fn limits() -> Vec<(&'static str, serde_json::Value)> {
        let widest = Move { relative: true, ..Move::default() };
        widest.targets().map(|(name, _, range)| (name, Limit::<f64>::keywords(range))).into()
    }

    fn check_members(&self, at: JsonPath<'_>, faults: &mut Faults) {
        self.targets().iter().for_each(|(name, value, range)| Limit::check(*range, value, at.member(name), faults));
    }
}

/// A checked path. Its moves may depend on the contact.
#[derive(Clone, Debug)]
pub enum Plan {
    /// Moves as they were sent.
    Moves(Vec<Move>),
    /// Displacements.
    Displacement(Vec<f64>),
    /// Forces.
    Force(Vec<f64>),
    /// Falling amplitude.
    FallingAmplitude(FallingAmplitude),
    /// Equal peaks.
    EqualPeaks(EqualPeaks),
    /// Equal cycles.
    Cycles(Cycles),
    /// A single move that is the body itself.
    Single(Move),
    /// Displacements with the forces that were measured there.
    Observations(Vec<Observation>),
    /// Moves in the plane, which `POST /simulate` and `POST /accuracy` follow.
    Plane(PlanarPlan),
}

impl Move {
    /// A move to a displacement, m.
    pub fn displacement(displacement: f64) -> Move {
        Move { displacement: Some(displacement), ..Move::default() }
    }

    /// A move to a tangential force, N.
    pub fn force(force: f64) -> Move {
        Move { force: Some(force), ..Move::default() }
    }

    /// Notes the faults of the move at `at`.
    pub fn check(&self, at: JsonPath<'_>, faults: &mut Faults) {
        self.check_members(at, faults);
        if self.displacement.is_some() && self.force.is_some() {
            faults.add(at.member("force"), "conflicts with `displacement`: at most one tangential target is allowed");
        }
        if self.indentation.is_some() && self.normal_force.is_some() {
            faults.add(at.member("normal_force"), "conflicts with `indentation`: at most one normal target is allowed");
        }
        if self.targets().iter().all(|(_, value, _)| value.is_none()) {
            faults.add(
                at,
                "no target: name `displacement` or `force`, or `indentation` or `normal_force`, or one of each",
            );
        }
    }

    /// The four targets with their names and ranges. As an increment a normal force may be negative.
    fn targets(&self) -> [(&'static str, Option<f64>, &'static Range); 4] {
        let normal_force = if self.relative { &range::FORCE } else { &range::NORMAL_FORCE };
        [
            ("displacement", self.displacement, &range::DISPLACEMENT),
            ("force", self.force, &range::FORCE),
            ("indentation", self.indentation, &range::INDENTATION),
            ("normal_force", self.normal_force, normal_force),
        ]
    }

    /// Whether the move has a target for this quantity.
    pub fn names(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Displacement => self.displacement.is_some(),
            Quantity::Force => self.force.is_some(),
            Quantity::Indentation => self.indentation.is_some(),
            Quantity::NormalForce => self.normal_force.is_some(),
            _ => false,
        }
    }

    /// Whether the move is straight in a force while the other quantity changes. Such a move is curved in displacement
    /// and indentation, and followed in many small steps.
    pub fn is_curved(&self) -> bool {
        let normal = self.indentation.is_some() || self.normal_force.is_some();
        (self.force.is_some() && normal) || (self.displacement.is_some() && self.normal_force.is_some())
    }

    /// The move for the mechanics.
    pub fn step(&self) -> mechanics::Move {
        let tangential = self.displacement.map(Tangential::Displacement).or(self.force.map(Tangential::Force));
        let normal = self.indentation.map(Normal::Indentation).or(self.normal_force.map(Normal::NormalForce));
        mechanics::Move { tangential, normal, relative: self.relative }
    }
}

impl Path {
    /// The checked path; its faults are noted at `at`.
    #[must_use]
    pub fn check(self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
        faults.part(|faults| self.check_members(at, faults))?;
        let plan = faults.part(|faults| match self {
            Path::Moves(moves) => {
                let at = at.member("moves");
                moves.iter().enumerate().for_each(|(index, step)| step.check(at.index(index), faults));
                Some(Plan::Moves(moves))
            }
            Path::Displacement(targets) => Some(Plan::Displacement(targets)),
            Path::Force(targets) => Some(Plan::Force(targets)),
            Path::FallingAmplitude(fall) => Some(Plan::FallingAmplitude(fall)),
            Path::EqualPeaks(peaks) => Some(Plan::EqualPeaks(peaks)),
            Path::Cycles(cycles) => cycles.check(at.member("cycles"), faults).map(Plan::Cycles),
        });
        plan.flatten()
    }
}

impl Plan {
    /// How many moves it has.
    pub fn length(&self) -> usize {
        match self {
            Plan::Moves(moves) => moves.len(),
            Plan::Displacement(targets) | Plan::Force(targets) => targets.len(),
            Plan::FallingAmplitude(fall) => fall.reversals.saturating_add(1),
            Plan::EqualPeaks(peaks) => peaks.reversals.saturating_add(1),
            Plan::Cycles(cycles) => cycles.length(),
            Plan::Single(_) => 1,
            Plan::Observations(observations) => observations.len(),
            Plan::Plane(plane) => plane.moves.len(),
        }
    }

    /// How many of them are curved.
    pub fn curved(&self) -> usize {
        match self {
            Plan::Moves(moves) => moves.iter().filter(|step| step.is_curved()).count(),
            Plan::Cycles(cycles) if cycles.is_curved() => cycles.length(),
            Plan::Single(step) => usize::from(step.is_curved()),
            Plan::Displacement(_)
            | Plan::Force(_)
            | Plan::FallingAmplitude(_)
            | Plan::EqualPeaks(_)
            | Plan::Cycles(_)
            | Plan::Observations(_)
            | Plan::Plane(_) => 0,
        }
    }

    /// The JSON pointer to the move of this number in the body; `quantity` is the member at fault, if one is.
    pub fn place_of(&self, index: usize, quantity: Option<Quantity>) -> String {
        let member = quantity.map(|quantity| format!("/{quantity}")).unwrap_or_default();
        match self {
            Plan::Moves(_) => format!("/path/moves/{index}{member}"),
            Plan::Displacement(_) => format!("/path/displacement/{index}"),
            Plan::Force(_) => format!("/path/force/{index}"),
            Plan::FallingAmplitude(_) => "/path/falling_amplitude".to_owned(),
            Plan::EqualPeaks(_) if quantity == Some(Quantity::CutoffRadius) => format!("/path/equal_peaks{member}"),
            Plan::EqualPeaks(_) => "/path/equal_peaks".to_owned(),
            Plan::Cycles(cycles) => format!("/path/cycles{}", cycles.place_of(quantity)),
            Plan::Single(_) => member,
            Plan::Observations(_) => format!("/observations/{index}/displacement"),
            Plan::Plane(plane) => plane.place_of(index, quantity),
        }
    }
}
