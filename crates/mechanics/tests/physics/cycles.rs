//! Steady cycles against closed forms, against loops that are stepped, and against sums over the loop.

use std::f64::consts::PI;

use proptest::prelude::*;
use stickslip_mechanics::cycle::{
    Drive, OscillatingCycle, OscillatingLoad, Oscillation, Resonator, SteadyCycle, best_load,
};
use stickslip_mechanics::profile::{PowerLaw, TruncatedSphere};
use stickslip_mechanics::{Contact, Elasticity, Normal, Preload, Profile, Regime, Setup, Sphere};

use crate::support::quadrature::integral;
use crate::support::{config, displace, shapes};

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

#[test]
fn the_loss_factor_begins_straight_and_has_trebled_its_slope_at_gross_slip() {
    // D = (2/3) mu F_N'' U0^3/m^2 with F_N'' = 2 E* da/dd, and E = G* a U0^2: 2/(3 pi) (d/a)(da/dd) U0/u_max.
    let share = 1e-7;
    let slope = |contact: &Contact| {
        SteadyCycle::of(contact, share * contact.gross_slip_displacement()).loss_factor().unwrap() / share
    };
    for n in [1.0, 1.5, 2.0, 4.0] {
        let virgin = contact(Profile::PowerLaw(PowerLaw::new(n, 0.1).unwrap()), 1e-3);
        close(slope(&virgin), 2.0 / (3.0 * PI * n), 1e-6);
        let onset = SteadyCycle::of(&virgin, virgin.gross_slip_displacement());
        close(onset.loss_factor().unwrap(), 2.0 / (PI * n), 1e-12);
    }
    // A worn ball, d = a (a^2 - b^2)^(1/2)/R: (d/a)(da/dd) = (a^2 - b^2)/(2 a^2 - b^2).
    let worn = contact(Profile::TruncatedSphere(TruncatedSphere::new(0.01, 8e-5).unwrap()), 6e-7);
    close(worn.contact_radius(), 1e-4, 1e-12);
    close(slope(&worn), 2.0 / (3.0 * PI) * 0.36 / 1.36, 1e-6);
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
fn harmonics_of_all_orders_are_integrals_of_the_closed_loop_of_a_ball() {
    let ball = unit_sphere();
    let limit = FRICTION * ball.normal_force();
    for share in [1e-3, 0.3, 0.97, 0.99, 1.0, 1.01, 1.03, 1.5, 20.0_f64] {
        // The first loading at twice its size, from the upper end.
        let force = |angle: f64| {
            let first = |part: f64| 1.0 - (1.0 - part).max(0.0).powf(1.5);
            first(share) - 2.0 * first(share * (0.5 * angle).sin().powi(2))
        };
        let sliding = 2.0 * share.max(1.0).sqrt().recip().asin();
        for count in [6, 18, 31] {
            for found in SteadyCycle::of(&ball, share * SCALE).harmonics(count).harmonics {
                let order = found.order as f64;
                let part = |wave: fn(f64) -> f64| {
                    let product = |angle: f64| 2.0 / PI * force(angle) * wave(order * angle);
                    integral(&product, 0.0, sliding, 1e-13) + integral(&product, sliding, PI, 1e-13)
                };
                // Half a turn later the force is the opposite, and so are the waves of odd order.
                let expected = if found.order % 2 == 1 { [part(f64::cos), part(f64::sin)] } else { [0.0; 2] };
                for (found, expected) in [found.in_phase, found.quadrature].into_iter().zip(expected) {
                    assert!((found / limit - expected).abs() < 1e-11, "{share} {order}: {found:e} {expected:e}");
                }
            }
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
    close(rest.secant_stiffness(), 2.0 * G_STAR * ball.contact_radius(), 1e-15);
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
    fn a_machine_takes_its_share_of_the_displacement(share in 1e-9..3.0_f64, compliance in -3.0..3.0_f64,
        index in 0..13_usize) {
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
        prop_assert!((cycle.displacement_amplitude() / high - 1.0).abs() < 1e-12, "{} \
            {high}", cycle.displacement_amplitude());
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

/// oint q dW of the unit sphere under the indentation 1 + 0.2 sin t and W = 0.3 sin(t + phase), which is a cosine that
/// the load precedes by less.
fn oblique(phase: f64, tolerance: f64) -> OscillatingCycle {
    let load = OscillatingLoad { amplitude: Normal::Indentation(0.2), phase: -phase.to_radians() };
    let swing = Oscillation { drive: Drive::Displacement(0.3 * SCALE), load, compliance: 0.0 };
    swing.steady(&unit_sphere(), tolerance, 3, &|| true).unwrap()
}

#[test]
fn a_load_that_oscillates_too_changes_the_work_with_its_phase() {
    for (phase, work) in [(0.0, 0.005_446_066_3), (45.0, 0.009_441_080_9), (90.0, 0.019_685_344_5)] {
        let cycle = oblique(phase, 1e-10);
        let found = cycle.dissipated_energy / (2.0 * G_STAR * SCALE * SCALE);
        assert!((found - work).abs() < 8e-10, "{phase}: {found}");
        for tolerance in [1e-4, 1e-6] {
            let rough = oblique(phase, tolerance);
            let unit = 4.0 * FRICTION * 4.0 / 3.0 * E_STAR * 1.2_f64.powf(1.5) * 0.3 * SCALE;
            let off = (rough.dissipated_energy - cycle.dissipated_energy).abs() / unit;
            assert!(off <= rough.error + cycle.error && rough.error <= tolerance, "{phase}: {off:e} {rough:?}");
        }
        // The force against the displacement: D = -pi U0 b_1.
        let first = cycle.harmonics[0].quadrature;
        assert!((-PI * 0.3 * SCALE * first / cycle.dissipated_energy - 1.0).abs() < 1e-5, "{cycle:?}");
    }
    close(oblique(0.0, 1e-3).dissipated_energy, oblique(360.0, 1e-3).dissipated_energy, 1e-6);
}

#[test]
fn without_an_amplitude_of_the_load_the_stepped_cycle_is_the_steady_one() {
    for (profile, depth) in shapes() {
        let virgin = contact(profile.clone(), depth);
        let limit = FRICTION * virgin.normal_force();
        let full = virgin.gross_slip_displacement();
        let load = OscillatingLoad { amplitude: Normal::NormalForce(0.0), phase: 1.0 };
        for (drive, compliance) in [
            (Drive::Displacement(0.6 * full), 0.0),
            (Drive::Displacement(1.2 * full), 0.0),
            (Drive::Displacement(0.9 * full), 0.4 * full / limit),
            (Drive::Force(0.7 * limit), 0.0),
        ] {
            let stepped = Oscillation { drive, load, compliance }.steady(&virgin, 1e-6, 3, &|| true).unwrap();
            let steady = SteadyCycle::driven(&virgin, drive, compliance).unwrap();
            let unit = limit * steady.displacement_amplitude();
            assert!(
                (stepped.dissipated_energy - steady.dissipated_energy()).abs() <= 1e-9 * unit,
                "{profile:?} {drive:?}"
            );
            close(stepped.force_amplitude, steady.force_amplitude(), 1e-11);
            close(stepped.machine_amplitude, steady.machine_amplitude(), 1e-11);
            close(stepped.tangent_stiffness, steady.tangent_stiffness(), 1e-11);
            assert_eq!(stepped.regime, steady.regime(), "{profile:?} {drive:?}");
            assert!((stepped.sliding_ratio.unwrap() - steady.sliding_ratio().unwrap()).abs() < 1e-3);
            for (one, other) in stepped.harmonics.iter().zip(steady.harmonics(3).harmonics) {
                let unit = if matches!(drive, Drive::Force(_)) { steady.displacement_amplitude() } else { limit };
                let off = (one.in_phase - other.in_phase).abs().max((one.quadrature - other.quadrature).abs());
                assert!(off <= 1e-4 * unit, "{profile:?} {drive:?}: {one:?}, not {other:?}");
            }
        }
    }
}

#[test]
fn a_contact_that_lifts_off_in_each_cycle_forgets_and_one_that_cannot_be_unloaded_is_refused() {
    let ball = unit_sphere();
    let load = |amplitude| OscillatingLoad { amplitude, phase: 0.5 * PI };
    let swing =
        |amplitude| Oscillation { drive: Drive::Displacement(0.3 * SCALE), load: load(amplitude), compliance: 0.0 };
    let lifted = swing(Normal::Indentation(1.5)).steady(&ball, 1e-5, 2, &|| true).unwrap();
    assert_eq!((lifted.regime, lifted.stick_radius), (Regime::Separated, 0.0));
    assert!(lifted.dissipated_energy > 0.0 && lifted.harmonics[1].in_phase.abs() > 0.0);
    let much = 1.01 * ball.normal_force();
    assert!(swing(Normal::NormalForce(much)).steady(&ball, 1e-5, 0, &|| true).is_err());
    let force = Oscillation {
        drive: Drive::Force(0.9 * FRICTION * ball.normal_force()),
        ..swing(Normal::NormalForce(0.5 * ball.normal_force()))
    };
    assert!(force.steady(&ball, 1e-5, 0, &|| true).is_err());
    assert!(swing(Normal::Indentation(0.1)).steady(&ball, 1e-5, 0, &|| false).is_err());
}

#[test]
fn no_load_does_more_work_than_the_best() {
    for (profile, depth) in shapes().into_iter().filter(|(profile, _)| !matches!(profile, Profile::Tabulated(_))) {
        let virgin = contact(profile.clone(), depth);
        let full = virgin.gross_slip_displacement();
        let limit = FRICTION * virgin.normal_force();
        for (drive, compliance) in [
            (Drive::Displacement(0.5 * full), 0.0),
            (Drive::Displacement(0.9 * full), 0.5 * full / limit),
            (Drive::Force(0.5 * limit), 0.0),
        ] {
            let best = best_load(&virgin, drive, compliance, &|| true).unwrap().unwrap();
            for index in 1..400 {
                // From a hundredth of it to a hundred times it.
                let load = best.normal_force * 10_f64.powf(4.0 * f64::from(index) / 400.0 - 2.0);
                let pressed = virgin.pressed(load).unwrap();
                let Ok(cycle) = SteadyCycle::driven(&pressed, drive, compliance) else { continue };
                let ratio = cycle.dissipated_energy() / best.dissipated_energy;
                assert!(ratio <= 1.0 + 1e-9, "{profile:?} {drive:?}: {ratio} at {load:e} N, not {best:?}");
            }
        }
    }
}

/// The amplitude of a mass on the contact after many periods, stepped in time with the exact contact.
fn integrated(virgin: &Contact, body: Resonator, frequency: f64, damping_periods: usize) -> f64 {
    const STEPS: usize = 400;
    let step = 1.0 / (frequency * STEPS as f64);
    let mut moving = virgin.clone();
    let (mut position, mut speed, mut largest) = (0.0, 0.0, 0.0_f64);
    for index in 0..damping_periods * STEPS {
        let phase = 2.0 * PI * (index % STEPS) as f64 / STEPS as f64;
        speed += step / body.mass * (body.drive_force * phase.cos() - moving.force());
        position += step * speed;
        moving.apply(&displace(position)).unwrap();
        if index >= (damping_periods - 2) * STEPS {
            largest = largest.max(position.abs());
        }
    }
    largest
}

#[test]
fn a_mass_on_the_contact_swings_as_time_integration_says() {
    let virgin = contact(Profile::Sphere(Sphere::new(0.01).unwrap()), 3e-6);
    let limit = FRICTION * virgin.normal_force();
    let body = Resonator { mass: 0.1, drive_force: 0.25 * limit };
    let natural = body.natural_frequency(&virgin);
    for share in [0.3, 0.6, 1.2, 1.6] {
        let found = body.respond(&virgin, &[share * natural], 1e-6, &|| true).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        let stepped = integrated(&virgin, body, share * natural, 300);
        // What the balance leaves out acts at three times the frequency.
        let allowed = 0.01 + found[0].third_harmonic;
        assert!((stepped / found[0].amplitude - 1.0).abs() < allowed, "{share}: {stepped:e}, {found:?}");
    }
    // Where the curve leans over there is one, too: two motions on such a contact never draw apart.
    for percent in 50..100 {
        let found = body.respond(&virgin, &[0.01 * f64::from(percent) * natural], 1e-6, &|| true).unwrap();
        assert_eq!(found.len(), 1, "{percent} %: {found:?}");
    }
    assert!(body.respond(&virgin, &[natural], 1e-6, &|| false).is_none());
}
