//! The law of a contact that is moved in the plane step by step, for a program with equations of motion of its own.
//!
//! A contact keeps its rings from step to step. They have equal areas, which are doubled where the contact outgrows its
//! rings, and halved where few of them are left. A step is made by the rings that touch before or after it: m rings of
//! equal area have the matrix of [`Mesh`] for m, whatever the contact was divided into. The state is the force on each
//! ring, which would be tau + K dU if all rings stuck, and so includes the slip of all steps before.

mod packed;

use std::sync::{Arc, OnceLock};

use super::load::beyond;
use super::mesh::{Mesh, Vector};
use super::slip::{Workspace, solve};
use super::{NO_SLIP, PlanarState, TURNED};
use crate::contact::Contact;
use crate::contact::state::{Normal, Regime, Setup};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Profile;
use crate::range;
use crate::range::error::Error;

/// The part of the indentation to which a contact is unloaded at once.
const UNLOADED: f64 = 0.5;
/// The part of its area by which a contact may exceed its rings: rounding.
const SAME_AREA: f64 = 1e-12;
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
    /// Those of 1, 2, ... rings.
    meshes: Box<[OnceLock<Mesh>]>,
}

/// One contact with the history of its rings.
#[derive(Clone, Debug)]
pub struct PlanarContact {
    indentation: f64,
    normal_force: f64,
    radius: f64,
    displacement: Vector,
    force: Vector,
    stick_radius: f64,
    dissipated: f64,
    elastic: f64,
    unsettled: f64,
    /// The area of a ring over pi, m^2; zero without a contact.
    area: f64,
    /// Those that touch, from the centre outwards.
    rings: Vec<Ring>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Ring {
    /// Friction times the normal force on it, N.
    bound: f64,
    /// The tangential force on it, N.
    traction: Vector,
    /// Its slip in the last step, m, with which the next one begins its search.
    slip: Vector,
}

/// What a step needs besides its contact: one for each thread.
#[derive(Clone, Debug, Default)]
pub struct PlanarBuffers {
    /// Friction times the load of each ring at the end of the step, N, and that beyond its inner edge.
    limits: Vec<f64>,
    outside: Vec<f64>,
    bounds: Vec<f64>,
    forces: Vec<Vector>,
    traction: Vec<Vector>,
    slip: Vec<Vector>,
    workspace: Workspace,
}

impl PlanarContact {
    /// Normal force F_N, N.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Tangential force, N.
    #[must_use]
    pub fn force(&self) -> [f64; 2] {
        self.force
    }

    /// The largest force of a ring that the search for its slip has left in the last step, N: rounding, unless the
    /// search did not end.
    #[must_use]
    pub fn unsettled_force(&self) -> f64 {
        self.unsettled
    }

    /// The state after the last step.
    #[must_use]
    pub fn state(&self) -> PlanarState {
        PlanarState {
            displacement: self.displacement,
            force: self.force,
            indentation: self.indentation,
            normal_force: self.normal_force,
            contact_radius: self.radius,
            stick_radius: self.stick_radius,
            regime: match self.stick_radius {
                _ if self.indentation < 0.0 => Regime::Separated,
                radius if radius <= 0.0 && !self.rings.is_empty() => Regime::GrossSlip,
                radius if radius < self.radius => Regime::PartialSlip,
                _ => Regime::Stick,
            },
            dissipated_energy: self.dissipated,
            elastic_energy: self.elastic,
            work: self.dissipated + self.elastic,
        }
    }

    /// Bytes of RAM that it takes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<PlanarContact>() + self.rings.capacity() * size_of::<Ring>()
    }

    /// Whether this load, of an indentation, m, and a normal force, N, is not the present one.
    fn carries_another(&self, [indentation, normal_force]: [f64; 2]) -> bool {
        indentation.to_bits() != self.indentation.to_bits() || normal_force.to_bits() != self.normal_force.to_bits()
    }

    /// Twice what two half steps have led to less what the `whole` step has, within the friction of each ring;
    /// `dissipated` is the friction work before, J.
    fn extrapolate(&mut self, whole: &PlanarContact, dissipated: f64) {
        self.stick_radius = whole.stick_radius;
        if self.area.to_bits() != whole.area.to_bits() || self.rings.len() != whole.rings.len() {
            return;
        }
        self.force = [0.0; 2];
        for (ring, whole) in self.rings.iter_mut().zip(&whole.rings) {
            let [x, y] = [0, 1].map(|axis| 2.0 * ring.traction[axis] - whole.traction[axis]);
            let share = (ring.bound / x.hypot(y)).min(1.0);
            ring.traction = if share < 1.0 { [x * share, y * share] } else { [x, y] };
            self.force = [0, 1].map(|axis| self.force[axis] + ring.traction[axis]);
        }
        self.dissipated = (2.0 * self.dissipated - whole.dissipated).max(dissipated);
        self.elastic = (2.0 * self.elastic - whole.elastic).max(0.0);
    }

    /// How many rings the contact takes.
    fn touching(&self) -> f64 {
        (self.radius * self.radius * (1.0 - SAME_AREA) / self.area).ceil().max(1.0)
    }

    /// Makes one ring of two: the force on both stays.
    fn merge(&mut self) {
        self.area *= 2.0;
        let merged = |pair: &[Ring]| Ring {
            bound: pair.iter().map(|ring| ring.bound).sum(),
            traction: [0, 1].map(|axis| pair.iter().map(|ring| ring.traction[axis]).sum()),
            slip: [0.0; 2],
        };
        self.rings = self.rings.chunks(2).map(merged).collect();
    }

