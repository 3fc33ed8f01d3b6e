//! Contacts of lines, in plane strain: a cylinder on a flat, a flat pad with rounded edges on a flat.
//!
//! Under a load per length P the pressure is a superposition of flat punches of half-width t, p(x) = (1/pi) int_x^a
//! P'(t)/sqrt(t^2 - x^2) dt, so that G = P/E* over the half-width t takes the place of g in every kernel
//! ([`LineContact::face`]), and partial slip is a stack over P (Jäger 1998; Ciavarella 1998). Half-planes alike in
//! their constants have one influence function for normal and tangential tractions: G* = E*.
//!
//! Displacements of a half-plane are known up to a motion in proportion to the load, which one length fixes: d(delta) =
//! (2/(pi E*)) ln(l/t) dP, and the same for the tangential displacement with the tangential force. So a line contact of
//! the length L is a load curve with X = F_N'/(2 E*) = pi L/(4 ln(l/t)), l the reference length, and has what load
//! curves have: displacements, energies, cycles. The integrals over a ring of levels are taken over s = sqrt(t^2 -
//! b^2), b the half-width of the flat, in which G is analytic.

mod bulk;
mod pad;
mod rings;

use std::f64::consts::{FRAC_2_PI, PI};
use std::sync::Arc;

pub use bulk::LineBulk;
pub use pad::PadFace;

use super::curve_family::CurveFamily;
use super::{Moments, Point, Profile, Ring, Sphere};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{TWELVE_POINTS, integral};
use crate::numerics::roots::within;
use crate::range::error::Error;
use crate::range::{self, Quantity, Range};

/// The part of the reference length that half-widths stay below: at the length itself the approach would no longer
/// grow with the load.
pub const WIDEST: f64 = 0.9;

/// The specimen that is pressed on the flat.
#[derive(Clone, Debug, PartialEq)]
enum Specimen {
    /// Radius R, m.
    Cylinder { radius: f64 },
    /// Half-width b of the flat and radius R of the edges, m.
    RoundedPad { flat_half_width: f64, edge_radius: f64 },
}

/// A contact along a line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineContact {
    specimen: Specimen,
    length: f64,
    reference_length: f64,
    /// The body of revolution whose g is G.
    face: Arc<Profile>,
    bulk: Option<LineBulk>,
}

