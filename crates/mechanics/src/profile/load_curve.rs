//! A load curve F_N(d), measured or computed elsewhere, as the contact that has it: X = F_N'/(2 E*).
//!
//! F_N is joined by the shape-preserving quadratic spline of Schumaker (1983): X is continuous and straight between the
//! points and one more in each interval, so that it does not fall where the points do not let it. Up to the first point
//! it is the power law through the first two, as a curve begins. The integrals over a ring are polynomials in its depth
//! and keep their digits.
//!
//! F_N is exact at the points, and between them it errs by some h times the error of X in the gap of the width h, which
//! is what [`open_gaps`](super::open_gaps) leave open. Up to the first point d1 it is F_N (d/d1)^n times (d1/d)^e - 1,
//! where e is the error of the exponent n, for which the change of n over an e-fold of d beyond the first point stands;
//! F_N is convex, and so no larger than its chord from zero. The factors are fitted to random curves
//! (`tests/physics/open_gaps.rs`).

use std::sync::Arc;

use super::curve_family::CurveFamily;
use super::open_gaps::open_slopes;
use super::{InterpolationError, Moments, Ring};
use crate::cells::moment_tree::MomentTree;
use crate::elasticity::Elasticity;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWENTY_POINTS;
use crate::range;
use crate::range::error::{CurveFault, Error};

/// A fall of the slope up to this, of itself, is rounding.
const ERROR_OF_SLOPE: f64 = 1e-12;
/// The least step of the indentation, m.
const LEAST_STEP: f64 = 1e-15;
/// The distance of the radius at the end of the curve from the limit that no contact reaches, over the radius.
const END: f64 = 4.0 * f64::EPSILON;
/// A share of a level from which on the power law is integrated by a rule, because differences of powers cancel.
const CANCELLING: f64 = 0.5;

/// The error of int X dy in a gap over its width times that of X, and the share of the latter that a level of given X
/// errs by.
const OF_LOAD: f64 = 0.4;
const OF_RADIUS: f64 = 0.15;
/// The share of the error of the exponent that the slope at the first point errs by, over F_N/d there.
const OF_EXPONENT: f64 = 0.5;
/// Points this much further out tell another exponent.
const FURTHER: f64 = 1.5;

/// A contact known by its load curve; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCurve(Arc<Curve>);

/// The straight pieces of X.
#[derive(Debug, PartialEq)]
struct Curve {
    /// From the origin on.
    knots: Vec<CurveKnot>,
    /// The exponent of X up to the first knot.
    exponent: f64,
    /// Moments of the pieces.
    tree: MomentTree,
    /// The gaps between the points, and the error of the exponent.
    gaps: Vec<CurveGap>,
    exponent_error: f64,
}

/// A gap between two points: the levels of both, m, the error of X in it, m, and by how much the mean of X exceeds that
/// of the gap before, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CurveGap {
    low: f64,
    high: f64,
    radius: f64,
    rise: f64,
}

/// An end of a straight piece.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CurveKnot {
    level: f64,
    /// X, m.
    radius: f64,
    /// int X dy up to here, m^2.
    load: f64,
}

