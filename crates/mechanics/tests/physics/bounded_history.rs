//! A history in a fixed number of doubles: the same while nothing is dropped, and within the laws whatever is.

use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Setup, Tangential};

use super::support::{Random, UNIT, Worst, displace, oblique, shapes};

/// The contact that a program with so many turning points goes on with, and whether some were dropped.
fn kept(contact: &Contact, turning_points: usize) -> (Contact, bool) {
    let (numbers, dropped) = contact.packed_fixed(turning_points).unwrap();
    assert_eq!(numbers.len(), 2 * turning_points + 4);
    (contact.unpack_fixed(&numbers).unwrap(), dropped)
}

/// Work that has been put in along the motion so far, J.
fn work(contact: &Contact) -> f64 {
    let state = contact.state();
    state.elastic_energy + state.dissipated_energy
}

/// A contact of every shape, with its indentation, m, and its displacement of gross slip, m.
fn contacts() -> impl Iterator<Item = (Contact, f64, f64)> {
    shapes().into_iter().map(|(profile, depth)| {
        let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
        let preload = Preload::Indentation(depth);
        let contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
        let full = contact.gross_slip_displacement();
        (contact, depth, full)
    })
}

/// A move of any kind, under a changing load or not, lift-off included.
fn any_move((depth, full): (f64, f64), random: &mut Random) -> Move {
    let target = full * random.within(-1.2, 1.2);
    match random.within(0.0, 6.0) as usize {
        0 => oblique(depth * random.within(0.3, 1.3), target),
        1 => Move { normal: Some(Normal::Indentation(depth * random.within(0.6, 1.2))), ..Move::default() },
        2 if random.within(0.0, 8.0) < 1.0 => oblique(-0.1 * depth, target),
        _ => displace(target),
    }
}

#[test]
fn nothing_is_lost_while_every_turning_point_has_a_place() {
    let worst = Worst::new("force of a history in doubles, over mu F_N", 1e-11);
    let mut random = Random(74);
    for (virgin, depth, full) in contacts() {
        let (mut whole, mut bounded) = (virgin.clone(), virgin);
        for _ in 0..400 {
            let step = any_move((depth, full), &mut random);
            whole.apply(&step).unwrap();
            bounded.apply(&step).unwrap();
            let (after, dropped) = kept(&bounded, 120);
            assert!(!dropped);
            let unit = whole.summary().gross_slip_force.max(1e-300);
            worst.close(after.force(), whole.force(), unit);
            worst.close(after.normal_force(), whole.normal_force(), unit);
            worst.close(work(&after), work(&whole), work(&whole).max(unit * full));
            // The same numbers again.
            assert_eq!(after.packed_fixed(120).unwrap().0, bounded.packed_fixed(120).unwrap().0);
            bounded = after;
        }
    }
}

#[test]
fn force_and_energy_keep_the_laws_whatever_is_dropped() {
    let mut random = Random(740);
    let mut count = 0;
    for (virgin, depth, full) in contacts() {
        for turning_points in [0, 1, 2, 3, 5, 8] {
            let mut contact = virgin.clone();
            for _ in 0..300 {
                contact.apply(&any_move((depth, full), &mut random)).unwrap();
                let (after, dropped) = kept(&contact, turning_points);
                count += usize::from(dropped);
                let limit = after.summary().gross_slip_force;
                assert!(after.force().abs() <= limit * (1.0 + 1e-13), "{} of {limit}", after.force());
                let (before, now) = (contact.state(), after.state());
                assert!(now.elastic_energy <= before.elastic_energy * (1.0 + 1e-12) + 1e-14 * limit * full);
                let balance = work(&after) - work(&contact);
                assert!(balance.abs() <= 1e-12 * work(&contact) + 1e-14 * limit * full, "{balance}");
                assert!(now.memory_depth <= turning_points + 1 || now.memory_depth == 0);
                contact = after;
            }
        }
    }
    println!("dropped {count} times");
    assert!(count > 3000);
}

#[test]
fn no_closed_cycle_yields_work() {
    let mut random = Random(7400);
    let mut least = f64::INFINITY;
    for (virgin, depth, full) in contacts().step_by(3) {
        for case in 0..30 {
            // Small amplitudes under a constant load, and all of them under a changing one.
            let size = if case % 2 == 0 { 0.4 } else { 1.0 };
            let cycle: Vec<(f64, f64)> = (0..12)
                .map(|_| {
                    let load = if case % 3 == 0 { random.within(0.4, 1.0) } else { 1.0 };
                    (depth * load, size * full * random.within(-1.0, 1.0))
                })
                .chain([(depth, 0.0)])
                .collect();
            let turning_points = 1 + case % 4;
            let (mut contact, mut total) = (virgin.clone(), 0.0);
            let unit = virgin.summary().gross_slip_force * full;
            for lap in 0..20 {
                let mut of_lap = 0.0;
                for &(to, target) in &cycle {
                    let before = work(&contact);
                    contact.apply(&oblique(to, target)).unwrap();
                    of_lap += (work(&contact) - before) / unit;
                    contact = kept(&contact, turning_points).0;
                }
                total += of_lap;
                assert!(total >= -1e-12, "{total}");
                // What a first lap leaves behind is gone.
                if lap > 2 {
                    assert!(of_lap >= -1e-12, "{of_lap}");
                    least = least.min(of_lap);
                }
            }
        }
    }
    println!("the least work of a lap over mu F_N u_max: {least:.1e}");
}

