//! Paths that are straight in a force, against closed forms for the sphere.

use crate::support::{displace, push};
use stickslip_mechanics::{
    Contact, Elasticity, Error, Move, Normal, Preload, Profile, Regime, Setup, Sphere, Tangential,
};

const RADIUS: f64 = 0.02;
const E_STAR: f64 = 1.2e11;
const G_STAR: f64 = 9.0e10;
const FRICTION: f64 = 0.4;
const LOAD: f64 = 20.0;

fn ball(normal_force: f64) -> Contact {
    Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(RADIUS).unwrap()),
        elasticity: Elasticity::effective(E_STAR, G_STAR).unwrap(),
        friction: FRICTION,
        preload: Preload::NormalForce(normal_force),
    })
    .unwrap()
}

/// Hertz: a = (3 F_N R/(4 E*))^(1/3).
fn contact_radius(normal_force: f64) -> f64 {
    (0.75 * normal_force * RADIUS / E_STAR).cbrt()
}

fn indentation(normal_force: f64) -> f64 {
    contact_radius(normal_force).powi(2) / RADIUS
}

fn forces(force: f64, normal_force: f64) -> Move {
    Move {
        tangential: Some(Tangential::Force(force)),
        normal: Some(Normal::NormalForce(normal_force)),
        ..Move::default()
    }
}

fn slide_and_press(displacement: f64, normal_force: f64) -> Move {
    Move { normal: Some(Normal::NormalForce(normal_force)), ..displace(displacement) }
}

fn push_and_sink(force: f64, depth: f64) -> Move {
    Move { normal: Some(Normal::Indentation(depth)), ..push(force) }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * expected.abs(), "{found:e} is not {expected:e}: off by {:e}", error / expected.abs());
}

#[test]
fn an_interrupted_move_has_changed_nothing() {
    let mut contact = ball(LOAD);
    let full = contact.gross_slip_displacement();
    contact.apply(&displace(0.3 * full)).unwrap();
    let before = contact.state();
    let curve = Move { normal: Some(Normal::NormalForce(2.0 * LOAD)), ..displace(0.9 * full) };
    let chords = std::cell::Cell::new(0);
    let keep_going = || {
        chords.set(chords.get() + 1);
        chords.get() < 20
    };
    assert_eq!(contact.apply_while(&curve, 1e-10, &keep_going), Err(Error::Interrupted));
    assert_eq!((contact.state(), chords.get()), (before, 20));
    contact.apply(&curve).unwrap();
    assert!(contact.normal_force() > 1.99 * LOAD);
}

#[test]
fn proportional_loading_from_nothing_never_slips() {
    // Mindlin & Deresiewicz (1953): below the friction angle, dU/dd = (E*/G*) dF_x/dF_N throughout.
    for share in [0.1, 0.5, 0.9, 0.999_999, -0.7] {
        let mut contact = ball(0.0);
        contact.apply(&forces(share * FRICTION * LOAD, LOAD)).unwrap();
        let state = contact.state();
        assert_eq!(state.regime, Regime::Stick);
        close(state.displacement, E_STAR / G_STAR * share * FRICTION * indentation(LOAD), 1e-14);
        close(state.force, share * FRICTION * LOAD, 1e-14);
        assert!(state.dissipated_energy.abs() <= 0.0);
        assert_eq!(state.memory_depth, 1, "one straight stretch is one piece");
    }
}

#[test]
fn steeper_than_the_friction_angle_slips_like_a_lighter_contact() {
    // Ciavarella and Jäger: the traction is mu p less mu times that of the contact under N_c = N - F/mu.
    for force in [1.0, 4.0, 9.0, 9.99] {
        let (before, after) = (LOAD, 25.0);
        let mut contact = ball(before);
        if force <= FRICTION * (after - before) {
            continue;
        }
        contact.apply(&forces(force, after)).unwrap();
        let held = after - force / FRICTION;
        let state = contact.state();
        close(state.force, force, 1e-13);
        close(state.displacement, FRICTION * E_STAR / G_STAR * (indentation(after) - indentation(held)), 1e-12);
        close(state.stick_radius, contact_radius(held), 1e-11);
    }
}

