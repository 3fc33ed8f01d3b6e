//! A profile made of several: g, its slope, its loads and its kernels add up, since g is linear in f.
//!
//! Only X(y) does not: it lies between the least of the parts' X(y/n) and the least of their X(y), and is found there
//! by a bracketed method. A flat punch among the parts ends the sum in its vertical edge. The g of a table among them
//! may fall where the others make up for it: X(y) then lies between the flat radius of the sum and where it ends or
//! falls.

mod build;
#[cfg(test)]
mod tests;

use super::celled::OfShape;
use super::polynomial::Polynomial;
use super::shape::{self, Falls, KernelOrder, Shape, ShapeFacts};
use super::{DoubleDouble, Moments, Point, Profile, Ring, Span, StressRadius};
use crate::cells::Cells;
use crate::cells::grid::{self, Kink};
use crate::cells::kernel::Kernel;
use crate::cells::stages::Stages;
use crate::numerics::roots::increasing;

/// How far beyond a kink, or below a vertical end, relative to its radius, a radius still lacks digits that a level
/// has.
const NEAR: f64 = 1e-2;
/// Newton's steps for the level that carries a load there, each of which gains two digits at the least.
const POLISH: usize = 5;
/// How far, of itself, they may move an indentation; and to which part of itself the radius is searched, which is more
/// where g is steep.
const FARTHEST: f64 = 1e-3;
const SEARCHED: f64 = 1e-14;

/// A sum of profiles, none of them a sum.
#[derive(Clone, Debug)]
pub struct Sum {
    parts: Vec<Profile>,
    /// Radii at which one of the parts is not smooth, increasing.
    kinks: Vec<f64>,
    rim: Option<(f64, f64)>,
    /// Where X(y) is sought if a part's own inverse is of no help: from the flat radius of the sum to its rim, m.
    bracket: Option<(f64, f64)>,
    facts: ShapeFacts,
    /// g, where it is one.
    polynomial: Option<Polynomial>,
    /// Its cells, and the square of the radius where they end, m^2; none where a part has no series at its tip.
    stages: Option<(Stages, DoubleDouble)>,
}

impl PartialEq for Sum {
    fn eq(&self, other: &Sum) -> bool {
        // All else follows from them.
        self.parts == other.parts
    }
}

impl Sum {
    /// The parts, none of them a sum.
    #[must_use]
    pub fn parts(&self) -> &[Profile] {
        &self.parts
    }

    /// How many times larger than g at the radius `x`, m, its parts are.
    pub(super) fn cancellation(&self, x: f64) -> f64 {
        if !self.parts.iter().any(|part| part.facts().falls_within()) {
            return 1.0;
        }
        let growth = |f: &dyn Fn(&Profile) -> f64| {
            let (sum, sizes) = self.parts.iter().map(f).fold((0.0, 0.0), |(a, b), part| (a + part, b + part.abs()));
            if sum > 0.0 { sizes / sum } else { 1.0 }
        };
        // The terms that cancel are themselves good to some units in their last place.
        2.0 * growth(&|part| part.level(x)).max(growth(&|part| part.slope(x)))
    }

    /// The radius from which what lies beyond it must be known on its own: the kink that the radius of a level is
    /// little beyond, or, where the radius is little below the end of a part that is vertical there, one some units in
    /// the last place below it. A radius just below a kink may be rounded onto it, which the level is not.
    fn counted_from(&self, radius: f64, level: f64) -> Option<f64> {
        if radius > (1.0 - NEAR) * self.facts.ceiling {
            return Some(radius * (1.0 - 8.0 * f64::EPSILON));
        }
        let above = self.kinks.partition_point(|&kink| kink <= radius);
        let mut near = self.kinks[..above].iter().copied().rev().take_while(|kink| radius - kink < NEAR * kink);
        near.find(|&kink| self.level(kink) < level)
    }

