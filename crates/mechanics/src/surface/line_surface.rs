//! What the surface of a line contact carries, and how far it has slipped.
//!
//! Over the half-width t the load per length G(t) = P/E* takes the place of g: the pieces of the slip history, moved
//! from the levels of displacement to those of G, are the history of a round contact whose pressure and shear stress
//! over r are those of the line contact over x ([`Contact::face`]).
//!
//! A flat punch of half-width t under the tangential force dQ moves the surface at x > t less than itself by (2/(pi
//! E*)) arcosh(x/t) dQ. So slip is U - u(0) + (2 mu/pi) sum -beta_i int arcosh(x/t) dG over the rings inside x. On a
//! cylinder that is closed: (mu/R) times the difference of S(x, c) = (x sqrt(x^2 - c^2) - c^2 arcosh(x/c))/2 at the
//! ends of each ring. Where a bulk stress comes with the force, the zone of half-width c has its centre at e(c) (see
//! `profile/line/bulk.rs`): all terms are those of x - e.

use std::borrow::Cow;
use std::f64::consts::FRAC_2_PI;
use std::sync::Arc;

use crate::contact::Contact;
use crate::contact::state::State;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{TWENTY_POINTS, integral};
use crate::numerics::roots::between;
use crate::profile::{LineContact, Ring, StressRadius};
use crate::surface::shear_stress::{Peak, Residual};

/// Samples of the derivative of an eccentric shear stress between two ends of zones.
const SAMPLES: usize = 48;
/// An extremum is known to this part of the half-width.
const RESOLUTION: f64 = 1e-15;

/// An end of a piece of the slip history: half-width and centre of the zone inside it, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Zone {
    pub(crate) half_width: f64,
    pub(crate) centre: f64,
}

