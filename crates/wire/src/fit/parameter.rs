//! The quantities that a fit to a measured loop can determine, and what is known of them beforehand.

use crate::prelude::*;

/// The compliance of a machine: zero is a rigid one.
const COMPLIANCE: Range = Range { quantity: Quantity::MachineStiffness, unit: "m/N", min: 0.0, max: 1e9 };
/// A drift of the displacement.
const DRIFT: Range = Range { quantity: Quantity::Displacement, unit: "m/s", min: -1e9, max: 1e9 };
/// A delay of the force.
const DELAY: Range = Range { quantity: Quantity::Number, unit: "s", min: -1e9, max: 1e9 };
/// A drift of the gain.
const GAIN_DRIFT: Range = Range { quantity: Quantity::Number, unit: "1/s", min: -1e9, max: 1e9 };
/// A value in the unit of its quantity, whatever that is.
const VALUE: Range = Range { quantity: Quantity::Number, unit: "", min: -1e20, max: 1e20 };
/// Its standard error.
const STANDARD_ERROR: Range = Range { quantity: Quantity::Number, unit: "", min: 0.0, max: 1e20 };

/// Declares the quantities from one table: variant, name, its word in JSON, range, description.
macro_rules! parameters {
    ($($variant:ident $name:ident $word:tt $range:expr, $doc:literal;)*) => {
        words! {
            /// A quantity of the contact or of the bench that a fit can determine.
            pub enum FitParameter: PartialOrd, Ord {
                $(#[doc = $doc] $variant = $word,)*
            }
        }

        impl FitParameter {
            /// Its range, with its unit.
            pub fn range(self) -> Range {
                match self {
                    $(FitParameter::$variant => $range,)*
                }
            }
        }

        requests! {
            /// Values known beforehand, by name.
            pub struct KnownValues: Copy, Default {
                $(#[doc = $doc] pub $name: Option<KnownValue>,)*
            }
        }

        impl KnownValues {
            /// What is known, in the order of [`FitParameter::ALL`].
            pub fn iter(&self) -> impl Iterator<Item = (FitParameter, KnownValue)> + use<> {
                let all = [$((FitParameter::$variant, self.$name)),*];
                all.into_iter().filter_map(|(parameter, known)| Some((parameter, known?)))
            }

            /// Where the value of this name is.
            pub fn entry(&mut self, parameter: FitParameter) -> &mut Option<KnownValue> {
                match parameter {
                    $(FitParameter::$variant => &mut self.$name,)*
                }
            }
        }
    };
}

parameters! {
    Friction friction "friction" range::FRICTION, "Coulomb's coefficient of friction μ, a pure number.";
    GStar g_star "g_star" range::G_STAR, "Reduced shear modulus G*, Pa.";
    EStar e_star "e_star" range::E_STAR, "Reduced modulus E*, Pa.";
    Radius radius "radius" range::RADIUS, "Radius of a sphere, m.";
    MachineCompliance machine_compliance "machine_compliance" COMPLIANCE,
        "Compliance of the machine in series with the contact, m/N.";
    DisplacementOffset displacement_offset "displacement_offset" range::DISPLACEMENT,
        "Measured displacement at which the contact is not displaced, m.";
    ForceOffset force_offset "force_offset" range::FORCE, "Measured force at zero force on the contact, N.";
    Drift drift "drift" DRIFT, "Drift rate of the zero of the displacement, m/s.";
    Delay delay "delay" DELAY, "Time by which the measured force follows the measured displacement, s.";
    GainDrift gain_drift "gain_drift" GAIN_DRIFT,
        "Rate at which the gain of the force drifts, relative to the gain at time zero, 1/s.";
    ShearStrength shear_strength "shear_strength" range::SHEAR_STRENGTH,
        "Shear strength of the interface τ₀ beside friction, Pa.";
}

requests! {
/// A value that is known from elsewhere.
pub struct KnownValue: Copy {
    /// The value, in the SI unit of its quantity.
    pub value: f64 = VALUE,
    /// Its standard error, in the same unit; zero, the default, holds the value fixed.
    pub standard_error: Option<f64> = STANDARD_ERROR,
}
}

impl FitParameter {
    /// Whether only the times of the points determine it.
    pub(super) fn needs_time(self) -> bool {
        matches!(self, FitParameter::Drift | FitParameter::Delay | FitParameter::GainDrift)
    }
}

impl KnownValues {
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) {
        for (parameter, known) in self.iter() {
            let (name, range) = (parameter.name(), parameter.range());
            let at = at.member(name);
            if VALUE.contains(known.value) && !range.contains(known.value) {
                faults.add(at.member("value"), format_args!("{:?} is invalid: {name} is {range}", known.value));
            }
        }
    }
}