    /// The stretch from a radius outward whose squares differ by `gap`.
    fn beyond(base: f64, gap: f64) -> Span {
        let inner = DoubleDouble::square_of(base);
        let outer = inner + DoubleDouble::from(gap);
        Span { inner, outer, inner_radius: base, outer_radius: outer.value().sqrt(), gap, edge: 0.0 }
    }

    /// X(y), m.
    fn radius(&self, level: f64) -> f64 {
        if let Some(polynomial) = self.polynomial.as_ref().filter(|_| level > 0.0) {
            return polynomial.radius(level);
        }
        match self.rim {
            Some((rim, top)) if level >= top => rim,
            _ => self.inverse(level, Profile::radius, Shape::level, |x| Shape::slope(self, x)),
        }
    }

    /// The first cells of it.
    fn cells(&self, count: usize) -> Cells {
        let end = self.stages.as_ref().map_or(DoubleDouble::ZERO, |(_, end)| *end);
        grid::cells(&OfShape(self), 0.0, end, count)
    }

    fn total(&self, f: impl Fn(&Profile) -> f64) -> f64 {
        self.parts.iter().map(f).sum()
    }

    /// The radius at which an additive function has the value `target`; `radius` inverts it for a single part.
    fn inverse(
        &self,
        target: f64,
        radius: impl Fn(&Profile, f64) -> f64,
        f: impl Fn(&Profile, f64) -> f64,
        slope: impl Fn(f64) -> f64,
    ) -> f64 {
        let least = |target: f64| self.parts.iter().map(|part| radius(part, target)).fold(f64::INFINITY, f64::min);
        if target <= 0.0 {
            return self.bracket.map_or_else(|| least(target), |(flat_radius, _)| flat_radius);
        }
        let (low, high) = self.bracket.unwrap_or_else(|| (least(target / self.parts.len() as f64), least(target)));
        let width = high - low;
        if width <= 1e-15 * high {
            return high;
        }
        // Measured from below, so that a flat core does not hide how far beyond it the root lies.
        low + increasing(0.5 * width, |step| {
            let x = low + step.min(width);
            let value = self.total(|part| f(part, x)) - target;
            // The far end is the rim of a part, as steep as may be: Newton's step from there says nothing.
            (value, if step < width { slope(x) } else { 2.0 * value / step })
        })
        .min(width)
    }
}

impl Shape for Sum {
    fn celled(&self, radius: f64) -> Option<&Cells> {
        self.stages.as_ref().map(|(stages, _)| stages.up_to(radius, |count| self.cells(count)))
    }

    fn kinks(&self) -> Vec<Kink> {
        grid::united(self.parts.iter().map(Shape::kinks))
    }

    fn level(&self, radius: f64) -> f64 {
        if let Some(polynomial) = &self.polynomial {
            return polynomial.level(radius);
        }
        if let Some(cells) = self.celled(radius) {
            return cells.level(radius);
        }
        self.total(|part| part.level(radius))
    }

    fn slope(&self, radius: f64) -> f64 {
        if let Some(polynomial) = &self.polynomial {
            return polynomial.slope(radius);
        }
        self.total(|part| part.slope(radius))
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        self.parts.iter().fold([0.0; N], |mut sum, part| {
            sum.iter_mut().zip(part.slopes(base, t)).for_each(|(sum, slope)| *sum += slope);
            sum
        })
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        if let Some((stages, _)) = &self.stages {
            return stages.up_to_level(level.value(), |count| self.cells(count)).square(level);
        }
        let radius = self.radius(level.value());
        let plain = DoubleDouble::square_of(radius);
        let at_rim = self.rim.is_some_and(|(_, top)| level.value() >= top);
        let Some(base) = self.counted_from(radius, level.value()).filter(|_| !at_rim) else { return plain };
        let above = (level - DoubleDouble::from(self.level(base))).value();
        if above <= 0.0 {
            return plain;
        }
        let gap = increasing((radius - base) * (radius + base), |gap| {
            let span = Sum::beyond(base, gap);
            let rise = self.rise(&span);
            let steepness = Shape::slope(self, span.outer_radius) / (2.0 * span.outer_radius);
            (rise - above, if steepness.is_finite() { steepness } else { rise / gap })
        });
        let found = Sum::beyond(base, gap).outer;
        // A level that the next kink does not exceed is not reached beyond it, where g may rise like a root.
        let next = self.kinks.get(self.kinks.partition_point(|&kink| kink <= base));
        let next = next.filter(|&&next| found > DoubleDouble::square_of(next) && self.level(next) >= level.value());
        next.map_or(found, |&next| DoubleDouble::square_of(next))
    }

