//! Integrals of families with a kink at b, in the coordinate t = sqrt(x^2 - b^2) where they are smooth.
//!
//! A truncated cone or sphere, a rounded punch, the flank of a rounded cone: each is analytic in t but at t = +-ib, and its
//! gamma(t) = dg/dt does not fall. With kappa = r^2 - b^2 and v = sqrt(x^2 - r^2), so t^2 - v^2 = kappa,
//! K = int gamma dt/v = int gamma ds, where t + v = const e^s: t = tau cosh s for r > b, t = delta sinh s for r < b. In s the
//! integrand is analytic for |Im s| < pi/2 and both root singularities are gone (the substitutions are elementary; for the
//! profiles see Popov & Hess 2015, chapter 3).

use super::gauss::along_strip;
use super::roots::{descend, increasing};
use super::smooth_interval::SmoothInterval;
use super::{DoubleDouble, Moments, Ring, Span, StressRadius};

/// A profile for x >= b, given as a function of the coordinate t = sqrt(x^2 - b^2) in which it is smooth.
pub(super) trait SmoothCoordinate {
    /// b, m.
    fn kink_radius(&self) -> f64;

    /// The distance in t, along the imaginary axis, at which g is singular, m.
    fn singularity(&self) -> f64 {
        self.kink_radius()
    }

    /// g, m.
    fn level_at(&self, t: f64) -> f64;

    /// gamma = dg/dt (pure number), positive and not falling.
    fn slope_at(&self, t: f64) -> f64;

    /// t gamma' - gamma (pure number): t^2 times the slope of gamma/t.
    fn bend_at(&self, t: f64) -> f64;

    /// g(top) - g(t), m, to round-off of itself; `dt` = top - t.
    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64;

    /// A t at which g less g(b) is not below `level`.
    fn upper_bound(&self, level: f64) -> f64;

    /// The t of a level.
    fn solve(&self, level: f64) -> f64 {
        descend(self.upper_bound(level), |t| (self.level_at(t) - level, self.slope_at(t)))
    }

    /// t^2 of a level, m^2, as exact as can be.
    fn square_above(&self, level: DoubleDouble) -> DoubleDouble {
        DoubleDouble::square_of(self.solve(level.value()))
    }

    /// x, m.
    fn radius_at(&self, t: f64) -> f64 {
        (self.kink_radius() * self.kink_radius() + t * t).sqrt()
    }

    /// gamma(t) again, at `drop` below the outer end: for a steep gamma the difference says more than t.
    fn slope_below(&self, t: f64, _outer: f64, _drop: f64) -> f64 {
        self.slope_at(t)
    }

    /// t gamma' - gamma again, likewise.
    fn bend_below(&self, t: f64, _outer: f64, _drop: f64) -> f64 {
        self.bend_at(t)
    }

    /// gamma changes no faster than t to this power.
    fn power(&self) -> f64 {
        1.0
    }

