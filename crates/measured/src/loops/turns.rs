//! The turns of a displacement between its samples.
//!
//! A drive turns between two samples, and the noise of the displacement hides where. The samples about a turn show it
//! in two forms: the vertex of one parabola, as of a sine, and the intersection of two straight lines, as of a
//! triangle. The true place is between or near the two. It is a parameter of the fit, since all forces after a turn
//! depend on it (Masing 1926); the two forms are what is known beforehand.

use std::ops::RangeInclusive;

/// Samples on either side of a turn that its forms need.
const LEAST_SIDE: usize = 2;
/// Samples about a turn are used up to this many standard deviations of the noise below it.
const REACH: f64 = 8.0;
/// How far a turn may be from its form: as a share of the shorter of the steps beside it, of the distance of the two
/// forms, and of the longer step where a stroke has no sample of its own.
const STEP_SHARE: f64 = 0.1;
const FORM_SHARE: f64 = 0.3;
const EMPTY_STROKE_SHARE: f64 = 0.5;
/// A turn is not known better than this share of the range.
const LEAST_ERROR: f64 = 1e-5;

/// Where between its forms a turn is, is not known better than this share of the way.
const LEAST_SHARE_ERROR: f64 = 0.2;

/// A turn as the samples about it show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Form {
    /// When it turns.
    pub(super) time: f64,
    /// The vertex of the parabola, m.
    pub(super) vertex: f64,
    /// The intersection of the lines, m.
    pub(super) corner: f64,
    /// How far the turn may be from either, m.
    pub(super) error: f64,
    /// Sums of the squared distances of the samples from either form, m^2.
    pub(super) squares: [f64; 2],
}

/// The forms of the turn at the extreme sample `at`, of samples between the turns beside it.
pub(super) fn form(times: &[f64], displacement: &[f64], at: usize, between: RangeInclusive<usize>, noise: f64) -> Form {
    let (first, last) = (*between.start(), *between.end());
    let near = |index: &usize| (displacement[*index] - displacement[at]).abs() < REACH * noise;
    let before = (first..at).rev().take_while(near).count().max(LEAST_SIDE).min(at - first);
    let after = (at + 1..=last).take_while(near).count().max(LEAST_SIDE).min(last - at);
    let about = at - before..=at + after;
    let reach = (times[at + after] - times[at]).max(times[at] - times[at - before]);
    let x = |index: usize| (times[index] - times[at]) / reach;
    let y = |index: usize| displacement[index] - displacement[at];
    let steps = [y(at - 1).abs(), y(at + 1).abs()];
    let (mut vertex, mut of_vertex) = parabola(about.clone(), x, y).unwrap_or(([0.0; 2], f64::INFINITY));
    if vertex[0] < x(at - before.min(1 + before / 2)) || vertex[0] > x(at + after.min(1 + after / 2)) {
        (vertex, of_vertex) = ([0.0; 2], f64::INFINITY);
    }
    let (corner, of_corner) = lines(about, x, y).unwrap_or((vertex, f64::INFINITY));
    if of_vertex.is_infinite() {
        vertex = corner;
    }
    let time = times[at] + reach * if of_corner < of_vertex { corner[0] } else { vertex[0] };
    let empty = if before.min(after) < LEAST_SIDE { EMPTY_STROKE_SHARE * steps[0].min(steps[1]) } else { 0.0 };
    let error =
        noise.hypot(STEP_SHARE * steps[0].min(steps[1])).hypot(FORM_SHARE * (vertex[1] - corner[1])).hypot(empty);
    let [vertex, corner] = [vertex, corner].map(|form| displacement[at] + form[1]);
    let range = displacement[first..=last].iter().fold(0.0, |far: f64, u| far.max((u - displacement[at]).abs()));
    let squares = [of_vertex, of_corner];
    Form { time, vertex, corner, error: error.max(LEAST_ERROR * range), squares }
}

/// The vertex of the parabola through samples, and the squares that it leaves.
fn parabola(
    about: RangeInclusive<usize>,
    x: impl Fn(usize) -> f64,
    y: impl Fn(usize) -> f64,
) -> Option<([f64; 2], f64)> {
    let basis = |index: usize| nalgebra::Vector3::new(1.0, x(index), x(index).powi(2));
    let normal: nalgebra::Matrix3<f64> = about.clone().map(|index| basis(index) * basis(index).transpose()).sum();
    let right: nalgebra::Vector3<f64> = about.clone().map(|index| basis(index) * y(index)).sum();
    let fitted = normal.try_inverse()? * right;
    let squares = about.map(|index| (y(index) - fitted.dot(&basis(index))).powi(2)).sum();
    let place = -0.5 * fitted[1] / fitted[2];
    place.is_finite().then_some(([place, fitted[0] + 0.5 * fitted[1] * place], squares))
}

