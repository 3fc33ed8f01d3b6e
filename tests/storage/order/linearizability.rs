//! Whether a recorded history is linearizable (Herlihy & Wing 1990): whether each operation can have happened at one
//! instant between its call and its return, so that one after the other they give the replies that were recorded.
//! `todc-utils` searches for such an order (Wing & Gong 1993, Lowe 2017).

use std::collections::HashSet;

use todc_utils::linearizability::WGLChecker;
use todc_utils::linearizability::history::{Action, History as Actions};
use todc_utils::specifications::Specification;

use super::model::{Contact, Operation, Reply, Request};

/// An operation of a history, with the instants of its call and of its return by one clock for all.
#[derive(Clone, Debug)]
pub struct Call {
    pub request: Request,
    pub called: u64,
    /// `None` if its outcome is unknown.
    pub returned: Option<(u64, Reply)>,
}

/// A history of a contact, and where it began.
pub struct History {
    pub initial: Contact,
    pub calls: Vec<Call>,
}

/// What the checker takes for an operation.
#[derive(Clone, Debug)]
pub enum Step {
    /// The beginning, which all others follow, and how many of them were answered.
    Begin(Contact, usize),
    Served(Request, Option<Reply>),
}

impl Specification for Contact {
    /// The contact, and how many replies are still to be explained.
    type State = (Contact, usize);
    type Operation = Step;

    fn init() -> Self::State {
        Self::State::default()
    }

    fn apply(step: &Step, (state, left): &Self::State) -> (bool, Self::State) {
        let after = match step {
            Step::Begin(initial, known) => Some((initial.clone(), *known)),
            // What has no reply may never have happened, which is only tried when all replies are explained.
            Step::Served(..) if *left == 0 => Some((state.clone(), 0)),
            Step::Served(request, reply) => state
                .served(request, reply.as_ref())
                .filter(|after| reply.is_some() || after != state)
                .map(|after| (after, left - usize::from(reply.is_some()))),
        };
        (after.is_some(), after.unwrap_or_default())
    }
}

impl Call {
    /// The instant of its return, or the end of time.
    fn end(&self) -> u64 {
        self.returned.as_ref().map_or(u64::MAX, |(end, _)| *end)
    }
}

impl History {
    /// Whether some order of the operations gives their replies. One of unknown outcome may have happened at any time
    /// after its call, or not at all: that is after all others, where it changes nothing that anybody has seen.
    fn is_linearizable(&self) -> bool {
        let labels: HashSet<&str> = self.calls.iter().filter_map(|call| call.returned.as_ref()?.1.label()).collect();
        // A label that nobody has seen explains no reply, unless its request comes again with its key.
        let is_unseen = |request: &Request| match &request.operation {
            Operation::Rename(label) => request.key.is_none() && !labels.contains(label.as_str()),
            _ => false,
        };
        let may_change = |request: &Request| request.changes() && !is_unseen(request);
        let changes = |call: &&Call| call.returned.is_some() || may_change(&call.request);
        let initial = self.initial.clone().with_replies(&self.calls);
        let known = self.calls.iter().filter(|call| call.returned.is_some()).count();
        let begin = Step::Begin(initial, known);
        let mut events = vec![(0, 0, Action::Call(begin.clone())), (0, 0, Action::Response(begin))];
        for (number, call) in (1..).zip(self.calls.iter().filter(changes)) {
            let step = Step::Served(call.request.clone(), call.returned.as_ref().map(|(_, reply)| reply.clone()));
            events.push((call.called + 1, number, Action::Call(step.clone())));
            events.push((call.end().saturating_add(1), number, Action::Response(step)));
        }
        events.sort_by_key(|(instant, ..)| *instant);
        let actions = events.into_iter().map(|(_, number, action)| (number, action)).collect();
        WGLChecker::<Contact>::is_linearizable(Actions::from_actions(actions))
    }

    /// The first reply that no order explains; `None` if the history is linearizable. What was known when it came is
    /// enough to see it.
    pub fn first_contradiction(&self) -> Option<usize> {
        if self.is_linearizable() {
            return None;
        }
        let mut returns: Vec<usize> =
            (0..self.calls.len()).filter(|&call| self.calls[call].returned.is_some()).collect();
        returns.sort_by_key(|&call| self.calls[call].end());
        // A beginning of a linearizable history is linearizable.
        let explained = returns.partition_point(|&call| self.until(self.calls[call].end()).is_linearizable());
        returns.get(explained).copied()
    }

    /// What had been seen of the history at an instant.
    fn until(&self, instant: u64) -> History {
        let seen = self.calls.iter().filter(|call| call.called < instant).cloned();
        let cut = seen.map(|call| Call { returned: call.returned.filter(|(end, _)| *end <= instant), ..call });
        History { initial: self.initial.clone(), calls: cut.collect() }
    }
}

impl Reply {
    /// The label that it shows.
    fn label(&self) -> Option<&str> {
        match self {
            Reply::Contact(summary) | Reply::Forked { summary, .. } => summary.label.as_deref(),
            _ => None,
        }
    }
}

impl Request {
    /// Whether it may change something.
    pub fn changes(&self) -> bool {
        !matches!(self.operation, Operation::Read | Operation::History { .. })
    }
}
