//! Steady cycles against closed forms, against loops that are stepped, and against sums over the loop.

use std::f64::consts::PI;

use proptest::prelude::*;
use stickslip_mechanics::cycle::{Drive, SteadyCycle};
use stickslip_mechanics::profile::{
    Cone, ExactSphere, FlatPunch, PowerLaw, RoundedCone, RoundedPunch, Sum, Tabulated, TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Regime, Setup, Sphere};

use crate::support::quadrature::integral;
use crate::support::{config, displace};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;
const SCALE: f64 = FRICTION * E_STAR / G_STAR;

fn contact(profile: Profile, depth: f64) -> Contact {
    let elasticity = Elasticity::effective(E_STAR, G_STAR).unwrap();
    Contact::new(Setup { profile, elasticity, friction: FRICTION, preload: Preload::Indentation(depth) }).unwrap()
}

/// g = x^2 at d = 1: the sphere of radius one.
fn unit_sphere() -> Contact {
    contact(Profile::Sphere(Sphere::new(1.0).unwrap()), 1.0)
}

fn shapes() -> Vec<(Profile, f64)> {
    let radii: Vec<f64> = (0..=40).map(|index| f64::from(index) * 3e-5).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02 * (1.0 + 500.0 * r)).collect();
    let power = |n, c| Profile::PowerLaw(PowerLaw::new(n, c).unwrap());
    let sphere = || Profile::Sphere(Sphere::new(0.01).unwrap());
    vec![
        (sphere(), 3e-6),
        (Profile::ExactSphere(ExactSphere::new(0.01).unwrap()), 1e-4),
        (Profile::Cone(Cone::new(0.05).unwrap()), 1e-5),
        (power(1.5, 1.0), 3e-6),
        (power(4.0, 1e6), 3e-6),
        (power(2.7, 1e3), 3e-6),
        (Profile::TruncatedCone(TruncatedCone::new(0.05, 1e-4).unwrap()), 1e-5),
        (Profile::TruncatedSphere(TruncatedSphere::new(0.01, 1e-4).unwrap()), 3e-6),
        (Profile::RoundedPunch(RoundedPunch::new(1e-4, 0.01).unwrap()), 3e-6),
        (Profile::RoundedCone(RoundedCone::new(0.05, 1e-4).unwrap()), 1e-5),
        (Profile::Sum(Sum::new(vec![sphere(), power(4.0, 1e6)]).unwrap()), 3e-6),
        (Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()), 3e-6),
        (Profile::FlatPunch(FlatPunch::new(1e-3).unwrap()), 1e-6),
    ]
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} is not {expected:e}");
}

#[test]
fn work_and_describing_function_are_those_of_closed_forms() {
    let ball = unit_sphere();
    // oint q dW, q = F/(2 G* m).
    let work = |cycle: &SteadyCycle<'_>| cycle.dissipated_energy() / (2.0 * G_STAR * SCALE * SCALE);
    close(work(&SteadyCycle::of(&ball, 0.9 * SCALE)), 0.349_307_522_852_4, 1e-12);
    let quartic = Profile::PowerLaw(PowerLaw::new(4.0, 1.0).unwrap());
    // g = kappa x^4 with kappa = 8/3, so X = (y/kappa)^(1/4).
    let quartic = contact(quartic, 1.0);
    close(work(&SteadyCycle::of(&quartic, 0.3 * SCALE)) * (8.0_f64 / 3.0).powf(0.25), 0.005_104_349_766_7, 1e-11);
    let limit = FRICTION * ball.normal_force();
    for (share, in_phase, quadrature) in
        [(0.5, 0.647_223_121_426_06, -0.046_340_957_700_298), (1.0, 16.0 / (5.0 * PI), -4.0 / (5.0 * PI))]
    {
        let found = SteadyCycle::of(&ball, share * SCALE).harmonics(1).harmonics[0];
        close(found.in_phase / limit, in_phase, 1e-12);
        close(found.quadrature / limit, quadrature, 1e-12);
    }
}

