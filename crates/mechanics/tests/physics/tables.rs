//! Tables against the bodies that they were taken from. `--nocapture` prints the numbers of `docs/tables.md`.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use crate::support::quadrature::integral;
use crate::support::{config, displace};
use proptest::prelude::*;
use stickslip_mechanics::profile::{ExactSphere, Sphere, Tabulated};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Profile, Setup};

/// A contact of radius 0.5 under the unit ball, or the table of it, after half a loading and half of that back.
fn moved(profile: Profile) -> Contact {
    let elasticity = Elasticity::effective(1.0, 0.8).unwrap();
    let mut contact =
        Contact::new(Setup { profile, elasticity, friction: 0.5, preload: Preload::ContactRadius(0.5) }).unwrap();
    let full = contact.summary().gross_slip_displacement;
    contact.apply(&displace(0.5 * full)).unwrap();
    contact.apply(&displace(0.25 * full)).unwrap();
    contact
}

/// Errors of F_x over mu F_N and of tau over mu p_max (off the kinks), and their estimates.
fn errors(count: u32) -> [f64; 4] {
    let radii: Vec<f64> = (0..=count).map(|i| 0.6 * f64::from(i) / f64::from(count)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / (1.0 + (1.0 - r * r).sqrt())).collect();
    let table = moved(Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()));
    let exact = moved(Profile::ExactSphere(ExactSphere::new(1.0).unwrap()));
    let figures = exact.summary();
    let limit = figures.gross_slip_force / figures.normal_force * figures.max_pressure.unwrap();
    let off_the_kinks = |i: &u32| ![0.27, 0.37, 0.5].iter().any(|kink| (0.0025 * f64::from(*i) - kink).abs() < 0.03);
    let stresses = (0..200)
        .filter(off_the_kinks)
        .map(|i| 0.0025 * f64::from(i))
        .map(|r| (table.shear(r) - exact.shear(r)).abs() / limit);
    let estimate = table.accuracy();
    let force = (table.force() - exact.force()).abs() / figures.gross_slip_force;
    [force, stresses.fold(0.0, f64::max), estimate.force_error, estimate.stress_error]
}

#[test]
fn tables_of_a_ball_converge_and_say_how_far_they_are() {
    println!("| points | force | stress | force, estimated | stress, estimated |");
    let mut rows = Vec::new();
    for count in [8, 16, 32, 64, 128, 256, 512] {
        let row = errors(count);
        println!("| {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} |", count + 1, row[0], row[1], row[2], row[3]);
        assert!(row[0] <= 3.0 * row[2] && row[1] <= 3.0 * row[3], "{count}: {row:?}");
        rows.push(row);
    }
    // With four times the points all fall at least tenfold: the order is two and more.
    for pair in rows.windows(3) {
        assert!(pair[2].iter().zip(pair[0]).all(|(now, before)| *now < 0.1 * before), "{pair:?}");
    }
}

