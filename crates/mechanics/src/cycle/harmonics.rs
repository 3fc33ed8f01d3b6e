//! The harmonics of a steady cycle, by quadrature over one branch.
//!
//! The drive is S0 cos(th). On the branch from the upper end the answer falls from R0 by 2 R(s) while the drive falls
//! by 2 S(s), s the displacement of a first loading: sin^2(th/2) = S(s)/S0. By parts, the odd harmonics are
//!
//! a_n = 4/(pi n) int sin(n th) dR, b_n = -4/(pi n) int cos(n th) dR,
//!
//! the even ones zero. The straight part, R = kappa S with the stiffness just after the reversal, gives kappa S0
//! cos(th); only the rest, which goes with X(d) - X(y), is integrated, so that small cycles keep the digits of their
//! higher harmonics. The integrand is smooth over the angle phi with s = s0 sin^2(phi/2), but for the tip and the kinks
//! of the profile; panels shrink towards these.

use std::f64::consts::{FRAC_PI_2, PI};

use super::SteadyCycle;
use crate::contact::normal::load;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{EIGHT_POINTS, TWENTY_POINTS};
use crate::profile::Ring;

/// The turn of the highest harmonic that a panel of twenty points follows, rad.
const TURN: f64 = 13.0;
/// The share of a panel that must lie between it and a singularity for a rule of twenty points: rho = 2.6.
const CLEARANCE: f64 = 0.56;
/// Panels are halved towards a singularity down to this angle: the integral over the rest is of its third power.
const LEAST_PANEL: f64 = 1e-5;
/// More kinks than this are not resolved one by one, but by equal panels.
const MOST_KINKS: usize = 8;
const PANELS: f64 = 16.0;

/// One harmonic of the answer to a drive that is a cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// 1 for the fundamental; even ones vanish at constant load.
    pub order: usize,
    /// The amplitude of the cosine, in the unit of the answer.
    pub in_phase: f64,
    /// The amplitude of the sine: below zero for a force that does work, above zero for a displacement.
    pub quadrature: f64,
}

/// Harmonics with their error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Harmonics {
    /// From the fundamental on.
    pub harmonics: Vec<Harmonic>,
    /// Error of each, relative to the amplitude of the answer: an estimate.
    pub error: f64,
}

impl SteadyCycle<'_> {
    /// The harmonics up to the order `count`: of the force, N, where the displacement is driven, and of the
    /// displacement at the contact, m, where the force is.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::SteadyCycle;
    ///
    /// // A ball at the onset of gross slip: 16/(5 pi) and -4/(5 pi) of mu F_N.
    /// let all = SteadyCycle::of(&contact, 0.0075).harmonics(1);
    /// let first = all.harmonics[0];
    /// assert!((first.in_phase / 2000.0 - 16.0 / (5.0 * std::f64::consts::PI)).abs() < 1e-12);
    /// assert!((first.quadrature / 2000.0 + 4.0 / (5.0 * std::f64::consts::PI)).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn harmonics(&self, count: usize) -> Harmonics {
        let branch = Branch::new(self);
        let (panels, resolved) = self.panels(count);
        let sums = branch.integrate(&panels, count, &TWENTY_POINTS);
        // Where kinks are not resolved, halves of the panels give the result, and the difference its error.
        let halves = panels.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]).chain([PI]);
        let (sums, coarser) = if resolved {
            (sums, None)
        } else {
            (branch.integrate(&halves.collect::<Vec<f64>>(), count, &TWENTY_POINTS), Some(sums))
        };
        let off = coarser.iter().flatten().flatten().zip(sums.iter().flatten()).map(|(one, other)| (one - other).abs());
        let error = 4.0 / PI * off.fold(0.0, f64::max) / branch.answer.max(f64::MIN_POSITIVE);
        branch.harmonics(&sums, count, f64::EPSILON + error)
    }

    /// The harmonics by the shorter rule alone, for a start: right to some 1e-3, of unknown error.
    pub(super) fn rough_harmonics(&self, count: usize) -> Vec<Harmonic> {
        let (branch, (panels, _)) = (Branch::new(self), self.panels(count));
        branch.harmonics(&branch.integrate(&panels, count, &EIGHT_POINTS), count, f64::INFINITY).harmonics
    }

    /// The ends of the panels of the angle from 0 to pi, and whether they resolve every kink.
    fn panels(&self, count: usize) -> (Vec<f64>, bool) {
        let widest = TURN / (count + 1) as f64;
        let (profile, ring) = (&self.contact.indenter, &self.ring);
        let angle = |depth: f64| 2.0 * depth.max(0.0).sqrt().atan2((ring.depth - depth).max(0.0).sqrt());
        let rim = profile.rim_radius();
        let inside = |radius: &f64| *radius > ring.inner.radius && *radius <= ring.outer.radius;
        let kinks: Vec<f64> = profile.knots_below(ring.outer.radius).into_iter().chain(rim).filter(inside).collect();
        // The kinks of a load curve are at levels.
        if kinks.len() > MOST_KINKS || profile.face().is_none() {
            let mut ends = vec![0.0, PI];
            split(&mut ends, widest.min(PI / PANELS));
            return (ends, false);
        }
        let mut ends = vec![0.0, PI];
        let core_level = ring.inner.level.value().max(0.0);
        if ring.depth > 0.0 {
            // The tip lies beyond the far end, at a distance along the imaginary axis.
            approach(&mut ends, PI, 2.0 * (core_level / ring.depth).sqrt().asinh());
        }
        for radius in kinks {
            let kink = angle((ring.outer.level - DoubleDouble::from(profile.level(radius))).value());
            ends.push(kink);
            approach(&mut ends, kink, 0.0);
        }
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| *a - *b <= 0.0);
        split(&mut ends, widest);
        (ends, true)
    }
}

