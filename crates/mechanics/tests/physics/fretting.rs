//! Fatigue criteria of a cycle at the instants that matter, against very many of them; the worst place of a body.

use stickslip_mechanics::fatigue::{Bulk, Criterion, Cycle, Measure, Ratings, Study};
use stickslip_mechanics::profile::{Cone, FlatPunch};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{
    Body, Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Stress, Tangential,
};

use crate::support::{Random, cases, displace, oblique, push, shapes, sphere};

pub const BODY: (Side, f64) = (Side::First, 0.3);
pub const STEEL: f64 = 2.1e11;

/// A steel body of this profile on a rigid plane.
pub fn steel(profile: Profile, friction: f64, radius: f64) -> Contact {
    let elasticity = Elasticity::against_rigid(Body::new(STEEL, 0.3).unwrap());
    Contact::new(Setup { profile, elasticity, friction, preload: Preload::ContactRadius(radius) }).unwrap()
}

pub fn crossland(alpha: f64) -> Measure {
    Measure::Stress(Criterion::Crossland { alpha })
}

/// All criteria of stress.
pub fn of_stress() -> Vec<Measure> {
    let (youngs_modulus, poisson) = (STEEL, 0.3);
    [
        Criterion::Crossland { alpha: 0.3 },
        Criterion::DangVan { alpha: 0.3 },
        Criterion::Findley { k: 0.3 },
        Criterion::SmithWatsonTopper { youngs_modulus, poisson },
        Criterion::FatemiSocie { k: 1.0, yield_stress: 4e8, youngs_modulus, poisson },
    ]
    .map(Measure::Stress)
    .into()
}

pub fn rated(cycle: &Cycle, measures: Vec<Measure>, tolerance: f64, places: &[[f64; 3]]) -> Ratings {
    Study::new(cycle, BODY, None, measures, tolerance, &|| true).unwrap().rate_all(places).unwrap()
}

#[test]
fn ruiz_multiplies_half_ranges_by_the_largest_tension() {
    let contact = steel(sphere(0.01), 0.5, 1e-4);
    let slide = 0.7 * contact.gross_slip_displacement();
    let cycle = Cycle::new(&contact, &[displace(slide), displace(-0.5 * slide)], &|| true).unwrap();
    let states = cycle.states(1000, &|| true).unwrap();
    let places = [[0.9e-4, 0.0, 0.0], [-0.97e-4, 0.0, 0.0], [0.0, 0.8e-4, 0.0], [1e-6, 0.0, 0.0]];
    let found = rated(&cycle, vec![Measure::Ruiz, Measure::RuizTension], 1e-4, &places);
    for (index, place) in places.into_iter().enumerate() {
        let radius = place[0].hypot(place[1]);
        let ends = |of: &dyn Fn(&Contact) -> f64| {
            let values = states.iter().map(of);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
        };
        let half = |[low, high]: [f64; 2]| 0.5 * (high - low);
        let damage = half(ends(&|state| state.shear(radius))) * half(ends(&|state| state.slip(radius).unwrap()));
        let tension = ends(&|state| state.subsurface(BODY.0, BODY.1).unwrap().at(place).unwrap().xx)[1].max(0.0);
        let (one, other) = (found.values[0][index], found.values[1][index]);
        assert!((one - damage).abs() <= 2e-3 * damage, "{place:?}: {one:e} {damage:e}");
        assert!((other - tension * damage).abs() <= 4e-3 * tension * damage, "{place:?}: {other:e}");
    }
    // Nothing slips at the centre, and before the contact the surface is drawn apart.
    assert!(found.values[0][3] == 0.0 && found.values[1][..2].iter().any(|value| *value > 0.0));
}

/// In gross slip the shear stress is mu p(r) both ways, and the surface of a sphere has moved by
/// u_max (1 - r^2/(2 a^2)).
#[test]
fn in_gross_slip_ruiz_is_exact_and_has_no_tension_where_all_is_pressed() {
    let contact = steel(sphere(0.01), 0.5, 1e-4);
    let (full, radius) = (contact.gross_slip_displacement(), contact.contact_radius());
    let cycle = Cycle::new(&contact, &[displace(2.0 * full), displace(-2.0 * full)], &|| true).unwrap();
    let places = [0.0, 0.4, 0.97].map(|part| [-part * radius, 0.0, 0.0]);
    let found = |mean: f64| {
        let (bulk, measures) = (Bulk { mean, amplitude: 0.0, phase: 0.0 }, vec![Measure::Ruiz, Measure::RuizTension]);
        Study::new(&cycle, BODY, Some(bulk), measures, 1e-4, &|| true).unwrap().rate_all(&places).unwrap().values
    };
    let (pulled, pressed) = (found(1e12), found(-1e12));
    for (index, [x, ..]) in places.into_iter().enumerate() {
        let slip = full * (1.0 + 0.5 * (x / radius).powi(2));
        let damage = 0.5 * contact.pressure(x.abs()) * slip;
        assert!((pulled[0][index] / damage - 1.0).abs() < 1e-12, "{x}: {:e} {damage:e}", pulled[0][index]);
        assert!((pulled[1][index] / (1e12 * damage) - 1.0).abs() < 1e-2);
        assert!((pressed[0][index] / damage - 1.0).abs() < 1e-12 && pressed[1][index] == 0.0);
    }
}

