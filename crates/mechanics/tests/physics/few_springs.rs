//! The error estimate of springs so few that no radius lies some cells away from centre, edge and kinks: it holds at
//! every radius, against the closed forms of a ball with a cone on it.

use crate::support::masing::Masing;
use crate::support::{Random, config, displace};
use proptest::prelude::*;
use stickslip_mechanics::profile::{Cone, Sphere, Sum};
use stickslip_mechanics::{Elasticity, Preload, Profile, Setup, Springs};

/// A paraboloid of this curvature, 1/m, and a cone of this slope, added up.
#[derive(Clone, Copy, Debug)]
struct Pointed {
    curvature: f64,
    slope: f64,
}

impl Pointed {
    fn profile(self) -> Profile {
        let ball = || Profile::Sphere(Sphere::new(1.0 / self.curvature).unwrap());
        let cone = || Profile::Cone(Cone::new(self.slope).unwrap());
        if self.slope <= 0.0 {
            ball()
        } else if self.curvature <= 0.0 {
            cone()
        } else {
            Profile::Sum(Sum::new(vec![ball(), cone()]).unwrap())
        }
    }

    /// The inverse of g = curvature x^2 + pi slope x/2, m.
    fn radius(self, level: f64) -> f64 {
        let half = std::f64::consts::FRAC_PI_4 * self.slope;
        level / (half + (half * half + self.curvature * level).sqrt())
    }

    /// F_N/E* = 4/3 curvature a^3 + pi slope a^2/2, m^2.
    fn load(self, a: f64) -> f64 {
        4.0 / 3.0 * self.curvature * a * a * a + std::f64::consts::FRAC_PI_2 * self.slope * a * a
    }

    /// p/E* = (2/pi) curvature sqrt(a^2 - r^2) + slope arcosh(a/r)/2: Hertz and Love.
    fn pressure(self, a: f64, r: f64) -> f64 {
        if r >= a {
            return 0.0;
        }
        let tip = if self.slope > 0.0 { 0.5 * self.slope * (a / r).acosh() } else { 0.0 };
        std::f64::consts::FRAC_2_PI * self.curvature * ((a - r) * (a + r)).sqrt() + tip
    }
}

/// The largest true error of the stress at `shares` of the contact radius, and the stated one.
fn errors(body: Pointed, depth: f64, count: usize, turns: &[f64], shares: &[f64]) -> (f64, f64) {
    let (e_star, g_star, friction) = (1e11, 8e10, 0.3);
    let elasticity = Elasticity::effective(e_star, g_star).unwrap();
    let setup = Setup { profile: body.profile(), elasticity, friction, preload: Preload::Indentation(depth) };
    let edge = body.radius(depth);
    let mut springs = Springs::new(setup, count, edge).unwrap();
    let mut path = Masing::new(friction * e_star / g_star * depth);
    for &turn in turns {
        springs.apply(&displace(turn)).unwrap();
        path.go(turn);
    }
    let unit = if body.slope > 0.0 {
        body.load(edge) / (std::f64::consts::PI * edge * edge)
    } else {
        body.pressure(edge, 0.0)
    };
    let worst = shares
        .iter()
        .map(|share| {
            let r = share * edge;
            let stroke = |u: f64| body.pressure(edge, r) - body.pressure(body.radius(depth * (1.0 - u).max(0.0)), r);
            let exact: f64 = path.strokes().map(|(factor, u)| factor * stroke(u)).sum();
            (springs.shear(r) / (friction * e_star) - exact).abs() / unit
        })
        .fold(0.0, f64::max);
    (worst, springs.accuracy().stress_error)
}

#[test]
fn three_springs_under_a_cone_admit_their_error() {
    let body = Pointed { curvature: 0.0, slope: 0.05 };
    let edge = body.radius(1e-5);
    let shares = [1e-5, 5e-5, 1e-4].map(|radius| radius / edge);
    let (error, estimate) = errors(body, 1e-5, 3, &[2e-6], &shares);
    assert!((0.4..0.6).contains(&error), "the error itself: {error}");
    assert!(error <= 3.0 * estimate && estimate < 100.0 * error, "{error:e}, {estimate:e}");
}

/// The true and the stated error of two to eight springs under a random body after a random path.
fn scene(random: &mut Random) -> (f64, f64) {
    let shares: Vec<f64> = (0..50).map(|index| (f64::from(index) + 0.6) / 50.0).collect();
    let (blunt, steep) = (random.within(1.0, 100.0), 10_f64.powf(random.within(-3.0, -0.5)));
    let body = match random.bits() % 3 {
        0 => Pointed { curvature: blunt, slope: 0.0 },
        1 => Pointed { curvature: 0.0, slope: steep },
        _ => Pointed { curvature: blunt, slope: steep },
    };
    let depth = 10_f64.powf(random.within(-7.0, -4.0));
    let full = 0.3 * 1e11 / 8e10 * depth;
    let size = 10_f64.powf(random.within(-2.0, 0.1));
    let count = 2 + (random.bits() % 7) as usize;
    let turns: Vec<f64> = (0..1 + random.bits() % 5).map(|_| size * full * random.within(-1.0, 1.0)).collect();
    errors(body, depth, count, &turns, &shares)
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn so_few_springs_that_every_radius_is_near_a_kink_admit_their_error_at_every_radius(seed in any::<u64>()) {
        let (error, estimate) = scene(&mut Random(seed));
        prop_assert!(error <= 3.0 * estimate, "{error:.1e}, estimated {estimate:.1e}");
    }
}

#[test]
fn the_estimate_of_so_few_springs_is_usually_within_ten_times_the_error() {
    let mut random = Random(17);
    let mut ratios: Vec<f64> = (0..500).map(|_| scene(&mut random)).map(|(error, stated)| stated / error).collect();
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!("estimate over error: {:.2} at the least, {median:.1} usually", ratios[0]);
    assert!(median < 10.0, "{median}");
}

#[test]
fn springs_that_were_never_moved_sideways_have_no_error_of_the_stress() {
    let body = Pointed { curvature: 10.0, slope: 0.05 };
    let (error, estimate) = errors(body, 1e-5, 3, &[], &[0.1, 0.5, 0.9]);
    assert!(error <= 0.0 && estimate < 1e-15, "{error:e}, {estimate:e}");
}
