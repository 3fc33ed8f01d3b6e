//! What to know about a result that is nevertheless given.

use crate::mechanics::Elasticity;
use crate::wire::{Profile, Warning};

/// Dundurs' β beyond which the bodies are no longer called alike; round-off of like bodies stays below it.
const BETA: f64 = 1e-12;
/// The ratio of contact radius to radius of curvature up to which a half-space stands for the body.
const LARGE_CONTACT: f64 = 0.3;

/// The warnings for a pair of bodies, and the largest contact radius (m) that is known.
#[must_use]
pub fn warnings(profile: &Profile, elasticity: &Elasticity, contact_radius: f64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if let Some(beta) = elasticity.dundurs_beta().filter(|beta| beta.abs() > BETA) {
        warnings.push(Warning {
            code: "dundurs_beta".to_owned(),
            message: format!(
                "the bodies are unlike (Dundurs' beta = {beta:.4}): pressing them together also shears them, which is neglected"
            ),
        });
    }
    let ratio = profile.curvature_radius().map_or(0.0, |curvature| contact_radius / curvature);
    if ratio > LARGE_CONTACT {
        warnings.push(Warning {
            code: "large_contact".to_owned(),
            message: format!(
                "the contact radius is {ratio:.3} of the radius of curvature: beyond {LARGE_CONTACT} a body is no longer a half-space"
            ),
        });
    }
    warnings
}
