//! Moves by force: undone to the last bit where they fail, and refused nowhere where the force zero is all there is.

use std::cell::Cell;

use proptest::prelude::any;
use stickslip_mechanics::cycle::{Drive, OscillatingLoad, Oscillation, SteadyCycle};
use stickslip_mechanics::rings::{self, PlanarMove, PlanarTarget};
use stickslip_mechanics::{Contact, Error, Move, Normal, Springs, Tangential};

use super::support::{Ball, PLAIN, Random, forall};

fn by_force(target: f64) -> Move {
    Move { tangential: Some(Tangential::Force(target)), ..Move::default() }
}

/// A contact after random moves at any load.
fn moved(random: &mut Random) -> Contact {
    let mut contact = PLAIN.contact();
    let (slide, load) = (contact.gross_slip_displacement(), contact.normal_force());
    for _ in 0..(random.within(1.0, 30.0) as usize) {
        let tangential = Some(Tangential::Displacement(random.within(-1.2, 1.2) * slide));
        let normal = (random.within(0.0, 3.0) < 1.0).then(|| Normal::NormalForce(random.within(0.2, 1.5) * load));
        contact.apply_within(&Move { tangential, normal, ..Move::default() }, 1e-4).unwrap();
    }
    contact
}

#[test]
fn a_curved_move_that_is_interrupted_at_any_chord_leaves_the_contact_as_it_was_to_the_last_bit() {
    forall(40, any::<u64>(), |seed| {
        let mut random = Random(seed | 1);
        let contact = moved(&mut random);
        let limit = contact.friction() * contact.normal_force();
        let load = random.within(0.3, 1.6) * contact.normal_force();
        let step = Move {
            tangential: Some(Tangential::Force(random.within(-0.9, 0.9) * limit.min(contact.friction() * load))),
            normal: Some(Normal::NormalForce(load)),
            ..Move::default()
        };
        let mut whole = contact.clone();
        if whole.apply_within(&step, 1e-4).is_err() {
            return;
        }
        for most in 0..12 {
            let asked = Cell::new(0);
            let go_on = || {
                asked.set(asked.get() + 1);
                asked.get() <= most
            };
            let mut stopped = contact.clone();
            match stopped.apply_while(&step, 1e-4, &go_on) {
                Ok(()) => assert_eq!(stopped.pack(), whole.pack()),
                Err(error) => {
                    assert_eq!(error, Error::Interrupted);
                    assert_eq!(stopped.pack(), contact.pack(), "after {most} chords");
                    // What a later move reads of the pieces is as it was too.
                    stopped.apply_within(&step, 1e-4).unwrap();
                    assert_eq!(stopped.pack(), whole.pack(), "again after {most} chords");
                }
            }
        }
    });
}

#[test]
fn a_force_of_zero_without_load_or_friction_is_zero_and_moves_nothing() {
    let smooth = Ball { friction: 0.0, ..PLAIN };
    let parted = Move { normal: Some(Normal::Indentation(-1e-7)), ..Move::default() };
    let unloaded = Move { normal: Some(Normal::NormalForce(0.0)), ..Move::default() };
    for (ball, first) in [(smooth, None), (PLAIN, Some(parted)), (PLAIN, Some(unloaded))] {
        let mut contact = ball.contact();
        first.iter().for_each(|step| contact.apply(step).unwrap());
        contact.apply(&Move { tangential: Some(Tangential::Displacement(3e-8)), ..Move::default() }).unwrap();
        for normal in [None, first.and_then(|step| step.normal)] {
            contact.apply(&Move { normal, ..by_force(0.0) }).unwrap();
            assert_eq!((contact.force(), contact.displacement()), (0.0, 3e-8), "{ball:?} {normal:?}");
        }
        let refused = contact.apply(&by_force(1e-9));
        assert!(matches!(refused, Err(Error::ForceExceedsFriction { limit: 0.0, .. })), "{refused:?}");
        let cycle = SteadyCycle::driven(&contact, Drive::Force(0.0), 0.0).unwrap();
        assert_eq!(
            (cycle.force_amplitude(), cycle.dissipated_energy(), cycle.displacement_amplitude()),
            (0.0, 0.0, 0.0)
        );
    }
    let mut springs = Springs::new(smooth.setup(), 100, smooth.radius).unwrap();
    springs.apply(&Move { tangential: Some(Tangential::Displacement(3e-8)), ..Move::default() }).unwrap();
    springs.apply(&by_force(0.0)).unwrap();
    assert_eq!((springs.force(), springs.displacement()), (0.0, 3e-8));
    let to = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
    let path = [to(PlanarTarget::Displacement([3e-8, 1e-8])), to(PlanarTarget::Force([0.0; 2]))];
    for count in [None, Some(20)] {
        let options = rings::Options { count, tolerance: 1e-3 };
        let state = rings::follow(smooth.setup(), &path, &options, &|| true).unwrap().states[1];
        assert!(state.force.iter().all(|force| force.abs() <= 0.0), "{count:?}: {state:?}");
        let [x, y] = state.displacement;
        assert!((x - 3e-8).hypot(y - 1e-8) < 1e-20, "{count:?}: {state:?}");
    }
    let oscillation = Oscillation {
        drive: Drive::Force(0.0),
        load: OscillatingLoad { amplitude: Normal::NormalForce(0.1 * smooth.contact().normal_force()), phase: 0.0 },
        compliance: 0.0,
    };
    let cycle = oscillation.steady(&smooth.contact(), 1e-6, 3, &|| true).unwrap();
    assert_eq!((cycle.force_amplitude, cycle.dissipated_energy, cycle.displacement_amplitude), (0.0, 0.0, 0.0));
}

#[test]
fn a_load_that_is_carried_already_is_no_change_of_it() {
    let mut contact = PLAIN.contact();
    contact.apply(&Move { normal: Some(Normal::Indentation(1.7e-6)), ..Move::default() }).unwrap();
    contact.apply(&by_force(0.4 * contact.friction() * contact.normal_force())).unwrap();
    let mut same = contact.clone();
    let (target, load) =
        (Tangential::Force(-0.1 * contact.friction() * contact.normal_force()), contact.normal_force());
    contact.apply(&Move { tangential: Some(target), ..Move::default() }).unwrap();
    let normal = Some(Normal::NormalForce(load));
    same.apply(&Move { tangential: Some(target), normal, ..Move::default() }).unwrap();
    assert_eq!(same.pack(), contact.pack());
}