    /// Makes two rings of one: the force on it is shared as the bounds are.
    fn split(&mut self, bounds: &[f64]) {
        let halves = self.rings.iter().zip(bounds.chunks(2));
        let of_ring = |(ring, pair): (&Ring, &[f64])| {
            let (traction, whole) = (ring.traction, pair.iter().sum::<f64>());
            let half = move |bound: &f64| {
                let share = if whole > 0.0 { bound / whole } else { 0.0 };
                Ring { bound: *bound, traction: traction.map(|component| component * share), slip: [0.0; 2] }
            };
            pair.iter().map(half).collect::<Vec<_>>()
        };
        self.rings = halves.flat_map(of_ring).collect();
    }
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
        let setup = setup.shared();
        setup.profile.check_round("motion in the plane")?;
        setup.profile.check_stress_field()?;
        Ok(PlanarLaw { contact: Contact::new(setup)?, meshes: (0..rings).map(|_| OnceLock::new()).collect() })
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
        let half = |one: f64, other: f64| 0.5 * (one + other);
        let middle = [0, 1].map(|axis| half(contact.displacement[axis], displacement[axis]));
        let indentation = half(contact.indentation, load[0]);
        let half_load = match normal {
            _ if !changes => load,
            Normal::Indentation(_) => [indentation, self.contact.normal_force_at(DoubleDouble::from(indentation))],
            Normal::NormalForce(force) => {
                let force = half(contact.normal_force, force);
                [self.contact.indentation_for(force).value(), force]
            }
        };
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
            while FEWEST * contact.rings.len() <= self.meshes.len() {
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
        let most = self.meshes.len() as f64;
        if contact.area <= 0.0 {
            contact.area = contact.radius * contact.radius / most;
        }
        while contact.touching() > most {
            contact.merge();
        }
        self.limits(contact, buffers);
        contact.rings.resize(buffers.limits.len().max(contact.rings.len()), Ring::default());
    }

    /// Friction times the load of each ring, N.
    fn limits(&self, contact: &PlanarContact, buffers: &mut PlanarBuffers) {
        let PlanarBuffers { limits, outside, .. } = buffers;
        let (profile, count) = (self.contact.indenter(), contact.touching() as usize);
        let kinks = profile.knots_below(contact.radius);
        let from = |index: usize| {
            let radius = (index as f64 * contact.area).sqrt();
            beyond(profile, &kinks, contact.indentation, contact.radius, radius)
        };
        outside.clear();
        outside.extend((0..count).map(from));
        outside.push(0.0);
        let limit = self.contact.friction() * contact.normal_force;
        let unit = if outside[0] > 0.0 { limit / outside[0] } else { 0.0 };
        limits.clear();
        limits.extend(outside.windows(2).map(|ends| unit * (ends[0] - ends[1]).max(0.0)));
    }

    /// Moves the indenter by a vector, m, and asks Coulomb's law of each ring; `full` is the displacement of gross
    /// slip, m.
    fn slip(&self, contact: &mut PlanarContact, by: Vector, full: f64, buffers: &mut PlanarBuffers) {
        let count = contact.rings.len();
        let mesh = self.meshes[count - 1].get_or_init(|| Mesh::new(count));
        let PlanarBuffers { limits, bounds, forces, traction, slip, workspace, .. } = buffers;
        let touching = limits.len();
        limits.resize(count, 0.0);
        // In displacements: over G* times the outermost radius.
        let unit = self.contact.elasticity().g_star() * (count as f64 * contact.area).sqrt();
        bounds.clear();
        bounds.extend(limits.iter().map(|limit| limit / unit));
        let held = contact.rings.iter().zip(mesh.together());
        forces.clear();
        forces.extend(held.map(|(ring, share)| [0, 1].map(|axis| ring.traction[axis] / unit + share * by[axis])));
        slip.clear();
        // A long step slips by its own length, nearly.
        let long = by[0].hypot(by[1]) > full;
        slip.extend(contact.rings.iter().map(|ring| if long { by } else { ring.slip }));
        traction.clear();
        traction.resize(count, [0.0; 2]);
        if self.contact.friction() > 0.0 {
            contact.unsettled = solve(mesh.stiffness(false), bounds, forces, traction, slip, workspace) * unit;
        }
        contact.force = [0.0; 2];
        // The innermost ring that slips.
        let mut first = None;
        for (index, ring) in contact.rings.iter_mut().enumerate() {
            let (limit, slip) = (limits[index], slip[index]);
            let before = ring.traction;
            let after = traction[index].map(|component| component * unit);
            let size = slip[0].hypot(slip[1]);
            // It slips at the end of the step, from the force on that it had reached until then.
            let end = limit * size;
            let begin = if limit < ring.bound { dot(before, slip).max(end) } else { ring.bound * size };
            contact.dissipated += 0.5 * (begin + end);
            let moved = [by[0] - slip[0], by[1] - slip[1]];
            contact.elastic += 0.5 * (dot(before, moved) + dot(after, moved));
            contact.force = [contact.force[0] + after[0], contact.force[1] + after[1]];
            if size > NO_SLIP * full && index < touching {
                first.get_or_insert(index);
            }
            *ring = Ring { bound: limit, traction: after, slip };
        }
        contact.elastic = contact.elastic.max(0.0);
        contact.stick_radius = first.map_or(contact.radius, |first| (first as f64 * contact.area).sqrt());
        contact.rings.truncate(touching);
    }
}

fn dot(one: Vector, other: Vector) -> f64 {
    one[0] * other[0] + one[1] * other[1]
}
