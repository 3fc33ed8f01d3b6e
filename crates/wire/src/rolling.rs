//! The body of `POST /rolling` and its reply: a cylinder that rolls steadily.

use stickslip_mechanics::rolling::Drive;

use crate::prelude::*;

/// Points of the curves if the request does not say.
const DEFAULT_POINTS: usize = 200;
/// A force over μ F_N below gross slip, or a creep.
const DRIVE: Range = Range { quantity: Quantity::RollingRatio, unit: "", min: -1e9, max: 1e9 };

requests! {
/// A cylinder that rolls towards +x and carries a tangential force: one of `ratio` and `creep`. Nothing is stored.
#[schema(example = json!({"contact": RollingRequest::example_contact(), "ratio": 0.5}))]
pub struct RollingRequest {
    /// The contact; its profile is a `cylinder`.
    pub contact: ContactDefinition,
    /// Tangential force over μ F_N, a pure number between −1 and 1; positive along +x.
    pub ratio: Option<f64> = DRIVE,
    /// Creep, a pure number below μ a/R in magnitude; positive with a positive force.
    pub creep: Option<f64> = DRIVE,
    /// Number of places of the curves, evenly spaced from −a to a; 200 if left out.
    pub points: Option<usize> = STRESS_POINTS,
}
}

replies! {
/// Creep, stick zone and tractions of a cylinder that rolls steadily.
pub struct RollingReply {
    /// The contact at its preload.
    pub contact: ContactSummary,
    /// Tangential force over μ F_N, a pure number.
    pub ratio: f64,
    /// Creep, a pure number.
    pub creep: f64,
    /// Where the stick zone begins and ends along x, m; it ends at the leading edge.
    pub stick: [f64; 2],
    /// Places along x, m, from the trailing edge −a to the leading edge a.
    pub x: Vec<f64>,
    /// Pressure, Pa.
    pub pressure: Vec<f64>,
    /// Shear stress, Pa; positive with a positive force.
    pub shear: Vec<f64>,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}
}

impl RollingRequest {
    /// Two steel cylinders of 50 mm radius as one of 25 mm.
    pub fn example_contact() -> Value {
        let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
        json!({
            "profile": {"type": "cylinder", "radius": 0.025, "length": 0.01},
            "material": {"bodies": [steel, steel]},
            "friction": 0.3,
            "preload": {"normal_force": 1000.0}
        })
    }

    /// Places of the curves.
    pub fn points(&self) -> usize {
        self.points.unwrap_or(DEFAULT_POINTS)
    }
}

impl Document for RollingRequest {
    type Checked = (RollingRequest, SharedSetup, Drive);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let contact = JsonPath::Root.member("contact");
        let setup = self.contact.check(contact, profiles, faults);
        if !matches!(self.contact.profile, Profile::Cylinder(_)) {
            faults.add(contact.member("profile"), Error::OnlyCylinder);
        }
        if self.contact.bulk.is_some() {
            faults.add(contact.member("bulk"), "a bulk stress does not follow the force of rolling: leave it out");
        }
        let drive = match (self.ratio, self.creep) {
            (Some(ratio), None) => Some(Drive::Ratio(ratio)),
            (None, Some(creep)) => Some(Drive::Creep(creep)),
            _ => faults.refuse(JsonPath::Root, "expected one of `ratio`, `creep`"),
        };
        Some((self, setup?, drive?))
    }
}
