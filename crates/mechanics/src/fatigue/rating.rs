//! A criterion at a place, over the curve that its stress follows in a cycle.
//!
//! Every criterion is made of largest values over the cycle of convex functions of the stress: distances from a centre,
//! normal stresses, hydrostatic stress. So the instants that carry them are found one by one: where the curve is
//! farthest from the centre of a ball, the ball grows, until it holds the whole curve (cutting planes). A critical
//! plane is sought over the samples; the best ones are then climbed with the instants that matter on them.

use std::f64::consts::{FRAC_1_SQRT_2 as SHEAR_SHARE, SQRT_2};

use super::ball::squared_distance;
use super::curve::{Allowance, Arc, CurvePeak, Instant, StressCurve, StressSample, stress};
use super::planes::{Vector, climb, peaks};
use super::{
    Ball, Criterion, deviator, dot, enclosing_ball, from_deviator, resolved, shear_axes, strained, upward, weights,
};
use crate::subsurface::Stress;

/// The hydrostatic stress over the size of a stress, at the most.
const HYDROSTATIC_SHARE: f64 = 0.577_350_269_189_625_8;
/// A ball that leaves this share of its squared radius outside holds the curve.
const HELD: f64 = 1e-11;
/// More instants than a ball or a plane ever needs; a safeguard only.
const MOST_ROUNDS: usize = 40;
/// How much more than the stress the centre of a ball moves at many places: how much it may at one is found there.
const CENTER_SHARE: f64 = 5.0;
/// Points of a ball that many errors below its surface may come to carry it.
const NEAR_SURFACE: f64 = 4.0;
/// Such points closer than this part of the radius go together.
const TOGETHER: f64 = 0.1;
/// Planes are sought over samples that are apart by this part of the farthest two.
const SEARCHED: f64 = 1.0 / 100.0;
/// The most that the other samples add to the value on a plane, over the range of the values on all.
const UNSEEN: f64 = 0.06;
/// Peaks over all planes that are climbed.
const CLIMBED: usize = 6;
/// Cosine of the angle below which two of them are one.
const SAME_PEAK: f64 = 0.9999;
/// The first step of such a climb, and the change over the value that ends it.
const CLIMB_STEP: f64 = 0.02;
const SETTLED: f64 = 1e-9;

/// A quantity that is computed at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// A criterion of stress.
    Stress(Criterion),
    /// Amplitude of the shear stress times that of the slip at the surface, N/m (Ruiz, Boddington & Chen 1984). It has
    /// no limit of its own: compare places and cycles by it.
    Ruiz,
    /// That times the largest tension along x, zero where there is none, N^2/m^3.
    RuizTension,
    /// Friction work per area and cycle at the surface, J/m^2.
    FrictionWork,
}

/// A measure at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rated {
    /// In the unit of the measure; infinite where a stress is, and no number below the surface if it is of the surface.
    pub value: f64,
    /// The estimated distance from the value over the whole cycle.
    pub error: f64,
    /// Unit normal, z not negative, of the critical plane, if the criterion has one. Where several planes have the
    /// largest value, as mirror images do, it is one of them.
    pub plane: Option<[f64; 3]>,
    /// The critical instant: of the largest hydrostatic stress (Crossland), of the largest sum (Dang Van), of the
    /// largest normal stress on the plane (the others).
    pub at: Option<Instant>,
}

impl Measure {
    /// Whether it is of the surface alone.
    #[must_use]
    pub fn of_surface(&self) -> bool {
        !matches!(self, Measure::Stress(_))
    }