/// The stresses of a place over a cycle of straight moves, at so many instants that the curve is within `sag` of the
/// chords between them, and these shorter than `length`, Pa.
fn curve(cycle: &Cycle, place: [f64; 3], moves: &[Move], fineness: (f64, f64)) -> Vec<Stress> {
    curve_of(cycle, moves, fineness, |contact| contact.subsurface(BODY.0, BODY.1).unwrap().at(place).unwrap())
}

/// The same of a stress that each state has.
pub fn curve_of(
    cycle: &Cycle,
    moves: &[Move],
    (sag, length): (f64, f64),
    stress: impl Fn(&Contact) -> Stress,
) -> Vec<Stress> {
    let ends = cycle.states(1, &|| true).unwrap();
    let mut path = Vec::new();
    for (index, step) in moves.iter().enumerate() {
        let start = &ends[(index + moves.len() - 1) % moves.len()];
        let at = |part: f64| {
            let mut contact = start.clone();
            contact.apply(&start.partial_move(step, part)).unwrap();
            stress(&contact)
        };
        let off = |one: Stress, other: Stress| {
            let off = one + other * -1.0;
            off.components().iter().map(|part| part * part).sum::<f64>().sqrt()
        };
        let first = 48;
        let mut parts: Vec<_> = (0..first)
            .rev()
            .map(|index| [f64::from(index), f64::from(index + 1)].map(|index| index / f64::from(first)))
            .map(|[low, high]| ((low, at(low)), (high, at(high))))
            .collect();
        while let Some((low, high)) = parts.pop() {
            let middle = 0.5 * (low.0 + high.0);
            let between = at(middle);
            let chord = (low.1 + high.1) * 0.5;
            let long = off(between, chord) > sag || off(low.1, high.1) > length;
            if long && high.0 - low.0 > 1e-13 {
                parts.extend([((middle, between), high), (low, (middle, between))]);
            } else {
                path.extend([between, high.1]);
            }
        }
    }
    path
}

/// The example.
fn example() -> (Contact, [Move; 2]) {
    let moves = [(1e-6, -9.107142857142858e-07), (2.6e-7, -1.3478571428571431e-06)];
    (steel(sphere(0.01), 0.6, 1e-4), moves.map(|(depth, target)| oblique(depth, target)))
}

#[test]
fn a_cusp_in_time_at_the_surface_is_found() {
    let (contact, moves) = example();
    let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
    let ratings = rated(&cycle, vec![crossland(0.3)], 1e-4, &[[5.69e-5, 0.0, 0.0]]);
    let largest = ratings.largest[0].unwrap().rated;
    // 4096 equal instants of each move still find 3.23086e8, 64 of them 3.19e8: at a cusp they converge like a root.
    let path = curve(&cycle, [5.69e-5, 0.0, 0.0], &moves, (3e3, 1e8));
    let truth = Criterion::Crossland { alpha: 0.3 }.of(&path).value;
    assert!((truth / 3.244852e8 - 1.0).abs() < 1e-5, "{truth:e}");
    assert!((largest.value - truth).abs() <= 3.0 * largest.error + 1e-5 * truth, "{largest:?} {truth:e}");
    assert!(largest.error <= 1e-4 * largest.value, "{largest:?}");
    // Its instant is known: halving the moves until the cusp is met takes 304.
    assert!(ratings.instants <= 64, "{}", ratings.instants);
}

