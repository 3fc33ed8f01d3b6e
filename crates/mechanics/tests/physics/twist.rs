//! Contacts that are twisted: the closed forms of Lubkin and Jaeger, limit torques, Masing's rule, energies, the hoop
//! stress, and what is refused.

use std::f64::consts::PI;

use stickslip_mechanics::profile::{Cone, FlatPunch, PowerLaw, Sum, TruncatedCone};
use stickslip_mechanics::{
    Body, Contact, Elasticity, Error, Friction, Move, Normal, Preload, Profile, Regime, Setup, Sphere, Tangential,
};

/// The moduli and the coefficient of friction of every contact below.
const E_STAR: f64 = 1.0;
const SHEAR_MODULUS: f64 = 0.5;
const FRICTION: f64 = 0.4;

fn contact_with(profile: Profile, [e_star, shear_modulus, friction]: [f64; 3], preload: Preload) -> Contact {
    let elasticity = Elasticity::effective(e_star, 0.8).unwrap().with_shear_modulus(shear_modulus).unwrap();
    Contact::new(Setup { profile, elasticity, friction, preload }).unwrap()
}

fn contact(profile: Profile) -> Contact {
    contact_with(profile, [E_STAR, SHEAR_MODULUS, FRICTION], Preload::Indentation(0.9))
}

fn sphere() -> Profile {
    Profile::Sphere(Sphere::new(1.0).unwrap())
}

fn by(angle: f64) -> Move {
    Move { tangential: Some(Tangential::Twist(angle)), ..Move::default() }
}

fn torque(torque: f64) -> Move {
    Move { tangential: Some(Tangential::Torque(torque)), ..Move::default() }
}

fn shapes() -> Vec<(&'static str, Profile)> {
    let sum = vec![sphere(), Profile::Cone(Cone::new(0.2).unwrap())];
    vec![
        ("ball", sphere()),
        ("cone", Profile::Cone(Cone::new(1.0).unwrap())),
        ("quartic", Profile::PowerLaw(PowerLaw::new(4.0, 0.7).unwrap())),
        ("three halves", Profile::PowerLaw(PowerLaw::new(1.5, 0.7).unwrap())),
        ("punch", Profile::FlatPunch(FlatPunch::new(1.0).unwrap())),
        ("truncated cone", Profile::TruncatedCone(TruncatedCone::new(0.3, 0.4).unwrap())),
        ("sum", Profile::Sum(Sum::new(sum).unwrap())),
    ]
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found:e}, expected {expected:e}");
}

#[test]
fn check_values_are_met() {
    // mu = p0 = a = G = 1: p0 = 2 E* a/(pi R).
    let virgin = contact_with(sphere(), [0.5 * PI, 1.0, 1.0], Preload::ContactRadius(1.0));
    let limit = 3.0 * PI / 16.0 * virgin.normal_force();
    for (c, angle, share, work) in [
        (0.9, 0.080_663_279_695_7, 0.299_373_217_594_1, 0.006_263_925_466_8),
        (0.5, 0.472_729_809_965_6, 0.897_338_429_005_2, 0.667_564_296_946_5),
        (0.1, 1.339_821_908_982_3, 0.999_272_152_693_0, 4.528_341_510_579_1),
    ] {
        let mut contact = virgin.clone();
        contact.apply(&by(angle)).unwrap();
        let state = contact.state();
        near(state.stick_radius, c, 1e-11, "stick radius");
        near(state.torque.unwrap(), share * limit, 1e-11, "torque");
        let first = state.dissipated_energy;
        contact.apply(&by(-angle)).unwrap();
        contact.apply(&by(angle)).unwrap();
        near(contact.state().dissipated_energy - first, work, 2e-11, "work of a cycle");
        let mut by_torque = virgin.clone();
        by_torque.apply(&torque(share * limit)).unwrap();
        near(by_torque.state().twist.unwrap(), angle, 2e-9, "angle by torque");
    }
    let mut soft = virgin.clone();
    soft.apply(&by(1e-9)).unwrap();
    near(soft.state().torque.unwrap(), 16.0 / 3.0 * 1e-9, 1e-8, "stiffness at first touch");

    // mu = E* = G = a = 1, c = 0.5: g = x, and g = x^4. A cone of slope s has g = (pi/2) s x, r^4 g = (8/3) r^4.
    for (profile, angle, force, work) in [
        (Profile::Cone(Cone::new(2.0 / PI).unwrap()), 0.204_889_868_014, 0.436_406_508_945, 0.117_686_102_584),
        (
            Profile::PowerLaw(PowerLaw::new(4.0, 0.375).unwrap()),
            0.362_568_591_886,
            0.993_669_215_186,
            0.417_867_755_828,
        ),
    ] {
        let mut contact = contact_with(profile, [1.0, 1.0, 1.0], Preload::ContactRadius(1.0));
        contact.apply(&by(angle)).unwrap();
        let first = contact.state();
        near(first.stick_radius, 0.5, 1e-10, "stick radius");
        near(first.torque.unwrap(), force, 1e-10, "torque");
        contact.apply(&by(-angle)).unwrap();
        contact.apply(&by(angle)).unwrap();
        near(contact.state().dissipated_energy - first.dissipated_energy, work, 1e-10, "work of a cycle");
    }
}

