//! The body of `POST /fit` and its reply: measured loops become the friction and the stiffness of their contact.

mod data;
mod parameter;
mod reply;

pub use data::{FitUnits, ForceUnit, LoopRecord, LoopStart, MeasuredLoop};
pub use parameter::{FitParameter, KnownValue, KnownValues};
pub use reply::{FitEstimate, FitReply, FitResidual, FittedLoop, NoiseLevels, SignRuns};

use serde_json::{Value, json};

use stickslip_mechanics::range::{Quantity, Range};

use crate::check::{Faults, JsonPath};
use crate::definition::{ContactDefinition, DefinedProfile, SharedSetup};
use crate::document::Document;
use crate::limits::{FIT_LOOPS, Items, Limit, Limited as _};
use crate::prepare::Prepare;
use crate::request::requests;

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
    /// The quantities that the fit determines.
    pub free: Vec<FitParameter> = Distinct,
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

/// A checked request, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct FitTask {
    /// The contact as it was defined.
    pub definition: ContactDefinition,
    /// Its checked setup.
    pub setup: SharedSetup,
    /// The loops.
    pub loops: Vec<LoopRecord>,
    /// What is to be determined.
    pub free: Vec<FitParameter>,
    /// What is known.
    pub known: KnownValues,
    /// The noise, where it is known.
    pub noise: FitNoise,
    /// The units that the request has named.
    pub units: FitUnits,
}

impl FitTask {
    /// Points of all loops.
    pub fn points(&self) -> usize {
        self.loops.iter().fold(0, |sum, record| sum.saturating_add(record.force.len()))
    }
}

impl Document for FitRequest {
    type Checked = FitTask;

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let root = JsonPath::Root;
        let setup = self.contact.check(root.member("contact"), profiles, faults);
        self.check_members(root, faults);
        let drifts = self.free.contains(&FitParameter::Drift);
        let units = self.units.unwrap_or_default();
        let in_si = units.in_si();
        let at = root.member("loops");
        let loops: Option<Vec<LoopRecord>> = if FIT_LOOPS.contains(&self.loops.len()) {
            let loops = self.loops.into_iter().enumerate();
            loops.map(|(index, one)| one.check(in_si, drifts, at.index(index), faults)).collect()
        } else {
            None
        };
        let known = self.known.unwrap_or_default();
        known.check(root.member("known"), faults);
        let noise = self.noise.unwrap_or_default();
        noise.check_members(root.member("noise"), faults);
        setup.zip(loops).map(|(setup, loops)| FitTask {
            definition: self.contact,
            setup,
            loops,
            free: self.free,
            known,
            noise,
            units,
        })
    }
}
