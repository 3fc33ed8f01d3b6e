//! The law of a contact that is moved in the plane step by step, for a program with equations of motion of its own.
//!
//! A contact keeps its rings from step to step. They have equal areas, which are doubled where the contact outgrows its
//! rings, and halved where few of them are left. A step is made by the rings that touch before or after it: m rings of
//! equal area have the matrix of [`RingStiffness`] for m, whatever the contact was divided into. The state is the force
//! on each ring, which would be tau + K dU if all rings stuck, and so includes the slip of all steps before.

mod contact;
mod packed;

pub use contact::PlanarContact;

use std::sync::{Arc, OnceLock};

use super::load::load_between;
use super::step::{Increment, PlanarBuffers, RingState, Units, dot};
use super::stiffness::{RingStiffness, Vector};
use super::{PlanarState, TURNED, contact_of};
use crate::contact::Contact;
use crate::contact::state::{Normal, Setup};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Profile;
use crate::range;
use crate::range::error::Error;

/// The part of the indentation to which a contact is unloaded at once.
const UNLOADED: f64 = 0.5;
/// The part of all rings from which on their areas are halved is one over this.
const FEWEST: usize = 4;

/// The law of all contacts of one definition, with the matrices of their rings.
///
/// ```
/// use stickslip_mechanics::rings::{PlanarBuffers, PlanarLaw};
#[doc = include_str!("../example.txt")]
/// let law = PlanarLaw::new(setup, 40)?;
/// let (mut ball, mut buffers) = (law.start(), PlanarBuffers::default());
/// // Half-way to gross slip in a direction of 3 to 4 (Cattaneo 1938): F = mu F_N (1 - (1 - U/u_max)^(3/2)).
/// law.step(&mut ball, Normal::Indentation(0.01), [0.6 * 0.00375, 0.8 * 0.00375], &mut buffers)?;
/// let exact = 2000.0 * (1.0 - 0.5_f64.powf(1.5));
/// let [x, y] = ball.force();
/// assert!((x - 0.6 * exact).hypot(y - 0.8 * exact) < 2e-4 * 2000.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug)]
pub struct PlanarLaw {
    /// At its preload.
    contact: Contact,
    /// The matrices of 1, 2, ... rings.
    matrices: Box<[OnceLock<RingStiffness>]>,
}

impl PlanarLaw {
    /// The law of a definition, by at most so many rings in [`range::RING_COUNT`]: a contact that keeps its radius has
    /// all of them, one whose radius changes a quarter of them at least.
    ///
    /// # Errors
    /// Those of [`Contact::new`]; [`Error::OutOfRange`] for the number of rings; [`Error::NoStressField`] for a profile
    /// whose pressure is not known, [`Error::LineContact`] for one that is not round.
    pub fn new<P: Into<Arc<Profile>>>(setup: Setup<P>, rings: usize) -> Result<PlanarLaw, Error> {
        range::RING_COUNT.check(rings as f64)?;
        Ok(PlanarLaw { contact: contact_of(setup)?, matrices: (0..rings).map(|_| OnceLock::new()).collect() })
    }

    /// The contact of the definition at its preload, which moves along a line.
    #[must_use]
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// The virgin contact at its preload.
    #[must_use]
    pub fn start(&self) -> PlanarContact {
        let mut start = PlanarContact {
            indentation: self.contact.indentation(),
            normal_force: self.contact.normal_force(),
            radius: self.contact.contact_radius(),
            displacement: [0.0; 2],
            force: [0.0; 2],
            stick_radius: if self.contact.friction() > 0.0 { self.contact.contact_radius() } else { 0.0 },
            dissipated: 0.0,
            elastic: 0.0,
            unsettled: 0.0,
            area: 0.0,
            rings: Vec::new(),
        };
        let mut buffers = PlanarBuffers::default();
        self.cover(&mut start, &mut buffers);
        start.rings.iter_mut().zip(buffers.limits).for_each(|(ring, limit)| ring.bound = limit);
        start
    }

