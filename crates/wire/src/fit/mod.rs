//! The body of `POST /fit` and its reply: measured loops become the friction and the stiffness of their contact.

mod data;
mod parameter;
mod reply;

pub use data::{FitUnits, ForceUnit, LoopStart, MeasuredLoop};
pub use parameter::{FitParameter, KnownValue, KnownValues};
pub use reply::{
    FitEstimate, FitReply, FitResidual, FittedLoop, NoiseLevels, OmittedParameter, ParameterSensitivity, SignRuns,
};

use crate::limits::FIT_LOOPS;
use crate::prelude::*;

/// The standard deviation of a measured force.
const FORCE_NOISE: Range = Range { quantity: Quantity::Force, unit: "N", min: 1e-18, max: 1e18 };
/// The standard deviation of a measured displacement; zero is an exact one.
const DISPLACEMENT_NOISE: Range = Range { quantity: Quantity::Displacement, unit: "m", min: 0.0, max: 1e9 };

requests! {
/// Measured loops, and the quantities that a fit is to determine from them. Nothing is stored.
pub struct FitRequest {
    /// The contact as far as it is known. Free quantities start from their values here.
    pub contact: ContactDefinition,
    /// The measured loops, which are fitted together.
    pub loops: Vec<MeasuredLoop> = Items(FIT_LOOPS),
    /// The units of `displacement` and `force` of the loops; if left out, SI. Everything else is in SI units.
    pub units: Option<FitUnits>,
    /// The quantities that the fit determines. If left out, the loops decide: friction, stiffness and force offset, the
    /// compliance of the machine if a loop reaches gross slip, and what the score tests show to differ from zero.
    pub free: Option<Vec<FitParameter>> = Distinct,
    /// Values known from elsewhere. One with a standard error takes part in the fit, whether it is free or not.
    pub known: Option<KnownValues>,
    /// The noise of the measured numbers; if left out, it is estimated from the loops.
    pub noise: Option<FitNoise>,
}

/// Standard deviations of the noise of a measurement, in SI units.
pub struct FitNoise: Copy, Default {
    /// Of a force, N.
    pub force: Option<f64> = FORCE_NOISE,
    /// Of a displacement, m.
    pub displacement: Option<f64> = DISPLACEMENT_NOISE,
}
}

/// At least one name, and none twice.
struct Distinct;

impl Limit<Vec<FitParameter>> for Distinct {
    fn keywords(&self) -> Value {
        json!({"minItems": 1, "maxItems": FitParameter::ALL.len(), "uniqueItems": true})
    }

    fn check(&self, names: &Vec<FitParameter>, at: JsonPath<'_>, faults: &mut Faults) {
        faults.length(at, names.len(), &(1..=FitParameter::ALL.len()));
        for (index, name) in names.iter().enumerate() {
            if names.iter().take(index).any(|other| other == name) {
                faults.add(at.index(index), format_args!("{} is named twice", name.name()));
            }
        }
    }
}

impl FitRequest {
    /// Points of all loops.
    pub fn points(&self) -> usize {
        self.loops.iter().fold(0, |sum, measured| sum.saturating_add(measured.force.len()))
    }
}

impl Document for FitRequest {
    /// Its loops are in SI units, whatever `units` says.
    type Checked = (FitRequest, FrictionSetup);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(mut self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let root = JsonPath::Root;
        let setup = self.contact.check_limited(root.member("contact"), profiles, faults);
        // A drift that is known moves nothing in a record without times.
        let known = self.known.iter().flat_map(KnownValues::iter).map(|(parameter, _)| parameter);
        let known = known.filter(|parameter| *parameter != FitParameter::Drift);
        let mut named = self.free.iter().flatten().copied().chain(known);
        let timed = named.find(|parameter| parameter.needs_time());
        let (units, at) = (self.units.unwrap_or_default().in_si(), root.member("loops"));
        for (index, measured) in self.loops.iter_mut().enumerate() {
            measured.check(units, timed, at.index(index), faults);
        }
        if let Some(known) = &self.known {
            known.check(root.member("known"), faults);
        }
        Some((self, setup?))
    }
}
