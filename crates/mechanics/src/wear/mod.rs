//! What fretting wear leaves: the limiting shape of a contact that is moved back and forth at a constant indentation.
//!
//! At the indentation d an amplitude U0 below gross slip leaves springs inside c stuck, m (d - g(c)) = U0: they keep
//! their g. Springs outside slip and wear until they press no more, so that their g becomes d. In the end the bodies
//! touch in the disc c alone (Popov 2014, *Analytic solution for the limiting shape of profiles due to fretting wear*,
//! Sci. Rep. 4, 3749):
//!
//! - F_N = 2 E* int_0^c (d - g) dx, the amplitude of the force is 2 G* c U0, and no friction work is left,
//! - p(r) = (E*/pi) [K(r, c) + (d - g(c))/sqrt(c^2 - r^2)], infinite at c,
//! - f(r) = (2/pi) [int_0^c g dx/sqrt(r^2 - x^2) + d arccos(c/r)] for c < r < b, and as before elsewhere. That is f as
//!   before plus (2/pi) H(r), H(r) = int_c^r (d - g) dx/sqrt(r^2 - x^2), and b is the zero of H beyond the edge.

mod table;

use std::f64::consts::{FRAC_2_PI, PI};

pub use table::WornTable;

use crate::contact::Contact;
use crate::contact::normal;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{TWENTY_POINTS, by_halves, integral};
use crate::numerics::roots::{between, largest_of};
use crate::profile::{Point, Profile, Ring, StressRadius};
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;

/// Squares of radii of the first scan for the largest depth, evenly spaced, and levels of it.
const DEPTH_SCAN: usize = 24;
/// How often a panel of the removed volume is halved at most: a safeguard only.
const MOST_HALVINGS: u32 = 40;
/// Radii whose heights are summed together: within a factor of two to the power of one over this.
const BANDS: f64 = 3.0;
/// A radius that is rounded lies within this factor of it.
const BEYOND: f64 = 1.0 + 1e-12;
/// The share of the radius where a profile ends up to which its surface is shown.
const KNOWN: f64 = 1.0 - 1e-9;
/// The error of a panel of the removed volume that is accepted, relative to the whole.
const VOLUME_ERROR: f64 = 1e-15;

impl Profile {
    /// Refuses the limit of wear of a profile for which this module has no theory: without a stress field the shape is
    /// not known. A profile that wears by another law is refused here.
    ///
    /// # Errors
    /// [`Error::NoStressField`] with the type of the profile, [`Error::LineContact`].
    pub fn check_wear(&self) -> Result<(), Error> {
        self.check_round("the limiting shape of wear")?;
        self.check_stress_field()
    }
}

/// A contact that fretting at a constant indentation has worn to its limit.
#[derive(Clone, Debug)]
pub struct WornContact<'a> {
    contact: &'a Contact,
    /// The edge of the disc that never slips.
    stick: Point,
    /// Where the worn surface meets the unworn.
    worn: Point,
    /// d - g(c) = U0/m, m.
    step: f64,
    amplitude: f64,
}

/// Largest depth of the removed material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearDepth {
    /// The depth, m.
    pub largest: f64,
    /// Where, m.
    pub radius: f64,
}

/// Heights of the surface above its lowest point, m.
#[derive(Clone, Debug, PartialEq)]
pub struct WornHeights {
    /// Before wear.
    pub before: Vec<f64>,
    /// In the limit.
    pub after: Vec<f64>,
}

