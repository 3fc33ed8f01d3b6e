//! The cost of moves, stresses and searches: `cargo bench -p stickslip-mechanics`. Compare the figures with each other.

use std::hint::black_box;
use std::sync::Arc as Arced;

use criterion::{Criterion, criterion_group, criterion_main};
use stickslip_mechanics::cycle::{Drive, OscillatingLoad, Oscillation, SteadyCycle, TimedCycle};
use stickslip_mechanics::profile::{Asperities, Cone, ExactSphere, PowerLaw, RoundedPunch, Tabulated, TruncatedCone};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::rings::{EllipseArc, Options, PlanarMove, PlanarTarget, follow};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{
    Contact, Elasticity, Friction, Law, Move, Normal, Preload, Profile, Prony, PronyTerm, Setup, Sphere, Springs,
    Tangential,
};

const REVERSALS: usize = 20;
const RADII: usize = 200;

fn setup() -> Setup {
    Setup {
        profile: Profile::Sphere(Sphere::new(0.01).expect("a valid radius")),
        elasticity: Elasticity::effective(1.15e11, 8.5e10).expect("valid moduli"),
        friction: 0.3,
        preload: Preload::NormalForce(10.0),
    }
}

fn virgin() -> Contact {
    Contact::new(setup()).expect("a valid contact")
}

fn to(displacement: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() }
}

fn exact_scene() -> f64 {
    let mut contact = virgin();
    let figures = contact.summary();
    for target in falling_amplitude(REVERSALS, figures.gross_slip_displacement) {
        contact.apply(&to(target)).expect("a displacement has no limit");
    }
    let radii: Vec<f64> = (0..RADII).map(|index| figures.contact_radius * index as f64 / RADII as f64).collect();
    contact.shears(&radii).into_iter().sum()
}

fn springs_scene(count: usize) -> f64 {
    let figures = virgin().summary();
    let mut springs = Springs::new(setup(), count, figures.contact_radius).expect("a valid count");
    for target in falling_amplitude(REVERSALS, figures.gross_slip_displacement) {
        springs.apply(&to(target)).expect("a displacement has no limit");
    }
    (0..RADII).map(|index| springs.shear(figures.contact_radius * index as f64 / RADII as f64)).sum()
}

/// Random positions within gross slip, the same in every run.
fn positions(count: usize, unit: f64) -> Vec<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (2.0 * next() - 1.0) * unit).collect()
}

fn moves(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("move at constant load");
    for history in [1_000, 10_000_000] {
        let mut contact = virgin();
        let path = positions(history, contact.summary().gross_slip_displacement);
        for &target in &path {
            contact.apply(&to(target)).expect("a displacement has no limit");
        }
        let mut targets = path.iter().cycle();
        group.bench_function(format!("after {history} moves"), |bencher| {
            bencher.iter(|| contact.apply(&to(*targets.next().expect("the cycle is endless"))));
        });
    }
    group.finish();
}

/// The same moves, with the force after each, on a sphere, on its closed form and on a table of its points.
fn profiles(criterion: &mut Criterion) {
    const POINTS: usize = 1_000;
    const BALL: f64 = 0.01;
    let radii: Vec<f64> = (0..POINTS).map(|index| 2e-4 * index as f64 / (POINTS - 1) as f64).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / (BALL + ((BALL - r) * (BALL + r)).sqrt())).collect();
    let mut group = criterion.benchmark_group("move and force by profile");
    for (name, profile) in [
        ("sphere", setup().profile),
        ("exact sphere", Profile::ExactSphere(ExactSphere::new(BALL).expect("a valid radius"))),
        ("table of 1000 points", Profile::Tabulated(Tabulated::new(&radii, &heights).expect("a convex table"))),
    ] {
        let mut contact = Contact::new(Setup { profile, ..setup() }).expect("a valid contact");
        let path = positions(1_000, contact.summary().gross_slip_displacement);
        let mut targets = path.iter().cycle();
        group.bench_function(name, |bencher| {
            bencher
                .iter(|| contact.apply(&to(*targets.next().expect("the cycle is endless"))).map(|()| contact.force()));
        });
    }
    group.finish();
}

