//! The kernels of adjoining rings, weighted and summed, at many radii, where g'/x is a power series between any two of
//! its kinks.
//!
//! With v = sqrt(x^2 - r^2) a kernel is int q dv, q = g'/x. The rings are cut at the kinks b of g, and so that no piece
//! of x^2 is wider than half its distance from the singularity beneath it. Over a piece X - h..X + h let q = sum of c_k
//! Y^k, x^2 = X + h Y; it is of one of three forms for a radius:
//!
//! - Near: with s = (r^2 - X)/h and I_k = int Y^k dv it holds that (2k + 1) I_k = [Y^k v] + 2 k s I_(k-1), so that the
//!   antiderivative is v A(Y), and by the even and the odd part of A the kernel is (v_1 - v_0) E + (v_1 + v_0) O: what
//!   a thin ring has is not lost. |c_k| falls as the k-th power of h over the distance of X from the singularity, a
//!   fifth at most, and |s| is three at most: no term is large.
//! - Far, where the inner end is at least as far beyond r^2 as the piece is wide: a [`Multipole`]. What lies beyond a
//!   singularity is far from all that is inside it.
//! - At a kink, which q begins at as a power of t = sqrt(x^2 - b^2): with gamma = t q = sum of g_k t^k and kappa = r^2
//!   - b^2 it is the integral of [`root_kernel`](crate::numerics::root_kernel). t ends at a quarter of its distance
//!     from the next singularity there, and what is inside that is far.
//!
//! A vertical edge adds the levels that rings cross there, over the root of its distance.
//!
//! Series end where their terms no longer count. A piece whose series does not is halved as long as that brings it
//! nearer to its end: what is left then is the rounding of q itself.

mod far;
mod kernels;
mod sampled_series;

use std::ops::Range;

use super::shape::{KernelOrder, Shape, ShapeFacts, kink_under, span};
use super::{DoubleDouble, Ring, Span, StressRadius};
#[cfg(test)]
use crate::cells::call_count;
use crate::numerics::chebyshev::counted;
use crate::numerics::multipole::Multipole;
use crate::numerics::root_kernel::KernelPair;
use sampled_series::{TERMS, beside_kink, of_slope_over_radius};

/// Radii that are summed for side by side.
const LANES: usize = 4;
/// A piece is far from radii whose squares are this many times its width below it.
const ROOM: f64 = 1.0;
/// A piece is no wider than this share of its distance from a singularity.
const WIDEST: f64 = 0.5;
/// The part of the distance to the next singularity, in squares, up to which the series in t of a kink is taken.
const KINK: f64 = 1.0 / 16.0;
/// What halving a piece takes off the last term of its series at the least, unless that is rounding.
const NEARER: f64 = 0.1;
/// Terms whose size is below this share of the largest do not count.
const NEGLIGIBLE: f64 = 1e-17;
/// The smallest radius, over that of the edge, that pieces reach down to at a tip where q is not smooth.
const INNERMOST: f64 = 1e-3;
/// The pieces reach down to this share of the smallest radius, whose square has digits that it has lost itself.
const CLEAR: f64 = 0.9;
/// How near to a tip that is not smooth the pieces for one radius reach, over the outer radius.
const TIP: f64 = 1e-12;
/// With more pieces than this within a ring, others are quicker.
const MOST_CUTS: f64 = 48.0;
/// How near to where g ceases to be analytic an edge may be, in squares over its own.
const CLOSEST: f64 = 1e-2;
/// Squares of radii that differ by less, over that of the outer one, have lost digits that the depth of their ring has.
const THIN: f64 = 1e-3;

/// The pieces of a profile's rings, from the edge inward.
pub(super) struct SmoothPieces<'a, S> {
    shape: &'a S,
    pieces: Vec<SmoothPiece>,
    /// The coefficients of all of them.
    terms: Vec<f64>,
    /// The radius, m, that the pieces reach down to, and what is left of rings inside it, with their weights.
    innermost: f64,
    tip: Vec<(Span, f64)>,
    /// The vertical edge of the rings, if they have one.
    rim: Option<Rim>,
    /// 1/a^2, m^-2: lengths are in units of the edge.
    unit: f64,
    /// With more pieces than this within a ring, there is none.
    most_cuts: f64,
    /// Nor where the edge is nearer than this to the ceiling, in squares over its own.
    closest: f64,
}