#[test]
fn limit_torques_are_the_moments_of_friction() {
    // In mu F_N a: cone pi/6, ball 3 pi/16, r^4 0.654498, punch pi/4.
    for (name, of_load) in
        [("cone", PI / 6.0), ("ball", 3.0 * PI / 16.0), ("quartic", 0.654_498_469_498), ("punch", 0.25 * PI)]
    {
        let profile = shapes().into_iter().find(|(found, _)| *found == name).unwrap().1;
        let contact = contact(profile);
        let limit = contact.twisting().unwrap().normal_force();
        near(limit, of_load * FRICTION * contact.normal_force() * contact.contact_radius(), 1e-11, name);
    }
    // Whether its radius has a square that is a double or not.
    for index in 1..60 {
        let radius = 0.013 * f64::from(index);
        let contact = contact(Profile::FlatPunch(FlatPunch::new(radius).unwrap()));
        let limit = contact.twisting().unwrap().normal_force();
        near(limit, 0.25 * PI * FRICTION * contact.normal_force() * radius, 1e-11, "punch");
    }
    // A flat punch sticks up to 2/3 of mu F_N a.
    let punch = contact(Profile::FlatPunch(FlatPunch::new(1.0).unwrap()));
    let limit = FRICTION * punch.normal_force();
    for (share, regime) in [(0.99 * 2.0 / 3.0, Regime::Stick), (1.01 * 2.0 / 3.0, Regime::PartialSlip)] {
        let mut punch = punch.clone();
        punch.apply(&torque(share * limit)).unwrap();
        assert_eq!(punch.state().regime, regime, "{share}");
    }
}

#[test]
fn a_ball_by_its_integral_is_that_by_its_closed_form() {
    // A power law of the exponent 2 has no closed form of its own.
    let square = Profile::PowerLaw(PowerLaw::new(2.0, 0.5).unwrap());
    let [mut one, mut other] = [sphere(), square].map(contact);
    for angle in [0.1, -0.05, 0.4, -0.3, 0.2, 5.0, 1e-6] {
        for contact in [&mut one, &mut other] {
            contact.apply(&by(angle)).unwrap();
        }
        near(other.state().torque.unwrap(), one.state().torque.unwrap(), 1e-11, "torque");
        near(other.state().stick_radius + 1.0, one.state().stick_radius + 1.0, 1e-11, "stick radius");
        near(other.state().dissipated_energy, one.state().dissipated_energy, 1e-10, "work");
    }
}

