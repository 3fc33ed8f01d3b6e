//! Many Hertzian asperities on one rigid motion, which do not interact elastically: X(y) = sum sqrt(R_i (y - h_i)) over
//! the gaps h_i < y (Greenwood & Williamson 1966; with friction by Ciavarella 1998 and Jaeger 1998).
//!
//! Each asperity that is touched adds the moments of a parabola from its own tip on, so that a thin ring keeps its
//! digits. The levels are divided into cells of a few gaps each. Within a cell the asperities whose gaps lie far below
//! it are one series of X' ([`Local`]), the others are summed one by one; whole cells are summed by a [`MomentTree`].
//! So a ring costs two cells and the logarithm of their number.
//!
//! One asperity alone is a [`Sphere`].

use std::ops::Range;
use std::sync::Arc;

use super::curve_family::CurveFamily;
use super::{DoubleDouble, Error, Moments, Ring, Sphere, range};
use crate::cells::moment_tree::MomentTree;
use crate::error::CurveFault;
use crate::numerics::far_field::{FarField, Local};
use crate::numerics::gauss::TWELVE_POINTS;
use crate::numerics::roots::increasing;

/// Asperities in the smallest cluster: fewer are summed one by one sooner than as the twenty points of a cluster.
const LEAF: usize = 16;

/// Asperities up to this many are summed one by one, without a look at their clusters.
const FEW: usize = 8 * LEAF;

/// Asperities that are summed side by side.
const LANES: usize = 4;

/// A set of asperities; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Asperities(pub(super) Count);

/// One asperity, or several.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Count {
    One(Sphere),
    Many(Arc<Set>),
}

#[derive(Debug, PartialEq)]
pub(super) struct Set {
    /// Gaps above the smallest, m, rising, and sqrt(R), m^(1/2), of each.
    gaps: Vec<f64>,
    roots: Vec<f64>,
    clusters: FarField,
    /// Cells of levels, rising from zero, with X' by the asperities far below each; their upper ends; and their
    /// moments.
    cells: Vec<Local>,
    ends: Vec<f64>,
    whole_cells: MomentTree,
    /// The sum of all sqrt(R), m^(1/2).
    total: f64,
}

impl Asperities {
    /// Parabolas of these radii of curvature, m, one for all or one each, whose tips are this far, m, from the flat. An
    /// offset of the gaps does not matter: indentations count from the first touch.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::ASPERITIES`], [`range::RADIUS`] and [`range::GAP`], [`Error::Curve`] for radii
    /// and gaps that differ in number.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Asperities, Profile};
    ///
    /// let three = Profile::Asperities(Asperities::new(&[1e-4], &[0.0, 0.0, 2e-6])?);
    /// // At 1 um two of them carry, each like a ball: X = 2 sqrt(R d).
    /// assert!((three.radius(1e-6) - 2e-5).abs() < 1e-19);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn new(radii: &[f64], gaps: &[f64]) -> Result<Asperities, Error> {
        Asperities::new_while(radii, gaps, &|| true)
    }

    /// The same while `keep_going` returns true.
    ///
    /// # Errors
    /// As [`Asperities::new`], and [`Error::Interrupted`].
    pub fn new_while(radii: &[f64], gaps: &[f64], keep_going: &dyn Fn() -> bool) -> Result<Asperities, Error> {
        range::ASPERITIES.check(gaps.len() as f64)?;
        if radii.len() != 1 && radii.len() != gaps.len() {
            return Err(Error::Curve { fault: CurveFault::LengthsDiffer, index: radii.len().min(gaps.len()) });
        }
        for (radii, range) in [(radii, range::RADIUS), (gaps, range::GAP)] {
            radii.iter().try_for_each(|&number| range.check(number).map(drop))?;
        }
        let mut set: Vec<(f64, f64)> =
            gaps.iter().zip(radii.iter().cycle()).map(|(&gap, radius)| (gap, radius.sqrt())).collect();
        set.sort_by(|a, b| a.0.total_cmp(&b.0));
        let first = set[0].0;
        let (gaps, roots): (Vec<f64>, Vec<f64>) = set.into_iter().map(|(gap, root)| (gap - first, root)).unzip();
        Ok(Asperities(match (gaps.len(), radii) {
            (1, &[radius]) => Count::One(Sphere::of_curvature(radius)),
            _ => Count::Many(Arc::new(Set::new(gaps, roots, keep_going)?)),
        }))
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        match &self.0 {
            Count::One(_) => 1,
            Count::Many(set) => set.gaps.len(),
        }
    }
}

