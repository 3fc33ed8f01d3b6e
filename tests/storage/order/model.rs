//! What a contact does if its requests come one after the other: the order that all clients are promised, as a program.

use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use uuid::Uuid;

use super::linearizability::Call;

/// A move to a displacement, or by one, in units of which every sum is exact ([`super::service::UNIT`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    pub relative: bool,
    pub units: i64,
}

/// A move that has been made, and the displacement after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Made {
    pub step: Step,
    pub displacement: i64,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// One move by `move`, several by `path`.
    Advance(Vec<Step>),
    Rename(String),
    /// After so many moves, or after all of them.
    Fork(Option<u64>),
    Delete,
    Read,
    History {
        after: u64,
        limit: u64,
    },
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Request {
    pub operation: Operation,
    /// `If-Match`.
    pub expected: Option<u64>,
    /// `Idempotency-Key`.
    pub key: Option<String>,
}

/// Number of moves, displacement after the last of them, and label.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Summary {
    pub sequence: u64,
    pub displacement: i64,
    pub label: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Reply {
    /// The sequence after the last move, and the displacement after each.
    Advanced(u64, Vec<i64>),
    /// Of a contact that was read or renamed.
    Contact(Summary),
    /// The new contact, and the moves that it was found to have made.
    Forked {
        id: Option<Uuid>,
        summary: Summary,
        past: Arc<[Made]>,
    },
    Deleted,
    /// Moves with their numbers, and whether there are more.
    Page(Vec<(u64, Made)>, bool),
    /// 412.
    Stale,
    /// 422: a fork after a move that has not been made.
    NoSuchMove,
    /// 422: the key belongs to another request.
    KeyReused,
    /// 404.
    NotFound,
}

/// What the replies of a history have shown. It is the same in all states of the history.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// Moves by their numbers.
    moves: Arc<BTreeMap<u64, Made>>,
    /// How many there were when everything else had been answered.
    last: Option<u64>,
}

impl PartialEq for Shown {
    fn eq(&self, _: &Shown) -> bool {
        true
    }
}

impl Eq for Shown {}

impl Hash for Shown {
    fn hash<H: Hasher>(&self, _: &mut H) {}
}

/// A contact and the replies that retries are owed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Contact {
    pub moves: Vec<Made>,
    pub label: Option<String>,
    deleted: bool,
    first_replies: BTreeMap<String, (Operation, Reply)>,
    shown: Shown,
}

impl Contact {
    /// A contact that begins with these moves.
    pub fn after(moves: &[Made], label: Option<String>) -> Contact {
        Contact { moves: moves.to_vec(), label, ..Contact::default() }
    }

    fn sequence(&self) -> u64 {
        self.moves.len() as u64
    }

    /// As it was after so many moves.
    fn summary(&self, moves: &[Made]) -> Summary {
        let displacement = moves.last().map_or(0, |made| made.displacement);
        Summary { sequence: moves.len() as u64, displacement, label: self.label.clone() }
    }

    /// Does what is asked for, or refuses it and changes nothing.
    fn serve(&mut self, request: &Request) -> Reply {
        let Request { operation, expected, key } = request;
        if let Some((first, reply)) = key.as_ref().and_then(|key| self.first_replies.get(key)) {
            return if first == operation { reply.clone() } else { Reply::KeyReused };
        }
        if self.deleted {
            return Reply::NotFound;
        }
        if expected.is_some_and(|expected| expected != self.sequence()) {
            return Reply::Stale;
        }
        let reply = match operation {
            Operation::Advance(steps) => {
                let displacements = steps.iter().map(|&step| self.advance(step)).collect();
                Reply::Advanced(self.sequence(), displacements)
            }
            Operation::Rename(label) => {
                self.label = Some(label.clone());
                Reply::Contact(self.summary(&self.moves))
            }
            Operation::Fork(at) => {
                let Some(past) = self.moves.get(..at.unwrap_or(self.sequence()) as usize) else {
                    return Reply::NoSuchMove;
                };
                Reply::Forked { id: None, summary: self.summary(past), past: past.into() }
            }
            Operation::Delete => {
                self.deleted = true;
                Reply::Deleted
            }
            Operation::Read => Reply::Contact(self.summary(&self.moves)),
            Operation::History { after, limit } => {
                let numbered = (1..).zip(self.moves.iter().copied());
                let page: Vec<(u64, Made)> = numbered.skip(*after as usize).take(*limit as usize).collect();
                Reply::Page(page, after + limit < self.sequence())
            }
        };
        if let Some(key) = key {
            self.first_replies.insert(key.clone(), (operation.clone(), reply.clone()));
        }
        reply
    }

