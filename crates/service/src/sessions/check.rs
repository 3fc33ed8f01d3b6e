//! Verifies a store: every session is replayed from its moves, and compared with the recorded states.
//!
//! Nothing is written, and one page of moves at a time is in memory. Others may work on the store meanwhile: of a
//! session that moves on, the moves that it had when it was looked at are checked.

use std::fmt;

use jiff::{SignedDuration, Timestamp};

use crate::store::{Page, Record, Snapshot};
use stickslip_wire::{Move, PrepareAnew, State};

use super::prelude::*;
use super::snapshot::compare;

/// Sessions and moves that are fetched at a time.
const SESSIONS: usize = 1_000;
const MOVES: usize = 10_000;
/// How far the clock may be set between two moves, or be ahead.
const CLOCK_STEP: SignedDuration = SignedDuration::from_hours(24);
/// Differences of one session that are reported one by one.
const REPORTED: u64 = 5;

/// A fault of the store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The session that it is about, unless it is about the storage.
    pub contact: Option<Uuid>,
    /// The description.
    pub what: String,
}

/// What a check tells while it runs.
#[derive(Clone, Copy, Debug)]
pub enum CheckEvent<'a> {
    /// A fault.
    Found(&'a Finding),
    /// What has been checked so far.
    Progress(&'a Checked),
}

/// Counts of what has been checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// Sessions.
    pub contacts: u64,
    /// Moves.
    pub moves: u64,
    /// Snapshots that were compared.
    pub snapshots: u64,
    /// Snapshots of another engine, which are never read.
    pub foreign_snapshots: u64,
    /// Faults.
    pub findings: u64,
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.contact {
            Some(id) => write!(formatter, "contact {id}: {}", self.what),
            None => formatter.write_str(&self.what),
        }
    }
}

impl fmt::Display for Checked {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Checked { contacts, moves, snapshots, foreign_snapshots, findings } = self;
        let counted = |count: u64, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        let [contacts, moves] = [counted(*contacts, "contact"), counted(*moves, "move")];
        let [snapshots, findings] = [counted(*snapshots, "snapshot"), counted(*findings, "finding")];
        write!(formatter, "checked {contacts}, {moves}, {snapshots}: {findings}")?;
        if *foreign_snapshots > 0 {
            let are = if *foreign_snapshots == 1 { "is" } else { "are" };
            write!(formatter, "; {} {are} of another engine and not used", counted(*foreign_snapshots, "snapshot"))?;
        }
        Ok(())
    }
}

/// Moves of all contacts of a store.
///
/// # Errors
/// As the store's, if its contacts cannot be listed.
pub async fn count_moves(store: &dyn Store) -> Result<u64, StoreError> {
    let (mut moves, mut after) = (0_u64, None);
    loop {
        let page = store.list(None, None, Page::oldest(after, SESSIONS)).await?;
        let Some(last) = page.last() else { return Ok(moves) };
        after = Some(last.id);
        moves = page.iter().fold(moves, |moves, session| moves.saturating_add(session.sequence));
    }
}

/// Checks all of a store, and reports every fault. Recorded states may differ from the replayed ones by
/// `tolerance`, relative to the largest that the session has had; 0 means not in a single bit.
///
/// # Errors
/// [`StoreError::Unavailable`] if the store cannot be asked to the end.
pub async fn check(
    store: &dyn Store,
    tolerance: f64,
    report: &mut (dyn FnMut(CheckEvent<'_>) + Send),
) -> Result<Checked, StoreError> {
    let mut check = Check { store, tolerance, report, checked: Checked::default() };
    match store.check_integrity().await {
        Ok(found) => found.into_iter().for_each(|what| check.found(None, what)),
        Err(error) => check.unreadable(None, "the storage", error)?,
    }
    let mut after = None;
    loop {
        let page = match store.list(None, None, Page::oldest(after, SESSIONS)).await {
            Ok(page) => page,
            Err(error) => {
                check.unreadable(None, "the rest of the contacts", error)?;
                break;
            }
        };
        let Some(last) = page.last() else { break };
        after = Some(last.id);
        for session in page {
            check.session(session.id).await?;
        }
    }
    Ok(check.checked)
}

struct Check<'a> {
    store: &'a dyn Store,
    tolerance: f64,
    report: &'a mut (dyn FnMut(CheckEvent<'_>) + Send),
    checked: Checked,
}