    /// By how much the value may change, over the change of a stress, where stresses are up to `largest`, Pa.
    pub(super) fn sensitivity(&self, largest: f64) -> f64 {
        match *self {
            Measure::Stress(Criterion::Crossland { alpha }) => SHEAR_SHARE + alpha * HYDROSTATIC_SHARE,
            Measure::Stress(Criterion::DangVan { alpha }) => CENTER_SHARE * SHEAR_SHARE + alpha * HYDROSTATIC_SHARE,
            Measure::Stress(Criterion::Findley { k }) => SHEAR_SHARE + k,
            Measure::Stress(Criterion::SmithWatsonTopper { youngs_modulus, .. }) => 2.6 * largest / youngs_modulus,
            Measure::Stress(Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson }) => {
                let shear_modulus = 0.5 * youngs_modulus / (1.0 + poisson);
                (SHEAR_SHARE * (1.0 + k * largest / yield_stress) + SHEAR_SHARE * k * largest / yield_stress)
                    / shear_modulus
            }
            Measure::Ruiz | Measure::RuizTension | Measure::FrictionWork => 0.0,
        }
    }

    /// Its value over a curve, with an instant in the parts of that, on planes `near` one if that is given.
    pub(super) fn over(&self, curve: &StressCurve, friction: f64, near: Option<Vector>) -> Rated {
        let largest = curve.samples().map(|(_, sample)| stress(sample).norm()).fold(0.0, f64::max);
        let off = self.sensitivity(largest) * curve.error.stress;
        match self {
            Measure::Stress(criterion @ (Criterion::Crossland { alpha } | Criterion::DangVan { alpha })) => {
                let (ball, points, outside) = deviator_ball(curve);
                if matches!(criterion, Criterion::Crossland { .. }) {
                    let peak = peak_of(curve, |sample| stress(sample).hydrostatic());
                    let value = ball.radius / SQRT_2 + alpha * peak.value;
                    Rated { value, error: off + outside, plane: None, at: Some(peak.at) }
                } else {
                    let peak = peak_of(curve, |sample| tresca(sample, &ball, *alpha));
                    let allowed = curve.error.stress + outside;
                    let error =
                        (SHEAR_SHARE + alpha * HYDROSTATIC_SHARE) * allowed + drift_of_centre(&ball, points, allowed);
                    Rated { value: peak.value, error, plane: None, at: Some(peak.at) }
                }
            }
            Measure::Stress(criterion) => on_worst_plane(criterion, curve, off, near),
            Measure::FrictionWork => {
                let [work, error] = curve.work().map(|work| friction * work);
                Rated { value: work, error, plane: None, at: None }
            }
            Measure::Ruiz | Measure::RuizTension => {
                let [shear, slip] = [(7, false), (8, true)].map(|(index, inside)| {
                    let wanted = |arc: &Arc| arc.touched || !inside;
                    let end = |sign: f64| {
                        let peak = curve.peak(wanted, |sample| sign * sample[index]);
                        peak.map_or(0.0, |peak| peak.value)
                    };
                    (0.5 * (end(1.0) + end(-1.0))).max(0.0)
                });
                let tension = curve.peak(|_| true, |sample| sample[0]).map_or(0.0, |peak| peak.value.max(0.0));
                let Allowance { stress, slip: off } = curve.error;
                let (value, error) = (shear * slip, shear * off + stress * slip);
                if matches!(self, Measure::Ruiz) {
                    Rated { value, error, plane: None, at: None }
                } else {
                    Rated { value: tension * value, error: tension * error + stress * value, plane: None, at: None }
                }
            }
        }
    }
}

fn peak_of(curve: &StressCurve, value: impl FnMut(&StressSample) -> f64) -> CurvePeak {
    let none = CurvePeak { value: 0.0, sample: [0.0; 9], at: Instant { step: 0, part: 1.0 } };
    curve.peak(|_| true, value).unwrap_or(none)
}

/// Tresca's shear stress about the centre of the ball, and the share of the hydrostatic stress.
fn tresca(sample: &StressSample, ball: &Ball<5>, alpha: f64) -> f64 {
    let stress = stress(sample);
    (stress + from_deviator(&ball.center) * -1.0).max_shear() + alpha * stress.hydrostatic()
}

