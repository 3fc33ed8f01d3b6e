//! What a scan says, against shapes whose contact is known.

mod coverage;
mod faults;
mod given;
mod known_shapes;
mod synthetic;
mod unmodelled;

use stickslip_mechanics::profile::Profile;
use stickslip_mechanics::{Contact, ContactSummary, Elasticity, Preload, Setup, elasticity::Body};

/// Steel on a rigid plane.
fn steel() -> Elasticity {
    Elasticity::against_rigid(Body::new(2.1e11, 0.3).unwrap())
}

/// The contact of a known shape.
fn truth(profile: Profile, preload: Preload) -> ContactSummary {
    Contact::new(Setup { profile, elasticity: steel(), friction: 0.3, preload }).unwrap().summary()
}
