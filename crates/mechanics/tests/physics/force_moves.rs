//! Moves by force: undone to the last bit where they fail, refused nowhere where the force zero is all there is, and no
//! longer after a long history.

use std::cell::Cell;
use std::time::Instant;

use proptest::prelude::any;
use stickslip_mechanics::cycle::{Drive, OscillatingLoad, Oscillation, SteadyCycle, best_load};
use stickslip_mechanics::profile::{Sum, Tabulated};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::rings::{self, PlanarMove, PlanarTarget};
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Springs, Tangential};

use super::support::{Ball, PLAIN, Random, displace, forall, sphere};

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

/// The least time of a piece of work, s, in some rounds, so that other work on the machine hardly counts.
fn least_time(mut work: impl FnMut()) -> f64 {
    let once = |_| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    (0..9).map(once).fold(f64::INFINITY, f64::min)
}

#[test]
fn moves_by_force_and_best_loads_do_no_more_after_a_hundred_thousand_reversals() {
    let times = [10, 100_000].map(|reversals| {
        let mut contact = PLAIN.contact();
        let (full, limit) = (contact.gross_slip_displacement(), contact.friction() * contact.normal_force());
        for target in falling_amplitude(reversals, full) {
            contact.apply(&displace(target)).unwrap();
        }
        let here = contact.force();
        let moves = least_time(|| {
            for _ in 0..50 {
                contact.apply(&by_force(here + 1e-9 * limit)).unwrap();
                contact.apply(&by_force(here - 1e-9 * limit)).unwrap();
            }
        });
        let load = least_time(|| {
            best_load(&contact, Drive::Displacement(0.3 * full), 0.0, &|| true).unwrap();
        });
        [moves, load]
    });
    // A copy of the history takes a thousand times as long as a move.
    for (work, (few, many)) in ["moves", "best load"].into_iter().zip(times[0].into_iter().zip(times[1])) {
        assert!(many < 20.0 * few, "{work}: {few:e} s and {many:e} s");
    }
}

#[test]
fn gross_slip_of_a_sum_does_no_more_for_each_point_of_its_table() {
    let times = [100, 10_000].map(|points| {
        let radii: Vec<f64> = (0..points).map(|index| 1e-3 * f64::from(index) / f64::from(points)).collect();
        let heights: Vec<f64> = radii.iter().map(|r| 40.0 * r * r).collect();
        let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
        let profile = Profile::Sum(Sum::new(vec![sphere(0.02), table]).unwrap());
        let mut contact = Contact::new(Setup {
            profile,
            elasticity: Elasticity::effective(1.13e11, 8.9e10).unwrap(),
            friction: 0.31,
            preload: Preload::ContactRadius(8e-4),
        })
        .unwrap();
        let full = contact.gross_slip_displacement();
        least_time(|| {
            for _ in 0..200 {
                contact.apply(&displace(2.0 * full)).unwrap();
                contact.apply(&displace(-2.0 * full)).unwrap();
            }
        })
    });
    assert!(times[1] < 8.0 * times[0], "{times:?} s");
}
