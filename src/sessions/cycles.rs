//! The closed cycles of a session's past, from its recorded states alone.

use std::collections::VecDeque;
use std::sync::Arc;

use uuid::Uuid;

use crate::admission::{Nanoseconds, Stop};
use crate::simulation::Failure;
use crate::simulation::cost::Work;
use crate::store::Record;
use stickslip_mechanics::cycle::SteadyCycle;
use stickslip_mechanics::{Contact, Move, Normal};
use stickslip_wire::reply::finite;
use stickslip_wire::{Cycle, CyclePage, State, limits};

use super::cycle_scan::{Answer, ClosedCycle, CycleScan};
use super::replay::PAGE;
use super::{SessionError, Sessions};

/// Looking at one recorded state.
const STATE_COST: Nanoseconds = 50;
/// Moves whose cost that of a steady cycle is like.
const CYCLE_MOVES: usize = 4;
/// JSON pointer to the number of cycles.
const LAST: &str = "/last";

/// What has been found in the states of a session so far. It stays with the cached session, so that later requests read
/// the new states alone.
#[derive(Clone, Default)]
pub(super) struct CycleLog {
    scan: CycleScan,
    /// The last state that has been looked at.
    sequence: u64,
    /// As many as a reply can have.
    newest: VecDeque<ClosedCycle>,
}

impl CycleLog {
    fn new(virgin: &State) -> CycleLog {
        let mut log = CycleLog::default();
        log.push(0, virgin);
        log
    }

    fn push(&mut self, sequence: u64, state: &State) {
        self.sequence = sequence;
        let newest = &mut self.newest;
        self.scan.push(sequence, state, |cycle| {
            if newest.len() == *limits::CYCLES.end() {
                newest.pop_front();
            }
            newest.push_back(cycle);
        });
    }

    /// Bytes of memory.
    pub(super) fn bytes(&self) -> usize {
        size_of::<CycleLog>() + self.scan.heap_bytes() + self.newest.capacity() * size_of::<ClosedCycle>()
    }

    /// Bytes that it and a page of records take while they are looked at.
    fn bytes_of_page(&self) -> usize {
        let newest = 2 * limits::CYCLES.end() * size_of::<ClosedCycle>();
        self.scan.heap_bytes_after(PAGE) + newest + PAGE * size_of::<Record>()
    }
}

impl Sessions {
    /// The `last` newest closed cycles of a session, and its sequence.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], a failure of the store or of the pool, or
    /// [`SessionError::Failure`] if it takes too long.
    pub async fn cycles(&self, id: Uuid, last: usize) -> Result<(u64, CyclePage), SessionError> {
        let (stop, _guard) = self.common.pool.deadline();
        // The lock is held for copies alone, so that the session can move on meanwhile.
        let (virgin, sequence, known) = {
            let mut guard = self.lock(id).await?;
            let live = self.current(&mut guard).await?;
            (live.contact.virgin(), live.session.sequence, live.cycles.clone())
        };
        let log = match known {
            Some(known) if known.sequence == sequence => known,
            known => self.look_on(id, sequence, known, &virgin, &stop).await?,
        };
        let work = Work { moves: CYCLE_MOVES * last.min(log.newest.len()), ..Work::default() };
        let cost = work.cost(virgin.profile());
        let answers = move || {
            let newest = log.newest.range(log.newest.len().saturating_sub(last)..);
            newest.map(|cycle| answered(cycle, &virgin, &stop)).collect::<Result<_, _>>()
        };
        let items = self.common.pool.run(cost, answers).await??;
        Ok((sequence, CyclePage { items }))
    }

    /// Looks at the states up to the move `sequence` that are not in `known`, and leaves the result with the session.
    async fn look_on(
        &self,
        id: Uuid,
        sequence: u64,
        known: Option<Arc<CycleLog>>,
        virgin: &Contact,
        stop: &Stop,
    ) -> Result<Arc<CycleLog>, SessionError> {
        let known = known.filter(|known| known.sequence < sequence);
        let bytes = known.as_ref().map_or_else(|| CycleLog::default().bytes_of_page(), |known| known.bytes_of_page());
        let mut held = self.common.pool.reserve(bytes).await?;
        let mut log = known.map_or_else(|| CycleLog::new(&virgin.state().into()), Arc::unwrap_or_clone);
        while log.sequence < sequence {
            self.common.pool.resize(&mut held, log.bytes_of_page()).await?;
            let most = usize::try_from(sequence - log.sequence).unwrap_or(PAGE).min(PAGE);
            let next = log.sequence + 1;
            let records = self.common.store.history(id, log.sequence, most).await;
            let records = records.map_err(|error| self.store_error(id, error))?;
            if records.first().is_none_or(|record| record.sequence != next) {
                return Err(SessionError::Broken(format!("move {next} of contact {id} is missing")));
            }
            let stop = stop.clone();
            let look = move || {
                stop.check().map_err(|interrupted| Failure::interrupted(interrupted, LAST))?;
                records.iter().for_each(|record| log.push(record.sequence, &record.state));
                Ok::<_, SessionError>(log)
            };
            log = self.common.pool.run(STATE_COST * most as u64, look).await??;
        }
        log.scan.shrink();
        let log = Arc::new(log);
        let mut guard = self.lock(id).await?;
        if let Some(live) = guard.live.as_mut().filter(|live| live.session.sequence >= sequence)
            && live.cycles.as_ref().is_none_or(|kept| kept.sequence < sequence)
        {
            live.cycles = Some(Arc::clone(&log));
        }
        Ok(log)
    }
}

/// A row of the reply; `virgin` is the contact before its first move.
fn answered(cycle: &ClosedCycle, virgin: &Contact, stop: &Stop) -> Result<Cycle, SessionError> {
    stop.check().map_err(|interrupted| Failure::interrupted(interrupted, LAST))?;
    let amplitude = cycle.displacement_amplitude;
    let (force_amplitude, dissipated_energy, sliding_ratio) = match cycle.answer {
        Answer::Recorded { force_amplitude, dissipated_energy } => (force_amplitude, dissipated_energy, None),
        Answer::Steady { indentation } => {
            let mut contact = virgin.clone();
            let load = Move { normal: Some(Normal::Indentation(indentation)), ..Move::default() };
            if (indentation - virgin.indentation()).abs() > 0.0 {
                contact.apply(&load).map_err(|error| SessionError::Broken(format!("no load of a cycle: {error}")))?;
            }
            let steady = SteadyCycle::of(&contact, amplitude);
            (steady.force_amplitude(), steady.dissipated_energy(), steady.sliding_ratio())
        }
    };
    Ok(Cycle {
        from: cycle.from,
        to: cycle.to,
        displacement_amplitude: amplitude,
        force_amplitude,
        dissipated_energy,
        secant_stiffness: finite(force_amplitude / amplitude),
        sliding_ratio,
    })
}
