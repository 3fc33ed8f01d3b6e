//! The history in a fixed number of doubles, for programs that keep so many for each contact.
//!
//! Over the level y the displacement w is straight between turning points and zero at the edge, so that the levels of
//! the turning points and the slopes beyond them are all of it. Where there are more of them than fit, the smallest
//! loops are cut off one by one: of all turning points the one goes whose loss changes the force least, and w becomes
//! straight between its neighbours. Three things hold whatever is left out:
//!
//! - |w| <= d - y, because the bound is straight, too, and so |F| <= mu F_N;
//! - the slopes remain from -1 to 1, as those of any path;
//! - the elastic energy does not rise: where the chord would raise it, w is scaled down to the energy before. All work
//!   is elastic energy or dissipated, so no closed cycle, under whatever load, yields work.

use super::piece::rise;
use super::{Line, Piece, Point, SlipHistory, Sums};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Moments, Ring};
use crate::slip_history::limit::Limit;

/// The turning points that are left: the slope at the centre, and of each its level, m, with the slope beyond.
pub(in super::super) struct Bounded {
    pub(in super::super) core_slope: f64,
    pub(in super::super) turning_points: Vec<[f64; 2]>,
    /// What of int w^2 dx / 2 was lost, m^3, if any were left out.
    pub(in super::super) lost: Option<f64>,
}

/// A straight part of w over y, up to the next one or to the edge.
#[derive(Clone, Copy)]
struct Stretch {
    level: f64,
    /// To its outer end, m.
    depth: f64,
    /// w at its inner end, m.
    value: f64,
    slope: f64,
    /// Over its ring; with the flat end of the profile if it begins at the centre.
    moments: Moments,
}

impl Stretch {
    /// int w dx and int w^2 dx / 2, where w has this value at the outer end.
    fn sums(&self, end: f64) -> [f64; 2] {
        let (Moments { width, first, second }, slope) = (self.moments, self.slope);
        let squares = end * end * width - 2.0 * end * slope * first + slope * slope * second;
        [end * width - slope * first, 0.5 * squares]
    }

    /// The chord over this and the next stretch, where w has the value `end` at the outer end of the next.
    fn joined(&self, next: &Stretch, end: f64) -> Stretch {
        let (here, beyond) = (&self.moments, &next.moments);
        let depth = self.depth + next.depth;
        let moments = Moments {
            width: here.width + beyond.width,
            first: here.first + next.depth * here.width + beyond.first,
            second: here.second + next.depth * (2.0 * here.first + next.depth * here.width) + beyond.second,
        };
        Stretch { depth, slope: ((end - self.value) / depth).clamp(-1.0, 1.0), moments, ..*self }
    }
}

impl SlipHistory {
    /// The history with at most `most` turning points.
    pub(in super::super) fn bounded(&self, limit: &impl Limit, most: usize) -> Bounded {
        let mut stretches = self.stretches(limit);
        let energy = |stretches: &[Stretch]| totals(stretches)[1];
        let (before, count) = (energy(&stretches), stretches.len());
        while stretches.len() > most + 1 {
            cut_smallest_loop(&mut stretches);
        }
        Bounded {
            core_slope: stretches.first().map_or(0.0, |core| core.slope),
            turning_points: stretches.iter().skip(1).map(|stretch| [stretch.level, stretch.slope]).collect(),
            lost: (stretches.len() < count).then(|| (before - energy(&stretches)).max(0.0)),
        }
    }

    /// The pieces with levels as doubles; what they do not distinguish is one turning point.
    fn stretches(&self, limit: &impl Limit) -> Vec<Stretch> {
        let mut stretches: Vec<Stretch> = Vec::with_capacity(self.pieces.len());
        let (mut outer, mut value) = (self.edge, 0.0);
        for piece in self.pieces.iter().rev() {
            let (level, slope) = (piece.inner.level.value(), piece.line.slope.value().clamp(-1.0, 1.0));
            if level >= outer.level.value() {
                continue;
            }
            let ring = Ring::between(piece.inner, outer);
            let mut moments = piece.moments_to(limit, &outer);
            if level <= 0.0 {
                let flat = piece.inner.radius;
                moments.width += flat;
                moments.first += flat * ring.depth;
                moments.second += flat * ring.depth * ring.depth;
            }
            value -= slope * ring.depth;
            stretches.push(Stretch { level, depth: ring.depth, value, slope, moments });
            outer = piece.inner;
        }
        stretches.reverse();
        stretches
    }