/// The smallest ball around the deviators of a curve, its points, and how far the curve leaves it, Pa.
fn deviator_ball(curve: &StressCurve) -> (Ball<5>, Vec<[f64; 5]>, f64) {
    let mut points: Vec<[f64; 5]> = curve.samples().map(|(_, sample)| deviator(&stress(sample))).collect();
    let (ball, outside) = grown(&mut points, |center| {
        let far = |sample: &StressSample| squared_distance(&deviator(&stress(sample)), center);
        let peak = peak_of(curve, far);
        (deviator(&stress(&peak.sample)), peak.value)
    });
    (ball, points, outside)
}

/// How far Tresca's shear stress about the centre may be off, Pa, if the points are by `error`: the sum of what it is
/// between the centre and those of balls for which one part of the points at the surface lies so much farther out.
fn drift_of_centre(ball: &Ball<5>, mut points: Vec<[f64; 5]>, error: f64) -> f64 {
    if ball.radius <= error {
        // No centre of the points as they are is farther away than the points may be.
        return ball.radius + error;
    }
    let within = (ball.radius - NEAR_SURFACE * error).max(0.0);
    points.retain(|point| squared_distance(point, &ball.center) >= within * within);
    let mut moved = vec![false; points.len()];
    let mut sum = 0.0;
    while let Some(first) = moved.iter().position(|moved| !moved) {
        let from = points[first];
        let mut farther = points.clone();
        for (index, point) in points.iter().enumerate() {
            if !moved[index] && squared_distance(point, &from) <= (TOGETHER * ball.radius).powi(2) {
                moved[index] = true;
                let out = 1.0 + error / ball.radius;
                farther[index] = std::array::from_fn(|i| ball.center[i] + out * (point[i] - ball.center[i]));
            }
        }
        let center = enclosing_ball(&farther).center;
        sum += from_deviator(&std::array::from_fn(|i| center[i] - ball.center[i])).max_shear();
    }
    sum
}

/// The ball around some points and the farthest that a curve has from its centre, again and again; and how far it
/// still leaves the curve outside.
fn grown<const N: usize>(
    points: &mut Vec<[f64; N]>,
    mut farthest: impl FnMut(&[f64; N]) -> ([f64; N], f64),
) -> (Ball<N>, f64) {
    let mut ball = enclosing_ball(points);
    for _ in 0..MOST_ROUNDS {
        let (point, square) = farthest(&ball.center);
        let reach = ball.radius * ball.radius;
        if square <= reach * (1.0 + HELD) {
            return (ball, 0.0);
        }
        points.push(point);
        let next = enclosing_ball(points);
        if next.radius <= ball.radius {
            break;
        }
        ball = next;
    }
    let outside = farthest(&ball.center).1.sqrt() - ball.radius;
    (ball, outside.max(0.0))
}

/// The planes on which a criterion may be largest.
fn candidates(criterion: &Criterion, curve: &StressCurve) -> Vec<Vector> {
    let opening = peak_of(curve, |sample| stress(sample).principal()[0]);
    let mut few = vec![stress(&opening.sample)];
    let apart = |one: &Stress, other: &Stress| (*one + *other * -1.0).norm();
    let samples = || curve.samples().map(|(_, sample)| stress(sample));
    let farthest = samples().map(|other| apart(&few[0], &other)).fold(0.0, f64::max);
    for sample in samples() {
        if apart(&few[few.len() - 1], &sample) > SEARCHED * farthest {
            few.push(sample);
        }
    }
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let found = peaks(&criterion.starts(&few), |normal| {
        let value = criterion.on_plane(&few, normal).0;
        range = [range[0].min(value), range[1].max(value)];
        value
    });
    let least = found[0].0 - UNSEEN * (range[1] - range[0]);
    // Searches from several planes end at one peak.
    let mut normals: Vec<Vector> = Vec::with_capacity(CLIMBED);
    for (_, normal) in found.into_iter().take_while(|peak| peak.0 >= least) {
        if normals.len() < CLIMBED && normals.iter().all(|other| dot(other, &normal).abs() < SAME_PEAK) {
            normals.push(normal);
        }
    }
    normals
}

