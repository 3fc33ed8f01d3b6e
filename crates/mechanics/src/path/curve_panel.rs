//! Two chords in the place of a stretch of a curved path, with the same integral.
//!
//! Chords between points of a curve all err to one side: their errors add up, and fall with the square of their length
//! only. Here the point between two chords is moved off the curve until the pair has the integral of the curve, which
//! a quadrature over the newly touched ring gives to round-off. Let h(x) = d1 - g(x) in the ring x0 < x < x1, whose
//! depth is D. Levels touched without slip carry w = W1 - W(x). With F_N' = 2 E* x g' (the Galin-Sneddon integral):
//! - W straight in F_N: int w dx = (W1 - W0) int (2x - x0) h dx/(x0 D + int h dx);
//! - F_x straight in d: dF_x = 2 G* m x dW (no slip), so W1 - W0 = c (D/x1 + K) and int w dx = c x0 J, with
//!   c = (dF_x/dd)/(2 G* m), J = int h/x^2 dx and K = int (D - h)/x^2 dx; J = D/x0 - D/x1 - K.

use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{self, EIGHT_POINTS, TWENTY_POINTS};
use crate::path::curved_path::{CurvedPath, PathPoint};
use crate::profile::Ring;

/// A rate of slip below this, relative to the levels and positions that it is a difference of, is rounding.
const RATE_ROUND_OFF: f64 = 16.0 * f64::EPSILON;

/// Slip that ends within this share of a stretch is over at its start, as far as it was found: W - d is flat there, so
/// that the share is wrong by its square.
const BEGINNING: f64 = 1e-3;

/// A stretch of a curved path, from the present state on.
pub(crate) struct PathPanel {
    /// Where the two chords meet.
    pub(crate) elbow: PathPoint,
    pub(crate) end: PathPoint,
    /// Whether all of it is without slip, so that what it touches keeps a part of the curve.
    pub(crate) sticks: bool,
    /// The sign of slip, and whether slip towards it goes on at the start, if it does so in a part alone.
    pub(crate) turn: Option<(f64, bool)>,
    /// A bound of int (error of w) dx up to anywhere within the pair of chords, m^2.
    pub(crate) within: f64,
    /// Error of that integral over the whole pair, m^2.
    pub(crate) quadrature: f64,
    /// Error of the slope of w over y, times the kernel of the newly touched ring at its inner radius.
    pub(crate) kernel: f64,
}

/// An integral by two rules: its value, and their difference.
struct Quadrature {
    value: f64,
    difference: f64,
}

/// A quadrature over the radii of a ring of an integrand of (x, D - h, h).
fn over_ring(contact: &Contact, ring: &Ring, integrand: impl Fn(f64, f64, f64) -> f64) -> Quadrature {
    if let Some(curve) = contact.indenter.profile().curve() {
        // Over the level, as its radius is an inverse: over the root of the distance from the inner one, next to which
        // a radius may rise like a root.
        return by_two_rules(|u| {
            let risen = ring.depth * u * u;
            let level = ring.inner.level + DoubleDouble::from(risen);
            let [radius, rate] = curve.radius_and_rate(level);
            2.0 * ring.depth * u * rate * integrand(radius, risen, ring.depth - risen)
        });
    }
    let (inner, width) = (ring.inner.radius, ring.outer.radius - ring.inner.radius);
    // Over the root of the distance from the inner radius: next to a flat g rises like a root.
    by_two_rules(|u| {
        let x = inner + width * u * u;
        let level = DoubleDouble::from(contact.indenter.level(x));
        let [risen, left] = [level - ring.inner.level, ring.outer.level - level];
        let [risen, left] = [risen, left].map(|height| height.value().clamp(0.0, ring.depth.max(0.0)));
        2.0 * width * u * integrand(x, risen, left)
    })
}

/// The integral of a function over 0 to 1.
fn by_two_rules(integrand: impl Fn(f64) -> f64) -> Quadrature {
    let value = gauss::integral(&TWENTY_POINTS, 1.0, &integrand);
    Quadrature { value, difference: (value - gauss::integral(&EIGHT_POINTS, 1.0, &integrand)).abs() }
}

