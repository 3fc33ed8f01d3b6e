//! The smallest ball that encloses points, exactly, in any number of dimensions.
//!
//! The ball of a few points on its surface, the support, grows: the farthest point outside joins, and of all balls that
//! support and newcomer can carry, the smallest that encloses them is next. The radius rises at each step, so that no
//! support comes twice, whatever points coincide or lie on one sphere (Welzl 1991; the farthest first: Gärtner 1999).

/// A ball in N dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const N: usize> {
    /// The centre.
    pub center: [f64; N],
    /// The radius.
    pub radius: f64,
}

/// More steps than points ever need; a safeguard only.
const MOST_STEPS: usize = 1000;
/// A squared distance above the squared radius by less than this share is round-off.
const ON_SURFACE: f64 = 8.0 * f64::EPSILON;
/// A point nearer than this to the flat through others, squared and relative to its distance, is taken as lying in it.
const FLAT: f64 = 1e-30;

/// The smallest ball around all `points`, its radius right to round-off; the ball of no points has the radius zero.
///
/// ```
/// use stickslip_mechanics::fatigue::enclosing_ball;
///
/// // The longest side of an obtuse triangle is a diameter.
/// let ball = enclosing_ball(&[[-1.0, 0.0], [0.5, 0.25], [1.0, 0.0]]);
/// assert_eq!((ball.center, ball.radius), ([0.0, 0.0], 1.0));
/// ```
#[must_use]
pub fn enclosing_ball<const N: usize>(points: &[[f64; N]]) -> Ball<N> {
    let Some(&origin) = points.first() else { return Ball { center: [0.0; N], radius: 0.0 } };
    // From one of them, so that a common offset costs no digits.
    let points: Vec<[f64; N]> = points.iter().map(|point| minus(point, &origin)).collect();
    let (mut center, mut reach) = ([0.0; N], 0.0);
    let mut support = vec![center];
    let mut farthest = farthest_from(&center, &points);
    for _ in 0..MOST_STEPS {
        if farthest.1 <= reach * (1.0 + ON_SURFACE) {
            break;
        }
        let next = Smallest::carried_by(farthest.0, &support);
        if next.reach <= reach {
            break;
        }
        let (place, square, carriers) = (next.center, next.reach, next.carriers);
        let kept = support.iter().enumerate().filter(|(index, _)| carriers & (1 << index) != 0);
        support = kept.map(|(_, point)| *point).chain([farthest.0]).collect();
        (center, reach) = (place, square);
        farthest = farthest_from(&center, &points);
    }
    Ball { center: std::array::from_fn(|i| origin[i] + center[i]), radius: farthest.1.max(reach).sqrt() }
}

fn minus<const N: usize>(one: &[f64; N], other: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| one[i] - other[i])
}

pub(super) fn dot<const N: usize>(one: &[f64; N], other: &[f64; N]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

pub(super) fn squared_distance<const N: usize>(one: &[f64; N], other: &[f64; N]) -> f64 {
    let between = minus(one, other);
    dot(&between, &between)
}

/// The farthest point from a place, and its squared distance.
fn farthest_from<const N: usize>(place: &[f64; N], points: &[[f64; N]]) -> ([f64; N], f64) {
    points.iter().fold((*place, 0.0), |farthest, point| {
        let distance = squared_distance(point, place);
        if distance > farthest.1 { (*point, distance) } else { farthest }
    })
}

/// The search of the smallest ball around an apex on its surface and a few other points.
struct Smallest<'a, const N: usize> {
    apex: [f64; N],
    others: &'a [[f64; N]],
    center: [f64; N],
    /// The squared radius.
    reach: f64,
    /// The others on the surface that fix the ball, one bit each.
    carriers: u32,
}

impl<'a, const N: usize> Smallest<'a, N> {
    fn carried_by(apex: [f64; N], others: &'a [[f64; N]]) -> Smallest<'a, N> {
        let mut search = Smallest { apex, others, center: apex, reach: f64::INFINITY, carriers: 0 };
        search.extend(&[0.0; N], &mut [[0.0; N]; N], 0, (0, 0));
        search
    }

    /// Tries the ball through the apex and the `carriers`, and those with further points: its centre from the apex is
    /// in the flat that `frame` spans. It counts with the distance of the farthest point, so that round-off cannot
    /// win.
    fn extend(
        &mut self,
        center: &[f64; N],
        frame: &mut [[f64; N]; N],
        dimensions: usize,
        (carriers, from): (u32, usize),
    ) {
        let place: [f64; N] = std::array::from_fn(|i| self.apex[i] + center[i]);
        let reach = farthest_from(&place, self.others).1.max(squared_distance(&self.apex, &place));
        if reach < self.reach {
            (self.center, self.reach, self.carriers) = (place, reach, carriers);
        }
        for index in from..self.others.len() {
            let arm = minus(&self.others[index], &self.apex);
            let mut height = arm;
            for axis in &frame[..dimensions] {
                let part = dot(&height, axis);
                height = std::array::from_fn(|i| height[i] - part * axis[i]);
            }
            let (square, rise) = (dot(&arm, &arm), dot(&height, &height));
            if dimensions == N || rise <= FLAT * square {
                continue;
            }
            // As far from this point as from the apex.
            let (rise, missing) = (rise.sqrt(), 0.5 * square - dot(&arm, center));
            let axis = height.map(|part| part / rise);
            frame[dimensions] = axis;
            let moved = std::array::from_fn(|i| center[i] + missing / rise * axis[i]);
            self.extend(&moved, frame, dimensions + 1, (carriers | 1 << index, index + 1));
        }
    }
}
