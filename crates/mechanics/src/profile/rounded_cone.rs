//! Cone with a rounded tip, f' = T min(r/b, 1): inside b the paraboloid of curvature radius b/T; outside, with
//! t = sqrt(x^2 - b^2) and phi = atan(t/b), g = T x A, A = b/(x + t) + phi.
//!
//! There gamma = dg/dt = T (t/x) Q, Q = 2b/(x + t) + phi, and int x dg = (T/2)(x^2 phi + (4/3) b x^2/(x + t) + b t/3)
//! (Ciavarella 1999; Popov & Hess 2015). f' bends but does not jump at b, so all stresses are finite.

use super::shape::{KernelOrder, Shape, ShapeFacts};
use super::smooth_coordinate::{self, SmoothCoordinate};
use super::sphere::Sphere;
use super::{DoubleDouble, Error, Moments, Ring, Span, StressRadius, range};
use crate::numerics::angle::{angles, tangent_less_angle};
use crate::numerics::roots::descend;

/// A cone whose tip is a paraboloid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCone {
    tip: Sphere,
    flank: Flank,
}

/// The cone outside the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flank {
    slope: f64,
    tip_radius: f64,
    /// The level at the end of the tip, from the paraboloid so that both sides agree on it.
    tip_level: DoubleDouble,
}

impl RoundedCone {
    /// The cone of slope T, parabolic up to the radius b, m, where both slopes agree.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::SLOPE`] and [`range::TIP_RADIUS`].
    pub fn new(slope: f64, tip_radius: f64) -> Result<RoundedCone, Error> {
        let (slope, tip_radius) = (range::SLOPE.check(slope)?, range::TIP_RADIUS.check(tip_radius)?);
        let curvature_radius = tip_radius / slope;
        let tip_level = DoubleDouble::square_of(tip_radius).over(DoubleDouble::from(curvature_radius));
        Ok(RoundedCone { tip: Sphere::of_curvature(curvature_radius), flank: Flank { slope, tip_radius, tip_level } })
    }

    fn parts(&self, span: &Span) -> (Option<Span>, Option<Span>) {
        let b = self.flank.tip_radius;
        let square = DoubleDouble::square_of(b);
        (span.below(square, b), span.above(square, b))
    }
}

impl Flank {
    fn load_at(&self, t: f64) -> f64 {
        let (b, x) = (self.tip_radius, self.radius_at(t));
        0.5 * self.slope * (x * x * ((t / b).atan() + 4.0 / 3.0 * b / (x + t)) + b * t / 3.0)
    }
}

impl SmoothCoordinate for Flank {
    fn kink_radius(&self) -> f64 {
        self.tip_radius
    }

    fn level_at(&self, t: f64) -> f64 {
        let (b, x) = (self.tip_radius, self.radius_at(t));
        self.slope * x * (b / (x + t) + (t / b).atan())
    }

    fn slope_at(&self, t: f64) -> f64 {
        let (b, x) = (self.tip_radius, self.radius_at(t));
        self.slope * (t / x) * (2.0 * b / (x + t) + (t / b).atan())
    }

    fn slopes_at<const N: usize>(&self, t: [f64; N]) -> Option<[f64; N]> {
        let b = self.tip_radius;
        let (angle, _) = angles(t.map(|t| t / b));
        Some(std::array::from_fn(|index| {
            let (t, x) = (t[index], (b * b + t[index] * t[index]).sqrt());
            self.slope * (t / x) * (2.0 * b / (x + t) + angle[index])
        }))
    }

    fn bend_at(&self, t: f64) -> f64 {
        // t gamma' - gamma = -T (t/x) ((t/x)^2 Q + b^3 t/(x (x + t))^2 x), from Q' = -b^3/(x^2 (x + t)^2).
        let (b, x) = (self.tip_radius, self.radius_at(t));
        let q = 2.0 * b / (x + t) + (t / b).atan();
        let (u, w) = (t / x, b / (x + t));
        -self.slope * u * (u * u * q + u * (b / x) * w * w)
    }

    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64 {
        let b = self.tip_radius;
        let (x, x_top) = (self.radius_at(t), self.radius_at(top));
        let dx = dt * (t + top) / (x + x_top);
        let (both, ends) = (b * b + t * top, (x + t) * (x_top + top));
        let u = b * dt / both;
        // A(top) - A(t), of second order in t where each of its terms is of first: the tangents' part is combined
        // before.
        let turn = if u < 1.0 {
            let product = (b * b * (t * t + top * top) + t * t * top * top) / (x * x_top + b * b);
            b * (dt * (product + x * top + t * x_top) / both - dx) / ends - tangent_less_angle(u)
        } else {
            u.atan() - b * (dt + dx) / ends
        };
        self.slope * (x_top * turn + (b / (x + t) + (t / b).atan()) * dx)
    }

