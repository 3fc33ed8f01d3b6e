//! Whether a recorded history is linearizable (Herlihy & Wing 1990): whether each operation can have happened at one
//! instant between its call and its return, so that one after the other they give the replies that were recorded.
//!
//! The search is that of Wing & Gong (1993): of the operations that no other must precede one is tried after the other.
//! It remembers which operations have led to which state (Lowe 2017), so that no way is gone twice: checkers that do
//! not take too long where many outcomes are unknown. An operation of unknown outcome may have happened at any time
//! after its call, or not at all.

use std::collections::HashSet;
use std::hash::Hash;

/// What an object does if its operations come one after the other.
pub trait Specification: Clone + Eq + Hash {
    type Operation;
    type Reply;

    /// The state after an operation, if that may give this reply. An unknown reply may be any.
    fn after(&self, operation: &Self::Operation, reply: Option<&Self::Reply>) -> Option<Self>;

    /// The state where a history begins that has these calls. What their replies show of later states may be kept in
    /// it, to give up at once what leads elsewhere.
    fn with_replies(self, _calls: &[Call<Self::Operation, Self::Reply>]) -> Self {
        self
    }
}

/// An operation of a history, with the instants of its call and of its return by one clock for all.
#[derive(Clone, Debug)]
pub struct Call<O, R> {
    pub operation: O,
    pub called: u64,
    /// `None` if its outcome is unknown.
    pub returned: Option<(u64, R)>,
}

/// A history of an object, and where it began.
pub struct History<S: Specification> {
    pub initial: S,
    pub calls: Vec<Call<S::Operation, S::Reply>>,
}

struct Search<'a, S: Specification> {
    calls: &'a [Call<S::Operation, S::Reply>],
    done: Vec<bool>,
    order: Vec<usize>,
    tried: HashSet<(Vec<bool>, S)>,
}

impl<S: Specification> History<S>
where
    S::Operation: Clone,
    S::Reply: Clone,
{
    /// An order of the operations that gives their replies, without those that need not have happened; `None` if there
    /// is none.
    pub fn linearization(&self) -> Option<Vec<usize>> {
        let done = vec![false; self.calls.len()];
        let mut search = Search { calls: &self.calls, done, order: Vec::new(), tried: HashSet::new() };
        let initial = self.initial.clone().with_replies(&self.calls);
        search.completes(&initial).then_some(search.order)
    }

    /// The first reply that no order explains; `None` if the history is linearizable. What was known when it came is
    /// enough to see it.
    pub fn first_contradiction(&self) -> Option<usize> {
        let mut returns: Vec<usize> =
            (0..self.calls.len()).filter(|&call| self.calls[call].returned.is_some()).collect();
        returns.sort_by_key(|&call| self.calls[call].end());
        // A beginning of a linearizable history is linearizable.
        let explained = returns.partition_point(|&call| self.until(self.calls[call].end()).linearization().is_some());
        returns.get(explained).copied()
    }

    /// What had been seen of the history at an instant.
    fn until(&self, instant: u64) -> History<S> {
        let seen = self.calls.iter().filter(|call| call.called < instant).cloned();
        let cut = seen.map(|call| Call { returned: call.returned.filter(|(end, _)| *end <= instant), ..call });
        History { initial: self.initial.clone(), calls: cut.collect() }
    }
}

impl<O, R> Call<O, R> {
    /// The instant of its return, or the end of time.
    fn end(&self) -> u64 {
        self.returned.as_ref().map_or(u64::MAX, |(end, _)| *end)
    }
}