#[test]
fn lowering_the_load_under_a_steady_pull_shrinks_the_stick_circle() {
    let pull = 4.0;
    let mut contact = ball(LOAD);
    contact.apply(&Move { tangential: Some(Tangential::Force(pull)), ..Move::default() }).unwrap();
    for load in [18.0, 14.0, 10.5, 10.0 + 1e-9] {
        contact.apply(&forces(pull, load)).unwrap();
        let held = load - pull / FRICTION;
        let state = contact.state();
        close(state.force, pull, 1e-13);
        // Where little is held, its size keeps the digits that the difference of the loads has.
        close(state.stick_radius, contact_radius(held), 1e-15 * load / held + 1e-12);
        close(state.displacement, FRICTION * E_STAR / G_STAR * (indentation(load) - indentation(held)), 1e-12);
    }
    let refused = contact.apply(&forces(pull, 5.0)).unwrap_err();
    let Error::ForceExceedsFriction { limit, part, .. } = refused else { panic!("{refused}") };
    close(limit, pull, 1e-12);
    assert!(part < 1e-9, "the limit is met at once, not {part}");
}

/// Tangential force after (U, F_N) has gone straight from (0, `from`) to (`shift`, `to`) without slip: each ring
/// carries what was moved since its touch, 2 G* int (U_1 - U(x)) dx with U(x) from F_N(x) = 4 E* x^3/(3 R).
fn pressed_while_moving(from: f64, to: f64, shift: f64) -> f64 {
    let (inner, outer) = (contact_radius(from), contact_radius(to));
    let ring = outer.powi(3) * (outer - inner) - (outer.powi(4) - inner.powi(4)) / 4.0;
    let lag = 4.0 * E_STAR / (3.0 * RADIUS) / (to - from);
    2.0 * G_STAR * shift * (inner + lag * ring)
}

#[test]
fn moving_while_the_normal_force_rises_meets_the_tolerance_and_says_so() {
    let (from, to) = (LOAD, 35.0);
    let shift = 0.3 * FRICTION * E_STAR / G_STAR * (indentation(to) - indentation(from));
    let expected = pressed_while_moving(from, to, shift);
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-10] {
        let mut contact = ball(from);
        contact.apply_within(&slide_and_press(shift, to), tolerance).unwrap();
        let state = contact.state();
        assert_eq!(state.regime, Regime::Stick);
        let error = (state.force - expected).abs() / (FRICTION * to);
        let estimate = contact.accuracy().force_error;
        assert!(error <= tolerance, "{error:e} at {tolerance:e}");
        assert!(error <= 3.0 * estimate && estimate <= tolerance + 1e-14, "{error:e} against {estimate:e}");
        close(state.normal_force, to, 0.0);
        close(state.displacement, shift, 0.0);
    }
}

#[test]
fn pulling_while_the_indentation_grows_has_the_displacement_of_a_growing_stiffness() {
    // Without slip dF = 2 G* a dU, and F is straight in d: U = F/(2 G* (d1 - d0)) int dd/sqrt(R d).
    let (from, to) = (indentation(LOAD), 1.6 * indentation(LOAD));
    let force = 1.0;
    let expected = force / (G_STAR * (to - from)) * (to.sqrt() - from.sqrt()) / RADIUS.sqrt();
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let mut contact = ball(LOAD);
        contact.apply_within(&push_and_sink(force, to), tolerance).unwrap();
        close(contact.state().force, force, 1e-13);
        let error = (contact.state().displacement - expected).abs() / expected;
        assert!(error <= 10.0 * tolerance, "{error:e} at {tolerance:e}");
    }
}

#[test]
fn a_path_in_two_forces_equals_itself_in_parts() {
    let stations = [(3.0, 20.0), (-2.0, 16.0), (6.0, 30.0), (-6.0, 30.0), (1.0, 18.0)];
    let mut whole = ball(LOAD);
    let mut parts = ball(LOAD);
    let mut here = (0.0, LOAD);
    for station in stations {
        whole.apply(&forces(station.0, station.1)).unwrap();
        for index in 1..=7 {
            let part = f64::from(index) / 7.0;
            let (force, load) = (here.0 + (station.0 - here.0) * part, here.1 + (station.1 - here.1) * part);
            parts.apply(&forces(force, load)).unwrap();
        }
        here = station;
        let (whole, parts) = (whole.state(), parts.state());
        let full = FRICTION * E_STAR / G_STAR * indentation(station.1);
        assert!((whole.displacement - parts.displacement).abs() < 1e-8 * full);
        assert!((whole.dissipated_energy - parts.dissipated_energy).abs() < 1e-8 * full * FRICTION * station.1);
    }
}