/// Whether slip towards `sign` goes on while the position advances and the indentation rises by so much.
fn slips((advance, rise): (DoubleDouble, DoubleDouble), sign: f64, noise: f64) -> bool {
    (advance * sign - rise).value() > noise
}

/// How far into a ring, from its outer end, its kernel is asked for where it is infinite at the inner one.
const BESIDE: f64 = 0.999;

/// [`CurvedPath::gain`] where W is straight in F_N.
pub(super) fn lever(contact: &Contact, ring: &Ring, advance: f64) -> (f64, f64) {
    let inner = ring.inner.radius;
    let lever = over_ring(contact, ring, |x, _, left| (2.0 * x - inner) * left);
    let rate = advance / (inner * ring.depth + contact.indenter.moments(ring).first);
    (rate * lever.value, (rate * lever.difference).abs())
}

/// [`CurvedPath::gain`] where F_x is straight in d.
pub(super) fn lag(contact: &Contact, ring: &Ring, advance: f64) -> (f64, f64) {
    let (inner, outer, depth) = (ring.inner.radius, ring.outer.radius, ring.depth);
    let bend = over_ring(contact, ring, |x, risen, _| risen / x / x);
    let rate = advance / (depth / outer + bend.value);
    if inner > 0.5 * outer {
        let lag = over_ring(contact, ring, |x, _, left| inner / x * (left / x));
        (rate * lag.value, (rate * lag.difference).abs())
    } else {
        // The same by K, since h/x^2 is steep where the ring begins next to the axis.
        let lag = depth * (1.0 - inner / outer) - inner * bend.value;
        (rate * lag, (rate * inner * bend.difference).abs())
    }
}

impl Contact {
    /// The displacement, scaled, m, at which a contact that does not slip has the tangential force `target`, N, on a
    /// path straight in (F_x, d); `None` where it slips.
    pub(super) fn stuck_position(&self, indentation: DoubleDouble, target: f64) -> Option<DoubleDouble> {
        let here = self.history.edge().level;
        if here.value() < 0.0 || indentation <= here {
            return None;
        }
        let ring = Ring::between(self.indenter.point(here), self.indenter.point(indentation));
        // Rounding may leave nothing of a ring, or turn it round.
        if ring.depth <= 0.0 {
            return None;
        }
        let gain = target / self.force_unit() - self.history.force();
        let begun = self.indenter.point(here + (indentation - here) * BEGINNING);
        if gain.abs() > ring.depth * begun.radius {
            return None;
        }
        let compliance = ring.depth / ring.outer.radius + over_ring(self, &ring, |x, risen, _| risen / x / x).value;
        let advance = gain / ring.depth * compliance;
        advance.is_finite().then(|| self.history.position() + DoubleDouble::from(advance))
    }

