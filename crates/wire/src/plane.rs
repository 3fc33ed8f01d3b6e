//! Motion in the plane: paths with pairs, and the reply of `POST /simulate` to them.

use std::borrow::Cow;

use utoipa::PartialSchema;
use utoipa::openapi::schema::{AnyOfBuilder, ArrayBuilder, OneOfBuilder, SchemaFormat, Type};
use utoipa::openapi::{KnownFormat, ObjectBuilder, Ref, RefOr, Schema};

use stickslip_mechanics as mechanics;
use stickslip_mechanics::Normal;
use stickslip_mechanics::rings::{self, EllipseArc, PlanarTarget, straight_moves};

use super::path::{CyclicPath, EqualPeaks, FallingAmplitude, PHASE};
use super::simulate::SimulateReply;
use crate::prelude::*;

/// Turns of an ellipse.
const TURNS: RangeInclusive<usize> = 1..=10_000;
/// Moves of a turn.
const STEPS_PER_TURN: RangeInclusive<usize> = 4..=10_000;
/// Moves of a turn, unless the path says how many.
const DEFAULT_STEPS_PER_TURN: usize = 64;
/// A semi-axis, m.
const SEMI_AXIS: Range = Range { min: 0.0, ..range::DISPLACEMENT };

/// A number along x, or a pair [x, y].
pub type Components = NumberOr<[f64; 2]>;

impl Numbers for [f64; 2] {
    const EXPECTED: &'static str = "a number, or a pair [x, y] of numbers";
}

impl ToSchema for Components {
    fn name() -> Cow<'static, str> {
        "Components".into()
    }
}

impl PartialSchema for Components {
    #[expect(deprecated, reason = "tools of version 3.0 of OpenAPI read `example`")]
    fn schema() -> RefOr<Schema> {
        // The widest range of a component: the member that has them narrows it.
        let number = || {
            let double = Some(SchemaFormat::KnownFormat(KnownFormat::Double));
            let number = ObjectBuilder::new().schema_type(Type::Number).format(double);
            number.minimum(Some(range::FORCE.min)).maximum(Some(range::FORCE.max))
        };
        let pair = ArrayBuilder::new().items(number()).min_items(Some(2)).max_items(Some(2));
        OneOfBuilder::new()
            .description(Some("A number along x, or a pair [x, y]."))
            .example(Some(json!([1e-7, 5e-8])))
            .item(number())
            .item(pair)
            .into()
    }
}

impl Components {
    /// Both components.
    pub fn pair(self) -> [f64; 2] {
        match self {
            Components::One(x) => [x, 0.0],
            Components::Many(pair) => pair,
        }
    }
}

/// Each component within the range.
impl Limit<Components> for Range {
    fn keywords(&self) -> Value {
        Limit::<f64>::keywords(self)
    }

    fn check(&self, value: &Components, at: JsonPath<'_>, faults: &mut Faults) {
        match value {
            Components::One(value) => Limit::check(self, value, at, faults),
            Components::Many(pair) => Limit::check(self, pair, at, faults),
        }
    }
}

