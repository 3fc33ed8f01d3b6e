//! The contacts of the figures. All figures are normalised, so that they hold whatever these are made of.

use super::POINTS;
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Preload, Profile, Setup, Sphere, Tangential};

pub(super) fn contact_of(profile: Profile, friction: f64, preload: Preload) -> Result<Contact, Error> {
    let elasticity = Elasticity::effective(1.15e11, 8.5e10)?;
    Contact::new(Setup { profile, elasticity, friction, preload })
}

/// A contact of the radius 1e-4 m.
pub(super) fn small_contact(profile: Profile, friction: f64) -> Result<Contact, Error> {
    contact_of(profile, friction, Preload::ContactRadius(1e-4))
}

/// A ball of the radius 1 cm under 10 N.
pub(super) fn ball_under_load() -> Result<Contact, Error> {
    contact_of(ball()?, 0.3, Preload::NormalForce(10.0))
}

pub(super) fn ball() -> Result<Profile, Error> {
    Ok(Profile::Sphere(Sphere::new(0.01)?))
}

/// The move to a displacement, m.
pub(super) fn to(displacement: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() }
}

/// tau over mu p_max over r/a, through every extremum.
pub(super) fn shear_curve(contact: &Contact) -> Vec<(f64, f64)> {
    let (edge, unit) = (contact.contact_radius(), contact.summary().unit_shear());
    let mut radii: Vec<f64> = (0..=POINTS).map(|index| edge * index as f64 / POINTS as f64).collect();
    radii.extend(contact.residual().peaks.iter().map(|peak| peak.radius));
    radii.sort_by(f64::total_cmp);
    radii.iter().map(|&r| (r / edge, contact.shear(r) / unit)).collect()
}