/// The intersection of the two lines that leave the least squares, each through at least two samples on its side.
fn lines(about: RangeInclusive<usize>, x: impl Fn(usize) -> f64, y: impl Fn(usize) -> f64) -> Option<([f64; 2], f64)> {
    let (first, last) = (*about.start(), *about.end());
    // Sums of 1, x, y, xx, xy, yy up to each sample.
    let mut sums = vec![[0.0; 6]];
    for index in about {
        let (x, y) = (x(index), y(index));
        let terms = [1.0, x, y, x * x, x * y, y * y];
        let so_far = sums[sums.len() - 1];
        sums.push(std::array::from_fn(|term| so_far[term] + terms[term]));
    }
    let line = |from: usize, to: usize| {
        let [n, x, y, xx, xy, yy]: [f64; 6] = std::array::from_fn(|term| sums[to][term] - sums[from][term]);
        let (xx, xy, yy) = (xx - x * x / n, xy - x * y / n, yy - y * y / n);
        let slope = xy / xx;
        (slope, (y - slope * x) / n, (yy - slope * xy).max(0.0))
    };
    let mut best: Option<([f64; 2], f64)> = None;
    for after in LEAST_SIDE..=(last + 1 - first).checked_sub(LEAST_SIDE)? {
        let (left, right) = (line(0, after), line(after, last + 1 - first));
        let place = (right.1 - left.1) / (left.0 - right.0);
        let (low, high) = (x(first + after - 1), x(first + after));
        let slack = 1e-6 * (high - low);
        let squares = left.2 + right.2;
        if place >= low - slack && place <= high + slack && best.is_none_or(|(_, least)| squares < least) {
            best = Some(([place, left.1 + left.0 * place], squares));
        }
    }
    best
}

/// How much of the way from the vertex to the corner the turns of a record are: a value with its standard deviation.
/// It is nearer to the form that leaves less of the samples, and the less sure the more that form leaves too, as at the
/// end of a short rest.
pub(super) fn corner_share(forms: &[Form], noise: f64) -> [f64; 2] {
    let known: Vec<&Form> =
        forms.iter().filter(|form| form.squares.iter().all(|squares| squares.is_finite())).collect();
    let least = 4.0 * noise * noise * known.len() as f64;
    let [vertex, corner] = [0, 1].map(|which| known.iter().map(|form| form.squares[which]).sum::<f64>() + least);
    let share = if vertex + corner > 0.0 { vertex / (vertex + corner) } else { 0.5 };
    let apart: f64 = known.iter().map(|form| (form.corner - form.vertex).powi(2)).sum();
    let unlike = if apart > 0.0 { (vertex.min(corner) / apart).sqrt() } else { 0.0 };
    [share, share.min(1.0 - share).clamp(LEAST_SHARE_ERROR, 0.5).hypot(unlike).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The truth is 1 at time 0. Two lines are exact for a triangle, and the parabola for a sine is within its error.
    #[test]
    fn a_turn_between_samples_is_found_in_the_form_that_it_has() {
        let mut random = fastrand::Rng::with_seed(2);
        for _ in 0..200 {
            let (step, phase) = (0.2 * random.f64() + 0.01, random.f64());
            let times: Vec<f64> = (-4..=4).map(|index| step * (f64::from(index) + phase)).collect();
            let shapes: [fn(f64) -> f64; 3] =
                [|t| 1.0 - t.abs(), |t: f64| 1.0 - 1.2 * t.max(0.0) - 0.6 * (-t).max(0.0), f64::cos];
            let forms = shapes.map(|shape| {
                let displacement: Vec<f64> = times.iter().map(|time| shape(*time)).collect();
                let at = (0..9).max_by(|a, b| displacement[*a].total_cmp(&displacement[*b])).unwrap();
                form(&times, &displacement, at, 0..=8, 0.0)
            });
            for form in &forms[..2] {
                assert!((form.corner - 1.0).abs() < 1e-12 && form.time.abs() < 1e-12, "{form:?}");
                assert!(corner_share(std::slice::from_ref(form), 0.0)[0] > 0.99);
            }
            let sine = forms[2];
            assert!((sine.vertex - 1.0).abs() < sine.error && sine.time.abs() < 0.1 * step, "{sine:?} {step} {phase}");
            assert!(corner_share(&[sine], 0.0)[0] < 0.05, "{sine:?}");
        }
    }
}
