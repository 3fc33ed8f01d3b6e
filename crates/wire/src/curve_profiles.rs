//! Profiles of contacts that are known by their load curve alone: asperities, measured curves, Hertz's ellipse.

use stickslip_mechanics::profile::{Asperities, Direction, Ellipsoid, LoadCurve, Profile as Shape};
use stickslip_mechanics::{CurveFault, Elasticity};

use super::check::accepted;
use crate::prelude::*;

requests! {
/// Hertzian asperities between two rigid bodies; each asperity is an elastic contact of its own.
pub struct AsperitiesProfile {
    /// Radii of curvature, m, one for each gap; or give one `radius` for all.
    pub radii: Option<Vec<f64>> = Array(ASPERITIES, range::RADIUS),
    /// Radius of curvature of all asperities, m.
    pub radius: Option<f64> = range::RADIUS,
    /// Distances of the tips from the flat before the load, m, in any order; an offset does not matter, because the
    /// indentation counts from the first touch.
    pub gaps: Vec<f64> = Array(ASPERITIES, range::GAP),
}

/// A load curve from the first touch on. Its slope must not fall.
pub struct LoadCurveProfile {
    /// Indentations d, m: increasing from 0. The indentation must not exceed the last.
    pub indentation: Vec<f64> = Array(CURVE_POINTS, range::PRELOAD_INDENTATION),
    /// The normal force F_N at each indentation, N: increasing from 0.
    pub normal_force: Vec<f64> = Array(CURVE_POINTS, range::NORMAL_FORCE),
}

/// A gap x²/(2 R_x) + y²/(2 R_y); `material` must name the bodies.
pub struct EllipsoidProfile {
    /// The principal radii of curvature of the gap, R_x and R_y, m; their ratio is at most 10⁶.
    pub radii: Vec<f64> = Array(2..=2, range::RADIUS),
    /// The axis along which the indenter moves.
    pub direction: MotionAxis,
}
}

const ASPERITIES: RangeInclusive<usize> = count(&range::ASPERITIES);
const CURVE_POINTS: RangeInclusive<usize> = count(&range::CURVE_POINTS);

words! {
/// The axis of the tangential motion.
pub enum MotionAxis of Direction {
    /// Along x, whose radius is R_x.
    X = "x",
    /// Along y, whose radius is R_y.
    Y = "y",
}
}

impl AsperitiesProfile {
    /// The checked profile; its faults are noted at `at`.
    pub(super) fn check(&self, at: JsonPath<'_>, keep_going: &dyn Fn() -> bool, faults: &mut Faults) -> Option<Shape> {
        if self.radii.is_some() == self.radius.is_some() {
            return faults.refuse(at, "give either `radii`, one for each gap, or one `radius` for all");
        }
        let radii = self.radii.as_deref().unwrap_or(self.radius.as_slice());
        if self.radii.is_some() && radii.len() != self.gaps.len() {
            let (radii, gaps) = (radii.len(), self.gaps.len());
            let detail = format_args!("{gaps} gaps for {radii} radii: give one radius for each gap");
            return faults.refuse(at.member("gaps"), detail);
        }
        accepted(Asperities::new_while(radii, &self.gaps, keep_going).map(Shape::Asperities), at, faults)
    }
}

impl LoadCurveProfile {
    /// The checked profile of these bodies; its faults are noted at `at`.
    pub(super) fn check(
        &self,
        bodies: &Elasticity,
        at: JsonPath<'_>,
        keep_going: &dyn Fn() -> bool,
        faults: &mut Faults,
    ) -> Option<Shape> {
        let LoadCurveProfile { indentation, normal_force } = self;
        let curve =
            if keep_going() { LoadCurve::new(indentation, normal_force, bodies) } else { Err(Error::Interrupted) };
        if let Err(Error::Curve { fault, index }) = curve {
            let (member, whole) = match fault {
                CurveFault::LengthsDiffer => ("normal_force", true),
                CurveFault::IndentationNotRising => ("indentation", false),
                CurveFault::NotFromZero if indentation.first().is_some_and(|first| *first > 0.0) => {
                    ("indentation", false)
                }
                CurveFault::NotFromZero | CurveFault::ForceNotRising | CurveFault::SlopeFalls => {
                    ("normal_force", false)
                }
            };
            let place = at.member(member);
            return faults.refuse(if whole { place } else { place.index(index) }, fault);
        }
        accepted(curve.map(Shape::LoadCurve), at, faults)
    }
}

impl EllipsoidProfile {
    /// The checked profile; its faults are noted at `at`.
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
        let place = at.member("radii");
        let &[x, y] = self.radii.as_slice() else { return None };
        let ratio = x.max(y) / x.min(y);
        let Range { max, .. } = range::RADIUS_RATIO;
        if ratio > max {
            let detail = format_args!("one radius is {ratio:e} times the other: at most {max:e} is allowed");
            return faults.refuse(place, detail);
        }
        accepted(Ellipsoid::new([x, y], self.direction.into()).map(Shape::Ellipsoid), at, faults)
    }
}
