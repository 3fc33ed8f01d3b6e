//! A profile resolved once: everything that moves and stresses ask a shape for.
//!
//! | part | what it is | serves |
//! |---|---|---|
//! | curve | X(y), the radius of a level: its inverse, its integrals over rings | moves, forces, energies |
//! | face | a body of revolution, by cells in x^2: kernels, sources, displacements | stresses, surfaces |
//! | flat, rim | the point of the level zero; the place of a vertical edge | both |
//! | kinks, end | where g is not analytic; where contacts end | both |
//!
//! A round shape is both; a line has a curve of its own and a round face; asperities, ellipsoids and load curves have
//! no face. Places carry their squares with twice the digits, and are compared by them: an annulus beyond a flat may
//! be thinner than a unit in the last place of its radius. A limit law is written on an indenter:
//! `slip_history/limit.rs`.

mod ring_integrals;
mod ring_sum;

use std::sync::Arc;

pub(crate) use ring_sum::{InwardSum, RingSum};

use crate::cells::Cells;
use crate::cells::falls::Falls;
use crate::cells::parabola::Parabola;
use crate::cells::ring::{Point, StressRadius};
use crate::cells::shape::{End, EndKind, Kinks, Powers, Reach, Shape};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{LineContact, Profile, WIDEST};
use crate::range::error::Error;

/// A profile resolved once.
///
/// ```
/// use stickslip_mechanics::profile::{Profile, Ring, Sphere, StressRadius};
///
/// // A sphere of radius 10 mm pressed in by 1 µm: the contact radius is sqrt(R d).
/// let sphere = Profile::Sphere(Sphere::new(0.01)?).indenter();
/// assert!((sphere.radius(1e-6) - 1e-4).abs() < 1e-18);
/// // Pressure is E*/pi times the kernel of the whole contact, (2/R) sqrt(a^2 - r^2).
/// let whole = Ring::between(sphere.point(0.0.into()), sphere.point(1e-6.into()));
/// assert!((sphere.kernel(&StressRadius::new(6e-5), &whole) - 0.016).abs() < 1e-16);
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Indenter {
    profile: Arc<Profile>,
    curve: Curve,
    face: Face,
    /// The level zero: the end of a flat, the tip.
    flat: Point,
    /// A vertical edge, whose radius the contact keeps under every higher load.
    rim: Option<StressRadius>,
    /// Inside the rim or the end alone.
    kinks: Kinks,
    /// The end of what is known of the shape, or of what has an inverse.
    end: Option<End>,
}

/// Where X(y) and its integrals come from.
#[derive(Clone, Copy, Debug)]
enum Curve {
    /// In closed form.
    Ball(Parabola),
    /// The cells of the shape.
    Cells,
    /// The load curve of the profile.
    Load,
}

/// The body of revolution whose stresses over r are those of the contact.
#[derive(Clone, Debug)]
enum Face {
    /// The shape itself.
    Own,
    /// That of a line contact, whose stresses are over x.
    Line(Arc<Indenter>),
    /// None is known.
    None,
}

impl Profile {
    /// It resolved: the same as [`Indenter::new`] of a copy.
    #[must_use]
    pub fn indenter(&self) -> Indenter {
        Indenter::new(self.clone())
    }
}

impl Indenter {
    /// Resolves a profile.
    #[must_use]
    pub fn new(profile: impl Into<Arc<Profile>>) -> Indenter {
        let profile = profile.into();
        let (shape, load) = (profile.shape(), profile.curve());
        let face = match (&*profile, shape) {
            (Profile::Line(line), _) => Face::Line(Arc::new(Indenter::new(line.shared_face()))),
            (_, Some(_)) => Face::Own,
            _ => Face::None,
        };
        let unknown = |radius| End { radius, kind: EndKind::Unknown };
        let end = load.map_or_else(|| shape?.end(), |load| load.end().map(unknown));
        let rim = end.filter(|end| end.kind == EndKind::Edge).map(|end| StressRadius::new(end.radius));
        let mut kinks = shape.map_or_else(|| Kinks::from([]), Shape::kinks);
        let within = end.map_or(kinks.len(), |end| kinks.partition_point(|kink| kink.at.radius < end.radius));
        if within < kinks.len() {
            kinks = kinks[..within].into();
        }
        let level = DoubleDouble::ZERO;
        let flat = match (load, kinks.first()) {
            (Some(load), _) => Point::new(level, load.radius_at(level)),
            (None, Some(kink)) => Point { level, radius: kink.at.radius, square: kink.at.square },
            (None, None) => Point::new(level, end.map_or(0.0, |end| end.radius)),
        };
        let curve = match (profile.ball(), load) {
            (Some(ball), _) => Curve::Ball(ball),
            (None, Some(_)) => Curve::Load,
            (None, None) => Curve::Cells,
        };
        Indenter { curve, face, flat, rim, kinks, end: end.filter(|_| rim.is_none()), profile }
    }