impl Check<'_> {
    fn found(&mut self, contact: Option<Uuid>, what: String) {
        self.checked.findings += 1;
        (self.report)(CheckEvent::Found(&Finding { contact, what }));
    }

    /// Records unreadable data as a finding, unless the whole store is unreachable.
    fn unreadable(&mut self, contact: Option<Uuid>, what: &str, error: StoreError) -> Result<(), StoreError> {
        match error {
            // A client has deleted it since it was listed.
            StoreError::NotFound | StoreError::Expired(_) => Ok(()),
            StoreError::Damaged { what, .. } => {
                self.found(contact, what);
                Ok(())
            }
            StoreError::Failed(why) => {
                self.found(contact, format!("{what} cannot be read: {why}"));
                Ok(())
            }
            other => Err(other),
        }
    }

    async fn session(&mut self, id: Uuid) -> Result<(), StoreError> {
        // The snapshot first: taken later, it might be of a move that the session found has not made yet.
        let snapshot = match self.store.snapshot(id).await {
            Ok(snapshot) => snapshot,
            Err(error) => {
                self.unreadable(Some(id), "its snapshot", error)?;
                None
            }
        };
        let session = match self.store.find(id).await {
            Ok(session) => session,
            Err(error) => return self.unreadable(Some(id), "its definition", error),
        };
        self.checked.contacts += 1;
        let sequence = session.sequence;
        if let Some(ahead) = snapshot.as_ref().map(|snapshot| snapshot.sequence).filter(|taken| *taken > sequence) {
            self.found(Some(id), format!("its snapshot is of move {ahead}, and the last one stored is {sequence}"));
        }
        match LoadedSession::of_stored(session, &PrepareAnew) {
            Ok(live) => self.replay(id, sequence, live.contact, snapshot).await,
            Err(why) => {
                self.found(Some(id), format!("its definition is invalid: {why}"));
                Ok(())
            }
        }
    }

    async fn replay(
        &mut self,
        id: Uuid,
        last: u64,
        mut contact: Contact,
        snapshot: Option<Snapshot>,
    ) -> Result<(), StoreError> {
        let (mut at, mut most, mut scale, mut different) = (0, MOVES, [0.0; QUANTITIES], 0);
        let (mut before, now) = (None, Timestamp::now());
        self.compare_snapshot(id, at, &contact, snapshot.as_ref());
        while at < last {
            let page = match self.store.history(id, at, most).await {
                Ok(page) => page,
                // The moves before the gap are compared first.
                Err(StoreError::Damaged { .. }) if most > 1 => {
                    most /= 2;
                    continue;
                }
                Err(error) => return self.unreadable(Some(id), &format!("its moves after {at}"), error),
            };
            if page.is_empty() {
                // A client may have deleted it meanwhile.
                if self.store.extent(id).await.is_ok() {
                    self.found(Some(id), format!("it is at move {last}, and the moves after {at} are missing"));
                }
                return Ok(());
            }
            for record in page.into_iter().take_while(|record| record.sequence <= last) {
                at = record.sequence;
                self.checked.moves += 1;
                if before.is_some_and(|before| record.at + CLOCK_STEP < before) || record.at > now + CLOCK_STEP {
                    self.found(Some(id), format!("move {at} was made at {}, more than a day off", record.at));
                }
                before = Some(record.at);
                if record.measured.is_some() && record.step.displacement.map(Move::displacement) != Some(record.step) {
                    self.found(Some(id), format!("move {at} has a measured force, and goes to no displacement alone"));
                }
                if let Err(error) = contact.apply_within(&record.step.step(), record.tolerance) {
                    self.found(Some(id), format!("move {at} cannot be made: {error}"));
                    return Ok(());
                }
                if let Some(difference) = difference(&record, &contact.state().into(), &mut scale, self.tolerance) {
                    different += 1;
                    if different <= REPORTED {
                        self.found(Some(id), difference);
                    }
                }
                self.compare_snapshot(id, at, &contact, snapshot.as_ref());
            }
            (self.report)(CheckEvent::Progress(&self.checked));
        }
        if different > REPORTED {
            self.found(Some(id), format!("{} further moves differ", different - REPORTED));
        }
        Ok(())
    }

    fn compare_snapshot(&mut self, id: Uuid, at: u64, state: &Contact, snapshot: Option<&Snapshot>) {
        let Some(snapshot) = snapshot.filter(|snapshot| snapshot.sequence == at) else { return };
        let compared = compare(state, &snapshot.state);
        match compared {
            Ok(false) => self.checked.foreign_snapshots += 1,
            Ok(true) | Err(_) => self.checked.snapshots += 1,
        }
        if let Err(fault) = compared {
            self.found(Some(id), format!("its snapshot of move {at} {fault}"));
        }
    }
}

