//! Profiles of contacts along a line, and the bulk stress that comes with their tangential force.

use stickslip_mechanics::profile::{LineBulk, LineContact, Profile as Shape};

use super::check::accepted;
use crate::prelude::*;

requests! {
/// A cylinder pressed along a line on a flat, in plane strain.
pub struct CylinderProfile {
    /// Radius R, m; for two cylinders 1/R = 1/R₁ + 1/R₂.
    pub radius: f64 = range::LENGTH,
    /// Length L of the contact, m; forces are totals over this length.
    pub length: f64 = range::LENGTH,
    /// The length that fixes the displacements, m: dδ = 2/(π E* L) ln(reference_length/t) dF_N for the half-width t.
    /// If left out, twice the radius. Half-widths must stay below nine tenths of it; stresses, forces and the work of
    /// closed cycles under a force do not depend on it.
    pub reference_length: Option<f64> = range::LENGTH,
}

/// A flat pad with rounded edges pressed along a line on a flat, in plane strain.
pub struct RoundedPadProfile {
    /// Half-width b of the flat, m.
    pub flat_half_width: f64 = range::LENGTH,
    /// Radius R of the edges, m.
    pub edge_radius: f64 = range::LENGTH,
    /// Length L of the contact, m; forces are totals over this length.
    pub length: f64 = range::LENGTH,
    /// The length that fixes the displacements, m, as for a cylinder. If left out, `length`.
    pub reference_length: Option<f64> = range::LENGTH,
}

/// A bulk stress along x in one of the bodies, in proportion to the tangential force and in phase with it.
pub struct BulkPerForce {
    /// The body that carries the stress.
    pub body: BodyName,
    /// The stress over the tangential force, Pa/N; tension is positive.
    pub stress_per_force: f64 = range::STRESS_PER_FORCE,
}
}

impl CylinderProfile {
    /// The checked profile; its faults are noted at `at`.
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
        made(LineContact::cylinder(self.radius, self.length, self.reference_length), at, faults)
    }
}

impl RoundedPadProfile {
    /// The checked profile; its faults are noted at `at`.
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
        let RoundedPadProfile { flat_half_width, edge_radius, length, reference_length } = *self;
        made(LineContact::rounded_pad(flat_half_width, edge_radius, length, reference_length), at, faults)
    }
}

fn made(line: Result<LineContact, Error>, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
    if let Err(Error::OutOfRange { .. }) = &line {
        // Each number has passed its own check: the reference length is too short for the flat.
        return accepted(line.map(Shape::Line), at.member("reference_length"), faults);
    }
    accepted(line.map(Shape::Line), at, faults)
}

impl BulkPerForce {
    /// The profile with this stress; what is refused of it is noted at `at`.
    pub(super) fn check(
        &self,
        shape: &Shape,
        material: &Material,
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) -> Option<Shape> {
        faults.none_within(at)?;
        let Some(bodies) = material.checked_bodies() else {
            return faults
                .refuse(at, "the strain of a bulk stress needs the constants of the body: name the two bodies");
        };
        let body = bodies[usize::from(self.body == BodyName::Second)];
        let bulk = LineBulk::new(self.body.into(), self.stress_per_force, body);
        let found = match shape {
            Shape::Line(line) => bulk.and_then(|bulk| line.clone().with_bulk(bulk)),
            _ => Err(Error::BulkTooLarge { stress_per_force: self.stress_per_force, largest: 0.0 }),
        };
        match found {
            Ok(line) => Some(Shape::Line(line)),
            Err(error) => {
                faults.unanswerable(at, error);
                None
            }
        }
    }
}