/// A thousand steady cycles with three harmonics, from a thousandth of gross slip to twice that, by shape; and a whole
/// swing under an oscillating load.
fn cycles(criterion: &mut Criterion) {
    let radii: Vec<f64> = (0..1_000).map(|index| 3e-4 * f64::from(index) / 999.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r).collect();
    let valid = "valid parameters";
    let shapes = [
        ("sphere", setup().profile),
        ("cone", Profile::Cone(Cone::new(0.05).expect(valid))),
        ("power 2.7", Profile::PowerLaw(PowerLaw::new(2.7, 1e4).expect(valid))),
        ("exact sphere", Profile::ExactSphere(ExactSphere::new(0.01).expect(valid))),
        ("truncated cone", Profile::TruncatedCone(TruncatedCone::new(0.05, 5e-5).expect(valid))),
        ("rounded punch", Profile::RoundedPunch(RoundedPunch::new(5e-5, 0.01).expect(valid))),
        ("table of 1000 points", Profile::Tabulated(Tabulated::new(&radii, &heights).expect(valid))),
    ];
    let mut group = criterion.benchmark_group("1000 cycles with three harmonics");
    group.sample_size(10);
    for (name, profile) in shapes {
        let contact = Contact::new(Setup { profile, ..setup() }).expect("a valid contact");
        let full = contact.gross_slip_displacement();
        let each = |index: i32| {
            let cycle = SteadyCycle::of(&contact, 2e-3 * f64::from(index) * full);
            cycle.dissipated_energy() + cycle.harmonics(3).harmonics[2].in_phase
        };
        group.bench_function(name, |bencher| bencher.iter(|| (1..=1_000).map(each).sum::<f64>()));
    }
    let contact = virgin();
    let load = OscillatingLoad { amplitude: Normal::NormalForce(2.0), phase: 0.5 };
    let swing =
        Oscillation { drive: Drive::Displacement(0.5 * contact.gross_slip_displacement()), load, compliance: 0.0 };
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let name = format!("one under an oscillating load, to {tolerance:e}");
        group.bench_function(name, |bencher| bencher.iter(|| swing.steady(&contact, tolerance, 3, &|| true)));
    }
    group.finish();
}

/// The stress tensor at 10 000 points below the surface after 20 reversals, beside the shear stress of the surface at
/// as many radii.
fn depths(criterion: &mut Criterion) {
    const POINTS: usize = 10_000;
    let mut group = criterion.benchmark_group("10000 points after 20 reversals");
    group.sample_size(10);
    let power = |exponent, coefficient| PowerLaw::new(exponent, coefficient).expect("in range");
    let radii: Vec<f64> = (0..1_000).map(|index| 5e-7 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r).collect();
    let shapes = [
        ("sphere", setup().profile),
        ("cone", Profile::Cone(Cone::new(0.05).expect("in range"))),
        ("fourth power", Profile::PowerLaw(power(4.0, 1e6))),
        ("exact sphere", Profile::ExactSphere(ExactSphere::new(0.01).expect("in range"))),
        ("table of 1000", Profile::Tabulated(Tabulated::new(&radii, &heights).expect("convex"))),
    ];
    for (name, profile) in shapes {
        let mut contact = Contact::new(Setup { profile, ..setup() }).expect("a valid contact");
        let full = contact.gross_slip_displacement();
        for target in falling_amplitude(REVERSALS, full) {
            contact.apply(&to(target)).expect("a displacement has no limit");
        }
        let a = contact.contact_radius();
        let share = |index: usize| index as f64 / POINTS as f64;
        let radii: Vec<f64> = (0..POINTS).map(|index| a * share(index)).collect();
        group.bench_function(format!("{name}: shear stress of the surface"), |bencher| {
            bencher.iter(|| contact.shears(&radii).into_iter().sum::<f64>());
        });
        let at = |index: usize| [1.5 * a * share(index * 37 % POINTS), 0.3 * a, 1.5 * a * share(index * 101 % POINTS)];
        group.bench_function(format!("{name}: tensor"), |bencher| {
            bencher.iter(|| {
                let field = contact.subsurface(Side::Second, 0.3).expect("a Poisson's ratio");
                (0..POINTS).map(|index| field.at(at(index)).expect("a place near the contact").xx).sum::<f64>()
            });
        });
    }
    group.finish();
}

/// How the tensor grows with the pieces of the history and with the places.
fn growth_in_depth(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tensors under a sphere");
    group.sample_size(10);
    for (reversals, places) in [(2, 10_000), (20, 10_000), (200, 10_000), (2_000, 1_000), (20, 1_000), (20, 100_000)] {
        let mut contact = virgin();
        let full = contact.gross_slip_displacement();
        for target in falling_amplitude(reversals, full) {
            contact.apply(&to(target)).expect("a displacement has no limit");
        }
        let a = contact.contact_radius();
        let share = |index: usize| (index % places) as f64 / places as f64;
        group.bench_function(format!("{reversals} reversals, {places} places"), |bencher| {
            bencher.iter(|| {
                let field = contact.subsurface(Side::Second, 0.3).expect("a Poisson's ratio");
                let at = |index: usize| [1.5 * a * share(index * 37), 0.3 * a, 1.5 * a * share(index * 101)];
                (0..places).map(|index| field.at(at(index)).expect("a place near the contact").xx).sum::<f64>()
            });
        });
    }
    group.finish();
}

fn scenes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("20 reversals and 200 radii");
    group.sample_size(20);
    group.bench_function("exact", |bencher| bencher.iter(|| black_box(exact_scene())));
    for count in [100, 1_000, 10_000] {
        group.bench_function(format!("{count} springs"), |bencher| bencher.iter(|| black_box(springs_scene(count))));
    }
    group.finish();
}