/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::wear::WornContact;
///
/// // U0 = 0.36 u_max leaves c = 0.8 a.
/// let worn = WornContact::new(&contact, 0.36 * contact.gross_slip_displacement())?;
/// assert!((worn.stick_radius() / 0.08 - 1.0).abs() < 1e-14);
/// assert!(worn.worn_radius() > contact.contact_radius());
/// assert!(worn.normal_force() < contact.normal_force());
/// assert!((worn.force_amplitude() - 2.0 * 2e6 * 0.08 * 0.36 * 0.0075).abs() < 1e-9);
/// // Nothing is left beyond c, and the pressure is infinite there.
/// assert_eq!(worn.pressures(&[0.09, worn.stick_radius()]), [0.0, f64::INFINITY]);
/// let heights = worn.heights(&[0.05, 0.1]);
/// assert_eq!(heights.before[0], heights.after[0]);
/// assert!(heights.after[1] > heights.before[1] && worn.removed_volume() > 0.0);
/// assert!(worn.depth().largest > 0.0);
/// // At gross slip everything wears on.
/// assert!(WornContact::new(&contact, contact.gross_slip_displacement()).is_err());
/// # Ok::<(), Error>(())
/// ```
impl<'a> WornContact<'a> {
    /// The limit of a contact at its present indentation, whatever its history, under cycles of this displacement
    /// amplitude, m, of at least zero.
    ///
    /// # Errors
    /// As [`Profile::check_wear`]; [`Error::OutOfRange`] for an amplitude from gross slip on, under which all of the
    /// contact wears on; [`Error::WornBeyondProfile`] if the profile ends within the worn part.
    pub fn new(contact: &'a Contact, amplitude: f64) -> Result<WornContact<'a>, Error> {
        contact.check_coulomb("wear")?;
        contact.profile().check_wear()?;
        let edge = *contact.history.edge();
        let step = contact.scaled(DoubleDouble::from(amplitude));
        let level = edge.level - step;
        let gross_slip = contact.gross_slip_displacement();
        if amplitude.is_nan() || amplitude < 0.0 || amplitude >= gross_slip || level.value() <= 0.0 {
            let allowed = format!(
                "below the displacement of gross slip, {} m: at and above it the whole contact slips and wears without \
                 a limit",
                short(gross_slip)
            );
            return Err(Error::OutOfRange { quantity: Quantity::Displacement, value: amplitude, allowed });
        }
        let stick = contact.indenter.point(level);
        let mut worn = WornContact { contact, stick, worn: edge, step: step.value(), amplitude };
        if worn.wears() {
            worn.worn = worn.meeting_point()?;
        }
        Ok(worn)
    }

    /// Whether anything slips at all: under a vertical edge nothing may.
    #[must_use]
    pub fn wears(&self) -> bool {
        self.edge().square > self.stick.square
    }

    /// The radius c of the disc that never slips, m: the contact radius in the limit.
    #[must_use]
    pub fn stick_radius(&self) -> f64 {
        self.stick.radius
    }

    /// The radius b up to which the surface has worn, m.
    #[must_use]
    pub fn worn_radius(&self) -> f64 {
        self.worn.radius
    }

    /// The normal force that is left, N.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        let inside = normal::load(&self.contact.indenter, &normal::whole(&self.contact.indenter, &self.stick));
        2.0 * self.contact.elasticity.e_star() * (inside + self.step * self.stick.radius)
    }

    /// The amplitude of the tangential force that is left, N.
    #[must_use]
    pub fn force_amplitude(&self) -> f64 {
        2.0 * self.contact.elasticity.g_star() * self.stick.radius * self.amplitude
    }

    /// The pressure that is left, Pa, at each of `radii`, m: infinite at the stick radius, zero beyond.
    #[must_use]
    pub fn pressures(&self, radii: &[f64]) -> Vec<f64> {
        let unit = self.contact.elasticity.e_star() / PI;
        let inside = normal::pressures(&self.contact.indenter, &self.contact.elasticity, &self.stick, radii);
        let edge_term = |radius: f64| {
            if radius >= self.stick.radius {
                return if radius <= self.stick.radius && self.step > 0.0 { f64::INFINITY } else { 0.0 };
            }
            self.step / (self.stick.square - DoubleDouble::square_of(radius)).value().sqrt()
        };
        inside.into_iter().zip(radii).map(|(inside, &radius)| inside + unit * edge_term(radius)).collect()
    }

    /// How far the surface is known and worth showing, m: the given multiple of the worn radius, or just inside the end
    /// of the profile.
    #[must_use]
    pub fn reach(&self, multiple: f64) -> f64 {
        let profile = &self.contact.indenter;
        let end = profile.limit_radius().map(|limit| KNOWN * limit).or(profile.rim_radius());
        end.map_or(f64::INFINITY, |end| end.max(self.worn.radius)).min(multiple * self.worn.radius)
    }

