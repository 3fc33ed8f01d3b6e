//! Moves, and paths of moves.

mod cycles;
mod timed;

use stickslip_mechanics as mechanics;
use stickslip_mechanics::{Normal, Tangential};

use super::plane::PlanarPlan;
use crate::prelude::*;

pub(crate) use cycles::PHASE;
pub use cycles::{Cycles, CyclicPath, FirstTurn, NormalOscillation};
pub use timed::{Timed, TimedPath, TimedSimulatedPath};

/// Reversals of an oscillation that dies away; each is one move, and one more ends the path at zero.
const REVERSALS: RangeInclusive<usize> = 1..=99_999;

requests! {
/// One move, straight to its targets: at most one tangential target (`displacement`, `force`, `twist` or `torque`) and
/// one normal target (`indentation` or `normal_force`), at least one in all or a `duration`. Without a tangential
/// target displacement and twist stay, without a normal one the indentation stays.
#[schema(example = json!({"displacement": 1e-7}))]
pub struct Move: Copy, Default {
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
}
}

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
    "falling_amplitude" => FallingAmplitude(FallingAmplitude),
    /// Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
    /// profile of the contact.
    "equal_peaks" => EqualPeaks(EqualPeaks),
    /// Equal cycles about a mean, under a constant load or one that oscillates too.
    "cycles" => Cycles(CyclicPath),
    /// Angles of twist, rad, one move each.
    "twist" => Twist(Vec<f64>) = Array(PATH_MOVES, range::TWIST),
    /// Torques, N·m, one move each.
    "torque" => Torque(Vec<f64>) = Array(PATH_MOVES, range::TORQUE),
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
    /// Angles of twist.
    Twist(Vec<f64>),
    /// Torques.
    Torque(Vec<f64>),
    /// Moves along a line that take this long, s, unless they say so themselves.
    Timed(Box<Plan>, f64),
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

    /// A move to an angle of twist, rad.
    pub fn twist(twist: f64) -> Move {
        Move { twist: Some(twist), ..Move::default() }
    }

    /// A move to a torque, N·m.
    pub fn torque(torque: f64) -> Move {
        Move { torque: Some(torque), ..Move::default() }
    }

    /// Whether it has an angle of twist or a torque for its target.
    pub fn twists(&self) -> bool {
        self.twist.is_some() || self.torque.is_some()
    }

    /// Notes the faults of the move at `at`, beside the limits of its members.
    pub fn check(&self, at: JsonPath<'_>, faults: &mut Faults) {
        if self.twists() {
            let others = [("displacement", self.displacement.is_some()), ("force", self.force.is_some())];
            for (name, _) in others.into_iter().filter(|(_, given)| *given) {
                faults.unanswerable(at.member(name), mechanics::Error::TwistWithShift);
            }
        }
        if self.twist.is_some() && self.torque.is_some() {
            faults.add(at.member("torque"), "conflicts with `twist`: at most one of them is allowed");
        }
        if self.displacement.is_some() && self.force.is_some() {
            faults.add(at.member("force"), "conflicts with `displacement`: at most one tangential target is allowed");
        }
        if self.indentation.is_some() && self.normal_force.is_some() {
            faults.add(at.member("normal_force"), "conflicts with `indentation`: at most one normal target is allowed");
        }
        let named = [self.displacement, self.force, self.indentation, self.normal_force, self.duration];
        if named.iter().all(Option::is_none) && !self.twists() {
            faults.add(
                at,
                "no target: name `displacement`, `force`, `twist` or `torque`, or `indentation` or `normal_force`, or \
                 one of each",
            );
        }
    }

    /// Whether the move has a target for this quantity.
    pub fn names(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Displacement => self.displacement.is_some(),
            Quantity::Force => self.force.is_some(),
            Quantity::Indentation => self.indentation.is_some(),
            Quantity::NormalForce => self.normal_force.is_some(),
            Quantity::Duration => self.duration.is_some(),
            Quantity::Twist => self.twist.is_some(),
            Quantity::Torque => self.torque.is_some(),
            _ => false,
        }
    }

    /// Whether the move is straight in a force while the other quantity changes. Such a move is curved in displacement
    /// and indentation, and followed in many small steps.
    pub fn is_curved(&self) -> bool {
        let normal = self.indentation.is_some() || self.normal_force.is_some();
        let forced = self.force.is_some() || self.twists();
        (forced && normal) || (self.displacement.is_some() && self.normal_force.is_some())
    }

    /// The move for the mechanics.
    pub fn step(&self) -> mechanics::Move {
        let shift = self.displacement.map(Tangential::Displacement).or(self.force.map(Tangential::Force));
        let tangential = shift.or(self.twist.map(Tangential::Twist)).or(self.torque.map(Tangential::Torque));
        let normal = self.indentation.map(Normal::Indentation).or(self.normal_force.map(Normal::NormalForce));
        let duration = self.duration.unwrap_or(0.0);
        mechanics::Move { tangential, normal, relative: self.relative, duration }
    }
}

