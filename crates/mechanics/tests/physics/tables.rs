//! The error of a table against the body that it was taken from. `--nocapture` prints the numbers of `docs/tables.md`.

use crate::support::displace;
use stickslip_mechanics::profile::{ExactSphere, Tabulated};
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

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
