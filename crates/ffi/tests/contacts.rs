//! The functions as a program in C calls them: the same bits as the crate, and a code for whatever is wrong.

#![allow(clippy::undocumented_unsafe_blocks)]

mod support;

use std::ptr::{self, null, null_mut};
use std::thread;

use stickslip_ffi::exports::*;
use stickslip_mechanics::rings::{PlanarBuffers, PlanarLaw};
use stickslip_mechanics::{Contact, Move, Normal, Tangential};
use stickslip_wire::{CreateRequest, read};
use support::{BALL, definitions, failure, fresh, resident_bytes};

/// The contact of the crate.
fn own(json: &str) -> Contact {
    Contact::new(read::<CreateRequest>(json.as_bytes()).unwrap().setup).unwrap()
}

fn bits<const N: usize>(numbers: [f64; N]) -> [u64; N] {
    numbers.map(f64::to_bits)
}

fn state_of(contact: *const ss_contact) -> ss_contact_state {
    let mut state = ss_contact_state::default();
    assert_eq!(unsafe { ss_state(contact, &raw mut state) }, SS_OK);
    state
}

fn packed(contact: *const ss_contact) -> Vec<u8> {
    let mut length = 0;
    assert_eq!(unsafe { ss_pack(contact, null_mut(), 0, &raw mut length) }, SS_OK);
    let mut bytes = vec![0_u8; length];
    assert_eq!(unsafe { ss_pack(contact, bytes.as_mut_ptr().cast(), length, &raw mut length) }, SS_OK);
    bytes
}

#[test]
fn a_thousand_random_paths_have_the_bits_of_the_crate() {
    let mut random = fastrand::Rng::with_seed(74);
    let definitions = definitions();
    for path in 0..1000 {
        let json = &definitions[path % definitions.len()];
        let (mut expected, contact) = (own(json), fresh(json));
        let (depth, full) = (expected.indentation(), expected.gross_slip_displacement());
        for _ in 0..30 {
            let displacement = full * (2.4 * random.f64() - 1.2);
            let load = random.i32(0..3);
            let normal = match load {
                SS_INDENTATION => depth * (1.1 * random.f64() - 0.05),
                _ => expected.initial_summary().normal_force * random.f64(),
            };
            let target = match load {
                SS_CONSTANT_LOAD => None,
                SS_INDENTATION => Some(Normal::Indentation(normal)),
                _ => Some(Normal::Indentation(expected.indentation_under(normal).unwrap())),
            };
            let mut forces = [f64::NAN; 2];
            let way = random.u8(0..4);
            let step = if way == 0 { ss_step } else { ss_trial };
            assert_eq!(unsafe { step(contact, load, normal, &raw const displacement, forces.as_mut_ptr()) }, SS_OK);
            let tangential = Some(Tangential::Displacement(displacement));
            let mut moved = expected.clone();
            moved.apply(&Move { tangential, normal: target, ..Move::default() }).unwrap();
            assert_eq!(bits(forces), bits([moved.normal_force(), moved.force()]));
            match way {
                1 => assert_eq!(ss_revert(contact), SS_OK),
                2 => assert_eq!(ss_commit(contact), SS_OK),
                _ => {}
            }
            if way == 0 || way == 2 {
                expected = moved;
            }
            let (state, own) = (state_of(contact), expected.state());
            assert_eq!(state.force[0].to_bits(), own.force.to_bits());
            assert_eq!(state.dissipated_energy.to_bits(), own.dissipated_energy.to_bits());
            assert_eq!((state.stick_radius, state.regime), (own.stick_radius, own.regime as i32));
        }
        assert_eq!(packed(contact), expected.pack());
        let (copy, bytes) = (fresh(json), packed(contact));
        assert_eq!(unsafe { ss_unpack(copy, bytes.as_ptr().cast(), bytes.len()) }, SS_OK);
        assert_eq!(packed(copy), bytes);
        let mut stiffness = [0.0; 2];
        assert_eq!(unsafe { ss_stiffness(copy, -1, stiffness.as_mut_ptr()) }, SS_OK);
        let (normal, tangential) = expected.stiffness(-1.0).unwrap();
        assert_eq!(bits(stiffness), bits([normal, tangential]));
        assert_eq!([ss_free(contact), ss_free(copy)], [SS_OK; 2]);
    }
}