#[test]
fn the_hoop_stress_keeps_to_friction_and_has_the_torque() {
    for (name, profile) in shapes() {
        let mut contact = contact(profile);
        let slides = 2.0 * contact.twisting().unwrap().gross_slip_displacement();
        let a = contact.contact_radius();
        for (step, angle) in [0.3, -0.2, 0.25, slides].into_iter().enumerate() {
            contact.apply(&by(angle)).unwrap();
            // With r = a sin(t), by the midpoint rule.
            let count = 4000;
            let places: Vec<f64> =
                (0..count).map(|index| 0.5 * PI * (f64::from(index) + 0.5) / f64::from(count)).collect();
            let radii: Vec<f64> = places.iter().map(|t| a * t.sin()).collect();
            let hoops = contact.hoops(&radii);
            let sum: f64 =
                places.iter().zip(&hoops).map(|(t, hoop)| 2.0 * PI * (a * t.sin()).powi(2) * hoop * a * t.cos()).sum();
            let found = sum * 0.5 * PI / f64::from(count);
            assert!(
                (found - contact.state().torque.unwrap()).abs() < 2e-4 * contact.twisting().unwrap().normal_force()
            );
            for (radius, hoop) in radii.iter().zip(&hoops).step_by(37) {
                let bound = FRICTION * contact.pressure(*radius);
                assert!(hoop.abs() <= bound * (1.0 + 1e-9), "{name} at {radius}");
                if step == 3 && *radius > 1e-3 * a {
                    let mean = FRICTION * contact.pressure(0.3 * a);
                    assert!((hoop - bound).abs() <= 1e-9 * (bound + mean), "{name} at {radius}: {hoop:e}, {bound:e}");
                }
            }
        }
        assert_eq!(contact.hoops(&[1.5 * a]), [0.0]);
        assert_eq!(contact.shears(&[0.5 * a]), [0.0]);
    }
}

#[test]
fn cycles_close_by_masings_rule_and_energy_is_kept() {
    for (name, profile) in shapes() {
        let mut virgin = contact(profile);
        // Its limit is made once.
        virgin.apply(&by(0.0)).unwrap();
        let most = 0.2;
        let first = |angle: f64| {
            let mut contact = virgin.clone();
            contact.apply(&by(angle)).unwrap();
            contact.state().torque.unwrap()
        };
        let mut contact = virgin.clone();
        contact.apply(&by(most)).unwrap();
        let (top, start) = (contact.state().torque.unwrap(), contact.state());
        let (mut work, count) = (0.0, 400);
        for step in 1..=count {
            let share = 1.0 - 2.0 * f64::from(step) / f64::from(count);
            let before = contact.state();
            contact.apply(&by(share * most)).unwrap();
            let state = contact.state();
            assert!(state.dissipated_energy >= before.dissipated_energy, "{name}");
            near(state.torque.unwrap() + top, 2.0 * top - 2.0 * first(0.5 * (1.0 - share) * most), 1e-10, name);
            work +=
                0.5 * (state.torque.unwrap() + before.torque.unwrap()) * (state.twist.unwrap() - before.twist.unwrap());
        }
        let end = contact.state();
        let kept = end.elastic_energy + end.dissipated_energy - start.elastic_energy - start.dissipated_energy;
        assert!((kept - work).abs() < 1e-4 * end.elastic_energy, "{name}: {kept:e} and {work:e}");
        contact.apply(&by(most)).unwrap();
        near(contact.state().torque.unwrap(), top, 1e-13, name);
        near(contact.state().elastic_energy, start.elastic_energy, 1e-12, name);
    }
}

#[test]
fn twist_is_alone_and_ends_when_the_contact_lifts_off() {
    let mut contact = contact(sphere());
    let slide = Move { tangential: Some(Tangential::Displacement(0.01)), ..Move::default() };
    let press = |load| Move { normal: Some(Normal::NormalForce(load)), ..Move::default() };
    // Loads change before, and with tangential motion no twist.
    let mut shifted = contact.clone();
    shifted.apply(&slide).unwrap();
    assert_eq!(shifted.apply(&by(0.1)), Err(Error::TwistWithShift));
    let load = 0.8 * contact.normal_force();
    contact.apply(&press(load)).unwrap();
    contact.apply(&by(0.2)).unwrap();
    let state = contact.state();
    assert_eq!(contact.apply(&slide), Err(Error::TwistWithShift));
    let limit = contact.twisting().unwrap().normal_force();
    assert!(matches!(contact.apply(&torque(limit)), Err(Error::TorqueExceedsFriction { .. })));
    for target in [f64::NAN, f64::INFINITY, 2e6] {
        assert!(matches!(contact.apply(&by(target)), Err(Error::OutOfRange { .. })));
    }
    assert_eq!(contact.state(), state);
    contact.apply(&press(load)).unwrap();
    assert_eq!(contact.state(), state);
    // Relative moves, and a torque taken off.
    contact.apply(&Move { relative: true, ..by(0.05) }).unwrap();
    near(contact.state().twist.unwrap(), 0.25, 1e-15, "angle");
    contact.apply(&torque(0.0)).unwrap();
    assert!(contact.state().torque.unwrap().abs() < 1e-15 * limit && contact.state().twist.unwrap() > 0.0);
    // Lifted off, what the twist had stored is lost, and either motion is free.
    let before = contact.state();
    contact.apply(&Move { normal: Some(Normal::Indentation(-0.1)), ..Move::default() }).unwrap();
    let apart = contact.state();
    assert_eq!((apart.regime, apart.twist, apart.torque), (Regime::Separated, None, None));
    near(apart.dissipated_energy, before.dissipated_energy + before.elastic_energy, 1e-14, "work");
    contact.apply(&press(load)).unwrap();
    contact.apply(&slide).unwrap();
    assert!(contact.state().force > 0.0);
}

