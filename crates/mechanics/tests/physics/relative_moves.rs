//! A relative move leads where the absolute one does whose targets are worked out by hand.

use crate::support::{PLAIN, displace, push};
use stickslip_mechanics::springs::largest_contact_radius;
use stickslip_mechanics::{Contact, Error, Move, Normal, Preload, Springs, State, Tangential};

/// Kinds of a target, of which a move may leave one out.
const KINDS: [Option<bool>; 3] = [None, Some(false), Some(true)];

/// The move by increments, and the same to absolute targets, from a state. `Some(true)` asks for forces.
fn pair(tangential: Option<bool>, normal: Option<bool>, from: &State) -> (Move, Move) {
    let slide = 0.21 * PLAIN.full_slip();
    let drag = -0.13 * PLAIN.force_limit(PLAIN.radius);
    let (sink, load) = (0.17 * PLAIN.indentation(), 0.11 * from.normal_force);
    let towards = |base: [f64; 4]| Move {
        tangential: tangential.map(|force| match force {
            false => Tangential::Displacement(base[0] + slide),
            true => Tangential::Force(base[1] + drag),
        }),
        normal: normal.map(|force| match force {
            false => Normal::Indentation(base[2] + sink),
            true => Normal::NormalForce(base[3] + load),
        }),
        ..Move::default()
    };
    let increments = Move { relative: true, ..towards([0.0; 4]) };
    (increments, towards([from.displacement, from.force, from.indentation, from.normal_force]))
}

fn agree(name: &str, found: &State, expected: &State) {
    let units = [PLAIN.full_slip(), PLAIN.force_limit(PLAIN.radius), PLAIN.indentation(), expected.normal_force];
    let numbers = |state: &State| [state.displacement, state.force, state.indentation, state.normal_force];
    for ((found, expected), unit) in numbers(found).into_iter().zip(numbers(expected)).zip(units) {
        assert!((found - expected).abs() < 1e-11 * unit, "{name}: {found:e} {expected:e}");
    }
    let energies = (found.dissipated_energy - expected.dissipated_energy).abs();
    assert!(energies < 1e-11 * units[0] * units[1], "{name}: {energies:e}");
}

#[test]
fn every_pair_of_targets_may_be_relative() {
    let start = [displace(0.6 * PLAIN.full_slip()), push(-0.2 * PLAIN.force_limit(PLAIN.radius))];
    let mut contact = PLAIN.contact();
    let moves = start.to_vec();
    moves.iter().for_each(|step| contact.apply(step).unwrap());
    for tangential in KINDS {
        for normal in KINDS.into_iter().filter(|normal| normal.is_some() || tangential.is_some()) {
            let name = format!("{tangential:?} {normal:?}");
            let (increments, targets) = pair(tangential, normal, &contact.state());
            let (mut found, mut expected) = (contact.clone(), contact.clone());
            found.apply(&increments).unwrap();
            expected.apply(&targets).unwrap();
            agree(&name, &found.state(), &expected.state());
            assert_ne!(found.state(), contact.state(), "{name} does something");
        }
    }
}

#[test]
fn springs_follow_what_they_can_by_increments_too() {
    for tangential in KINDS {
        for normal in KINDS.into_iter().filter(|normal| normal.is_some() || tangential.is_some()) {
            let setup = PLAIN.setup();
            let far = Move { normal: Some(Normal::Indentation(1.5 * PLAIN.indentation())), ..Move::default() };
            let mut springs =
                Springs::new(setup.clone(), 4001, largest_contact_radius(&setup, [far]).unwrap()).unwrap();
            springs.apply(&displace(0.6 * PLAIN.full_slip())).unwrap();
            let (increments, targets) = pair(tangential, normal, &springs.state());
            let mut other = springs.clone();
            match springs.apply(&increments) {
                Ok(()) => {
                    other.apply(&targets).unwrap();
                    // A relative load starts from the exact one, an absolute one here from that of the springs.
                    let (found, expected) = (springs.state(), other.state());
                    let off = (found.force - expected.force).abs() / PLAIN.force_limit(PLAIN.radius);
                    assert!(off < 1e-6, "{tangential:?} {normal:?}: {off:e}");
                }
                Err(Error::Unsupported { .. }) => assert!(
                    tangential.is_some() && normal.is_some() && (normal, tangential) != (Some(false), Some(false))
                ),
                Err(error) => panic!("{error}"),
            }
        }
    }
}

#[test]
fn all_of_a_load_can_be_taken_away_by_an_increment() {
    let setup = PLAIN.loaded(Preload::NormalForce(10.0));
    let away = Move { normal: Some(Normal::NormalForce(-10.0)), relative: true, ..Move::default() };
    let mut contact = Contact::new(setup.clone()).unwrap();
    contact.apply(&away).unwrap();
    assert!(contact.normal_force().abs() <= 0.0);
    for count in [10, 11, 1000, 1001] {
        let mut springs = Springs::new(setup.clone(), count, contact.initial_summary().contact_radius).unwrap();
        springs.apply(&away).unwrap();
        assert!(springs.normal_force().abs() <= 0.0, "{count}");
        let refused = springs.apply(&away).unwrap_err();
        assert_eq!(refused, contact.apply(&away).unwrap_err());
    }
}
