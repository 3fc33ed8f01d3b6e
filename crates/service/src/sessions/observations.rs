//! Observations: a contact follows a bench, and the reply has what it predicts beside what was measured. Its friction
//! is that with which the model is nearest to the newest measured cycle.
//!
//! The estimate follows from what is stored, and is kept with the cached session until the next such cycle closes.

use crate::store;
use stickslip_compute::simulation::bytes::ROW;
use stickslip_compute::{Nanoseconds, Part, Stop};
use stickslip_measured::cycle_friction::{MeasuredCycle, newest_large};
use stickslip_mechanics::closed_cycles::{ClosedCycle, CycleLog};
use stickslip_mechanics::{in_unit, range};
use stickslip_wire::{
    Faults, FrictionEstimate, FrictionReply, JsonPath, NoFriction, Observation, ObservationsReply, ObservedMove,
    Rejection, limits,
};

use super::cycles::{STATE_COST, bytes_to_read};
use super::loaded::Estimated;
use super::prelude::*;
use super::replay::PAGE;

/// How long an estimate may take.
const TIME: Duration = Duration::from_secs(5);
/// Time of a fit to a cycle, and for each of its points.
const FIT_COST: Nanoseconds = 500_000;
const POINT_COST: Nanoseconds = 10_000;
/// Time to write one observation as JSON.
const WRITING_COST: Nanoseconds = 240;

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

impl Sessions {
    /// The friction of a session by its observations.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], or a failure of the store or of the pool.
    pub async fn friction(&self, id: Uuid) -> Result<FrictionReply, SessionError> {
        let (request, _raised_at_the_end) = self.pool.deadline();
        let stop = Arc::new(Part::of(request.clone(), Some(TIME)));
        let copies =
            |live: &LoadedSession| (live.contact.virgin(), live.session.sequence, live.cycles.clone(), live.estimated);
        let (virgin, sequence, known, mut estimated) = self.copies(id, &request, copies).await?;
        let memory = &mut Reservation::default();
        let (log, seen) = self.read_states(id, sequence, known, &virgin, &*stop, Some(memory)).await?;
        if seen.is_ok() {
            self.pool.resize(memory, bytes_of_fit(sequence)).await?;
            estimated = self.estimate(id, &log, &virgin, estimated, &[], &stop).await?;
        }
        let mut guard = self.lock(id).await?;
        if let Some(live) = guard.live.as_mut().filter(|live| live.session.sequence == sequence) {
            live.keep_log(&log);
            live.estimated = estimated;
        }
        let known = if seen.is_ok() { NoFriction::NoCycle } else { NoFriction::NotEstimated };
        let friction = estimated.map_or(Err(known), |estimated| estimated.friction);
        Ok(FrictionReply { id, sequence, friction: friction.ok(), reason: friction.err() })
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
        let Some(&ClosedCycle { from, to, .. }) = newest_large(&log.newest) else { return Ok(None) };
        let is_known = |known: &Estimated| {
            (known.from, known.to) == (from, to) && !matches!(known.friction, Err(NoFriction::NotEstimated))
        };
        if let Some(earlier) = earlier.filter(is_known) {
            return Ok(Some(earlier));
        }
        let unknown = |why| Ok(Some(Estimated { from, to, friction: Err(why) }));
        let moves = usize::try_from(to - from).unwrap_or(usize::MAX);
        if moves >= *limits::PATH_MOVES.end() {
            return unknown(NoFriction::TooManyMoves);
        }
        let mut cycle = MeasuredCycle::default();
        let stored = to.min(log.sequence - new.len() as u64);
        let mut read = from.saturating_sub(1);
        while read < stored {
            let page = match self.page(id, read, stored).await {
                // A store behind the cached state: the append that follows says so.
                Err(SessionError::Store(StoreError::Damaged { .. })) if !new.is_empty() => {
                    return unknown(NoFriction::NotEstimated);
                }
                page => page?,
            };
            if !page.iter().all(|record| add(&mut cycle, record)) {
                return unknown(NoFriction::NotMeasured);
            }
            read += page.len() as u64;
        }
        let mut rest = new.iter().filter(|record| (from..=to).contains(&record.sequence));
        if !rest.all(|record| add(&mut cycle, record)) {
            return unknown(NoFriction::NotMeasured);
        }
        let (virgin, stop) = (virgin.clone(), Arc::clone(stop));
        let fit = move || cycle.friction(virgin, &|| stop.check().is_ok());
        let friction = self.pool.run(FIT_COST + POINT_COST * moves as u64, fit).await?;
        Ok(match friction {
            Ok(friction) => {
                let friction = friction.map(|(value, interval)| FrictionEstimate { value, interval, from, to });
                Some(Estimated { from, to, friction: friction.ok_or(NoFriction::NotDetermined) })
            }
            // The time is up.
            Err(_) => earlier.or(Some(Estimated { from, to, friction: Err(NoFriction::NotEstimated) })),
        })
    }

    /// The reply to observations that have led to `live` and are not stored yet. The guard has the state before them.
    /// If the estimate of the friction takes too long, or there is no memory for it now, it is the one before: a
    /// request that has the lock of a contact never waits for memory.
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
        let (pool, known) = (&self.pool, live.cycles.take());
        let bytes = bytes_to_read(known.as_deref(), &virgin, live.session.sequence);
        if let Some(_held) = pool.try_reserve(bytes + bytes_of_fit(live.session.sequence)) {
            let (mut log, seen) = self.read_states(id, before, known, &virgin, &*stop, None).await?;
            // It is not read again if these observations are overtaken.
            if let Some(live) = &mut guard.live {
                live.keep_log(&log);
            }
            if seen.is_ok() {
                let states: Vec<_> = records.iter().map(|record| (record.sequence, record.state)).collect();
                let look = move || {
                    let own = Arc::make_mut(&mut log);
                    for (sequence, state) in states {
                        own.push(sequence, &state.into());
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
                displacement: record.state.displacement.unwrap_or_default(),
                force: observed.force,
                predicted: observed.predicted,
                innovation: observed.innovation,
            })
        });
        let friction = live.estimated.and_then(|estimated| estimated.friction.ok());
        let reply = ObservationsReply { id, sequence: live.session.sequence, items: items.collect(), friction };
        self.pool.run(WRITING_COST * records.len() as u64, move || written(&reply)).await?
    }
}

/// Bytes that a fit to a cycle of a session takes, with the records that it is read from.
fn bytes_of_fit(sequence: u64) -> usize {
    let moves = usize::try_from(sequence).unwrap_or(usize::MAX);
    moves.min(*limits::PATH_MOVES.end()) * ROW + moves.min(PAGE) * store::RECORD_BYTES
}

/// Adds a move to a cycle; returns whether it is an observation under the same load as those before.
fn add(cycle: &mut MeasuredCycle, record: &store::Record) -> bool {
    let (state, Some(measured)) = (&record.state, record.measured) else { return false };
    let Some(displacement) = state.displacement else { return false };
    cycle.push(displacement, measured.force, (state.indentation, state.normal_force))
}
