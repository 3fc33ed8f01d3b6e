//! The load of a soak: what its clients do with the contacts of a round, and what must be true of them at its end.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use stickslip_wire::client::Options;
use stickslip_wire::{ForkRequest, Path, PathRequest, SimulateRequest, Steps, StressRequest};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::timeout;
use uuid::Uuid;

use crate::common::kill::{Random, exact, history, replays_to_the_last_bit};
use crate::common::{PATIENCE, ball, create, of, until};
use crate::hostile_http;
use crate::soak::Soak;

/// The contacts of one round, and what has been acknowledged of them.
pub struct Round<'a> {
    soak: &'a Soak,
    ids: Vec<Uuid>,
    /// By contact and sequence: the move and the state after it.
    acknowledged: RefCell<BTreeMap<(Uuid, u64), (String, String)>>,
    /// The last acknowledged sequence.
    last: RefCell<BTreeMap<Uuid, u64>>,
    /// The original, its sequence, and the copy.
    forks: RefCell<Vec<(Uuid, u64, Uuid)>>,
    over: Cell<bool>,
}

/// The simulation that clients ask for again and again.
pub fn simulation() -> SimulateRequest {
    let body = of(&ball(), &serde_json::json!({"path": {"falling_amplitude": {"reversals": 200}}}));
    serde_json::from_value(body).unwrap()
}

