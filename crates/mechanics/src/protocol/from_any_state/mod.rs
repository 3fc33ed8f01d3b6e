//! The best strokes from any state: alternating extrema outside a cut, the stress of the slip history inside it.
//!
//! The first stroke slips down to a cut, and the strokes after it to kinks ever nearer to the edge. For a largest
//! stress E the kinks follow from the edge inwards as in `minimax`; they do not depend on the history inside the cut.
//! The cut is then where the whole inside stays lowest, or, where the end is prescribed, the one that leads there. E is
//! lowered until the inside would be above it.
//!
//! Inside a cut the history may be such that other sequences leave less: few strokes are also searched (`search`).
//!
//! At a vertical edge the stress stays finite only if nothing is carried there. The kinks then lie inside the edge, and
//! a last stroke, during which nothing slips but the edge itself, unloads it.

mod descent;
mod linear_program;
mod search;

use super::minimax::{Problem, smallest};
use super::{PathEnd, alternating, cutoff_of, outermost_singular, positions};
use crate::contact::Contact;
use crate::contact::normal::load;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::{largest_of, turning};
use crate::profile::{Point, Ring, StressRadius};
use crate::slip_history::Line;

/// A slip history of more pieces is refused, because each piece is evaluated for every E; nor is it a candidate as it
/// is, because the cost of its extrema grows with the square of the depth.
pub(super) const MAX_DEPTH: usize = 256;
/// Number of sampled radii besides the kinks of the history, and of cuts that are tried.
const GRID: usize = 64;
const CUTS: usize = 16;
/// Up to this many strokes all sequences are searched; from more the search would take longer than it gains.
const SEARCHED: usize = 6;
/// The part of the stretch about the best of these to which a cut is narrowed down.
const BRACKET: f64 = 1e-6;
/// The factor by which E is changed until it is bracketed.
const PACE: f64 = 1.06;
/// Relative tolerance of E.
const TOLERANCE: f64 = 1e-8;

/// Strokes from the state of a contact.
pub(super) struct FromAnyState<'a> {
    problem: Problem<'a>,
    /// The level of the edge, and of what a last stroke takes off a vertical one: its height, else zero.
    edge: DoubleDouble,
    rim: f64,
    /// The history from the centre outward.
    history: Vec<(Ring, Line)>,
    /// The sampled radii, from the centre outward.
    samples: Vec<SampleRadius>,
    reference: DoubleDouble,
    /// The direction of the last stroke that slips inside, and of the first.
    last: f64,
    first: f64,
    end: PathEnd,
}

/// A sequence of strokes, scaled by m, for a last stroke forwards.
struct LaterStrokes {
    kinks: Vec<Point>,
    cut: Point,
    /// Where the first stroke leads to.
    first: f64,
}

