//! A profile made of several: g, its slope, its loads and its kernels add up, since g is linear in f.
//!
//! Only X(y) does not: it lies between the least of the parts' X(y/n) and the least of their X(y), and is found there
//! by a bracketed method. A flat punch among the parts ends the sum in its vertical edge. The g of a table among them
//! may fall where the others make up for it: X(y) then lies between the flat radius of the sum and where it ends or
//! falls.

mod build;
mod fields;
mod kink_moments;
#[cfg(test)]
mod tests;

use super::polynomial::Polynomial;
use super::power_series::{KINK_TERMS, KinkSeries, Place, Series};
use super::shape::{self, Shape, ShapeFacts};
use super::smooth_interval::{Node, SmoothInterval};
use super::tabulated::{self, Kernel};
use super::{DoubleDouble, InterpolationError, Moments, Point, Profile, Ring, Span, StressRadius};
use crate::numerics::roots::increasing;
pub(crate) use fields::SumFields;
use kink_moments::KinkMoments;

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
    /// Of many kinks that a contact can reach.
    kink_moments: Option<KinkMoments>,
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

    /// The radius from which what lies beyond it must be known on its own: the kink that a radius is little beyond, or,
    /// where the radius is little below the end of a part that is vertical there, one some units in the last place
    /// below it.
    fn counted_from(&self, radius: f64) -> Option<f64> {
        if radius > (1.0 - NEAR) * self.facts.ceiling {
            return Some(radius * (1.0 - 8.0 * f64::EPSILON));
        }
        let above = self.kinks.partition_point(|&kink| kink <= radius);
        let kink = *self.kinks.get(above.checked_sub(1)?)?;
        (radius - kink < NEAR * kink).then_some(kink)
    }

    /// The stretch from a radius outward whose squares differ by `gap`.
    fn beyond(base: f64, gap: f64) -> Span {
        let inner = DoubleDouble::square_of(base);
        let outer = inner + DoubleDouble::from(gap);
        Span { inner, outer, inner_radius: base, outer_radius: outer.value().sqrt(), gap, edge: 0.0 }
    }

    /// The least of the radii at which a part alone has a level: not below that of the sum.
    fn least_radius(&self, level: f64) -> f64 {
        self.parts.iter().map(|part| part.radius(level)).fold(f64::INFINITY, f64::min)
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
    fn level(&self, radius: f64) -> f64 {
        if let Some(polynomial) = &self.polynomial {
            return polynomial.level(radius);
        }
        self.total(|part| part.level(radius))
    }

    fn slope(&self, radius: f64) -> f64 {
        if let Some(polynomial) = &self.polynomial {
            return polynomial.slope(radius);
        }
        self.total(|part| part.slope(radius))
    }

    fn radius(&self, level: f64) -> f64 {
        if let Some(polynomial) = self.polynomial.as_ref().filter(|_| level > 0.0) {
            return polynomial.radius(level, self.least_radius(level));
        }
        match self.rim {
            Some((rim, top)) if level >= top => rim,
            _ => self.inverse(level, Shape::radius, Shape::level, |x| Shape::slope(self, x)),
        }
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let radius = self.radius(level.value());
        let plain = DoubleDouble::square_of(radius);
        let at_rim = self.rim.is_some_and(|(_, top)| level.value() >= top);
        let Some(base) = self.counted_from(radius).filter(|_| !at_rim) else { return plain };
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
        Sum::beyond(base, gap).outer
    }

    fn load(&self, radius: f64) -> f64 {
        self.total(|part| part.load(radius))
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if let Some((rim, top)) = self.rim {
            let face = self.load(rim);
            if load >= face {
                return top + (load - face) / rim;
            }
        }
        let radius = |part: &Profile, load: f64| part.radius(part.indentation_for(load));
        let found = self.inverse(load, radius, Shape::load, |x| x * Shape::slope(self, x));
        let mut level = self.level(found);
        if load > 0.0 && self.counted_from(found).is_some() {
            // int_0^d X dy, whose slope X hardly changes here.
            let core = self.radius(0.0);
            let point = |level: f64| {
                let (level, square) = (DoubleDouble::from(level), self.square(DoubleDouble::from(level)));
                Point { level, radius: square.value().sqrt(), square }
            };
            let mut polished = level;
            for _ in 0..POLISH {
                let ring = Ring::between(point(0.0), point(polished));
                let carried = core * polished + self.moments(&self.span(&ring)).first;
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
        self.polynomial.map_or_else(|| self.total(|part| part.rise(span)), |polynomial| polynomial.rise(span))
    }

    fn rise_to(&self, outer: &Span, interval: &SmoothInterval, node: Node) -> f64 {
        self.total(|part| part.rise_to(outer, interval, node))
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        self.polynomial.map_or_else(|| shape::gap(self, ring, depth), |polynomial| polynomial.gap(ring, depth))
    }

    fn moments(&self, span: &Span) -> Moments {
        match &self.polynomial {
            Some(polynomial) => polynomial.moments(span),
            None => {
                let kept = self.kink_moments.as_ref().and_then(|kept| kept.across(self, span));
                kept.unwrap_or_else(|| shape::moments(self, span))
            }
        }
    }

    fn rim(&self) -> Option<(f64, f64)> {
        self.rim
    }

    fn facts(&self) -> ShapeFacts {
        self.facts
    }

    fn kink_below(&self, radius: f64) -> f64 {
        let above = self.kinks.partition_point(|&kink| kink < radius);
        above.checked_sub(1).map_or(0.0, |index| self.kinks[index])
    }

    fn kernel(&self, at: &StressRadius, span: &Span) -> f64 {
        self.total(|part| Shape::kernel(part, at, span))
    }

    fn kernel_slope(&self, at: &StressRadius, span: &Span) -> f64 {
        self.total(|part| Shape::kernel_slope(part, at, span))
    }

    fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Option<Vec<f64>> {
        if rings.len() * radii.len() <= tabulated::FEW {
            return None;
        }
        let sums = SumFields::new(self, rings, radii.len())?.sums(Kernel::Root, radii);
        Some(sums.into_iter().map(|(sum, _)| sum).collect())
    }

    fn displacements(&self, rings: &[(Ring, f64)], ends: (f64, f64), radii: &[StressRadius]) -> Option<Vec<f64>> {
        let fields = SumFields::new(self, rings, radii.len())?;
        let edge = &rings.last()?.0.outer;
        Some(tabulated::displacements(edge, ends, radii, |angle, radii| fields.sums(angle, radii)))
    }

    fn slope_series(&self, a: f64) -> Option<Vec<f64>> {
        self.parts.iter().try_fold(Vec::new(), |mut sum, part| {
            let series = part.slope_series(a)?;
            sum.resize(sum.len().max(series.len()), 0.0);
            sum.iter_mut().zip(series).for_each(|(sum, c)| *sum += c);
            Some(sum)
        })
    }

    fn slope_over_radius_series(&self, place: &Place) -> Option<Series> {
        let mut parts = self.parts.iter().map(|part| part.slope_over_radius_series(place));
        let first = parts.next()??;
        parts.try_fold(first, |sum, part| Some(sum.plus(&part?)))
    }

    fn kink_series(&self, b: f64, top: f64) -> Option<KinkSeries> {
        let place = Place { middle: DoubleDouble::square_of(b), half: top * top, terms: KINK_TERMS };
        self.parts.iter().try_fold(KinkSeries::default(), |sum, part| {
            let own = part.kink_below(b * (1.0 + f64::EPSILON)).to_bits() == b.to_bits();
            let series = if own {
                part.kink_series(b, top)?
            } else {
                KinkSeries::smooth(&part.slope_over_radius_series(&place)?, top)
            };
            Some(sum.plus(&series))
        })
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.total(|part| part.surface_slope(r))
    }

    fn cancellation(&self, x: f64) -> f64 {
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

    fn least_fall(&self, inner: f64, outer: f64) -> f64 {
        self.total(|part| part.least_fall(inner, outer))
    }

    fn rises_concavely(&self, inner: f64) -> bool {
        self.parts.iter().all(|part| part.rises_concavely(inner))
    }

    fn singular_radii(&self) -> Vec<f64> {
        let mut radii: Vec<f64> = self.parts.iter().flat_map(Profile::singular_radii).collect();
        radii.sort_by(f64::total_cmp);
        radii.dedup_by(|a, b| a.to_bits() == b.to_bits());
        radii
    }

    fn interpolation_error(&self, radius: f64) -> InterpolationError {
        let errors = self.parts.iter().map(|part| part.interpolation_error(radius));
        errors.fold(InterpolationError::default(), InterpolationError::and)
    }

    fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        let noises = self.parts.iter().filter_map(|part| part.noise(radius));
        noises.reduce(|one, other| if one.0 > other.0 { one } else { other })
    }
}