/// How many numbers a state has.
const QUANTITIES: usize = 10;

fn quantities(state: &State) -> [(&'static str, f64); QUANTITIES] {
    [
        ("displacement", state.displacement.unwrap_or_default()),
        ("force", state.force.unwrap_or_default()),
        ("twist", state.twist.unwrap_or_default()),
        ("torque", state.torque.unwrap_or_default()),
        ("indentation", state.indentation),
        ("normal force", state.normal_force),
        ("contact radius", state.contact_radius),
        ("stick radius", state.stick_radius),
        ("dissipated energy", state.dissipated_energy),
        ("elastic energy", state.elastic_energy),
    ]
}

/// Describes how a recorded state differs from the replayed one.
fn difference(record: &Record, replayed: &State, scale: &mut [f64; QUANTITIES], tolerance: f64) -> Option<String> {
    let mut differing = Vec::new();
    let pairs = quantities(&record.state).into_iter().zip(quantities(replayed));
    for (((name, recorded), (_, replayed)), scale) in pairs.zip(scale) {
        *scale = scale.max(replayed.abs());
        let near = tolerance > 0.0 && (recorded - replayed).abs() <= tolerance * *scale;
        if recorded.to_bits() != replayed.to_bits() && !near {
            differing.push(format!("{name} {recorded:e} instead of {replayed:e}"));
        }
    }
    if record.state.regime != replayed.regime {
        differing.push(format!("regime {:?} instead of {:?}", record.state.regime, replayed.regime));
    }
    if record.state.memory_depth != replayed.memory_depth {
        let (recorded, replayed) = (record.state.memory_depth, replayed.memory_depth);
        differing.push(format!("memory depth {recorded} instead of {replayed}"));
    }
    let what = || format!("move {} is recorded with {}", record.sequence, differing.join(", "));
    (!differing.is_empty()).then(what)
}

#[cfg(test)]
mod tests {
    use super::Checked;

    #[test]
    fn one_of_a_kind_is_counted_in_the_singular() {
        let one = Checked { contacts: 1, moves: 1, snapshots: 1, foreign_snapshots: 1, findings: 1 };
        let said = "checked 1 contact, 1 move, 1 snapshot: 1 finding; 1 snapshot is of another engine and not used";
        assert_eq!(one.to_string(), said);
        let two = Checked { contacts: 2, moves: 3, ..Checked::default() };
        assert_eq!(two.to_string(), "checked 2 contacts, 3 moves, 0 snapshots: 0 findings");
    }
}