/// A random cycle of oblique moves on a ball, and a place below or at the surface of it.
pub fn any_cycle(random: &mut Random) -> (Contact, Vec<Move>, [f64; 3]) {
    let contact = steel(sphere(0.01), random.within(0.1, 1.0), 1e-4);
    let (depth, slide) = (contact.indentation(), contact.gross_slip_displacement());
    let count = 2 + (random.bits() % 3) as usize;
    let constant = random.bits().is_multiple_of(4);
    let moves = (0..count).map(|_| {
        let target = random.within(-1.5, 1.5) * slide;
        if constant { displace(target) } else { oblique(random.within(0.05, 1.2) * depth, target) }
    });
    let moves = moves.collect();
    let radius = random.within(0.0, 1.2) * 1e-4;
    let (sin, cos) = if random.bits().is_multiple_of(2) { (0.0, 1.0) } else { random.within(0.0, 3.1).sin_cos() };
    let z = if random.bits().is_multiple_of(2) { 0.0 } else { 1e-4 * 10f64.powf(random.within(-4.0, 0.2)) };
    (contact, moves, [radius * cos, radius * sin, z])
}

/// Random cycles that have several instants or planes of nearly the same value, of which one was once missed: the
/// farthest from the centre of a ball on one arc (the first four), or a plane.
const ALIKE: [u32; 9] = [135, 195, 332, 454, 564, 768, 1026, 1428, 1710];

#[test]
fn errors_of_random_cycles_are_not_stated_too_small() {
    let mut random = Random(31);
    let measures = of_stress();
    let (mut beyond, mut worst, mut stated) = (0, 0.0_f64, Vec::new());
    let count = cases(100);
    for case in 0..count.max(1 + ALIKE[8]) {
        let (contact, moves, place) = any_cycle(&mut random);
        if case >= count && !ALIKE.contains(&case) {
            continue;
        }
        let Ok(cycle) = Cycle::new(&contact, &moves, &|| true) else { continue };
        let tolerance = [1e-4, 1e-3][case as usize % 2];
        let ratings = rated(&cycle, measures.clone(), tolerance, &[place]);
        let unit = contact.summary().unit_pressure();
        let path = curve(&cycle, place, &moves, (1e-6 * unit, 0.05 * unit));
        for (index, measure) in measures.iter().enumerate() {
            // The planes of all criteria take long over so many instants.
            if index > 1 && case % 6 != 0 {
                continue;
            }
            let Measure::Stress(criterion) = measure else { continue };
            let mut truth = criterion.of(&path).value;
            let found = ratings.largest[index].unwrap().rated;
            let sensitive = [unit, unit, unit, unit * unit / STEEL, unit / STEEL][index];
            // What the reference itself leaves.
            let mut off = ((found.value - truth).abs() - 3e-6 * sensitive).max(0.0);
            if off > 3.0 * found.error && (index < 2 || found.value > truth) {
                // The centre of a ball is known to the root of what the reference leaves, and a largest value over
                // instants is too low where the reference has missed one.
                truth = criterion.of(&curve(&cycle, place, &moves, (1e-9 * unit, 0.05 * unit))).value;
                off = ((found.value - truth).abs() - 3e-6 * sensitive).max(0.0);
            }
            if off > 3.0 * found.error {
                beyond += 1;
                println!("case {case} {criterion:?} at {place:?}: {found:?}, true {:?}", criterion.of(&path));
            }
            worst = worst.max(off / found.error.max(1e-300));
            stated.push(found.error / sensitive);
            if truth > 0.05 * sensitive {
                assert!(found.error <= tolerance * found.value, "case {case} {criterion:?}: {found:?}");
            }
        }
    }
    stated.sort_by(f64::total_cmp);
    let (found, median) = (stated.len(), stated[stated.len() / 2]);
    println!(
        "{found} values: {beyond} off by more than three times the error, at most {worst:.2} times; median {median:.1e}"
    );
    assert_eq!(beyond, 0);
}

#[test]
fn errors_hold_on_every_profile() {
    let mut random = Random(5);
    for (number, (profile, indentation)) in shapes().into_iter().enumerate() {
        let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
        let preload = Preload::Indentation(indentation);
        let contact = Contact::new(Setup { profile, elasticity, friction: 0.4, preload }).unwrap();
        let (slide, radius) = (contact.gross_slip_displacement(), contact.contact_radius());
        let moves = [displace(0.7 * slide), oblique(0.6 * indentation, -0.4 * slide), oblique(indentation, 0.0)];
        let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
        let unit = contact.summary().unit_pressure();
        for z in [0.0, 0.05 * radius] {
            let place = [random.within(0.3, 0.9) * radius, 0.0, z];
            let measures = of_stress()[..2].to_vec();
            let ratings = rated(&cycle, measures.clone(), 1e-3, &[place]);
            let path = curve(&cycle, place, &moves, (1e-4 * unit, 0.2 * unit));
            for (measure, largest) in measures.iter().zip(&ratings.largest) {
                let (Measure::Stress(criterion), Some(largest)) = (measure, largest) else { panic!("{measure:?}") };
                let (truth, found) = (criterion.of(&path).value, largest.rated);
                let off = (found.value - truth).abs() - 2e-4 * unit;
                assert!(off <= 3.0 * found.error, "{number} {place:?} {criterion:?}: {found:?} {truth:e}");
                assert!(found.error <= 1e-3 * found.value.max(0.05 * unit), "{number}: {found:?}");
            }
        }
    }
}

