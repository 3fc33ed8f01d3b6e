//! The service as its clients reach it: a request of the model over HTTP, to any of the replicas; or by way of one that
//! breaks a promise.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use stickslip_wire::client::{Client, Error, Options};
use stickslip_wire::{ForkRequest, HistoryItem, Move, Path, PathRequest, State, Steps};
use uuid::Uuid;

use super::model::{Made, Operation, Reply, Request, Step, Summary};

/// The unit of displacements, m. It is a power of two, so that their sums are exact.
pub const UNIT: f64 = 1.0 / (1u64 << 40) as f64;

/// What a broken service does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Acknowledges moves before they are made; of four one never is, as if a kill had come in between.
    ReplyBeforeCommit,
    /// Does not compare the sequence with `If-Match`.
    LostCompare,
    /// Does not know an `Idempotency-Key` when it comes again.
    LostKey,
    /// Answers every second read of a contact with what it has shown before.
    StaleRead,
    /// Counts a move that it does not make.
    LostMove,
}

/// Why there is no reply of the model.
#[derive(Debug, PartialEq, Eq)]
pub enum NoReply {
    /// The request cannot have arrived, or was refused and has changed nothing.
    NothingDone,
    /// The request may have been served.
    Unknown,
    /// The same, and the service says that its store does not answer.
    Unavailable,
}

/// The replicas by their present addresses.
pub struct Service {
    pub replicas: Mutex<Vec<Client>>,
    fault: Option<Fault>,
    count: AtomicU64,
    /// Requests to which the service has said that its store does not answer.
    pub unavailable: AtomicU64,
    /// What has been read, by contact and request.
    shown: Mutex<HashMap<(Uuid, Operation), Reply>>,
}

impl Service {
    pub fn new(replicas: Vec<Client>, fault: Option<Fault>) -> Service {
        let [count, unavailable] = [const { AtomicU64::new(0) }; 2];
        Service { replicas: Mutex::new(replicas), fault, count, unavailable, shown: Mutex::default() }
    }

    pub fn client(&self, replica: u64) -> Client {
        let replicas = self.replicas.lock().unwrap();
        replicas[replica as usize % replicas.len()].clone()
    }

    /// Sends a request to a replica. What a fork has made is not looked at: its `past` is empty.
    pub async fn serve(&self, replica: u64, id: Uuid, request: &Request) -> Result<Reply, NoReply> {
        let client = self.client(replica);
        let mut sent = request.clone();
        let turn = if self.fault.is_some() { self.count.fetch_add(1, Ordering::Relaxed) } else { 0 };
        match (self.fault, &request.operation) {
            (Some(Fault::ReplyBeforeCommit), Operation::Advance(steps)) if request.expected.is_none() => {
                return self.acknowledge_early(client, id, request, steps, turn).await;
            }
            (Some(Fault::LostMove), Operation::Advance(steps)) if steps.len() > 1 => {
                sent.operation = Operation::Advance(steps[1..].to_vec());
                let reply = send(&client, id, &sent).await?;
                let Reply::Advanced(sequence, mut displacements) = reply else { return Ok(reply) };
                displacements.insert(0, displacements[0]);
                return Ok(Reply::Advanced(sequence + 1, displacements));
            }
            (Some(Fault::LostCompare), _) => sent.expected = None,
            (Some(Fault::LostKey), _) => sent.key = None,
            (Some(Fault::StaleRead), operation @ (Operation::Read | Operation::History { .. })) => {
                let place = (id, operation.clone());
                let known = self.shown.lock().unwrap().remove(&place);
                if let Some(shown) = known {
                    return Ok(shown);
                }
                let reply = send(&client, id, &sent).await?;
                self.shown.lock().unwrap().insert(place, reply.clone());
                return Ok(reply);
            }
            _ => {}
        }
        let reply = send(&client, id, &sent).await;
        self.unavailable.fetch_add((reply == Err(NoReply::Unavailable)).into(), Ordering::SeqCst);
        reply
    }

