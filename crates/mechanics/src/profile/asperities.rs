//! Many Hertzian asperities on one rigid motion, which do not interact elastically: X(y) = sum sqrt(R_i (y - h_i)) over
//! the gaps h_i < y (Greenwood & Williamson 1966; with friction by Ciavarella 1998 and Jäger 1998).
//!
//! Each asperity that is touched adds the moments of a parabola from its own tip on, so that a thin ring keeps its
//! digits. The levels are divided into cells of a few gaps each ([`LevelCell`]). Within a cell the asperities whose
//! gaps lie farther below it than it is wide are one series of X', the others are summed one by one; whole cells are
//! summed by a [`MomentTree`]. So a ring costs two cells and the logarithm of their number.
//!
//! One asperity alone is a parabola.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::curve_family::CurveFamily;
use super::{Moments, Ring};
#[cfg(test)]
use crate::cells::call_count;
use crate::cells::moment_tree::MomentTree;
use crate::cells::parabola::Parabola;
use crate::numerics::chebyshev::{self, TWENTY};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWELVE_POINTS;
use crate::numerics::multipole::Multipole;
use crate::numerics::roots::within;
use crate::range;
use crate::range::error::{CurveFault, Error};

/// Asperities in the smallest cluster.
const LEAF: usize = 16;

/// A cell of levels with more asperities than this within it or near below it is halved.
const NEAR: usize = 2 * LEAF;

/// Above this level, m, there are no cells: no contact is pressed in so far.
const HIGHEST: f64 = 1e10;

/// Cells beside one for every four asperities, at which halving ends: clusters of gaps that are far narrower than the
/// distances between them would take many.
const MOST_CELLS: usize = 2048;

/// A set of asperities; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Asperities(pub(super) Count);

/// One asperity, or several.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Count {
    One(Parabola),
    Many(Arc<Set>),
}

#[derive(Debug, PartialEq)]
pub(super) struct Set {
    /// Gaps above the smallest, m, rising, and sqrt(R), m^(1/2), of each.
    gaps: Vec<f64>,
    roots: Vec<f64>,
    /// Cells of levels, rising from zero, and their moments.
    cells: Vec<LevelCell>,
    whole_cells: MomentTree,
    /// The sum of all sqrt(R), m^(1/2).
    total: f64,
    /// int_0^h X dy, m^2, and X, m, at each gap h, once a load has been asked for.
    at_gaps: OnceLock<Vec<[f64; 2]>>,
}

/// An interval of levels, m.
#[derive(Clone, Debug, PartialEq)]
struct LevelCell {
    low: f64,
    high: f64,
    /// The first asperity that is not in the series, because its gap is nearer below than the cell is wide.
    first_near: usize,
    /// The asperities whose gaps lie within the cell.
    items: Range<usize>,
    /// The Chebyshev series of X' and of X by the asperities below `first_near`.
    series: Vec<f64>,
    radii: Vec<f64>,
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
    /// let three = Profile::Asperities(Asperities::new(&[1e-4], &[0.0, 0.0, 2e-6])?).indenter();
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
        if let (1, &[radius]) = (gaps.len(), radii) {
            return Ok(Asperities(Count::One(Parabola { curvature_radius: radius })));
        }
        let mut set: Vec<(f64, f64)> =
            gaps.iter().zip(radii.iter().cycle()).map(|(&gap, radius)| (gap, radius.sqrt())).collect();
        set.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Those of one gap are one parabola.
        set.dedup_by(|next, before| {
            let same = next.0 <= before.0;
            before.1 += if same { next.1 } else { 0.0 };
            same
        });
        let first = set[0].0;
        let (gaps, roots): (Vec<f64>, Vec<f64>) = set.into_iter().map(|(gap, root)| (gap - first, root)).unzip();
        Ok(Asperities(Count::Many(Arc::new(Set::new(gaps, roots, keep_going)?))))
    }
}

impl Set {
    fn new(gaps: Vec<f64>, roots: Vec<f64>, keep_going: &dyn Fn() -> bool) -> Result<Set, Error> {
        let cells = cells(&gaps, &roots, keep_going).ok_or(Error::Interrupted)?;
        let total = roots.iter().sum();
        let at_gaps = OnceLock::new();
        let mut set = Set { gaps, roots, cells, whole_cells: MomentTree::new([].into_iter()), total, at_gaps };
        let whole = |cell: &LevelCell| {
            let depth = cell.high - cell.low;
            (set.moments_within(Some(cell), cell.low.into(), cell.high.into(), depth), depth)
        };
        let whole_cells: Vec<_> = set.cells.iter().map(whole).collect();
        set.whole_cells = MomentTree::new(whole_cells.into_iter());
        for index in 0..set.cells.len() {
            let cell = &set.cells[index];
            let [near] = set.sum(cell.first_near..cell.items.start, |root, gap| [root * (cell.low - gap).sqrt()]);
            let far = set.whole_cells.run(0, index).0.width - near;
            set.cells[index].radii = chebyshev::integral(&cell.series, 0.5 * (cell.high - cell.low), far);
        }
        Ok(set)
    }

