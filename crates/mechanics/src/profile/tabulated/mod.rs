//! Profile given by a table: the smooth curve of [`spline`] through its points, so f'' jumps at the knots and g is a sum of rounded
//! punches (Schubert 1942) of strength half the jump. It is not summed that way: between two knots g is analytic in
//! t = sqrt(x^2 - k^2), and one short series there replaces the thousand terms.
//!
//! f'(0) = 0: a sharp tip would come from the noise of the first two points, with a log-infinite pressure; to model
//! one, add a cone. With n equal steps the interpolation error of g falls as n^(-5/2), measured for f = cosh r - 1 up
//! to r = 1.5: 3e-5 of g at n = 30, 1e-6 at 120 (`tests/physics/tables.rs`). Only radii below the last of the table, and below the
//! first at which g falls, exist: but for the part of a sum, whose g may fall as long as that of the sum does not.

mod build;
mod displacement;
mod interpolation_error;
mod kernel;
mod lookup;
mod near_kernel;
mod noise;
mod panel;
mod panel_integrals;
mod panels;
mod ring_moments;
mod spline;
#[cfg(test)]
mod tests;
mod weighted_panels;

use super::super::error::TableFault;
use super::cluster_tree::ClusterTree;
use super::moment_tree::MomentTree;
use super::multipole::Multipole;
use super::shape::{self, End, Shape};
use super::smooth_coordinate::{self, SmoothCoordinate};
use super::smooth_interval::{Node, SmoothInterval};
use super::{DoubleDouble, Error, Moments, Point, Ring, Span, StressRadius, gauss, range};
pub use interpolation_error::InterpolationError;
use kernel::Kernel;
use lookup::Lookup;
use panel::Panel;
use spline::Knot;
pub(super) use weighted_panels::WeightedPanels;

/// A bound of int dt/sqrt(t^2 - s^2) over any panel, for any radius that is further from a knot than e^-36 of the panel's end: it is
/// ln(2 t/s), or less.
const LOGARITHM: f64 = 40.0;
/// As many kernels, rings times radii, are summed sooner than panels are weighted for all of them.
const FEW: usize = 128;

/// A tabulated profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    radii: Vec<f64>,
    heights: Vec<f64>,
    /// Estimate of the noise of the heights, m.
    noise: f64,
    /// The interpolation error at increasing radii.
    interpolation_errors: Vec<(f64, InterpolationError)>,
    panels: Vec<Panel>,
    by_radius: Lookup,
    by_level: Lookup,
    /// Moments and depth of all runs of panels.
    tree: MomentTree,
    /// The kernel's sources.
    sources: ClusterTree<Multipole>,
    knots: Vec<f64>,
    /// The sums of [`Panel::steepest`] before each panel.
    steepest: Vec<f64>,
    /// Radius, level and load at the end.
    end: (f64, f64, f64),
    /// The first radius at which g falls, if it does.
    falls: Option<f64>,
}

impl Tabulated {
    /// The profile through the points (r, z), m. `radii` begin at zero and increase; an offset of z does not matter.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::TABLE_POINTS`], [`range::TABLE_RADIUS`] and [`range::TABLE_HEIGHT`], [`Error::Table`] for a
    /// table that is none, [`Error::NotConvexEnough`] if g falls from the centre on.
    pub fn new(radii: &[f64], heights: &[f64]) -> Result<Tabulated, Error> {
        Tabulated::through(radii, heights, false)
    }

    /// The part of a sum through the points (r, z), m, whose g may fall: for example the deviation of a body from a
    /// sphere. On its own, g has no inverse from there on, and contacts end there.
    ///
    /// # Errors
    /// As [`Tabulated::new`], but for a g that falls.
    pub fn part(radii: &[f64], heights: &[f64]) -> Result<Tabulated, Error> {
        Tabulated::through(radii, heights, true)
    }