/// Widths from that of nothing to that of an atom: a contact is twisted as any other one is, or carries nothing.
#[test]
fn a_contact_of_hardly_any_width_is_twisted_or_carries_nothing() {
    for (name, profile) in shapes() {
        for power in (-323..=-4).step_by(11) {
            let level = 10_f64.powi(power);
            let preload = Preload::Indentation(level);
            let Ok(contact) = Contact::new(Setup {
                profile: profile.clone(),
                elasticity: Elasticity::effective(1.0, 0.8).unwrap().with_shear_modulus(0.5).unwrap(),
                friction: 0.4,
                preload,
            }) else {
                continue;
            };
            let mut twisted = contact.clone();
            twisted.apply(&by(0.1)).unwrap_or_else(|error| panic!("{name}, {level:e}: {error}"));
            let mut pressed = twisted.clone();
            pressed.apply(&to(0.5, 0.1)).unwrap();
            assert!(pressed.state().torque.unwrap() >= 0.0, "{name}, {level:e}");
            pressed.apply(&to(level, -0.1)).unwrap();
            let Some(torque) = twisted.state().torque else {
                assert!(twisted.apply(&torque(1e-3)).is_err());
                continue;
            };
            let limit = contact.gross_slip_torque().unwrap();
            // Below the smallest number with all its digits nothing is compared.
            let digits = limit > 1e-290;
            assert!(!digits || (torque > 0.0 && torque <= limit * (1.0 + 1e-9)), "{name}, {level:e}: {torque:e}");
        }
    }
}

#[test]
fn what_cannot_be_twisted_is_refused() {
    let setup = |profile| Setup {
        profile,
        elasticity: Elasticity::effective(1.0, 0.8).unwrap().with_shear_modulus(0.5).unwrap(),
        friction: Friction { shear_strength: 0.1, ..Friction::from(0.3) },
        preload: Preload::Indentation(0.5),
    };
    let mut strong = Contact::new(setup(sphere())).unwrap();
    assert_eq!(strong.apply(&by(0.1)), Err(Error::ShearStrength("twist")));
    let plain = |friction: f64, elasticity| {
        Contact::new(Setup { profile: sphere(), elasticity, friction, preload: Preload::Indentation(0.5) }).unwrap()
    };
    let moduli = Elasticity::effective(1.0, 0.8).unwrap();
    assert_eq!(plain(0.3, moduli).apply(&by(0.1)), Err(Error::ShearModulusNeeded));
    let known = moduli.with_shear_modulus(0.5).unwrap();
    assert!(matches!(plain(0.0, known).apply(&by(0.1)), Err(Error::OutOfRange { .. })));
    let mut twisted = plain(0.3, known);
    twisted.apply(&by(0.1)).unwrap();
    assert_eq!(twisted.check_coulomb("wear"), Err(Error::Twisted("wear")));
    assert!(!twisted.virgin().is_twisted() && !twisted.without_history().is_twisted());
    // 1/G = 1/G_1 + 1/G_2, and a rigid body adds nothing.
    let rubber = Body::new(3.0, 0.5).unwrap();
    assert_eq!(Elasticity::against_rigid(rubber).shear_modulus(), Some(1.0));
    assert_eq!(Elasticity::of_bodies(rubber, rubber).shear_modulus(), Some(0.5));
}

#[test]
fn a_packed_contact_comes_back_to_the_last_bit() {
    let virgin = contact(sphere());
    let mut contact = virgin.clone();
    for angle in [0.2, -0.1, 0.05] {
        contact.apply(&by(angle)).unwrap();
        let bytes = contact.pack();
        assert_eq!(bytes.len(), contact.packed_length());
        let back = virgin.unpack(&bytes).unwrap();
        assert_eq!(back.state(), contact.state());
        assert!(virgin.unpack(&bytes[..bytes.len() - 8]).is_none());
        // From a state that is twisted, too.
        assert_eq!(contact.unpack(&virgin.pack()).unwrap().state(), virgin.state());
        contact = back;
    }
}