/// A vertical edge: the square of its radius, m^2, in two parts; the weighted levels that rings cross there, and the
/// sum of their sizes, in units of the edge.
#[derive(Clone, Copy)]
struct Rim {
    square: (f64, f64),
    levels: f64,
    size: f64,
}

struct SmoothPiece {
    /// The squares of the radii of its ends, m^2, in two parts each.
    inner: (f64, f64),
    outer: (f64, f64),
    /// Their difference, in units of the edge.
    gap: f64,
    /// Whether that has digits that the squares have lost.
    thin: bool,
    weight: f64,
    near: Near,
    far: Multipole,
}

/// A piece to be: the kink beneath it, m, the squares of its ends and of its middle, m^2, and half their difference.
struct PieceEnds {
    base: f64,
    inner: DoubleDouble,
    outer: DoubleDouble,
    middle: DoubleDouble,
    half: f64,
}

/// What serves near radii, among the coefficients.
enum Near {
    /// c_k.
    Smooth(Range<usize>),
    /// g_k times the k-th power of the t where the piece ends.
    Kink(Range<usize>),
}

/// Weighted sums of kernels, of their derivatives, and of the sizes of these.
struct PieceSums<const N: usize> {
    kernels: [f64; N],
    slopes: [f64; N],
    sizes: [f64; N],
}