impl<S: Specification> Search<'_, S> {
    /// Whether the operations that are left can follow this state.
    fn completes(&mut self, state: &S) -> bool {
        let calls = self.calls;
        let left = (0..calls.len()).filter(|&call| !self.done[call]);
        let first_end = left.clone().map(|call| calls[call].end()).min().unwrap_or(u64::MAX);
        if first_end == u64::MAX {
            return true;
        }
        // Whatever was called after another one had returned comes after it.
        let mut next: Vec<usize> = left.filter(|&call| calls[call].called < first_end).collect();
        next.sort_by_key(|&call| calls[call].end());
        for call in next {
            let Call { operation, returned, .. } = &calls[call];
            let reply = returned.as_ref().map(|(_, reply)| reply);
            let Some(after) = state.after(operation, reply).filter(|after| reply.is_some() || after != state) else {
                continue;
            };
            self.done[call] = true;
            self.order.push(call);
            if self.tried.insert((self.done.clone(), after.clone())) && self.completes(&after) {
                return true;
            }
            self.order.pop();
            self.done[call] = false;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use stateright::semantics::{ConsistencyTester as _, LinearizabilityTester, SequentialSpec};

    use super::{Call, History, Specification};
    use crate::common::kill::Random;

    /// A number that is written, read, and replaced if it is what it should be.
    #[derive(Clone, Debug, PartialEq, Eq, Hash)]
    struct Register(u64);

    #[derive(Clone, Debug)]
    enum Use {
        Write(u64),
        Read,
        Replace { expected: u64, new: u64 },
    }

    impl Specification for Register {
        type Operation = Use;
        /// What was there before.
        type Reply = u64;

        fn after(&self, operation: &Use, reply: Option<&u64>) -> Option<Register> {
            let after = match operation {
                Use::Write(new) => *new,
                Use::Replace { expected, new } if *expected == self.0 => *new,
                Use::Read | Use::Replace { .. } => self.0,
            };
            reply.is_none_or(|reply| *reply == self.0).then_some(Register(after))
        }
    }

    impl SequentialSpec for Register {
        type Op = Use;
        type Ret = u64;

        fn invoke(&mut self, operation: &Use) -> u64 {
            let before = self.0;
            if let Some(after) = self.after(operation, None) {
                *self = after;
            }
            before
        }
    }

    /// What the tester of stateright says of a history. Each operation has a thread of its own, which never returns if
    /// its outcome is unknown.
    fn has_an_order(history: &History<Register>) -> bool {
        let mut tester = LinearizabilityTester::new(history.initial.clone());
        let mut events: Vec<(u64, usize, Option<u64>)> = Vec::new();
        for (index, call) in history.calls.iter().enumerate() {
            events.push((call.called, index, None));
            events.extend(call.returned.map(|(end, reply)| (end, index, Some(reply))));
        }
        events.sort_unstable();
        for (_, thread, reply) in events {
            let told = match reply {
                None => tester.on_invoke(thread, history.calls[thread].operation.clone()),
                Some(reply) => tester.on_return(thread, reply),
            };
            told.unwrap();
        }
        tester.is_consistent()
    }

    /// Up to six operations of three clients with replies that need not make sense.
    fn random_history(random: &mut Random) -> History<Register> {
        let mut calls: Vec<Call<Use, u64>> = Vec::new();
        let mut open: [Option<usize>; 3] = [None; 3];
        for instant in 0..12 {
            let client = random.below(3) as usize;
            match open[client] {
                Some(call) if random.below(6) == 0 => {
                    calls[call].returned = None;
                    open[client] = None;
                }
                Some(call) => {
                    calls[call].returned = Some((instant, random.below(2)));
                    open[client] = None;
                }
                None if calls.len() < 6 => {
                    let operation = match random.below(3) {
                        0 => Use::Write(random.below(2)),
                        1 => Use::Read,
                        _ => Use::Replace { expected: random.below(2), new: random.below(2) },
                    };
                    open[client] = Some(calls.len());
                    calls.push(Call { operation, called: instant, returned: None });
                }
                None => {}
            }
        }
        History { initial: Register(0), calls }
    }

    #[test]
    fn the_verdict_is_that_of_another_checker() {
        let mut random = Random(32);
        let mut verdicts = [0; 2];
        for case in 0..2000 {
            let history = random_history(&mut random);
            let found = history.linearization();
            let exists = has_an_order(&history);
            assert_eq!(found.is_some(), exists, "case {case}: {:?}", history.calls);
            verdicts[usize::from(exists)] += 1;
            let Some(contradiction) = history.first_contradiction() else { continue };
            let end = history.calls[contradiction].end();
            assert!(!exists && !has_an_order(&history.until(end)), "case {case}");
            assert!(has_an_order(&history.until(end - 1)), "case {case}");
        }
        println!("linearizable: {}, not: {}", verdicts[1], verdicts[0]);
        assert!(verdicts.iter().all(|count| *count > 200), "{verdicts:?}");
    }
}