    /// The heights of the surface at each of `radii`, m, below the end of the profile.
    #[must_use]
    pub fn heights(&self, radii: &[f64]) -> WornHeights {
        let before = unworn_heights(&self.contact.indenter, radii);
        let worn = |radius: &f64| self.wears() && *radius > self.stick.radius && *radius <= self.worn.radius;
        let places: Vec<f64> = radii.iter().copied().filter(worn).collect();
        let mut limits = self.worn_heights(&places).into_iter();
        let height = |(&before, radius): (&f64, &f64)| {
            if worn(radius) { limits.next().map_or(before, |limit| limit.max(before)) } else { before }
        };
        WornHeights { after: before.iter().zip(radii).map(height).collect(), before }
    }

    /// (2/pi) [int_0^c g dx/sqrt(r^2 - x^2) + d arccos(c/r)], m, at each of `radii` beyond c, m.
    fn worn_heights(&self, radii: &[f64]) -> Vec<f64> {
        let profile = &self.contact.indenter;
        let whole = normal::whole(profile, &self.stick);
        let (at, level) = (StressRadius::of_all(radii), self.stick.level.value());
        let inside = profile.displacements(&[(whole, 1.0)], (0.0, level), &at);
        let depth = self.edge().level.value();
        inside.into_iter().zip(&at).map(|(inside, at)| inside + FRAC_2_PI * depth * self.angle(at)).collect()
    }

    /// arccos(c/r), rad.
    fn angle(&self, at: &StressRadius) -> f64 {
        (at.square - self.stick.square).value().max(0.0).sqrt().atan2(self.stick.radius)
    }

    /// The largest depth of the removed material, and where it is.
    #[must_use]
    pub fn depth(&self) -> WearDepth {
        if !self.wears() {
            return WearDepth { largest: 0.0, radius: self.stick.radius };
        }
        // A shape with kinks may have several maxima: a scan by radii and by levels, then a search about its largest.
        let (low, width) = (self.stick.square, self.worn.square - self.stick.square);
        let share = |index: usize| index as f64 / DEPTH_SCAN as f64;
        let rise = self.worn.level - self.stick.level;
        let mut squares: Vec<DoubleDouble> = (0..=DEPTH_SCAN)
            .map(|index| low + width * share(index))
            .chain(
                (1..DEPTH_SCAN).map(|index| self.contact.indenter.point(self.stick.level + rise * share(index)).square),
            )
            .collect();
        squares.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let depth = |square: DoubleDouble| {
            self.gap_integral(&StressRadius { radius: square.value().sqrt(), square }, &self.worn)
        };
        // A place by its level may be one by its radius too, as on a sphere: so the neighbours but one.
        let (square, found) = largest_of(&squares, 2, 1e-8, depth);
        WearDepth { largest: FRAC_2_PI * found, radius: square.value().sqrt() }
    }

    /// The removed volume, m^3: 2 pi int (f - f_before) r dr = 4 int_c^b (d - g) sqrt(b^2 - x^2) dx. It has the digits
    /// that d - g has, a difference.
    #[must_use]
    pub fn removed_volume(&self) -> f64 {
        if !self.wears() {
            return 0.0;
        }
        let profile = &self.contact.indenter;
        let (stick, worn) = (self.stick.radius, self.worn.radius);
        let mut kinks = profile.knots_below(worn);
        kinks.retain(|&kink| kink > stick);
        let ends: Vec<f64> = [stick].into_iter().chain(kinks).chain([worn]).collect();
        let scale = self.step * (self.worn.square - self.stick.square).value();
        let mut sum = DoubleDouble::ZERO;
        for ends in ends.windows(2) {
            let base = profile.kink_below(ends[1]);
            sum = sum + DoubleDouble::from(self.volume_between(base, [ends[0], ends[1]], VOLUME_ERROR * scale));
        }
        4.0 * sum.value()
    }