    /// The document that it was made of.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The same document, shared.
    pub(crate) fn shared_profile(&self) -> Arc<Profile> {
        Arc::clone(&self.profile)
    }

    /// The body of revolution whose stresses over r are those of the contact, if there is one.
    pub(crate) fn face(&self) -> Option<&Indenter> {
        match &self.face {
            Face::Own => Some(self),
            Face::Line(face) => Some(face),
            Face::None => None,
        }
    }

    /// The face with the point of it that is this edge.
    pub(crate) fn on_face(&self, edge: &Point) -> Option<(&Indenter, Point)> {
        let line = self.profile.line().filter(|_| edge.level.value() >= 0.0);
        Some((self.face()?, line.map_or(*edge, |line| line.face_point(edge.level))))
    }

    /// It as a contact along a line.
    pub(crate) fn line(&self) -> Option<&LineContact> {
        self.profile.line()
    }

    /// The face of a line contact.
    pub(crate) fn line_face(&self) -> Option<&Arc<Indenter>> {
        if let Face::Line(face) = &self.face { Some(face) } else { None }
    }

    /// The closed forms of it, if it is a parabola or has the load curve of one.
    fn ball(&self) -> Option<&Parabola> {
        if let Curve::Ball(ball) = &self.curve { Some(ball) } else { None }
    }

    /// Those of its stresses.
    fn ball_face(&self) -> Option<&Parabola> {
        self.ball().filter(|_| matches!(self.face, Face::Own))
    }

    /// Its cells that reach beyond something, where it has any.
    pub(crate) fn cells(&self, reach: Reach) -> Option<&Cells> {
        self.profile.cells(reach)
    }

    /// The level zero.
    pub(crate) fn flat(&self) -> &Point {
        &self.flat
    }

    /// The kinks inside the end.
    pub(crate) fn kinks(&self) -> &Kinks {
        &self.kinks
    }

    /// Whether a contact that ends there has grown to a vertical edge and is pressed in beyond it.
    pub(crate) fn is_upright(&self, edge: &Point) -> bool {
        self.rim.is_some_and(|rim| edge.square >= rim.square)
            && self.cells(Reach::Radius(edge.radius)).is_some_and(|cells| edge.level > cells.top.level)
    }

    /// The contact radius, m, of a contact with this edge; of a line contact the half-width.
    pub(crate) fn edge_radius(&self, edge: &Point) -> f64 {
        match self.profile.line() {
            Some(line) if edge.level.value() >= 0.0 => line.half_width(edge.level.value()),
            _ => edge.radius,
        }
    }

    /// The contact radius, m, at a level, m; of a line contact the half-width, where [`Indenter::radius`] is F_N'/(2
    /// E*).
    #[must_use]
    pub fn contact_radius(&self, level: f64) -> f64 {
        self.profile.line().map_or_else(|| self.radius(level), |line| line.half_width(level))
    }

    /// The level, m, of a contact radius, m; of a half-width, for a line contact.
    #[must_use]
    pub fn level_at_edge(&self, contact_radius: f64) -> f64 {
        self.profile.line().map_or_else(|| self.level(contact_radius), |line| line.level_of_width(contact_radius))
    }

    /// g(x), m, for a radius x >= 0, m.
    #[must_use]
    pub fn level(&self, radius: f64) -> f64 {
        match (self.profile.curve(), self.ball()) {
            (Some(curve), _) => curve.level_of(radius),
            (None, Some(ball)) => radius * radius / ball.curvature_radius,
            _ => self.profile.level(radius),
        }
    }

    /// g'(x) (pure number), infinite where f' jumps.
    #[must_use]
    pub fn slope(&self, radius: f64) -> f64 {
        match (self.profile.curve(), self.ball()) {
            (Some(curve), _) => curve.radius_and_rate(curve.level_of(radius).into())[1].recip(),
            (None, Some(ball)) => 2.0 * radius / ball.curvature_radius,
            _ => self.profile.slope(radius),
        }
    }

    /// The largest radius below `radius`, m, at which g is not analytic; zero, the tip, if there is none.
    pub(crate) fn kink_below(&self, radius: f64) -> f64 {
        let below = self.kinks.partition_point(|kink| kink.at.radius < radius);
        below.checked_sub(1).map_or(0.0, |last| self.kinks[last].at.radius)
    }

    /// X(y), m, for a level y >= 0, m; X(0) is the radius of a flat core. Beyond the end of the profile it stays at
    /// [`Indenter::limit_radius`].
    #[must_use]
    pub fn radius(&self, level: f64) -> f64 {
        self.point(level.into()).radius
    }