requests! {
/// One move, straight to its targets: at most one tangential target (`displacement`, `force`, `twist` or `torque`) and
/// one normal target (`indentation` or `normal_force`), at least one in all or a `duration`. Without a tangential
/// target displacement and twist stay, without a normal one the indentation stays. A pair [x, y] is a target in the
/// plane.
#[schema(example = json!({"displacement": [1e-7, 5e-8]}))]
pub struct SimulatedMove: Copy, Default {
    /// Tangential displacement of the indenter, m, along x or [x, y].
    pub displacement: Option<Components> = range::DISPLACEMENT,
    /// Tangential force, N, along x or [x, y]. Its magnitude must stay below the friction limit μ F_N.
    pub force: Option<Components> = range::FORCE,
    /// Indentation, m; below zero the bodies are apart and the slip history is lost.
    pub indentation: Option<f64> = range::INDENTATION,
    /// Normal force, N; below zero, if it is no increment, only with `adhesion`.
    pub normal_force: Option<f64> = range::FORCE,
    /// How long the move takes, s, at an even pace; at once if left out. Only of bodies with `prony`, along a line.
    /// Without a target it waits.
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

/// Turns around the ellipse x = a cos θ, y = b sin(θ + phase), after a move to its beginning. Between the points of the
/// ellipse the path follows the curve.
#[schema(example = json!({"radii": [1e-7, 1e-7], "turns": 2}))]
pub struct Ellipse: Copy {
    /// a and b, m.
    pub radii: [f64; 2] = SEMI_AXIS,
    /// Number of turns.
    pub turns: usize = TURNS,
    /// Moves in each turn, each with its state; if left out, 64. The path has one more move, at most 100 000 in all.
    pub steps_per_turn: Option<usize> = STEPS_PER_TURN,
    /// Phase, degrees: an upright ellipse at 0, a line at 90; if left out, 0.
    pub phase: Option<f64> = PHASE,
}
}

choices! {
/// A path, one key: a list of moves, or a short form of one.
#[schema(example = json!({"displacement": [1e-7, -1e-7, 0.0]}))]
pub enum SimulatedPath {
    /// Moves, one after the other.
    "moves" => Moves(Vec<SimulatedMove>) = Items(PATH_MOVES),
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
    /// Turns around an ellipse.
    "ellipse" => Ellipse(Ellipse),
    /// Angles of twist, rad, one move each.
    "twist" => Twist(Vec<f64>) = Array(PATH_MOVES, range::TWIST),
    /// Torques, N·m, one move each.
    "torque" => Torque(Vec<f64>) = Array(PATH_MOVES, range::TORQUE),
}
}

replies! {
/// The state after a move in the plane.
pub struct PlanarState: Copy, Default omits Option {
    /// Tangential displacement of the indenter along x and y, m.
    pub displacement: [f64; 2],
    /// Tangential force along x and y, N; in a virgin contact it points along the displacement.
    pub force: [f64; 2],
    /// Indentation d, m; positive when pressed in, below zero the bodies are apart.
    pub indentation: f64,
    /// Normal force F_N, N; compression is positive.
    pub normal_force: f64,
    /// Contact radius a, m.
    pub contact_radius: f64,
    /// Stick radius c of the last move, m: inside it the move did not slip, to the width of a ring. The contact radius
    /// if nothing slipped, zero in gross slip.
    pub stick_radius: f64,
    /// How much of the contact slipped in the last move.
    pub regime: Regime,
    /// Work dissipated by friction since the start, J; never falls.
    pub dissipated_energy: f64,
    /// Energy stored in the tangential deformation, J.
    pub elastic_energy: f64,
    /// Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone.
    pub electrical_conductance: Option<f64>,
    /// Thermal conductance of the contact, W/K, if its bodies have a `conductivity`.
    pub thermal_conductance: Option<f64>,
}

/// Stresses along the radius at the end of a path in the plane; they are the same at every angle. An array that was not
/// asked for is left out.
pub struct PlanarStress: Default omits Option {
    /// Radii, m.
    pub radius: Vec<f64>,
    /// Normal pressure, Pa; compression is positive; `null` where it is infinite.
    pub pressure: Option<Vec<Option<f64>>>,
    /// Shear stress along x, Pa; `null` where it is infinite.
    pub shear_x: Option<Vec<Option<f64>>>,
    /// Shear stress along y, Pa; `null` where it is infinite.
    pub shear_y: Option<Vec<Option<f64>>>,
    /// Slip along x, the displacement of the indenter less that of the surface, m; `null` outside the contact.
    pub slip_x: Option<Vec<Option<f64>>>,
    /// Slip along y, m; `null` outside the contact.
    pub slip_y: Option<Vec<Option<f64>>>,
    /// Friction work per area since the start, J/m²; returned with `slip` if rings follow the path.
    pub friction_work: Option<Vec<Option<f64>>>,
}

/// The result of a simulation in the plane.
pub struct PlanarReply: Default omits Option {
    /// Quantities that follow from the definition at the preload.
    pub contact: ContactSummary,
    /// The states along the path: all of them, or the last.
    pub steps: Vec<PlanarState>,
    /// The stresses at the end, if asked for.
    pub stress: Option<PlanarStress>,
    /// Friction work of each turn of an ellipse, J; the first one begins at rest.
    pub turn_losses: Option<Vec<f64>>,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}
}

impl From<rings::PlanarState> for PlanarState {
    /// Without the conductances, which the contact knows.
    fn from(state: rings::PlanarState) -> PlanarState {
        PlanarState {
            displacement: state.displacement,
            force: state.force,
            indentation: state.indentation,
            normal_force: state.normal_force,
            contact_radius: state.contact_radius,
            stick_radius: state.stick_radius,
            regime: state.regime.into(),
            dissipated_energy: state.dissipated_energy,
            elastic_energy: state.elastic_energy,
            electrical_conductance: None,
            thermal_conductance: None,
        }
    }
}

/// The result of a simulation, along a line or in the plane: the latter if the path has pairs or is an ellipse, or
/// rings are asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
#[expect(clippy::large_enum_variant, reason = "there is one of it for a request")]
pub enum SimulationReply {
    /// Along a line.
    Line(SimulateReply),
    /// In the plane.
    Plane(PlanarReply),
}

impl ToSchema for SimulationReply {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        fn add<T: ToSchema>(schemas: &mut Vec<(String, RefOr<Schema>)>) {
            schemas.push((T::name().into_owned(), T::schema()));
            T::schemas(schemas);
        }
        add::<SimulateReply>(schemas);
        add::<PlanarReply>(schemas);
    }
}