    /// The t at which gamma is singular, never reached.
    fn ceiling(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether gamma > 0 at t = 0, so that f' jumps at b and stresses are infinite there.
    fn jumps(&self) -> bool {
        self.slope_at(0.0) > 0.0
    }
}

/// t at a radius.
pub(super) fn t_of(family: &impl SmoothCoordinate, radius: f64) -> f64 {
    ((radius - family.kink_radius()) * (radius + family.kink_radius())).max(0.0).sqrt()
}

/// g'(x).
pub(super) fn slope(family: &impl SmoothCoordinate, radius: f64) -> f64 {
    let t = t_of(family, radius);
    if t > 0.0 {
        family.slope_at(t) * radius / t
    } else if radius < family.kink_radius() {
        0.0
    } else if family.jumps() {
        f64::INFINITY
    } else {
        // gamma is of the first order in t where a parabola turns into a slope, of the second where a flat turns into a parabola.
        let t = 1e-9 * radius;
        family.slope_at(t) * radius / t
    }
}

/// Both ends of a span in t, and their difference.
fn ends(family: &impl SmoothCoordinate, span: &Span) -> (f64, f64, f64) {
    let (low, high) = span.excess(DoubleDouble::square_of(family.kink_radius()));
    let (low, high) = (low.max(0.0).sqrt(), high.max(0.0).sqrt());
    (low, high, if high > 0.0 { span.gap / (low + high) } else { 0.0 })
}

/// g over a span, to round-off of itself.
pub(super) fn rise(family: &impl SmoothCoordinate, span: &Span) -> f64 {
    let square = DoubleDouble::square_of(family.kink_radius());
    let Some(span) = span.above(square, family.kink_radius()) else { return 0.0 };
    let (low, high, dt) = ends(family, &span);
    family.rise_at(low, high, dt)
}

/// Difference of the squares over a ring of this depth.
pub(super) fn gap(family: &impl SmoothCoordinate, ring: &Ring, depth: f64) -> f64 {
    let square = DoubleDouble::square_of(family.kink_radius());
    let low = (ring.inner.square - square).value().max(0.0);
    let high = (ring.outer.square - square).value().max(0.0);
    if low < 0.5 * high {
        return high - low;
    }
    let top = high.sqrt();
    let steep = family.slope_at(top);
    // Where g is flat by rounding, its levels do not tell radii apart.
    if steep <= 0.0 {
        return high - low;
    }
    let mut dt = (depth / steep).min(0.5 * top);
    for _ in 0..8 {
        let t = top - dt;
        let steep = family.slope_at(t);
        if steep <= 0.0 {
            return high - low;
        }
        let step = (depth - family.rise_at(t, top, dt)) / steep;
        dt = (dt + step).clamp(0.5 * dt, top);
        if step.abs() <= 1e-9 * dt {
            break;
        }
    }
    dt * (top + top - dt)
}

/// The moments over a span above the core.
pub(super) fn moments(family: &impl SmoothCoordinate, span: &Span) -> Moments {
    let interval = interval(family, span);
    interval.moments(|node| family.rise_at(node.t, interval.high, node.dt))
}

/// The span as one interval above the kink.
fn interval(family: &impl SmoothCoordinate, span: &Span) -> SmoothInterval {
    SmoothInterval::new(span, family.kink_radius(), family.singularity(), f64::INFINITY, 2.0)
}

/// The displacement integral of a span above the core, `above` the level added to h.
pub(super) fn displacement_integral(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span, above: f64) -> f64 {
    let interval = interval(family, span);
    interval.displacement_integral(span, at, above, |node| family.rise_at(node.t, interval.high, node.dt))
}

/// The path of integration of a kernel: from its outer end inward.
struct Path {
    kappa: f64,
    low: f64,
    high: f64,
    v_low: f64,
    v_high: f64,
    length: f64,
}

impl Path {
    /// For radii above r in a span; none if there are none.
    fn new(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span) -> Option<Path> {
        let square = DoubleDouble::square_of(family.kink_radius());
        let span = span.above(square, family.kink_radius())?;
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return None;
        }
        let (mut low, high, _) = ends(family, &span);
        let kappa = (at.square - square).value();
        let (mut v_low, v_high) = (inner.max(0.0).sqrt(), outer.sqrt());
        let mut gap = span.gap;
        if inner <= 0.0 {
            (low, v_low, gap) = (kappa.max(0.0).sqrt(), 0.0, outer);
        }
        let steps = gap / (v_low + v_high) + gap / (low + high);
        // At r = b in a profile that is smooth there, what lies this near to b adds nothing.
        let start = if low + v_low > 0.0 { low + v_low } else { 1e-17 * (high + v_high) };
        Some(Path { kappa, low, high, v_low, v_high, length: (steps / start).ln_1p() })
    }

    /// int f(t, v, t_outer - t) ds for an f that changes as a power of t does; `ceiling` is the t where it is singular.
    fn integrate(&self, power: f64, ceiling: f64, f: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let end = self.high + self.v_high;
        let room = if ceiling < f64::INFINITY {
            ((ceiling + (ceiling * ceiling - self.kappa).sqrt()) / end).ln()
        } else {
            ceiling
        };
        along_strip(self.length, power.max(1.0).recip(), room, |s| {
            let here = end * (-s).exp();
            let other = self.kappa / here;
            let drop = -0.5 * (-s).exp_m1() * (end - other);
            // Far below the outer end the difference has lost its digits, and the sum of the two has not.
            let t = if drop < 0.5 * self.high { self.high - drop } else { 0.5 * (here + other) };
            f(t.max(self.low), (0.5 * (here - other)).max(self.v_low), drop)
        })
    }
}