impl LoadCurve {
    /// The curve through the points (d, F_N), m and N, of these bodies. Both begin at zero, the indentation rises by
    /// 1e-15 m from point to point at the least, and F_N is convex.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::CURVE_POINTS`], [`range::PRELOAD_INDENTATION`] and [`range::NORMAL_FORCE`],
    /// [`Error::Curve`] for points that are no such curve.
    ///
    /// ```
    /// use stickslip_mechanics::Elasticity;
    /// use stickslip_mechanics::profile::{LoadCurve, Profile};
    ///
    /// // A spring: X does not depend on the indentation, as under a flat punch of 5 um.
    /// let bodies = Elasticity::effective(1e11, 8e10)?;
    /// let spring = LoadCurve::new(&[0.0, 1e-6, 3e-6], &[0.0, 1.0, 3.0], &bodies)?;
    /// let spring = Profile::LoadCurve(spring).indenter();
    /// assert!((spring.radius(2e-6) - 5e-6).abs() < 1e-20);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn new(indentation: &[f64], normal_force: &[f64], elasticity: &Elasticity) -> Result<LoadCurve, Error> {
        let fault = |fault, index| Err(Error::Curve { fault, index });
        range::CURVE_POINTS.check(indentation.len() as f64)?;
        if indentation.len() != normal_force.len() {
            return fault(CurveFault::LengthsDiffer, indentation.len().min(normal_force.len()));
        }
        for (numbers, range) in [(indentation, range::PRELOAD_INDENTATION), (normal_force, range::NORMAL_FORCE)] {
            numbers.iter().try_for_each(|&number| range.check(number).map(drop))?;
        }
        let unit = 2.0 * elasticity.e_star();
        if indentation[0] > 0.0 || normal_force[0] > 0.0 {
            return fault(CurveFault::NotFromZero, 0);
        }
        if let Some(index) = indentation.windows(2).position(|pair| pair[1] - pair[0] < LEAST_STEP) {
            return fault(CurveFault::IndentationNotRising, index + 1);
        }
        range::check_normal_force(normal_force[1])?;
        if normal_force[1] <= 0.0 {
            return fault(CurveFault::ForceNotRising, 1);
        }
        let points: Vec<(f64, f64)> =
            indentation.iter().zip(normal_force).map(|(&d, &force)| (d, force / unit)).collect();
        let slope = |index: usize| secant(points[index], points[index + 1]);
        let falls = |index: &usize| slope(*index) < slope(index - 1) * (1.0 - ERROR_OF_SLOPE);
        if let Some(index) = (1..points.len() - 1).find(falls) {
            return fault(CurveFault::SlopeFalls, index + 1);
        }
        let mut curve = Curve::through(&points);
        curve.exponent_error = exponent_error(&points);
        curve.gaps = gaps(&points, curve.exponent_error.min(curve.exponent + 1.0));
        Ok(LoadCurve(Arc::new(curve)))
    }
}

/// The mean of X between two points.
fn secant(low: (f64, f64), high: (f64, f64)) -> f64 {
    (high.1 - low.1) / (high.0 - low.0)
}

/// The exponent of the power law through two points.
fn exponent(low: (f64, f64), high: (f64, f64)) -> f64 {
    (high.1 / low.1).ln() / (high.0 / low.0).ln()
}

/// The error of the exponent up to the first point: how it changes over an e-fold of the indentation, or that of a
/// straight line where there is but one.
fn exponent_error(points: &[(f64, f64)]) -> f64 {
    let last = points.len() - 1;
    if last < 3 {
        return exponent(points[1], points[last]).max(1.0) - 1.0;
    }
    let further = |index: usize| points.partition_point(|point| point.0 < FURTHER * points[index].0).clamp(2, last);
    let far = further(1);
    let change = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|index| points[index]);
        (exponent(a, b) - exponent(b, c)).abs() / (0.5 * (c.0 / a.0).ln()).min(1.0)
    };
    let pairs = [[1, 2, 3], [1, far, further(far)], [1, 2, far], [1, 2, further(far)]];
    pairs.into_iter().filter(|[a, b, c]| a < b && b < c).map(change).fold(0.0, f64::max)
}

/// The gaps between points (d, int X dy) whose exponent at the first one errs by so much.
fn gaps(points: &[(f64, f64)], exponent_error: f64) -> Vec<CurveGap> {
    let mut radii = open_slopes(points, 0);
    radii[0] = OF_EXPONENT * exponent_error * points[1].1 / points[1].0;
    radii[1] = radii[1].max(radii[0]);
    let gap = |(index, radius): (usize, f64)| {
        let (low, high) = (points[index], points[index + 1]);
        let before = if index > 0 { secant(points[index - 1], low) } else { 0.0 };
        CurveGap { low: low.0, high: high.0, radius, rise: (secant(low, high) - before).max(0.0) }
    };
    radii.into_iter().enumerate().map(gap).collect()
}