    /// int (d - g) sqrt(b^2 - x^2) dx between two radii, m, above the kink `base`, m, by x^2 = b^2 - T^2 sin^2 psi, T^2
    /// = b^2 - base^2: g is analytic in sqrt(x^2 - base^2), and so is the integrand in psi.
    fn volume_between(&self, base: f64, [inner, outer]: [f64; 2], error: f64) -> f64 {
        let (profile, depth) = (&self.contact.indenter, self.edge().level);
        let total = (self.worn.square - DoubleDouble::square_of(base)).value();
        let angle = |x: f64| {
            let below = (self.worn.square - DoubleDouble::square_of(x)).value().max(0.0);
            below.sqrt().atan2(((x - base) * (x + base)).max(0.0).sqrt())
        };
        let integrand = |psi: f64| {
            let (sin, cos) = psi.sin_cos();
            let x = (base * base + total * cos * cos).sqrt();
            (depth - DoubleDouble::from(profile.level(x))).value() * total * total.sqrt() * sin * sin * cos / x
        };
        let rule = |[low, high]: [f64; 2]| integral(&TWENTY_POINTS, high - low, |psi| integrand(low + psi));
        let coarse = |_, whole: f64, sum: f64| (sum - whole).abs() > error.max(1e-14 * whole.abs());
        let panels = by_halves([angle(outer), angle(inner)], MOST_HALVINGS, rule, coarse);
        panels.into_iter().map(|(_, sum)| sum).sum()
    }

    /// H(r) = int_c^r (d - g) dx/sqrt(r^2 - x^2), m, at a radius from c to that of `end`, which is not inside the edge.
    fn gap_integral(&self, at: &StressRadius, end: &Point) -> f64 {
        let (profile, edge) = (&self.contact.indenter, self.edge());
        let pressed = profile.displacement_integral(at, &Ring::between(self.stick, *edge));
        if at.square <= edge.square {
            return pressed;
        }
        let beyond = Ring::between(*edge, *end);
        pressed - (beyond.depth * profile.arc(at, &beyond) - profile.displacement_integral(at, &beyond))
    }

    /// Where H is zero beyond the edge, or a vertical edge before that.
    fn meeting_point(&self) -> Result<Point, Error> {
        let (profile, edge) = (&self.contact.indenter, self.edge());
        let point = |rise: f64| profile.point(edge.level + DoubleDouble::from(rise));
        let surplus = |rise: f64| {
            let point = point(rise);
            self.gap_integral(&StressRadius::of_point(&point), &point)
        };
        let end = profile.limit_radius().or(profile.rim_radius());
        let most = end.map_or(f64::INFINITY, |end| (profile.level(end) - edge.level.value()).max(0.0));
        let (mut low, mut rise) = ((0.0, surplus(0.0)), self.step);
        loop {
            rise = rise.min(most);
            let value = surplus(rise);
            if value <= 0.0 {
                let root = between([low, (rise, value)], 2.0 * f64::EPSILON * rise, surplus);
                return Ok(point(root));
            }
            if rise >= most {
                return match profile.limit_radius() {
                    Some(limit) => Err(Error::WornBeyondProfile { limit }),
                    None => Ok(point(rise)),
                };
            }
            low = (rise, value);
            rise *= 2.0;
        }
    }

    fn edge(&self) -> &Point {
        self.contact.history.edge()
    }
}

/// The heights of a surface at each of `radii`, m, above its lowest point, m: f(r) = (2/pi) int arccos(x/r) dg.
fn unworn_heights(profile: &Indenter, radii: &[f64]) -> Vec<f64> {
    let band = |radius: f64| (BANDS * radius.log2()).ceil() as i64;
    radii.chunk_by(|one, other| band(*one) == band(*other)).flat_map(|radii| heights_together(profile, radii)).collect()
}

/// The same by one sum up to the largest radius, whose rounding error all share.
fn heights_together(profile: &Indenter, radii: &[f64]) -> Vec<f64> {
    let at = StressRadius::of_all(radii);
    let outermost = profile.level(BEYOND * radii.iter().copied().fold(0.0, f64::max));
    let ring = normal::whole(profile, &profile.point(outermost.into()));
    profile.displacements(&[(ring, 1.0)], (0.0, ring.outer.level.value()), &at)
}
