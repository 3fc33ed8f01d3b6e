//! The cost of fits of loops: `cargo bench -p stickslip-measured`. Compare the figures with each other.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use stickslip_measured::loops::{Known, Noise, Parameter, Record, Start, Task, fit};
use stickslip_mechanics::profile::{Cone, ExactSphere, LoadCurve, PowerLaw, RoundedPunch, Tabulated};
use stickslip_mechanics::{Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};

const RADIUS: f64 = 0.01;
const POINTS: usize = 500;
const FREE: [Parameter; 5] = [
    Parameter::Friction,
    Parameter::GStar,
    Parameter::MachineCompliance,
    Parameter::DisplacementOffset,
    Parameter::ForceOffset,
];

fn elasticity() -> Elasticity {
    Elasticity::effective(1.15e11, 8.5e10).expect("valid moduli")
}

fn contact(profile: Profile, friction: f64) -> Contact {
    Contact::new(Setup { profile, elasticity: elasticity(), friction, preload: Preload::NormalForce(10.0) })
        .expect("a valid contact")
}

/// A loop with 1 % of noise that reaches gross slip, from its first move on, behind a machine.
fn task(profile: &Profile) -> Task {
    let mut truth = contact(profile.clone(), 0.42);
    let amplitude = 1.5 * truth.gross_slip_displacement();
    let mut random = fastrand::Rng::with_seed(1);
    let (mut displacement, mut force) = (vec![], vec![]);
    for point in 0..POINTS {
        let place = amplitude * (2.5 * std::f64::consts::TAU * point as f64 / POINTS as f64).sin();
        let tangential = Some(Tangential::Displacement(place));
        truth.apply(&Move { tangential, ..Move::default() }).expect("a valid move");
        displacement.push(place + 3e-8 * truth.force() + 1e-8);
        force.push(truth.force() + 0.05 + 0.04 * (random.f64() + random.f64() + random.f64() - 1.5) * 2.0);
    }
    let start = Some(Start::Virgin);
    let record = Record { displacement, force, time: None, normal_force: None, start, weight: 1.0 };
    let contact = contact(profile.clone(), 0.3);
    Task { contact, records: vec![record], free: FREE.to_vec(), known: vec![], noise: Noise::default() }
}

fn fits(criterion: &mut Criterion) {
    let radii: Vec<f64> = (0..1000).map(|index| 2e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / (2.0 * RADIUS)).collect();
    let curve: Vec<f64> = (0..1000).map(|index| 1e-9 * f64::from(index)).collect();
    let forces: Vec<f64> = curve.iter().map(|depth| 1.5e10 * depth.powf(1.5)).collect();
    let profiles = [
        ("sphere", Profile::Sphere(Sphere::new(RADIUS).expect("valid"))),
        ("cone", Profile::Cone(Cone::new(0.01).expect("valid"))),
        ("power 2.7", Profile::PowerLaw(PowerLaw::new(2.7, 1e4).expect("valid"))),
        ("exact sphere", Profile::ExactSphere(ExactSphere::new(RADIUS).expect("valid"))),
        ("rounded punch", Profile::RoundedPunch(RoundedPunch::new(5e-5, 1e-3).expect("valid"))),
        ("table of 1000", Profile::Tabulated(Tabulated::new(&radii, &heights).expect("valid"))),
        ("load curve of 1000", Profile::LoadCurve(LoadCurve::new(&curve, &forces, &elasticity()).expect("valid"))),
    ];
    let mut group = criterion.benchmark_group("fit of 500 points, five parameters");
    group.sample_size(10);
    for (name, profile) in profiles {
        let task = task(&profile);
        group.bench_function(format!("{name}, with intervals"), |bencher| {
            bencher.iter(|| fit(black_box(&task), &|| true).expect("a fit"));
        });
    }
    group.finish();
}

/// Steady cycles of a sine with 1 % of noise in the force and 0.5 % in the displacement; friction and modulus are
/// sought.
fn steady(points: usize, cycles: usize) -> Task {
    let profile = Profile::Sphere(Sphere::new(RADIUS).expect("valid"));
    let mut truth = contact(profile.clone(), 0.42);
    let gross_slip = truth.gross_slip_displacement();
    let mut random = fastrand::Rng::with_seed(1);
    let mut noise = || (random.f64() + random.f64() + random.f64() - 1.5) * 2.0;
    let (mut displacement, mut force) = (vec![], vec![]);
    // The first cycle is run before the record begins.
    for point in 0..points + points / cycles {
        let turn = std::f64::consts::TAU * cycles as f64 * point as f64 / points as f64;
        let place = 1.5 * gross_slip * (turn + 0.3).sin();
        let tangential = Some(Tangential::Displacement(place));
        truth.apply(&Move { tangential, ..Move::default() }).expect("a valid move");
        if point >= points / cycles {
            displacement.push(place + 0.005 * gross_slip * noise());
            force.push(truth.force() + 0.04 * noise());
        }
    }
    let start = Some(Start::Steady);
    let record = Record { displacement, force, time: None, normal_force: None, start, weight: 1.0 };
    let known = vec![Known { parameter: Parameter::MachineCompliance, value: 0.0, standard_error: 0.0 }];
    let free = vec![Parameter::Friction, Parameter::GStar];
    Task { contact: contact(profile, 0.3), records: vec![record], free, known, noise: Noise::default() }
}

fn sizes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("fit of friction and modulus, noise of both columns");
    group.sample_size(10);
    for (points, cycles) in [(400, 4), (10_000, 10)] {
        let task = steady(points, cycles);
        group.bench_function(format!("{points} points, {cycles} cycles"), |bencher| {
            bencher.iter(|| fit(black_box(&task), &|| true).expect("a fit"));
        });
    }
    group.finish();
}

criterion_group!(benches, fits, sizes);
criterion_main!(benches);