impl Curve {
    /// The pieces of X through the points (d, int X dy).
    fn through(points: &[(f64, f64)]) -> Curve {
        let mean = |index: usize| secant(points[index], points[index + 1]);
        let (first, last) = (points[1], points.len() - 1);
        // Straight, where there is no second point to tell.
        let power = points.get(2).map_or(2.0, |second| (second.1 / first.1).ln() / (second.0 / first.0).ln());
        let power = power.max(1.0);
        let mut knots = vec![(first.0, power * first.1 / first.0)];
        for index in 1..last {
            let (before, mean) = (knots[knots.len() - 1].1, mean(index));
            let (low, high) = (points[index].0, points[index + 1].0);
            let after = if index + 1 < last {
                let (width, next) = (high - low, points[index + 2].0 - high);
                let beyond = secant(points[index + 1], points[index + 2]);
                (mean * next + beyond * width) / (width + next)
            } else {
                2.0 * mean - before
            };
            // Where X reaches the mean, so that the two straight pieces have it.
            let (below, above) = ((mean - before).max(0.0), (after - mean).max(0.0));
            if below + above > 0.0 {
                knots.push((low + (high - low) * (above / (below + above)), mean));
            }
            knots.push((high, after));
        }
        let mut before = CurveKnot { level: 0.0, radius: if power > 1.0 { 0.0 } else { knots[0].1 }, load: 0.0 };
        let mut all = vec![before];
        for (level, radius) in knots {
            let radius = radius.max(before.radius);
            if level > before.level {
                let depth = level - before.level;
                let load = if all.len() == 1 { first.1 } else { before.load + 0.5 * depth * (before.radius + radius) };
                before = CurveKnot { level, radius, load };
                all.push(before);
            }
        }
        let mut curve = Curve {
            knots: all,
            exponent: power - 1.0,
            tree: MomentTree::new(std::iter::empty()),
            gaps: Vec::new(),
            exponent_error: 0.0,
        };
        let leaves: Vec<(Moments, f64)> = (0..curve.knots.len() - 1)
            .map(|index| {
                let (low, high) = (curve.knots[index].level, curve.knots[index + 1].level);
                (curve.piece(index, low, (high, high - low)), high - low)
            })
            .collect();
        curve.tree = MomentTree::new(leaves.into_iter());
        curve
    }

    /// The piece that holds a level; beyond the end the last.
    fn find(&self, level: f64) -> usize {
        let above = self.knots.partition_point(|knot| knot.level <= level);
        above.saturating_sub(1).min(self.knots.len() - 2)
    }

    /// X' of a straight piece.
    fn slope(&self, index: usize) -> f64 {
        let (low, high) = (self.knots[index], self.knots[index + 1]);
        (high.radius - low.radius) / (high.level - low.level)
    }

    fn radius(&self, level: DoubleDouble) -> f64 {
        let index = self.find(level.value());
        if index == 0 {
            let first = self.knots[1];
            let share = level.value() / first.level;
            return if share < 1.0 { first.radius * share.powf(self.exponent) } else { first.radius };
        }
        let low = self.knots[index];
        let radius = low.radius + self.slope(index) * (level - DoubleDouble::from(low.level)).value();
        let last = self.knots[self.knots.len() - 1];
        if level.value() > last.level { radius.max(last.radius * (1.0 + END)) } else { radius.min(last.radius) }
    }

    /// The moments of a part of one piece, from `low` up to a level `depth` above it, m.
    fn piece(&self, index: usize, low: f64, (high, depth): (f64, f64)) -> Moments {
        if index > 0 {
            let width = self.slope(index) * depth;
            return Moments { width, first: 0.5 * width * depth, second: width * depth * depth / 3.0 };
        }
        let q = self.exponent;
        let (outer, share) = (self.radius(high.into()), depth / high);
        if share < CANCELLING {
            let inner = self.radius(low.into());
            let mut sums = Moments { width: inner * (q * (depth / low).ln_1p()).exp_m1(), ..Moments::default() };
            for (share, weight) in TWENTY_POINTS {
                let below = depth * share;
                let gained = inner * (q * ((depth - below) / low).ln_1p()).exp_m1();
                sums.first += depth * weight * gained;
                sums.second += 2.0 * depth * weight * below * gained;
            }
            return sums;
        }
        let u = low / high;
        let kept = if low > 0.0 {
            u.powf(q)
        } else if q > 0.0 {
            0.0
        } else {
            1.0
        };
        let [first, second] = [(1.0 - kept * u) / (q + 1.0), (1.0 - kept * u * u) / (q + 2.0)];
        Moments {
            width: outer * (1.0 - kept),
            first: outer * high * (first - kept * share),
            second: outer * high * high * (2.0 * (first - second) - kept * share * share),
        }
    }
}