impl<'a> FromAnyState<'a> {
    /// At most `strokes` strokes, the last one of which goes in the direction `last`; `None` where they are too few,
    /// where the history is too deep, or the annulus beyond the cut-off as thin as the rounding of its radius.
    pub(super) fn new(
        contact: &'a Contact,
        strokes: usize,
        last: f64,
        end: PathEnd,
        keep_going: &'a dyn Fn() -> bool,
    ) -> Option<FromAnyState<'a>> {
        let (profile, history) = (&*contact.indenter, &contact.history);
        let edge = *history.edge();
        if history.pieces().len() > MAX_DEPTH {
            return None;
        }
        let rings: Vec<_> = history.rings().rev().map(|(ring, line)| (ring, *line)).collect();
        let rim = profile.rim_radius().filter(|rim| edge.radius >= *rim).map(|rim| profile.level(rim));
        let outer = rim.map_or(edge, |level| profile.point(DoubleDouble::from(level)));
        let inner_strokes = strokes.checked_sub(usize::from(rim.is_some()))?;
        if inner_strokes == 0 || outer.level.value() <= 0.0 {
            return None;
        }
        let cutoff = cutoff_of(outermost_singular(profile, outer.radius), outer.radius);
        if cutoff >= outer.radius {
            return None;
        }
        let problem = Problem { indenter: profile, edge: outer, cutoff, reversals: inner_strokes - 1, keep_going };
        let last = if rim.is_some() { -last } else { last };
        let first = if inner_strokes.is_multiple_of(2) { -1.0 } else { 1.0 };
        let height = rim.map_or(0.0, |level| (edge.level - DoubleDouble::from(level)).value());
        let reference = history.position() - history.shift();
        let samples = samples(&problem, &rings, last);
        Some(FromAnyState {
            problem,
            edge: edge.level,
            rim: height,
            history: rings,
            samples,
            reference,
            last,
            first,
            end,
        })
    }

    /// w - W of the history at a level, for a last stroke forwards.
    fn relative_displacement(&self, level: DoubleDouble) -> f64 {
        let line = self.history.iter().rfind(|(ring, _)| ring.inner.level <= level).map(|(_, line)| line);
        self.last * line.map_or(DoubleDouble::ZERO, |line| line.at(level) - self.reference).value()
    }

    /// Where the first stroke must lead to so that it slips down to a level.
    fn first_to(&self, level: DoubleDouble) -> f64 {
        self.first * (self.edge - level).value() - self.relative_displacement(level)
    }

    /// int w dx at the end, m^2, for a cut at a point.
    fn carried(&self, kinks: &[Point], cut: &Point) -> f64 {
        let load = |ring: &Ring| load(self.problem.indenter, ring);
        let inside = self.inside(cut);
        let whole = self.history[..inside.whole].iter().map(|(ring, line)| (*ring, self.stress_weight(line)));
        let kept: f64 = whole.chain(inside.part).map(|(ring, slope)| slope * load(&ring)).sum();
        self.problem.sum_down_to(*cut, kinks, load) + kept
    }

    /// The stress of a piece of the history over its kernel, for a last stroke forwards.
    fn stress_weight(&self, line: &Line) -> f64 {
        -self.last * line.slope.value()
    }

    /// The history inside a cut.
    fn inside(&self, cut: &Point) -> Inside {
        let whole = self.history.partition_point(|(ring, _)| ring.inner.level < cut.level).saturating_sub(1);
        let part = self.history.get(whole).filter(|(ring, _)| ring.inner.level < cut.level);
        Inside { whole, part: part.map(|(ring, line)| (Ring::between(ring.inner, *cut), self.stress_weight(line))) }
    }

    /// The residual of the end with a cut at a level, in the direction of the first stroke: it falls as the cut goes
    /// outwards.
    fn miss(&self, kinks: &[Point], level: DoubleDouble) -> f64 {
        let value = match self.end {
            PathEnd::Free => 0.0,
            PathEnd::DisplacementZero => self.first_to(level) + self.problem.way(self.edge, kinks) - self.rim,
            PathEnd::ForceZero => self.carried(kinks, &self.problem.indenter.point(level)),
        };
        self.first * value
    }

    /// The largest stress inside the last kink, for a cut; `outside` is that of the rings beyond the kink, sample by
    /// sample.
    fn worst(&self, outside: &[f64], kinks: &[Point], cut: &Point) -> f64 {
        let ring = Ring::between(*cut, *kinks.last().unwrap_or(&self.problem.edge));
        let profile = self.problem.indenter;
        let inside = self.inside(cut);
        let mut worst = 0.0_f64;
        for (sample, outside) in self.samples.iter().zip(outside) {
            let stress = outside + alternating(kinks.len(), profile.kernel(&sample.at, &ring));
            worst = worst.max((stress + inside.stress(profile, sample)).abs());
        }
        if cut.radius > self.problem.cutoff {
            let at = StressRadius::of_point(cut);
            worst = worst.max(self.problem.shear_down_to(*cut, kinks, &at).abs());
        }
        worst
    }

    /// The strokes of a largest stress E, if there are any, and by how much they exceed it, over it; `None` if
    /// `keep_going` returned false.
    fn strokes(&self, limit: f64) -> Option<(f64, Option<LaterStrokes>)> {
        let marched = self.problem.march(limit, 1.0)?;
        if marched.excess.is_none() {
            return Some((-1.0, None));
        }
        let inside = self.samples.iter().take_while(|sample| sample.at.radius < marched.last().radius);
        let outside: Vec<f64> = inside.map(|sample| marched.beyond.at(&sample.at)).collect();
        let kinks = marched.kinks;
        let found = if self.end == PathEnd::Free {
            let cut = self.free_cut(&outside, &kinks);
            Some((cut, self.first_to(cut.level)))
        } else {
            self.prescribed_cut(&kinks)
        };
        let Some((cut, first)) = found else { return Some((1.0, None)) };
        let excess = self.worst(&outside, &kinks, &cut) / limit - 1.0;
        Some((excess, Some(LaterStrokes { kinks, cut, first })))
    }

    /// The cut that leaves least inside the last kink.
    fn free_cut(&self, outside: &[f64], kinks: &[Point]) -> Point {
        let profile = self.problem.indenter;
        let outermost = kinks.last().unwrap_or(&self.problem.edge);
        let cut = |radius: f64| profile.point(DoubleDouble::from(profile.level(radius).min(outermost.level.value())));
        let relief = |radius: f64| -self.worst(outside, kinks, &cut(radius));
        // Between the kinks of the history, each of which may be as near to the last as it likes, the stress is smooth.
        let bends = self.history.iter().map(|(ring, _)| ring.outer.radius).filter(|bend| *bend < outermost.radius);
        let bends: Vec<f64> = [0.0].into_iter().chain(bends).chain([outermost.radius]).collect();
        let parts = (CUTS / (bends.len() - 1)).max(2);
        let between = |pair: &[f64]| {
            let (low, width) = (pair[0], pair[1] - pair[0]);
            (0..parts).map(move |index| low + width * index as f64 / parts as f64)
        };
        let tried: Vec<f64> = bends.windows(2).flat_map(between).chain([outermost.radius]).collect();
        cut(largest_of(&tried, 1, BRACKET, relief).0)
    }

    /// The cut that leads to the prescribed end, and where the first stroke leads to; `None` if no cut does.
    fn prescribed_cut(&self, kinks: &[Point]) -> Option<(Point, f64)> {
        let outermost = kinks.last().unwrap_or(&self.problem.edge).level;
        let miss = |level: f64| self.miss(kinks, DoubleDouble::from(level));
        if self.miss(kinks, outermost) > 0.0 {
            return None;
        }
        let over = miss(0.0);
        if over < 0.0 {
            // Sliding on as a whole changes nothing but where it ends.
            let (low, slides) = (DoubleDouble::ZERO, self.end == PathEnd::DisplacementZero);
            return slides.then(|| (self.problem.indenter.point(low), self.first_to(low) - self.first * over));
        }
        let [_, level] = turning([0.0, outermost.value()], |level| miss(level) <= 0.0);
        let level = DoubleDouble::from(level);
        Some((self.problem.indenter.point(level), self.first_to(level)))
    }

    /// The displacements, scaled by m, of the strokes that leave least, found in two ways; fewer where a way finds
    /// none, or `keep_going` returned false.
    pub(super) fn solve(&self) -> Vec<Vec<f64>> {
        let marched = self.equal();
        let searched = if self.problem.reversals < SEARCHED { self.searched(marched.as_ref()) } else { Vec::new() };
        marched.iter().chain(&searched).map(|strokes| self.positions(strokes)).collect()
    }

    /// The strokes of the smallest E; `None` if there are none, or `keep_going` returned false.
    fn equal(&self) -> Option<LaterStrokes> {
        let problem = &self.problem;
        let middle = StressRadius::new(0.5 * (problem.cutoff + problem.edge.radius));
        let zero = problem.indenter.point(DoubleDouble::ZERO);
        let guess = problem.shear_down_to(zero, &[], &middle) / (problem.reversals as f64 + 1.0).sqrt();
        Some(smallest(guess, TOLERANCE, Some(PACE), |limit| self.strokes(limit))?.1)
    }

    fn positions(&self, strokes: &LaterStrokes) -> Vec<f64> {
        let mut positions = positions(strokes.first, self.edge, &strokes.kinks);
        if self.rim > 0.0 {
            positions.extend(positions.last().map(|here| here - self.rim));
        }
        positions.into_iter().map(|position| self.last * position).collect()
    }
}

