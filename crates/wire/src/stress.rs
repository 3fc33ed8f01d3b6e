//! Stress requests and their answers.

use crate::prelude::*;

/// Radii of a round contact, and places of a line contact.
pub(crate) const STRESS_RADII: Array<Range> = Array(1..=10_000, range::CONTACT_RADIUS);
pub(crate) const STRESS_PLACES: Array<Range> = Array(1..=10_000, range::PLACE);

requests! {
/// Where stresses are asked for: exactly one of `points` and `radii` (for a line contact `x`), and which `fields`.
#[schema(example = json!({"points": 200}))]
pub struct StressRequest: Default {
    /// Number of radii, evenly spaced from the centre to the edge of the contact, both included; for a line contact
    /// from the edge at −a to the edge at a.
    pub points: Option<usize> = STRESS_POINTS,
    /// Radii in a round contact, m; outside the contact the stresses are zero.
    pub radii: Option<Vec<f64>> = STRESS_RADII,
    /// Places along x in a line contact, m.
    pub x: Option<Vec<f64>> = STRESS_PLACES,
    /// Which fields are computed; if left out, `pressure` and `shear`.
    pub fields: Option<Vec<Field>>,
}
}

words! {
/// A quantity along the radius.
pub enum Field {
    /// Normal pressure p(r), Pa.
    Pressure = "pressure",
    /// Shear stress τ(r), Pa; a positive displacement of the indenter gives a positive stress.
    Shear = "shear",
    /// Slip U − u(r) under the indenter since the preload, m; `null` outside the contact.
    Slip = "slip",
    /// Tangential displacement u(r) of the surface, m, inside the contact and outside.
    Displacement = "displacement",
    /// Hoop stress τ(r) of a contact that is twisted, Pa; a positive angle gives a positive stress.
    Hoop = "hoop",
}
}

replies! {
/// Stresses along the radius; an array that was not asked for is left out.
pub struct Stress: Default omits Option {
    /// Radii in a round contact, m.
    pub radius: Option<Vec<f64>>,
    /// Places along x in a line contact, m.
    pub x: Option<Vec<f64>>,
    /// Normal pressure, Pa; compression is positive; `null` where it is infinite.
    pub pressure: Option<Vec<Option<f64>>>,
    /// Shear stress, Pa; positive as a positive displacement causes it; `null` where it is infinite.
    pub shear: Option<Vec<Option<f64>>>,
    /// Slip U − u(r), the displacement of the indenter less that of the surface, m; `null` outside the contact.
    pub slip: Option<Vec<Option<f64>>>,
    /// Tangential displacement u(r) of the surface, m; positive along x.
    pub displacement: Option<Vec<Option<f64>>>,
    /// Hoop stress of a contact that is twisted, Pa; positive as a positive angle causes it.
    pub hoop: Option<Vec<Option<f64>>>,
}
}

impl Stress {
    /// The places: radii or, of a line contact, x, m.
    pub fn places(&self) -> &[f64] {
        self.radius.as_deref().or(self.x.as_deref()).unwrap_or_default()
    }
}

impl StressRequest {
    /// Checks the request, whose faults are noted at `at`.
    pub fn check(self, at: JsonPath<'_>, faults: &mut Faults) -> Option<StressRequest> {
        self.check_limits(at, faults);
        self.checked(at, faults)
    }

    /// The same beside the limits of its members.
    pub(crate) fn checked(self, at: JsonPath<'_>, faults: &mut Faults) -> Option<StressRequest> {
        faults.none_within(at)?;
        if self.fields.as_ref().is_some_and(Vec::is_empty) {
            let all = Field::ALL.map(Field::name).join("`, `");
            return faults.refuse(at.member("fields"), format_args!("empty: name at least one of `{all}`"));
        }
        match (self.points.is_some(), self.radii.is_some(), self.x.is_some()) {
            (true, false, false) | (false, true, false) | (false, false, true) => Some(self),
            (false, false, false) => faults.refuse(at, "give one of `points` and `radii`, or `x` of a line contact"),
            (true, true, _) => faults.refuse(at, "`points` conflicts with `radii`: give one of them"),
            (.., true) => faults.refuse(at.member("x"), "it conflicts with `points` and `radii`: give one of them"),
        }
    }

    /// Whether a field is asked for.
    pub fn wants(&self, field: Field) -> bool {
        self.fields.as_deref().unwrap_or(&[Field::Pressure, Field::Shear]).contains(&field)
    }

    /// How many places there are.
    pub fn length(&self) -> usize {
        self.points.unwrap_or_else(|| self.radii.as_ref().or(self.x.as_ref()).map_or(0, Vec::len))
    }

    /// The places, m, in a contact of this radius or half-width, m: radii or, of a line contact, x from edge to edge.
    pub fn places(&self, line: bool, size: f64) -> Vec<f64> {
        let Some(count) = self.points else {
            return self.radii.as_ref().or(self.x.as_ref()).cloned().unwrap_or_default();
        };
        let last = count.saturating_sub(1) as f64;
        // Quotients: the last point is the edge itself, and those of a line are mirror images of each other.
        let share = |index: f64| if line { (2.0 * index - last) / last } else { index / last };
        (0..count).map(|index| size * share(index as f64)).collect()
    }
}
