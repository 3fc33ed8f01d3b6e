//! The results of Kraft & Pohrt (2016), as corrected: falling amplitude on a sphere.

use crate::support::displace;
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup, Sphere};

const FRICTION: f64 = 0.3;

fn sphere_contact() -> Contact {
    Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(10.0).unwrap()),
        elasticity: Elasticity::effective(1000.0, 800.0).unwrap(),
        friction: FRICTION,
        preload: Preload::ContactRadius(0.5),
    })
    .unwrap()
}

/// The contact after the first `moves` positions of eq. 20.
fn after(reversals: usize, moves: usize) -> Contact {
    let mut contact = sphere_contact();
    let amplitude = contact.summary().gross_slip_displacement;
    for target in falling_amplitude(reversals, amplitude).take(moves) {
        contact.apply(&displace(target)).unwrap();
    }
    contact
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found:e} is not {expected:e} within {tolerance:e}");
}

#[test]
fn eq_20_alternates_falls_and_ends_at_zero() {
    let path: Vec<f64> = falling_amplitude(4, 2.0).collect();
    let expected = [2.0, -1.5, 1.0, -0.5, 0.0];
    assert_eq!(path.len(), expected.len());
    for (found, expected) in path.iter().zip(expected) {
        close(*found, expected, 0.0);
    }
}

#[test]
fn force_at_the_end_is_not_zero() {
    // F/(mu F_N) at U = 0 after a full stroke and back, by Masing's rule: 1 - 2 (1 - (1 - 1/2)^(3/2)).
    let by_hand = 1.0 - 2.0 * (1.0 - 0.5_f64.powf(1.5));
    for (reversals, expected, tolerance) in
        [(1, by_hand, 1e-14), (1, -0.2929, 5e-5), (2, -0.04904, 5e-6), (20, -0.002045, 5e-7)]
    {
        let contact = after(reversals, reversals + 1);
        let limit = contact.summary().gross_slip_force;
        close(contact.state().force / limit, expected, tolerance);
    }
}

#[test]
fn largest_shear_stress_falls_with_the_root_of_the_reversals() {
    for reversals in (1..=40).chain([100, 1000]) {
        let contact = after(reversals, reversals + 1);
        let unit = FRICTION * contact.summary().max_pressure.unwrap();
        let expected = if reversals == 1 { 0.5_f64.sqrt() } else { (2.0 - 1.5_f64.sqrt()) / (reversals as f64).sqrt() };
        let residual = contact.residual();
        close(residual.max.unwrap() / unit, expected, 1e-12);
        assert_eq!(residual.peaks.len(), reversals, "one interior extremum a reversal");
        assert!(residual.min.unwrap() <= residual.mean.unwrap() && residual.mean <= residual.max);
        for pair in residual.peaks.windows(2) {
            assert!(pair[0].radius < pair[1].radius && pair[0].shear * pair[1].shear < 0.0, "peaks alternate");
        }
    }
    close((2.0 - 1.5_f64.sqrt()) / 2.0_f64.sqrt(), 0.5482, 5e-5);
}

#[test]
fn stick_radii_of_figure_3() {
    // Point A is the sixth reversal of twenty, point B the way back from it to U = 0.
    let mut contact = after(20, 6);
    let state = contact.state();
    let scale = contact.summary().gross_slip_displacement;
    close(state.displacement / scale, -0.75, 1e-15);
    // The last stroke went from 0.8 to -0.75 u_max, and half of it slipped: c^2 = a^2 (1 - 1.55/2).
    close(state.stick_radius / state.contact_radius, 0.225_f64.sqrt(), 1e-13);
    close(state.stick_radius / state.contact_radius, 0.474, 5e-4);
    contact.apply(&displace(0.0)).unwrap();
    let state = contact.state();
    close(state.stick_radius / state.contact_radius, 0.625_f64.sqrt(), 1e-13);
    close(state.stick_radius / state.contact_radius, 0.791, 5e-4);
}

#[test]
fn friction_work_of_the_reference_contact() {
    let mut contact = Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(10.0).unwrap()),
        elasticity: Elasticity::effective(1000.0, 1000.0).unwrap(),
        friction: FRICTION,
        preload: Preload::ContactRadius(0.5),
    })
    .unwrap();
    let full = contact.summary().gross_slip_displacement;
    let fresh = contact.clone();
    contact.apply(&displace(0.5 * full)).unwrap();
    close(contact.state().dissipated_energy, 0.000_682_427, 5e-10);
    contact.apply(&displace(-0.25 * full)).unwrap();
    close(contact.state().dissipated_energy, 0.001_233_126, 5e-10);
    let mut contact = fresh;
    for target in falling_amplitude(20, full) {
        contact.apply(&displace(target)).unwrap();
    }
    close(contact.state().dissipated_energy, 0.071_643_3, 5e-8);
}