    /// The cell below whose upper end a level lies, if it does not lie above all.
    fn cell(&self, level: DoubleDouble) -> usize {
        self.cells.partition_point(|cell| above(level, cell.high) > 0.0)
    }

    /// How many are touched at a level of a cell.
    fn touched(&self, cell: Option<&LevelCell>, level: DoubleDouble) -> usize {
        let items = cell.map_or(0..self.gaps.len(), |cell| cell.items.clone());
        items.start + self.gaps[items].partition_point(|&gap| above(level, gap) > 0.0)
    }

    /// The sums of terms over some asperities, of which each is a function of sqrt(R) and of the gap.
    fn sum<const N: usize>(&self, some: Range<usize>, term: impl Fn(f64, f64) -> [f64; N]) -> [f64; N] {
        #[cfg(test)]
        call_count::add(|calls| &mut calls.asperities);
        let mut sums = [0.0; N];
        for (root, gap) in self.roots[some.clone()].iter().zip(&self.gaps[some]) {
            for (sum, term) in sums.iter_mut().zip(term(*root, *gap)) {
                *sum += term;
            }
        }
        sums
    }

    /// The moments of a ring within one cell.
    fn moments_within(
        &self,
        cell: Option<&LevelCell>,
        inner: DoubleDouble,
        outer: DoubleDouble,
        depth: f64,
    ) -> Moments {
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
        let first = cell.map_or(0, |cell| cell.first_near);
        let mut sums = self.sum(first..self.touched(cell, outer), moments);
        if let Some(cell) = cell.filter(|cell| cell.first_near > 0) {
            let start = above(inner, cell.low);
            let rates = cell.values(&cell.series, TWELVE_POINTS.map(|(at, _)| start + depth * at));
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
        let high = DoubleDouble::from(self.cells[first].high);
        let low = DoubleDouble::from(self.cells[last - 1].high);
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
        let low = DoubleDouble::from(self.cells[below].high);
        let depth = (level - low).value();
        let outside = self.moments_within(self.cells.get(last), low, level, depth);
        self.whole_cells.across(0..last, Moments::default(), (outside, depth))
    }

    /// int_0^y X dy, and X.
    fn load_and_radius(&self, level: DoubleDouble) -> [f64; 2] {
        let Moments { width, first, .. } = self.moments_below(level);
        [first, width]
    }

    fn at_gaps(&self) -> &[[f64; 2]] {
        self.at_gaps.get_or_init(|| self.gaps.iter().map(|&gap| self.load_and_radius(gap.into())).collect())
    }

    /// The level above the last gap at which one of [`Set::at_gaps`] is below a target, where the function, given with
    /// its slope, has this value; `least` is that level without gaps. `first` is a guess from what is known at the gap.
    fn invert(
        &self,
        (target, least): (f64, f64),
        known: impl Fn(&[f64; 2]) -> f64,
        first: impl Fn(&[f64; 2]) -> f64,
        value: impl Fn(DoubleDouble) -> [f64; 2],
    ) -> f64 {
        if target <= 0.0 {
            return 0.0;
        }
        // Between two gaps it is smooth.
        let (gaps, at_gaps) = (&self.gaps, self.at_gaps());
        let index = at_gaps.partition_point(|at| known(at) < target);
        let before = index.saturating_sub(1);
        let base = gaps[before];
        // Beyond all gaps, no farther above the last than if all were there.
        let room = gaps.get(index).map_or(least, |next| next - base);
        let start = if least > base { least - base } else { room.min(least) };
        base + within([0.0, room], start.min(first(&at_gaps[before])), |step| {
            let [here, slope] = value(DoubleDouble::sum(base, step));
            (here - target, slope)
        })
    }
}

impl LevelCell {
    /// One of its series at levels this far above its lower end, side by side.
    fn values<const N: usize>(&self, series: &[f64], offsets: [f64; N]) -> [f64; N] {
        let half = 0.5 * (self.high - self.low);
        chebyshev::values(series, offsets.map(|offset| offset / half - 1.0))
    }
}

/// The cells over asperities of these gaps and sqrt(R); `None` if `keep_going` returned false.
///
/// The levels up to three times the last gap are halved, the widest first. Above, all asperities are far below cells
/// that grow by a half.
fn cells(gaps: &[f64], roots: &[f64], keep_going: &dyn Fn() -> bool) -> Option<Vec<LevelCell>> {
    if gaps.len() <= NEAR {
        return Some(Vec::new());
    }
    let cell = |low: f64, high: f64| {
        let touched = |level| gaps.partition_point(|&gap| gap < level);
        let first_near = gaps.partition_point(|&gap| low - gap > high - low);
        LevelCell { low, high, first_near, items: touched(low)..touched(high), series: Vec::new(), radii: Vec::new() }
    };
    let halved = 3.0 * gaps[gaps.len() - 1];
    let ends = std::iter::successors(Some(halved), |&end| Some(1.5 * end));
    let mut cells: Vec<LevelCell> = ends.take_while(|&low| low < HIGHEST).map(|low| cell(low, 1.5 * low)).collect();
    let mut open = VecDeque::from([cell(0.0, halved)]);
    while let Some(wide) = open.pop_front() {
        let middle = wide.low.midpoint(wide.high);
        let few = wide.items.end - wide.first_near <= NEAR || wide.low >= middle || middle >= wide.high;
        if few || cells.len() + open.len() > MOST_CELLS + gaps.len() / 4 {
            cells.push(wide);
        } else {
            open.extend([cell(wide.low, middle), cell(middle, wide.high)]);
        }
    }
    cells.sort_by(|one, other| one.low.total_cmp(&other.low));
    // X' = sum sqrt(R)/(2 sqrt(y - h)), with -h as the place of a source.
    let clusters = ClusterTree::new(gaps.len(), LEAF, |items, halves| {
        let last = gaps[items.end - 1];
        let mut sources = Multipole::empty((-last).into(), last - gaps[items.start]);
        match halves {
            Some(halves) => halves.into_iter().for_each(|half| sources.add(half, 1.0)),
            None => items.clone().for_each(|item| sources.add_sources(&[last - gaps[item]], &[0.5 * roots[item]])),
        }
        sources
    });
    for LevelCell { low, high, first_near, series, .. } in &mut cells {
        if !keep_going() {
            return None;
        }
        let offsets = TWENTY.places(0.0, *high - *low);
        let (mut near, mut far) = ([0.0; 20], [0.0; 20]);
        let mut visit_far = |cluster: &Cluster<Multipole>| {
            // Places from the last gap on, by which small distances keep their digits.
            let place = -(*low + cluster.sources.origin.value());
            let is_far = cluster.sources.is_far(place);
            if is_far {
                let potentials = cluster.sources.potentials(offsets.map(|offset| place - offset));
                far.iter_mut().zip(potentials).for_each(|(sum, potential)| *sum += potential);
            }
            is_far
        };
        clusters.visit(0..*first_near, &mut visit_far, &mut |items| {
            for item in items {
                let rate = |offset: f64| 0.5 * roots[item] / (*low - gaps[item] + offset).sqrt();
                near.iter_mut().zip(offsets.map(rate)).for_each(|(sum, rate)| *sum += rate);
            }
        });
        *series = TWENTY.series(&std::array::from_fn(|index| near[index] + far[index]));
    }
    Some(cells)
}

/// How far a level lies above a gap, m: to round-off of itself, however near.
fn above(level: DoubleDouble, gap: f64) -> f64 {
    let (whole, rest) = level.parts();
    (whole - gap) + rest
}

impl CurveFamily for Arc<Set> {
    fn radius_at(&self, level: DoubleDouble) -> f64 {
        self.radius_and_rate(level)[0]
    }

    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2] {
        let cell = self.cells.get(self.cell(level));
        let near = cell.map_or(0, |cell| cell.first_near)..self.touched(cell, level);
        let [mut radius, mut rate] = self.sum(near, |root, gap| {
            let edge = above(level, gap).sqrt();
            [root * edge, 0.5 * root / edge]
        });
        if let Some(cell) = cell.filter(|cell| cell.first_near > 0) {
            let offset = above(level, cell.low);
            radius += cell.values(&cell.radii, [offset])[0];
            rate += cell.values(&cell.series, [offset])[0];
        }
        [radius, rate]
    }

    fn level_of(&self, radius: f64) -> f64 {
        let least = radius / self.total;
        self.invert(
            (radius, least * least),
            |[_, radius]| *radius,
            |_| f64::INFINITY,
            |level| self.radius_and_rate(level),
        )
    }

    fn moments_of(&self, ring: &Ring) -> Moments {
        self.moments_between(ring.inner.level, ring.outer.level, ring.depth)
    }

    fn indentation_of(&self, load: f64) -> f64 {
        let least = (1.5 * load / self.total).cbrt();
        // The load rises at least by the radius at the gap.
        let first = |[before, radius]: &[f64; 2]| (load - before) / radius;
        self.invert((load, least * least), |[load, _]| *load, first, |level| self.load_and_radius(level))
    }
}