#[test]
fn the_force_itself_does_work_on_small_steps() {
    // The same by the sum of forces, which knows no energy of the solver.
    let mut random = Random(74_000);
    let mut contact = UNIT.contact();
    let (mut here, mut total, mut force) = (0.0, 0.0, 0.0);
    for turn in 0..60 {
        let target = if turn == 59 { 0.0 } else { random.within(-0.6, 0.6) };
        let steps = 200;
        let from = here;
        for step in 1..=steps {
            let next = from + (target - from) * f64::from(step) / f64::from(steps);
            contact.apply(&Move { tangential: Some(Tangential::Displacement(next)), ..Move::default() }).unwrap();
            total += 0.5 * (force + contact.force()) * (next - here);
            contact = kept(&contact, 2).0;
            (here, force) = (next, contact.force());
        }
    }
    assert!(total > 0.0, "{total}");
}

/// The rms error of the force over mu F_N, by the number of turning points.
fn rms(path: &[f64], turning_points: usize) -> f64 {
    let (mut whole, mut bounded) = (UNIT.contact(), UNIT.contact());
    let limit = whole.summary().gross_slip_force;
    let squares = path.iter().map(|target| {
        whole.apply(&displace(*target)).unwrap();
        bounded.apply(&displace(*target)).unwrap();
        bounded = kept(&bounded, turning_points).0;
        ((bounded.force() - whole.force()) / limit).powi(2)
    });
    (squares.sum::<f64>() / path.len() as f64).sqrt()
}

#[test]
fn errors_are_those_stated() {
    // docs/embedding.md states them: the rms over eight draws, and the largest of a draw.
    let stated = [
        ("noise", [3e-2, 1e-2, 6e-4], [5e-2, 2.1e-2, 1.1e-3]),
        ("even", [1.3e-2, 2.3e-3, 2.1e-4], [1.7e-2, 4.5e-3, 4.1e-4]),
        ("walk", [4e-3, 7e-6, 1.1e-6], [7.2e-3, 1.7e-5, 3e-6]),
    ];
    let mut wrong = false;
    for (name, whole, of_one) in stated {
        let draws: Vec<[f64; 3]> =
            (1..=8).map(|seed| [4, 8, 12].map(|turning_points| rms(&drawn(name, seed), turning_points))).collect();
        for index in 0..3 {
            let found: Vec<f64> = draws.iter().map(|draw| draw[index]).collect();
            let mean = (found.iter().map(|error| error * error).sum::<f64>() / 8.0).sqrt();
            let largest = found.iter().copied().fold(0.0, f64::max);
            println!("{name} {index}: {mean:.2e}, largest {largest:.2e}");
            wrong |= mean > whole[index] || largest > of_one[index];
        }
    }
    assert!(!wrong);
}

/// Two thousand displacements over that of gross slip.
fn drawn(name: &str, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let normal = |random: &mut Random| (0..12).map(|_| random.within(0.0, 1.0)).sum::<f64>() - 6.0;
    let mut here = 0.0;
    let next = |_| match name {
        "noise" => 0.25 * normal(&mut random),
        "even" => random.within(-0.95, 0.95),
        _ => {
            here += 0.1 * normal(&mut random);
            here
        }
    };
    (0..2000).map(next).collect()
}

#[test]
fn numbers_that_are_no_state_are_refused() {
    let contact = UNIT.contact();
    let sound = [1.0, 0.5, 0.0, 0.0, 0.75, -1.0, 0.0, 0.0];
    assert!(contact.unpack_fixed(&sound).is_some());
    let with = |index: usize, number: f64| {
        let mut numbers = sound;
        numbers[index] = number;
        numbers
    };
    let wrong = [
        with(0, f64::NAN),
        with(0, -1.0),
        with(1, f64::INFINITY),
        with(2, -1.0),
        with(3, 1.5),
        with(4, 1.0),
        with(5, -1.5),
        with(6, 0.5),
        with(7, 1.0),
    ];
    for numbers in wrong {
        assert!(contact.unpack_fixed(&numbers).is_none(), "{numbers:?}");
    }
    assert!(contact.unpack_fixed(&sound[..5]).is_none() && contact.unpack_fixed(&[]).is_none());
}