    /// The stretch of a path from here, at `done`, to `next`.
    pub(crate) fn panel(&self, path: &dyn CurvedPath, done: f64, next: f64) -> PathPanel {
        let end = path.point(self, next);
        let start = self.history.edge().level;
        let rise = end.indentation - start;
        let mut panel =
            PathPanel { elbow: end, end, sticks: false, turn: None, within: 0.0, quadrature: 0.0, kernel: 0.0 };
        let middle = path.point(self, 0.5 * (done + next));
        let rises = (middle.indentation - start, end.indentation - middle.indentation);
        let (lower, upper) = if rise.value() > 0.0 { (start, end.indentation) } else { (end.indentation, start) };
        if upper.value() <= 0.0 || rises.0.value() * rises.1.value() <= 0.0 {
            return panel;
        }
        panel.elbow = middle;
        let (half, whole) = (self.advance_to(&middle), self.advance_to(&end));
        let noise = RATE_ROUND_OFF * (start.abs() + end.indentation.abs() + self.history.position().abs()).value();
        // Half the curvature of W over d: the parabola through both ends and the middle.
        let (first, second) = (rises.0.value(), rises.1.value());
        let bend = ((whole - half).over(rises.1) - half.over(rises.0)).value() / rise.value();
        // Its rates at the ends show a turn that the halves as a whole do not.
        let ends = [(half, rises.0, -bend * first * first), (whole - half, rises.1, bend * second * second)]
            .map(|(advance, rise, more)| (advance + DoubleDouble::from(more), rise));
        let halves = [(half, rises.0), (whole - half, rises.1)];
        let slip = |sign: f64| halves.map(|way| slips(way, sign, noise));
        panel.turn = [1.0, -1.0].into_iter().find_map(|sign| {
            let at_ends = ends.map(|way| slips(way, sign, noise));
            let same = [at_ends, slip(sign)].as_flattened().iter().all(|&rate| rate == at_ends[0]);
            (!same).then_some((sign, at_ends[0]))
        });
        panel.sticks = rise.value() > 0.0 && [1.0, -1.0].into_iter().all(|sign| slip(sign) == [false, false]);
        let lower = if lower.value() > 0.0 { lower } else { DoubleDouble::ZERO };
        let ring = Ring::between(self.indenter.point(lower), self.indenter.point(upper));
        let rates = [done, 0.5 * (done + next), next].map(|part| path.rate(part));
        if panel.sticks && rates[0].is_none() {
            if let Some(gained) = path.gain(self, &ring, whole.value()) {
                self.bend_stuck(gained, &mut panel, &ring, (whole.value(), bend));
            }
            return panel;
        }
        // The state at the end is that of the curve already. The friction work is not: the slip of a level under the
        // bound d - y depends on int W dd, by Simpson's rule over the path or that of the parabola.
        let parabola = bend * (first.abs().powi(3) + second.abs().powi(3)) / 6.0;
        let area = match rates {
            [Some(_), Some(at_middle), Some(at_end)] => {
                let [half, whole] = [half, whole].map(DoubleDouble::value);
                let chords = 0.5 * (half * first + (half + whole) * second);
                rise.value().signum() * (chords - (4.0 * half * at_middle + whole * at_end) * (next - done) / 6.0)
            }
            _ => parabola,
        };
        let area = if area.is_finite() { area } else { parabola };
        let shift = DoubleDouble::from(-2.0 * area / rise.value().abs());
        let bent = [(half + shift, rises.0), (whole - half - shift, rises.1)];
        if [1.0, -1.0].into_iter().all(|sign| bent.map(|way| slips(way, sign, noise)) == slip(sign)) {
            panel.elbow.displacement = self.unscaled(self.history.position() + half + shift);
        }
        panel.within = area.abs() * self.indenter.moments(&ring).width / rise.value().abs();
        panel
    }

    /// The elbow and the errors of a stretch without slip, on which the position advances by `whole` and int w dx grows
    /// by `gained`, up to an error.
    fn bend_stuck(&self, (gained, error): (f64, f64), panel: &mut PathPanel, ring: &Ring, (whole, bend): (f64, f64)) {
        let touched = self.indenter.moments(ring).first;
        let middle = self.indenter.point(panel.elbow.indentation);
        let (low, high) = (Ring::between(ring.inner, middle), Ring::between(middle, ring.outer));
        let (low_moments, high_moments) = (self.indenter.moments(&low), self.indenter.moments(&high));
        let (low_mean, high_mean) = (low_moments.first / low.depth, high_moments.first / high.depth);
        let share = low_moments.width + high_mean - low_mean;
        if share > 0.0 {
            let left = (gained - whole * low_mean) / share;
            let advance = self.advance_to(&panel.end) - DoubleDouble::from(left);
            panel.elbow.displacement = self.unscaled(self.history.position() + advance);
            panel.within = 0.25 * (gained - whole * touched / ring.depth).abs();
            panel.quadrature = error;
        }
        // A chord of half the depth is off the parabola's slope by a half of bend times the depth at its ends, and the
        // elbow by a sixth more.
        let kernel = self.face_kernel(ring, None);
        let kernel = if kernel.is_finite() {
            kernel
        } else {
            // At the tip of a cone or at a rim it is infinite, and so is the stress itself: the error is that of the
            // stress beside it.
            let beside = BESIDE * ring.inner.radius + (1.0 - BESIDE) * ring.outer.radius;
            self.face_kernel(ring, Some(beside))
        };
        panel.kernel = (bend * ring.depth).abs() / 1.5 * kernel;
    }
}