impl PartialSchema for SimulationReply {
    fn schema() -> RefOr<Schema> {
        // Some members of both are alike, so that no schema could say that one of them alone fits.
        let about = "The result of a simulation, along a line or in the plane: the latter if the path has pairs or is \
                     an ellipse, or rings are asked for.";
        let of = |name: Cow<'static, str>| Ref::from_schema_name(name);
        let either = AnyOfBuilder::new().description(Some(about));
        either.item(of(SimulateReply::name())).item(of(PlanarReply::name())).into()
    }
}

/// A checked path in the plane.
#[derive(Clone, Debug)]
pub struct PlanarPlan {
    /// The moves.
    pub moves: Vec<rings::PlanarMove>,
    /// The direction of the line that all moves lead along, if they do: the exact solver then follows them, also where
    /// rings are asked for.
    pub line: Option<[f64; 2]>,
    /// The pointer, below the path, to the first pair; the ellipse itself.
    first_pair: String,
    form: Form,
}

/// How the path was sent.
#[derive(Clone, Copy, Debug)]
enum Form {
    Moves,
    /// A list of this name.
    Targets(&'static str),
    /// By so many moves a turn.
    Ellipse(usize),
}

impl Form {
    fn place_of(self, index: usize, quantity: Option<Quantity>) -> String {
        let member = quantity.map(|quantity| format!("/{quantity}")).unwrap_or_default();
        match self {
            Form::Moves => format!("/path/moves/{index}{member}"),
            Form::Targets(name) => format!("/path/{name}/{index}"),
            Form::Ellipse(_) => "/path/ellipse".to_owned(),
        }
    }
}

impl From<Move> for SimulatedMove {
    fn from(step: Move) -> SimulatedMove {
        SimulatedMove {
            displacement: step.displacement.map(Components::One),
            force: step.force.map(Components::One),
            indentation: step.indentation,
            normal_force: step.normal_force,
            duration: step.duration,
            twist: step.twist,
            torque: step.torque,
            relative: step.relative,
        }
    }
}

impl From<Path> for SimulatedPath {
    fn from(path: Path) -> SimulatedPath {
        match path {
            Path::Moves(moves) => SimulatedPath::Moves(moves.into_iter().map(SimulatedMove::from).collect()),
            Path::Displacement(targets) => SimulatedPath::Displacement(targets),
            Path::Force(targets) => SimulatedPath::Force(targets),
            Path::FallingAmplitude(fall) => SimulatedPath::FallingAmplitude(fall),
            Path::EqualPeaks(peaks) => SimulatedPath::EqualPeaks(peaks),
            Path::Cycles(cycles) => SimulatedPath::Cycles(cycles),
            Path::Twist(targets) => SimulatedPath::Twist(targets),
            Path::Torque(targets) => SimulatedPath::Torque(targets),
        }
    }
}

impl SimulatedMove {
    fn pairs(&self) -> [(&'static str, Option<Components>); 2] {
        [("displacement", self.displacement), ("force", self.force)]
    }

    /// The move along x.
    fn along_x(&self) -> Move {
        let [x, force] = self.pairs().map(|(_, components)| components.map(|components| components.pair()[0]));
        let SimulatedMove { indentation, normal_force, duration, twist, torque, relative, .. } = *self;
        Move { displacement: x, force, indentation, normal_force, duration, twist, torque, relative }
    }

    fn in_plane(&self) -> rings::PlanarMove {
        let displacement = self.displacement.map(|target| PlanarTarget::Displacement(target.pair()));
        let force = self.force.map(|target| PlanarTarget::Force(target.pair()));
        let normal = self.indentation.map(Normal::Indentation).or(self.normal_force.map(Normal::NormalForce));
        rings::PlanarMove { tangential: displacement.or(force), normal, relative: self.relative }
    }
}

impl SimulatedPath {
    fn twists(&self) -> bool {
        match self {
            SimulatedPath::Twist(_) | SimulatedPath::Torque(_) => true,
            SimulatedPath::Moves(moves) => moves.iter().any(|step| step.along_x().twists()),
            _ => false,
        }
    }