#[test]
fn the_first_instant_that_friction_cannot_hold_is_named() {
    // mu (20 - 10 t) = 6 t at t = 0.8, where both are 4.8 N; the contact has not moved.
    let mut contact = ball(LOAD);
    let before = contact.state();
    let refused = contact.apply(&forces(6.0, 10.0)).unwrap_err();
    let Error::ForceExceedsFriction { target, limit, part } = refused else { panic!("{refused}") };
    close(part, 0.8, 1e-12);
    close(limit, 4.8, 1e-12);
    close(target, 6.0, 0.0);
    assert_eq!(contact.state(), before);
    // Straight in the indentation the load dips below the pull on the way, though it holds at both ends.
    let mut contact = ball(LOAD);
    contact.apply(&Move { tangential: Some(Tangential::Force(7.9)), ..Move::default() }).unwrap();
    let refused = contact.apply(&push_and_sink(-7.9, 0.9999 * indentation(LOAD))).err();
    assert_eq!(refused, None, "a pull that falls faster than the load can be held");
    let refused = contact.apply(&push_and_sink(-7.8, 0.5 * indentation(LOAD))).unwrap_err();
    assert!(matches!(refused, Error::ForceExceedsFriction { .. }));
    // 2.82 N are held at the end, where mu F_N = 8 N / 2^(3/2), but not 5.36 N half-way, where it is 8 N (3/4)^(3/2).
    let mut contact = ball(LOAD);
    contact.apply(&Move { tangential: Some(Tangential::Force(7.9)), ..Move::default() }).unwrap();
    let before = contact.state();
    let refused = contact.apply(&push_and_sink(2.82, 0.5 * indentation(LOAD))).unwrap_err();
    let Error::ForceExceedsFriction { limit, part, .. } = refused else { panic!("{refused}") };
    assert!(part > 0.05 && part < 0.2, "{part}");
    close(limit, 7.9 + (2.82 - 7.9) * part, 1e-12);
    close(limit, FRICTION * LOAD * (1.0 - 0.5 * part).powf(1.5), 1e-12);
    assert_eq!(contact.state(), before);
}

#[test]
fn without_friction_only_displacements_can_be_asked_for() {
    let mut contact = Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(RADIUS).unwrap()),
        elasticity: Elasticity::effective(E_STAR, G_STAR).unwrap(),
        friction: 0.0,
        preload: Preload::NormalForce(LOAD),
    })
    .unwrap();
    contact.apply(&slide_and_press(1e-6, 30.0)).unwrap();
    let state = contact.state();
    assert_eq!(state.regime, Regime::GrossSlip);
    for nothing in [state.force, state.stick_radius, state.elastic_energy, state.dissipated_energy, contact.shear(0.0)]
    {
        assert!(nothing.abs() <= 0.0);
    }
    assert!(contact.apply(&forces(1e-9, 30.0)).is_err());
}

#[test]
fn a_gap_closes_before_the_normal_force_rises() {
    let mut contact = ball(LOAD);
    contact.apply(&Move { normal: Some(Normal::Indentation(-1e-6)), ..Move::default() }).unwrap();
    assert_eq!(contact.state().regime, Regime::Separated);
    contact.apply(&forces(2.0, LOAD)).unwrap();
    let mut fresh = ball(0.0);
    fresh.apply(&forces(2.0, LOAD)).unwrap();
    assert_eq!(contact.state(), fresh.state());
}

#[test]
fn the_default_tolerance_is_met_from_no_load_on() {
    // Straight from no load: the contact radius grows like the cube root of the force, steepest at first.
    let touching = || ball(0.0);
    let load = Some(Normal::NormalForce(LOAD));
    let mut contact = touching();
    contact.apply(&Move { normal: load, ..displace(1e-9) }).unwrap();
    // A displacement that grows with the force keeps U/F, and dU/dd falls with d: nothing slips where U is this small
    // beside d, and F = 2 G* int a dU = 2 G* (3/2 a) U - G* U a: with a ~ F^(1/3) and U ~ F, int a dU = (3/4) a U.
    let expected = 2.0 * G_STAR * 0.75 * contact_radius(LOAD) * 1e-9;
    assert!((contact.force() - expected).abs() < 1e-10 * FRICTION * LOAD, "{:e}", contact.force() - expected);
    let error = contact.accuracy().path_error;
    assert!(error <= 1e-10, "{error:e}");

    let mut sliding = touching();
    let far = 10.0 * FRICTION * E_STAR / G_STAR * indentation(LOAD);
    sliding.apply(&Move { normal: load, ..displace(far) }).unwrap();
    // All of it slips: the force is at its limit, whatever the way.
    assert_eq!(sliding.state().regime, Regime::GrossSlip);
    assert!((sliding.force() / (FRICTION * LOAD) - 1.0).abs() < 1e-14);
    assert!(sliding.accuracy().path_error <= 0.0);
}