/// The largest value over all planes, or those near one.
fn on_worst_plane(criterion: &Criterion, curve: &StressCurve, off: f64, near: Option<Vector>) -> Rated {
    let mut path: Vec<Stress> = curve.samples().map(|(_, sample)| stress(sample)).collect();
    let normals = near.map_or_else(|| candidates(criterion, curve), |normal| vec![normal]);
    let mut best = Rated { value: f64::NEG_INFINITY, error: off, plane: None, at: None };
    for mut normal in normals {
        let mut value = f64::NEG_INFINITY;
        for round in 0..MOST_ROUNDS {
            let at = add_support_stresses(criterion, curve, &normal, &mut path);
            let (here, _) = criterion.on_plane(&path, &normal);
            if here > best.value {
                best = Rated { value: here, plane: Some(upward(normal)), at: Some(at), ..best };
            }
            if here - value <= SETTLED * here.abs() || round > 6 {
                break;
            }
            value = here;
            let step = if round == 0 { CLIMB_STEP } else { 0.1 * CLIMB_STEP };
            normal = climb((here, normal), step, |normal| criterion.on_plane(&path, normal).0).1;
        }
    }
    best
}

/// Adds the stresses that matter on a plane, and says when its normal stress is largest.
fn add_support_stresses(
    criterion: &Criterion,
    curve: &StressCurve,
    normal: &Vector,
    path: &mut Vec<Stress>,
) -> Instant {
    let along = weights(normal, normal);
    let opening = peak_of(curve, |sample| resolved(&stress(sample), &along));
    path.push(stress(&opening.sample));
    if let Criterion::SmithWatsonTopper { poisson, .. } = criterion {
        for sign in [1.0, -1.0] {
            let strain = |sample: &StressSample| sign * strained(&stress(sample), &along, *poisson);
            path.push(stress(&peak_of(curve, strain).sample));
        }
        return opening.at;
    }
    let [one, two] = shear_axes(normal);
    let shear = |stress: &Stress| [resolved(stress, &one), resolved(stress, &two)];
    let mut shears: Vec<[f64; 2]> = path.iter().map(shear).collect();
    grown(&mut shears, |center| {
        let far = peak_of(curve, |sample| squared_distance(&shear(&stress(sample)), center));
        path.push(stress(&far.sample));
        (shear(&stress(&far.sample)), far.value)
    });
    opening.at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_center_moves_no_farther_than_it_is_said_to() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut any = |size: f64| std::array::from_fn::<f64, 5, _>(|_| size * (2.0 * random.f64() - 1.0));
        let mut most = 0.0_f64;
        for case in 0..400 {
            // Flat balls, which are carried by three to six points, and some inside.
            let flat = [1.0, 0.1, 0.01][case % 3];
            let points: Vec<[f64; 5]> =
                (0..9).map(|_| any(1.0)).map(|[a, b, c, d, e]| [a, flat * b, flat * c, flat * d, flat * e]).collect();
            let error = [1e-3, 1e-5, 1e-7][case % 7 % 3];
            let ball = enclosing_ball(&points);
            let allowed = SHEAR_SHARE * error + drift_of_centre(&ball, points.clone(), error);
            for _ in 0..8 {
                let moved = points.iter().map(|point| {
                    let off = any(error / 5f64.sqrt());
                    std::array::from_fn(|i| point[i] + off[i])
                });
                let center = enclosing_ball(&moved.collect::<Vec<[f64; 5]>>()).center;
                let off = from_deviator(&std::array::from_fn(|i| center[i] - ball.center[i])).max_shear();
                most = most.max(off / error);
                assert!(off <= 3.0 * allowed, "{case}: {off:e} {allowed:e}");
            }
        }
        assert!(most > 3.0, "{most}");
    }
}