    /// The level with its radius and that radius's square.
    #[must_use]
    #[inline]
    pub fn point(&self, level: DoubleDouble) -> Point {
        // A move on a ball is so short that a call counts.
        if let Curve::Ball(ball) = &self.curve { ball.point(level) } else { self.point_of_any(level) }
    }

    #[inline(never)]
    fn point_of_any(&self, level: DoubleDouble) -> Point {
        if level.value() <= 0.0 {
            return Point { level, ..self.flat };
        }
        if let Some(curve) = self.profile.curve() {
            // The square of a radius below 1e-154 m would give it back with fewer digits.
            return Point::new(level, curve.radius_at(level));
        }
        let cells = self.cells(Reach::Level(level.value()));
        let square = cells.map_or(DoubleDouble::ZERO, |cells| cells.square(level));
        Point { level, radius: square.value().sqrt(), square }
    }

    /// The indentation d, m, at which int_0^d X(y) dy = F_N/(2 E*) = `load`, m^2.
    #[must_use]
    pub fn indentation_for(&self, load: f64) -> f64 {
        match (self.profile.curve(), self.ball()) {
            (Some(curve), _) => curve.indentation_of(load),
            (_, Some(ball)) => ball.indentation_for(load),
            _ => self.cells(Reach::Load(load)).map_or(f64::NAN, |cells| cells.indentation_for(load)),
        }
    }

    /// The radius, m, that every contact must stay below: where a table ends or its g falls, nine tenths of an exact
    /// sphere. A punch's edge is no such limit.
    #[must_use]
    pub fn limit_radius(&self) -> Option<f64> {
        self.end.map(|end| end.radius)
    }

    /// The radius, m, of a vertical edge, which the contact keeps under every higher load.
    #[must_use]
    pub fn rim_radius(&self) -> Option<f64> {
        self.rim.map(|rim| rim.radius)
    }

    /// Checks a contact radius and returns it.
    ///
    /// # Errors
    /// If it is not below [`Indenter::limit_radius`]: [`Error::NotConvexEnough`] where g falls from there on,
    /// [`Error::BeyondProfile`] where the profile ends; [`Error::BeyondReferenceLength`] for the half-width of a line
    /// contact from [`WIDEST`] of its reference length on.
    pub fn check_radius(&self, radius: f64) -> Result<f64, Error> {
        if let Some(limit) = self.profile.line().map(|line| WIDEST * line.reference_length()) {
            let beyond = Err(Error::BeyondReferenceLength { half_width: radius, limit });
            return if radius < limit { Ok(radius) } else { beyond };
        }
        match self.end {
            Some(End { radius: limit, kind: EndKind::Fall }) if radius >= limit => {
                Err(Error::NotConvexEnough { radius: limit })
            }
            Some(End { radius: limit, .. }) if radius >= limit => Err(Error::BeyondProfile { radius, limit }),
            _ => Ok(radius),
        }
    }

    /// Bounds on the kernel up to c = `outer`, m, from r = `inner`, m, on.
    pub(crate) fn falls(&self, inner: f64, outer: f64) -> Falls {
        self.cells(Reach::Radius(outer)).map_or(Falls::UNKNOWN, |cells| cells.falls(inner, outer))
    }

    /// The places, from the innermost on, at which pressure and shear are infinite once the contact has grown over
    /// them, but for a vertical edge.
    pub(crate) fn singular(&self) -> impl Iterator<Item = StressRadius> {
        self.kinks.iter().filter(|kink| kink.powers.singular()).map(|kink| kink.at)
    }

    /// The radii, m, increasing, at which pressure and shear are infinite once the contact has grown over them: the tip
    /// of a cone, a rim where the slope jumps. The vertical edge of a punch is not among them.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Profile, TruncatedCone};
    ///
    /// let cone = Profile::TruncatedCone(TruncatedCone::new(0.1, 5e-5)?).indenter();
    /// assert_eq!(cone.singular_radii(), [5e-5]);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn singular_radii(&self) -> Vec<f64> {
        self.singular().map(|at| at.radius).collect()
    }

    /// The radii, m, above zero and below `radius` at which g is not analytic, increasing: ends of a flat, knots of a
    /// table. Stresses are log-infinite there, or their derivatives are.
    #[must_use]
    pub fn knots_below(&self, radius: f64) -> Vec<f64> {
        let knots = self.kinks.iter().map(|kink| kink.at.radius).filter(|&knot| knot > 0.0);
        knots.take_while(|&knot| knot < radius).collect()
    }

    /// Whether stresses are analytic in r^2 at the centre if the surface slips there.
    #[must_use]
    pub fn smooth_centre(&self) -> bool {
        let smooth = |powers| powers == Powers::Odd;
        self.face().is_some() && self.kinks.first().is_none_or(|kink| kink.at.radius > 0.0 || smooth(kink.powers))
    }
}
