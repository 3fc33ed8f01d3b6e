//! Clients that ask for whatever a contact can do, lose replies and connections, repeat requests, and record what they
//! have seen.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use futures::future::join_all;
use tokio::sync::watch;
use tokio::time::{sleep, timeout};
use uuid::Uuid;

use crate::common::kill::{Random, history, replays_to_the_last_bit};
use crate::common::{PATIENCE, create};
use stickslip_wire::client::Options;

use super::linearizability::{Call, History};
use super::model::{Contact, Made, Operation, Reply, Request, Step};
use super::service::{NoReply, Service};

/// Moves that the history of a contact may have when it is read as a whole.
const WHOLE: u64 = 1000;
/// How long a client waits for a reply before it takes it for lost. Far more than any freeze takes: replies are lost by
/// the seed.
const WAIT: Duration = Duration::from_secs(20);
/// How long it waits where the store does not answer.
const OUTAGE: Duration = Duration::from_millis(300);
/// How often a request of unknown outcome is repeated.
const RETRIES: u64 = 3;

/// How much is asked for.
#[derive(Clone, Copy)]
pub struct Load {
    pub contacts: usize,
    pub clients: u64,
    /// Of each client, on all contacts together.
    pub operations: u64,
    /// Whether clients lose replies and connections.
    pub losses: bool,
}

/// What the clients have seen of a service.
pub struct Recorder {
    pub service: Service,
    load: Load,
    seed: u64,
    clock: AtomicU64,
    /// Requests that are done, whatever came of them.
    pub done: AtomicU64,
    /// Whether clients wait with their next request: the store is known to be out of reach.
    pub paused: watch::Sender<bool>,
    /// Contacts that all clients know, oldest first.
    contacts: Mutex<Vec<Uuid>>,
    histories: Mutex<HashMap<Uuid, History>>,
    /// What forks were found to have made when they were new.
    pasts: Mutex<HashMap<Uuid, Arc<[Made]>>>,
}

/// What a client does about a reply.
enum Fate {
    Awaited,
    /// The request is sent, and the reply comes to nobody.
    ReplyLost,
    /// The connection is closed after a time.
    ConnectionLost(Duration),
}

impl Recorder {
    /// Makes the contacts.
    pub async fn start(service: Service, load: Load, seed: u64) -> Recorder {
        let recorder = Recorder {
            service,
            load,
            seed,
            clock: AtomicU64::new(0),
            done: AtomicU64::new(0),
            paused: watch::Sender::new(false),
            contacts: Mutex::default(),
            histories: Mutex::default(),
            pasts: Mutex::default(),
        };
        for _ in 0..load.contacts {
            let id = recorder.service.client(0).create(&create(), &Options::default()).await.unwrap().id;
            recorder.publish(id, Contact::default());
        }
        recorder
    }

    /// All requests of all clients.
    pub fn requests(&self) -> u64 {
        self.load.clients * self.load.operations
    }

    /// All clients at work, to the end.
    pub async fn work(self: &Arc<Self>) {
        let clients = (0..self.load.clients).map(|client| {
            let recorder = Arc::clone(self);
            tokio::spawn(async move { recorder.client(client).await })
        });
        for client in join_all(clients).await {
            client.unwrap();
        }
    }