    /// Indentation, m, and normal force, N, of a target.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], and [`Error::BeyondProfile`] or [`Error::NotConvexEnough`] for a load that the profile
    /// has no contact for.
    pub fn load(&self, normal: Normal) -> Result<[f64; 2], Error> {
        let [indentation, force] = match normal {
            Normal::Indentation(depth) => [depth, self.contact.normal_force_at(DoubleDouble::from(depth))],
            Normal::NormalForce(force) => {
                [self.contact.indentation_for(range::check_normal_force(force)?).value(), force]
            }
        };
        self.contact.check_indentation(indentation)?;
        Ok([indentation, force])
    }

    /// Moves a contact straight to a load and a displacement, m. A step in which a ring slips or the load changes is
    /// made as a whole and in halves, and what both say is extrapolated: it is of second order in the change of the
    /// load and in that of the direction of slip. A contact that parts loses its history; the next one sticks where it
    /// is met. An error leaves the contact as it was.
    ///
    /// # Errors
    /// As [`PlanarLaw::load`], and [`Error::OutOfRange`] for a displacement outside [`range::DISPLACEMENT`].
    pub fn step(
        &self,
        contact: &mut PlanarContact,
        normal: Normal,
        displacement: [f64; 2],
        buffers: &mut PlanarBuffers,
    ) -> Result<(), Error> {
        for component in displacement {
            range::DISPLACEMENT.check(component)?;
        }
        let load = self.load(normal)?;
        let by = [0, 1].map(|axis| displacement[axis] - contact.displacement[axis]);
        let far = by[0].hypot(by[1]) > TURNED * self.full(contact.indentation.max(load[0]));
        while load[0] > 0.0 && load[0] < UNLOADED * contact.indentation {
            let left = UNLOADED * contact.indentation;
            let part = if far { 0.0 } else { (contact.indentation - left) / (contact.indentation - load[0]) };
            let here = contact.displacement;
            let to = [0, 1].map(|axis| here[axis] + part * (displacement[axis] - here[axis]));
            self.single_step(contact, [left, self.contact.normal_force_at(DoubleDouble::from(left))], to, buffers);
        }
        if far {
            self.far_step(contact, load, displacement, buffers);
            return Ok(());
        }
        let changes = contact.carries_another(load);
        let mut whole = contact.clone();
        self.single_step(&mut whole, load, displacement, buffers);
        let slips = whole.stick_radius < whole.radius;
        if !(slips || changes) || contact.rings.is_empty() || whole.rings.is_empty() {
            *contact = whole;
            return Ok(());
        }
        let middle = [0, 1].map(|axis| 0.5 * (contact.displacement[axis] + displacement[axis]));
        let ends = [[contact.indentation, contact.normal_force], load];
        let half_load = load_between(&self.contact, ends, matches!(normal, Normal::NormalForce(_)), 0.5);
        let half_load = if changes { half_load } else { load };
        let dissipated = contact.dissipated;
        self.single_step(contact, half_load, middle, buffers);
        self.single_step(contact, load, displacement, buffers);
        contact.extrapolate(&whole, dissipated);
        Ok(())
    }

    /// The displacement of gross slip, m, at an indentation, m.
    fn full(&self, indentation: f64) -> f64 {
        self.contact.scale() * indentation.max(0.0)
    }

    /// A step to a load and a displacement, m, so far away that all rings slip along it in the end: its beginning in
    /// two steps, and then nothing but the friction work grows.
    fn far_step(&self, contact: &mut PlanarContact, load: [f64; 2], displacement: Vector, buffers: &mut PlanarBuffers) {
        let by = [0, 1].map(|axis| displacement[axis] - contact.displacement[axis]);
        let (distance, full) = (by[0].hypot(by[1]), self.full(contact.indentation.max(load[0])));
        let along = by.map(|component| component / distance);
        for _ in 0..2 {
            let to = [0, 1].map(|axis| contact.displacement[axis] + 0.5 * TURNED * full * along[axis]);
            self.single_step(contact, load, to, buffers);
        }
        contact.displacement = displacement;
        contact.force = [0.0; 2];
        for ring in &mut contact.rings {
            ring.traction = along.map(|component| component * ring.bound);
            contact.dissipated += (distance - TURNED * full) * ring.bound;
            contact.force = [0, 1].map(|axis| contact.force[axis] + ring.traction[axis]);
        }
        if !contact.rings.is_empty() {
            contact.stick_radius = 0.0;
        }
    }

