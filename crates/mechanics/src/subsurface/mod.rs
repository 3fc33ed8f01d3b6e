//! The stress in the bodies below the contact, after any history.
//!
//! The axes of a body: x along the motion of the first body, which carries the profile, z into the body, the origin on
//! the axis of the contact. Pressure and shear stress are known through the slopes of their displacements in the
//! reduced problem, and each slope acts like a line source at an imaginary depth (see `kernel`). On a parabola the sum
//! is closed (`sphere`), on every other profile it is integrated (`mesh`).

mod complex;
mod kernel;
mod line;
mod mesh;
mod place_sums;
mod sphere;
mod tensor;

use std::f64::consts::PI;
use std::sync::OnceLock;

use crate::contact::Contact;
pub use crate::elasticity::Side;
use crate::profile::{LineContact, Profile, Ring};
use crate::range::error::Error;
use crate::range::unit_prefix::short;
use crate::range::{self, Quantity};
use kernel::{DeepPlace, NormalKernels, TangentialKernels};
use line::LineField;
use mesh::{Mesh, Source};
pub(crate) use place_sums::PlaceSums;
use sphere::Kinks;
pub use tensor::Stress;

/// Distance from the centre of the contact, in contact radii, from which the closed form of the parabola would lose
/// digits.
const FAR: f64 = 8.0;
/// The largest error of quadrature and closed form over the unit pressure that tests have found.
const NUMERICAL: f64 = 4e-12;
/// How many times the error of a traction the stress below it may err: its largest component under a unit traction.
const GAIN: f64 = 4.0;
/// How far from the middle stresses are given, in contact radii: twelve digits of the pressure are left there.
pub const FURTHEST: f64 = 1e6;
/// Depth, in contact radii, below which a point is taken as one of the surface: the stress changes with its root.
const SURFACE: f64 = 1e-36;

/// The stress field below one surface in the state of a contact when it was asked for.
#[derive(Clone, Debug)]
pub struct Subsurface {
    /// In the state of the field.
    pub(super) contact: Contact,
    /// The changes of the slopes of pressure and shear stress at the kinks of the slip history, under a parabola alone.
    kinks: Option<Kinks>,
    /// The zones of a line contact.
    line: Option<LineField>,
    /// The slopes over the radius, made when the first place needs them.
    mesh: OnceLock<Mesh>,
    side: Side,
    poisson: f64,
    /// Pa/m for the slopes of the pressure, and of the shear stress on this body.
    units: (f64, f64),
    /// The radii, m, at which the stress of the surface may be infinite.
    singular: Vec<f64>,
}

impl Contact {
    /// The stress field in one of the bodies, of this Poisson's ratio, in the present state.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::POISSON_RATIO`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::subsurface::Side;
    ///
    /// // Hertz: under nu = 0.3 the largest von Mises stress is 0.62 times the pressure, at the depth 0.48 a.
    /// let field = contact.subsurface(Side::Second, 0.3)?;
    /// let stress = field.at([0.0, 0.0, 0.0480864485292895])?;
    /// assert!((stress.von_mises() / contact.pressure(0.0) - 0.620041003909043).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn subsurface(&self, side: Side, poisson_ratio: f64) -> Result<Subsurface, Error> {
        self.clone().into_subsurface(side, poisson_ratio)
    }

    /// As [`Contact::subsurface`], without a copy.
    pub(super) fn into_subsurface(self, side: Side, poisson_ratio: f64) -> Result<Subsurface, Error> {
        let poisson = range::POISSON_RATIO.check(poisson_ratio)?;
        self.check_coulomb("the stress below the surface")?;
        self.profile().check_stress_field()?;
        let radius = self.contact_radius();
        let sign = if side == Side::Second { 1.0 } else { -1.0 };
        let (pressed, dragged) = (self.elasticity.e_star(), sign * self.elasticity.g_star() * self.scale());
        let units = (pressed / (PI * radius), dragged / (PI * radius));
        let singular = self.indenter.singular_radii().into_iter().chain([0.0, radius]).collect();
        let kinks = matches!(self.profile(), Profile::Sphere(_)).then(|| self.kinks());
        let line = self.indenter.line().map(|line| LineField::new(&self, line));
        Ok(Subsurface { contact: self, kinks, line, mesh: OnceLock::new(), side, poisson, units, singular })
    }

    /// The changes of the slopes at the kinks, from the edge inward, for g = t^2 over the contact radius.
    fn kinks(&self) -> Kinks {
        let radius = self.contact_radius();
        // y = (t a)^2/R.
        let level = self.indenter.level(radius);
        let mut outer = None;
        let kink = |(ring, share): (Ring, f64)| {
            let (normal, change) = if let Some(outer) = outer { (0.0, share - outer) } else { (level, share) };
            outer = Some(share);
            Source { t: ring.outer.radius / radius, normal, tangential: level * change }
        };
        Kinks::new(&self.shear_rings().map(kink).collect::<Vec<_>>())
    }
}

impl Subsurface {
    /// The stress at x, y, z, m; not finite where it is infinite.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a place that is no number, lies above the surface, or is further than
    /// [`FURTHEST`] contact radii from the middle.
    pub fn at(&self, place: [f64; 3]) -> Result<Stress, Error> {
        for value in place {
            range::PLACE.check(value)?;
        }
        let [x, y, z] = place;
        let refused = |value, allowed| Err(Error::OutOfRange { quantity: Quantity::Place, value, allowed });
        if z < 0.0 {
            return refused(z, "a depth of at least 0 m".to_owned());
        }
        let (distance, furthest) = (x.hypot(y).hypot(z), FURTHEST * self.contact.contact_radius());
        if furthest > 0.0 && distance > furthest {
            return refused(
                distance,
                format!("up to {FURTHEST:e} contact radii from the middle, {} m", short(furthest)),
            );
        }
        Ok(self.stress(place))
    }

