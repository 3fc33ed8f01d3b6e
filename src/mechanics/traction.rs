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
    /// Largest magnitude over the whole contact, Pa, the centre included; `None` where it is infinite.
    pub max: Option<f64>,
    /// Smallest magnitude of a peak, Pa.
    pub min: Option<f64>,
    /// Mean magnitude of the peaks, Pa.
    pub mean: Option<f64>,
}

impl Residual {
    /// Sums up the shear stress at the centre and the local extrema; `bounded` if it is finite everywhere else.
    pub(super) fn of(centre: f64, peaks: Vec<Peak>, bounded: bool) -> Residual {
        let sizes = || peaks.iter().map(|peak| peak.shear.abs());
        let max = (bounded && centre.is_finite()).then(|| sizes().fold(centre.abs(), f64::max));
        let (min, mean) = if peaks.is_empty() {
            (None, None)
        } else {
            (Some(sizes().fold(f64::INFINITY, f64::min)), Some(sizes().sum::<f64>() / peaks.len() as f64))
        };
        Residual { centre: centre.is_finite().then_some(centre), max, min, mean, peaks }
    }
}

/// Between two kinks the derivative is sampled at distances from the outer one that shrink by this factor: beneath a thin
/// ring it has structure of every size from the whole stretch down to the ring's depth.
const SHRINK: f64 = 0.6;
/// Sampling ends this far below the depth of the ring beyond, where the kink itself outweighs all else.
const FINEST: f64 = 1e-3;
/// The most samples of one stretch: they reach down to round-off.
const SAMPLES: i32 = 72;

/// A derivative below this share of what it is the sum of is nought: the kernels of some families are good to 1e-13.
const NOISE: f64 = 1e-12;

/// A stretch of radii in which the shear stress is smooth.
struct Stretch {
    inner: At,
    outer: At,
    /// Sign of the derivative at the outer end, if it is known.
    end: f64,
    /// Difference of the squares of the radii of the ring beyond, m^2.
    beyond: f64,
}

impl Stretch {
    /// The radius whose square is this share of the way from the outer end to the inner.
    fn at(&self, share: f64) -> At {
        let square = self.outer.square - (self.outer.square - self.inner.square) * share;
        At { radius: square.value().max(0.0).sqrt(), square }
    }
}

impl Contact {
    /// Shear stress, Pa, at a radius (m) of at least nought; nought outside the contact.
    #[must_use]
    pub fn shear(&self, radius: f64) -> f64 {
        self.shear_at(&At::radius(radius))
    }

    /// [`Contact::shear`] at each of `radii`, m: quicker than one by one.
    #[must_use]
    pub fn shears(&self, radii: &[f64]) -> Vec<f64> {
        let mut rings: Vec<_> = self.memory.rings().map(|(ring, line)| (ring, -line.slope.value())).collect();
        rings.reverse();
        let unit = self.shear_unit();
        self.profile.kernel_sums(&rings, radii).into_iter().map(|sum| unit * sum).collect()
    }

    /// G* m/pi, Pa.
    fn shear_unit(&self) -> f64 {
        self.elasticity.g_star() * self.scale() / std::f64::consts::PI
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
        self.shear_unit() * sum
    }