impl<'a> Round<'a> {
    pub fn of(soak: &'a Soak, ids: Vec<Uuid>) -> Round<'a> {
        let (acknowledged, last, forks) = (RefCell::default(), RefCell::default(), RefCell::default());
        Round { soak, ids, acknowledged, last, forks, over: Cell::new(false) }
    }

    /// Has the clients end.
    pub fn end(&self) {
        self.over.set(true);
    }

    /// One client, until the accidents are over.
    pub async fn work(&self, mut random: Random, seed: u64, client: u64) {
        for number in 0.. {
            if self.over.get() {
                return;
            }
            let id = self.ids[random.below(self.ids.len() as u64) as usize];
            let key = format!("{seed}-{client}-{number}");
            match random.below(16) {
                0 => self.fork(id, key).await,
                1 => self.come_and_go(key).await,
                2 => self.path(id, &mut random, key).await,
                3 => self.simulate().await,
                4 => self.attack(&mut random).await,
                5..8 => self.read(id, &mut random).await,
                _ => self.apply(id, &mut random, key).await,
            }
        }
    }

    fn acknowledge(&self, id: Uuid, sequence: u64, step: String, state: String) {
        let before = self.acknowledged.borrow_mut().insert((id, sequence), (step, state));
        assert!(before.is_none(), "two moves of {id} were confirmed as number {sequence}");
        let mut last = self.last.borrow_mut();
        let known = last.entry(id).or_default();
        *known = sequence.max(*known);
    }

    async fn apply(&self, id: Uuid, random: &mut Random, key: String) {
        let (step, options) = (random.step(), Options { idempotency_key: Some(key), ..Options::default() });
        let reply = self.soak.insist(async |client| client.apply(id, &step.into(), &options).await).await.unwrap();
        self.acknowledge(id, reply.sequence, exact(&step), exact(&reply.state));
        self.soak.count(|figures| figures.moves += 1);
    }

    async fn path(&self, id: Uuid, random: &mut Random, key: String) {
        let moves: Vec<_> = (0..20).map(|_| random.step()).collect();
        let path = Path::Moves(moves.clone());
        let request = PathRequest { path, stress: None, steps: Steps::All, tolerance: None };
        let options = Options { idempotency_key: Some(key), ..Options::default() };
        let reply = self.soak.insist(async |client| client.path(id, &request, &options).await).await.unwrap();
        assert_eq!(reply.steps.len(), moves.len());
        let first = reply.sequence + 1 - moves.len() as u64;
        for (sequence, (step, state)) in (first..).zip(moves.iter().zip(&reply.steps)) {
            self.acknowledge(id, sequence, exact(step), exact(state));
        }
        self.soak.count(|figures| figures.moves += moves.len() as u64);
    }

    async fn fork(&self, id: Uuid, key: String) {
        let options = Options { idempotency_key: Some(key), ..Options::default() };
        let fork = self.soak.insist(async |client| client.fork(id, &ForkRequest::default(), &options).await).await;
        let fork = fork.unwrap();
        self.forks.borrow_mut().push((id, fork.sequence, fork.id));
        self.soak.count(|figures| figures.forks += 1);
    }

    /// Makes a contact and deletes it.
    async fn come_and_go(&self, key: String) {
        let options = Options { idempotency_key: Some(key), ..Options::default() };
        let id = self.soak.insist(async |client| client.create(&create(), &options).await).await.unwrap().id;
        let gone = self.soak.insist(async |client| client.delete(id, &Options::default()).await).await;
        // An attempt whose answer was lost has deleted it.
        assert!(matches!(gone, Ok(()) | Err(404)), "{gone:?}");
        self.soak.count(|figures| figures.contacts += 1);
    }

    async fn simulate(&self) {
        let reply = self.soak.insist(async |client| client.simulate(&simulation()).await).await.unwrap();
        assert_eq!(exact(&reply.steps), self.soak.simulation);
        self.soak.count(|figures| figures.reads += 1);
    }

    /// What has been acknowledged is seen by everybody, at once.
    async fn read(&self, id: Uuid, random: &mut Random) {
        let known = self.last.borrow().get(&id).copied().unwrap_or_default();
        if random.below(2) == 0 {
            let reply = self.soak.insist(async |client| client.contact(id).await).await.unwrap();
            assert!(reply.sequence >= known, "{id} was at {known}, and is at {}", reply.sequence);
        } else {
            let request = StressRequest { points: Some(50), ..StressRequest::default() };
            self.soak.insist(async |client| client.stress(id, &request, true).await).await.unwrap();
            let page = self.soak.insist(async |client| client.history(id, Some(known.saturating_sub(1)), None).await);
            let page = page.await.unwrap();
            assert!(known == 0 || page.items[0].sequence == known, "{id} has lost move {known}");
        }
        self.soak.count(|figures| figures.reads += 1);
    }

    /// Sends a hostile head; it is refused, or the connection is closed.
    async fn attack(&self, random: &mut Random) {
        // Those that wait for the end of their time would only wait.
        let mut cases = hostile_http::cases();
        cases.retain(|(_, _, status)| *status != 0 && *status != 408);
        let (name, bytes, status) = &cases[random.below(cases.len() as u64) as usize];
        let address = self.soak.base.borrow().trim_start_matches("http://").to_owned();
        let Ok(stream) = TcpStream::connect(address).await else { return };
        let (mut reader, mut writer) = stream.into_split();
        let mut answer = Vec::new();
        let exchange = async {
            // The server may close the connection before it has read everything.
            let _ = writer.write_all(bytes).await;
            let _ = writer.shutdown().await;
            let _ = reader.read_to_end(&mut answer).await;
        };
        timeout(PATIENCE, exchange).await.unwrap_or_else(|_| panic!("{name}: the connection stays open"));
        let text = String::from_utf8_lossy(&answer);
        let found: Option<u16> = text.strip_prefix("HTTP/1.").and_then(|rest| rest.get(2..5)?.parse().ok());
        // 503: all places were taken.
        assert!(found.is_none_or(|found| found == *status || found == 503), "{name}: {text}");
        self.soak.count(|figures| figures.hostile += 1);
    }

    /// The store has what was acknowledged, and nothing else.
    pub async fn compare(self) {
        let client = self.soak.client.borrow().clone();
        until("the server is ready", async || client.readyz().await.ok()).await;
        let mut expected: BTreeSet<Uuid> = self.ids.iter().copied().collect();
        expected.extend(self.forks.borrow().iter().map(|(_, _, copy)| *copy));
        let (mut found, mut after) = (BTreeSet::new(), None);
        loop {
            let page = client.contacts(after, Some(1_000)).await.unwrap();
            found.extend(page.items.iter().map(|contact| contact.id));
            after = page.next;
            if after.is_none() {
                break;
            }
        }
        assert_eq!(found, expected);
        let mut acknowledged = self.acknowledged.take();
        let mut pasts = BTreeMap::new();
        for id in &self.ids {
            let past = history(&client, *id).await;
            replays_to_the_last_bit(&past);
            for item in &past {
                let confirmed = acknowledged.remove(&(*id, item.sequence));
                assert_eq!(confirmed, Some((exact(&item.step), exact(&item.state))), "{id} {}", item.sequence);
            }
            pasts.insert(*id, past);
        }
        assert!(acknowledged.is_empty(), "acknowledged and lost: {acknowledged:?}");
        for (original, sequence, copy) in self.forks.take() {
            let past = history(&client, copy).await;
            assert_eq!(exact(&past), exact(&pasts[&original][..sequence as usize].to_vec()));
        }
        for id in expected {
            client.delete(id, &Options::default()).await.unwrap();
        }
    }
}
