//! The reply of `POST /fretting`.

use stickslip_mechanics::fatigue;

use crate::prelude::*;

replies! {
/// The criteria over the steady cycle, each with its values at all places.
pub struct FrettingReply omits Option {
    /// Quantities that follow from the definition at the preload.
    pub contact: ContactSummary,
    /// Place along the motion of the first body, m.
    pub x: Vec<f64>,
    /// Place across the motion of the first body, m.
    pub y: Vec<f64>,
    /// Depth into the body, m; never negative.
    pub z: Vec<f64>,
    /// Crossland's criterion, Pa.
    pub crossland: Option<Rating>,
    /// Dang Van's criterion, Pa.
    pub dang_van: Option<Rating>,
    /// Findley's criterion, Pa.
    pub findley: Option<Rating>,
    /// Smith, Watson and Topper's criterion, Pa.
    pub swt: Option<Rating>,
    /// Fatemi and Socie's criterion, a pure number.
    pub fatemi_socie: Option<Rating>,
    /// Ruiz's first parameter, shear stress times slip, N/m.
    pub ruiz: Option<Rating>,
    /// Ruiz's second parameter, the first times the largest tension along x, N²/m³; returned with the first.
    pub ruiz_tension: Option<Rating>,
    /// Friction work per area and cycle, J/m²; never negative.
    pub friction_work: Option<Rating>,
    /// The stresses over the cycle at the places of `stress_paths`.
    pub stress_paths: Option<Vec<StressPath>>,
    /// Number of instants in the move that needed most, at the places of the largest values.
    pub instants: usize,
    /// The largest relative error among the largest values of the criteria, a pure number.
    pub change: f64,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// A criterion at all places.
pub struct Rating omits Option {
    /// Its values, place by place, in the unit of the criterion; `null` where a stress is infinite, and below the
    /// surface for a quantity that is defined on the surface.
    pub values: Vec<Option<f64>>,
    /// The largest value that is not `null`; in a search left out if there is no largest value in the body.
    pub largest: Option<Largest>,
    /// The limit over the largest value, a pure number, if a limit was given: below 1 the criterion predicts crack
    /// growth. Left out where the value is nowhere positive, and where it is infinite somewhere.
    pub margin: Option<f64>,
    /// The life of the largest value, if a curve was given.
    pub life: Option<Life>,
    /// The cycles at all places, pure numbers, if a curve was given; `null` where a value has no life.
    pub cycles: Option<Vec<Option<f64>>>,
    /// The criterion below its worst point of the surface, if `critical_distance` was given.
    pub critical_distance: Option<BelowSurface>,
}

/// A criterion at the critical distance below a point of the surface.
pub struct BelowSurface omits Option {
    /// The value, in the unit of the criterion.
    pub value: f64,
    /// Estimated error of the value over the whole cycle, in the unit of the criterion.
    pub error: f64,
    /// The point of the surface above: x, y, z, m. The criterion is larger there than elsewhere on the surface; a
    /// deeper point may be worse.
    pub point: [f64; 3],
    /// Unit normal of the critical plane along x, y and z, pure numbers, if the criterion has one.
    pub plane: Option<[f64; 3]>,
    /// The critical instant, if the criterion has one.
    pub at: Option<Instant>,
    /// The limit over the value, a pure number, if a limit was given and the value is positive.
    pub margin: Option<f64>,
    /// The life of the value, if a curve was given.
    pub life: Option<Life>,
}

/// Number of cycles that the material withstands. Tested lives scatter by a factor of three and more about such a
/// curve.
pub struct Life: Copy {
    /// Cycles N_f, a pure number; `null` if there is none, for the reason in `no_life`.
    pub cycles: Option<f64>,
    /// Lower bound of the cycles within the stated error of the value, a pure number; zero for less than 0.5.
    pub shortest: f64,
    /// Upper bound of the cycles within that error, a pure number; `null` if above 1e12 or infinite.
    pub longest: Option<f64>,
    /// Why `cycles` is `null`; left out if it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub no_life: Option<NoLife>,
}

/// The place where a criterion is largest.
pub struct Largest omits Option {
    /// The value, in the unit of the criterion.
    pub value: f64,
    /// Estimated error of the value as the largest over the cycle and, in a search, over the body, in the unit of the
    /// criterion.
    pub error: f64,
    /// The place: x, y, z, m.
    pub point: [f64; 3],
    /// Unit normal of the critical plane along x, y and z, pure numbers, if the criterion has one.
    pub plane: Option<[f64; 3]>,
    /// The critical instant, if the criterion has one.
    pub at: Option<Instant>,
}

/// An instant of the cycle.
pub struct Instant: Copy of fatigue::Instant {
    /// Index of the move.
    #[serde(rename = "move")]
    pub step: usize,
    /// Fraction of the move that has been made, a pure number above 0 and up to 1.
    pub part: f64,
}

/// The stresses at one place over the cycle, in columns, Pa, tension positive.
pub struct StressPath: Default {
    /// Index of the place.
    pub place: usize,
    /// Index of the move.
    #[serde(rename = "move")]
    pub step: Vec<usize>,
    /// Fraction of the move that has been made, a pure number above 0 and up to 1.
    pub part: Vec<f64>,
    /// Normal stress along x, Pa; tension is positive.
    pub xx: Vec<Option<f64>>,
    /// Normal stress along y, Pa; tension is positive.
    pub yy: Vec<Option<f64>>,
    /// Normal stress along z, Pa; tension is positive.
    pub zz: Vec<Option<f64>>,
    /// Shear stress in the plane of x and y, Pa.
    pub xy: Vec<Option<f64>>,
    /// Shear stress in the plane of y and z, Pa.
    pub yz: Vec<Option<f64>>,
    /// Shear stress in the plane of x and z, Pa.
    pub xz: Vec<Option<f64>>,
}
}

words! {
/// Why a value has no life.
pub enum NoLife of fatigue::NoLife {
    /// It is zero or negative: the criterion sees no damage. That is no proof of an infinite life.
    NotPositive = "not_positive",
    /// The curve gives more than 1e12 cycles, which no test has reached.
    TooLong = "too_long",
    /// The curve gives less than half a cycle.
    TooShort = "too_short",
    /// The stress of the model is infinite there.
    InfiniteStress = "infinite_stress",
}
}

impl From<fatigue::Life> for Life {
    fn from(life: fatigue::Life) -> Life {
        let fatigue::Life { cycles, shortest, longest } = life;
        Life { cycles: cycles.ok(), shortest, longest, no_life: cycles.err().map(NoLife::from) }
    }
}

/// The criteria in their order: the name in requests and replies, the unit, and what a picture calls it.
pub const CRITERIA: [(&str, &str, &str); 8] = [
    ("crossland", "Pa", "Crossland"),
    ("dang_van", "Pa", "Dang Van"),
    ("findley", "Pa", "Findley"),
    ("swt", "Pa", "Smith-Watson-Topper"),
    ("fatemi_socie", "1", "Fatemi-Socie"),
    ("ruiz", "N/m", "Ruiz, shear stress times slip"),
    ("ruiz_tension", "N²/m³", "Ruiz, with tension"),
    ("friction_work", "J/m²", "Friction work per cycle"),
];

impl FrettingReply {
    /// The criteria that there are, with names and units.
    pub fn ratings(&self) -> impl Iterator<Item = (&'static str, &'static str, &Rating)> {
        let FrettingReply {
            crossland, dang_van, findley, swt, fatemi_socie, ruiz, ruiz_tension, friction_work, ..
        } = self;
        let ratings = [crossland, dang_van, findley, swt, fatemi_socie, ruiz, ruiz_tension, friction_work];
        let named = CRITERIA.into_iter().zip(ratings);
        named.filter_map(|((name, unit, _), rating)| Some((name, unit, rating.as_ref()?)))
    }
}