    fn through(radii: &[f64], heights: &[f64], whole: bool) -> Result<Tabulated, Error> {
        range::TABLE_POINTS.check(radii.len() as f64)?;
        if radii.len() != heights.len() {
            return Err(Error::Table { fault: TableFault::LengthsDiffer, index: radii.len().min(heights.len()) });
        }
        for (&radius, &height) in radii.iter().zip(heights) {
            range::TABLE_RADIUS.check(radius)?;
            range::TABLE_HEIGHT.check(height)?;
        }
        if radii[0] > 0.0 {
            return Err(Error::Table { fault: TableFault::FirstRadiusNotZero, index: 0 });
        }
        if let Some(index) = radii.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(Error::Table { fault: TableFault::RadiusNotRising, index: index + 1 });
        }
        range::RADIUS.check(radii[1])?;
        let knots = spline::knots(radii, heights);
        let mut table = Tabulated::from_knots(&knots, whole)?;
        table.interpolation_errors = interpolation_error::up_to_radii(radii, heights, &knots);
        (table.radii, table.heights) = (radii.to_vec(), heights.to_vec());
        table.noise = noise::of_heights(radii, heights);
        Ok(table)
    }

    /// The profile whose slope is linear between knots, as far as g rises or `whole`.
    fn from_knots(knots: &[Knot], whole: bool) -> Result<Tabulated, Error> {
        let (mut panels, falls_at) = build::panels(knots, whole);
        let (level, load) = build::accumulate(&mut panels);
        let Some(last) = panels.last() else {
            return Err(match falls_at {
                Some(radius) => Error::NotConvexEnough { radius },
                None => Error::Table { fault: TableFault::HeightNeverRises, index: knots.len() - 1 },
            });
        };
        let end = (last.end().1, level, load);
        let leaf = |panel: &Panel| (smooth_coordinate::moments(panel, &panel.span(None)), panel.depth());
        let tree = MomentTree::new(panels.iter().map(leaf));
        let sources = weighted_panels::sources(&panels);
        let mut knots: Vec<f64> = panels.iter().map(|panel| panel.base).filter(|&base| base > 0.0).collect();
        knots.dedup_by(|a, b| a.to_bits() == b.to_bits());
        let steepest = panels.iter().scan(0.0, |sum, panel| Some(std::mem::replace(sum, *sum + panel.steepest())));
        let steepest = steepest.collect();
        let by_radius = Lookup::new(panels.iter().map(|panel| panel.radius), end.0);
        let by_level = Lookup::new(panels.iter().map(|panel| panel.level), level);
        Ok(Tabulated {
            radii: Vec::new(),
            heights: Vec::new(),
            noise: 0.0,
            interpolation_errors: Vec::new(),
            panels,
            by_radius,
            by_level,
            tree,
            sources,
            knots,
            steepest,
            end,
            // A curve that was cut where g falls ends there, however that radius is rounded.
            falls: falls_at.map(|radius| if whole { radius.min(end.0) } else { end.0 }),
        })
    }

    /// Radii, m, increasing, between which g' cannot hide a fall.
    pub(super) fn slope_check_radii(&self) -> impl Iterator<Item = f64> {
        self.panels.iter().flat_map(|panel| panel.slope_check_places().into_iter().map(|t| panel.radius_at(t)))
    }
}

impl Shape for Tabulated {
    fn level(&self, radius: f64) -> f64 {
        let panel = &self.panels[self.find(radius)];
        panel.level_at(panel.t_of(DoubleDouble::square_of(radius)))
    }

    fn slope(&self, radius: f64) -> f64 {
        let panel = &self.panels[self.find(radius)];
        if radius < panel.radius {
            return 0.0;
        }
        panel.slope_over_radius(panel.t_of(DoubleDouble::square_of(radius))) * radius
    }

    fn radius(&self, level: f64) -> f64 {
        self.square(level.into()).value().sqrt()
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let y = level.value();
        if y >= self.end.1 {
            return DoubleDouble::square_of(self.end.0);
        }
        let index = self.by_level.holding(y);
        let panel = &self.panels[index];
        let rest = (level - DoubleDouble::from(panel.level)).value();
        if rest <= 0.0 {
            return panel.square;
        }
        if let Some(further) = panel_integrals::distance(panel, rest) {
            return panel.square + DoubleDouble::from(further);
        }
        let whole = self.panels.get(index + 1).map_or(self.end.1, |next| next.level) - panel.level;
        let t =
            panel.find(rest / whole, 2.0, |t| (panel.rise_at(panel.low, t, t - panel.low) - rest, panel.slope_at(t)));
        DoubleDouble::square_of(panel.base) + DoubleDouble::square_of(t)
    }

    fn load(&self, radius: f64) -> f64 {
        let panel = &self.panels[self.find(radius)];
        panel.load + panel.load_to(panel.t_of(DoubleDouble::square_of(radius)))
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        let (radius, level, most) = self.end;
        if load >= most {
            return level + (load - most) / radius;
        }
        let index = self.panels.partition_point(|panel| panel.load <= load).saturating_sub(1);
        let panel = &self.panels[index];
        let rest = load - panel.load;
        let whole = self.panels.get(index + 1).map_or(self.end.2, |next| next.load) - panel.load;
        let t = panel.find(rest / whole, 3.0, |t| (panel.load_to(t) - rest, panel.radius_at(t) * panel.slope_at(t)));
        panel.level_at(t)
    }

    fn rise(&self, span: &Span) -> f64 {
        let (low, whole, high) = self.parts(span);
        let between = self.tree.run(whole.start, whole.end).1;
        [low, high]
            .into_iter()
            .flatten()
            .map(|(index, span)| smooth_coordinate::rise(&self.panels[index], &span))
            .sum::<f64>()
            + between
    }

    fn rise_to(&self, outer: &Span, interval: &SmoothInterval, node: Node) -> f64 {
        let index = self.by_radius.ending_at(outer.outer_radius);
        let panel = &self.panels[index];
        // The series knows no other knot than its own.
        if panel.base.to_bits() == interval.base.to_bits() && node.t >= panel.low {
            return panel.rise_at(node.t, interval.high, node.dt);
        }
        self.rise(&shape::under(outer, interval, node))
    }