#[test]
fn the_work_of_small_cycles_grows_with_the_cube_of_the_amplitude_to_all_digits() {
    let ball = unit_sphere();
    // D = (2/3) mu F_N'' U0^3/m^2 with F_N = 4/3 E* d^(3/2), and the next term of its series.
    for power in 1..=12 {
        let share = 10_f64.powi(-power);
        let leading = 2.0 / 3.0 * FRICTION * E_STAR * share.powi(3) * SCALE;
        let found = SteadyCycle::of(&ball, share * SCALE).dissipated_energy() / leading;
        let expected = 1.0 + share / 4.0 + 9.0 / 80.0 * share * share;
        assert!((found - expected).abs() < 2e-14 + 0.1 * share.powi(3), "{share:e}: {found}, not {expected}");
    }
}

/// The state after the moves U0, -U0, U0, and the work of the last two.
fn stepped(virgin: &Contact, amplitude: f64) -> (Contact, f64) {
    let mut contact = virgin.clone();
    contact.apply(&displace(amplitude)).unwrap();
    let before = contact.state().dissipated_energy;
    contact.apply(&displace(-amplitude)).unwrap();
    contact.apply(&displace(amplitude)).unwrap();
    let work = contact.state().dissipated_energy - before;
    (contact, work)
}

#[test]
fn every_shape_gives_the_loop_that_stepping_gives() {
    for (profile, depth) in shapes() {
        let virgin = contact(profile.clone(), depth);
        let full = virgin.gross_slip_displacement();
        for share in [1e-6, 0.01, 0.3, 0.7, 0.999, 1.0, 1.5] {
            let amplitude = share * full;
            let cycle = SteadyCycle::of(&virgin, amplitude);
            let (turned, work) = stepped(&virgin, amplitude);
            let state = turned.state();
            let unit = FRICTION * virgin.normal_force() * amplitude;
            assert!((cycle.dissipated_energy() - work).abs() <= 1e-12 * unit, "{profile:?} {share}: {work:e}");
            close(cycle.force_amplitude(), state.force, 1e-13);
            close(cycle.max_elastic_energy(), state.elastic_energy, 1e-11);
            close(cycle.secant_stiffness(), state.force / amplitude, 1e-13);
            assert!((cycle.stick_radius() - state.stick_radius).abs() <= 1e-13 * state.contact_radius);
            assert_eq!(cycle.regime(), state.regime, "{profile:?} {share}");
            // Where the branch from the upper end has no force.
            let mut zero = turned.clone();
            let at = cycle.sliding_ratio().unwrap() * amplitude;
            zero.apply(&displace(at)).unwrap();
            assert!(zero.force().abs() <= 1e-12 * state.force, "{profile:?} {share}: {:e}", zero.force() / state.force);
            // Just after a reversal.
            let mut back = turned.clone();
            back.apply(&displace(amplitude - 1e-9 * full)).unwrap();
            let tangent = (state.force - back.force()) / (1e-9 * full);
            assert!(tangent <= cycle.tangent_stiffness() * (1.0 + 1e-6), "{profile:?} {share}");
        }
    }
}

