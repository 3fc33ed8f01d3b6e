//! Builds the cells of a table from f', in a time that is proportional to the number of knots.
//!
//! g'(x) = int_0^x (r f')' dr/sqrt(x^2 - r^2), and (r f')' = A + 2 C r in the segment between two knots. Segments are
//! gathered in cells of a binary tree. What lies further below a cell than the cell is wide (in the square of the
//! radius) is a Chebyshev series there, which its halves take over: far cells add to it as [`Multipole`]s, single
//! segments in closed form. The rest, a few segments for each of the smallest cells, is summed for every panel: each
//! gives A (asin) + 2 C (sqrt). With w = sqrt(x^2 - r^2) the angle between r1 and r2 is atan(T),
//! T = x^2 (r2^2 - r1^2)/((r2 w1 + r1 w2) (w1 w2 + r1 r2)), where nothing cancels.
//!
//! A panel gets as many places as its series needs: few where f'' hardly jumps about it.

use super::spline::SplineKnot;
use crate::cells::Cell;
use crate::cells::grid::{GROWTH, first_width};
use crate::cells::shape::Powers;
use crate::numerics::angle::angles;
use crate::numerics::chebyshev::{self, EIGHT, Points, SIXTEEN, TWELVE, TWENTY, TWENTY_FOUR};
use crate::numerics::cluster_tree::ClusterTree;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{EIGHT_POINTS, TWENTY_POINTS};
use crate::numerics::multipole::Multipole;
use crate::numerics::roots::turning;

/// Segments in the smallest cells.
const LEAF: usize = 4;
/// The least width of the last cell above a knot over the whole, in squares.
const LEAST_CELL: f64 = 0.05;

/// f' between two knots, f' = A + C r.
struct Segment {
    start: f64,
    end: f64,
    constant: f64,
    curvature: f64,
}

/// A stretch above a knot still without its series, by how far its inner end is beyond the knot and how wide it is, in
/// squares of radii, m^2.
#[derive(Clone, Copy)]
struct Stretch {
    knot: usize,
    base: f64,
    low: f64,
    width: f64,
}

/// The cells of a table.
#[derive(Default)]
pub(super) struct Built {
    /// From the first knot at which the surface leaves the plane, up to the last or, unless the whole curve is wanted,
    /// to where g falls.
    pub(super) cells: Vec<Cell>,
    /// The first radius at which g falls, if it does.
    pub(super) falls_at: Option<f64>,
    /// Whether the caller has ended it.
    pub(super) stopped: bool,
}

/// The panels through knots, while `keep_going` returns true, which is asked at every cell.
pub(super) fn cells(knots: &[SplineKnot], whole: bool, keep_going: &dyn Fn() -> bool) -> Built {
    let segment = |pair: &[SplineKnot]| {
        let curvature = (pair[1].slope - pair[0].slope) / (pair[1].radius - pair[0].radius);
        let constant = pair[0].slope - curvature * pair[0].radius;
        Segment { start: pair[0].radius, end: pair[1].radius, constant, curvature }
    };
    let segments: Vec<Segment> = knots.windows(2).map(segment).collect();
    let flat = segments.iter().take_while(|s| s.constant.abs() + s.curvature.abs() <= 0.0).count();
    let clusters = clusters(&segments, keep_going);
    let mut build = Build {
        segments: &segments,
        flat,
        clusters: &clusters,
        whole,
        keep_going,
        points: 24,
        built: Built { cells: Vec::with_capacity(segments.len()), ..Built::default() },
    };
    if let Some(root) = clusters.root() {
        build.visit(root, None, &[]);
    }
    build.built
}