#[test]
fn paths_in_the_plane_have_the_bits_of_the_crate() {
    let mut random = fastrand::Rng::with_seed(75);
    let law = PlanarLaw::new(read::<CreateRequest>(BALL.as_bytes()).unwrap().setup.coulomb("").unwrap(), 12).unwrap();
    let mut buffers = PlanarBuffers::default();
    let full = law.contact().gross_slip_displacement();
    for _ in 0..40 {
        let (mut expected, mut contact) = (law.start(), null_mut());
        let json = support::text(BALL);
        assert_eq!(unsafe { ss_planar_new(json.as_ptr(), 12, &raw mut contact) }, SS_OK);
        for _ in 0..15 {
            let displacement = [0, 1].map(|_| full * (2.0 * random.f64() - 1.0));
            let (load, normal) = (random.i32(0..3), 10.0 * random.f64());
            let target = match load {
                SS_INDENTATION => Normal::Indentation(1e-7 * normal),
                SS_NORMAL_FORCE => Normal::NormalForce(normal),
                _ => Normal::NormalForce(expected.normal_force()),
            };
            let given = if load == SS_INDENTATION { 1e-7 * normal } else { normal };
            // A load by an indentation is kept as one.
            let target = match (load, law.load(Normal::Indentation(expected.state().indentation))) {
                (SS_CONSTANT_LOAD, Ok([depth, force])) if force.to_bits() == expected.normal_force().to_bits() => {
                    Normal::Indentation(depth)
                }
                _ => target,
            };
            law.step(&mut expected, target, displacement, &mut buffers).unwrap();
            let mut forces = [0.0; 3];
            let step = if random.bool() { ss_step } else { ss_trial };
            assert_eq!(unsafe { step(contact, load, given, displacement.as_ptr(), forces.as_mut_ptr()) }, SS_OK);
            assert!([SS_OK, SS_NO_TRIAL].contains(&ss_commit(contact)));
            let [x, y] = expected.force();
            assert_eq!(bits(forces), bits([expected.normal_force(), x, y]));
            assert_eq!(state_of(contact).dissipated_energy.to_bits(), expected.state().dissipated_energy.to_bits());
        }
        let bytes = packed(contact);
        assert_eq!(bytes, law.pack(&expected));
        assert_eq!(unsafe { ss_unpack(contact, bytes.as_ptr().cast(), bytes.len()) }, SS_OK);
        assert_eq!(packed(contact), bytes);
        ss_free(contact);
    }
}

