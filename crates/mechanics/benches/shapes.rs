//! What the shape costs, over the same on a sphere: 20 reversals with the shear stress at 200 radii, a move with its force, all
//! extrema of the shear stress after 20 reversals, and the displacement of the surface at a radius, one of 200, in the same state.
//!
//! `cargo bench -p stickslip-mechanics --bench shapes` prints a table. Each run of a shape follows one of the sphere, and the ratio is
//! the median over such pairs, so that other work on the machine counts on both sides.

use std::hint::black_box;
use std::time::{Duration, Instant};

use stickslip_mechanics::profile::{
    Cone, ExactSphere, PowerLaw, RoundedCone, RoundedPunch, Sum, Tabulated, TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};

const REVERSALS: usize = 20;
const RADII: usize = 200;
const MOVES: usize = 1000;
const PAIRS: usize = 25;

/// The time of a piece of work on a new contact.
type Scene = fn(&Contact) -> Duration;

const BALL: f64 = 0.01;
const VALID: &str = "valid parameters";

fn table(points: u32) -> Profile {
    let radii: Vec<f64> = (0..points).map(|index| 2e-4 * f64::from(index) / f64::from(points - 1)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / (BALL + ((BALL - r) * (BALL + r)).sqrt())).collect();
    Profile::Tabulated(Tabulated::new(&radii, &heights).expect(VALID))
}

fn contact(profile: Profile) -> Contact {
    let elasticity = Elasticity::effective(1.15e11, 8.5e10).expect(VALID);
    Contact::new(Setup { profile, elasticity, friction: 0.3, preload: Preload::NormalForce(10.0) }).expect(VALID)
}

fn slide(contact: &mut Contact, target: f64) {
    let step = Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() };
    contact.apply(&step).expect("a displacement has no limit");
}

/// A new contact after falling reversals.
fn reversed(virgin: &Contact) -> Contact {
    let mut contact = virgin.clone();
    for target in falling_amplitude(REVERSALS, virgin.gross_slip_displacement()) {
        slide(&mut contact, target);
    }
    contact
}

/// The time of the reversals and the shear stress.
fn stresses(virgin: &Contact) -> Duration {
    let edge = virgin.contact_radius();
    let radii: Vec<f64> = (0..RADII).map(|index| edge * index as f64 / RADII as f64).collect();
    let start = Instant::now();
    black_box(reversed(virgin).shears(&radii));
    start.elapsed()
}

/// The time of moves to and fro, each with its force.
fn moves(virgin: &Contact) -> Duration {
    let (mut contact, full) = (virgin.clone(), virgin.gross_slip_displacement());
    let mut random = fastrand::Rng::with_seed(1);
    let start = Instant::now();
    for _ in 0..MOVES {
        slide(&mut contact, (2.0 * random.f64() - 1.0) * full);
        black_box(contact.force());
    }
    start.elapsed()
}

/// The time of the displacement of the surface.
fn displacements(virgin: &Contact) -> Duration {
    let (contact, edge) = (reversed(virgin), virgin.contact_radius());
    let radii: Vec<f64> = (0..RADII).map(|index| edge * index as f64 / RADII as f64).collect();
    let start = Instant::now();
    black_box(contact.surface_displacements(&radii));
    start.elapsed()
}

/// The time of the extrema.
fn extrema(virgin: &Contact) -> Duration {
    let contact = reversed(virgin);
    let start = Instant::now();
    black_box(contact.residual());
    start.elapsed()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let sphere = contact(Profile::Sphere(Sphere::new(BALL).expect(VALID)));
    let power = |exponent, coefficient| Profile::PowerLaw(PowerLaw::new(exponent, coefficient).expect(VALID));
    let sum = [Profile::Sphere(Sphere::new(BALL).expect(VALID)), power(4.0, 1e6)];
    let shapes = [
        ("sphere", Profile::Sphere(Sphere::new(BALL).expect(VALID))),
        ("cone", Profile::Cone(Cone::new(0.05).expect(VALID))),
        ("power 4", power(4.0, 1e6)),
        ("power 2.7", power(2.7, 1e4)),
        ("exact sphere", Profile::ExactSphere(ExactSphere::new(BALL).expect(VALID))),
        ("truncated sphere", Profile::TruncatedSphere(TruncatedSphere::new(BALL, 5e-5).expect(VALID))),
        ("truncated cone", Profile::TruncatedCone(TruncatedCone::new(0.05, 5e-5).expect(VALID))),
        ("rounded punch", Profile::RoundedPunch(RoundedPunch::new(5e-5, BALL).expect(VALID))),
        ("rounded cone", Profile::RoundedCone(RoundedCone::new(0.05, 5e-5).expect(VALID))),
        ("sphere and fourth power", Profile::Sum(Sum::new(sum.to_vec()).expect(VALID))),
        ("table of 1000 points", table(1_000)),
        ("table of 10 000 points", table(10_000)),
    ];
    println!(
        "| shape | stress at 200 radii, us | over the sphere's | a move, us | over the sphere's | extrema, us | over the sphere's | displacement at a radius, us | over the sphere's |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, profile) in shapes {
        let shape = contact(profile);
        let figures =
            [(stresses as Scene, 1), (moves, MOVES), (extrema, 1), (displacements, RADII)].map(|(scene, count)| {
                let (mut times, mut ratios) = (Vec::new(), Vec::new());
                for _ in 0..PAIRS {
                    let unit = scene(&sphere).as_secs_f64();
                    let time = scene(&shape).as_secs_f64();
                    times.push(1e6 * time / count as f64);
                    ratios.push(time / unit);
                }
                format!("{:.3} | {:.1}", median(times), median(ratios))
            });
        println!("| {name} | {} |", figures.join(" | "));
    }
}