#[test]
fn a_tabulated_parabola_is_the_sphere() {
    let mut radii: Vec<f64> = (0..60u32).map(|i| 1e-5 * f64::from(i) * (1.0 + 0.3 * f64::from(i).sin())).collect();
    radii.sort_by(f64::total_cmp);
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02).collect();
    let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
    let sphere = Profile::Sphere(Sphere::new(0.01).unwrap());
    for share in [1e-3, 0.1, 0.5, 0.99] {
        let x = share * radii[59];
        assert!((table.indenter().level(x) / sphere.indenter().level(x) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_hollow_is_refused_where_g_falls() {
    let radii: Vec<f64> = (0..100u32).map(|i| 0.01 * f64::from(i)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r - 0.9 * r.powi(4)).collect();
    let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
    let limit = table.indenter().limit_radius().unwrap();
    // g = 2 x^2 - 0.9 (8/3) x^4: g' = 0 at x^2 = 4/9.6.
    assert!((limit - (4.0f64 / 9.6).sqrt()).abs() < 2e-3, "{limit}");
    assert_eq!(table.indenter().check_radius(limit), Err(Error::NotConvexEnough { radius: limit }));
    let hole: Vec<f64> = radii.iter().map(|r| -r * r).collect();
    assert!(matches!(Tabulated::new(&radii, &hole), Err(Error::NotConvexEnough { radius }) if radius <= 0.0));
}

#[test]
fn the_interpolation_converges() {
    // f = cosh r - 1; g to 17 digits by quadrature of f'(x sin q) at x = 1: sum over n of x^(2n) (2n)!!/(2n -
    // 1)!!/(2n)!.
    let exact: f64 = (1..12u32)
        .map(|n| {
            (1..=n).map(|k| f64::from(2 * k) / f64::from(2 * k - 1)).product::<f64>()
                / (1..=2 * n).map(f64::from).product::<f64>()
        })
        .sum();
    let error = |n: u32| {
        let radii: Vec<f64> = (0..=n).map(|i| 1.5 * f64::from(i) / f64::from(n)).collect();
        let heights: Vec<f64> = radii.iter().map(|r| r.cosh() - 1.0).collect();
        (Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()).indenter().level(1.0) / exact - 1.0).abs()
    };
    let errors: Vec<f64> = [15, 30, 60, 120, 240].into_iter().map(error).collect();
    assert!(errors.windows(2).all(|pair| pair[1] < 0.19 * pair[0]), "{errors:?}");
}

#[test]
fn amplified_noise() {
    let radii: Vec<f64> = (0..=500u32).map(|i| 2e-6 * f64::from(i)).collect();
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 33).unwrap()) / f64::from(1u32 << 31) - 0.5
    };
    let sigma = 1e-12 / 12f64.sqrt();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02 + 1e-12 * random()).collect();
    let table = Tabulated::new(&radii, &heights).unwrap();
    assert!((table.height_noise() / sigma - 1.0).abs() < 0.1, "{}", table.height_noise() / sigma);
    assert!((20.0..50.0).contains(&table.noise_amplification(1e-3)), "{}", table.noise_amplification(1e-3));
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn at_the_knots_of_a_tabulated_parabola_the_surface_moves_as_under_a_sphere(
        curvature in 0.01..1.0_f64,
        count in 6_usize..60,
        uneven in prop::collection::vec(-0.3..0.3_f64, 60),
        slide in 0.05..0.95_f64,
    ) {
        let radii: Vec<f64> = (0..=count)
            .map(|i| if i == 0 { 0.0 } else { 1e-3 * (i as f64 + uneven[i - 1]) / count as f64 })
            .collect();
        let heights: Vec<f64> = radii.iter().map(|r| 0.5 * r * r / curvature).collect();
        let edge = 0.8e-3;
        let depth = edge * edge / curvature;
        let (friction, elasticity) = (0.3, Elasticity::effective(1e11, 8e10).unwrap());
        let ratio = friction * elasticity.e_star() / elasticity.g_star();
        let profile = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
        let preload = Preload::Indentation(depth);
        let mut table = Contact::new(Setup { profile, elasticity, friction, preload }).unwrap();
        table.apply(&displace(slide * ratio * depth)).unwrap();
        let stick = ((1.0 - slide) * depth * curvature).sqrt();
        for &r in &radii[1..] {
            let angle = |x: f64| if x < r { x.atan2(((r - x) * (r + x)).sqrt()) } else { FRAC_PI_2 };
            let slipped = |turn: f64| depth - (r * turn.sin()).powi(2) / curvature;
            let slipped = integral(&slipped, angle(stick), angle(edge), 1e-16 * depth);
            let expected = ratio * FRAC_2_PI * (slide * depth * angle(stick) + slipped);
            let error = (table.surface_displacement(r) / expected - 1.0).abs();
            prop_assert!(error < 1e-12, "at {r:e} m off by {error:e}");
        }
    }
}