/// The sources (r f')' dr of segments over X = -r^2, so that the radii of g lie below them.
fn clusters(segments: &[Segment], keep_going: &dyn Fn() -> bool) -> ClusterTree<Multipole> {
    ClusterTree::new(segments.len(), LEAF, |items, halves| {
        let (start, end) = (segments[items.start].start, segments[items.end - 1].end);
        let mut sources = Multipole::empty((-end * end).into(), (end - start) * (end + start));
        let width = end - start;
        match halves {
            Some(halves) => halves.into_iter().for_each(|half: &Multipole| sources.add(half, 1.0)),
            None if keep_going() => {
                for segment in &segments[items.clone()] {
                    // The polynomials of the cell are slow over a short part of it that is far from the axis.
                    if segment.end - segment.start <= 0.25 * width.min(segment.start) {
                        add_segment(&mut sources, segment, end, &EIGHT_POINTS);
                    } else {
                        add_segment(&mut sources, segment, end, &TWENTY_POINTS);
                    }
                }
            }
            None => {}
        }
        sources
    })
}

fn add_segment<const N: usize>(sources: &mut Multipole, segment: &Segment, end: f64, rule: &[(f64, f64); N]) {
    let width = segment.end - segment.start;
    let nodes = rule.map(|(u, share)| (segment.start + width * u, width * share));
    let above = nodes.map(|(r, _)| (end - r) * (end + r));
    let weights = nodes.map(|(r, weight)| weight * (segment.constant + 2.0 * segment.curvature * r));
    sources.add_sources(&above, &weights);
}

/// Several radii, the largest first, by how far their squares lie above that of a radius at or below them.
struct Places<const N: usize> {
    base: f64,
    above: [f64; N],
    squares: [f64; N],
    radii: [f64; N],
}

impl<const N: usize> Places<N> {
    fn new(base: f64, above: [f64; N]) -> Places<N> {
        let squares = above.map(|above| base * base + above);
        Places { base, above, squares, radii: squares.map(f64::sqrt) }
    }

    /// The roots w of how far their squares lie above that of r.
    fn roots(&self, r: f64) -> [f64; N] {
        let (below, mut roots) = ((self.base - r) * (self.base + r), self.above);
        for root in &mut roots {
            let above = below + *root;
            *root = if above > 0.0 { above.sqrt() } else { 0.0 };
        }
        roots
    }
}

impl Segment {
    /// Adds to g' at places beyond the segment, whose roots w of its start become those of its end.
    fn add<const N: usize>(&self, places: &Places<N>, roots: &mut [f64; N], sums: &mut [f64; N]) {
        let (start, end) = (self.start, self.end);
        let gap = (end - start) * (end + start);
        let outer = places.roots(end);
        let (mut tangents, mut drops) = ([0.0; N], [0.0; N]);
        for lane in 0..N {
            let (w1, w2) = (roots[lane], outer[lane]);
            tangents[lane] = places.squares[lane] * gap / ((end * w1 + start * w2) * (w1 * w2 + start * end));
            drops[lane] = gap / (w1 + w2);
        }
        *roots = outer;
        let (turns, _) = angles(tangents);
        for lane in 0..N {
            sums[lane] += self.constant * turns[lane] + 2.0 * self.curvature * drops[lane];
        }
    }

    /// Adds to g' what the segment adds that holds the places, whose roots w of its start are given: w/(r + x) is the
    /// tangent of half the angle.
    fn add_own<const N: usize>(&self, places: &Places<N>, roots: &[f64; N], sums: &mut [f64; N]) {
        let tangents: [f64; N] = std::array::from_fn(|lane| roots[lane] / (self.start + places.radii[lane]));
        let (halves, _) = angles(tangents);
        for lane in 0..N {
            sums[lane] += 2.0 * (self.constant * halves[lane] + self.curvature * roots[lane]);
        }
    }
}

/// Adds to g' at places beyond all of some adjoining segments; the roots w of where these end.
fn add_all<const N: usize>(segments: &[Segment], places: &Places<N>, start: f64, sums: &mut [f64; N]) -> [f64; N] {
    let mut roots = places.roots(start);
    segments.iter().for_each(|segment| segment.add(places, &mut roots, sums));
    roots
}

/// The part of g' in a cell by the sources far below it: a series over the squares of the radii.
struct CellField {
    low: f64,
    high: f64,
    series: Vec<f64>,
}