impl Contact {
    /// This contact, or the round one whose stresses over r are those of a line contact over x.
    /// None where no surface is known.
    pub(crate) fn face(&self) -> Option<Cow<'_, Contact>> {
        let (Some(line), Some(face)) = (self.indenter.line(), self.indenter.line_face()) else {
            return self.indenter.face().map(|_| Cow::Borrowed(self));
        };
        let history = self.history.moved_to(|level| line.face_point(level));
        Some(Cow::Owned(Contact { indenter: Arc::clone(face), history, ..self.clone_without_history() }))
    }

    /// Centre of the stuck zone of the half-width c, m, in the present contact.
    pub(crate) fn zone_centre(&self, line: &LineContact, half_width: f64) -> f64 {
        line.zone_centre(self.normal_force, self.contact_radius(), half_width)
    }

    /// Where the middle of the part that stuck is in a state of this contact, m, if a bulk stress comes with the force.
    /// It follows from the radii and the load of the state, and needs no history.
    #[must_use]
    pub fn stick_centre(&self, state: &State) -> Option<f64> {
        let line = self.indenter.line().filter(|line| line.bulk().is_some())?;
        Some(line.zone_centre(state.normal_force, state.contact_radius, state.stick_radius))
    }

    /// The line contact of a bulk stress that moves its zones.
    pub(crate) fn eccentric(&self) -> Option<&LineContact> {
        self.indenter.line().filter(|line| line.reach_of_bulk(self.normal_force) != 0.0)
    }

    /// The rings of a line contact from the edge inward: inner zone, outer zone and -dw/dy.
    pub(crate) fn zones<'a>(&'a self, line: &'a LineContact) -> impl Iterator<Item = (Zone, Zone, f64)> + 'a {
        let zone = |level: DoubleDouble| {
            let half_width = line.half_width(level.value());
            Zone { half_width, centre: self.zone_centre(line, half_width) }
        };
        let mut outer = zone(self.history.edge().level);
        self.shear_rings().map(move |(ring, share)| {
            let inner = zone(ring.inner.level);
            (inner, std::mem::replace(&mut outer, inner), share)
        })
    }

    /// What the surface's fields depend on at a place, m: the distance from the axis, or the x of a line contact.
    pub(crate) fn coordinate(&self, [x, y, _]: &[f64; 3]) -> f64 {
        if self.indenter.line().is_some() { *x } else { x.hypot(*y) }
    }

    /// The level, m, of the zone whose end is at a coordinate: c with e(c) + c = x, or e(c) - c = x on the other side.
    pub(crate) fn level_at(&self, coordinate: f64) -> f64 {
        let Some(line) = self.indenter.line() else { return self.indenter.level(coordinate) };
        let (reach, edge) = (line.reach_of_bulk(self.normal_force), self.contact_radius());
        let bend = if edge > 0.0 { 4.0 * reach / (edge * edge) } else { 0.0 };
        let (from, bend) = if coordinate >= reach { (coordinate - reach, -bend) } else { (reach - coordinate, bend) };
        line.level_of_width(2.0 * from / (1.0 + (1.0 + bend * from).max(0.0).sqrt()))
    }

    /// The distances from the middle, m, at which the zone of a level, m, ends.
    pub(crate) fn circles_of(&self, level: f64) -> [f64; 2] {
        let radius = self.indenter.contact_radius(level);
        let centre = self.indenter.line().map_or(0.0, |line| self.zone_centre(line, radius));
        [radius + centre, radius - centre].map(f64::abs)
    }

    /// Shear stress over mu E*/(2 R), m, of the eccentric zones of a cylinder at a place, m, and its derivative.
    fn eccentric_shear(zones: &[(Zone, Zone, f64)], x: f64) -> [f64; 2] {
        let root = |zone: &Zone| {
            let offset = x - zone.centre;
            let square = (zone.half_width - offset) * (zone.half_width + offset);
            if square > 0.0 { [square.sqrt(), -offset / square.sqrt()] } else { [0.0; 2] }
        };
        zones.iter().fold([0.0; 2], |sum, (inner, outer, share)| {
            let (low, high) = (root(inner), root(outer));
            std::array::from_fn(|i| sum[i] + share * (high[i] - low[i]))
        })
    }

    /// Shear stresses, Pa, of eccentric zones at places x, m.
    pub(crate) fn eccentric_shears(&self, line: &LineContact, places: &[f64]) -> Vec<f64> {
        let (zones, unit) = (self.zones(line).collect::<Vec<_>>(), self.eccentric_unit(line));
        places.iter().map(|&x| unit * Self::eccentric_shear(&zones, x)[0]).collect()
    }

    fn eccentric_unit(&self, line: &LineContact) -> f64 {
        0.5 * self.friction * self.elasticity.e_star() / line.curvature_radius()
    }

    /// The extrema of the shear stress of eccentric zones, from the edge at -a to that at a: the derivative is sampled
    /// between the ends of zones, closer to these, and an extremum is where its sign changes.
    pub(crate) fn eccentric_residual(&self, line: &LineContact, keep_going: impl Fn() -> bool) -> Option<Residual> {
        let (zones, unit, edge) =
            (self.zones(line).collect::<Vec<_>>(), self.eccentric_unit(line), self.contact_radius());
        let mut ends: Vec<f64> = vec![-edge, edge];
        for (inner, ..) in zones.iter().filter(|(inner, ..)| inner.half_width > 0.0) {
            ends.extend([inner.centre - inner.half_width, inner.centre + inner.half_width]);
        }
        ends.sort_by(f64::total_cmp);
        let slope = |x: f64| Self::eccentric_shear(&zones, x)[1];
        let (mut places, mut before) = (Vec::new(), None::<(f64, f64)>);
        for pair in ends.windows(2) {
            if !keep_going() {
                return None;
            }
            let half = 0.5 * (pair[1] - pair[0]);
            for index in 1..=SAMPLES {
                let angle = std::f64::consts::PI * (index as f64 - 0.5) / SAMPLES as f64;
                let x = pair[0] + half * 2.0 * (0.5 * angle).sin().powi(2);
                let here = slope(x);
                if let Some((last, value)) = before.filter(|(last, value)| *last < x && value * here < 0.0) {
                    // Across the end of a zone, where the derivative jumps, that end itself is the extremum.
                    let root = if last < pair[0] {
                        pair[0]
                    } else {
                        between([(last, value), (x, here)], RESOLUTION * edge, slope)
                    };
                    places.push(root);
                }
                if here != 0.0 {
                    before = Some((x, here));
                }
            }
        }
        let shear = |x: f64| unit * Self::eccentric_shear(&zones, x)[0];
        let peaks = places.into_iter().map(|radius| Peak { radius, shear: shear(radius) }).collect();
        Some(Residual::of(shear(0.0), peaks, 0.0))
    }

    /// How much less than at the centre the surface of a line contact has moved over mu, m, at a place x, m.
    pub(crate) fn lag(&self, line: &LineContact, zones: &[(Zone, Zone, f64)], x: f64) -> f64 {
        let flat = line.flat_half_width();
        let ring = |(inner, outer, share): &(Zone, Zone, f64)| {
            if flat > 0.0 {
                share * FRAC_2_PI * line.arcosh_integral([inner.half_width, outer.half_width], x.abs())
            } else {
                let [low, high] = [inner, outer].map(|zone| lagging((x - zone.centre).abs(), zone.half_width));
                share * (low - high) / line.curvature_radius()
            }
        };
        zones.iter().map(ring).sum()
    }

    /// w - W at the centre, as stored.
    pub(crate) fn core(&self) -> f64 {
        self.history.pieces().first().map_or(0.0, |core| core.line.at(DoubleDouble::ZERO).value())
    }

    /// The largest kernel over a ring of this contact's levels: at its inner radius. Zero without a face, where no
    /// stress errs.
    pub(crate) fn face_kernel(&self, ring: &Ring, at: Option<f64>) -> f64 {
        let [inner, outer] = [ring.inner, ring.outer].map(|point| self.indenter.on_face(&point));
        let (Some((face, inner)), Some((_, outer))) = (inner, outer) else { return 0.0 };
        let at = at.map_or(StressRadius::of_point(&inner), StressRadius::new);
        face.kernel(&at, &Ring::between(inner, outer))
    }
}