#[test]
fn ten_thousand_misuses_give_a_code_and_a_text() {
    let mut random = fastrand::Rng::with_seed(76);
    let freed = fresh(BALL);
    assert_eq!(ss_free(freed), SS_OK);
    // Its slot has another contact now.
    let _other = fresh(BALL);
    let good = fresh(BALL);
    let (mut planar, json) = (null_mut(), support::text(BALL));
    assert_eq!(unsafe { ss_planar_new(json.as_ptr(), 8, &raw mut planar) }, SS_OK);
    let bytes = packed(good);
    let mut numbers = [0.0; 12];
    for case in 0..10_000 {
        let wild = ptr::without_provenance_mut::<ss_contact>(random.usize(..));
        let bad = [null_mut(), freed, wild, ptr::without_provenance_mut(random.usize(..1 << 33))][random.usize(..4)];
        let displacement = [0.0; 2];
        let (from, to) = (displacement.as_ptr(), numbers.as_mut_ptr());
        let mut made = null_mut();
        let (mut length, mut state) = (0, ss_contact_state::default());
        let number = [f64::NAN, f64::INFINITY, -1e300, 1e300][random.usize(..4)];
        let code = match case % 20 {
            0 => unsafe { ss_step(bad, SS_CONSTANT_LOAD, 0.0, from, to) },
            1 => unsafe { ss_trial(bad, SS_CONSTANT_LOAD, 0.0, from, to) },
            2 => ss_commit(if random.bool() { bad } else { good }),
            3 => ss_revert(bad),
            4 => ss_free(if bad.is_null() { freed } else { bad }),
            5 => unsafe { ss_state(bad, &raw mut state) },
            6 => unsafe { ss_state(good, null_mut()) },
            7 => unsafe { ss_copy(bad, &raw mut made) },
            8 => unsafe { ss_contact_new(null(), &raw mut made) },
            9 => {
                // A definition cut short, or with another byte.
                let mut text = BALL.as_bytes().to_vec();
                if random.bool() {
                    text.truncate(random.usize(..text.len()));
                } else {
                    let place = random.usize(..text.len());
                    text[place] = b'}';
                }
                let text = std::ffi::CString::new(text).unwrap();
                match unsafe { ss_contact_new(text.as_ptr(), &raw mut made) } {
                    // Within a label, say.
                    SS_OK => ss_free(made) + SS_REFUSED,
                    code => code,
                }
            }
            10 => unsafe { ss_contact_new(json.as_ptr(), null_mut()) },
            11 => unsafe { ss_step(good, random.i32(3..), 0.0, from, to) },
            12 => unsafe { ss_step(good, random.i32(1..3), number, from, to) },
            13 => unsafe { ss_step(good, SS_CONSTANT_LOAD, 0.0, &raw const number, to) },
            14 => unsafe { ss_step([good, planar][random.usize(..2)], SS_CONSTANT_LOAD, 0.0, null(), to) },
            15 => unsafe { ss_pack(good, to.cast(), random.usize(1..90), &raw mut length) },
            16 => {
                let mut damaged = bytes.clone();
                damaged.truncate(random.usize(..bytes.len()));
                unsafe { ss_unpack([good, planar][random.usize(..2)], damaged.as_ptr().cast(), damaged.len()) }
            }
            17 => unsafe { ss_packed_fixed(planar, 4, to, null_mut()) },
            18 => {
                let wrong = [number; 12];
                unsafe { ss_unpack_fixed(good, 4, wrong.as_ptr()) }
            }
            _ => unsafe {
                let array = [good, bad, planar];
                ss_step_many(array.as_ptr(), 3, SS_CONSTANT_LOAD, null(), [0.0; 6].as_ptr(), to, &raw mut length)
            },
        };
        assert_ne!(code, SS_OK, "case {case}");
        assert_ne!(code, SS_INTERNAL, "case {case}: {}", failure());
        assert!(!failure().is_empty());
    }
    assert_eq!(bits(state_of(good).displacement), [0; 2]);
    assert_eq!(ss_free(null_mut()), SS_OK);
}

#[test]
fn a_handle_of_a_contact_that_is_gone_does_not_disturb_the_one_in_its_slot() {
    let (gone, owner) = loop {
        let gone = fresh(BALL).addr();
        assert_eq!(ss_free(ptr::without_provenance_mut(gone)), SS_OK);
        let next = fresh(BALL);
        // The lower half of a handle is the number of its slot, which another thread may have taken in the meantime.
        if gone & 0xffff_ffff == next.addr() & 0xffff_ffff {
            break (gone, next);
        }
        assert_eq!(ss_free(next), SS_OK);
    };
    thread::scope(|scope| {
        let misuse = scope.spawn(|| {
            (0..200_000).for_each(|_| assert_eq!(ss_commit(ptr::without_provenance_mut(gone)), SS_NO_CONTACT));
        });
        while !misuse.is_finished() {
            state_of(owner);
        }
    });
}

#[test]
fn a_definition_that_is_wrong_is_refused_with_its_place() {
    let wrong = support::text(&BALL.replace("0.3}", "7}"));
    let mut contact = null_mut();
    assert_eq!(unsafe { ss_contact_new(wrong.as_ptr(), &raw mut contact) }, SS_INVALID_DEFINITION);
    assert!(contact.is_null() && failure().starts_with("/material/bodies/0/poisson_ratio: 7"), "{}", failure());
}

#[test]
fn contacts_are_made_and_freed_without_a_leak() {
    let first = fresh(BALL);
    let rounds = |count: usize| {
        for _ in 0..count {
            let mut copy = null_mut();
            assert_eq!(unsafe { ss_copy(first, &raw mut copy) }, SS_OK);
            let (to, mut forces) = (1e-8, [0.0; 2]);
            assert_eq!(unsafe { ss_trial(copy, SS_CONSTANT_LOAD, 0.0, &raw const to, forces.as_mut_ptr()) }, SS_OK);
            assert_eq!(ss_free(copy), SS_OK);
            assert_eq!(ss_free(fresh(BALL)), SS_OK);
        }
    };
    rounds(1000);
    let before = resident_bytes();
    // Two contacts a round.
    let count = std::env::var("STICKSLIP_CONTACTS").map_or(200_000, |count| count.parse().unwrap());
    rounds(count / 2);
    let grown = resident_bytes().saturating_sub(before);
    // One that is lost takes some hundred bytes.
    assert!(grown < 4 << 20, "{grown} bytes");
}

