//! What follows for every family, against what closed families say themselves.

use super::super::{
    Cone, DoubleDouble, ExactSphere, PowerLaw, Profile, Ring, RoundedCone, RoundedPunch, Sphere, StressRadius, Sum,
    TruncatedCone, TruncatedSphere,
};
use super::{KernelOrder, Kink, Moments, Shape, ShapeFacts, displacement_integral, span};

fn power(exponent: f64) -> Profile {
    Profile::PowerLaw(PowerLaw::new(exponent, 0.2).unwrap())
}

fn sum(parts: Vec<Profile>) -> Profile {
    Profile::Sum(Sum::new(parts).unwrap())
}

/// A family that is known by its g, its slope and its kinks alone.
struct Plain<'a>(&'a Profile);

impl Shape for Plain<'_> {
    fn level(&self, radius: f64) -> f64 {
        self.0.level(radius)
    }

    fn slope(&self, radius: f64) -> f64 {
        self.0.slope(radius)
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.0.surface_slope(r)
    }

    fn facts(&self) -> ShapeFacts {
        Shape::facts(self.0)
    }

    fn kinks(&self) -> Vec<Kink> {
        Shape::kinks(self.0)
    }

    fn kink_below(&self, radius: f64) -> f64 {
        self.0.kink_below(radius)
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        self.0.slopes(base, t)
    }
}

#[test]
fn all_that_follows_from_g_is_what_closed_forms_say() {
    let cone = |flat| Profile::TruncatedCone(TruncatedCone::new(0.1, flat).unwrap());
    let worn = || Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap());
    let punch = || Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap());
    let rounded = || Profile::RoundedCone(RoundedCone::new(0.1, 0.15).unwrap());
    let ball = || Profile::ExactSphere(ExactSphere::new(1.2).unwrap());
    let families = [
        Profile::Sphere(Sphere::new(1.0).unwrap()),
        ball(),
        Profile::Cone(Cone::new(0.1).unwrap()),
        power(1.3),
        power(2.7),
        power(4.0),
        power(12.5),
        cone(0.15),
        worn(),
        punch(),
        rounded(),
        sum(vec![worn(), power(2.7), rounded(), ball()]),
    ];
    for profile in families {
        let plain = Plain(&profile);
        let close = |ours: f64, exact: f64, allowed: f64, what: &str| {
            assert!((ours - exact).abs() <= allowed * exact.abs(), "{what} of {profile:?}: {ours:e} is not {exact:e}");
        };
        for radius in [0.21, 1.1] {
            let level = DoubleDouble::from(profile.level(radius));
            close(plain.square(level).value(), Shape::square(&profile, level).value(), 1e-14, "X^2");
            let load = Shape::load(&profile, radius);
            close(plain.load(radius), load, 1e-13, "load");
            close(plain.indentation_for(load), profile.indentation_for(load), 1e-13, "indentation");
        }
        for [low, high] in [[0.0, 0.4], [0.05, 0.3], [0.25, 0.4], [0.3, 0.300_01], [0.3, 0.300_000_000_1], [0.21, 1.1]]
        {
            let ring =
                Ring::between(profile.point(profile.level(low).into()), profile.point(profile.level(high).into()));
            let (ours, exact) = (span(&plain, &ring), span(&profile, &ring));
            close(ours.gap, exact.gap, 1e-13, "gap");
            close(plain.rise(&exact), profile.rise(&exact), 1e-13, "rise");
            let parts = |moments: Moments| [moments.width, moments.first, moments.second];
            let top = profile.level(exact.outer_radius);
            let pairs = parts(plain.moments(&exact, top)).into_iter().zip(parts(Shape::moments(&profile, &exact, top)));
            for (ours, exact) in pairs {
                close(ours, exact, 1e-12, "moment");
            }
            for share in [0.01, 0.31, 0.61, 0.87, 0.999] {
                let at = StressRadius::new(share * high);
                let kernel = |order| (plain.kernel(order, &at, &exact), Shape::kernel(&profile, order, &at, &exact));
                let (ours, exact_kernel) = kernel(KernelOrder::Value);
                close(ours, exact_kernel, 1e-12, "kernel");
                let (ours, exact_slope) = kernel(KernelOrder::Slope);
                // Where two terms nearly cancel, what a closed form leaves of them.
                let terms = exact_slope.abs() + exact_kernel / (high * high);
                assert!(
                    (ours - exact_slope).abs() <= 1e-10 * terms,
                    "slope of {profile:?}: {ours:e} is not {exact_slope:e}"
                );
                let integrals = displacement_integral(&plain, &at, &exact);
                close(integrals, displacement_integral(&profile, &at, &exact), 1e-12, "displacement");
            }
        }
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
            if !profile.falls(inner, 1.0).concavely {
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
