//! What the gaps between points leave open of the slope of a curve through them.
//!
//! In a gap of the width h the curve has the heights of both ends, so that its slope errs with a mean of zero; by how
//! much depends on how far the second derivative varies about the gap, and at most in proportion to h times that
//! variation: a jump J of f'' within the gap moves the slope by J h/4, a third derivative by f''' h^2/6. The variation
//! is the spread of the second divided differences that hold the gap: with its nearest neighbours, whose rounding the
//! curve shares, and with points at a distance comparable with h, which know more than a twin of an end. At the end of
//! the points the curve is extrapolated, so that the last gap counts for more, and the differences before it count too.

/// Points this share of a gap away, and further, are at a distance comparable with it.
const REACH: f64 = 0.5;
/// The share of h times the variation of f'' that the slope is taken to err by, and of the last gap.
const SHARE: f64 = 0.5;
const SHARE_AT_END: f64 = 2.0;

/// About how much the slope of a smooth curve through points (x, y) of rising x may err within each of their gaps, from
/// the one above the point `first` on.
pub(super) fn open_slopes(points: &[(f64, f64)], first: usize) -> Vec<f64> {
    let end = points.len() - 1;
    let open = |index: usize| {
        let width = points[index + 1].0 - points[index].0;
        let left = before(points, index, REACH * width);
        let right = after(points, index + 1, REACH * width);
        let at_end = index + 1 == end;
        let nearest = [index.saturating_sub(1), (index + 2).min(end)];
        let stencils = [
            [nearest[0], index, index + 1],
            [index, index + 1, nearest[1]],
            // None beside the nearest ones.
            [if left < nearest[0] { left } else { index }, index, index + 1],
            [index, index + 1, if right > nearest[1] { right } else { index + 1 }],
            [if at_end { before(points, left, REACH * width) } else { left }, left, index],
        ];
        let bends = stencils.into_iter().filter(|[a, b, c]| a < b && b < c).map(|at| bend(at.map(|i| points[i])));
        let (least, most) = bends.fold((f64::MAX, f64::MIN), |(low, high), bend| (low.min(bend), high.max(bend)));
        let share = if at_end { SHARE_AT_END } else { SHARE };
        share * width * (most - least).max(0.0)
    };
    (first..end).map(open).collect()
}

/// The last point at least `distance` below that of an index, the first if there is none: by steps that double.
fn before(points: &[(f64, f64)], index: usize, distance: f64) -> usize {
    let limit = points[index].0 - distance;
    let mut reach = 1;
    while reach <= index && points[index - reach].0 > limit {
        reach *= 2;
    }
    let start = index.saturating_sub(reach);
    (start + points[start..index].partition_point(|point| point.0 <= limit)).saturating_sub(1)
}

/// The first point at least `distance` above that of an index, the last if there is none.
fn after(points: &[(f64, f64)], index: usize, distance: f64) -> usize {
    let (limit, end) = (points[index].0 + distance, points.len() - 1);
    let mut reach = 1;
    while index + reach <= end && points[index + reach].0 < limit {
        reach *= 2;
    }
    let stop = (index + reach).min(end);
    index + points[index..stop].partition_point(|point| point.0 < limit)
}

/// The second derivative of the parabola through three points.
fn bend([a, b, c]: [(f64, f64); 3]) -> f64 {
    let secant = |low: (f64, f64), high: (f64, f64)| (high.1 - low.1) / (high.0 - low.0);
    2.0 * (secant(b, c) - secant(a, b)) / (c.0 - a.0)
}
