//! The integrals of every profile over rings against quadratures of its g, by graded panels between its kinks.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::{
    Cone, ExactSphere, Family, FlatPunch, Parameter, PowerLaw, Profile, Ring, RoundedCone, RoundedPunch, Sphere,
    StressRadius, Sum, Tabulated, TruncatedCone, TruncatedSphere, families,
};
use crate::numerics::gauss::{self, TWENTY_POINTS};

fn power(exponent: f64) -> Profile {
    Profile::PowerLaw(PowerLaw::new(exponent, 0.2).unwrap())
}

fn sum(parts: Vec<Profile>) -> Profile {
    Profile::Sum(Sum::new(parts).unwrap())
}

/// Heights of uneven steps whose slope changes by any amount but falls nowhere, up to a radius of 1.3 m.
fn table() -> Profile {
    let (mut radii, mut heights, mut slope) = (vec![0.0], vec![0.0], 0.0);
    for index in 1..40_u32 {
        let step = 1.0 + 0.8 * (2.7 * f64::from(index)).sin();
        slope += (0.5 + 0.45 * (1.9 * f64::from(index)).cos()) * step;
        radii.push(radii[radii.len() - 1] + step);
        heights.push(heights[heights.len() - 1] + slope * step);
    }
    let unit = 1.3 / radii[radii.len() - 1];
    radii.iter_mut().for_each(|r| *r *= unit);
    Profile::Tabulated(Tabulated::new(&radii, &heights.iter().map(|z| 1e-4 * z).collect::<Vec<_>>()).unwrap())
}

/// Every family, its lengths tenths of a metre, and sums of them, for contact radii up to a metre.
fn profiles() -> Vec<Profile> {
    let cone = |flat| Profile::TruncatedCone(TruncatedCone::new(0.1, flat).unwrap());
    let worn = || Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap());
    let punch = |flat| Profile::RoundedPunch(RoundedPunch::new(flat, 1.0).unwrap());
    let rounded = || Profile::RoundedCone(RoundedCone::new(0.1, 0.15).unwrap());
    let ball = || Profile::ExactSphere(ExactSphere::new(1.2).unwrap());
    let sphere = || Profile::Sphere(Sphere::new(1.0).unwrap());
    let sharp = || Profile::Cone(Cone::new(0.1).unwrap());
    let of_family = |family: &&Family| {
        let number = |parameter: &Parameter| match parameter.range.unit {
            // Those of millimetres become that of the radius of a ball, those below a tenth of it.
            "m" if parameter.example >= 2e-3 => 1.2,
            "m" => 0.15,
            _ => parameter.example.min(4.0),
        };
        (family.make)(&family.parameters.iter().map(number).collect::<Vec<_>>()).unwrap()
    };
    let mut profiles: Vec<Profile> = [0.6, 1.3, 2.7, 7.0, 12.5, 60.0].map(power).into();
    profiles.extend(families().iter().map(of_family).filter(|profile| profile.indenter().rim_radius().is_none()));
    profiles.push(table());
    profiles.push(sum(vec![worn(), power(2.7), rounded(), ball()]));
    profiles.push(sum(vec![sphere(), sharp(), power(17.0)]));
    profiles.push(sum(vec![table(), punch(0.3), power(1.5)]));
    profiles.push(sum(vec![cone(0.2), punch(0.2 * (1.0 + 1e-9)), sphere()]));
    profiles
}

/// An integral over low..high of what may be singular at the lower end, and is smooth beyond.
fn graded(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut width) = (0.0, high - low);
    for _ in 0..60 {
        width *= 0.5;
        sum += gauss::integral(&TWENTY_POINTS, width, |step| f(low + width + step));
    }
    sum
}

