//! What the points of a sweep share: a profile that no axis changes is checked and made once, and so is the whole
//! contact if no axis changes that.

use std::sync::Arc;

use stickslip_wire::Solver;
use stickslip_wire::sweep::{CheckedSweep, Pointer};

use crate::prelude::*;
use crate::simulation::run::simulate_on;
use crate::simulation::simulate_any;

#[derive(Debug)]
pub(super) struct Shared {
    profile: Arc<Profile>,
    /// The virgin contact, unless an axis changes it or there is none.
    contact: Option<Contact>,
}

/// A profile that is cheap to parse, in the base of points that share another.
pub(super) fn placeholder() -> Value {
    json!({"type": "sphere", "radius": 1.0})
}

impl Shared {
    /// What one of the points shares with all the others; `None` if not even the profile.
    pub(super) fn of(point: Simulation, sweep: &CheckedSweep) -> Option<Shared> {
        let changed = |member: &str| {
            let begins =
                |pointer: &Pointer| pointer.segments().iter().map(String::as_str).take(2).eq(["contact", member]);
            sweep.pointers().any(begins)
        };
        // A bulk stress is one of the profile, and a line contact is quickly made.
        let bound = point.definition.bulk.is_some();
        if bound || changed("profile") || point.definition.profile.depends_on_bodies() && changed("material") {
            return None;
        }
        let members = ["material", "friction", "shear_strength", "adhesion", "preload", "prony"];
        let fixed = !members.into_iter().any(changed);
        let profile = Arc::clone(&point.setup.profile);
        let contact = fixed.then(|| Contact::new(point.setup).ok());
        Some(Shared { profile, contact: contact.flatten() })
    }

    /// The reply to a point whose profile is the placeholder.
    pub(super) fn simulate(&self, mut point: Simulation, stop: &dyn Stop) -> Result<SimulationReply, Failure> {
        if matches!(point.solver, Some(Solver::Springs(_))) || matches!(point.plan, Plan::Plane(_)) {
            point.setup.profile = Arc::clone(&self.profile);
            return simulate_any(&point, stop);
        }
        let timer = Timer::start(stop);
        let contact = match &self.contact {
            Some(contact) => contact.clone(),
            None => {
                point.setup.profile = Arc::clone(&self.profile);
                contact(point.setup.clone(), "/contact")?
            }
        };
        simulate_on(contact, &point, timer, stop).map(SimulationReply::Line)
    }
}