    /// d tau/d(r^2) but for a positive factor, from the right at a kink; nought where it is nought to round-off.
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
        if sum.abs() > NOISE * size { sum } else { 0.0 }
    }

    /// All extrema of the shear stress with their exact radii, and what they amount to.
    #[must_use]
    pub fn residual(&self) -> Residual {
        self.residual_while(|| true).unwrap_or_else(|| Residual::of(self.shear(0.0), Vec::new(), false))
    }

    /// As [`Contact::residual`], for as long as `go_on` says so, which is asked at every kink: a deep memory costs its square.
    /// `None` if it said no.
    pub fn residual_while(&self, go_on: impl Fn() -> bool) -> Option<Residual> {
        let edge = self.memory.edge().radius;
        let spikes = self.profile.singular_radii().into_iter().chain([edge]);
        let bounded = spikes.filter(|&radius| radius <= edge).all(|radius| self.shear(radius).is_finite());
        Some(Residual::of(self.shear(0.0), self.peaks(go_on)?, bounded))
    }

    fn peaks(&self, go_on: impl Fn() -> bool) -> Option<Vec<Peak>> {
        let bends = self.bends();
        let settled = self.settled_from(&bends);
        let spikes = self.profile.singular_radii();
        let pieces = self.memory.pieces();
        let mut peaks = Vec::new();
        for (index, &bend) in bends.iter().enumerate() {
            if !go_on() {
                return None;
            }
            // The interval from kink `index` (the centre for the first) out to kink `index + 1`, which bends by `bend`.
            let inner = At::point(&pieces[index].inner);
            let outer = pieces.get(index + 1).map_or(*self.memory.edge(), |next| next.inner);
            let right = if settled[index] { -bend } else { self.trend(&inner) };
            if index > 0 && bends[index - 1] * right > 0.0 {
                peaks.push(Peak { radius: inner.radius, shear: self.shear_at(&inner) });
            }
            if !settled[index] {
                let beyond = pieces.get(index + 2).map_or(*self.memory.edge(), |next| next.inner);
                let beyond = (beyond.square - outer.square).value();
                // The stress may be infinite in between, where f' jumps: no peak, but an end to be seen from both sides.
                let mut from = if index == 0 { At::radius(0.0) } else { inner };
                let within = from.radius..outer.radius;
                for &spike in spikes.iter().filter(|&spike| within.contains(spike) && *spike > within.start) {
                    let to = At::radius(spike);
                    self.smooth_extrema(&Stretch { inner: from, outer: to, end: 0.0, beyond: 0.0 }, &mut peaks);
                    from = to;
                }
                self.smooth_extrema(&Stretch { inner: from, outer: At::point(&outer), end: -bend, beyond }, &mut peaks);
            }
        }
        Some(peaks)
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

    /// Extrema strictly within a stretch.
    fn smooth_extrema(&self, stretch: &Stretch, peaks: &mut Vec<Peak>) {
        let span = (stretch.outer.square - stretch.inner.square).value();
        if span <= 0.0 {
            return;
        }
        // Times the root of the distance to the kink, whose inverse the derivative grows with, dips stand out.
        let sample = |share: f64| (share, self.trend(&stretch.at(share)) * share.sqrt());
        let mut samples: Vec<(f64, f64)> = Vec::new();
        // Nothing is beyond the edge; what is beyond a spike is unknown.
        let beyond = if stretch.beyond > 0.0 { (stretch.beyond / span).min(1.0) } else { 1.0 };
        for power in 0..SAMPLES {
            let share = SHRINK.powi(power);
            samples.push(sample(share));
            if share < FINEST * beyond {
                break;
            }
        }
        samples.push((0.0, stretch.end));
        samples.retain(|(_, value)| value.abs() > 0.0);
        let mut found = Vec::new();
        for (index, pair) in samples.windows(2).enumerate() {
            let (before, after) = (pair[0], pair[1]);
            if before.1 * after.1 < 0.0 {
                found.push(self.turn(stretch, before, after.0));
            } else if let Some(&next) = samples.get(index + 2)
                && after.1 * next.1 > 0.0
                && after.1.abs() < before.1.abs().min(next.1.abs())
                && let Some(dip) = self.dip(&sample, (before.0, next.0), after.1.signum())
            {
                // Two roots between samples of one sign.
                found.push(self.turn(stretch, before, dip.0));
                found.push(self.turn(stretch, dip, next.0));
            }
        }
        peaks.extend(found.iter().map(|root| Peak { radius: root.radius, shear: self.shear_at(root) }));
    }

    /// Where samples dip through nought against `sign` between two shares, if they do.
    fn dip(&self, sample: &impl Fn(f64) -> (f64, f64), between: (f64, f64), sign: f64) -> Option<(f64, f64)> {
        let (mut high, mut low) = between;
        for _ in 0..48 {
            let third = (high - low) / 3.0;
            let (lower, upper) = (sample(low + third), sample(high - third));
            if let Some(&through) = [lower, upper].iter().find(|point| point.1 * sign < 0.0) {
                return Some(through);
            }
            if lower.1.abs() < upper.1.abs() { high -= third } else { low += third }
        }
        None
    }

    /// Bisects for the change of sign between two shares: the derivative ends in an inverse root, which nothing quicker
    /// takes without care, and there are few of these.
    fn turn(&self, stretch: &Stretch, (mut high, sign): (f64, f64), mut low: f64) -> At {
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high || high - low < f64::EPSILON * f64::EPSILON {
                return stretch.at(middle);
            }
            if self.trend(&stretch.at(middle)) * sign > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
    }
}
