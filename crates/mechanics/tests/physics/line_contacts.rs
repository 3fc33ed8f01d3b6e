//! Contacts along a line against closed forms, their own laws, and boundary elements.

use stickslip_mechanics::cycle::{Drive, SteadyCycle};
use stickslip_mechanics::profile::{LineBulk, LineContact};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Body, Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

const E: f64 = 7.4e10;
const NU: f64 = 0.33;

fn alike() -> Elasticity {
    let body = Body::new(E, NU).unwrap();
    Elasticity::of_bodies(body, body)
}

fn contact(line: LineContact, preload: Preload) -> Contact {
    Contact::new(Setup { profile: Profile::Line(line), elasticity: alike(), friction: 0.6, preload }).unwrap()
}

fn cylinder() -> LineContact {
    LineContact::cylinder(0.05, 0.01, Some(0.1)).unwrap()
}

fn pad() -> LineContact {
    LineContact::rounded_pad(5e-4, 0.05, 0.01, Some(0.02)).unwrap()
}

fn by_force(force: f64) -> Move {
    Move { tangential: Some(Tangential::Force(force)), ..Move::default() }
}

fn assert_near(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() <= error * expected.abs(), "{found} is not {expected}");
}

/// p0 = 160 MPa on aluminium, as in Nowell & Hills' tests, with sigma = 1.2 p0 Q/P in the second body.
fn nowell_and_hills(bulk: bool) -> (Contact, f64, f64) {
    let (p0, e_star) = (1.6e8, alike().e_star());
    let half_width = 2.0 * p0 * 0.05 / e_star;
    let line_load = std::f64::consts::FRAC_PI_2 * p0 * half_width;
    assert_near(half_width, 3.85340540541e-4, 1e-11);
    assert_near(line_load, 96846.6409034, 1e-11);
    let body = Body::new(E, NU).unwrap();
    let stress = LineBulk::new(Side::Second, 1.2 * p0 / (line_load * 0.01), Some(body)).unwrap();
    let line = if bulk { cylinder().with_bulk(stress).unwrap() } else { cylinder() };
    let mut contact = contact(line, Preload::NormalForce(line_load * 0.01));
    for share in [0.5, -0.5, 0.5, -0.2, 0.1] {
        contact.apply(&by_force(share * 0.6 * line_load * 0.01)).unwrap();
    }
    (contact, p0, half_width)
}

#[test]
fn the_shear_of_eccentric_zones_and_the_stress_below_it_are_the_printed_values() {
    let (contact, p0, a) = nowell_and_hills(true);
    let expected = [0.243104915623, 0.166177503909, 0.061446284913, 0.060153085570, 0.141067359797];
    let shears = contact.shears(&[-0.97, -0.5, 0.1, 0.7, 0.99].map(|x| x * a));
    for (found, expected) in shears.into_iter().zip(expected) {
        assert_near(found / (0.6 * p0), expected, 1e-10);
    }
    let field = contact.subsurface(Side::Second, NU).unwrap();
    let tensors = [
        ([0.95, 0.02], [-0.267916190567, -0.199922013200, -0.265908091857, -0.074394093136]),
        ([-0.8, 0.1], [-0.356108441169, -0.350726191518, -0.634698199795, 0.070828383902]),
    ];
    for ([x, z], [xx, yy, zz, xz]) in tensors {
        let stress = field.at([x * a, 0.3 * a, z * a]);
        for (found, expected) in [stress.xx, stress.yy, stress.zz, stress.xz].into_iter().zip([xx, yy, zz, xz]) {
            assert_near(found / p0, expected, 1e-10);
        }
    }
}

#[test]
fn a_cylinder_approaches_and_dissipates_as_printed() {
    let load = 968.466409034;
    let contact = contact(cylinder(), Preload::NormalForce(load));
    assert_near(contact.indentation(), 8.99654751374e-6, 1e-11);
    for (share, work) in [(0.3, 5.516112568281e-6), (0.9, 2.741122679008e-4)] {
        let cycle = SteadyCycle::driven(&contact, Drive::Force(share * 0.6 * load), 0.0).unwrap();
        assert_near(cycle.dissipated_energy(), work, 1e-10);
    }
}

#[test]
fn a_pad_has_the_printed_load_pressure_and_approach() {
    let a = 8e-4;
    let contact = contact(pad(), Preload::ContactRadius(a));
    let e_star = contact.elasticity().e_star();
    assert_near(contact.normal_force() / (e_star * 0.01), 2.60975568149e-6, 1e-11);
    assert_near(contact.indentation(), 5.61627255403e-6, 1e-11);
    let pressures = contact.pressures(&[0.0, 0.5, 0.63, 0.9].map(|x| x * a));
    let expected = [0.00122898095884, 0.00155800151099, 0.00212315528997, 0.00185695142654];
    for (found, expected) in pressures.into_iter().zip(expected) {
        assert_near(found / e_star, expected, 1e-10);
    }
}

#[test]
fn zz_debug() {
    let load = 968.466409034;
    let mut contact = contact(cylinder(), Preload::NormalForce(load));
    println!("{:?}", contact.summary());
    let p = contact.profile();
    let whole = stickslip_mechanics::profile::Ring::between(p.point(0.0.into()), p.point(contact.indentation().into()));
    println!("{:?} {:?}", whole, p.moments(&whole));
    for share in [0.3, 0.5, 0.9, 0.99] {
        let cycle = SteadyCycle::driven(&contact, Drive::Force(share * 0.6 * load), 0.0).unwrap();
        println!("{share} {} {} {} {}", cycle.dissipated_energy(), cycle.stick_radius(), cycle.force_amplitude(), cycle.displacement_amplitude());
    }
    contact.apply(&by_force(0.5 * 0.6 * load)).unwrap();
    println!("{:?}", contact.state());
    let (b, p0, a) = nowell_and_hills(true);
    println!("{:?}", b.state());
    println!("{:?}", b.shears(&[-0.97, -0.5, 0.1, 0.7, 0.99].map(|x| x * a)).iter().map(|x| x/(0.6*p0)).collect::<Vec<_>>());
    let (b, p0, a) = nowell_and_hills(false);
    println!("{:?}", b.shears(&[-0.97, -0.5, 0.1, 0.7, 0.99].map(|x| x * a)).iter().map(|x| x/(0.6*p0)).collect::<Vec<_>>());
}