impl Set {
    fn new(gaps: Vec<f64>, roots: Vec<f64>, keep_going: &dyn Fn() -> bool) -> Result<Set, Error> {
        let last = gaps[gaps.len() - 1];
        let clusters = FarField::new(&gaps, &roots, LEAF, keep_going);
        // Above the last gap cells double in width, until all asperities are one cluster far below.
        let start = gaps[gaps.len().saturating_sub(LEAF)];
        let width = last - if start < last { start } else { 0.0 };
        let beyond: Vec<f64> = std::iter::successors(Some((last, width)), |&(end, width)| {
            (end < 2.0 * last).then_some((end + width, 2.0 * width))
        })
        .map(|(end, _)| end)
        .collect();
        let cells = clusters.locals(&beyond, (&gaps, &roots), |distance| 0.5 / distance.sqrt(), keep_going);
        if !keep_going() {
            return Err(Error::Interrupted);
        }
        let total = roots.iter().sum();
        let ends = cells.iter().map(|cell| cell.high).collect();
        let mut set = Set { gaps, roots, clusters, cells, ends, whole_cells: MomentTree::new([].into_iter()), total };
        let whole = |cell: &Local| {
            let depth = cell.high - cell.low;
            (set.moments_within(Some(cell), cell.low.into(), cell.high.into(), depth), depth)
        };
        let whole_cells: Vec<_> = set.cells.iter().map(whole).collect();
        set.whole_cells = MomentTree::new(whole_cells.into_iter());
        Ok(set)
    }

    /// The cell below whose upper end a level lies, if it does not lie above all.
    fn cell(&self, level: DoubleDouble) -> usize {
        self.ends.partition_point(|&end| above(level, end) > 0.0)
    }

    /// How many are touched at a level of a cell.
    fn touched(&self, cell: Option<&Local>, level: DoubleDouble) -> usize {
        let Some(cell) = cell else { return self.gaps.len() };
        cell.items.start + self.gaps[cell.items.clone()].partition_point(|&gap| above(level, gap) > 0.0)
    }

    /// The sums over some asperities of what one gives by sqrt(R) and its gap, which is smooth in the gap up to `level`
    /// alone.
    fn sum<const N: usize>(
        &self,
        some: Range<usize>,
        level: DoubleDouble,
        term: impl Fn(f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let (mut far, mut near) = ([[0.0; LANES]; N], [[0.0; LANES]; N]);
        let here = level.value();
        let mut each = |items: Range<usize>| add(&mut near, &self.gaps[items.clone()], &self.roots[items], &term);
        if some.len() <= FEW {
            each(some);
        } else {
            let far = &mut |gaps: &[f64; _], roots: &[f64; _]| add(&mut far, gaps, roots, &term);
            self.clusters.visit(some, (here, here), far, &mut each);
        }
        std::array::from_fn(|index| far[index].iter().sum::<f64>() + near[index].iter().sum::<f64>())
    }

    /// The moments of a ring within one cell.
    fn moments_within(&self, cell: Option<&Local>, inner: DoubleDouble, outer: DoubleDouble, depth: f64) -> Moments {
        if depth <= 0.0 {
            return Moments::default();
        }
        let moments = |root: f64, gap: f64| {
            // The ring of a parabola x^2 = R (y - h), over sqrt(R): see `sphere.rs`.
            let top = above(outer, gap);
            let edge = top.sqrt();
            let width = depth.min(top) / (edge + above(inner, gap).max(0.0).sqrt());
            let area = root * width * width;
            let lever = (4.0 / 3.0 * edge - width) * edge + 0.2 * width * width;
            [root * width, area * (edge - 1.0 / 3.0 * width), area * width * lever]
        };
        // Of those touched within the ring, only the outer level is seen.
        let first = cell.map_or(0, |cell| cell.first_near);
        let (before, after) = (self.touched(cell, inner), self.touched(cell, outer));
        let (old, new) = (self.sum(first..before, inner, moments), self.sum(before..after, outer, moments));
        let mut sums: [f64; 3] = std::array::from_fn(|index| old[index] + new[index]);
        if let Some(cell) = cell.filter(|cell| cell.first_near > 0) {
            let start = above(inner, cell.low);
            let rates = cell.at(TWELVE_POINTS.map(|(at, _)| start + depth * at));
            for (rate, (at, weight)) in rates.into_iter().zip(TWELVE_POINTS) {
                let (mut share, left) = (weight * rate * depth, depth * (1.0 - at));
                for sum in &mut sums {
                    *sum += share;
                    share *= left;
                }
            }
        }
        let [width, first, second] = sums;
        Moments { width, first, second }
    }

    /// The moments of the ring up to a level from a lower one.
    fn moments_between(&self, inner: DoubleDouble, outer: DoubleDouble, depth: f64) -> Moments {
        let (first, last) = (self.cell(inner), self.cell(outer));
        if first == last {
            return self.moments_within(self.cells.get(last), inner, outer, depth);
        }
        let high = DoubleDouble::from(self.ends[first]);
        let low = DoubleDouble::from(self.ends[last - 1]);
        let (head, tail) = ((high - inner).value(), (outer - low).value());
        let inside = self.moments_within(self.cells.get(first), inner, high, head);
        let outside = self.moments_within(self.cells.get(last), low, outer, tail);
        self.whole_cells.across(first + 1..last, inside, (outside, tail))
    }

    /// The moments of all levels up to one.
    fn moments_below(&self, level: DoubleDouble) -> Moments {
        let last = self.cell(level);
        let Some(below) = last.checked_sub(1) else {
            return self.moments_within(self.cells.first(), DoubleDouble::ZERO, level, level.value());
        };
        let low = DoubleDouble::from(self.ends[below]);
        let depth = (level - low).value();
        let outside = self.moments_within(self.cells.get(last), low, level, depth);
        self.whole_cells.across(0..last, Moments::default(), (outside, depth))
    }

    /// X'(y).
    fn rate_at(&self, level: DoubleDouble) -> f64 {
        let cell = self.cells.get(self.cell(level));
        let near = cell.map_or(0, |cell| cell.first_near)..self.touched(cell, level);
        let [far] = cell.map_or([0.0], |cell| cell.at([above(level, cell.low)]));
        far + self.sum(near, level, |root, gap| [0.5 * root / above(level, gap).sqrt()])[0]
    }

    /// X and its slope.
    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2] {
        [self.moments_below(level).width, self.rate_at(level)]
    }

