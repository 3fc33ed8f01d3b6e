//! The error estimates of springs against the exact solver, over random scenes of every kind of profile.

use crate::support::{Random, cases, displace};
use stickslip_mechanics::profile::{
    Cone, ExactSphere, FlatPunch, PowerLaw, RoundedCone, RoundedPunch, Sum, Tabulated, TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::springs::largest_contact_radius;
use stickslip_mechanics::{
    Contact, Elasticity, Error, ErrorEstimate, Move, Normal, Preload, Profile, Setup, Sphere, Springs, Tangential,
};

/// How far from a kink, in cells, stresses are compared.
const OFF: f64 = 4.0;

/// A body of about unit size, and where its own kinks are.
fn body(random: &mut Random, kind: u64) -> (Profile, Vec<f64>) {
    let (blunt, slope, rim) = (random.within(1.2, 4.0), random.within(0.05, 0.6), random.within(0.05, 0.4));
    let smooth = |profile| (profile, Vec::new());
    match kind {
        0 => smooth(Profile::Sphere(Sphere::new(blunt).unwrap())),
        1 => smooth(Profile::ExactSphere(ExactSphere::new(blunt).unwrap())),
        2 => smooth(Profile::Cone(Cone::new(slope).unwrap())),
        3 => smooth(Profile::PowerLaw(PowerLaw::new(random.within(1.2, 9.0), slope).unwrap())),
        4 => (Profile::TruncatedCone(TruncatedCone::new(slope, rim).unwrap()), vec![rim]),
        5 => (Profile::TruncatedSphere(TruncatedSphere::new(blunt, rim).unwrap()), vec![rim]),
        6 => (Profile::RoundedPunch(RoundedPunch::new(rim, blunt).unwrap()), vec![rim]),
        7 => (Profile::RoundedCone(RoundedCone::new(slope, rim).unwrap()), vec![rim]),
        8 => {
            let radii: Vec<f64> = (0..=24).map(|index| f64::from(index) / 20.0).collect();
            let heights: Vec<f64> = radii.iter().map(|r| slope * r * r * (1.0 + blunt * r)).collect();
            smooth(Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()))
        }
        9 => smooth(Profile::FlatPunch(FlatPunch::new(rim).unwrap())),
        _ => {
            let mut kinks = Vec::new();
            let parts = (0..2 + random.bits() % 2).map(|_| {
                let kind = random.bits() % 9;
                let (part, at) = body(random, kind);
                kinks.extend(at);
                part
            });
            let parts = parts.collect();
            (Profile::Sum(Sum::new(parts).unwrap()), kinks)
        }
    }
}

/// A move of any sort that springs can follow, in units of the depth and slip of the virgin contact.
fn step(random: &mut Random, contact: &Contact, depth: f64, slip: f64) -> Move {
    let displacement = Some(Tangential::Displacement(slip * random.within(-1.2, 1.2)));
    let normal = Some(match random.bits() % 2 {
        0 => Normal::Indentation(depth * random.within(0.3, 1.4)),
        _ => Normal::NormalForce(contact.normal_force() * random.within(0.3, 1.5)),
    });
    match random.bits() % 5 {
        0 => Move { tangential: None, normal, ..Move::default() },
        1 => {
            let indentation = Some(Normal::Indentation(depth * random.within(0.3, 1.4)));
            Move { tangential: displacement, normal: indentation, ..Move::default() }
        }
        2 => {
            let force = contact.summary().gross_slip_force * random.within(-0.98, 0.98);
            Move { tangential: Some(Tangential::Force(force)), ..Move::default() }
        }
        _ => Move { tangential: displacement, ..Move::default() },
    }
}

/// True errors, each over the unit of its estimate, and the estimates. The force on the way is over the largest limit.
struct Outcome {
    on_the_way: f64,
    force: f64,
    stress: f64,
    force_error: f64,
    stress_error: f64,
}

