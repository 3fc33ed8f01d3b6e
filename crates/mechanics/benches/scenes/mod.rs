//! Shared by the benchmarks: a contact of each shape, under the same load.

use stickslip_mechanics::profile::{PowerLaw, Sum, Tabulated, families};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Body, Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};

pub const BALL: f64 = 0.01;
pub const VALID: &str = "valid parameters";

/// The sphere in Hertz's approximation.
pub fn sphere() -> Profile {
    Profile::Sphere(Sphere::new(BALL).expect(VALID))
}

/// Radii and heights of so many points of an exact sphere, or of the parabola at its tip.
pub fn points(count: u32, parabola: bool) -> (Vec<f64>, Vec<f64>) {
    let radii: Vec<f64> = (0..count).map(|index| 2e-4 * f64::from(index) / f64::from(count - 1)).collect();
    let root = |r: f64| if parabola { BALL } else { ((BALL - r) * (BALL + r)).sqrt() };
    let heights = radii.iter().map(|r| r * r / (BALL + root(*r))).collect();
    (radii, heights)
}

/// A table of so many points of an exact sphere.
pub fn table(count: u32) -> Profile {
    let (radii, heights) = points(count, false);
    Profile::Tabulated(Tabulated::new(&radii, &heights).expect(VALID))
}

/// Steel on steel.
pub fn elasticity() -> Elasticity {
    let steel = Body::new(2.1e11, 0.3).expect(VALID);
    Elasticity::of_bodies(steel, steel)
}

/// The virgin contact of a profile under 10 N.
pub fn contact(profile: Profile) -> Contact {
    let elasticity = elasticity();
    Contact::new(Setup { profile, elasticity, friction: 0.3, preload: Preload::NormalForce(10.0) }).expect(VALID)
}

/// Moves to a displacement, m.
pub fn slide(contact: &mut Contact, target: f64) {
    let step = Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() };
    contact.apply(&step).expect("a displacement has no limit");
}

/// The contact after reversals of falling amplitude: about as many pieces of slip history.
pub fn reversed(virgin: &Contact, reversals: usize) -> Contact {
    let mut contact = virgin.clone();
    for target in falling_amplitude(reversals, virgin.gross_slip_displacement()) {
        slide(&mut contact, target);
    }
    contact
}

/// So many radii from the centre on, evenly spaced below the edge, m.
pub fn radii(contact: &Contact, count: usize) -> Vec<f64> {
    (0..count).map(|index| contact.contact_radius() * index as f64 / count as f64).collect()
}

/// Every shape with its name, the sphere first.
pub fn shapes() -> Vec<(&'static str, Profile)> {
    let power = |exponent, coefficient| Profile::PowerLaw(PowerLaw::new(exponent, coefficient).expect(VALID));
    let sum = |other| Profile::Sum(Sum::new(vec![sphere(), other]).expect(VALID));
    let mut shapes: Vec<_> =
        families().iter().map(|family| (family.name, (family.make)(&family.example()).expect(VALID))).collect();
    shapes.retain(|(_, profile)| profile.indenter().rim_radius().is_none());
    shapes.extend([
        ("power 2.7", power(2.7, 1e4)),
        ("sphere and fourth power", sum(power(4.0, 1e6))),
        ("table of 1000 points", table(1_000)),
        ("table of 10 000 points", table(10_000)),
        ("sphere and table of 1000 points", sum(table(1_000))),
    ]);
    shapes
}
