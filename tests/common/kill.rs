//! Random moves, and the past of a session held against what they give on a fresh contact.

use stickslip_mechanics::{Contact, DEFAULT_TOLERANCE};
use stickslip_wire::client::Client;
use stickslip_wire::{Document as _, HistoryItem, Move, State};
use uuid::Uuid;

use super::create;

/// A generator of random numbers that a seed determines (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Below a bound.
    pub fn below(&mut self, bound: u64) -> u64 {
        self.next() % bound
    }

    /// Between -1 and 1.
    pub fn number(&mut self) -> f64 {
        self.next() as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    /// A move that the contact of the examples can always make, whatever came before it.
    pub fn step(&mut self) -> Move {
        let (tangential, normal) = (self.number(), self.number());
        match self.below(4) {
            0 => Move::displacement(2e-7 * tangential),
            1 => Move { relative: true, ..Move::displacement(5e-8 * tangential) },
            2 => Move { indentation: Some(4.7e-7 * (1.0 + 0.3 * normal)), ..Move::displacement(2e-7 * tangential) },
            _ => Move::force(0.5 * tangential),
        }
    }
}

/// All moves of a session, in pages, numbered without a gap.
pub async fn history(client: &Client, id: Uuid) -> Vec<HistoryItem> {
    let (mut items, mut next) = (Vec::new(), Some(0));
    while let Some(after) = next {
        let page = client.history(id, Some(after), Some(1_000)).await.unwrap();
        items.extend(page.items);
        next = page.next;
    }
    let numbers: Vec<u64> = items.iter().map(|item: &HistoryItem| item.sequence).collect();
    assert_eq!(numbers, (1..=items.len() as u64).collect::<Vec<_>>());
    items
}

/// Makes the moves of a history again on a fresh contact of the library, and compares every state.
pub fn replays_to_the_last_bit(history: &[HistoryItem]) {
    let mut contact = Contact::new(create().check().unwrap().setup).unwrap();
    for item in history {
        contact.apply_within(&item.step.step(), DEFAULT_TOLERANCE).unwrap();
        assert_eq!(exact(&State::from(contact.state())), exact(&item.state), "move {}", item.sequence);
    }
}

/// Every digit, and the sign of zero, which `==` ignores.
pub fn exact(value: &impl std::fmt::Debug) -> String {
    format!("{value:?}")
}