    fn upper_bound(&self, level: f64) -> f64 {
        // Q >= pi/2, so g rises by at least T (pi/2)(x - b); here `level` is that rise.
        let more = (level / self.slope * std::f64::consts::FRAC_2_PI).max(0.0);
        (more * (more + 2.0 * self.tip_radius)).sqrt()
    }

    fn square_above(&self, level: DoubleDouble) -> DoubleDouble {
        // From the end of the tip on: t would be lost in the rounding of the level there.
        let climb = (level - self.tip_level).value();
        let start = self.upper_bound(climb);
        DoubleDouble::square_of(if start > 0.0 {
            descend(start, |t| (self.rise_at(0.0, t, t) - climb, self.slope_at(t)))
        } else {
            0.0
        })
    }
}

impl Shape for RoundedCone {
    fn level(&self, radius: f64) -> f64 {
        if radius <= self.flank.tip_radius {
            self.tip.level(radius)
        } else {
            self.flank.level_at(smooth_coordinate::t_of(&self.flank, radius))
        }
    }

    fn slope(&self, radius: f64) -> f64 {
        if radius <= self.flank.tip_radius {
            self.tip.slope(radius)
        } else {
            smooth_coordinate::slope(&self.flank, radius)
        }
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        if base < self.flank.tip_radius {
            self.tip.slopes(base, t)
        } else {
            smooth_coordinate::slopes(&self.flank, base, t)
        }
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        if level <= self.flank.tip_level {
            self.tip.square(level)
        } else {
            DoubleDouble::square_of(self.flank.tip_radius) + self.flank.square_above(level)
        }
    }

    fn load(&self, radius: f64) -> f64 {
        if radius <= self.flank.tip_radius {
            self.tip.load(radius)
        } else {
            self.flank.load_at(smooth_coordinate::t_of(&self.flank, radius))
        }
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if load <= self.tip.load(self.flank.tip_radius) {
            self.tip.indentation_for(load)
        } else {
            smooth_coordinate::indentation_for(&self.flank, load, |t| self.flank.load_at(t))
        }
    }

    fn rise(&self, span: &Span) -> f64 {
        let (tip, flank) = self.parts(span);
        tip.map_or(0.0, |span| self.tip.rise(&span))
            + flank.map_or(0.0, |span| smooth_coordinate::rise(&self.flank, &span))
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let square = DoubleDouble::square_of(self.flank.tip_radius);
        if ring.outer.square <= square {
            return self.tip.gap(ring, depth);
        }
        if ring.inner.square >= square {
            return smooth_coordinate::gap(&self.flank, ring, depth);
        }
        // Both parts from the end of the tip: a difference of squares would lose what a thin ring has on either side.
        let above = (ring.outer.square - square).value();
        above + (square - ring.inner.square).value()
    }

    fn kink_below(&self, radius: f64) -> f64 {
        if radius > self.flank.tip_radius { self.flank.tip_radius } else { 0.0 }
    }

    fn moments(&self, span: &Span, _top: f64) -> Moments {
        let (tip, flank) = self.parts(span);
        let above = flank.map_or(0.0, |span| smooth_coordinate::rise(&self.flank, &span));
        let outer = flank.map_or(Moments::default(), |span| smooth_coordinate::moments(&self.flank, &span));
        Moments::stack(
            tip.map_or(Moments::default(), |span| self.tip.moments(&span, self.tip.level(span.outer_radius))),
            outer,
            above,
        )
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        let (tip, flank) = self.parts(span);
        tip.map_or(0.0, |span| self.tip.kernel(order, at, &span))
            + flank.map_or(0.0, |span| smooth_coordinate::kernel(&self.flank, order, at, &span))
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { kernel_falls: true, ..ShapeFacts::default() }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.flank.slope * (r / self.flank.tip_radius).min(1.0)
    }
}