#[test]
fn moves_straight_in_a_force_are_followed_by_their_chords() {
    let contact = steel(sphere(0.01), 0.5, 1e-4);
    let force = contact.normal_force();
    let to = |tangential: f64, normal: f64| Move {
        tangential: Some(Tangential::Force(tangential * force)),
        normal: Some(Normal::NormalForce(normal * force)),
        ..Move::default()
    };
    let moves = [to(0.3, 1.0), to(-0.2, 0.7), push(-0.25 * force), to(0.0, 1.0)];
    let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
    let unit = contact.summary().unit_pressure();
    for place in [[8e-5, 0.0, 0.0], [-6e-5, 2e-5, 1e-5]] {
        let ratings = rated(&cycle, vec![crossland(0.3)], 1e-3, &[place]);
        let found = ratings.largest[0].unwrap().rated;
        let path = curve(&cycle, place, &moves, (2e-3 * unit, unit));
        let truth = Criterion::Crossland { alpha: 0.3 }.of(&path).value;
        assert!((found.value - truth).abs() <= 3.0 * found.error + 2e-3 * unit, "{found:?} {truth:e}");
        assert!(found.value > truth - 1e-4 * unit, "{found:?} {truth:e}");
    }
}

#[test]
fn the_friction_work_of_a_cycle_whose_load_changes_adds_up_to_what_it_dissipates() {
    let contact = steel(sphere(0.01), 0.5, 1e-4);
    let (depth, slide) = (contact.indentation(), contact.gross_slip_displacement());
    for moves in [
        vec![displace(0.6 * slide), displace(-0.6 * slide)],
        vec![oblique(1.2 * depth, 0.8 * slide), oblique(0.5 * depth, -0.9 * slide), oblique(depth, 0.1 * slide)],
    ] {
        let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
        let mut here = cycle.start().clone();
        let before = here.state().dissipated_energy;
        for step in &moves {
            here.apply(step).unwrap();
        }
        let lap = here.state().dissipated_energy - before;
        // Rings of the midpoint rule in r^2.
        let rings = 300;
        let area = 1.3 * 1e-8 / f64::from(rings);
        let places: Vec<[f64; 3]> =
            (0..rings).map(|ring| [((f64::from(ring) + 0.5) * area).sqrt(), 0.0, 0.0]).collect();
        let ratings = rated(&cycle, vec![Measure::FrictionWork], 1e-4, &places);
        let work: f64 = ratings.values[0].iter().map(|density| std::f64::consts::PI * area * density).sum();
        assert!((work / lap - 1.0).abs() < 2e-3, "{work:e} {lap:e}");
        assert!(ratings.largest[0].is_some_and(|most| most.rated.error <= 1e-3 * most.rated.value), "{ratings:?}");
    }
}

#[test]
fn a_bulk_stress_moves_the_largest_instant() {
    let contact = steel(sphere(0.01), 0.3, 1e-4);
    let slide = 0.1 * contact.gross_slip_displacement();
    let cycle = Cycle::new(&contact, &[displace(slide), displace(-slide)], &|| true).unwrap();
    // Far away the bulk stress is alone: its amplitude over sqrt(3), and its largest value.
    let bulk = Bulk { mean: 5e7, amplitude: 1e8, phase: 1.0 };
    let mut study = Study::new(&cycle, BODY, Some(bulk), vec![crossland(0.3)], 1e-6, &|| true).unwrap();
    let found = study.rate_all(&[[0.0, 0.0, 1.0]]).unwrap().largest[0].unwrap().rated;
    let truth = 1e8 / 3f64.sqrt() + 0.3 * 1.5e8 / 3.0;
    assert!((found.value / truth - 1.0).abs() <= 1e-6, "{found:?} {truth:e}");
    // cos(2 pi (step + part)/2 + 1) = 1.
    let at = found.at.unwrap();
    let angle = std::f64::consts::PI * (at.step as f64 + at.part) + 1.0;
    assert!((angle.cos() - 1.0).abs() < 1e-6, "{at:?}");
}