    fn rises(&self, span: &Span, below: &[f64]) -> Vec<f64> {
        let (_, mut index) = self.ends(span);
        let (mut above, mut high) = (0.0, self.panels[index].t_of(span.outer));
        let rise = |&below: &f64| {
            let square = span.outer - DoubleDouble::from(below * (2.0 * span.outer_radius - below));
            let mut panel = &self.panels[index];
            while index > 0 && panel.square > square {
                let whole = high >= panel.high;
                above += if whole { self.tree.leaf(index).1 } else { panel.rise_at(panel.low, high, high - panel.low) };
                index -= 1;
                panel = &self.panels[index];
                high = panel.high;
            }
            let t = panel.t_of(square).min(high);
            above + panel.rough_rise(t, high)
        };
        below.iter().map(rise).collect()
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let square = DoubleDouble::square_of(self.end.0);
        let outer =
            if ring.outer.square > square { Point { square, radius: self.end.0, ..ring.outer } } else { ring.outer };
        let inside = Ring { outer, ..*ring };
        let first = self.find(inside.inner.radius);
        if self.panels.get(first + 1).is_some_and(|next| next.radius < outer.radius) {
            // Across a knot: the squares have the distance to it on either side.
            return (outer.square - inside.inner.square).value();
        }
        smooth_coordinate::gap(&self.panels[first], &inside, depth)
    }

    fn rim(&self) -> Option<(f64, f64)> {
        Some((self.end.0, self.end.1))
    }

    fn kink_below(&self, radius: f64) -> f64 {
        let above = self.knots.partition_point(|&knot| knot < radius);
        above.checked_sub(1).map_or(0.0, |index| self.knots[index])
    }

    fn moments(&self, span: &Span) -> Moments {
        let (low, whole, high) = self.parts(span);
        let mut sum = self.tree.run(whole.start, whole.end);
        if let Some((index, span)) = low {
            sum.0 = Moments::stack(smooth_coordinate::moments(&self.panels[index], &span), sum.0, sum.1);
        }
        if let Some((index, span)) = high {
            let panel = &self.panels[index];
            sum.0 =
                Moments::stack(sum.0, smooth_coordinate::moments(panel, &span), smooth_coordinate::rise(panel, &span));
        }
        sum.0
    }

    fn ring_moments(&self, ring: &Ring) -> Moments {
        self.moments_across(ring).unwrap_or_else(|| {
            let span = self.span(ring);
            Moments::stack(self.moments(&span), Moments::default(), span.edge)
        })
    }

    fn kernel(&self, at: &StressRadius, span: &Span) -> f64 {
        self.sum(Kernel::Root, at, span)
    }

    fn kernel_slope(&self, at: &StressRadius, span: &Span) -> f64 {
        self.sum(Kernel::RootSlope, at, span)
    }

    fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Option<Vec<f64>> {
        if rings.len() * radii.len() <= FEW {
            return None;
        }
        let sums = WeightedPanels::new(self, rings)?.sums(Kernel::Root, radii);
        Some(sums.into_iter().map(|(sum, _)| sum).collect())
    }

    fn displacements(&self, rings: &[(Ring, f64)], ends: (f64, f64), radii: &[StressRadius]) -> Option<Vec<f64>> {
        displacement::displacements(self, rings, ends, radii)
    }

    fn least_fall(&self, inner: f64, outer: f64) -> f64 {
        // 2 v int q' dt is v int (dq/dt) dt/sqrt(t^2 - s^2), s the t of r in the panel, summed over the panels.
        let (first, last) = (self.find(inner), self.find(outer));
        let steepest = self.steepest[last] + self.panels[last].steepest() - self.steepest[first];
        self.slope(outer) / outer - ((outer - inner) * (outer + inner)).sqrt() * LOGARITHM * steepest
    }

    fn surface_slope(&self, r: f64) -> f64 {
        let index = self.radii.partition_point(|point| *point < r).clamp(1, self.radii.len() - 1);
        (self.heights[index] - self.heights[index - 1]) / (self.radii[index] - self.radii[index - 1])
    }

    fn limit(&self) -> Option<End> {
        Some(End { radius: self.falls.unwrap_or(self.end.0), falls: self.falls.is_some() })
    }

    fn known_to(&self) -> Option<End> {
        Some(End { radius: self.end.0, falls: self.falls.is_some_and(|radius| radius >= self.end.0) })
    }

    fn falls_within(&self) -> bool {
        self.falls.is_some_and(|radius| radius < self.end.0)
    }

    fn flat_radius(&self) -> f64 {
        self.panels.first().map_or(0.0, |panel| panel.radius)
    }

    fn interpolation_error(&self, radius: f64) -> InterpolationError {
        let errors = &self.interpolation_errors;
        let index = errors.partition_point(|(end, _)| *end < radius);
        errors.get(index).or(errors.last()).map_or_else(InterpolationError::default, |(_, error)| *error)
    }

    fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        let amplification = self.noise_amplification(radius);
        Some((self.noise * amplification, amplification))
    }
}
