//! Observations: a contact follows a bench, and the reply has what it predicts beside what was measured. Its friction
//! is that with which the model is nearest to the newest measured cycle.
//!
//! The estimate follows from what is stored, and is kept with the cached session until the next such cycle closes. A
//! cycle counts if all of its moves are observations under one load. Noise closes cycles too: those with few moves are
//! passed over, and so are those that are small beside others.

use std::sync::Arc;
use std::time::Duration;

use uuid::Uuid;

use crate::admission::{Deadline, Reservation};
use crate::store::{self, StoreError};
use stickslip_compute::simulation::bytes::ROW;
use stickslip_compute::{Nanoseconds, Part, Stop};
use stickslip_measured::loops::{Error, Known, LoopFit, Noise, Note, Parameter, Record, Start, Task, fit};
use stickslip_mechanics::{Contact, in_unit, range};
use stickslip_wire::{
    Faults, FrictionEstimate, FrictionReply, JsonPath, Observation, ObservationsReply, ObservedMove, Rejection, limits,
};

use super::cache::Guard;
use super::cycle_log::{CycleLog, STATE_COST};
use super::cycles::ClosedCycles;
use super::loaded::{Estimated, LoadedSession};
use super::replay::{PAGE, Replay};
use super::{SessionError, written};

/// Moves that a cycle must have.
const MOVES: u64 = 8;
/// Newest cycles of so many moves that are compared; of less than half the largest amplitude are small ones.
const COMPARED: usize = 100;
/// How long an estimate may take.
const TIME: Duration = Duration::from_secs(5);
/// Time of a fit to a cycle, and for each of its points.
const FIT_COST: Nanoseconds = 500_000;
const POINT_COST: Nanoseconds = 10_000;
/// Time to write one observation as JSON.
const WRITING_COST: Nanoseconds = 240;
/// Indentations are the same load if they agree to this part.
const SAME_LOAD: f64 = 1e-12;

/// The measurements of a cycle, as far as they have been read.
#[derive(Default)]
struct MeasuredCycle {
    displacement: Vec<f64>,
    force: Vec<f64>,
    /// Indentation, m, and normal force, N.
    load: Option<(f64, f64)>,
}

impl MeasuredCycle {
    /// Adds a move; returns whether it is an observation under the same load as those before.
    fn push(&mut self, record: &store::Record) -> bool {
        let Some(measured) = record.measured else { return false };
        let (indentation, _) = *self.load.get_or_insert((record.state.indentation, record.state.normal_force));
        self.displacement.push(record.state.displacement);
        self.force.push(measured.force);
        (record.state.indentation - indentation).abs() <= SAME_LOAD * indentation.abs()
    }
}

/// The newest cycle that is not a small one: the move after which it began, and the one that closed it.
fn newest_large(log: &CycleLog) -> Option<(u64, u64)> {
    let long = || log.newest.iter().rev().filter(|cycle| cycle.to - cycle.from >= MOVES).take(COMPARED);
    let largest = long().map(|cycle| cycle.displacement_amplitude).fold(0.0, f64::max);
    long().find(|cycle| cycle.displacement_amplitude >= 0.5 * largest).map(|cycle| (cycle.from, cycle.to))
}

/// Refuses forces that no coefficient of friction explains at this normal force, N: they are in another unit.
pub(super) fn check_plausible(observations: &[Observation], normal_force: f64) -> Result<(), Rejection> {
    let most = range::FRICTION.max;
    let mut faults = Faults::default();
    let at = JsonPath::Root.member("observations");
    for (index, Observation { force, .. }) in observations.iter().enumerate() {
        // Without load any force is noise of the bench.
        if normal_force > 0.0 && force.abs() > most * normal_force {
            let [force, normal_force] = [*force, normal_force].map(|force| in_unit(force, "N"));
            faults.add(
                at.index(index).member("force"),
                format_args!("{force} is more than {most} times the normal force of {normal_force}: is it in N?"),
            );
        }
    }
    faults.done(Some(()))
}

/// The observations of the sessions of a tenant.
pub struct Observations {
    pub(super) cycles: ClosedCycles,
}

impl Observations {
    pub(super) fn of(replay: &Replay) -> Observations {
        Observations { cycles: ClosedCycles { replay: replay.clone() } }
    }

