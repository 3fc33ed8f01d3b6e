//! A profile made of several: g is linear in f, so that kinks and slopes add up, and the cells follow.
//!
//! A flat punch among the parts ends the sum in its vertical edge. The g of a table among them may fall where the
//! others make up for it.

use std::sync::Arc;

use super::{Error, Profile, Tabulated, range};
use crate::cells::shape::{End, EndKind, Kinks, Shape, united};
use crate::cells::stages::Stages;
use crate::numerics::roots::turning;

/// The share of the slopes of the parts below which a fall of their sum is rounding.
const ROUNDING_OF_SLOPE: f64 = 1e-12;

/// A sum of profiles, none of them a sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum {
    parts: Vec<Profile>,
    kinks: Kinks,
    end: Option<End>,
    stages: Stages,
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
        if let Some(part) = flat.iter().position(|part| !part.is_round()) {
            return Err(Error::NoSurface { part });
        }
        let kinks = united(&flat.iter().filter_map(Profile::shape).map(Shape::kinks).collect::<Vec<_>>());
        let end = flat.iter().filter_map(end_in_sum).reduce(|a, b| if b.radius < a.radius { b } else { a });
        let mut sum = Sum { parts: flat, kinks, end, stages: Stages::new() };
        if let Some(radius) = sum.first_fall(keep_going)? {
            sum.end = Some(End { radius, kind: EndKind::Fall });
        }
        let top = sum.end.filter(|_| sum.falling_tables().next().is_some()).map(|end| sum.level(end.radius));
        if top.is_some_and(|top| top <= 0.0) {
            return Err(Error::NotConvexEnough { radius: sum.kinks.first().map_or(0.0, |kink| kink.at.radius) });
        }
        Ok(sum)
    }

    /// The parts, none of them a sum.
    #[must_use]
    pub fn parts(&self) -> &[Profile] {
        &self.parts
    }

    /// The tables whose g falls before their end.
    fn falling_tables(&self) -> impl Iterator<Item = &Tabulated> {
        self.parts.iter().filter_map(|part| match part {
            Profile::Tabulated(table) if table.falls_within() => Some(table),
            _ => None,
        })
    }

    /// How many times larger than g at the radius `x`, m, its parts are.
    pub(super) fn cancellation(&self, x: f64) -> f64 {
        if self.falling_tables().next().is_none() {
            return 1.0;
        }
        let growth = |f: &dyn Fn(&Profile) -> f64| {
            let (sum, sizes) = self.parts.iter().map(f).fold((0.0, 0.0), |(a, b), part| (a + part, b + part.abs()));
            if sum > 0.0 { sizes / sum } else { 1.0 }
        };
        // The terms that cancel are themselves good to some units in their last place.
        2.0 * growth(&|part| part.level(x)).max(growth(&|part| part.slope(x)))
    }

    /// The first radius at which the sum falls, where a part of it does, m.
    fn first_fall(&self, keep_going: &dyn Fn() -> bool) -> Result<Option<f64>, Error> {
        let end = self.end_radius();
        let mut samples: Vec<f64> =
            self.falling_tables().flat_map(Tabulated::slope_check_radii).filter(|&radius| radius < end).collect();
        samples.sort_by(f64::total_cmp);
        let falls = |x: f64| {
            let (slope, sizes) = self
                .parts
                .iter()
                .map(|part| part.slope(x))
                .fold((0.0, 0.0), |(slope, sizes), part| (slope + part, sizes + part.abs()));
            // Parts that cancel leave their rounding.
            slope < -ROUNDING_OF_SLOPE * sizes
        };
        let found = samples.iter().position(|&x| !keep_going() || falls(x));
        if !keep_going() {
            return Err(Error::Interrupted);
        }
        let Some(index) = found else { return Ok(None) };
        let before = index.checked_sub(1).map_or(0.0, |before| samples[before]);
        Ok(Some(turning([before, samples[index]], falls)[0]))
    }
}

/// Where a part of a sum ends; a table may go on where its g falls.
fn end_in_sum(part: &Profile) -> Option<End> {
    match part {
        Profile::Tabulated(table) if table.falls_within() => {
            Some(End { radius: table.known_to(), kind: EndKind::Unknown })
        }
        part => part.shape()?.end(),
    }
}

impl Shape for Sum {
    fn kinks(&self) -> Kinks {
        Arc::clone(&self.kinks)
    }

    fn level(&self, x: f64) -> f64 {
        self.parts.iter().filter_map(Profile::shape).map(|part| part.level(x)).sum()
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        self.parts.iter().filter_map(Profile::shape).map(|part| part.gamma(base, t)).sum()
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.parts.iter().map(|part| part.surface_slope(r)).sum()
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        self.end
    }

    fn curvature_radius(&self) -> Option<f64> {
        self.parts.iter().filter_map(Profile::curvature_radius).reduce(f64::min)
    }
}
