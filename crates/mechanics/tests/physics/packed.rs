//! A contact as bytes: read back it is the same to the last bit, and whatever else is read does no harm.

use crate::support::{Random, forall};
use proptest::prelude::*;
use stickslip_mechanics::profile::{
    Cone, ExactSphere, FlatPunch, PowerLaw, RoundedCone, RoundedPunch, Sphere, Sum, Tabulated, TruncatedSphere,
};
use stickslip_mechanics::{Contact, ENGINE, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

/// Indentation at the preload, m.
const DEPTH: f64 = 1e-6;
/// Families to choose from.
const SHAPES: usize = 9;

fn profile(shape: usize) -> Profile {
    match shape {
        0 => Profile::Sphere(Sphere::new(0.01).unwrap()),
        1 => Profile::ExactSphere(ExactSphere::new(0.01).unwrap()),
        2 => Profile::Cone(Cone::new(0.05).unwrap()),
        3 => Profile::PowerLaw(PowerLaw::new(1.7, 3.0).unwrap()),
        4 => Profile::FlatPunch(FlatPunch::new(1e-4).unwrap()),
        5 => Profile::TruncatedSphere(TruncatedSphere::new(0.01, 2e-5).unwrap()),
        6 => Profile::RoundedPunch(RoundedPunch::new(5e-5, 0.002).unwrap()),
        7 => {
            let radii: Vec<f64> = (0..40).map(|index| 2e-5 * f64::from(index)).collect();
            let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02).collect();
            Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
        }
        _ => Profile::Sum(
            Sum::new(vec![profile(0), Profile::RoundedCone(RoundedCone::new(0.01, 1e-5).unwrap())]).unwrap(),
        ),
    }
}

fn virgin(shape: usize) -> Contact {
    virgin_at(shape, DEPTH)
}

fn virgin_at(shape: usize, indentation: f64) -> Contact {
    Contact::new(Setup {
        profile: profile(shape),
        elasticity: Elasticity::effective(1.15e11, 8.5e10).unwrap(),
        friction: 0.3,
        preload: Preload::Indentation(indentation),
    })
    .unwrap()
}

/// A move to anywhere: straight or curved, into the contact, out of it, sliding or not.
fn any_move(virgin: &Contact, random: &mut Random) -> (Move, f64) {
    let figures = virgin.initial_summary();
    let (slide, load) = (figures.gross_slip_displacement, figures.normal_force);
    let depth = DEPTH * random.within(-0.1, 1.5);
    let tangential = match random.within(0.0, 4.0) as usize {
        0 => None,
        1 => Some(Tangential::Force(random.within(-0.2, 0.2) * figures.gross_slip_force)),
        _ => Some(Tangential::Displacement(random.within(-1.1, 1.1) * slide)),
    };
    let normal = match random.within(0.0, 5.0) as usize {
        0 => Some(Normal::NormalForce(load * random.within(0.5, 1.5))),
        1 => Some(Normal::Indentation(depth)),
        _ => None,
    };
    let tolerance = 10_f64.powf(random.within(-7.0, -4.0));
    (Move { tangential, normal, relative: random.within(0.0, 8.0) < 1.0, duration: 0.0 }, tolerance)
}

/// Makes moves; those that are refused change nothing.
fn move_at_random(contact: &mut Contact, virgin: &Contact, count: usize, random: &mut Random) {
    for _ in 0..count {
        let (step, tolerance) = any_move(virgin, random);
        let _ = contact.apply_within(&step, tolerance);
    }
}

/// All fields, and the results that are computed from them, digit by digit.
fn digest_of(contact: &Contact) -> String {
    let radius = contact.contact_radius();
    let shear: Vec<u64> = (0..20).map(|part| contact.shear(radius * f64::from(part) / 19.0).to_bits()).collect();
    format!("{contact:?} {:?} {:?} {shear:?}", contact.state(), contact.accuracy())
}

/// Displacements over that of gross slip that are hard to follow: loops that nearly close or close exactly, steps of
/// the last digit, steps that take each other back, slip from end to end.
fn hard_displacements(count: usize, random: &mut Random) -> Vec<f64> {
    let mut path: Vec<f64> = vec![random.within(-1.0, 1.0)];
    while path.len() < count {
        let here = path[path.len() - 1];
        let earlier = path[(random.within(0.0, path.len() as f64) as usize).min(path.len() - 1)];
        let tiny = 10_f64.powf(random.within(-17.0, -8.0));
        path.push(match random.within(0.0, 8.0) as usize {
            0 => earlier,
            1 => earlier + tiny,
            2 => earlier * (1.0 - tiny),
            3 => here + tiny,
            4 => here - tiny,
            5 => here.next_up(),
            6 => random.within(-1.3, 1.3),
            _ => random.within(-1.0, 1.0) * earlier,
        });
    }
    path
}

#[test]
fn what_a_contact_keeps_for_its_next_move_changes_no_bit_on_hard_paths() {
    forall(200, (0..SHAPES, 1..80_usize, any::<u64>()), |(shape, count, seed)| {
        let (virgin, mut random) = (virgin(shape), Random(seed | 1));
        let full = virgin.gross_slip_displacement();
        let mut contact = virgin.clone();
        // A contact that has just been read holds its state alone.
        let mut bare = virgin.clone();
        for share in hard_displacements(count, &mut random) {
            let step = Move { tangential: Some(Tangential::Displacement(share * full)), ..Move::default() };
            contact.apply(&step).unwrap();
            bare = virgin.unpack(&bare.pack()).expect("it was packed a moment ago");
            bare.apply(&step).unwrap();
            assert_eq!(format!("{:?}", bare.state()), format!("{:?}", contact.state()), "{share}");
        }
        assert_eq!(digest_of(&bare), digest_of(&contact));
    });
}