    async fn client(self: Arc<Self>, client: u64) {
        let mut random = Random(self.seed << 16 | client);
        // What it has last seen of each contact, and its last request with a key.
        let mut known: HashMap<Uuid, u64> = HashMap::new();
        let mut keyed: HashMap<Uuid, Request> = HashMap::new();
        for number in 0..self.load.operations {
            let id = self.some_contact(&mut random);
            let sequence = known.get(&id).copied().unwrap_or(0);
            let key = format!("{}-{client}-{number}", self.seed);
            let request = match keyed.remove(&id) {
                // The same again, though it may have been answered; or another one with its key.
                Some(again) if random.below(2) == 0 => again,
                Some(again) if random.below(3) == 0 => {
                    Request { operation: Operation::Advance(vec![some_step(&mut random)]), ..again }
                }
                _ => some_request(&mut random, sequence, key),
            };
            let mut replica = random.below(2);
            for _ in 0..RETRIES {
                let fate = self.fate(&mut random);
                let reply = self.attempt(replica, id, &request, fate).await;
                replica += random.below(4).min(1);
                match reply {
                    Some(reply) => {
                        let seen = reply.sequence().unwrap_or(sequence);
                        known.insert(id, seen);
                        break;
                    }
                    // Without a key a repetition is another request.
                    None if request.key.is_none() => break,
                    None => {}
                }
            }
            if request.key.is_some() {
                keyed.insert(id, request);
            }
            self.done.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// More often one of those that were there first, so that several clients work on the same.
    fn some_contact(&self, random: &mut Random) -> Uuid {
        let contacts = self.contacts.lock().unwrap();
        let among = if random.below(4) == 0 { contacts.len() } else { self.load.contacts };
        contacts[random.below(among as u64) as usize]
    }

    fn fate(&self, random: &mut Random) -> Fate {
        let (choice, delay) = (random.below(20), random.below(12_000));
        match choice {
            0..2 if self.load.losses => Fate::ReplyLost,
            2..5 if self.load.losses => Fate::ConnectionLost(Duration::from_micros(delay)),
            _ => Fate::Awaited,
        }
    }

    /// Sends a request, and records it with its reply; `None` if that is lost.
    async fn attempt(self: &Arc<Self>, replica: u64, id: Uuid, request: &Request, fate: Fate) -> Option<Reply> {
        self.paused.subscribe().wait_for(|is_paused| !is_paused).await.unwrap();
        let place = self.called(id, request);
        let (recorder, sent) = (Arc::clone(self), request.clone());
        let serve = async move { recorder.until_sent(replica, id, &sent).await };
        let reply = match fate {
            Fate::Awaited => timeout(WAIT, serve).await.unwrap_or(None),
            Fate::ReplyLost => {
                tokio::spawn(serve);
                None
            }
            Fate::ConnectionLost(delay) => timeout(delay, serve).await.unwrap_or(None),
        }?;
        self.returned(id, place, reply.clone());
        if let Reply::Forked { id: Some(fork), summary, .. } = &reply {
            self.look_at_fork(*fork, summary.label.clone()).await;
        }
        Some(reply)
    }

    /// Sends a request, again as long as nothing has been done about it; `None` if nobody knows whether it has.
    async fn until_sent(&self, mut replica: u64, id: Uuid, request: &Request) -> Option<Reply> {
        loop {
            match self.service.serve(replica, id, request).await {
                Ok(reply) => return Some(reply),
                Err(NoReply::Unknown) => return None,
                Err(NoReply::Unavailable) => {
                    // The more requests have no outcome, the more orders there are to try.
                    sleep(OUTAGE).await;
                    return None;
                }
                Err(NoReply::NothingDone) => {
                    sleep(Duration::from_millis(5)).await;
                    replica += 1;
                }
            }
        }
    }

    /// Reads the past of a new fork before any other client knows it.
    async fn look_at_fork(&self, id: Uuid, label: Option<String>) {
        if self.pasts.lock().unwrap().contains_key(&id) {
            return;
        }
        let past = self.insist(0, id, Operation::History { after: 0, limit: WHOLE }).await;
        let Reply::Page(items, false) = past else { panic!("a fork has the past {past:?}") };
        assert!((1..).zip(&items).all(|(number, (sequence, _))| number == *sequence), "{items:?}");
        let past: Arc<[Made]> = items.into_iter().map(|(_, made)| made).collect();
        if self.pasts.lock().unwrap().insert(id, Arc::clone(&past)).is_none() {
            self.publish(id, Contact::after(&past, label));
        }
    }

    /// Sends a request that changes nothing until it is answered.
    async fn insist(&self, replica: u64, id: Uuid, operation: Operation) -> Reply {
        let request = Request { operation, expected: None, key: None };
        let served = async {
            loop {
                if let Ok(Some(reply)) = timeout(WAIT, self.until_sent(replica, id, &request)).await {
                    break reply;
                }
            }
        };
        timeout(PATIENCE, served).await.expect("a read is never answered")
    }

    /// Everything that is stored in the end, as each replica shows it.
    pub async fn read_all(&self) {
        let contacts = self.contacts.lock().unwrap().clone();
        join_all(contacts.iter().map(async |id| {
            for replica in 0..2 {
                for operation in [Operation::History { after: 0, limit: WHOLE }, Operation::Read] {
                    let place = self.called(*id, &Request { operation: operation.clone(), expected: None, key: None });
                    let reply = self.insist(replica, *id, operation).await;
                    self.returned(*id, place, reply);
                }
            }
        }))
        .await;
    }

    /// Every state that is stored is that of the same moves, made by the library.
    pub async fn replay_all(&self) {
        let contacts = self.contacts.lock().unwrap().clone();
        for id in contacts {
            let reply = self.insist(0, id, Operation::Read).await;
            if reply != Reply::NotFound {
                replays_to_the_last_bit(&history(&self.service.client(0), id).await);
            }
        }
    }

    /// The histories, with what the forks have shown.
    pub fn histories(&self) -> Vec<(Uuid, History)> {
        let pasts = self.pasts.lock().unwrap();
        let mut histories: Vec<_> = self.histories.lock().unwrap().drain().collect();
        for call in histories.iter_mut().flat_map(|(_, history)| &mut history.calls) {
            if let Some((_, Reply::Forked { id: Some(id), past, .. })) = &mut call.returned {
                *past = Arc::clone(&pasts[id]);
            }
        }
        for (_, history) in &mut histories {
            forget_unused_keys(&mut history.calls);
        }
        histories.sort_by_key(|(id, _)| *id);
        histories
    }

    fn publish(&self, id: Uuid, initial: Contact) {
        self.histories.lock().unwrap().insert(id, History { initial, calls: Vec::new() });
        self.contacts.lock().unwrap().push(id);
    }

    fn called(&self, id: Uuid, request: &Request) -> usize {
        let mut histories = self.histories.lock().unwrap();
        let calls = &mut histories.get_mut(&id).unwrap().calls;
        calls.push(Call { request: request.clone(), called: self.instant(), returned: None });
        calls.len() - 1
    }

    fn returned(&self, id: Uuid, place: usize, reply: Reply) {
        let mut histories = self.histories.lock().unwrap();
        histories.get_mut(&id).unwrap().calls[place].returned = Some((self.instant(), reply));
    }

    fn instant(&self) -> u64 {
        self.clock.fetch_add(1, Ordering::SeqCst)
    }
}

/// A lost request whose key nobody has used again does the same without it, and there are fewer states to distinguish.
fn forget_unused_keys(calls: &mut [Call]) {
    let mut uses: HashMap<String, usize> = HashMap::new();
    for key in calls.iter().filter_map(|call| call.request.key.clone()) {
        *uses.entry(key).or_default() += 1;
    }
    for call in calls.iter_mut().filter(|call| call.returned.is_none()) {
        call.request.key.take_if(|key| uses[key.as_str()] == 1);
    }
}

impl Reply {
    /// The sequence that it shows of the contact that was asked.
    fn sequence(&self) -> Option<u64> {
        match self {
            Reply::Advanced(sequence, _) => Some(*sequence),
            Reply::Contact(summary) => Some(summary.sequence),
            _ => None,
        }
    }
}

fn some_step(random: &mut Random) -> Step {
    let units = random.below(1 << 17) as i64 - (1 << 16);
    Step { relative: random.below(2) == 0, units }
}

/// A request of a client that has last seen this sequence.
fn some_request(random: &mut Random, sequence: u64, key: String) -> Request {
    let operation = match random.below(100) {
        0..45 => Operation::Advance(vec![some_step(random)]),
        45..57 => Operation::Advance((0..2 + random.below(3)).map(|_| some_step(random)).collect()),
        57..70 => Operation::Read,
        70..80 => Operation::History { after: random.below(sequence + 2), limit: 1 + random.below(8) },
        80..95 => Operation::Rename(format!("label {}", random.below(1000))),
        95..99 => Operation::Fork((random.below(2) == 0).then(|| random.below(sequence + 2))),
        _ if random.below(3) == 0 => Operation::Delete,
        _ => Operation::Read,
    };
    let reads = matches!(operation, Operation::Read | Operation::History { .. });
    let (expects, keeps) = (random.below(2) == 0, random.below(2) == 0);
    // Of four conditions one is stale.
    let expected = if random.below(4) == 0 { sequence.saturating_sub(1) } else { sequence };
    Request {
        expected: (expects && !reads && !matches!(operation, Operation::Fork(_))).then_some(expected),
        key: (keeps && !reads && operation != Operation::Delete).then_some(key),
        operation,
    }
}