/// S(x, c), m^2.
fn lagging(x: f64, c: f64) -> f64 {
    if x <= c {
        return 0.0;
    }
    let root = ((x - c) * (x + c)).sqrt();
    let angle = if c > 0.0 { c * c * (root / c).asinh() } else { 0.0 };
    0.5 * (x * root - angle)
}

impl LineContact {
    /// int arcosh(x/t) dG, m, over the half-widths t of a ring that are below x, m, for a pad.
    ///
    /// With s = sqrt(t^2 - b^2) = s(x) sin(phi) the integrand is analytic in phi, but for i b.
    fn arcosh_integral(&self, ring: [f64; 2], x: f64) -> f64 {
        let b = self.flat_half_width();
        let side = |t: f64| ((t - b).max(0.0) * (t + b)).sqrt();
        let reach = side(x);
        if reach <= 0.0 {
            return 0.0;
        }
        let [low, high] = ring.map(|t| (side(t) / reach).min(1.0).asin());
        let of = |phi: f64| {
            let (sin, cos) = phi.sin_cos();
            let s = reach * sin;
            (reach * cos / b.hypot(s)).asinh() * self.gamma(s) * reach * cos
        };
        let (mut sum, mut end) = (0.0, high);
        while end > low {
            let start = if end > 2.0 * low.max(0.5 * b / reach) { 0.5 * end } else { low };
            sum += integral(&TWENTY_POINTS, end - start, |step| of(start + step));
            end = start;
        }
        sum
    }
}