impl CurveFamily for LoadCurve {
    fn radius_at(&self, level: DoubleDouble) -> f64 {
        self.0.radius(level)
    }

    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2] {
        let (index, radius) = (self.0.find(level.value()), self.0.radius(level));
        [radius, if index > 0 { self.0.slope(index) } else { self.0.exponent * radius / level.value() }]
    }

    fn level_of(&self, radius: f64) -> f64 {
        let curve = &*self.0;
        let index = curve.knots.partition_point(|knot| knot.radius < radius);
        let Some(below) = index.checked_sub(1) else { return 0.0 };
        let Some(high) = curve.knots.get(index) else { return curve.knots[below].level };
        if below == 0 {
            return high.level * (radius / high.radius).powf(curve.exponent.recip());
        }
        let low = curve.knots[below];
        low.level + (radius - low.radius) / curve.slope(below)
    }

    fn moments_of(&self, ring: &Ring) -> Moments {
        let curve = &*self.0;
        let (low, high) = (ring.inner.level, ring.outer.level);
        let (inner, outer) = (curve.find(low.value()), curve.find(high.value()));
        let part = |index, low: DoubleDouble, high: DoubleDouble, depth| {
            curve.piece(index, low.value(), (high.value(), depth))
        };
        if inner == outer {
            return part(inner, low, high, ring.depth);
        }
        let [end, start] = [inner + 1, outer].map(|index| DoubleDouble::from(curve.knots[index].level));
        let [below, above] = [(end - low).value(), (high - start).value()];
        let (inside, outside) = (part(inner, low, end, below), part(outer, start, high, above));
        curve.tree.across(inner + 1..outer, inside, (outside, above))
    }

    fn indentation_of(&self, load: f64) -> f64 {
        let curve = &*self.0;
        let index = curve.knots.partition_point(|knot| knot.load <= load).saturating_sub(1).min(curve.knots.len() - 2);
        let (low, high) = (curve.knots[index], curve.knots[index + 1]);
        if index == 0 {
            return high.level * (load / high.load).powf((curve.exponent + 1.0).recip());
        }
        let rest = load - low.load;
        low.level + 2.0 * rest / (low.radius + (low.radius * low.radius + 2.0 * curve.slope(index) * rest).sqrt())
    }

    fn end(&self) -> Option<f64> {
        self.0.knots.last().map(|last| last.radius * (1.0 + END))
    }

    fn curve_error(&self, radius: f64) -> InterpolationError {
        let (curve, level) = (&*self.0, self.level_of(radius));
        let first = curve.knots[1];
        let (load, error) = if level < first.level {
            let power = curve.exponent + 1.0;
            let (share, above) = (level / first.level, (first.level / level).ln());
            let load = first.load * share.powf(power);
            // Another exponent makes another power; at most the load is that of the chord from zero.
            let most = (first.load * share - load).max(load);
            let load = (load * (curve.exponent_error * above).exp_m1()).min(most);
            let scale = first.load / first.level * share.powf(curve.exponent);
            (load, scale * (1.0 + power * above) * curve.exponent_error)
        } else {
            let index = curve.gaps.partition_point(|gap| gap.high < level).min(curve.gaps.len() - 1);
            let gap = curve.gaps[index];
            // A convex curve lies between the chord of a gap and that of the gap before, drawn on.
            let load = (OF_LOAD * gap.radius).min(gap.rise);
            (load * (level.min(gap.high) - gap.low), OF_RADIUS * gap.radius)
        };
        // Where X hardly rises, a radius says little of the level.
        let level = if error > 0.0 { (error / self.radius_and_rate(level.into())[1]).min(level) } else { 0.0 };
        InterpolationError { load: if load > 0.0 { load } else { 0.0 }, level, kernel: 0.0 }
    }
}