/// To an indentation, m, and an angle, rad.
fn to(indentation: f64, angle: f64) -> Move {
    Move { normal: Some(Normal::Indentation(indentation)), ..by(angle) }
}

/// The check path of a ball of R = 1: contact radii and angles, the first of them the preload.
const CHECKED: [(f64, f64); 8] =
    [(0.7, 0.0), (1.0, 0.15), (0.8, 0.05), (0.95, -0.15), (0.95, 0.1), (0.6, 0.1), (1.0, 0.12), (1.0, -0.05)];

fn checked_ball() -> Contact {
    contact_with(sphere(), [E_STAR, SHEAR_MODULUS, FRICTION], Preload::ContactRadius(CHECKED[0].0))
}

fn torque_of(contact: &Contact) -> f64 {
    contact.state().torque.unwrap()
}

#[test]
fn a_load_that_changes_has_the_torques_of_the_check_values() {
    let mut contact = checked_ball();
    let mut largest: f64 = 0.0;
    for ((radius, angle), expected) in
        CHECKED[1..].iter().zip([0.23401, 0.04822, -0.19543, 0.16042, 0.03189, 0.06264, -0.20236])
    {
        contact.apply(&to(radius * radius, *angle)).unwrap();
        assert!((torque_of(&contact) - expected).abs() < 2e-5, "{radius} {angle}: {}", torque_of(&contact));
        largest = largest.max(contact.accuracy().force_error);
    }
    assert!(largest > 1e-9 && largest < 5e-6, "{largest:e}");
}

/// Springs that know nothing of the solver: many, in very many steps, each bound by the closed form of the ball.
struct BruteForce {
    width: f64,
    carried: Vec<f64>,
    at: (f64, f64),
}

impl BruteForce {
    fn new(count: usize, reach: f64, indentation: f64) -> BruteForce {
        BruteForce { width: reach / count as f64, carried: vec![0.0; count], at: (indentation, 0.0) }
    }

    /// (mu p0/(2 G)) (K - E) of 1 - x^2/a^2, by the trapezoidal rule, which a period makes exact.
    fn bound(x: f64, indentation: f64) -> f64 {
        let a = indentation.max(0.0).sqrt();
        if x >= a {
            return 0.0;
        }
        let m = (1.0 - x / a) * (1.0 + x / a);
        let count = 64;
        let sum: f64 = (0..count)
            .map(|index| {
                let root = (1.0 - m * (0.5 * PI * (f64::from(index) + 0.5) / f64::from(count)).sin().powi(2)).sqrt();
                root.recip() - root
            })
            .sum();
        FRICTION * E_STAR * a / (PI * SHEAR_MODULUS) * sum * 0.5 * PI / f64::from(count)
    }

    fn go(&mut self, (indentation, angle): (f64, f64), steps: usize) -> f64 {
        let (d, w) = self.at;
        for step in 1..=steps {
            let part = step as f64 / steps as f64;
            let depth = d + part * (indentation - d);
            let change = (indentation - d) / steps as f64;
            for (index, carried) in self.carried.iter_mut().enumerate() {
                let x = (index as f64 + 0.5) * self.width;
                // A spring that is touched within a step turns with the rest of it.
                let share = if change > 0.0 { ((depth - x * x) / change).clamp(0.0, 1.0) } else { 1.0 };
                let bound = BruteForce::bound(x, depth);
                *carried = (*carried + share * (angle - w) / steps as f64).clamp(-bound, bound);
            }
        }
        self.at = (indentation, angle);
        self.carried.iter().enumerate().fold(0.0, |sum, (index, carried)| {
            let x = (index as f64 + 0.5) * self.width;
            sum + 16.0 * SHEAR_MODULUS * x * x * self.width * carried
        })
    }
}