    /// The history whose w has this slope at the centre and these turning points, each a level, m, with the slope
    /// beyond; `None` unless the levels rise between the centre and the edge and the slopes are from -1 to 1.
    pub(in super::super) fn of_turning_points(
        limit: &impl Limit,
        (indentation, position): (DoubleDouble, DoubleDouble),
        core_slope: f64,
        turning_points: &[[f64; 2]],
    ) -> Option<SlipHistory> {
        let mut history = SlipHistory::new(limit, indentation).at_position(position);
        let Some(core) = history.pieces.pop() else {
            return (turning_points.is_empty() && core_slope.abs() <= 0.0).then_some(history);
        };
        let beyond = turning_points.iter().map(|&[level, slope]| (limit.point(DoubleDouble::from(level)), slope));
        let lines: Vec<(Point, f64)> = std::iter::once((core.inner, core_slope)).chain(beyond).collect();
        let levels = lines.iter().map(|(point, _)| point.level).chain([indentation]);
        if !levels.is_sorted_by(|inner, outer| inner < outer) || lines.iter().any(|(_, slope)| slope.abs() > 1.0) {
            return None;
        }
        let (mut outer, mut value) = (indentation, DoubleDouble::ZERO);
        for (inner, slope) in lines.into_iter().rev() {
            let slope = DoubleDouble::from(slope);
            value = value - rise(slope, outer - inner.level);
            let line = Line { offset: value - rise(slope, inner.level), slope };
            history.pieces.push(Piece::new(inner, line, Sums::default(), None));
            outer = inner.level;
        }
        history.pieces.reverse();
        let ends: Vec<Point> = history.pieces.iter().skip(1).map(|piece| piece.inner).chain([history.edge]).collect();
        for (piece, end) in history.pieces.iter_mut().zip(ends) {
            piece.below = history.total;
            history.total = piece.end_at(limit, &end);
        }
        Some(history)
    }
}

/// The value of w at the outer end of a stretch, m.
fn end_of(stretches: &[Stretch], index: usize) -> f64 {
    stretches.get(index + 1).map_or(0.0, |next| next.value)
}

fn totals(stretches: &[Stretch]) -> [f64; 2] {
    let sums = stretches.iter().enumerate().map(|(index, stretch)| stretch.sums(end_of(stretches, index)));
    sums.fold([0.0; 2], |[force, energy], [more, stored]| [force + more, energy + stored])
}

/// Leaves out the turning point whose loss changes the force least; there is one at least.
fn cut_smallest_loop(stretches: &mut Vec<Stretch>) {
    let [force, energy] = totals(stretches);
    let without = |index: usize| {
        let (inner, outer, end) = (&stretches[index - 1], &stretches[index], end_of(stretches, index));
        let chord = inner.joined(outer, end);
        let [old, older, new] = [inner.sums(outer.value), outer.sums(end), chord.sums(end)];
        let [force_after, energy_after] = [0, 1].map(|sum| [force, energy][sum] - old[sum] - older[sum] + new[sum]);
        let scale = if energy_after > energy { (energy / energy_after).sqrt() } else { 1.0 };
        ((scale * force_after - force).abs(), index, chord, scale)
    };
    let candidates = (1..stretches.len()).map(without);
    let Some((_, index, chord, scale)) = candidates.min_by(|one, other| one.0.total_cmp(&other.0)) else { return };
    stretches[index - 1] = chord;
    stretches.remove(index);
    if scale < 1.0 {
        for stretch in stretches {
            stretch.slope *= scale;
            stretch.value *= scale;
        }
    }
}
