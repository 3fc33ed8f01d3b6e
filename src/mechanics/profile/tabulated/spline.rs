//! A smooth curve through the points of a table: f' continuous and linear between knots, f'(0) = 0.
//!
//! Slopes at the points are those of the parabola through each and its neighbours; they lie between the chords on either side,
//! so convex data keep convex. Between two points one parabola seldom fits both slopes: a knot is put between, where
//! Schumaker (1983) shows that two parabolas stay convex or rising as the data do.

/// A radius, m, and the slope f' there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub(super) radius: f64,
    pub(super) slope: f64,
}

/// The knots of the curve through points of strictly increasing radius, three at least and the first at nought.
pub(super) fn knots(radii: &[f64], heights: &[f64]) -> Vec<Knot> {
    let chords: Vec<f64> =
        radii.windows(2).zip(heights.windows(2)).map(|(r, z)| (z[1] - z[0]) / (r[1] - r[0])).collect();
    let slopes = slopes(radii, &chords);
    let mut knots = vec![Knot { radius: radii[0], slope: slopes[0] }];
    for (index, &chord) in chords.iter().enumerate() {
        let (start, end) = (radii[index], radii[index + 1]);
        let (left, right) = (slopes[index] - chord, slopes[index + 1] - chord);
        if let Some(share) = split(left, right, chord) {
            let radius = start + share * (end - start);
            if radius > start && radius < end {
                // The mean slope over the interval is the chord.
                let slope = chord - (left * share + right * (1.0 - share));
                knots.push(Knot { radius, slope });
            }
        }
        knots.push(Knot { radius: end, slope: slopes[index + 1] });
    }
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
    let end = chords[last] + (chords[last] - chords[last - 1]) * after / (before + after);
    slopes.push(if chords[last] > 0.0 { end.max(0.0) } else { end });
    slopes
}

/// Where to put the knot between two points, as a share of the interval; none if one parabola does. `left` and `right` are the
/// slopes at the ends less the chord.
fn split(left: f64, right: f64, chord: f64) -> Option<f64> {
    if (left + right).abs() <= 1e-12 * (left.abs() + right.abs() + chord.abs()) {
        None
    } else if left * right >= 0.0 {
        Some(0.5)
    } else if right.abs() < left.abs() {
        Some(right / (right - left))
    } else {
        Some(1.0 + left / (right - left))
    }
}

#[cfg(test)]
mod tests {
    use super::knots;

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
        let heights: Vec<f64> = radii.iter().map(|r| r.powf(1.3) + (4.0 * r).exp()).collect();
        let knots = knots(&radii, &heights);
        assert!(knots.windows(2).skip(1).all(|pair| pair[1].slope >= pair[0].slope));
    }
}