/// A move to where the contact is changes no value, and no instant is named in it. A bulk stress goes on meanwhile.
#[test]
fn a_move_without_length_is_no_instant_but_time_for_a_bulk_stress() {
    let contact = steel(sphere(0.01), 0.3, 1e-4);
    let slip = contact.gross_slip_displacement();
    let full = 0.3 * contact.normal_force();
    let mut random = Random(11);
    for case in 0..cases(12) {
        let moves: Vec<Move> = (0..4)
            .map(|turn| if turn % 2 == 0 { 1.0 } else { -1.0 })
            .map(|sign| match case % 2 {
                0 => push(sign * full * random.within(0.2, 0.9)),
                _ => displace(sign * slip * random.within(0.2, 1.5)),
            })
            .collect();
        // Which of the moves each of the longer path is, the ones without length with that before.
        let origin: Vec<usize> = (0..4).flat_map(|step| vec![step; 1 + (random.bits() % 3) as usize]).collect();
        let held: Vec<Move> = origin.iter().map(|step| moves[*step]).collect();
        let first = |step: usize| origin.iter().position(|other| *other == step).unwrap();
        let places = [[0.9e-4, 0.0, 0.0], [-0.8e-4, 0.0, 2e-5], [0.3e-4, 0.2e-4, 5e-5]];
        let [alone, with] = [&moves, &held].map(|moves| {
            let cycle = Cycle::new(&contact, moves, &|| true).unwrap();
            rated(&cycle, of_stress(), 1e-4, &places)
        });
        for (one, other) in alone.largest.iter().zip(&with.largest) {
            let [one, other] = [one, other].map(|largest| largest.unwrap().rated);
            assert!((one.value - other.value).abs() <= one.error + other.error, "{one:?} {other:?}");
            if let Some(at) = other.at {
                assert_eq!(at.step, first(origin[at.step]), "{at:?} of {origin:?}");
                assert!(at.part > 1e-12 && at.part <= 1.0, "{at:?}");
            }
        }

        // The bulk stress is largest in the middle of a move that holds the contact.
        let hold = (0..held.len()).find(|step| *step > 0 && origin[*step] == origin[*step - 1]);
        let Some(hold) = hold else { continue };
        let phase = -std::f64::consts::TAU * (hold as f64 + 0.5) / held.len() as f64;
        let bulk = Bulk { mean: 0.0, amplitude: 1e8, phase };
        let cycle = Cycle::new(&contact, &held, &|| true).unwrap();
        let mut study = Study::new(&cycle, BODY, Some(bulk), vec![crossland(0.3)], 1e-6, &|| true).unwrap();
        let found = study.rate_all(&[[0.0, 0.0, 1.0]]).unwrap().largest[0].unwrap().rated;
        let truth = 1e8 / 3f64.sqrt() + 0.3 * 1e8 / 3.0;
        assert!((found.value / truth - 1.0).abs() <= 1e-5, "{found:?} {truth:e}");
        let at = found.at.unwrap();
        assert!(at.step == hold && (at.part - 0.5).abs() < 1e-2, "{at:?} in {hold}");
    }
}

#[test]
fn an_infinite_stress_is_no_number() {
    for profile in [Profile::Cone(Cone::new(0.05).unwrap()), Profile::FlatPunch(FlatPunch::new(1e-4).unwrap())] {
        let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
        let preload = Preload::Indentation(1e-6);
        let contact = Contact::new(Setup { profile, elasticity, friction: 0.4, preload }).unwrap();
        let slide = 0.5 * contact.gross_slip_displacement();
        let cycle = Cycle::new(&contact, &[displace(slide), displace(-slide)], &|| true).unwrap();
        let mut study = Study::new(&cycle, BODY, None, vec![crossland(0.3)], 1e-3, &|| true).unwrap();
        let worst = study.worst().unwrap()[0];
        assert!(worst.rated.value == f64::INFINITY && worst.place[2] == 0.0, "{worst:?}");
        let ratings = study.rate_all(&[worst.place, [0.0, 0.0, 1e-5]]).unwrap();
        assert!(ratings.values[0][0] == f64::INFINITY && ratings.values[0][1].is_finite(), "{ratings:?}");
        assert_eq!(ratings.largest[0].map(|largest| largest.place), Some(1));
    }
}

#[test]
fn a_search_and_a_rating_can_be_interrupted() {
    let (contact, moves) = example();
    let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
    let left = std::cell::Cell::new(20);
    let go_on = || {
        left.set(left.get() - 1);
        left.get() > 0
    };
    let mut study = Study::new(&cycle, BODY, None, of_stress(), 1e-3, &go_on).unwrap();
    assert_eq!(study.worst(), Err(Error::Interrupted));
    assert_eq!(study.rate_all(&[[5e-5, 0.0, 0.0]]), Err(Error::Interrupted));
}
