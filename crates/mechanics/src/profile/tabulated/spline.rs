//! A smooth curve through the points of a table: f' continuous and linear between knots, f'(0) = 0.
//!
//! Slopes at the points are those of the parabola through each and its neighbours; they lie between the chords on
//! either side. Between two points one parabola seldom fits both slopes: a knot is put between, where Schumaker (1983)
//! shows that two parabolas stay convex or rising as the data do. Where neighbouring chords are nearly the same (a worn
//! flat, a straight flank) the slopes are drawn to them, so that no knot comes near a point: its place would be up to
//! the round-off of the heights, and f' would jump there. So the curve depends on its data continuously. Two straight
//! runs that meet leave no room for a smooth convex curve: then f' overshoots in the first interval after the corner,
//! by an eighth of the bend.

/// A radius, m, and the slope f' there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SplineKnot {
    pub(super) radius: f64,
    pub(super) slope: f64,
}

/// A knot between two points stays this far, relative to their distance, from either.
const MARGIN: f64 = 0.125;
/// The most by which the slopes at the ends of an interval may differ in their distance from the chord: the knot of two
/// parabolas that stay convex comes no nearer to an end than [`MARGIN`] then.
const RATIO: f64 = 7.0;

/// The knots of the curve through points of strictly increasing radius, three at least and the first at zero.
pub(super) fn knots(radii: &[f64], heights: &[f64]) -> Vec<SplineKnot> {
    let chords: Vec<f64> =
        radii.windows(2).zip(heights.windows(2)).map(|(r, z)| (z[1] - z[0]) / (r[1] - r[0])).collect();
    let mut slopes = slopes(radii, &chords);
    keep_shape(&mut slopes, &chords);
    let mut knots = vec![SplineKnot { radius: radii[0], slope: slopes[0] }];
    for (index, &chord) in chords.iter().enumerate() {
        let (start, end) = (radii[index], radii[index + 1]);
        let (left, right) = (slopes[index] - chord, slopes[index + 1] - chord);
        if let Some(share) = split(left, right, chord) {
            // The mean slope over the interval is the chord.
            let slope = chord - (left * share + right * (1.0 - share));
            knots.push(SplineKnot { radius: start + share * (end - start), slope });
        }
        knots.push(SplineKnot { radius: end, slope: slopes[index + 1] });
    }
    // Between neighbouring doubles there is no room for a knot.
    knots.dedup_by(|next, knot| next.radius <= knot.radius);
    knots
}

/// The slope at each point.
fn slopes(radii: &[f64], chords: &[f64]) -> Vec<f64> {
    let last = chords.len() - 1;
    let step = |index: usize| radii[index + 1] - radii[index];
    let mut slopes = vec![0.0];
    for index in 1..=last {
        let (before, after) = (step(index - 1), step(index));
        slopes.push((after * chords[index - 1] + before * chords[index]) / (before + after));
    }
    let (before, after) = (step(last - 1), step(last));
    slopes.push(chords[last] + (chords[last] - chords[last - 1]) * after / (before + after));
    slopes
}

/// Draws slopes to a neighbouring chord where the curve would otherwise not rise, or not be convex, as its data are.
/// Each stays between the chords on either side of its point.
fn keep_shape(slopes: &mut [f64], chords: &[f64]) {
    let last = chords.len();
    for index in 1..last {
        // Level at a peak and beside a flat.
        if chords[index - 1] * chords[index] <= 0.0 {
            slopes[index] = 0.0;
        }
    }
    // Where both ends are steeper than twice the chord, the middle would go the other way.
    for (index, &chord) in chords.iter().enumerate() {
        let (left, right) = (slopes[index] - chord, slopes[index + 1] - chord);
        if left * chord > 0.0 && right * chord > 0.0 {
            for slope in &mut slopes[index..=index + 1] {
                *slope = chord + (*slope - chord).clamp(-chord.abs(), chord.abs());
            }
        }
    }
    // Backward first: where both cannot be had, an overshoot above is better than a fall below.
    for (index, &chord) in chords.iter().enumerate().skip(1).rev() {
        slopes[index] = chord + limited(slopes[index] - chord, slopes[index + 1] - chord);
    }
    for (index, &chord) in chords.iter().enumerate() {
        slopes[index + 1] = chord + limited(slopes[index + 1] - chord, slopes[index] - chord);
    }
}