impl Path {
    /// The checked path; its faults are noted at `at`.
    #[must_use]
    pub fn check(self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
        faults.none_within(at)?;
        Some(match self {
            Path::Moves(moves) => {
                let at = at.member("moves");
                moves.iter().enumerate().for_each(|(index, step)| step.check(at.index(index), faults));
                Plan::Moves(moves)
            }
            Path::Displacement(targets) => Plan::Displacement(targets),
            Path::Force(targets) => Plan::Force(targets),
            Path::FallingAmplitude(fall) => Plan::FallingAmplitude(fall),
            Path::EqualPeaks(peaks) => Plan::EqualPeaks(peaks),
            Path::Cycles(cycles) => Plan::Cycles(cycles.check(at.member("cycles"), faults)?),
            Path::Twist(targets) => Plan::Twist(targets),
            Path::Torque(targets) => Plan::Torque(targets),
        })
    }
}

impl Plan {
    /// How many moves it has.
    pub fn length(&self) -> usize {
        match self {
            Plan::Moves(moves) => moves.len(),
            Plan::Displacement(targets) | Plan::Force(targets) | Plan::Twist(targets) | Plan::Torque(targets) => {
                targets.len()
            }
            Plan::FallingAmplitude(fall) => fall.reversals.saturating_add(1),
            Plan::EqualPeaks(peaks) => peaks.reversals.saturating_add(1),
            Plan::Cycles(cycles) => cycles.length(),
            Plan::Single(_) => 1,
            Plan::Observations(observations) => observations.len(),
            Plan::Plane(plane) => plane.moves.len(),
            Plan::Timed(plan, _) => plan.length(),
        }
    }

    /// Whether any of them twists the contact.
    pub fn twists(&self) -> bool {
        match self {
            Plan::Twist(_) | Plan::Torque(_) => true,
            Plan::Moves(moves) => moves.iter().any(Move::twists),
            Plan::Single(step) => step.twists(),
            Plan::Timed(plan, _) => plan.twists(),
            _ => false,
        }
    }

    /// How many of them are curved.
    pub fn curved(&self) -> usize {
        match self {
            Plan::Moves(moves) => moves.iter().filter(|step| step.is_curved()).count(),
            Plan::Cycles(cycles) if cycles.is_curved() => cycles.length(),
            Plan::Single(step) => usize::from(step.is_curved()),
            Plan::Timed(plan, _) => plan.curved(),
            Plan::Displacement(_)
            | Plan::Twist(_)
            | Plan::Torque(_)
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
            Plan::Twist(_) => format!("/path/twist/{index}"),
            Plan::Torque(_) => format!("/path/torque/{index}"),
            Plan::Timed(plan, _) => {
                let own = matches!(&**plan, Plan::Moves(moves) if moves[index].duration.is_some());
                if quantity == Some(Quantity::Duration) && !own {
                    format!("/path{member}")
                } else {
                    plan.place_of(index, quantity)
                }
            }
        }
    }
}