fn play(random: &mut Random, kind: u64) -> Option<Outcome> {
    let (profile, mut kinks) = body(random, kind);
    let depth = if kind == 9 { 0.1 } else { profile.indenter().level(random.within(0.45, 0.7)) };
    let unloaded = random.bits().is_multiple_of(6);
    let setup = Setup {
        profile: profile.clone(),
        elasticity: Elasticity::effective(1000.0, random.within(600.0, 1100.0)).unwrap(),
        friction: random.within(0.1, 0.9),
        preload: if unloaded { Preload::NormalForce(0.0) } else { Preload::Indentation(depth) },
    };
    let mut exact = Contact::new(setup.clone()).ok()?;
    let slip = setup.friction * 1000.0 / setup.elasticity.g_star() * depth;
    let mut moves = Vec::new();
    let mut note = |contact: &Contact| kinks.extend([contact.contact_radius(), contact.state().stick_radius]);
    note(&exact);
    if unloaded {
        let normal = Some(Normal::Indentation(depth));
        moves.push(Move { normal, ..Move::default() });
        exact.apply(&moves[0]).ok()?;
        note(&exact);
    }
    for _ in 0..1 + random.bits() % 6 {
        let next = step(random, &exact, depth, slip);
        if exact.apply(&next).is_ok() {
            moves.push(next);
            note(&exact);
        }
    }
    let count = 2.0 * 1500.0_f64.powf(random.within(0.0, 1.0));
    let reach = largest_contact_radius(&setup, moves.iter().copied()).unwrap();
    let mut springs = Springs::new(setup.clone(), count as usize, reach).unwrap();
    let mut exact = Contact::new(setup.clone()).unwrap();
    let (mut largest, mut limit) = (0.0_f64, exact.summary().gross_slip_force);
    for step in &moves {
        match springs.apply(step) {
            // Springs may hold a little less than the contact.
            Err(Error::ForceExceedsFriction { .. }) => return None,
            other => other.unwrap(),
        }
        exact.apply(step).unwrap();
        largest = largest.max((exact.force() - springs.force()).abs());
        limit = limit.max(exact.summary().gross_slip_force);
    }
    let (figures, estimate) = (exact.summary(), springs.accuracy());
    let edge = figures.contact_radius;
    let mean = figures.normal_force / (std::f64::consts::PI * edge * edge);
    let unit = setup.friction * figures.max_pressure.unwrap_or(mean);
    kinks.push(0.0);
    kinks.extend(profile.indenter().singular_radii());
    let away = OFF * 2.0 * reach / count.floor();
    let stress = (0..60)
        .map(|_| edge * random.within(0.0, 1.0))
        .filter(|radius| kinks.iter().all(|kink| (radius - kink).abs() > away))
        .map(|radius| (exact.shear(radius) - springs.shear(radius)).abs() / unit)
        .fold(0.0, f64::max);
    let force = (exact.force() - springs.force()).abs() / figures.gross_slip_force;
    let ErrorEstimate { force_error, stress_error, .. } = estimate;
    Some(Outcome { on_the_way: largest / limit, force, stress, force_error, stress_error })
}