/// An integral over radii, by t above each kink, of f(kink, t).
fn between_kinks(profile: &Profile, low: f64, high: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let t = |kink: f64, x: f64| ((x - kink) * (x + kink)).max(0.0).sqrt();
    let kinks: Vec<f64> = [0.0].into_iter().chain(profile.indenter().knots_below(high)).chain([high]).collect();
    let piece = |pair: &[f64]| {
        let (start, end) = (pair[0].max(low), pair[1].max(low));
        if end > start { graded(t(pair[0], start), t(pair[0], end), |t| f(pair[0], t)) } else { 0.0 }
    };
    kinks.windows(2).map(piece).sum()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 120, failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..ProptestConfig::default()
    })]

    #[test]
    fn integrals_over_rings_are_those_of_g(
        index in any::<prop::sample::Index>(),
        ends in (0.0..1.0_f64, 0.01..1.0_f64),
        share in 0.02..0.98_f64,
        thin in prop_oneof![Just(None), (-9.0..-2.0_f64).prop_map(Some)],
    ) {
        let profiles = profiles();
        let profile = index.get(&profiles);
        let flat = profile.indenter().radius(0.0);
        let high = flat + (1.05 - flat) * ends.0.max(ends.1);
        let low = thin.map_or(flat + (high - flat) * ends.0.min(ends.1), |power| high * (1.0 - 10f64.powf(power)));
        let low = low.max(flat);
        let shape = profile.shape().unwrap();
        let point = |x: f64| profile.indenter().point(shape.level(x).into());
        let ring = Ring::between(point(low), point(high));
        let (low, high) = (ring.inner.radius, ring.outer.radius);
        let x = |kink: f64, t: f64| kink.hypot(t);
        // By the rise from x up to the outer end, which a difference of levels would lose in a thin ring.
        let rise = |from: f64| between_kinks(profile, from, high, |kink, t| shape.gamma(kink, t));
        let close = |found: f64, exact: f64, allowed: f64| (found - exact).abs() <= allowed * exact.abs();
        let (depth, exact) = (ring.depth, rise(low));
        let allowed = 1e-12 + 4e-15 * ring.outer.level.value() / depth;
        prop_assert!(close(depth, exact, allowed), "{profile:?} {low} {high}: depth {depth} is not {exact}");
        let moments = profile.indenter().moments(&ring);
        let rounding = 1e-11 + 1e-15 * high / (high - low).max(1e-18);
        if thin.is_none() {
            let depth = |kink: f64, t: f64| ring.outer.level.value() - shape.level(x(kink, t));
            let first = between_kinks(profile, low, high, |kink, t| depth(kink, t) * t / x(kink, t).max(1e-300));
            prop_assert!(close(moments.first, first, rounding), "{profile:?} {low} {high}: {} {first}", moments.first);
        }
        prop_assert!(close(moments.width, high - low, 1e-13 + 4e-16 * high / (high - low)), "{profile:?}: width");
        let r = share * high;
        let at = StressRadius::new(r);
        let kernel = profile.indenter().kernel(&at, &ring);
        let q = |kink: f64, t: f64| shape.gamma(kink, t) / ((x(kink, t) - r) * (x(kink, t) + r)).sqrt();
        let exact = if r <= low {
            between_kinks(profile, low, high, q)
        } else {
            // Over v = sqrt(x^2 - r^2) up to the first kink beyond r.
            let first = profile.indenter().knots_below(high).into_iter().find(|kink| *kink > r).unwrap_or(high);
            let below = profile.indenter().knots_below(r.next_up()).last().copied().unwrap_or(0.0);
            let gamma_over_t = |v: f64| {
                let t = ((r - below) * (r + below) + v * v).sqrt();
                shape.gamma(below, t) / t
            };
            graded(0.0, ((first - r) * (first + r)).sqrt(), gamma_over_t) + between_kinks(profile, first, high, q)
        };
        prop_assert!(close(kernel, exact, rounding), "{profile:?} {low} {high} at {r}: {kernel} is not {exact}");
    }
}

#[test]
fn a_punch_that_ends_inside_all_flats_of_a_sum_is_a_punch() {
    let flat = |radius| Profile::TruncatedCone(TruncatedCone::new(0.1, radius).unwrap());
    let punch = || Profile::FlatPunch(FlatPunch::new(1e-3).unwrap());
    for radius in [1e-3, 2e-3] {
        let sum = sum(vec![flat(radius), punch()]);
        let ring = |profile: &Profile| {
            Ring::between(profile.indenter().point(0.0.into()), profile.indenter().point(1e-6.into()))
        };
        assert_eq!(sum.indenter().moments(&ring(&sum)), punch().indenter().moments(&ring(&punch())));
        let at = StressRadius::new(5e-4);
        assert!(
            (sum.indenter().kernel(&at, &ring(&sum)) / punch().indenter().kernel(&at, &ring(&punch())) - 1.0).abs()
                < 1e-15
        );
    }
}

#[test]
fn what_is_said_to_rise_concavely_does() {
    let punch = || Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap());
    let sphere = || Profile::Sphere(Sphere::new(1.0).unwrap());
    let mut profiles: Vec<Profile> = [1.3, 1.9, 2.0, 2.1, 2.7, 3.0, 3.9, 4.0, 4.1, 6.0].map(power).into();
    profiles.extend([sphere(), punch(), sum(vec![punch(), power(3.0), sphere()]), sum(vec![punch(), power(6.0)])]);
    profiles.push(Profile::TruncatedCone(TruncatedCone::new(0.1, 0.1).unwrap()));
    profiles.push(Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap()));
    let mut claims = 0;
    for profile in profiles {
        for inner in [0.0, 0.1, 0.2, 0.3] {
            if !profile.indenter().falls(inner, 1.0).concavely {
                continue;
            }
            claims += 1;
            let ratio = |index: u32| {
                let x = (inner * inner + 1e-3 * f64::from(index)).sqrt();
                profile.slope(x) / x
            };
            for index in 1..1000 {
                let [low, middle, high] = [index, index + 1, index + 2].map(ratio);
                let noise = 1e-13 * high;
                assert!(middle - low >= -noise, "{profile:?} falls beyond {inner} at {index}");
                assert!(high - middle <= middle - low + noise, "{profile:?} bends upward beyond {inner} at {index}");
            }
        }
    }
    // The six powers from two to four and the sphere; the punch and its sum with a cubic and a sphere from their
    // flat on.
    assert_eq!(claims, 7 * 4 + 2 * 2);
}