/// K over a span.
pub(super) fn kernel(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span) -> f64 {
    let Some(path) = Path::new(family, at, span) else { return 0.0 };
    if path.low + path.v_low <= 0.0 && family.jumps() {
        return f64::INFINITY;
    }
    path.integrate(family.power(), family.ceiling(), |t, _, drop| family.slope_below(t, path.high, drop))
}

/// dK/d(r^2) over a span: (1/2) int gamma dt/v^3, by parts where v starts from zero or nearly so.
pub(super) fn kernel_slope(family: &impl SmoothCoordinate, at: &StressRadius, span: &Span) -> f64 {
    let Some(path) = Path::new(family, at, span) else { return 0.0 };
    let (low, high, v_low, v_high) = (path.low, path.high, path.v_low, path.v_high);
    if v_low > 0.0 && (path.kappa <= 0.0 || v_high < 2.0 * v_low) {
        let integrand = |t, v, drop| family.slope_below(t, high, drop) / (v * v);
        return 0.5 * path.integrate(family.power(), family.ceiling(), integrand);
    }
    if low <= 0.0 && family.jumps() {
        return f64::NEG_INFINITY;
    }
    let bend =
        path.integrate(family.power(), family.ceiling(), |t, _, drop| family.bend_below(t, high, drop) / (t * t));
    let start = if v_low > 0.0 { family.slope_at(low) / (low * v_low) } else { 0.0 };
    0.5 * (bend + start - family.slope_at(high) / (high * v_high))
}

/// Implements `Shape` for a family with a flat core through its [`SmoothCoordinate`]: all but its loads and the given methods.
macro_rules! flat_core {
    ($family:ty { $($methods:item)* }) => {
        impl $crate::profile::shape::Shape for $family {
            fn level(&self, radius: f64) -> f64 {
                self.level_at(smooth_coordinate::t_of(self, radius))
            }
            fn slope(&self, radius: f64) -> f64 {
                smooth_coordinate::slope(self, radius)
            }
            fn radius(&self, level: f64) -> f64 {
                self.radius_at(self.solve(level))
            }
            fn square(&self, level: DoubleDouble) -> DoubleDouble {
                DoubleDouble::square_of(self.kink_radius()) + self.square_above(level)
            }
            fn load(&self, radius: f64) -> f64 {
                self.load_at(smooth_coordinate::t_of(self, radius))
            }
            fn indentation_for(&self, load: f64) -> f64 {
                smooth_coordinate::indentation_for(self, load, |t| self.load_at(t))
            }
            fn rise(&self, span: &Span) -> f64 {
                smooth_coordinate::rise(self, span)
            }
            fn gap(&self, ring: &Ring, depth: f64) -> f64 {
                smooth_coordinate::gap(self, ring, depth)
            }
            fn kink_below(&self, radius: f64) -> f64 {
                if radius > self.kink_radius() { self.kink_radius() } else { 0.0 }
            }
            fn moments(&self, span: &Span) -> Moments {
                smooth_coordinate::moments(self, span)
            }
            fn displacement_integral(&self, at: &StressRadius, span: &Span) -> f64 {
                smooth_coordinate::displacement_integral(self, at, span, 0.0)
            }
            fn kernel(&self, at: &StressRadius, span: &Span) -> f64 {
                smooth_coordinate::kernel(self, at, span)
            }
            fn kernel_slope(&self, at: &StressRadius, span: &Span) -> f64 {
                smooth_coordinate::kernel_slope(self, at, span)
            }
            fn singular_radii(&self) -> Vec<f64> {
                if self.jumps() { vec![self.kink_radius()] } else { Vec::new() }
            }
            $($methods)*
        }
    };
}
pub(super) use flat_core;

/// The level that carries a load, given the load as a function of t.
pub(super) fn indentation_for(family: &impl SmoothCoordinate, load: f64, load_at: impl Fn(f64) -> f64) -> f64 {
    if load <= 0.0 {
        return 0.0;
    }
    let guess = family.kink_radius();
    let t = increasing(guess, |t| (load_at(t) - load, family.radius_at(t) * family.slope_at(t)));
    family.level_at(t)
}