impl LineContact {
    /// A cylinder of the radius R, m, along the length L, m. The reference length, m, is twice the radius if none is
    /// given.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the name of the parameter.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{LineContact, Profile};
    ///
    /// let cylinder = Profile::Line(LineContact::cylinder(0.05, 0.01, Some(0.1))?).indenter();
    /// // Hertz: F_N = pi E* L a^2/(4 R), here over 2 E*.
    /// let load = 3.141592653589793 * 0.01 * 4e-4 * 4e-4 / (8.0 * 0.05);
    /// assert!((cylinder.contact_radius(cylinder.indentation_for(load)) / 4e-4 - 1.0).abs() < 1e-14);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn cylinder(radius: f64, length: f64, reference_length: Option<f64>) -> Result<LineContact, Error> {
        let radius = checked("radius", radius)?;
        let reference_length = reference_length.unwrap_or(2.0 * radius);
        let face = Profile::Sphere(Sphere::of_curvature(4.0 * radius / PI));
        LineContact {
            specimen: Specimen::Cylinder { radius },
            length,
            reference_length,
            face: Arc::new(face),
            bulk: None,
        }
        .checked(0.0)
    }

    /// A pad along the length L, m, flat up to the half-width b, m, with edges of the radius R, m. The reference length
    /// is L if none is given.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the name of the parameter.
    ///
    /// ```
    /// use stickslip_mechanics::profile::LineContact;
    ///
    /// assert!(LineContact::rounded_pad(5e-4, 0.05, 0.01, None).is_ok());
    /// // No reference length below the flat itself.
    /// assert!(LineContact::rounded_pad(5e-4, 0.05, 0.01, Some(4e-4)).is_err());
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn rounded_pad(
        flat_half_width: f64,
        edge_radius: f64,
        length: f64,
        reference_length: Option<f64>,
    ) -> Result<LineContact, Error> {
        let pad = PadFace::new(checked("flat_half_width", flat_half_width)?, checked("edge_radius", edge_radius)?);
        let (face, reference_length) = (Arc::new(Profile::PadFace(pad)), reference_length.unwrap_or(length));
        let specimen = Specimen::RoundedPad { flat_half_width, edge_radius };
        LineContact { specimen, length, reference_length, face, bulk: None }.checked(flat_half_width)
    }

    fn checked(self, least: f64) -> Result<LineContact, Error> {
        checked("length", self.length)?;
        checked("reference_length", self.reference_length)?;
        if least < WIDEST * self.reference_length {
            return Ok(self);
        }
        Err(Error::OutOfRange {
            quantity: Quantity::Parameter("reference_length"),
            value: self.reference_length,
            allowed: format!(
                "above {}, the half-width of the flat over {WIDEST}",
                crate::range::unit_prefix::in_unit(least / WIDEST, "m")
            ),
        })
    }

    /// The `type` in JSON.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.specimen {
            Specimen::Cylinder { .. } => "cylinder",
            Specimen::RoundedPad { .. } => "rounded_pad",
        }
    }

    /// The radius, m, of a cylinder.
    #[must_use]
    pub fn cylinder_radius(&self) -> Option<f64> {
        if let Specimen::Cylinder { radius } = self.specimen { Some(radius) } else { None }
    }

    /// The length L, m.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The reference length, m.
    #[must_use]
    pub fn reference_length(&self) -> f64 {
        self.reference_length
    }

    /// The radius of the cylinder or of the edges, m.
    #[must_use]
    pub fn curvature_radius(&self) -> f64 {
        match self.specimen {
            Specimen::Cylinder { radius } => radius,
            Specimen::RoundedPad { edge_radius, .. } => edge_radius,
        }
    }

    /// Half-width of the flat, m; zero of a cylinder.
    #[must_use]
    pub fn flat_half_width(&self) -> f64 {
        match self.specimen {
            Specimen::Cylinder { .. } => 0.0,
            Specimen::RoundedPad { flat_half_width, .. } => flat_half_width,
        }
    }

    /// dz/dx of the undeformed surface at the distance x, m, from the middle.
    pub(super) fn surface_slope(&self, x: f64) -> f64 {
        (x - self.flat_half_width()).max(0.0) / self.curvature_radius()
    }

    /// The body of revolution whose g(x), m, is P/E* of the half-width x: its pressure over a radius is that of this
    /// contact over x.
    #[must_use]
    pub fn face(&self) -> &Profile {
        &self.face
    }

    pub(crate) fn shared_face(&self) -> Arc<Profile> {
        Arc::clone(&self.face)
    }

    /// The same with a stress of one body along x that comes with the tangential force.
    ///
    /// # Errors
    /// [`Error::BulkTooLarge`] for a pad, whose zones are not known.
    pub fn with_bulk(self, bulk: LineBulk) -> Result<LineContact, Error> {
        if self.flat_half_width() > 0.0 {
            return Err(Error::BulkTooLarge { stress_per_force: bulk.stress_per_force, largest: 0.0 });
        }
        Ok(LineContact { bulk: Some(bulk), ..self })
    }

    /// The stress along x that comes with the tangential force.
    #[must_use]
    pub fn bulk(&self) -> Option<&LineBulk> {
        self.bulk.as_ref()
    }

    /// How far the zone of vanishing width is off the middle, m, under a normal force, N: R k kappa F_N.
    pub(crate) fn reach_of_bulk(&self, normal_force: f64) -> f64 {
        self.bulk.map_or(0.0, |bulk| self.curvature_radius() * bulk.strain_per_force * normal_force)
    }

    /// Centre of the zone of the half-width c, m, in a contact of the half-width a, m, under a normal force, N:
    /// e = R k kappa F_N (1 - c^2/a^2).
    pub(crate) fn zone_centre(&self, normal_force: f64, edge: f64, half_width: f64) -> f64 {
        let reach = self.reach_of_bulk(normal_force);
        if reach == 0.0 || edge <= 0.0 {
            0.0
        } else {
            reach * (edge - half_width) * (edge + half_width) / (edge * edge)
        }
    }

    /// Whether zones are nested in a contact of this half-width, m, under this normal force, N.
    ///
    /// # Errors
    /// [`Error::BulkTooLarge`] with the largest stress that is taken.
    pub(crate) fn check_bulk(&self, half_width: f64, normal_force: f64) -> Result<(), Error> {
        let (reach, most) = (self.reach_of_bulk(normal_force).abs(), 0.5 * half_width);
        let Some(LineBulk { stress_per_force, .. }) = self.bulk.filter(|_| reach > most) else { return Ok(()) };
        Err(Error::BulkTooLarge { stress_per_force, largest: (stress_per_force * most / reach).abs() })
    }

    /// The point of [`LineContact::face`] that has the half-width of a level of this contact.
    pub(crate) fn face_point(&self, level: DoubleDouble) -> Point {
        let (b, s) = (self.flat_half_width(), self.side_of_level(level.value()));
        let square = DoubleDouble::square_of(b) + DoubleDouble::square_of(s);
        let level = match self.specimen {
            Specimen::Cylinder { radius } => square * (PI / (4.0 * radius)),
            Specimen::RoundedPad { .. } => DoubleDouble::from(self.load_to(s)),
        };
        Point { level, radius: square.value().sqrt(), square }
    }

    /// Half-width, m, of a level, m: from [`WIDEST`] of the reference length on that itself, which no contact has.
    #[must_use]
    pub fn half_width(&self, level: f64) -> f64 {
        let s = self.side_of_level(level);
        if s < self.last_side() { self.width_at(s) } else { WIDEST * self.reference_length }
    }

    /// The level, m, of a half-width, m; zero within the flat.
    #[must_use]
    pub fn level_of_width(&self, half_width: f64) -> f64 {
        let b = self.flat_half_width();
        let t = half_width.min(WIDEST * self.reference_length);
        if t > b { self.level_to(((t - b) * (t + b)).sqrt()) } else { 0.0 }
    }

    /// Half-width at s, m.
    fn width_at(&self, s: f64) -> f64 {
        let b = self.flat_half_width();
        if b > 0.0 { b.hypot(s) } else { s }
    }

    /// ln(l/t) at s, m.
    fn log_at(&self, s: f64) -> f64 {
        (self.reference_length / self.width_at(s)).ln()
    }

    /// dG/ds (pure number).
    pub(crate) fn gamma(&self, s: f64) -> f64 {
        match self.specimen {
            Specimen::Cylinder { radius } => 0.5 * PI * s / radius,
            Specimen::RoundedPad { flat_half_width, edge_radius } => s / edge_radius * s.atan2(flat_half_width),
        }
    }

    /// d(level)/ds (pure number).
    fn rise(&self, s: f64) -> f64 {
        let gamma = self.gamma(s);
        if gamma > 0.0 { FRAC_2_PI * self.log_at(s) * gamma } else { 0.0 }
    }

    /// G up to s, m.
    fn load_to(&self, s: f64) -> f64 {
        match self.specimen {
            Specimen::Cylinder { radius } => 0.25 * PI * s * s / radius,
            Specimen::RoundedPad { flat_half_width: b, .. } if s < 0.5 * b => {
                integral(&TWELVE_POINTS, s, |s| self.gamma(s))
            }
            Specimen::RoundedPad { flat_half_width: b, edge_radius } => {
                0.5 * ((b * b + s * s) * s.atan2(b) - b * s) / edge_radius
            }
        }
    }

    /// The level up to s, m.
    fn level_to(&self, s: f64) -> f64 {
        self.level_and_rise(s)[0]
    }

    /// The level up to s, m, which is the integral of [`LineContact::rise`], and that.
    fn level_and_rise(&self, s: f64) -> [f64; 2] {
        if s <= 0.0 {
            return [0.0; 2];
        }
        match self.specimen {
            Specimen::Cylinder { radius } => {
                let log = self.log_at(s);
                [0.25 * s * s * (2.0 * log + 1.0) / radius, s * log / radius]
            }
            Specimen::RoundedPad { flat_half_width: b, .. } if s < 0.5 * b => {
                [integral(&TWELVE_POINTS, s, |s| self.rise(s)), self.rise(s)]
            }
            Specimen::RoundedPad { flat_half_width: b, edge_radius } => {
                let (angle, log, square) = (s.atan2(b), self.log_at(s), b * b + s * s);
                let (load, beyond) =
                    (0.5 * (square * angle - b * s), 0.25 * (square + 2.0 * b * b) * angle - 0.75 * b * s);
                [load * log + beyond, log * s * angle].map(|value| FRAC_2_PI * value / edge_radius)
            }
        }
    }

    /// s, m, of a level, m, no further than where contacts end.
    fn side_of_level(&self, level: f64) -> f64 {
        // Roots, since the product of a small radius and a small level may underflow.
        let about = (self.curvature_radius().sqrt() * level.max(0.0).sqrt()).min(self.last_side());
        self.side(level, level / (FRAC_2_PI * self.log_at(about)), |s| self.level_and_rise(s))
    }

    /// s at which an increasing function with its slope has a value, no further than where contacts end, from what
    /// about this load has: s^3/(3 R b) of a narrow edge and pi s^2/(4 R) of a wide one are both above G.
    fn side(&self, value: f64, load: f64, of: impl Fn(f64) -> [f64; 2]) -> f64 {
        let most = self.last_side();
        if value <= 0.0 {
            return 0.0;
        }
        if value >= of(most)[0] {
            return most;
        }
        let radius = self.curvature_radius();
        let (narrow, wide) =
            ((3.0 * radius * self.flat_half_width() * load).cbrt(), (4.0 / PI * load).sqrt() * radius.sqrt());
        within([0.0, most], narrow.max(wide), |s| {
            let [found, slope] = of(s);
            (found - value, slope)
        })
    }

    /// s of the widest contact, m.
    fn last_side(&self) -> f64 {
        let (b, most) = (self.flat_half_width(), WIDEST * self.reference_length);
        ((most - b) * (most + b)).sqrt()
    }

    /// X at s, m.
    fn curve_radius(&self, s: f64) -> f64 {
        0.25 * PI * self.length / self.log_at(s)
    }
}