/// The history inside a cut: its rings that are whole, and the one that the cut divides, with the stress of that over
/// its kernel.
struct Inside {
    whole: usize,
    part: Option<(Ring, f64)>,
}

impl Inside {
    /// The stress of the history at a sample, over G* m/pi.
    fn stress(&self, profile: &Indenter, sample: &SampleRadius) -> f64 {
        let part = self.part.as_ref().map_or(0.0, |(ring, slope)| slope * profile.kernel(&sample.at, ring));
        sample.below[self.whole] + part
    }
}

/// A sampled radius inside the last kink.
struct SampleRadius {
    at: StressRadius,
    /// The stress there of the first rings of the history, from the centre outward, over G* m/pi.
    below: Vec<f64>,
}

/// Even radii, and the kinks of the history.
fn samples(problem: &Problem<'_>, history: &[(Ring, Line)], last: f64) -> Vec<SampleRadius> {
    let (least, most) = (problem.cutoff, problem.edge.radius);
    let even = (0..GRID).map(|index| StressRadius::new(least + (most - least) * index as f64 / GRID as f64));
    let bends = history.iter().map(|(ring, _)| ring.inner).filter(|bend| bend.radius > least && bend.radius < most);
    let mut all: Vec<StressRadius> = even.chain(bends.map(|bend| StressRadius::of_point(&bend))).collect();
    all.sort_by(|a, b| a.radius.total_cmp(&b.radius));
    let sample = |at: StressRadius| {
        let mut below = Vec::with_capacity(history.len() + 1);
        let mut sum = 0.0;
        for (ring, line) in history {
            below.push(sum);
            let slope = -last * line.slope.value();
            if slope.abs() > 0.0 && ring.outer.radius > at.radius {
                sum += slope * problem.indenter.kernel(&at, ring);
            }
        }
        below.push(sum);
        SampleRadius { at, below }
    };
    all.into_iter().map(sample).collect()
}