/// The stress of a history of so many pieces at so many radii, and as many plain square roots to compare with.
fn stresses(criterion: &mut Criterion) {
    const MANY: usize = 1_000;
    let mut group = criterion.benchmark_group("shear stress at 1000 radii under 1000 pieces");
    let mut contact = virgin();
    let figures = contact.summary();
    for target in falling_amplitude(MANY, figures.gross_slip_displacement) {
        contact.apply(&to(target)).expect("a displacement has no limit");
    }
    let radii: Vec<f64> = (0..MANY).map(|index| figures.contact_radius * index as f64 / MANY as f64).collect();
    group.sample_size(20);
    group.bench_function("all at once", |bencher| bencher.iter(|| black_box(contact.shears(&radii))));
    group.bench_function("one by one", |bencher| {
        bencher.iter(|| radii.iter().map(|&radius| contact.shear(radius)).sum::<f64>());
    });
    let terms: Vec<f64> = positions(MANY, 1.0).iter().map(|position| position * position).collect();
    group.bench_function("a square root per term", |bencher| {
        let mut roots = vec![0.0; MANY];
        bencher.iter(|| {
            for &radius in &radii {
                for (root, term) in roots.iter_mut().zip(&terms) {
                    *root = (term + radius).sqrt();
                }
                black_box(&roots);
            }
        });
    });
    group.finish();
}

/// Random moves of many asperities: their cost grows with the logarithm of the number. Preparation sorts and clusters
/// them.
fn asperities(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("asperities");
    for count in [100, 10_000, 1_000_000] {
        let gaps: Vec<f64> = positions(count, 2e-6);
        let set = || Profile::Asperities(Asperities::new(&[1e-4], &gaps).expect("valid asperities"));
        let rough = Setup { profile: set(), preload: Preload::Indentation(2e-6), ..setup() };
        let mut contact = Contact::new(rough).expect("a valid contact");
        let targets = positions(1_000, contact.summary().gross_slip_displacement);
        group.bench_function(format!("1000 moves of {count}"), |bencher| {
            bencher.iter(|| {
                targets.iter().for_each(|&target| contact.apply(&to(target)).expect("a displacement has no limit"));
                black_box(contact.force())
            });
        });
        group.bench_function(format!("preparation of {count}"), |bencher| bencher.iter(|| black_box(set())));
    }
    group.finish();
}

/// A turn of 160 moves round a circle of 0.6 u_max, to the default tolerance.
fn plane(criterion: &mut Criterion) {
    const MOVES: usize = 160;
    let radius = 0.6 * virgin().summary().gross_slip_displacement;
    let target = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
    let turn = |index: usize| index as f64 / MOVES as f64;
    let arc = |index: usize| EllipseArc { radii: [radius; 2], phase: 0.0, turns: [turn(index), turn(index + 1)] };
    let begin = target(PlanarTarget::Displacement([radius, 0.0]));
    let turns = (0..MOVES).map(|index| target(PlanarTarget::Arc(arc(index))));
    let moves: Vec<PlanarMove> = std::iter::once(begin).chain(turns).collect();
    let mut group = criterion.benchmark_group("a turn of 160 moves in the plane");
    for (name, count) in [("to 1e-3", None), ("20 rings", Some(20)), ("80 rings", Some(80))] {
        let options = Options { count, tolerance: 1e-3 };
        group.bench_function(name, |bencher| {
            bencher.iter(|| follow(setup(), &moves, &options, &|| true).expect("a displacement has no limit").steps);
        });
    }
    group.finish();
}

/// Bodies with memory: a ball that is swayed in time, each move two steps of the springs.
fn memory(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bodies with memory");
    group.sample_size(10);
    let terms = [(0.3, 0.1), (0.3, 1.0)].map(|(ratio, time)| PronyTerm { ratio, time });
    let memory = Prony::new(&terms).expect("a valid series");
    let limit = Law { limit: Friction::from(0.3), memory: Some(Arced::new(memory)) };
    let Setup { profile, elasticity, preload, .. } = setup();
    let rubber = Contact::new(Setup { profile, elasticity, friction: limit, preload }).expect("a valid contact");
    let scale = rubber.gross_slip_displacement();
    group.bench_function("4 000 steps", |bencher| {
        bencher.iter(|| {
            let mut contact = rubber.clone();
            for index in 1..=2_000 {
                let sway = 0.7 * scale * (0.05 * f64::from(index)).sin();
                let step = Move { duration: 0.01, ..to(sway) };
                contact.apply_within(&step, 1e-3).expect("a displacement has no limit");
            }
            contact.count_and_steps()
        });
    });
    let swing = TimedCycle { amplitude: 0.5 * scale, frequency: 1.0 };
    let relaxed = rubber.relaxed(setup().preload).expect("a solid");
    group.bench_function("a steady cycle", |bencher| {
        bencher.iter(|| swing.steady(&rubber, &relaxed, 1, &|| true).expect("a displacement has no limit").error);
    });
    group.finish();
}

criterion_group!(
    benches,
    moves,
    profiles,
    asperities,
    cycles,
    depths,
    growth_in_depth,
    memory,
    plane,
    scenes,
    stresses
);
criterion_main!(benches);