impl CellField {
    fn add<const N: usize>(&self, squares: &[f64; N], sums: &mut [f64; N]) {
        let (scale, mut places) = (1.0 / (self.high - self.low), *squares);
        for x in &mut places {
            *x = ((*x - self.low) - (self.high - *x)) * scale;
        }
        let values = chebyshev::values(&self.series, places);
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
    }
}

/// The sources of the panels of one of the smallest cells.
struct NearSources {
    far: CellField,
    /// The first of the near segments.
    first: usize,
}

struct Build<'a> {
    segments: &'a [Segment],
    /// The first segment that is not flat.
    flat: usize,
    clusters: &'a ClusterTree<Multipole>,
    whole: bool,
    keep_going: &'a dyn Fn() -> bool,
    /// How many places the next panel will likely need.
    points: usize,
    built: Built,
}

impl Build<'_> {
    /// Makes the panels of a cell, given what is far below a cell around it, and the cells nearer, from the centre
    /// outward.
    fn visit(&mut self, number: usize, around: Option<&CellField>, beside: &[usize]) {
        let cell = self.clusters.cluster(number);
        self.built.stopped |= !(self.keep_going)();
        if cell.items.end <= self.flat || self.is_complete() || self.built.stopped {
            return;
        }
        let (start, end) = (self.segments[cell.items.start].start, self.segments[cell.items.end - 1].end);
        let (low, high) = (start * start, end * end);
        let places = Places::new(start, TWENTY.places(0.0, (end - start) * (end + start)));
        let mut sums = [0.0; 20];
        if let Some(around) = around {
            around.add(&places.squares, &mut sums);
        }
        let (mut near, mut open): (Vec<usize>, Vec<usize>) = (Vec::new(), beside.iter().rev().copied().collect());
        let most = if cell.halves.is_none() { LEAF } else { cell.items.len() };
        while let Some(number) = open.pop() {
            let source = self.clusters.cluster(number);
            let beyond = low + source.sources.origin.value();
            let is_beyond = beyond >= high - low;
            if is_beyond && source.sources.is_far(-beyond) {
                add_far(&source.sources, &places.squares, &mut sums);
            } else if let Some([inner, outer]) = source.halves.filter(|_| is_beyond || source.items.len() > most) {
                open.extend([outer, inner]);
            } else if is_beyond {
                let segments = &self.segments[source.items.clone()];
                add_all(segments, &places, segments[0].start, &mut sums);
            } else {
                near.push(number);
            }
        }
        if let Some([inner, outer]) = cell.halves {
            let field = CellField { low, high, series: TWENTY.series(&sums) };
            self.visit(inner, Some(&field), &near);
            near.push(inner);
            self.visit(outer, Some(&field), &near);
            return;
        }
        let first = near.first().map_or(cell.items.start, |&first| self.clusters.cluster(first).items.start);
        let far = CellField { low, high, series: TWENTY.series(&sums) };
        let sources = NearSources { far, first: first.max(self.flat) };
        for knot in cell.items.start.max(self.flat)..cell.items.end {
            let Segment { start, end, .. } = self.segments[knot];
            self.add_stretches(knot, ((end - start) * (end + start)).sqrt(), &sources);
        }
    }

    /// Adds the cells above a knot up to the t `high`: one, or several where the knot below it is too near for one
    /// series.
    fn add_stretches(&mut self, knot: usize, high: f64, sources: &NearSources) {
        let base = self.segments[knot].start;
        let singular = if knot > self.flat {
            let next = self.segments[knot - 1].start;
            (base - next) * (base + next)
        } else if base > 0.0 {
            base * base
        } else {
            f64::INFINITY
        };
        let whole = high * high;
        let mut reached = first_width(whole, singular);
        self.add_cell(&Stretch { knot, base, low: 0.0, width: reached }, sources);
        while reached < whole {
            let next =
                if reached * (1.0 + GROWTH) < whole * (1.0 - LEAST_CELL) { reached * (1.0 + GROWTH) } else { whole };
            self.add_cell(&Stretch { knot, base, low: reached, width: next - reached }, sources);
            reached = next;
        }
    }

    /// Whether g falls where the panels end.
    fn is_complete(&self) -> bool {
        self.built.falls_at.is_some() && !self.whole
    }

    /// Adds the cell of a stretch, up to where g falls unless the whole curve is wanted.
    fn add_cell(&mut self, stretch: &Stretch, sources: &NearSources) {
        if self.is_complete() {
            return;
        }
        let mut cell = self.cell(stretch, sources);
        if let Some(zeta) = first_fall(&cell) {
            self.built.falls_at.get_or_insert(cell.radius_at(zeta));
            if !self.whole {
                if zeta <= 0.0 {
                    return;
                }
                cell = self.cell(&Stretch { width: zeta * zeta, ..*stretch }, sources);
            }
        }
        self.built.cells.push(cell);
    }

    fn cell(&mut self, stretch: &Stretch, sources: &NearSources) -> Cell {
        let series = loop {
            let (series, resolved) = match self.points {
                8 => self.series(stretch, sources, &EIGHT),
                12 => self.series(stretch, sources, &TWELVE),
                16 => self.series(stretch, sources, &SIXTEEN),
                _ => self.series(stretch, sources, &TWENTY_FOUR),
            };
            if resolved || self.points == 24 {
                break series;
            }
            self.points = if self.points < 16 { self.points + 4 } else { 24 };
        };
        // Room for one more term than this one had.
        self.points = [8, 12, 16].into_iter().find(|points| series.len() + 3 <= *points).unwrap_or(24);
        let square = DoubleDouble::square_of(stretch.base) + DoubleDouble::from(stretch.low);
        let (high, powers) = (stretch.width.sqrt(), if stretch.low > 0.0 { Powers::Odd } else { Powers::All(1) });
        let series: Vec<f64> = series.into_iter().map(|term| high * term).collect();
        Cell::new(stretch.base, square, high, &series, powers)
    }

    /// The series of q = g'/x over a stretch, by its values at N points, and whether they resolve it.
    fn series<const N: usize>(&self, stretch: &Stretch, sources: &NearSources, points: &Points<N>) -> (Vec<f64>, bool) {
        let above = if stretch.low > 0.0 {
            points.places(0.0, stretch.width).map(|above| stretch.low + above)
        } else {
            points.places(0.0, stretch.width.sqrt()).map(|t| t * t)
        };
        let places = Places::new(stretch.base, above);
        let mut sums = [0.0; N];
        sources.far.add(&places.squares, &mut sums);
        let (segments, own) = (&self.segments[sources.first..stretch.knot], &self.segments[stretch.knot]);
        let roots = add_all(segments, &places, self.segments[sources.first].start, &mut sums);
        own.add_own(&places, &roots, &mut sums);
        sums.iter_mut().zip(places.radii).for_each(|(sum, radius)| *sum /= radius);
        let series = points.series(&sums);
        let resolved = Points::<N>::resolve(&series);
        (series, resolved)
    }
}

/// Adds to g' what sources do at squares of radii that are far from them.
fn add_far(sources: &Multipole, squares: &[f64; 20], sums: &mut [f64; 20]) {
    for (sums, squares) in sums.chunks_exact_mut(4).zip(squares.chunks_exact(4)) {
        let places = [0, 1, 2, 3].map(|lane| -(squares[lane] + sources.origin.value()));
        sums.iter_mut().zip(sources.potentials(places)).for_each(|(sum, value)| *sum += value);
    }
}

/// The first zeta at which q is below zero by more than rounding could make it.
fn first_fall(cell: &Cell) -> Option<f64> {
    if cell.surely_rises() {
        return None;
    }
    let places = cell.slope_check_places();
    let values: Vec<f64> = places.iter().map(|&zeta| cell.slope_over_radius(zeta)).collect();
    let size = values.iter().fold(0.0f64, |size, value| size.max(value.abs()));
    let index = values.iter().position(|&value| value < -1e-12 * size)?;
    let Some(before) = index.checked_sub(1) else { return Some(0.0) };
    Some(turning([places[before], places[index]], |zeta| cell.slope_over_radius(zeta) < 0.0)[0])
}