    /// int_0^y X dy, and X.
    fn load_and_radius(&self, level: DoubleDouble) -> [f64; 2] {
        let Moments { width, first, .. } = self.moments_below(level);
        [first, width]
    }

    /// The level at which a function that rises from zero, given with its slope, has this value; `least` is no larger.
    fn invert(&self, target: f64, least: f64, value: impl Fn(&Set, DoubleDouble) -> [f64; 2]) -> f64 {
        if target <= 0.0 {
            return 0.0;
        }
        // Between two gaps it is smooth.
        let gaps = &self.gaps;
        let index = gaps.partition_point(|&gap| value(self, gap.into())[0] < target);
        let base = gaps[index.saturating_sub(1)];
        let room = gaps.get(index).map_or(f64::INFINITY, |next| next - base);
        let guess = if least > base { least - base } else { room.min(least) };
        let step = increasing(guess, |step| {
            let [here, slope] = value(self, DoubleDouble::sum(base, step));
            (here - target, slope)
        });
        base + step.min(room)
    }
}

/// Adds the terms side by side, because roots and divisions take long and one need not wait for another's.
fn add<const N: usize>(
    sums: &mut [[f64; LANES]; N],
    gaps: &[f64],
    roots: &[f64],
    term: &impl Fn(f64, f64) -> [f64; N],
) {
    let (gaps, roots) = (gaps.chunks(LANES), roots.chunks(LANES));
    for (gaps, roots) in gaps.zip(roots) {
        // Lanes left over weigh nothing.
        let (mut gap, mut root) = ([gaps[0]; LANES], [0.0; LANES]);
        gap[..gaps.len()].copy_from_slice(gaps);
        root[..roots.len()].copy_from_slice(roots);
        for lane in 0..LANES {
            for (sum, one) in sums.iter_mut().zip(term(root[lane], gap[lane])) {
                sum[lane] += one;
            }
        }
    }
}

/// How far a level lies above a gap, m: to round-off of itself, however near.
fn above(level: DoubleDouble, gap: f64) -> f64 {
    let (whole, rest) = level.parts();
    (whole - gap) + rest
}

impl CurveFamily for Arc<Set> {
    fn radius_at(&self, level: DoubleDouble) -> f64 {
        self.moments_below(level).width
    }

    fn rate(&self, level: f64) -> f64 {
        self.rate_at(level.into())
    }

    fn level_of(&self, radius: f64) -> f64 {
        let least = radius / self.total;
        self.invert(radius, least * least, Set::radius_and_rate)
    }

    fn moments_of(&self, ring: &Ring) -> Moments {
        self.moments_between(ring.inner.level, ring.outer.level, ring.depth)
    }

    fn indentation_of(&self, load: f64) -> f64 {
        let least = (1.5 * load / self.total).cbrt();
        self.invert(load, least * least, Set::load_and_radius)
    }
}