#[test]
fn what_is_read_back_is_the_same_to_the_last_bit_and_stays_so() {
    forall(300, (0..SHAPES, 0..60_usize, any::<u64>()), |(shape, count, seed)| {
        let (virgin, mut random) = (virgin(shape), Random(seed | 1));
        let mut contact = virgin.clone();
        move_at_random(&mut contact, &virgin, count, &mut random);
        let bytes = contact.pack();
        assert_eq!(bytes.len(), contact.packed_length());
        let mut read = virgin.unpack(&bytes).expect("it was packed a moment ago");
        assert_eq!(digest_of(&read), digest_of(&contact));
        // And from there on, whichever of the two is moved.
        let mut twin = Random(random.0);
        move_at_random(&mut contact, &virgin, 20, &mut random);
        move_at_random(&mut read, &virgin, 20, &mut twin);
        assert_eq!(digest_of(&read), digest_of(&contact));
    });
}

#[test]
fn the_stack_that_is_read_back_takes_no_more_room_than_it_needs() {
    let (virgin, mut random) = (virgin(0), Random(7));
    let mut contact = virgin.clone();
    move_at_random(&mut contact, &virgin, 3_000, &mut random);
    let read = virgin.unpack(&contact.pack()).unwrap();
    assert!(read.memory_bytes() <= contact.memory_bytes());
}

#[test]
fn bytes_that_are_cut_short_or_drawn_out_are_not_read() {
    let (virgin, mut random) = (virgin(0), Random(11));
    let mut contact = virgin.clone();
    move_at_random(&mut contact, &virgin, 40, &mut random);
    let bytes = contact.pack();
    for length in 0..bytes.len() {
        let piece_by_piece = virgin.unpack(&bytes[..length]);
        // Whole pieces from the top may be missing unnoticed, which a checksum is for.
        assert!(piece_by_piece.is_none() || (bytes.len() - length).is_multiple_of(112), "{length}");
    }
    let longer = [&bytes[..], &[0]].concat();
    assert!(virgin.unpack(&longer).is_none());
}

#[test]
fn any_bytes_at_all_are_refused_or_read_without_a_panic() {
    let virgin = virgin(0);
    let head = virgin.pack()[..4 + 4 * 8].to_vec();
    let tail = prop::collection::vec(any::<u8>(), 0..1_000);
    forall(2_000, (any::<bool>(), tail), |(sound, tail)| {
        let bytes = if sound { [&head[..], &tail].concat() } else { tail };
        if let Some(read) = virgin.unpack(&bytes) {
            assert!(read.memory_bytes() < 4_096 + 2 * bytes.len());
        }
    });
    // One wrong byte in what is otherwise sound.
    let mut contact = virgin.clone();
    move_at_random(&mut contact, &virgin, 30, &mut Random(3));
    let bytes = contact.pack();
    forall(2_000, (0..bytes.len(), any::<u8>()), |(place, value)| {
        let mut bytes = bytes.clone();
        bytes[place] = value;
        let _ = virgin.unpack(&bytes);
    });
}

#[test]
fn another_contact_and_another_version_are_refused() {
    let bytes = virgin(0).pack();
    assert!(virgin_at(0, 2.0 * DEPTH).unpack(&bytes).is_none());
    assert!(virgin(2).unpack(&bytes).is_none());
    for place in [0, 2] {
        let mut other = bytes.clone();
        other[place] ^= 1;
        assert!(virgin(0).unpack(&other).is_none());
    }
}

/// Results of the engine, mixed into one number (FNV-1a): of a sphere and a flat punch, by displacement, indentation
/// and force. They need no function beyond the square root, so that the digits are the same on every machine.
fn digest() -> u64 {
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for shape in [0, 4] {
        let virgin = virgin(shape);
        let figures = virgin.initial_summary();
        let (mut contact, mut random) = (virgin.clone(), Random(1 + shape as u64));
        for index in 0..300 {
            let slide = random.within(-1.1, 1.1);
            let tangential = match index % 4 {
                0 => Tangential::Force(0.4 * slide * figures.gross_slip_force),
                _ => Tangential::Displacement(slide * figures.gross_slip_displacement),
            };
            let depth = DEPTH * random.within(if index % 20 == 0 { -0.1 } else { 0.5 }, 1.5);
            let normal = (index % 3 == 0).then_some(Normal::Indentation(depth));
            // Where friction cannot hold the force the contact stays where it is.
            let _ = contact.apply_within(&Move { tangential: Some(tangential), normal, ..Move::default() }, 1e-6);
            let state = contact.state();
            let stress = contact.shear(0.5 * state.contact_radius);
            for value in [state.force, state.stick_radius, state.dissipated_energy, state.elastic_energy, stress] {
                for byte in value.to_le_bytes() {
                    digest = (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
    }
    digest
}

#[test]
fn results_that_change_come_with_a_new_version_of_the_engine() {
    assert_eq!(
        (ENGINE, digest()),
        (22, 9_906_667_971_450_372_769),
        "results differ from those of the version: raise ENGINE in contact/packed.rs, and put both here"
    );
}