    /// The path without pairs; `None` if it has any.
    pub fn along_a_line(self) -> Option<Path> {
        let is_pair = |target: Option<Components>| matches!(target, Some(Components::Many(_)));
        Some(match self {
            SimulatedPath::Moves(moves) => {
                if moves.iter().any(|step| step.pairs().iter().any(|(_, target)| is_pair(*target))) {
                    return None;
                }
                Path::Moves(moves.iter().map(SimulatedMove::along_x).collect())
            }
            SimulatedPath::Displacement(targets) => Path::Displacement(targets),
            SimulatedPath::Force(targets) => Path::Force(targets),
            SimulatedPath::FallingAmplitude(fall) => Path::FallingAmplitude(fall),
            SimulatedPath::EqualPeaks(peaks) => Path::EqualPeaks(peaks),
            SimulatedPath::Cycles(cycles) => Path::Cycles(cycles),
            SimulatedPath::Twist(targets) => Path::Twist(targets),
            SimulatedPath::Torque(targets) => Path::Torque(targets),
            SimulatedPath::Ellipse(_) => return None,
        })
    }

    /// The checked path, in the plane if it has pairs, is an ellipse, or `rings` are asked for.
    pub(crate) fn check(self, rings: bool, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
        faults.none_within(at)?;
        if rings && self.twists() {
            return faults.refuse(JsonPath::Root.member("solver"), "rings follow no twist: leave `solver` out");
        }
        let plan = |moves: &mut dyn Iterator<Item = SimulatedMove>, form, first_pair: Option<String>| {
            let moves = moves.map(|step| step.in_plane()).collect();
            Some(Plan::Plane(PlanarPlan::new(moves, form, first_pair.unwrap_or_default())))
        };
        match &self {
            SimulatedPath::Moves(moves) => {
                let place = at.member("moves");
                moves.iter().enumerate().for_each(|(index, step)| step.along_x().check(place.index(index), faults));
                faults.none_within(at)?;
                let first_pair = first_pair(moves);
                if let Some(pair) = first_pair.as_ref().filter(|_| self.twists()) {
                    let error = mechanics::Error::TwistWithShift;
                    faults.unanswerable(JsonPath::Pointer(&format!("/path{pair}")), error);
                    return None;
                }
                if rings || first_pair.is_some() {
                    let timed = moves.iter().position(|step| step.duration.is_some_and(|duration| duration > 0.0));
                    if let Some(timed) = timed {
                        let error = stickslip_mechanics::Error::Viscoelastic("motion in the plane");
                        return faults.refuse(place.index(timed).member("duration"), error);
                    }
                    return plan(&mut moves.iter().copied(), Form::Moves, first_pair);
                }
            }
            SimulatedPath::Displacement(targets) if rings => {
                let moves = &mut targets.iter().map(|target| Move::displacement(*target).into());
                return plan(moves, Form::Targets("displacement"), None);
            }
            SimulatedPath::Force(targets) if rings => {
                let moves = &mut targets.iter().map(|target| Move::force(*target).into());
                return plan(moves, Form::Targets("force"), None);
            }
            SimulatedPath::Ellipse(ellipse) => {
                return ellipse.check(at.member("ellipse"), faults).map(Plan::Plane);
            }
            _ if rings => {
                let detail = "rings follow `moves`, `displacement`, `force` and `ellipse`: leave `solver` out";
                return faults.refuse(JsonPath::Root.member("solver"), detail);
            }
            _ => {}
        }
        self.along_a_line()?.check(at, faults)
    }
}

/// The pointer to the first pair of some moves.
fn first_pair(moves: &[SimulatedMove]) -> Option<String> {
    let in_move = |(index, step): (usize, &SimulatedMove)| {
        let mut pairs = step.pairs().into_iter();
        let (name, _) = pairs.find(|(_, target)| matches!(target, Some(Components::Many(_))))?;
        Some(format!("/moves/{index}/{name}"))
    };
    moves.iter().enumerate().find_map(in_move)
}

impl Ellipse {
    fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<PlanarPlan> {
        let steps = self.steps_per_turn.unwrap_or(DEFAULT_STEPS_PER_TURN);
        let moves = self.turns.saturating_mul(steps);
        if moves >= *PATH_MOVES.end() {
            let most = PATH_MOVES.end().saturating_sub(1).checked_div(steps).unwrap_or(0);
            let detail = format_args!("{} turns of {steps} moves: allowed are 1 to {most}", self.turns);
            return faults.refuse(at.member("turns"), detail);
        }
        let arc = |turns| EllipseArc { radii: self.radii, phase: self.phase.unwrap_or(0.0).to_radians(), turns };
        let to = |target| rings::PlanarMove { tangential: Some(target), ..rings::PlanarMove::default() };
        let line = self.line(steps);
        let turns = |index: usize| index as f64 / steps as f64;
        let along = |index: usize| {
            let arc = arc([turns(index), turns(index.saturating_add(1))]);
            to(match line {
                Some(line) => PlanarTarget::Displacement(line.point(&arc)),
                None => PlanarTarget::Arc(arc),
            })
        };
        let begin = arc([0.0; 2]);
        let begin = to(PlanarTarget::Displacement(line.map_or_else(|| begin.at(0.0), |line| line.point(&begin))));
        let moves = std::iter::once(begin).chain((0..moves).map(along)).collect();
        Some(PlanarPlan::new(moves, Form::Ellipse(steps), "/ellipse".to_owned()))
    }