#[test]
fn harmonics_are_those_of_many_points_of_the_stepped_loop() {
    const POINTS: usize = 1024;
    for (profile, depth) in shapes() {
        let virgin = contact(profile.clone(), depth);
        for (share, compliance) in [(0.4, 0.0), (0.95, 0.0), (1.4, 0.0), (0.6, 1.0)] {
            let compliance = compliance / (2.0 * G_STAR * virgin.contact_radius());
            let amplitude = share * virgin.gross_slip_displacement();
            let cycle = SteadyCycle::driven(&virgin, Drive::Displacement(amplitude), compliance).unwrap();
            let (turned, _) = stepped(&virgin, cycle.displacement_amplitude());
            let mut branch = turned.clone();
            let mut sums = [[0.0; 2]; 5];
            for index in 0..POINTS {
                // The middle of each of many equal steps of the angle.
                let angle = PI * (index as f64 + 0.5) / POINTS as f64;
                let wanted = amplitude * angle.cos();
                // At the machine: U + C F = wanted, by bisection on the exact branch.
                let force_at = |u: f64| {
                    let mut tried = branch.clone();
                    tried.apply(&displace(u)).unwrap();
                    (tried.force(), tried)
                };
                let (mut low, mut high) = (-cycle.displacement_amplitude(), branch.state().displacement);
                if compliance > 0.0 {
                    for _ in 0..60 {
                        let middle = 0.5 * (low + high);
                        if middle + compliance * force_at(middle).0 > wanted { high = middle } else { low = middle }
                    }
                } else {
                    high = wanted;
                }
                let (force, moved) = force_at(high);
                branch = moved;
                for (order, sum) in sums.iter_mut().enumerate() {
                    let (sin, cos) = ((order + 1) as f64 * angle).sin_cos();
                    sum[0] += 2.0 / POINTS as f64 * force * cos;
                    sum[1] += 2.0 / POINTS as f64 * force * sin;
                }
            }
            let found = cycle.harmonics(5);
            for (harmonic, sum) in found.harmonics.iter().zip(sums) {
                if harmonic.order % 2 == 0 {
                    assert_eq!((harmonic.in_phase, harmonic.quadrature), (0.0, 0.0));
                    continue;
                }
                let unit = cycle.force_amplitude();
                let off = (harmonic.in_phase - sum[0]).abs().max((harmonic.quadrature - sum[1]).abs()) / unit;
                assert!(
                    off <= 8e-6 + found.error,
                    "{profile:?} {share} {compliance:e}: {off:e} of {harmonic:?}, {sum:?}"
                );
            }
            assert!(found.error < 1e-7, "{profile:?} {share}: {:e}", found.error);
        }
    }
}

#[test]
fn the_first_quadrature_is_the_work_whatever_is_driven() {
    for (profile, depth) in shapes() {
        let virgin = contact(profile.clone(), depth);
        let limit = FRICTION * virgin.normal_force();
        let full = virgin.gross_slip_displacement();
        for compliance in [0.0, 0.3 * full / limit] {
            for share in [1e-5, 0.1, 0.5, 0.9, 1.0 - 1e-9] {
                for drive in [Drive::Displacement(1.3 * share * full), Drive::Force(share * limit)] {
                    let cycle = SteadyCycle::driven(&virgin, drive, compliance).unwrap();
                    let found = cycle.harmonics(3);
                    // D = oint F dU, with the drive as the cosine.
                    let work = match drive {
                        Drive::Displacement(amplitude) => -PI * amplitude * found.harmonics[0].quadrature,
                        Drive::Force(amplitude) => PI * amplitude * found.harmonics[0].quadrature,
                    };
                    let unit = 4.0 * cycle.force_amplitude() * cycle.machine_amplitude();
                    let off = (work - cycle.dissipated_energy()).abs() / unit;
                    assert!(off <= 1e-13 + found.error, "{profile:?} {drive:?} {compliance:e}: {off:e}");
                }
            }
        }
    }
}

#[test]
fn the_density_of_friction_work_adds_up_to_the_work() {
    for (profile, depth) in shapes().into_iter().take(6) {
        let virgin = contact(profile.clone(), depth);
        let edge = virgin.contact_radius();
        for share in [0.2, 0.8, 1.0, 1.7] {
            let cycle = SteadyCycle::of(&virgin, share * virgin.gross_slip_displacement());
            // Over the angle with r = a sin(angle) the pressure's root at the edge is smooth, and the slip begins like
            // a power of the distance from the stuck core.
            // At the tip of a cone it is infinite.
            let inner = (cycle.stick_radius() / edge).clamp(1e-9, 1.0).asin();
            let area = 2.0 * PI * edge * edge / cycle.dissipated_energy();
            let part = |angle: f64| area * angle.sin() * angle.cos() * cycle.friction_work(&[edge * angle.sin()])[0];
            let total = integral(&part, inner, 0.5 * PI, 1e-12);
            assert!((total - 1.0).abs() <= 1e-9, "{profile:?} {share}: {total}");
        }
    }
}