/// The branch from the upper end, over the angle phi.
struct Branch<'a, 'b> {
    cycle: &'a SteadyCycle<'b>,
    /// Amplitude of the drive and of the answer.
    drive: f64,
    answer: f64,
    /// dR/dS just after the reversal; zero where the contact slides, and all of R is integrated.
    straight: f64,
}

impl<'a, 'b> Branch<'a, 'b> {
    fn new(cycle: &'a SteadyCycle<'b>) -> Branch<'a, 'b> {
        let stiffness = cycle.tangent_stiffness();
        let (drive, answer, straight) = if cycle.force_driven {
            (cycle.force, cycle.displacement, stiffness.recip())
        } else {
            (cycle.machine_amplitude(), cycle.force, stiffness / (1.0 + cycle.compliance * stiffness))
        };
        let straight = if cycle.slide <= 0.0 && straight.is_finite() { straight } else { 0.0 };
        Branch { cycle, drive, answer, straight }
    }

    /// The harmonics of these integrals.
    fn harmonics(&self, sums: &[[f64; 2]], count: usize, error: f64) -> Harmonics {
        let harmonic = |order: usize| {
            if order.is_multiple_of(2) {
                return Harmonic { order, in_phase: 0.0, quadrature: 0.0 };
            }
            let [sine, cosine] = sums[order / 2].map(|sum| 4.0 * sum / (PI * order as f64));
            let straight = if order == 1 { self.straight * self.drive } else { 0.0 };
            Harmonic { order, in_phase: straight + sine, quadrature: -cosine }
        };
        Harmonics { harmonics: (1..=count).map(harmonic).collect(), error }
    }

    /// int sin(n th) dR and int cos(n th) dR for odd n up to `count`, without the straight part.
    fn integrate(&self, ends: &[f64], count: usize, rule: &[(f64, f64)]) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; count.div_ceil(2)];
        if self.cycle.ring.depth <= 0.0 || self.drive <= 0.0 {
            return sums;
        }
        for pair in ends.windows(2) {
            let width = pair[1] - pair[0];
            for (offset, share) in rule {
                let ([sin, cos], weight) = self.at(pair[0] + width * offset);
                // By the recurrence of two steps: cos((n + 2) th) = 2 cos(2 th) cos(n th) - cos((n - 2) th).
                let double = 2.0 * (2.0 * cos * cos - 1.0);
                let (mut here, mut before) = ([sin, cos], [-sin, cos]);
                for sum in &mut sums {
                    sum[0] += width * share * weight * here[0];
                    sum[1] += width * share * weight * here[1];
                    let next = [double * here[0] - before[0], double * here[1] - before[1]];
                    (before, here) = (here, next);
                }
            }
        }
        sums
    }

    /// Sine and cosine of th, and d(R - kappa S)/dphi.
    fn at(&self, phi: f64) -> ([f64; 2], f64) {
        let Branch { cycle, drive, straight, .. } = *self;
        let (contact, ring) = (cycle.contact, &cycle.ring);
        let (sin, cos) = (0.5 * phi).sin_cos();
        let (fallen, standing) = (ring.depth * sin * sin, ring.depth * cos * cos);
        // From the nearer end, at which the other one is not seen.
        let level = if phi < FRAC_PI_2 {
            ring.outer.level - DoubleDouble::from(fallen)
        } else {
            ring.inner.level + DoubleDouble::from(standing)
        };
        let point = contact.indenter.point(level);
        let (scale, unit) = (contact.scale(), contact.force_unit());
        let carried = |inner, outer| unit * load(&contact.indenter, &Ring::between(inner, outer));
        let forces = if cycle.force_driven || cycle.compliance > 0.0 {
            [carried(point, ring.outer), carried(ring.inner, point)]
        } else {
            [0.0; 2]
        };
        let [gone, left] = if cycle.force_driven {
            forces
        } else {
            let machine = forces.map(|force| cycle.compliance * force);
            [scale * fallen + machine[0], scale * standing + machine[1] + cycle.slide]
        };
        let sides = [2.0 * (gone * left).max(0.0).sqrt() / drive, (left - gone) / drive];
        let stiffness = 2.0 * contact.elasticity.g_star() * point.radius;
        // X(d) - X(y), of the squares.
        let lost = (ring.outer.square - point.square).value() / (ring.outer.radius + point.radius);
        let lost = 2.0 * contact.elasticity.g_star() * lost.max(0.0);
        let rate = if straight <= 0.0 {
            stiffness
        } else if cycle.force_driven {
            lost * straight
        } else {
            -lost / (1.0 + cycle.compliance * cycle.tangent_stiffness())
        };
        (sides, rate * scale * ring.depth * sin * cos)
    }
}

/// Divides panels, given by their ends in rising order, that are wider than `widest`.
fn split(ends: &mut Vec<f64>, widest: f64) {
    for index in (1..ends.len()).rev() {
        let (low, high) = (ends[index - 1], ends[index]);
        let parts = ((high - low) / widest).ceil() as usize;
        let between = (1..parts).map(|part| low + (high - low) * part as f64 / parts as f64);
        ends.splice(index..index, between);
    }
}

/// Adds ends of panels that shrink to a quarter of each other towards `place`, down to a singularity at `distance` from
/// it.
fn approach(ends: &mut Vec<f64>, place: f64, distance: f64) {
    let mut width = PI;
    while CLEARANCE * width > distance && width > LEAST_PANEL {
        width *= 0.25;
        ends.extend([place - width, place + width].into_iter().filter(|end| (0.0..=PI).contains(end)));
    }
}