impl<'a, S: Shape> SmoothPieces<'a, S> {
    /// The pieces of rings and their weights best for radii of at least `least`, m; `None` if the profile has no such
    /// series.
    pub(super) fn new(shape: &'a S, rings: &[(Ring, f64)], least: f64) -> Option<SmoothPieces<'a, S>> {
        let mut made = SmoothPieces::within(shape, rings.last()?.0.outer.radius, least, rings.len());
        rings.iter().rev().try_for_each(|(ring, weight)| made.add(&span(shape, ring), *weight))?;
        Some(made)
    }

    /// No pieces yet, for so many rings inside an edge at a radius, m.
    pub(super) fn within(shape: &'a S, edge: f64, least: f64, rings: usize) -> SmoothPieces<'a, S> {
        let innermost = if shape.facts().smooth_tip { 0.0 } else { (CLEAR * least).max(INNERMOST * edge) };
        let (pieces, terms) = (Vec::with_capacity(2 * rings), Vec::with_capacity(2 * TERMS * rings));
        SmoothPieces {
            shape,
            pieces,
            terms,
            innermost,
            tip: Vec::new(),
            rim: None,
            unit: 1.0 / (edge * edge),
            most_cuts: MOST_CUTS,
            closest: CLOSEST,
        }
    }

    /// The pieces of a span, however many they are, for one radius. At a tip that is not smooth they end at
    /// [`TIP`] of the outer radius.
    pub(super) fn of_span(shape: &'a S, span: &Span, radius: f64) -> Option<SmoothPieces<'a, S>> {
        let mut made = SmoothPieces::within(shape, span.outer_radius, radius, 1);
        (made.most_cuts, made.closest) = (f64::INFINITY, f64::EPSILON);
        if made.innermost > 0.0 {
            made.innermost = (CLEAR * radius).max(TIP * span.outer_radius);
        }
        made.add(&Span { edge: 0.0, ..*span }, 1.0)?;
        made.tip.clear();
        Some(made)
    }

    /// Adds the pieces of a ring by its span, from its outer end inward.
    pub(super) fn add(&mut self, ring: &Span, weight: f64) -> Option<()> {
        let shape = self.shape;
        let ShapeFacts { by_series, smooth_tip, ceiling, .. } = shape.facts();
        if !by_series {
            return None;
        }
        if ring.edge > 0.0 {
            let levels = ring.edge * self.unit.sqrt() * weight;
            let rim = self.rim.get_or_insert(Rim { square: ring.outer.parts(), levels: 0.0, size: 0.0 });
            (rim.levels, rim.size) = (rim.levels + levels, rim.size + levels.abs());
        }
        let thin = (ring.outer - ring.inner).value() <= THIN * ring.outer.value();
        let (mut outer, mut radius) = (ring.outer, ring.outer_radius);
        let floor = larger(ring.inner, DoubleDouble::square_of(self.innermost));
        // Beside the ceiling a radius has lost the digits that g depends on.
        if (ceiling - radius) * (ceiling + radius) < self.closest * outer.value() {
            return None;
        }
        while outer > floor {
            let kink = kink_under(shape, outer, radius);
            let base = DoubleDouble::square_of(kink);
            let room = (ceiling - radius) * (ceiling + radius);
            let low = larger(floor, base);
            // No wider than its distance from where g ceases to be analytic allows, either.
            let least = outer - DoubleDouble::from(WIDEST * room.min(outer.value()));
            let low = if WIDEST * room < (outer - low).value() { least } else { low };
            let gap = if thin && low == ring.inner && outer == ring.outer { ring.gap } else { (outer - low).value() };
            let above = (low - base).value();
            if kink > 0.0 && above <= 0.0 {
                let next = DoubleDouble::square_of(shape.kink_below(kink));
                let reach = KINK * (base - next).value().min((ceiling - kink) * (ceiling + kink));
                let top = if gap <= reach { gap } else { reach };
                let from = if gap <= reach { outer } else { base + DoubleDouble::from(reach) };
                if gap > reach {
                    self.smooth(kink, (from, outer), (gap - reach, false), [reach, room], weight)?;
                }
                let series = beside_kink(shape, kink, top.sqrt());
                let series = counted(&series, NEGLIGIBLE);
                let near = (Near::Kink(self.keep(series, 1.0)), far::of_kink(series, top * self.unit));
                self.push((base, from), (top, thin && gap <= reach), weight, near);
            } else {
                let above = if kink > 0.0 || !smooth_tip { above } else { f64::INFINITY };
                self.smooth(kink, (low, outer), (gap, thin), [above, room], weight)?;
            }
            (outer, radius) = (low, if low == base { kink } else { low.value().sqrt() });
        }
        if outer > ring.inner {
            self.tip.extend(ring.below(outer, outer.value().sqrt()).map(|span| (span, weight)));
        }
        Some(())
    }

    /// Adds pieces above the kink `base` between two squares that differ by `gap`: the inner one is `above` a
    /// singularity, and there is `room` beyond the outer one.
    fn smooth(
        &mut self,
        base: f64,
        (low, high): (DoubleDouble, DoubleDouble),
        (gap, thin): (f64, bool),
        [above, room]: [f64; 2],
        weight: f64,
    ) -> Option<()> {
        let growth = gap / above;
        let steps = if growth <= WIDEST { 0.0 } else { growth.ln_1p() };
        let cuts = (steps / WIDEST.ln_1p()).ceil().max(1.0);
        if !growth.is_finite() || cuts > self.most_cuts {
            return None;
        }
        let step = steps / cuts;
        let mut outer = high;
        for index in (0..cuts as u32).rev() {
            let last = index == 0;
            let inner = if last { low } else { low + DoubleDouble::from(above * (step * f64::from(index)).exp_m1()) };
            let gap = if cuts > 1.0 { (outer - inner).value() } else { gap };
            let half = 0.5 * gap;
            let below = if above < f64::INFINITY { above + (inner - low).value() } else { above };
            // Without a singularity nearby the fewest points are enough.
            let ratio = (half / (half + below)).max(half / (half + room));
            let middle = outer - DoubleDouble::from(half);
            let ends = PieceEnds { base, inner, outer, middle, half };
            self.resolve(&ends, (gap, thin && cuts <= 1.0), weight, ratio, f64::INFINITY);
            outer = inner;
        }
        Some(())
    }

    /// Adds a piece, or its halves where its series does not end and those of halves come nearer to it: what rounding
    /// has left in the last term of the piece `before`, over the largest one, halves have too.
    fn resolve(&mut self, ends: &PieceEnds, gap: (f64, bool), weight: f64, ratio: f64, before: f64) {
        let PieceEnds { base, inner, outer, middle, half } = *ends;
        let series = of_slope_over_radius(self.shape, base, (middle, half), ratio);
        if !series.ends() && series.last < NEARER * before {
            let half = 0.5 * half;
            for (inner, outer) in [(middle, outer), (inner, middle)] {
                let ends = PieceEnds { base, inner, outer, middle: outer - DoubleDouble::from(half), half };
                self.resolve(&ends, (2.0 * half, false), weight, ratio, series.last);
            }
            return;
        }
        let (series, edge) = (counted(&series.coefficients, NEGLIGIBLE), self.unit.sqrt().recip());
        let range = self.keep(series, edge);
        let far = far::of_smooth(&self.terms[range.clone()], gap.0 * self.unit);
        self.push((inner, outer), gap, weight, (Near::Smooth(range), far));
    }

    /// Keeps coefficients, each times `unit`.
    fn keep(&mut self, series: &[f64], unit: f64) -> Range<usize> {
        let start = self.terms.len();
        self.terms.extend(series.iter().map(|c| unit * c));
        start..self.terms.len()
    }

    fn push(
        &mut self,
        (inner, outer): (DoubleDouble, DoubleDouble),
        (gap, thin): (f64, bool),
        weight: f64,
        (near, far): (Near, Multipole),
    ) {
        let (inner, outer, gap) = (inner.parts(), outer.parts(), gap * self.unit);
        self.pieces.push(SmoothPiece { inner, outer, gap, thin, weight, near, far });
    }

    /// The sums at each radius.
    pub(super) fn sums(&self, radii: &[StressRadius]) -> Vec<f64> {
        let mut sums = vec![0.0; radii.len()];
        for chunk in StressRadius::rising(radii).chunks(LANES) {
            let found = self.lanes::<LANES, false>(&filled(chunk, |&index| radii[index].square));
            for (&index, kernel) in chunk.iter().zip(found.kernels) {
                sums[index] = kernel + self.in_tip(&radii[index], KernelOrder::Value);
            }
        }
        sums
    }

    /// The sum at one radius.
    pub(super) fn sum(&self, at: &StressRadius) -> f64 {
        let [kernel] = self.lanes::<1, false>(&[at.square]).kernels;
        kernel + self.in_tip(at, KernelOrder::Value)
    }

    /// Adds what the pieces are from afar to sources over squares, m^2.
    pub(super) fn add_sources(&self, sources: &mut Multipole) {
        let edge = self.unit.sqrt().recip();
        for SmoothPiece { inner: (low, _), gap, weight, far, .. } in &self.pieces {
            sources.add_part((*low, low + gap / self.unit), &far.moments, weight * edge);
        }
    }

    /// What lies inside all pieces, for radii there.
    fn in_tip(&self, at: &StressRadius, order: KernelOrder) -> f64 {
        let tip = self.tip.iter().filter(|(_, weight)| at.radius < self.innermost && weight.abs() > 0.0);
        tip.map(|(span, weight)| weight * self.shape.kernel(order, at, span)).sum()
    }

    /// The derivatives of the sum with respect to r^2, 1/m^2, each with the sum of the sizes of what it adds up from.
    /// `goes_on` is called with the number of pieces that follow; once it is false, derivatives are zero.
    pub(super) fn slopes(&self, radii: &[StressRadius], goes_on: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
        let mut found = Vec::with_capacity(radii.len());
        for chunk in radii.chunks(LANES) {
            if !goes_on(self.pieces.len()) {
                found.resize(found.len() + chunk.len(), (0.0, 0.0));
            } else if let [at] = chunk {
                found.push(self.with_tip(at, 0, &self.lanes::<1, true>(&[at.square])));
            } else {
                let sums = self.lanes::<LANES, true>(&filled(chunk, |at| at.square));
                found.extend(chunk.iter().enumerate().map(|(lane, at)| self.with_tip(at, lane, &sums)));
            }
        }
        found
    }

    /// The derivative in a lane and the sum of its sizes, 1/m^2, with those of the tip.
    fn with_tip<const N: usize>(&self, at: &StressRadius, lane: usize, sums: &PieceSums<N>) -> (f64, f64) {
        let tip = self.in_tip(at, KernelOrder::Slope);
        (sums.slopes[lane] * self.unit + tip, sums.sizes[lane] * self.unit + tip.abs())
    }

    fn lanes<const N: usize, const SLOPES: bool>(&self, squares: &[DoubleDouble; N]) -> PieceSums<N> {
        let (square, rest) = (squares.map(|square| square.parts().0), squares.map(|square| square.parts().1));
        let least = square.iter().copied().fold(f64::INFINITY, f64::min);
        // Squares that nearly agree cancel without a loss, and the rest is what rounding them has lost.
        let excess = |end: (f64, f64)| -> [f64; N] {
            std::array::from_fn(|lane| ((end.0 - square[lane]) + (end.1 - rest[lane])) * self.unit)
        };
        let mut sums = PieceSums { kernels: [0.0; N], slopes: [0.0; N], sizes: [0.0; N] };
        for piece in &self.pieces {
            if piece.outer.0 < least {
                break;
            }
            if piece.weight.abs() <= 0.0 {
                continue;
            }
            #[cfg(test)]
            call_count::add(|calls| if SLOPES { &mut calls.kernel_slope } else { &mut calls.kernel });
            let below = excess(piece.inner);
            let distant = below.map(|below| below > 0.0 && below >= ROOM * piece.gap);
            let far = || piece.far_kernels::<N, SLOPES>(&below);
            let near = || {
                let above = piece.above(&below, excess);
                let terms = |range: &Range<usize>| &self.terms[range.clone()];
                match &piece.near {
                    Near::Smooth(series) => kernels::smooth::<N, SLOPES>(terms(series), piece.gap, &below, &above),
                    Near::Kink(series) => kernels::kink::<N, SLOPES>(terms(series), piece.gap, &below, &above),
                }
            };
            let (kernel, slope) = if distant.iter().all(|&distant| distant) {
                far()
            } else if distant.iter().any(|&distant| distant) {
                let (near, far) = (near(), far());
                let pick = |near: [f64; N], far: [f64; N]| {
                    std::array::from_fn(|lane| if distant[lane] { far[lane] } else { near[lane] })
                };
                (pick(near.0, far.0), pick(near.1, far.1))
            } else {
                near()
            };
            for lane in 0..N {
                sums.kernels[lane] += piece.weight * kernel[lane];
                if SLOPES {
                    let slope = piece.weight * slope[lane];
                    sums.slopes[lane] += slope;
                    sums.sizes[lane] += slope.abs();
                }
            }
        }
        if let Some(Rim { square, levels, size }) = self.rim.filter(|rim| rim.size > 0.0) {
            for (lane, beyond) in excess(square).into_iter().enumerate().filter(|(_, beyond)| *beyond >= 0.0) {
                let root = beyond.sqrt();
                sums.kernels[lane] += levels / root;
                sums.slopes[lane] += 0.5 * levels / (beyond * root);
                sums.sizes[lane] += 0.5 * size / (beyond * root);
            }
        }
        sums
    }
}

impl SmoothPiece {
    /// Its kernel at radii that it is far from, or the derivative.
    fn far_kernels<const N: usize, const SLOPES: bool>(&self, below: &[f64; N]) -> KernelPair<N> {
        let places = below.map(|below| -below);
        if SLOPES { ([0.0; N], self.far.potential_slopes(places)) } else { (self.far.potentials(places), [0.0; N]) }
    }

    /// x^2 - r^2 at the outer end, zero where that is inside r.
    fn above<const N: usize>(&self, below: &[f64; N], excess: impl Fn((f64, f64)) -> [f64; N]) -> [f64; N] {
        let plain = excess(self.outer);
        std::array::from_fn(|lane| {
            let above = if self.thin && below[lane] > -0.5 * self.gap { below[lane] + self.gap } else { plain[lane] };
            if above > 0.0 { above } else { 0.0 }
        })
    }
}

/// The squares of a chunk, of which lanes left over repeat the first.
fn filled<T>(chunk: &[T], square: impl Fn(&T) -> DoubleDouble) -> [DoubleDouble; LANES] {
    std::array::from_fn(|lane| square(chunk.get(lane).unwrap_or(&chunk[0])))
}

fn larger(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests;