#[test]
fn borders_and_nothing_at_all() {
    let ball = unit_sphere();
    let rest = SteadyCycle::of(&ball, 0.0);
    assert_eq!((rest.dissipated_energy(), rest.force_amplitude(), rest.regime()), (0.0, 0.0, Regime::Stick));
    assert_eq!((rest.sliding_ratio(), rest.loss_factor()), (Some(0.0), Some(0.0)));
    assert_eq!(rest.secant_stiffness(), 2.0 * G_STAR * ball.contact_radius());
    assert_eq!(rest.harmonics(3).harmonics.len(), 3);
    let onset = SteadyCycle::of(&ball, ball.gross_slip_displacement());
    assert_eq!((onset.regime(), onset.stick_radius()), (Regime::GrossSlip, 0.0));
    assert_eq!(SteadyCycle::of(&ball, ball.gross_slip_displacement() * (1.0 - 1e-12)).regime(), Regime::PartialSlip);
    let limit = FRICTION * ball.normal_force();
    assert!(SteadyCycle::driven(&ball, Drive::Force(limit), 0.0).is_err());
    // Nothing touches.
    let apart = contact(Profile::Sphere(Sphere::new(1.0).unwrap()), 0.0);
    let nothing = SteadyCycle::of(&apart, 1e-3);
    assert_eq!((nothing.dissipated_energy(), nothing.max_elastic_energy(), nothing.force_amplitude()), (0.0, 0.0, 0.0));
    assert_eq!((nothing.loss_factor(), nothing.sliding_ratio()), (None, None));
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn a_machine_takes_its_share_of_the_displacement(share in 1e-9..3.0_f64, compliance in -3.0..3.0_f64, index in 0..13_usize) {
        let (profile, depth) = shapes().swap_remove(index);
        let virgin = contact(profile, depth);
        let compliance = 10_f64.powf(compliance) / (2.0 * G_STAR * virgin.contact_radius());
        let amplitude = share * virgin.gross_slip_displacement();
        let cycle = SteadyCycle::driven(&virgin, Drive::Displacement(amplitude), compliance).unwrap();
        // Brute force: bisection on the first loading.
        let force = |u: f64| {
            let mut moved = virgin.clone();
            moved.apply(&displace(u)).unwrap();
            moved.force()
        };
        let (mut low, mut high) = (0.0, amplitude);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if middle + compliance * force(middle) > amplitude { high = middle } else { low = middle }
        }
        prop_assert!((cycle.displacement_amplitude() / high - 1.0).abs() < 1e-12, "{} {high}", cycle.displacement_amplitude());
        prop_assert!((cycle.force_amplitude() / force(high) - 1.0).abs() < 1e-12);
        prop_assert!((cycle.machine_amplitude() / amplitude - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_force_amplitude_is_met_to_the_last_digits_of_the_limit(room in -12.0..0.0_f64, index in 0..13_usize) {
        let (profile, depth) = shapes().swap_remove(index);
        let virgin = contact(profile, depth);
        let limit = FRICTION * virgin.normal_force();
        for force in [limit * (1.0 - 10_f64.powf(room) * 0.999), limit * 10_f64.powf(room) * 0.999] {
            let cycle = SteadyCycle::driven(&virgin, Drive::Force(force), 0.0).unwrap();
            let mut moved = virgin.clone();
            moved.apply(&displace(cycle.displacement_amplitude())).unwrap();
            prop_assert!((moved.force() / force - 1.0).abs() < 1e-13, "{:e} {force:e}", moved.force());
        }
    }
}