    /// The line that this ellipse is, if it is one, and its points with so many steps a turn include those where it
    /// turns back.
    fn line(&self, steps: usize) -> Option<EllipseLine> {
        let ([a, b], phase) = (self.radii, self.phase.unwrap_or(0.0));
        let quarters = (phase / 90.0).rem_euclid(4.0);
        // Of the cosine alone.
        let cosine = |y: f64| steps.is_multiple_of(2).then_some(EllipseLine { end: [a, y], axis: 0 });
        match quarters {
            1.0 => cosine(b),
            3.0 => cosine(-b),
            _ if b <= 0.0 => cosine(0.0),
            0.0 if a <= 0.0 && steps.is_multiple_of(4) => Some(EllipseLine { end: [0.0, b], axis: 1 }),
            _ => None,
        }
    }
}

/// An ellipse that is a line: of this end, m, times cos θ or, for the axis 1, sin θ.
#[derive(Clone, Copy)]
struct EllipseLine {
    end: [f64; 2],
    axis: usize,
}

impl EllipseLine {
    /// The point at the end of an arc, m.
    fn point(self, arc: &EllipseArc) -> [f64; 2] {
        let size = EllipseArc { radii: [1.0; 2], phase: 0.0, ..*arc }.at(1.0)[self.axis];
        self.end.map(|component| component * size)
    }
}

impl PlanarPlan {
    fn new(moves: Vec<rings::PlanarMove>, form: Form, first_pair: String) -> PlanarPlan {
        let (count, direction) = straight_moves(&moves);
        let line = (count == moves.len()).then_some(direction);
        PlanarPlan { moves, line, first_pair, form }
    }

    /// The pointer to the first pair, or to the ellipse.
    pub fn first_pair(&self) -> String {
        format!("/path{}", self.first_pair)
    }

    /// The pointer to the move of this number in the body; `quantity` is the member at fault, if one is.
    pub(crate) fn place_of(&self, index: usize, quantity: Option<Quantity>) -> String {
        self.form.place_of(index, quantity)
    }

    /// Moves of a turn, of an ellipse.
    pub fn steps_per_turn(&self) -> Option<usize> {
        if let Form::Ellipse(steps) = self.form { Some(steps) } else { None }
    }

    /// The moves along the line of this direction.
    pub fn along(&self, [x, y]: [f64; 2]) -> Vec<Move> {
        let on_line = |[to_x, to_y]: [f64; 2]| to_x * x + to_y * y;
        let along = |step: &rings::PlanarMove| {
            let mut found = match step.tangential {
                None => Move::default(),
                Some(PlanarTarget::Displacement(to)) => Move::displacement(on_line(to)),
                Some(PlanarTarget::Force(to)) => Move::force(on_line(to)),
                Some(PlanarTarget::Arc(arc)) => Move::displacement(on_line(arc.at(1.0))),
            };
            match step.normal {
                Some(Normal::Indentation(depth)) => found.indentation = Some(depth),
                Some(Normal::NormalForce(force)) => found.normal_force = Some(force),
                None => {}
            }
            Move { relative: step.relative, ..found }
        };
        self.moves.iter().map(along).collect()
    }
}
