//! The body of `POST /wear` and its reply: what fretting wear leaves.

use crate::prelude::*;

/// Points of the curves if the request does not say.
const DEFAULT_POINTS: usize = 200;

requests! {
/// A contact that is moved back and forth until it has worn to its limit. Nothing is stored.
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "drive": {"displacement": 1e-7},
    "hold": "indentation"
}))]
pub struct WearRequest {
    /// The contact. Its profile must have a stress field.
    pub contact: ContactDefinition,
    /// How it is moved.
    pub drive: WearDrive,
    /// The quantity that is held constant: `indentation`. Under a constant normal force the final shape depends on the
    /// course of wear, so `normal_force` is refused.
    pub hold: Hold,
    /// Number of radii of the curves, evenly spaced and with both ends; 200 if left out. Stick radius, contact radius
    /// and worn radius are added to them.
    pub points: Option<usize> = STRESS_POINTS,
}

/// The cycles that wear a contact.
pub struct WearDrive: Copy {
    /// Amplitude of the tangential displacement, m; below that of gross slip.
    pub displacement: f64 = Range { min: 0.0, ..range::DISPLACEMENT },
}
}

words! {
/// The quantity that is held constant while a contact wears.
pub enum Hold {
    /// The indentation.
    Indentation = "indentation",
    /// The normal force. Refused: no limit is known.
    NormalForce = "normal_force",
}
}

replies! {
/// The limit that wear approaches in a contact.
pub struct WearReply omits Option {
    /// The contact before wear.
    pub contact: ContactSummary,
    /// Stick radius c of the cycle, m: inside it nothing ever slips. It is the contact radius in the limit.
    pub stick_radius: f64,
    /// Radius up to which the surface wears, m.
    pub worn_radius: f64,
    /// The indentation, which is held, m.
    pub indentation: f64,
    /// The normal force, N.
    pub normal_force: WornForce,
    /// Amplitude of the tangential force in the limit, N, where the whole contact sticks.
    pub force_amplitude: f64,
    /// The volume that is removed, m³.
    pub removed_volume: f64,
    /// The largest depth that is removed.
    pub depth: WearDepth,
    /// The height of the undeformed surface above its lowest point, m, from the centre to beyond the worn radius.
    pub shape: WornShape,
    /// The pressure, Pa, at the same radii; in the limit it is infinite, and so `null`, at the stick radius.
    pub pressure: WornPressure,
    /// The limiting shape for the computations that follow: a table, or the profile itself if nothing wears; left out
    /// if it has none, with a warning that gives the reason. In the table a steep rise of g takes the place of the jump
    /// at the stick radius: with the jump itself the contact at this indentation would be ambiguous.
    pub profile: Option<Profile>,
    /// How far `profile` is from the limit; left out without `profile`. The errors that other computations state do not
    /// include it.
    pub profile_error: Option<WornProfileError>,
    /// Solver, errors and time: of the forces before wear, and of the table if the profile has one.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// How far a table is from the limiting shape.
pub struct WornProfileError: Copy, Default {
    /// Error of the normal force on the table at this indentation, relative to the limit, a pure number.
    pub normal_force: f64,
    /// Width of the range about the stick radius in which g of the table rises, where g of the limit jumps, m.
    pub rise_width: f64,
}

/// The normal force before wear, and in the limit.
pub struct WornForce: Copy, Default {
    /// Normal force before wear, N.
    pub before: f64,
    /// Normal force in the limit, N.
    pub after: f64,
}

/// The largest depth of the removed material.
pub struct WearDepth: Copy, Default of stickslip_mechanics::wear::WearDepth {
    /// The depth, m.
    pub largest: f64,
    /// The radius where it is, m.
    pub radius: f64,
}

/// The height of the surface over the radius, before wear and in the limit.
pub struct WornShape: Default {
    /// Radii, m, increasing.
    pub radius: Vec<f64>,
    /// Heights before wear, m.
    pub before: Vec<f64>,
    /// Heights in the limit, m.
    pub after: Vec<f64>,
}

/// The pressure over the radius, before wear and in the limit.
pub struct WornPressure: Default {
    /// Radii, m, increasing.
    pub radius: Vec<f64>,
    /// Pressure before wear, Pa; `null` where it is infinite.
    pub before: Vec<Option<f64>>,
    /// Pressure in the limit, Pa; `null` where it is infinite.
    pub after: Vec<Option<f64>>,
}
}

impl WearRequest {
    /// Points of each curve.
    pub fn points(&self) -> usize {
        self.points.unwrap_or(DEFAULT_POINTS)
    }
}

impl Document for WearRequest {
    type Checked = (WearRequest, SharedSetup);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.check(at("contact"), profiles, faults);
        if let Some(Err(error)) = setup.as_ref().map(|setup| setup.profile.check_wear()) {
            faults.unanswerable(at("contact").member("profile"), error);
        }
        if self.hold == Hold::NormalForce {
            faults.add(
                at("hold"),
                "normal_force: the indentation would grow while the surface wears, and its final shape depends on the \
                 course of wear, so there is no limit to compute; allowed is indentation",
            );
        }
        Some((self, setup?))
    }
}
