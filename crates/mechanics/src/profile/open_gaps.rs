//! The interpolation error of the slope of a curve through points, by the gaps between them.
//!
//! In a gap of the width h the curve has the heights of both ends, so that its slope errs with a mean of zero; by how
//! much depends on how far the second derivative varies about the gap, and at most in proportion to h times that
//! variation: a jump J of f'' within the gap moves the slope by J h/4, a third derivative by f''' h^2/6. The variation
//! is the spread of the second divided differences that hold the gap: with its nearest neighbours, whose rounding the
//! curve shares, and with points at a distance comparable with h, which know more than a twin of an end. At the end of
//! the points the curve is extrapolated, so that the last gap counts for more, and the differences before it count too.
//! Points that lie together beside a much wider gap say what f'' is at its end: all differences that hold the gap share
//! its far point, and may agree where f'' has changed.

/// Points this share of a gap away, and further, are at a distance comparable with it.
const REACH: f64 = 0.5;
/// The share of h times the variation of f'' that the slope is taken to err by, and of the last gap.
const SHARE: f64 = 0.5;
const SHARE_AT_END: f64 = 2.0;
/// The same with the variation up to what points that lie together at an end of the last gap say of f''.
const SHARE_OF_ALL_AT_END: f64 = 1.0;
/// The share of itself that rounding may take from a second difference of points that lie together.
const RESOLVED: f64 = 0.1;

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
        let beside = [index.checked_sub(2), Some(index + 1).filter(|first| first + 2 <= end)].into_iter().flatten();
        let beside = beside.map(|first| [first, first + 1, first + 2]).filter(|&[low, middle, high]| {
            let [low, middle, high] = [low, middle, high].map(|i| points[i]);
            high.0 - low.0 < REACH * width && resolved([low, middle, high])
        });
        let across = stencils.into_iter().filter(|[a, b, c]| a < b && b < c);
        let range = |range: (f64, f64), at: [usize; 3]| {
            let bend = bend(at.map(|i| points[i]));
            (range.0.min(bend), range.1.max(bend))
        };
        let own = across.fold((f64::MAX, f64::MIN), range);
        let (least, most) = beside.fold(own, range);
        let [share, of_all] = if at_end { [SHARE_AT_END, SHARE_OF_ALL_AT_END] } else { [SHARE; 2] };
        width * (share * (own.1 - own.0)).max(of_all * (most - least)).max(0.0)
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

/// Whether the second difference of three points is more than what the last digits of their heights make of it.
fn resolved([a, b, c]: [(f64, f64); 3]) -> bool {
    let height = a.1.abs().max(b.1.abs()).max(c.1.abs());
    let rounding = 4.0 * f64::EPSILON * height / ((b.0 - a.0) * (c.0 - b.0));
    rounding <= RESOLVED * bend([a, b, c]).abs()
}

/// The second derivative of the parabola through three points.
fn bend([a, b, c]: [(f64, f64); 3]) -> f64 {
    let secant = |low: (f64, f64), high: (f64, f64)| (high.1 - low.1) / (high.0 - low.0);
    2.0 * (secant(b, c) - secant(a, b)) / (c.0 - a.0)
}