    async fn acknowledge_early(
        &self,
        client: Client,
        id: Uuid,
        request: &Request,
        steps: &[Step],
        turn: u64,
    ) -> Result<Reply, NoReply> {
        let read = Request { operation: Operation::Read, expected: None, key: None };
        let Reply::Contact(now) = send(&client, id, &read).await? else { return send(&client, id, request).await };
        let mut displacement = now.displacement;
        let displacements = steps.iter().map(|step| {
            displacement = if step.relative { displacement + step.units } else { step.units };
            displacement
        });
        let reply = Reply::Advanced(now.sequence + steps.len() as u64, displacements.collect());
        if !turn.is_multiple_of(4) {
            let request = request.clone();
            tokio::spawn(async move { send(&client, id, &request).await });
        }
        Ok(reply)
    }
}

/// A request over HTTP.
async fn send(client: &Client, id: Uuid, request: &Request) -> Result<Reply, NoReply> {
    let options = Options { if_match: request.expected, idempotency_key: request.key.clone() };
    let reply = match &request.operation {
        Operation::Advance(steps) if steps.len() == 1 => {
            let reply = client.apply(id, &step(steps[0]).into(), &options).await;
            reply.map(|reply| Reply::Advanced(reply.sequence, vec![units(reply.state.displacement.unwrap())]))
        }
        Operation::Advance(steps) => {
            let moves = steps.iter().copied().map(step).collect();
            let path =
                PathRequest { path: Path::Moves(moves).into(), stress: None, steps: Steps::All, tolerance: None };
            let reply = client.path(id, &path, &options).await;
            let displacements =
                |states: Vec<State>| states.iter().map(|state| units(state.displacement.unwrap())).collect();
            reply.map(|reply| Reply::Advanced(reply.sequence, displacements(reply.steps)))
        }
        Operation::Rename(label) => {
            let reply = client.rename(id, Some(label), &options).await;
            reply.map(|reply| Reply::Contact(summary(reply.sequence, &reply.state, reply.label)))
        }
        Operation::Fork(sequence) => {
            let fork = ForkRequest { label: None, sequence: *sequence };
            client.fork(id, &fork, &options).await.map(|reply| {
                let summary = summary(reply.sequence, &reply.state, reply.label);
                Reply::Forked { id: Some(reply.id), summary, past: [].into() }
            })
        }
        Operation::Delete => client.delete(id, &options).await.map(|()| Reply::Deleted),
        Operation::Read => {
            let reply = client.contact(id).await;
            reply.map(|reply| Reply::Contact(summary(reply.sequence, &reply.state, reply.label)))
        }
        Operation::History { after, limit } => {
            let page = client.history(id, Some(*after), Some(*limit as usize)).await;
            page.map(|page| Reply::Page(page.items.iter().map(made).collect(), page.next.is_some()))
        }
    };
    reply.or_else(|error| match &error {
        Error::Transport(error) if error.is_connect() => Err(NoReply::NothingDone),
        Error::Transport(_) => Err(NoReply::Unknown),
        Error::Problem(problem) => match (problem.code.as_str(), &request.operation) {
            ("stale_sequence", _) => Ok(Reply::Stale),
            ("idempotency_key_reused", _) => Ok(Reply::KeyReused),
            ("contact_not_found", _) => Ok(Reply::NotFound),
            ("invalid_input", Operation::Fork(_)) => Ok(Reply::NoSuchMove),
            ("overloaded" | "conflict" | "quota_exceeded", _) => Err(NoReply::NothingDone),
            ("storage_unavailable", _) => Err(NoReply::Unavailable),
            ("stopping", _) => Err(NoReply::Unknown),
            _ => panic!("{request:?}: {error}"),
        },
        Error::Unexpected { .. } => panic!("{request:?}: {error}"),
    })
}

fn step(Step { relative, units }: Step) -> Move {
    Move { relative, ..Move::displacement(units as f64 * UNIT) }
}

/// A displacement as the model has it.
fn units(displacement: f64) -> i64 {
    let units = displacement / UNIT;
    assert!(units.fract().abs() <= 0.0, "a displacement of {displacement} m is not exact");
    units as i64
}

fn summary(sequence: u64, state: &State, label: Option<String>) -> Summary {
    Summary { sequence, displacement: units(state.displacement.unwrap()), label }
}

fn made(item: &HistoryItem) -> (u64, Made) {
    let Move { displacement, relative, .. } = item.step;
    let step = Step { relative, units: units(displacement.expect("all moves have a displacement")) };
    (item.sequence, Made { step, displacement: units(item.state.displacement.unwrap()) })
}