    /// The stress at a place near the contact, z of at least zero.
    pub(crate) fn stress(&self, [x, y, z]: [f64; 3]) -> Stress {
        let radius = self.contact.contact_radius();
        if let Some(field) = &self.line {
            return self.below_line(field, x, z);
        }
        if radius <= 0.0 {
            return Stress::default();
        }
        let r = x.hypot(y);
        let surface = z <= SURFACE * radius;
        let place = DeepPlace { r: r / radius, z: if surface { 0.0 } else { z / radius }, poisson: self.poisson };
        let (normal, tangential) = match &self.kinks {
            Some(kinks) if place.r.hypot(place.z) < FAR => kinks.functions(&place),
            _ => self.integrated(&place, r),
        };
        self.of_functions([x, y], radius, surface, (normal, tangential))
    }

    /// What a place makes of all states up to the contact radius `unit`, m, where that is cheaper than the field of
    /// each: where a field is integrated.
    pub(crate) fn place_sums(&self, [x, y, z]: [f64; 3], unit: f64) -> Option<PlaceSums> {
        let depth = if z <= SURFACE * unit { 0.0 } else { z };
        let sums = || PlaceSums::new(&self.contact.indenter, (x.hypot(y), depth), unit, self.poisson);
        (self.kinks.is_none() && self.line.is_none()).then(sums)
    }

    /// The stress at a place by its sums.
    pub(crate) fn stress_by(&self, sums: &PlaceSums, [x, y, z]: [f64; 3]) -> Stress {
        if self.contact.contact_radius() <= 0.0 {
            return Stress::default();
        }
        self.of_functions([x, y], sums.unit(), z <= SURFACE * sums.unit(), sums.functions(&self.contact))
    }

    /// The stress at x, y by the functions of the place, lengths over `unit`, m.
    fn of_functions(
        &self,
        [x, y]: [f64; 2],
        unit: f64,
        surface: bool,
        (normal, tangential): (NormalKernels, TangentialKernels),
    ) -> Stress {
        let longer = self.contact.contact_radius() / unit;
        let (pressed, dragged) = (self.units.0 * longer, self.units.1 * longer);
        let stress = Stress::of(
            x / unit,
            y / unit,
            &normal.map(|value| pressed * value),
            &tangential.map(|value| dragged * value),
        );
        if surface { self.of_surface(x.hypot(y), stress) } else { stress }
    }

    /// The stress below a line contact, with the stress along x that comes with its tangential force.
    fn below_line(&self, field: &LineField, x: f64, z: f64) -> Stress {
        let contact = &self.contact;
        let carried = contact.indenter.line().and_then(LineContact::bulk).filter(|bulk| bulk.side == self.side);
        let along = carried.map_or(0.0, |bulk| bulk.stress_per_force * contact.force());
        if contact.normal_force() <= 0.0 {
            return Stress { xx: along, ..Stress::default() };
        }
        let sign = if self.side == Side::Second { 1.0 } else { -1.0 };
        let surface = z <= SURFACE * contact.contact_radius();
        let z = if surface { 0.0 } else { z };
        let mut stress = field.at(x, z, sign * contact.friction(), self.poisson) * contact.elasticity().e_star();
        if surface {
            (stress.zz, stress.xz) = (-contact.pressure(x), -sign * contact.shear(x));
        }
        stress.xx += along;
        stress
    }

    /// The ten functions by quadrature over the radius, at a place this far from the axis, m.
    fn integrated(&self, place: &DeepPlace, from_axis: f64) -> (NormalKernels, TangentialKernels) {
        let (mut normal, mut tangential) = ([0.0; 4], [0.0; 6]);
        let radius = self.contact.contact_radius();
        let mesh = self.mesh.get_or_init(|| {
            let rings = self.contact.shear_rings().collect::<Vec<_>>();
            Mesh::new(&self.contact.indenter, &rings, radius)
        });
        mesh.visit(&self.contact.indenter, radius, (from_axis, place.z), |offset, source| {
            let (p, q) = place.kernels(offset);
            for (sum, value) in normal.iter_mut().zip(p) {
                *sum += source.normal * value;
            }
            for (sum, value) in tangential.iter_mut().zip(q) {
                *sum += source.tangential * value;
            }
        });
        (normal, tangential)
    }

    /// Estimated error of any component, relative to
    /// [`ContactSummary::unit_pressure`](super::ContactSummary::unit_pressure): that of the tractions, and of the
    /// quadrature.
    #[must_use]
    pub fn error(&self) -> f64 {
        NUMERICAL + GAIN * self.contact.friction().max(1.0) * self.contact.accuracy().stress_error
    }

    /// A stress of the surface, with the tractions that the surface is known to have.
    fn of_surface(&self, r: f64, stress: Stress) -> Stress {
        let pressure = self.contact.pressure(r);
        if self.singular.contains(&r) && !pressure.is_finite() {
            return Stress::from_components([f64::NEG_INFINITY; 6]);
        }
        let shear = self.contact.shear(r) * self.units.1.signum();
        Stress { zz: -pressure, xz: -shear, yz: 0.0, ..stress }
    }
}
