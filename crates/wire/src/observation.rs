//! The body of `POST /contacts/{id}/observations` and its reply: a contact follows a bench.

use super::path::Observation;
use super::session::Advance;
use crate::prelude::*;

requests! {
/// Measurements on a bench, in the order of time: the contact follows all of them or, if one is refused, none.
#[schema(example = json!({
    "observations": [{"displacement": 1e-7, "force": 1.21}, {"displacement": 2e-7, "force": 2.04}]
}))]
pub struct ObservationsRequest {
    /// The measurements.
    pub observations: Vec<Observation> = Items(PATH_MOVES),
}
}

replies! {
/// The result of observations.
pub struct ObservationsReply omits Option {
    /// The identifier of the contact.
    pub id: Uuid,
    /// The number of the last move, which is the number of moves so far.
    pub sequence: u64,
    /// The observations with the forces that the contact predicts.
    pub items: Vec<ObservedMove>,
    /// The coefficient of friction from the last measured cycle; left out as long as the observations do not determine
    /// it.
    pub friction: Option<FrictionEstimate>,
}

/// An observation with the force that the contact predicts.
pub struct ObservedMove: Copy {
    /// Tangential displacement, m.
    pub displacement: f64,
    /// Measured tangential force, N; positive along x.
    pub force: f64,
    /// Tangential force of the contact there, N, with the friction of its definition.
    pub predicted: f64,
    /// Measured less predicted force, N.
    pub innovation: f64,
}

/// The force that was measured at the displacement of a move.
pub struct ObservedForce: Copy omits Option {
    /// Measured tangential force, N; positive along x.
    pub force: f64,
    /// Tangential force of the contact there, N, with the friction of its definition.
    pub predicted: f64,
    /// Measured less predicted force, N.
    pub innovation: f64,
    /// When it was measured, if that is known (ISO 8601, UTC).
    pub at: Option<Timestamp>,
}

/// A coefficient of friction from a measured cycle.
pub struct FrictionEstimate: Copy {
    /// Coefficient of friction μ, a pure number.
    pub value: f64,
    /// Both ends of its 95 % interval, pure numbers.
    #[schema(min_items = 2, max_items = 2)]
    pub interval: [f64; 2],
    /// The number of the move after which the cycle began.
    pub from: u64,
    /// The number of the move that closed it.
    pub to: u64,
}

/// The latest coefficient of friction that the observations of a contact determine.
pub struct FrictionReply: Copy omits Option {
    /// The identifier of the contact.
    pub id: Uuid,
    /// Number of moves so far.
    pub sequence: u64,
    /// The estimate; left out as long as the observations do not determine it.
    pub friction: Option<FrictionEstimate>,
    /// Why there is no estimate; left out where there is one.
    pub reason: Option<NoFriction>,
}
}

words! {
/// Why the observations do not determine the friction.
pub enum NoFriction {
    /// No cycle of eight moves has closed whose forces were measured.
    NoCycle = "no_cycle",
    /// The newest cycle has moves whose forces were not measured, or not under one load.
    NotMeasured = "not_measured",
    /// The newest cycle has too many moves.
    TooManyMoves = "too_many_moves",
    /// The contact sticks in its middle throughout the newest cycle, or its forces leave the friction open.
    NotDetermined = "not_determined",
    /// The estimate takes too long, or there is no memory for it now.
    NotEstimated = "not_estimated",
}
}

impl ObservedForce {
    /// A measured force beside the predicted one, N.
    pub fn new(force: f64, predicted: f64, at: Option<Timestamp>) -> ObservedForce {
        ObservedForce { force, predicted, innovation: force - predicted, at }
    }
}

impl Document for ObservationsRequest {
    type Checked = Advance;

    fn checked(self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let all = JsonPath::Root.member("observations");
        let mut latest = Timestamp::MIN;
        for (index, observation) in self.observations.iter().enumerate() {
            let Some(instant) = observation.at else { continue };
            let of = all.index(index);
            let at = of.member("at");
            if i64::try_from(instant.as_nanosecond()).is_err() {
                faults.add(at, format_args!("{instant} is out of range: allowed are 1678 to 2261"));
            } else if instant < latest {
                faults.add(at, format_args!("{instant} is before {latest} of an earlier measurement"));
            }
            latest = latest.max(instant);
        }
        let plan = Plan::Observations(self.observations);
        let tolerance = DEFAULT_TOLERANCE;
        Some(Advance { plan, stress: None, steps: Steps::All, tolerance, asked_tolerance: None, relax: None })
    }
}