/// An offset from the chord, limited to [`RATIO`] times the one at the other end.
fn limited(offset: f64, other: f64) -> f64 {
    let most = RATIO * other.abs();
    offset.clamp(-most, most)
}

/// Where to put the knot between two points, as a share of the interval; none if one parabola does. `left` and `right`
/// are the slopes at the ends less the chord.
fn split(left: f64, right: f64, chord: f64) -> Option<f64> {
    let size = left.abs() + right.abs();
    if (left + right).abs() <= 1e-12 * (size + chord.abs()) {
        None
    } else {
        Some((right.abs() / size).clamp(MARGIN, 1.0 - MARGIN))
    }
}

#[cfg(test)]
mod tests {
    use super::{SplineKnot, knots};

    #[test]
    fn a_parabola_is_its_own_spline() {
        let radii: Vec<f64> = [0.0, 0.1, 0.25, 0.3, 0.7, 1.0].into();
        let heights: Vec<f64> = radii.iter().map(|r| r * r).collect();
        let knots = knots(&radii, &heights);
        assert_eq!(knots.len(), radii.len());
        assert!(knots.iter().all(|knot| (knot.slope - 2.0 * knot.radius).abs() < 4e-15));
    }

    #[test]
    fn convex_data_keep_convex() {
        let radii: Vec<f64> = (0..40u32).map(|i| f64::from(i * (i + 3)) * 1e-3).collect();
        for power in [1.3, 2.0, 6.0, 40.0] {
            let heights: Vec<f64> =
                radii.iter().map(|r: &f64| r.powf(power) + 2.0 * (r - 0.1).max(0.0).powi(2)).collect();
            let knots = knots(&radii, &heights);
            assert!(knots.windows(2).all(|pair| pair[1].slope >= pair[0].slope * (1.0 - 1e-15)), "{power}");
        }
    }

    /// Heights at the radii by integration over the knots.
    fn heights_of(knots: &[SplineKnot], radii: &[f64]) -> Vec<f64> {
        let (mut height, mut found) = (0.0, vec![0.0]);
        for pair in knots.windows(2) {
            height += 0.5 * (pair[0].slope + pair[1].slope) * (pair[1].radius - pair[0].radius);
            if radii.contains(&pair[1].radius) {
                found.push(height);
            }
        }
        found
    }

    #[test]
    fn straight_runs_do_not_leave_the_curve_to_round_off() {
        // A worn flat, a straight flank, a corner between both, and one-digit changes of the heights.
        let radii = [0.0, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0, 1.3];
        let tables = [
            [0.0, 0.0, 0.0, 0.05, 0.17, 0.4, 1.1, 2.0],
            [0.0, 0.03, 0.1, 0.145, 0.19, 0.33, 0.53, 0.9],
            [0.0, 0.0, 0.0, 0.1, 0.2, 0.4, 0.6, 0.9],
        ];
        for heights in tables {
            let plain = knots(&radii, &heights);
            for (found, height) in heights_of(&plain, &radii).iter().zip(heights) {
                assert!((found - height).abs() < 1e-15, "{found} {height}");
            }
            for index in 1..radii.len() {
                for nudge in [-1e-15, 1e-15] {
                    let mut nudged = heights;
                    nudged[index] += nudge;
                    let slope = |knots: &[SplineKnot], r: f64| {
                        let index = knots.partition_point(|knot| knot.radius < r).max(1);
                        let (low, high) = (knots[index - 1], knots[index]);
                        low.slope + (high.slope - low.slope) * (r - low.radius) / (high.radius - low.radius)
                    };
                    let nudged = knots(&radii, &nudged);
                    let worst = (0..1300u32)
                        .map(|i| 1e-3 * f64::from(i))
                        .map(|r| (slope(&plain, r) - slope(&nudged, r)).abs())
                        .fold(0.0, f64::max);
                    assert!(worst < 1e-11, "{index} {nudge}: {worst:e}");
                }
            }
        }
    }
}
