//! A shape as its cells are made of it.

use std::sync::Arc;

use super::Cells;
use super::ring::StressRadius;
use super::stages::Stages;

/// The uneven power from which on what is not analytic beside a lower power is rounding: the terms of a Chebyshev
/// series of t^(n - 1) fall like j^(1 - 2 n).
const SMOOTH: f64 = 14.0;

/// What g is a series of, above a place where it is not analytic in x^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Powers {
    /// gamma = dg/dt is t to this power times a series in t: from zero on where f' jumps, from one on where f'' does.
    All(usize),
    /// gamma is an odd function of t: at a tip that is smooth.
    Odd,
    /// g is about t to this power, which is not whole.
    Uneven(f64),
}

impl Powers {
    /// Those of the sum of two functions.
    pub(crate) fn and(self, other: Powers) -> Powers {
        match (self, other) {
            (Powers::Uneven(one), Powers::Uneven(other)) => Powers::Uneven(one.min(other)),
            (Powers::Uneven(power), other) | (other, Powers::Uneven(power)) if power >= SMOOTH => {
                other.and(Powers::All(SMOOTH as usize - 1))
            }
            (Powers::Uneven(power), other) | (other, Powers::Uneven(power)) => Powers::Uneven(power.min(other.of_g())),
            (Powers::Odd, Powers::Odd) => Powers::Odd,
            (Powers::Odd, Powers::All(power)) | (Powers::All(power), Powers::Odd) => Powers::All(power.min(1)),
            (Powers::All(one), Powers::All(other)) => Powers::All(one.min(other)),
        }
    }

    /// The least power in g.
    fn of_g(self) -> f64 {
        match self {
            Powers::All(power) => (power + 1) as f64,
            Powers::Odd => 2.0,
            Powers::Uneven(power) => power,
        }
    }

    /// Whether pressure and shear are infinite there.
    pub(crate) fn singular(self) -> bool {
        self.of_g() <= 1.0
    }
}

/// Where g is not analytic in x^2: an end of a flat, a knot, the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Kink {
    pub(crate) at: StressRadius,
    /// What g is above it.
    pub(crate) powers: Powers,
}

/// The kinks of a shape from the innermost on; copies share them, because a table has many.
pub(crate) type Kinks = Arc<[Kink]>;

impl Kink {
    /// The kink at a radius, m.
    pub(crate) fn new(radius: f64, powers: Powers) -> Kink {
        Kink { at: StressRadius::new(radius), powers }
    }
}

/// The kinks of several shapes added up. A kink within another shape keeps the least power of the two.
pub(crate) fn united(parts: &[Kinks]) -> Kinks {
    let mut kinks: Vec<Kink> = parts.iter().flat_map(|kinks| kinks.iter().copied()).collect();
    kinks.sort_by(|a, b| a.at.radius.total_cmp(&b.at.radius));
    let mut united: Vec<Kink> = Vec::with_capacity(kinks.len());
    for kink in kinks {
        match united.last_mut() {
            Some(last) if last.at.radius.to_bits() == kink.at.radius.to_bits() => {
                last.powers = last.powers.and(kink.powers)
            }
            // What lies beneath goes on as an odd function of t.
            Some(_) => united.push(Kink { powers: Powers::All(1).and(kink.powers), ..kink }),
            None => united.push(kink),
        }
    }
    united.into()
}

/// gamma at t, m, above `base`, m, of what begins at the kink `own`, m, by its gamma above that: zero below it.
pub(crate) fn above(own: f64, base: f64, t: f64, gamma: impl Fn(f64) -> f64) -> f64 {
    let further = (base - own) * (base + own);
    if further < 0.0 {
        0.0
    } else if further <= 0.0 {
        gamma(t)
    } else {
        let place = (t * t + further).sqrt();
        gamma(place) * (t / place)
    }
}

/// How far cells are to reach.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reach {
    /// Beyond a radius, m.
    Radius(f64),
    /// Beyond a level, m.
    Level(f64),
    /// Beyond a load int x dg, m^2.
    Load(f64),
}

/// Where contacts end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    /// Radius, m.
    pub(crate) radius: f64,
    pub(crate) kind: EndKind,
}

/// Why they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum EndKind {
    /// The surface is vertical: the contact keeps this radius under every higher load.
    Edge,
    /// g falls from there on.
    Fall,
    /// No more is known of the surface.
    Unknown,
}

/// A body of revolution z = f(r), by g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr. All else follows from its cells.
pub(crate) trait Shape {
    /// Its kinks from the innermost on, where the surface leaves the plane; none of a flat punch.
    fn kinks(&self) -> Kinks;

    /// g at the radius x, m.
    fn level(&self, x: f64) -> f64;

    /// gamma = dg/dt (pure number) at t = sqrt(x^2 - b^2), m, above b = `base`, m: one of its kinks, or of those of a
    /// sum that it is part of, or zero.
    fn gamma(&self, base: f64, t: f64) -> f64;

    /// f'(r), the slope of the undeformed surface.
    fn surface_slope(&self, r: f64) -> f64;

    /// Its cells as far as they have been asked for.
    fn stages(&self) -> &Stages;

    /// Where contacts end. A shape that went on beyond its own end would give numbers where there is no surface, so
    /// that each has to say.
    fn end(&self) -> Option<End>;

    /// The radius at which contacts end, m; infinite where they never do.
    fn end_radius(&self) -> f64 {
        self.end().map_or(f64::INFINITY, |end| end.radius)
    }

    /// A radius of curvature, m, where it is given by one. No result depends on it: it is what warnings compare the
    /// contact radius with, and without one they compare nothing.
    fn curvature_radius(&self) -> Option<f64> {
        None
    }
}

impl dyn Shape + '_ {
    /// Its cells that reach beyond something, or to its end; `None` once `keep_going` has returned false.
    pub(crate) fn cells_while(&self, reach: Reach, keep_going: &dyn Fn() -> bool) -> Option<&Cells> {
        self.stages().up_to(self, reach, keep_going)
    }
}