    fn load(&self, radius: f64) -> f64 {
        if let Some(cells) = self.celled(radius) {
            return cells.load(radius);
        }
        self.total(|part| part.load(radius))
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if let Some((stages, _)) = &self.stages {
            return stages.up_to_load(load, |count| self.cells(count)).indentation_for(load);
        }
        if let Some((rim, top)) = self.rim {
            let face = self.load(rim);
            if load >= face {
                return top + (load - face) / rim;
            }
        }
        let radius = |part: &Profile, load: f64| part.radius(part.indentation_for(load));
        let found = self.inverse(load, radius, Shape::load, |x| x * Shape::slope(self, x));
        let mut level = self.level(found);
        if load > 0.0 && self.counted_from(found, f64::INFINITY).is_some() {
            // int_0^d X dy, whose slope X hardly changes here.
            let core = self.radius(0.0);
            let point = |level: f64| {
                let (level, square) = (DoubleDouble::from(level), self.square(DoubleDouble::from(level)));
                Point { level, radius: square.value().sqrt(), square }
            };
            let mut polished = level;
            for _ in 0..POLISH {
                let ring = Ring::between(point(0.0), point(polished));
                let carried = core * polished + shape::ring_moments(self, &ring).first;
                polished = (polished + (load - carried) / ring.outer.radius).max(0.0);
            }
            // Beyond the end of a part the search has gone as far as it can, and there is nothing to polish.
            let [low, high] = [1.0 - SEARCHED, 1.0 + SEARCHED].map(|share| self.level(found * share));
            if (polished - level).abs() <= FARTHEST * level || (low..=high).contains(&polished) {
                level = polished;
            }
        }
        level
    }

    fn rise(&self, span: &Span) -> f64 {
        if let Some(cells) = self.celled(span.outer_radius) {
            return cells.rise(span);
        }
        self.polynomial.map_or_else(|| self.total(|part| part.rise(span)), |polynomial| polynomial.rise(span))
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        if let Some(cells) = self.celled(ring.outer.radius) {
            return cells.gap(ring, depth);
        }
        self.polynomial.map_or_else(|| shape::gap(self, ring, depth), |polynomial| polynomial.gap(ring, depth))
    }

    fn moments(&self, span: &Span, _top: f64) -> Moments {
        if let Some(cells) = self.celled(span.outer_radius) {
            return cells.moments(span);
        }
        self.polynomial.map_or_else(|| shape::moments(self, span), |polynomial| polynomial.moments(span))
    }

    fn facts(&self) -> ShapeFacts {
        self.facts
    }

    fn kink_below(&self, radius: f64) -> f64 {
        let above = self.kinks.partition_point(|&kink| kink < radius);
        above.checked_sub(1).map_or(0.0, |index| self.kinks[index])
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        if let Some(cells) = self.celled(span.outer_radius) {
            return cells.sum(if order == KernelOrder::Value { Kernel::Root } else { Kernel::RootSlope }, at, span);
        }
        self.total(|part| Shape::kernel(part, order, at, span))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.total(|part| part.surface_slope(r))
    }

    fn falls(&self, inner: f64, outer: f64) -> Falls {
        let none = Falls { least: 0.0, concavely: true };
        self.parts
            .iter()
            .map(|part| part.falls(inner, outer))
            .fold(none, |sum, part| Falls { least: sum.least + part.least, concavely: sum.concavely && part.concavely })
    }
}
