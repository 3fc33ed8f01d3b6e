//! A store returns what was saved, to the last bit.

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Measured, Record, Session, Store};
use stickslip_wire::{Move, State};

use crate::common::kill::Random;
use crate::common::kill::exact;
use crate::fixtures::{record, session, stored};

/// The ends of what a double can say, and what databases like to change.
const AWKWARD: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.1,
    5e-324,
    -5e-324,
    f64::MIN_POSITIVE,
    2.225_073_858_507_201e-308,
    f64::EPSILON,
    f64::MAX,
    f64::MIN,
    9_007_199_254_740_993.0,
    -9_223_372_036_854_775_808.0,
    1e15,
    1e300,
    123_456_789_012_345_680.0,
    0.300_000_000_000_000_04,
];

/// A move of up to nineteen numbers.
fn with(sequence: u64, mut number: impl FnMut() -> f64) -> Record {
    let mut optional = |present: bool| present.then(&mut number);
    let step = Move {
        displacement: optional(sequence.is_multiple_of(2)),
        force: optional(sequence % 2 == 1),
        indentation: optional(sequence.is_multiple_of(3)),
        normal_force: optional(sequence % 3 == 1),
        duration: optional(sequence % 4 == 1),
        twist: optional(sequence.is_multiple_of(5)),
        torque: optional(sequence.is_multiple_of(7)),
        relative: sequence.is_multiple_of(5),
    };
    let state = State {
        displacement: (!sequence.is_multiple_of(5)).then(&mut number),
        force: (!sequence.is_multiple_of(5)).then(&mut number),
        twist: sequence.is_multiple_of(5).then(&mut number),
        torque: sequence.is_multiple_of(5).then(&mut number),
        indentation: number(),
        normal_force: number(),
        contact_radius: number(),
        stick_radius: number(),
        dissipated_energy: number(),
        elastic_energy: number(),
        time: (sequence % 4 == 1).then(&mut number),
        viscous_work: (sequence % 4 == 1).then(&mut number),
        ..record(sequence).state
    };
    let measured = Some(Measured { force: number(), at: None });
    Record { step, tolerance: number(), state, measured, ..record(sequence) }
}

pub async fn every_number_is_read_to_the_last_bit(store: &dyn Store) {
    let (session, _) = stored(store, 0).await;
    let mut given: Vec<Record> = Vec::new();
    for number in AWKWARD {
        for _ in 0..6 {
            given.push(with(given.len() as u64 + 1, || number));
        }
    }
    let mut random = Random(17);
    while given.len() < 2_000 {
        // Any bits at all that are a finite number, and now and then an awkward one among them.
        let number = || loop {
            let bits = random.next();
            let number =
                if bits.is_multiple_of(7) { AWKWARD[bits as usize / 7 % AWKWARD.len()] } else { f64::from_bits(bits) };
            if number.is_finite() {
                return number;
            }
        };
        given.push(with(given.len() as u64 + 1, number));
    }
    store.append(session.id, 0, given.clone(), None).await.unwrap();
    let found = store.history(session.id, 0, given.len()).await.unwrap();
    for (given, found) in given.iter().zip(&found) {
        assert_eq!(exact(given), exact(found));
    }
    assert_eq!(given.len(), found.len());
}

pub async fn times_are_read_to_the_nanosecond(store: &dyn Store) {
    let origin: Timestamp = "1969-12-31T23:59:59.999999999Z".parse().unwrap();
    let mut random = Random(3);
    for nanoseconds in [0, 1, -1, 999_999_999, 1_000_000_000, 1_234_567_890_123_456_789, random.next() as i64 / 2] {
        let at = origin + SignedDuration::from_nanos(nanoseconds);
        let later = at + SignedDuration::from_nanos(1);
        let made = Session { created_at: at, updated_at: later, ..session(None) };
        store.create(made.clone(), None).await.unwrap();
        assert_eq!(store.find(made.id).await.unwrap(), made);
        // A clock may be set back between two moves.
        let moves = [later, at].map(|at| at + SignedDuration::from_nanos(41));
        for (sequence, at) in (0..).zip(moves) {
            let measured = Some(Measured { force: 1.0, at: Some(at) });
            let moved = vec![Record { at, measured, ..record(sequence + 1) }];
            store.append(made.id, sequence, moved, None).await.unwrap();
            assert_eq!(store.find(made.id).await.unwrap().updated_at, at);
        }
        let found = store.history(made.id, 0, 2).await.unwrap();
        assert_eq!(found.iter().map(|item| item.at).collect::<Vec<_>>(), moves);
        assert_eq!(found.iter().map(|item| item.measured.unwrap().at.unwrap()).collect::<Vec<_>>(), moves);
    }
}