#[test]
fn the_stated_error_is_no_less_than_a_third_of_the_true_one() {
    let mut random = 17_u64;
    let mut number = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..3 {
        let start = 0.3 + 0.5 * number();
        let mut contact = contact_with(sphere(), [E_STAR, SHEAR_MODULUS, FRICTION], Preload::Indentation(start));
        let mut brute = BruteForce::new(500, 1.0, start);
        for _ in 0..5 {
            let target = (0.2 + 0.7 * number(), 0.4 * (number() - 0.5));
            contact.apply(&to(target.0, target.1)).unwrap();
            let expected = brute.go(target, 100);
            let limit = 3.0 * PI / 16.0 * FRICTION * contact.normal_force() * contact.contact_radius();
            let off = (torque_of(&contact) - expected).abs() / limit;
            // The brute force itself is good to 3e-5.
            assert!(off <= 3.0 * contact.accuracy().force_error + 3e-5, "{target:?}: {off:e}");
            assert!(torque_of(&contact).abs() <= limit * (1.0 + 1e-5));
        }
    }
}

#[test]
fn a_straight_move_in_two_is_the_same_move() {
    for (name, profile) in shapes() {
        let [mut one, mut two] = [contact(profile.clone()), contact(profile)];
        let mut here = (0.9, 0.0);
        // From the first change of the load on the springs are the same.
        for (depth, angle) in [(0.7, 0.0), (0.8, 0.12), (0.5, -0.03), (0.95, -0.1), (0.6, -0.1), (0.9, 0.2)] {
            one.apply(&to(depth, angle)).unwrap();
            for part in [0.3, 1.0] {
                two.apply(&to(here.0 + part * (depth - here.0), here.1 + part * (angle - here.1))).unwrap();
            }
            here = (depth, angle);
            let limit = one.twisting().unwrap().normal_force();
            assert!((torque_of(&one) - torque_of(&two)).abs() < 1e-9 * limit, "{name} {depth} {angle}");
            let [first, second] = [&one, &two].map(|contact| contact.state());
            assert!((first.elastic_energy - second.elastic_energy).abs() < 1e-9 * limit, "{name}");
            assert!((first.dissipated_energy - second.dissipated_energy).abs() < 1e-4 * limit, "{name}");
        }
    }
}

#[test]
fn springs_forget_in_cycles_under_a_constant_load_what_came_before() {
    for (name, profile) in shapes() {
        let mut exact = contact(profile.clone());
        let mut springs = contact_with(profile, [E_STAR, SHEAR_MODULUS, FRICTION], Preload::Indentation(0.6));
        springs.apply(&by(0.1)).unwrap();
        springs.apply(&to(0.9, -0.05)).unwrap();
        let limit = exact.twisting().unwrap().normal_force();
        for angle in [8.0, -8.0, 8.0, -0.1, 0.3, 0.1] {
            let [before, other] = [&exact, &springs].map(|contact| contact.state().dissipated_energy);
            exact.apply(&by(angle)).unwrap();
            springs.apply(&by(angle)).unwrap();
            let [one, two] = [&exact, &springs].map(Contact::state);
            let error = springs.accuracy().force_error;
            let off = (one.torque.unwrap() - two.torque.unwrap()).abs() / limit;
            assert!(error < 1e-5 && off <= 3.0 * error, "{name} to {angle}: {off:e}, stated {error:e}");
            assert!((one.elastic_energy - two.elastic_energy).abs() < 1e-4 * limit, "{name} to {angle}");
            let [lost, also] = [one.dissipated_energy - before, two.dissipated_energy - other];
            if angle < 8.0 {
                assert!((lost - also).abs() < 1e-5 * limit * (1.0 + lost / limit), "{name} to {angle}: {lost} {also}");
            }
            let apart = (one.stick_radius - two.stick_radius).abs();
            assert!(apart < 1e-3 * one.contact_radius, "{name} to {angle}: {apart:e}");
        }
        let places = [0.2, 0.5, 0.8].map(|part| part * exact.contact_radius());
        let mean = FRICTION * exact.pressure(places[0]);
        for (one, two) in exact.hoops(&places).iter().zip(springs.hoops(&places)) {
            assert!((one - two).abs() < 3e-3 * mean, "{name}: {one:e} and {two:e}");
        }
    }
}

