//! Shear stress at any radius, and all its extrema.
//!
//! tau(r) = -(G* m/pi) sum over pieces of slope_i int dy/sqrt(X(y)^2 - r^2): each piece adds its slope times its ring's
//! kernel (eq. 19 of Kraft & Pohrt 2016, by parts over the levels). Just inside a kink, where the slope changes by gamma,
//! tau falls off like -gamma sqrt(x - r), so that its derivative is infinite there with a known sign; between kinks it is
//! smooth. So an extremum is either a kink whose right-hand derivative has the other sign, or a root of the derivative.

use super::contact::Contact;
use super::profile::At;

/// A local extremum of the shear stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Its radius, m.
    pub radius: f64,
    /// The shear stress there, Pa, signed.
    pub shear: f64,
}

/// The shear stress that a history has left, in brief.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Shear stress at r = 0, Pa; `None` where it is infinite.
    pub centre: Option<f64>,
    /// All local extrema for 0 < r < a, from the centre outward.
    pub peaks: Vec<Peak>,
    /// Largest magnitude over the whole contact, Pa, the centre included.
    pub max: f64,
    /// Smallest magnitude of a peak, Pa.
    pub min: Option<f64>,
    /// Mean magnitude of the peaks, Pa.
    pub mean: Option<f64>,
}

impl Residual {
    /// Sums up the shear stress at the centre and the local extrema.
    pub(super) fn of(centre: f64, peaks: Vec<Peak>) -> Residual {
        let sizes = || peaks.iter().map(|peak| peak.shear.abs());
        let max = sizes().fold(if centre.is_finite() { centre.abs() } else { 0.0 }, f64::max);
        let (min, mean) = if peaks.is_empty() {
            (None, None)
        } else {
            (Some(sizes().fold(f64::INFINITY, f64::min)), Some(sizes().sum::<f64>() / peaks.len() as f64))
        };
        Residual { centre: centre.is_finite().then_some(centre), max, min, mean, peaks }
    }
}

/// Where between two kinks the derivative is sampled: as fractions of the difference of r^2, denser towards both ends,
/// where it changes fastest.
const SAMPLES: [f64; 9] = [0.0, 0.01, 0.06, 0.2, 0.45, 0.7, 0.9, 0.98, 0.999];

impl Contact {
    /// Shear stress, Pa, at a radius (m) of at least nought; nought outside the contact.
    #[must_use]
    pub fn shear(&self, radius: f64) -> f64 {
        self.shear_at(&At::radius(radius))
    }

    fn shear_at(&self, at: &At) -> f64 {
        let mut sum = 0.0;
        for (ring, line) in self.memory.rings() {
            if ring.outer.radius < at.radius {
                break;
            }
            let slope = line.slope.value();
            if slope.abs() > 0.0 {
                sum -= slope * self.profile.kernel(at, &ring);
            }
        }
        self.elasticity.g_star() * self.scale() / std::f64::consts::PI * sum
    }

    /// Sign of d tau/dr, from the right at a kink; nought where it is nought to round-off.
    fn trend(&self, at: &At) -> f64 {
        let (mut sum, mut size) = (0.0, 0.0);
        for (ring, line) in self.memory.rings() {
            if ring.outer.radius < at.radius {
                break;
            }
            let term = line.slope.value() * self.profile.kernel_slope(at, &ring);
            sum -= term;
            size += term.abs();
        }
        if sum.abs() > 8.0 * f64::EPSILON * size { sum.signum() } else { 0.0 }
    }

    /// All extrema of the shear stress with their exact radii, and what they amount to.
    #[must_use]
    pub fn residual(&self) -> Residual {
        Residual::of(self.shear(0.0), self.peaks())
    }

    fn peaks(&self) -> Vec<Peak> {
        let bends = self.bends();
        let settled = self.settled_from(&bends);
        let pieces = self.memory.pieces();
        let mut peaks = Vec::new();
        for (index, &bend) in bends.iter().enumerate() {
            // The interval from kink `index` (the centre for the first) out to kink `index + 1`, which bends by `bend`.
            let inner = At::point(&pieces[index].inner);
            let outer = pieces.get(index + 1).map_or(*self.memory.edge(), |next| next.inner);
            let right = if settled[index] { -bend.signum() } else { self.trend(&inner) };
            if index > 0 && bends[index - 1] * right > 0.0 {
                peaks.push(Peak { radius: inner.radius, shear: self.shear_at(&inner) });
            }
            if !settled[index] {
                let from = if index == 0 { At::radius(0.0) } else { inner };
                self.smooth_extrema(&from, &At::point(&outer), -bend, &mut peaks);
            }
        }
        peaks
    }

    /// Change of slope at each kink, from the first beyond the centre to the edge.
    fn bends(&self) -> Vec<f64> {
        let slope = |index: usize| self.memory.pieces().get(index).map_or(0.0, |piece| piece.line.slope.value());
        (0..self.memory.pieces().len()).map(|index| slope(index + 1) - slope(index)).collect()
    }

    /// Whether the derivative keeps one sign in the interval inside each kink, known without a search: where all bends from
    /// there on alternate and do not grow, and the kernel falls, the sum is an alternating one led by its first term.
    fn settled_from(&self, bends: &[f64]) -> Vec<bool> {
        let mut settled = vec![false; bends.len()];
        for index in (0..bends.len()).rev() {
            let bend = bends[index];
            settled[index] = match bends.get(index + 1) {
                Some(next) => settled[index + 1] && bend * next < 0.0 && bend.abs() >= next.abs(),
                // A straight end carries nothing on: there is no first term to lead.
                None => bend.abs() > 0.0 && self.profile.kernel_falls(),
            };
        }
        settled
    }

    /// Extrema strictly between two kinks; `end` has the sign of the derivative at the outer one.
    fn smooth_extrema(&self, inner: &At, outer: &At, end: f64, peaks: &mut Vec<Peak>) {
        let span = outer.square - inner.square;
        if span.value() <= 0.0 {
            return;
        }
        let at = |fraction: f64| {
            let square = inner.square + span * fraction;
            At { radius: square.value().sqrt(), square }
        };
        let mut before = (0.0, 0.0);
        for fraction in SAMPLES.into_iter().chain([1.0]) {
            let sign = if fraction < 1.0 { self.trend(&at(fraction)) } else { end.signum() };
            if before.1 * sign < 0.0 {
                let root = self.turn(&at, before, fraction);
                peaks.push(Peak { radius: root.radius, shear: self.shear_at(&root) });
            }
            if sign.abs() > 0.0 {
                before = (fraction, sign);
            }
        }
    }

    /// Bisects for the change of sign between two fractions: the derivative ends in an inverse root, which nothing quicker
    /// takes without care, and there are few of these.
    fn turn(&self, at: &impl Fn(f64) -> At, (mut low, sign): (f64, f64), mut high: f64) -> At {
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return at(middle);
            }
            if self.trend(&at(middle)) * sign > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
}