    /// The friction of a session by its observations.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn friction(&self, id: Uuid) -> Result<FrictionReply, SessionError> {
        let (request, _raised_at_the_end) = self.cycles.replay.common.pool.deadline();
        let stop = Arc::new(Part::of(request.clone(), Some(TIME)));
        // The lock is held for copies alone, so that the session can move on meanwhile.
        let (virgin, sequence, known, mut estimated) = {
            let mut guard = self.cycles.replay.lock(id).await?;
            let live = self.cycles.replay.current(&mut guard).await?;
            let known = (live.contact.virgin(), live.session.sequence, live.cycles.clone(), live.estimated);
            request.flag().charge(guard.loading);
            known
        };
        let memory = &mut Reservation::default();
        let (log, seen) = self.cycles.read_states(id, sequence, known, &virgin, &*stop, Some(memory)).await?;
        if seen.is_ok() {
            self.cycles.replay.common.pool.resize(memory, bytes_of_fit(sequence)).await?;
            estimated = self.estimate(id, &log, &virgin, estimated, &[], &stop).await?;
        }
        let mut guard = self.cycles.replay.lock(id).await?;
        if let Some(live) = guard.live.as_mut().filter(|live| live.session.sequence == sequence) {
            live.keep_log(&log);
            live.estimated = estimated;
        }
        Ok(FrictionReply { id, sequence, friction: estimated.and_then(|estimated| estimated.friction) })
    }

    /// What the newest cycle of a log says that is not a small one; `earlier` if it is the same cycle, or if this takes
    /// too long. `new` are the last moves of the log, which the store does not have yet.
    async fn estimate(
        &self,
        id: Uuid,
        log: &CycleLog,
        virgin: &Contact,
        earlier: Option<Estimated>,
        new: &[store::Record],
        stop: &Arc<Part<Deadline>>,
    ) -> Result<Option<Estimated>, SessionError> {
        let Some((from, to)) = newest_large(log) else { return Ok(None) };
        if let Some(earlier) = earlier.filter(|earlier| (earlier.from, earlier.to) == (from, to)) {
            return Ok(Some(earlier));
        }
        let unknown = Some(Estimated { from, to, friction: None });
        let moves = usize::try_from(to - from).unwrap_or(usize::MAX);
        if moves >= *limits::PATH_MOVES.end() {
            return Ok(unknown);
        }
        let mut cycle = MeasuredCycle::default();
        let stored = to.min(log.sequence - new.len() as u64);
        let mut read = from.saturating_sub(1);
        while read < stored {
            let page = match self.cycles.replay.page(id, read, stored).await {
                // A store behind the cached state: the append that follows says so.
                Err(SessionError::Store(StoreError::Damaged { .. })) if !new.is_empty() => return Ok(unknown),
                page => page?,
            };
            if !page.iter().all(|record| cycle.push(record)) {
                return Ok(unknown);
            }
            read += page.len() as u64;
        }
        let mut rest = new.iter().filter(|record| (from..=to).contains(&record.sequence));
        if !rest.all(|record| cycle.push(record)) {
            return Ok(unknown);
        }
        let (virgin, stop) = (virgin.clone(), Arc::clone(stop));
        let fit = move || fitted(virgin, cycle, &*stop);
        let friction = self.cycles.replay.common.pool.run(FIT_COST + POINT_COST * moves as u64, fit).await?;
        Ok(match friction {
            Some(friction) => {
                let friction = friction.map(|(value, interval)| FrictionEstimate { value, interval, from, to });
                Some(Estimated { from, to, friction })
            }
            None => earlier,
        })
    }

    /// The reply to observations that have led to `live` and are not stored yet. The guard has the state before them.
    /// If the estimate of the friction takes too long, or there is no memory for it now, it is the one before: nobody
    /// waits for memory while he has the lock of a contact.
    pub(super) async fn observed(
        &self,
        guard: &mut Guard,
        live: &mut LoadedSession,
        records: &[store::Record],
        stop: &Deadline,
    ) -> Result<Vec<u8>, SessionError> {
        let id = guard.id();
        let (virgin, before) = (live.contact.virgin(), live.session.sequence - records.len() as u64);
        let stop = Arc::new(Part::of(stop.clone(), Some(TIME)));
        let (pool, known) = (&self.cycles.replay.common.pool, live.cycles.take());
        let bytes = CycleLog::bytes_to_read(known.as_deref(), live.session.sequence);
        if let Some(_held) = pool.try_reserve(bytes + bytes_of_fit(live.session.sequence)) {
            let (mut log, seen) = self.cycles.read_states(id, before, known, &virgin, &*stop, None).await?;
            // It is not read again if these observations are overtaken.
            if let Some(live) = &mut guard.live {
                live.keep_log(&log);
            }
            if seen.is_ok() {
                let states: Vec<_> = records.iter().map(|record| (record.sequence, record.state)).collect();
                let look = move || {
                    let own = Arc::make_mut(&mut log);
                    for (sequence, state) in states {
                        own.push(sequence, &state);
                    }
                    log
                };
                log = pool.run(STATE_COST * records.len() as u64, look).await?;
                live.estimated = self.estimate(id, &log, &virgin, live.estimated, records, &stop).await?;
            }
            live.keep_log(&log);
        } else if let Some(known) = &known {
            live.keep_log(known);
        }
        let items = records.iter().filter_map(|record| {
            let observed = record.observation()?;
            Some(ObservedMove {
                displacement: record.state.displacement,
                force: observed.force,
                predicted: observed.predicted,
                innovation: observed.innovation,
            })
        });
        let friction = live.estimated.and_then(|estimated| estimated.friction);
        let reply = ObservationsReply { id, sequence: live.session.sequence, items: items.collect(), friction };
        self.cycles.replay.common.pool.run(WRITING_COST * records.len() as u64, move || written(&reply)).await?
    }
}