fn checked(name: &'static str, value: f64) -> Result<f64, Error> {
    Range { quantity: Quantity::Parameter(name), ..range::LENGTH }.check(value)
}

impl CurveFamily for LineContact {
    fn radius_at(&self, level: DoubleDouble) -> f64 {
        // A cylinder that just touches carries nothing.
        let s = self.side_of_level(level.value());
        if self.width_at(s) > 0.0 { self.curve_radius(s) } else { 0.0 }
    }

    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2] {
        let s = self.side_of_level(level.value());
        let (t, log) = (self.width_at(s), self.log_at(s));
        [self.radius_at(level), 0.25 * PI * self.length * s / (t * t * log * log * self.rise(s))]
    }

    fn level_of(&self, radius: f64) -> f64 {
        let most = WIDEST * self.reference_length;
        self.level_of_width((self.reference_length * (-0.25 * PI * self.length / radius).exp()).min(most))
    }

    fn moments_of(&self, ring: &Ring) -> Moments {
        let [inner, outer] = [ring.inner, ring.outer].map(|point| self.side_of_level(point.level.value()));
        self.ring_moments(inner, outer, ring.depth)
    }

    fn indentation_of(&self, load: f64) -> f64 {
        let wanted = 2.0 * load / self.length;
        self.level_to(self.side(wanted, wanted, |s| [self.load_to(s), self.gamma(s)]))
    }
}
