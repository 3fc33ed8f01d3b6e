//! The quantities that a fit to a measured loop can determine, and what is known of them beforehand.

use serde::{Deserialize, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;

use stickslip_mechanics::range::{self, Quantity, Range};

use crate::check::{Faults, JsonPath};
use crate::limits::Limited as _;
use crate::request::{not_null, object, requests};

/// The compliance of a machine: zero is a rigid one.
const COMPLIANCE: Range = Range { quantity: Quantity::MachineStiffness, unit: "m/N", min: 0.0, max: 1e9 };
/// A drift of the displacement.
const DRIFT: Range = Range { quantity: Quantity::Displacement, unit: "m/s", min: -1e9, max: 1e9 };
/// A value in the unit of its quantity, whatever that is.
const VALUE: Range = Range { quantity: Quantity::Number, unit: "", min: -1e20, max: 1e20 };
/// Its standard error.
const STANDARD_ERROR: Range = Range { quantity: Quantity::Number, unit: "", min: 0.0, max: 1e20 };

/// Declares the quantities from one table: variant, name, range, description.
macro_rules! parameters {
    ($($variant:ident $name:ident $range:expr, $doc:literal;)*) => {
        /// A quantity of the contact or of the bench that a fit can determine.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, ToSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum FitParameter {
            $(#[doc = $doc] $variant,)*
        }

        impl FitParameter {
            /// All of them.
            pub const ALL: [FitParameter; [$(stringify!($name)),*].len()] = [$(FitParameter::$variant),*];

            /// Its name in JSON.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(FitParameter::$variant => stringify!($name),)*
                }
            }

            /// Its range, with its unit.
            #[must_use]
            pub fn range(self) -> Range {
                match self {
                    $(FitParameter::$variant => $range,)*
                }
            }
        }

        /// What is known beforehand, by name.
        #[skip_serializing_none]
        #[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
        #[serde(deny_unknown_fields, remote = "Self")]
        pub struct KnownValues {
            $(#[doc = $doc] pub $name: Option<KnownValue>,)*
        }
        object!(KnownValues);

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
    Friction friction range::FRICTION, "Coulomb's coefficient of friction μ, a pure number.";
    GStar g_star range::G_STAR, "Reduced shear modulus G*, Pa.";
    EStar e_star range::E_STAR, "Reduced modulus E*, Pa.";
    Radius radius range::RADIUS, "Radius of a sphere, m.";
    MachineCompliance machine_compliance COMPLIANCE, "Compliance of the machine in series with the contact, m/N.";
    DisplacementOffset displacement_offset range::DISPLACEMENT, "Measured displacement at which the contact is not \
        displaced, m.";
    ForceOffset force_offset range::FORCE, "Measured force at which there is none, N.";
    Drift drift DRIFT, "How fast the zero of the displacement wanders, m/s.";
}

requests! {
/// A value that is known from elsewhere.
pub struct KnownValue: Copy {
    /// The value, in the SI unit of its quantity.
    pub value: f64 = VALUE,
    /// Its standard error, in the same unit; zero, which is the default, holds the value.
    pub standard_error: Option<f64> = STANDARD_ERROR,
}
}

impl KnownValues {
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) {
        for (parameter, known) in self.iter() {
            let (name, range) = (parameter.name(), parameter.range());
            let at = at.member(name);
            known.check_members(at, faults);
            if VALUE.contains(known.value) && !range.contains(known.value) {
                faults.add(at.member("value"), format_args!("{:?} is no {name}, which is {range}", known.value));
            }
        }
    }
}