    fn advance(&mut self, step: Step) -> i64 {
        let now = self.moves.last().map_or(0, |made| made.displacement);
        let displacement = if step.relative { now + step.units } else { step.units };
        self.moves.push(Made { step, displacement });
        displacement
    }

    /// Which contact a fork is follows from no rule, but a retry must get the same one.
    fn learn(&mut self, key: Option<&String>, seen: &Reply) {
        if let (Some(Reply::Forked { id: known @ None, .. }), Reply::Forked { id, .. }) =
            (key.and_then(|key| self.first_replies.get_mut(key)).map(|(_, reply)| reply), seen)
        {
            *known = *id;
        }
    }
}

impl Reply {
    /// Whether what was seen is this reply of the model, which may not know which contact a fork is.
    fn agrees_with(self, seen: &Reply) -> bool {
        match (self, seen) {
            (Reply::Forked { id: None, summary, past }, Reply::Forked { id, .. }) => {
                Reply::Forked { id: *id, summary, past } == *seen
            }
            (reply, seen) => reply == *seen,
        }
    }
}

impl Contact {
    /// The contact after a request, if that may get this reply. An unknown reply may be any.
    pub fn served(&self, request: &Request, seen: Option<&Reply>) -> Option<Contact> {
        let mut after = self.clone();
        let reply = after.serve(request);
        let mut new = (self.sequence() + 1..).zip(&after.moves[self.moves.len()..]);
        if new.any(|(number, made)| after.shown.moves.get(&number).is_some_and(|shown| shown != made)) {
            return None;
        }
        // No move is ever undone, so that none beyond the last one shown comes before a reply.
        if after.shown.last.is_some_and(|last| after.sequence() > last) {
            return None;
        }
        let Some(seen) = seen else { return Some(after) };
        if !reply.agrees_with(seen) {
            return None;
        }
        after.learn(request.key.as_ref(), seen);
        Some(after)
    }

    /// A contact that knows which moves the replies of its history show. A move stays where it is for ever, so that one
    /// that a reply has shown elsewhere is not tried there.
    pub fn with_replies(self, calls: &[Call]) -> Contact {
        let mut shown = BTreeMap::new();
        for Call { request, returned, .. } in calls {
            match (&request.operation, returned.as_ref().map(|(_, reply)| reply)) {
                (Operation::Advance(steps), Some(Reply::Advanced(last, displacements))) => {
                    let first = (last + 1).saturating_sub(steps.len() as u64);
                    let made =
                        steps.iter().zip(displacements).map(|(&step, &displacement)| Made { step, displacement });
                    shown.extend((first..).zip(made));
                }
                (_, Some(Reply::Page(items, _))) => shown.extend(items.iter().copied()),
                _ => {}
            }
        }
        Contact { shown: Shown { moves: Arc::new(shown), last: last_shown(calls) }, ..self }
    }
}

/// How many moves a read has shown that began when all other replies had come.
fn last_shown(calls: &[Call]) -> Option<u64> {
    let answered = calls.iter().filter_map(|call| call.returned.as_ref().map(|(end, reply)| (call, end, reply)));
    let (last, end, reply) = answered.clone().max_by_key(|(call, ..)| call.called)?;
    let is_alone = answered.filter(|(_, other, _)| *other != end).all(|(_, other, _)| *other < last.called);
    match (&last.request.operation, reply) {
        (Operation::Read, Reply::Contact(summary)) if is_alone => Some(summary.sequence),
        _ => None,
    }
}