#[test]
fn energy_is_kept_and_work_never_falls_while_the_load_changes() {
    for (name, profile) in shapes() {
        let mut contact = contact(profile);
        let limit = contact.twisting().unwrap().normal_force();
        contact.apply(&by(0.1)).unwrap();
        let mut here = (0.9, 0.1);
        let mut given = 0.0;
        let start = contact.state();
        for target in [(0.5, 0.1), (0.8, -0.05), (0.95, 0.2), (0.3, 0.25), (0.7, 0.0)] {
            let steps = 30;
            for step in 1..=steps {
                let part = f64::from(step) / f64::from(steps);
                let before = contact.state();
                let angle = here.1 + part * (target.1 - here.1);
                contact.apply(&to(here.0 + part * (target.0 - here.0), angle)).unwrap();
                let after = contact.state();
                assert!(after.dissipated_energy >= before.dissipated_energy, "{name}");
                given += 0.5 * (before.torque.unwrap() + after.torque.unwrap()) * (angle - before.twist.unwrap());
            }
            here = target;
        }
        let end = contact.state();
        let kept = end.elastic_energy + end.dissipated_energy - start.elastic_energy - start.dissipated_energy;
        assert!((kept - given).abs() < 1e-3 * limit, "{name}: {kept:e} and {given:e}");
        // Lifted off, what is stored is lost.
        contact.apply(&Move { normal: Some(Normal::Indentation(-0.1)), ..Move::default() }).unwrap();
        near(contact.state().dissipated_energy, end.dissipated_energy + end.elastic_energy, 1e-12, name);
        // While it opens and turns, by friction.
        contact.apply(&to(0.5, 0.1)).unwrap();
        let before = contact.state();
        contact.apply(&to(-0.1, 0.3)).unwrap();
        assert!(contact.state().twist.is_none() && contact.state().dissipated_energy > before.dissipated_energy);
    }
}

#[test]
fn a_torque_is_led_while_the_load_changes() {
    let mut contact = contact(sphere());
    let limit = contact.twisting().unwrap().normal_force();
    for (load, share) in [(0.8, 0.3), (1.3, -0.2), (0.6, 0.1), (1.0, 0.5)] {
        let normal = Some(Normal::NormalForce(load * 0.5));
        contact.apply(&Move { normal, ..torque(share * limit * 0.5) }).unwrap();
        near(torque_of(&contact), 0.5 * share * limit, 1e-12, "torque");
        near(contact.normal_force(), 0.5 * load, 1e-15, "load");
        assert!(contact.accuracy().force_error < 1e-5, "{:e}", contact.accuracy().force_error);
    }
    let state = contact.state();
    let falling = Move { normal: Some(Normal::NormalForce(0.01)), ..torque(0.2 * limit) };
    assert!(matches!(contact.apply(&falling), Err(Error::TorqueExceedsFriction { .. })));
    let off = Move { normal: Some(Normal::Indentation(-1.0)), ..torque(0.1 * limit) };
    assert!(matches!(contact.apply(&off), Err(Error::TorqueExceedsFriction { .. })));
    assert_eq!(contact.apply_while(&to(0.3, 0.1), 1e-6, &|| false), Err(Error::Interrupted));
    assert_eq!(contact.state(), state);
    let bytes = contact.pack();
    assert_eq!(bytes.len(), contact.packed_length());
    let mut back = self::contact(sphere()).unpack(&bytes).unwrap();
    assert_eq!(back.state(), state);
    for contact in [&mut contact, &mut back] {
        contact.apply(&to(2.0, -0.1)).unwrap();
    }
    assert_eq!((back.state(), back.pack()), (contact.state(), contact.pack()));
    // From the air the angle counts from the touch.
    let (mut touching, mut above) = (self::contact(sphere()), self::contact(sphere()));
    touching.apply(&Move { normal: Some(Normal::Indentation(0.0)), ..Move::default() }).unwrap();
    above.apply(&Move { normal: Some(Normal::Indentation(-3.0)), ..Move::default() }).unwrap();
    for contact in [&mut touching, &mut above] {
        contact.apply(&to(0.5, 0.2)).unwrap();
    }
    assert!(torque_of(&above) > 0.0);
    assert_eq!(torque_of(&above).to_bits(), torque_of(&touching).to_bits());
}

#[test]
fn the_limit_torque_follows_from_the_load_curve() {
    for (name, profile) in shapes() {
        let contact = contact(profile);
        near(contact.gross_slip_torque().unwrap(), contact.twisting().unwrap().normal_force(), 1e-11, name);
    }
}