/// Bytes that a fit to a cycle of a session takes, with the records that it is read from.
fn bytes_of_fit(sequence: u64) -> usize {
    let moves = usize::try_from(sequence).unwrap_or(usize::MAX);
    moves.min(*limits::PATH_MOVES.end()) * ROW + moves.min(PAGE) * store::RECORD_BYTES
}

/// The coefficient of friction of a cycle with its 95 % interval, if the cycle determines it; nothing at all if the
/// time is up.
fn fitted(virgin: Contact, cycle: MeasuredCycle, stop: &dyn Stop) -> Option<Option<(f64, [f64; 2])>> {
    let MeasuredCycle { displacement, force, load } = cycle;
    let normal_force = load.map(|(_, normal_force)| normal_force);
    let record = Record { displacement, force, time: None, normal_force, start: Some(Start::Steady), weight: 1.0 };
    let stiff = Known { parameter: Parameter::MachineCompliance, value: 0.0, standard_error: 0.0 };
    let task = Task {
        contact: virgin,
        records: vec![record],
        free: vec![Parameter::Friction, Parameter::ForceOffset],
        known: vec![stiff],
        noise: Noise::default(),
    };
    match fit(&task, &|| stop.check().is_ok()) {
        Ok(found) => Some(determined(&found)),
        Err(Error::Interrupted) => None,
        Err(_) => Some(None),
    }
}

/// The friction of a fit with its interval, unless the contact does not slide as a whole or the interval is as wide as
/// that.
fn determined(found: &LoopFit) -> Option<(f64, [f64; 2])> {
    let friction = found.estimates.first()?;
    let [Some(low), Some(high)] = friction.interval else { return None };
    let slides = !found.notes.contains(&Note::PartialSlipOnly);
    (slides && !friction.at_bound && high - low <= friction.value).then_some((friction.value, [low, high]))
}

#[cfg(test)]
mod tests {
    use super::super::cycle_scan::{Answer, ClosedCycle};
    use super::CycleLog;

    #[test]
    fn noise_and_what_was_long_ago_hide_no_cycle() {
        let newest_large = |cycles: &[(u64, u64, f64)]| {
            let cycle = |&(from, to, displacement_amplitude)| ClosedCycle {
                from,
                to,
                displacement_amplitude,
                answer: Answer::Steady { indentation: 1.0 },
            };
            let mut log = CycleLog::default();
            log.newest.extend(cycles.iter().map(cycle));
            super::newest_large(&log)
        };
        assert_eq!(newest_large(&[]), None);
        // Of few moves, or small beside others.
        assert_eq!(newest_large(&[(1, 4, 9.0)]), None);
        assert_eq!(newest_large(&[(1, 30, 1.0), (30, 60, 0.6), (45, 55, 0.2), (60, 63, 2.0)]), Some((30, 60)));
        // After a hundred smaller ones a larger one is forgotten.
        let later = |count: u64| (1..=count).map(|index| (30 * index, 30 * index + 30, 0.4));
        let cycles: Vec<_> = std::iter::once((1, 30, 1.0)).chain(later(99)).collect();
        assert_eq!(newest_large(&cycles), Some((1, 30)));
        let cycles: Vec<_> = std::iter::once((1, 30, 1.0)).chain(later(100)).collect();
        assert_eq!(newest_large(&cycles), Some((3_000, 3_030)));
    }
}
