//! A sum from its parts: where it ends, where it falls, and what is kept of it.

use super::super::polynomial::Polynomial;
use super::super::shape::{End, Shape, ShapeFacts};
use super::super::{Error, Profile, Tabulated, range};
use super::Sum;
use crate::cells::grid;
use crate::cells::stages::Stages;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::turning;

/// How near to its equator, over its radius, the cells of a sum with an exact sphere may end.
const DEEPEST: f64 = 0.9;

/// The radius of a flat core, m.
fn flat_radius(part: &Profile) -> f64 {
    if let Profile::Tabulated(table) = part { table.flat_radius() } else { part.radius(0.0) }
}

/// What holds for the sum because it does for its parts.
fn facts_of(parts: &[Profile]) -> ShapeFacts {
    let facts = || parts.iter().map(Shape::facts);
    let sum = ShapeFacts {
        ceiling: facts().map(|part| part.ceiling).fold(f64::INFINITY, f64::min),
        power: facts().map(|part| part.power).fold(1.0, f64::max),
        singular: facts().find_map(|part| part.singular),
        curvature_radius: facts().filter_map(|part| part.curvature_radius).reduce(f64::min),
        kernel_falls: facts().all(|part| part.kernel_falls),
        analytic_tip: facts().all(|part| part.analytic_tip),
        smooth_centre: facts().all(|part| part.smooth_centre),
        smooth_tip: facts().all(|part| part.smooth_tip),
        by_series: parts.iter().all(|part| matches!(part, Profile::FlatPunch(_)) || part.facts().by_series),
        ..ShapeFacts::default()
    };
    sum.ending(facts().filter_map(|part| part.known_to).reduce(|a, b| if b.radius < a.radius { b } else { a }))
}

impl Sum {
    /// The sum of `parts`; sums among them are taken apart.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::PARTS`], [`Error::NotConvexEnough`] if g falls before it has risen,
    /// [`Error::NoSurface`] for a part that is known by its load curve alone.
    pub fn new(parts: Vec<Profile>) -> Result<Sum, Error> {
        Sum::new_while(parts, &|| true)
    }

    /// The same while `keep_going` returns true.
    ///
    /// # Errors
    /// As [`Sum::new`], and [`Error::Interrupted`].
    pub fn new_while(parts: Vec<Profile>, keep_going: &dyn Fn() -> bool) -> Result<Sum, Error> {
        let mut flat = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                Profile::Sum(sum) => flat.extend(sum.parts),
                other => flat.push(other),
            }
        }
        range::PARTS.check(flat.len() as f64)?;
        if let Some(part) = flat.iter().position(|part| !part.has_stress_field()) {
            return Err(Error::NoSurface { part });
        }
        let mut kinks: Vec<f64> = flat.iter().flat_map(|part| part.knots_below(f64::INFINITY)).collect();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup_by(|a, b| a.to_bits() == b.to_bits());
        let mut sum = Sum {
            rim: None,
            bracket: None,
            facts: facts_of(&flat),
            polynomial: Polynomial::of(&flat),
            stages: None,
            parts: flat,
            kinks,
        };
        let rim = sum.parts.iter().filter_map(Profile::rim_radius).fold(f64::INFINITY, f64::min);
        let falls = sum.first_fall(rim, keep_going)?;
        if let Some(radius) = falls {
            sum.facts = sum.facts.ending(Some(End { radius, falls: true }));
        }
        let rim = falls.unwrap_or(rim);
        if rim < sum.facts.ceiling {
            sum.rim = Some((rim, sum.level(rim)));
            sum.facts.rim = Some(rim);
        }
        if sum.parts.iter().any(|part| part.facts().falls_within()) {
            let flat_radius = sum.parts.iter().map(flat_radius).fold(rim, f64::min);
            if !sum.rim.is_some_and(|(_, top)| top > 0.0) {
                return Err(Error::NotConvexEnough { radius: flat_radius });
            }
            sum.bracket = Some((flat_radius, rim));
        }
        sum.kinks.retain(|&kink| kink <= rim);
        sum.stages = sum.cells_end().filter(|_| sum.polynomial.is_none()).map(|end| (Stages::new(), end));
        Ok(sum)
    }

    /// The square, m^2, where its cells end; `None` where a part has no series at its tip, or where a radius loses the
    /// digits of a level beside the end of a sphere.
    fn cells_end(&self) -> Option<DoubleDouble> {
        let end =
            self.facts.rim.unwrap_or(grid::ENDLESS).min(self.facts.known_to.map_or(f64::INFINITY, |end| end.radius));
        let has_series = |part: &Profile| match part {
            Profile::PowerLaw(_) => false,
            Profile::ExactSphere(_) => end < DEEPEST * part.facts().ceiling,
            _ => true,
        };
        let rises = Shape::kinks(self).first().is_some_and(|kink| kink.radius < end);
        (rises && self.parts.iter().all(has_series)).then(|| DoubleDouble::square_of(end))
    }

    /// The first radius below `rim` at which the sum falls, where a part of it does, m.
    fn first_fall(&self, rim: f64, keep_going: &dyn Fn() -> bool) -> Result<Option<f64>, Error> {
        let tables = self.parts.iter().filter(|part| part.facts().falls_within()).filter_map(|part| match part {
            Profile::Tabulated(table) => Some(table),
            _ => None,
        });
        let mut samples: Vec<f64> =
            tables.flat_map(Tabulated::slope_check_radii).filter(|&radius| radius < rim).collect();
        samples.sort_by(f64::total_cmp);
        let sizes = |x: f64| self.total(|part| part.slope(x).abs());
        // Parts that cancel leave their rounding.
        let falls = |x: f64| Shape::slope(self, x) < -1e-12 * sizes(x);
        let found = samples.iter().position(|&x| !keep_going() || falls(x));
        if !keep_going() {
            return Err(Error::Interrupted);
        }
        let Some(index) = found else { return Ok(None) };
        let before = index.checked_sub(1).map_or(0.0, |before| samples[before]);
        Ok(Some(turning([before, samples[index]], falls)[0]))
    }
}