    /// One step to a load, which is that of an indentation, m, and a normal force, N, and to a displacement, m: of
    /// first order.
    fn single_step(
        &self,
        contact: &mut PlanarContact,
        [indentation, normal_force]: [f64; 2],
        displacement: [f64; 2],
        buffers: &mut PlanarBuffers,
    ) {
        let by = [0, 1].map(|axis| displacement[axis] - contact.displacement[axis]);
        let full = self.full(contact.indentation.max(indentation));
        contact.displacement = displacement;
        if contact.carries_another([indentation, normal_force]) {
            (contact.indentation, contact.normal_force) = (indentation, normal_force);
            contact.radius = if indentation < 0.0 { 0.0 } else { self.contact.indenter.radius(indentation) };
            self.cover(contact, buffers);
        } else {
            buffers.limits.clear();
            buffers.limits.extend(contact.rings.iter().map(|ring| ring.bound));
        }
        if buffers.limits.is_empty() {
            // What was stored elastically is lost when the last ring parts.
            contact.dissipated += std::mem::take(&mut contact.elastic);
            (contact.force, contact.area) = ([0.0; 2], 0.0);
            contact.rings.clear();
            contact.stick_radius = contact.radius;
        } else {
            self.slip(contact, by, full, buffers);
            while FEWEST * contact.rings.len() <= self.matrices.len() {
                contact.area *= 0.5;
                self.limits(contact, buffers);
                contact.split(&buffers.limits);
            }
        }
        let sticks = self.contact.friction() > 0.0;
        contact.stick_radius = if sticks { contact.stick_radius.min(contact.radius) } else { 0.0 };
    }

    /// The limits of the rings under the load of a contact, with rings where it has grown; none without a load.
    fn cover(&self, contact: &mut PlanarContact, buffers: &mut PlanarBuffers) {
        buffers.limits.clear();
        if contact.normal_force <= 0.0 || contact.radius <= 0.0 {
            return;
        }
        let most = self.matrices.len() as f64;
        if contact.area <= 0.0 {
            contact.area = contact.radius * contact.radius / most;
        }
        while contact.touching() > most {
            contact.merge();
        }
        self.limits(contact, buffers);
        contact.rings.resize(buffers.limits.len().max(contact.rings.len()), RingState::default());
    }

    /// Friction times the load of each ring, N.
    fn limits(&self, contact: &PlanarContact, buffers: &mut PlanarBuffers) {
        let limit = self.contact.friction() * contact.normal_force;
        let radii = (0..contact.touching() as usize).map(|index| (index as f64 * contact.area).sqrt());
        buffers.press(self.contact.indenter(), [contact.indentation, contact.radius], limit, radii);
    }

    /// Moves the indenter by a vector, m, and asks Coulomb's law of each ring; `full` is the displacement of gross
    /// slip, m.
    fn slip(&self, contact: &mut PlanarContact, by: Vector, full: f64, buffers: &mut PlanarBuffers) {
        let (count, touching) = (contact.rings.len(), buffers.limits.len());
        buffers.limits.resize(count, 0.0);
        let matrix = self.matrices[count - 1].get_or_init(|| RingStiffness::new(count));
        let stiffness = self.contact.elasticity().g_star() * (count as f64 * contact.area).sqrt();
        let dissipated = &mut contact.dissipated;
        let visit = &mut |_: usize, before: &RingState, ring: &RingState| {
            // It slips at the end of the step, from the force on that it had reached until then.
            let size = ring.slip[0].hypot(ring.slip[1]);
            let end = ring.bound * size;
            let begin =
                if ring.bound < before.bound { dot(before.traction, ring.slip).max(end) } else { before.bound * size };
            *dissipated += 0.5 * (begin + end);
        };
        let (units, increment) = (Units { stiffness, full }, Increment::Displacement(by));
        let done = buffers.step(&mut contact.rings, matrix, units, increment, visit);
        (contact.force, contact.unsettled) = (done.force, done.unsettled);
        contact.elastic = (contact.elastic + done.elastic).max(0.0);
        contact.stick_radius = done.first_slip.map_or(contact.radius, |first| (first as f64 * contact.area).sqrt());
        contact.rings.truncate(touching);
    }
}
