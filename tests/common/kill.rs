//! Kills a server under load repeatedly, and checks that no acknowledged move is lost.
//!
//! Clients move sessions, each move with an idempotency key, and repeat a move with its key until it is acknowledged.
//! So in the end every session must hold exactly the moves that were acknowledged for it: one more would be a move made
//! twice, one less a move lost.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use futures::future::join_all;
use stickslip_mechanics::{Contact, DEFAULT_TOLERANCE};
use stickslip_wire::client::{Client, Error, Options};
use stickslip_wire::{Document as _, HistoryItem, Move, MoveReply, State};
use tokio::sync::watch;
use uuid::Uuid;

use super::create;
use super::process::Process;

const CLIENTS: u64 = 12;
const SESSIONS: usize = 5;
/// Acknowledged moves between two kills, at least: each round is under load.
const ACKNOWLEDGED: usize = 20;
/// How long a test waits for what should take no time.
pub const PATIENCE: Duration = Duration::from_secs(30);

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

/// The confirmed moves: by session and sequence, the move and the state after it.
type Acknowledged = BTreeMap<(Uuid, u64), (Move, State)>;

/// Kills and restarts a server over a store repeatedly, and checks that no move is lost and none is stored twice.
pub async fn survives(store: &str, rounds: usize, seed: u64) {
    let mut random = Random(seed);
    let mut process = Process::start(store).await;
    let mut sessions = Vec::new();
    for _ in 0..SESSIONS {
        sessions.push(process.client.create(&create(), &Options::default()).await.unwrap().id);
    }
    let (place, places) = watch::channel(process.client.clone());
    let acknowledged = Arc::new(Mutex::new(Acknowledged::new()));
    let (count, over) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(false)));
    let clients = (0..CLIENTS).map(|client| {
        let (places, sessions, acknowledged) = (places.clone(), sessions.clone(), Arc::clone(&acknowledged));
        let (count, over, mut random) = (Arc::clone(&count), Arc::clone(&over), Random(seed ^ (client + 1) << 32));
        tokio::spawn(async move {
            while !over.load(Ordering::SeqCst) {
                let id = sessions[random.below(SESSIONS as u64) as usize];
                let (step, key) = (random.step(), format!("{seed}-{client}-{}", random.next()));
                let reply = until_acknowledged(&places, id, step, key).await;
                let before = acknowledged.lock().unwrap().insert((id, reply.sequence), (step, reply.state));
                assert!(before.is_none(), "two moves of {id} were confirmed as number {}", reply.sequence);
                count.fetch_add(1, Ordering::SeqCst);
            }
        })
    });
    let clients: Vec<_> = clients.collect();
    for round in 0..rounds {
        let enough = count.load(Ordering::SeqCst) + ACKNOWLEDGED;
        let waiting = async {
            while count.load(Ordering::SeqCst) < enough {
                tokio::time::sleep(Duration::from_millis(2)).await;
            }
        };
        tokio::time::timeout(PATIENCE, waiting).await.unwrap_or_else(|_| panic!("round {round}: nothing moves"));
        tokio::time::sleep(Duration::from_micros(random.below(100_000))).await;
        process.kill().await;
        process = Process::start(store).await;
        place.send_replace(process.client.clone());
    }
    over.store(true, Ordering::SeqCst);
    for client in clients {
        tokio::time::timeout(PATIENCE, client).await.expect("a client waits for ever").unwrap();
    }
    let mut acknowledged = std::mem::take(&mut *acknowledged.lock().unwrap());
    let histories = join_all(sessions.iter().map(|id| history(&process.client, *id))).await;
    for (id, history) in sessions.into_iter().zip(histories) {
        let live = process.client.contact(id).await.unwrap();
        assert_eq!((live.sequence, exact(&live.state)), (history.len() as u64, exact(&history.last().unwrap().state)));
        replays_to_the_last_bit(&history);
        for item in &history {
            let (step, state) = acknowledged
                .remove(&(id, item.sequence))
                .unwrap_or_else(|| panic!("{id} holds a move that was not confirmed: {item:?}"));
            assert_eq!((exact(&step), exact(&state)), (exact(&item.step), exact(&item.state)));
        }
    }
    assert!(acknowledged.is_empty(), "acknowledged and lost: {acknowledged:?}");
    process.stop().await;
}

/// Sends a move with its key until a server says that it is made.
async fn until_acknowledged(places: &watch::Receiver<Client>, id: Uuid, step: Move, key: String) -> MoveReply {
    let options = Options { idempotency_key: Some(key), ..Options::default() };
    loop {
        let client = places.borrow().clone();
        match tokio::time::timeout(PATIENCE, client.apply(id, &step.into(), &options)).await {
            Ok(Ok(reply)) => return reply,
            Ok(Err(Error::Problem(problem))) if problem.status < 500 => panic!("refused: {problem:?}"),
            Ok(Err(_)) => tokio::time::sleep(Duration::from_millis(5)).await,
            Err(_) => panic!("no answer to a move of {id}"),
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