#[test]
fn threads_step_contacts_of_their_own_and_are_told_of_a_shared_one() {
    let first = fresh(BALL);
    let contacts: Vec<usize> = (0..1000)
        .map(|_| {
            let mut copy = null_mut();
            assert_eq!(unsafe { ss_copy(first, &raw mut copy) }, SS_OK);
            copy.addr()
        })
        .collect();
    let displacements: Vec<f64> = (0..1000).map(|index| 1e-10 * f64::from(index)).collect();
    let step = |contacts: &[usize], displacements: &[f64]| {
        let handles: Vec<*mut ss_contact> =
            contacts.iter().map(|handle| ptr::without_provenance_mut(*handle)).collect();
        let (mut forces, mut done) = (vec![0.0; 2 * contacts.len()], 0);
        let normal = vec![8.0; contacts.len()];
        let (from, to) = (displacements.as_ptr(), forces.as_mut_ptr());
        let (all, count) = (handles.as_ptr(), contacts.len());
        let code = unsafe { ss_step_many(all, count, SS_NORMAL_FORCE, normal.as_ptr(), from, to, &raw mut done) };
        assert_eq!((code, done), (SS_OK, count), "{}", failure());
        forces
    };
    let forces: Vec<f64> = thread::scope(|scope| {
        let parts = contacts.chunks(130).zip(displacements.chunks(130));
        let threads: Vec<_> = parts.map(|(contacts, to)| scope.spawn(move || step(contacts, to))).collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    let mut alone = own(BALL);
    let depth = Normal::Indentation(alone.indentation_under(8.0).unwrap());
    alone
        .apply(&Move {
            tangential: Some(Tangential::Displacement(999.0 * 1e-10)),
            normal: Some(depth),
            ..Move::default()
        })
        .unwrap();
    assert_eq!(forces[1998..], [alone.normal_force(), alone.force()]);
    // One contact by many threads: each call is made, or refused.
    let shared = first.addr();
    let made: usize = thread::scope(|scope| {
        let threads: Vec<_> = (0..4)
            .map(|_| {
                scope.spawn(move || {
                    let contact = ptr::without_provenance_mut(shared);
                    let step = |index: i32| {
                        let (to, mut forces) = (1e-9 * f64::from(index % 7), [0.0; 2]);
                        unsafe { ss_step(contact, SS_CONSTANT_LOAD, 0.0, &raw const to, forces.as_mut_ptr()) }
                    };
                    let codes: Vec<i32> = (0..2000).map(step).collect();
                    assert!(codes.iter().all(|code| [SS_OK, SS_BUSY].contains(code)));
                    codes.iter().filter(|code| **code == SS_OK).count()
                })
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).sum()
    });
    assert!(made > 0);
}

#[test]
fn a_history_of_bounded_size_goes_through_twelve_doubles() {
    let contact = fresh(BALL);
    let mut forces = [0.0; 2];
    let (mut numbers, mut dropped) = ([f64::NAN; 12], -1);
    for (index, to) in [9e-8, -8e-8, 7e-8, -6e-8, 5e-8, -4e-8, 3e-8].into_iter().enumerate() {
        assert_eq!(unsafe { ss_step(contact, SS_CONSTANT_LOAD, 0.0, &raw const to, forces.as_mut_ptr()) }, SS_OK);
        assert_eq!(unsafe { ss_packed_fixed(contact, 4, numbers.as_mut_ptr(), &raw mut dropped) }, SS_OK);
        assert_eq!(dropped, i32::from(index >= 4));
    }
    assert_eq!(unsafe { ss_unpack_fixed(contact, 4, numbers.as_ptr()) }, SS_OK);
    let state = state_of(contact);
    assert_eq!((state.turning_points, numbers[1]), (4, 3e-8));
    assert!((state.force[0] - forces[1]).abs() < 0.05 * 3.0, "{} and {}", state.force[0], forces[1]);
}