#[test]
fn no_estimate_is_below_a_third_of_the_truth() {
    let mut random = Random(11);
    let (mut compared, mut liars) = (0, Vec::new());
    let mut worst = [0.0_f64; 3];
    let mut generous = [const { Vec::new() }; 3];
    for scene in 0..u64::from(cases(500)) {
        let kind = scene % 11;
        let Some(outcome) = play(&mut random, kind) else { continue };
        let Outcome { on_the_way, force, stress, force_error, stress_error } = outcome;
        compared += 1;
        let pairs = [(force, force_error), (stress, stress_error), (on_the_way, force_error)];
        for (index, (error, estimate)) in pairs.into_iter().enumerate() {
            if error > 1e-12 {
                worst[index] = worst[index].max(error / estimate);
                generous[index].push(estimate / error);
            }
            // Round-off of the sum over three thousand springs.
            if error > 3.0 * estimate + 1e-12 {
                liars.push(format!(
                    "scene {scene}, kind {kind}, {}: {error:.1e}, {estimate:.1e}",
                    ["force", "stress", "force on the way"][index]
                ));
            }
        }
    }
    let median = generous.map(|mut all| {
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    println!("{compared} scenes: worst error over estimate {worst:.2?}, median estimate over error {median:.1?}");
    assert!(compared > 9 * u64::from(cases(500)) / 10, "only {compared} scenes");
    assert!(liars.is_empty(), "{} of {compared}:\n{}", liars.len(), liars.join("\n"));
}

/// Force and stress of springs at the end of a path, over their units, with the true errors.
fn scene(profile: Profile, preload: Preload, moves: &[Move], count: usize) -> Outcome {
    let elasticity = Elasticity::effective(1000.0, 800.0).unwrap();
    let setup = Setup { profile, elasticity, friction: 0.3, preload };
    let mut exact = Contact::new(setup.clone()).unwrap();
    let mut springs =
        Springs::new(setup.clone(), count, largest_contact_radius(&setup, moves.iter().copied()).unwrap()).unwrap();
    let mut largest = 0.0_f64;
    for step in moves {
        exact.apply(step).unwrap();
        springs.apply(step).unwrap();
        largest = largest.max((exact.force() - springs.force()).abs() / exact.summary().gross_slip_force);
    }
    let (figures, half) = (exact.summary(), 0.5 * exact.contact_radius());
    let mean = figures.normal_force / (std::f64::consts::PI * 4.0 * half * half);
    let unit = 0.3 * figures.max_pressure.unwrap_or(mean);
    let ErrorEstimate { force_error, stress_error, .. } = springs.accuracy();
    Outcome {
        on_the_way: largest,
        force: (exact.force() - springs.force()).abs() / figures.gross_slip_force,
        stress: (exact.shear(half) - springs.shear(half)).abs() / unit,
        force_error,
        stress_error,
    }
}

#[test]
fn twins_that_agree_by_accident_hide_nothing() {
    // The same force on 50 and on 100 springs, to the last bit.
    let normal = Some(Normal::Indentation(0.0185));
    let tangential = Some(Tangential::Displacement(0.00388));
    let moves = [Move { normal, ..Move::default() }, Move { tangential, ..Move::default() }];
    for (count, least, most) in [(100, 3e-5, 1e-2), (1000, 9e-7, 1e-4)] {
        let cone = Profile::Cone(Cone::new(0.1).unwrap());
        let Outcome { force, force_error, .. } = scene(cone, Preload::Indentation(0.02), &moves, count);
        assert!(force > least, "{count}: the error itself, {force:e}");
        assert!(force <= 3.0 * force_error && force_error < most, "{count}: {force:e}, {force_error:e}");
    }
}

#[test]
fn a_contact_that_starts_without_load_has_an_estimate_too() {
    let moves = [
        Move { normal: Some(Normal::NormalForce(10.0)), ..Move::default() },
        Move { tangential: Some(Tangential::Force(1.0)), ..Move::default() },
    ];
    let ball = Profile::Sphere(Sphere::new(0.5).unwrap());
    let Outcome { stress, stress_error, .. } = scene(ball, Preload::NormalForce(0.0), &moves, 20);
    assert!(stress > 1e-3 && stress <= 3.0 * stress_error && stress_error < 0.5, "{stress:e}, {stress_error:e}");
}

#[test]
fn estimates_fall_with_the_number_of_springs() {
    let turns = [0.9, -0.5, 0.3].map(|part| 0.3 * 1000.0 / 800.0 * 0.02 * part);
    let moves = turns.map(displace);
    let at = |count| scene(Profile::Sphere(Sphere::new(0.5).unwrap()), Preload::Indentation(0.02), &moves, count);
    for count in [100, 1000] {
        let (few, many) = (at(count), at(10 * count));
        println!("{count}: force {:.1e}, stress {:.1e}", few.force_error, few.stress_error);
        // To order two, and one half next to the kinks.
        assert!(many.force_error < few.force_error / 30.0, "{:e} to {:e}", few.force_error, many.force_error);
        assert!(many.stress_error < few.stress_error / 2.0, "{:e} to {:e}", few.stress_error, many.stress_error);
    }
}
