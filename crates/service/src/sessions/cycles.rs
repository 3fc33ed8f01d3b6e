//! The closed cycles of a session's past, from its recorded states alone.

use crate::store::RECORD_BYTES;
use stickslip_compute::simulation::Failure;
use stickslip_compute::simulation::cost::Work;
use stickslip_compute::{Interrupted, Nanoseconds, Stop};
use stickslip_mechanics::closed_cycles::{ClosedCycle, CycleLog, Loop};
use stickslip_wire::reply::finite;
use stickslip_wire::{Cycle, CyclePage, HistoryPage, State, limits};

use super::history::mark_centres;
use super::prelude::*;
use super::replay::PAGE;

/// Looking at one recorded state.
pub(super) const STATE_COST: Nanoseconds = 50;
/// The cost of a steady cycle, in moves.
const CYCLE_MOVES: usize = 4;
/// JSON pointer to the number of cycles.
const LAST: &str = "/last";
/// JSON pointer to the choice of cycles in a history.
const MARKED: &str = "/cycles";

impl Sessions {
    /// The `last` newest closed cycles of a session, and its sequence. The memory of the request is more for as long as
    /// they are looked for.
    ///
    /// # Errors
    /// [`SessionError::NotFound`] or [`SessionError::Expired`], a failure of the store or of the pool, or
    /// [`SessionError::Failure`] if it takes too long.
    pub async fn cycles(
        &self,
        id: Uuid,
        last: usize,
        memory: &mut Reservation,
    ) -> Result<(u64, CyclePage), SessionError> {
        let (stop, _guard) = self.pool.deadline();
        let copies = |live: &LoadedSession| (live.contact.virgin(), live.session.sequence, live.cycles.clone());
        let (virgin, sequence, known) = self.copies(id, &stop, copies).await?;
        let log = match known {
            Some(known) if known.sequence == sequence => known,
            known => {
                let known = known.filter(|known| known.sequence < sequence);
                let log = self.look_on(id, sequence, known, &virgin, (&stop, LAST), memory).await?;
                self.keep_log(id, &log).await?;
                log
            }
        };
        let work = Work { moves: CYCLE_MOVES * last.min(log.newest.len()), ..Work::default() };
        let cost = work.cost(virgin.profile());
        let answers = move || {
            let newest = log.newest.range(log.newest.len().saturating_sub(last)..);
            newest.map(|cycle| answered(cycle, &virgin, (&stop, LAST))).collect::<Result<_, _>>()
        };
        let items = self.pool.run(cost, answers).await??;
        Ok((sequence, CyclePage { items }))
    }

    /// Adds to the moves of a page the cycles that they closed, and to their states what is not stored. The memory of
    /// the request is more meanwhile.
    ///
    /// # Errors
    /// As [`Sessions::cycles`].
    pub async fn mark_cycles(
        &self,
        id: Uuid,
        page: &mut HistoryPage,
        memory: &mut Reservation,
    ) -> Result<(), SessionError> {
        let Some(after) = page.items.first().map(|item| item.sequence - 1) else { return Ok(()) };
        let (stop, _guard) = self.pool.deadline();
        let (virgin, known) = self.copies(id, &stop, |live| (live.contact.virgin(), live.log_for(after))).await?;
        let log = self.mark(id, page, virgin, known, &stop, memory).await?;
        self.keep_log(id, &log).await
    }

    /// The same where the contact before its first move is known, and perhaps some of the cycles; returns those up to
    /// the end of the page.
    pub(super) async fn mark(
        &self,
        id: Uuid,
        page: &mut HistoryPage,
        virgin: Contact,
        known: Option<Arc<CycleLog>>,
        stop: &Deadline,
        memory: &mut Reservation,
    ) -> Result<Arc<CycleLog>, SessionError> {
        let after = page.items.first().map_or(0, |item| item.sequence - 1);
        let mut log = match known {
            Some(known) if known.sequence >= after => known,
            known => self.look_on(id, after, known, &virgin, (stop, MARKED), memory).await?,
        };
        let (pool, before) = (&self.pool, memory.bytes());
        pool.resize(memory, before + bytes_with(&log, PAGE)).await?;
        mark_centres(page, &virgin);
        let states: Vec<(u64, State)> = page.items.iter().map(|item| (item.sequence, item.state)).collect();
        let cost = Work { moves: CYCLE_MOVES * states.len(), ..Work::default() }.cost(virgin.profile());
        let stop = stop.clone();
        let look = move || {
            let mut answer = |(sequence, state): (u64, State)| {
                let is_known = sequence <= log.sequence;
                let cycle = if is_known {
                    log.closed_by(sequence)
                } else {
                    Arc::make_mut(&mut log).push(sequence, &state.into())
                };
                cycle.map(|cycle| answered(&cycle, &virgin, (&stop, MARKED))).transpose()
            };
            let cycles = states.into_iter().map(&mut answer).collect::<Result<Vec<_>, _>>()?;
            Ok::<_, SessionError>((log, cycles))
        };
        let (log, cycles) = pool.run(cost, look).await??;
        pool.resize(memory, before).await?;
        page.items.iter_mut().zip(cycles).for_each(|(item, cycle)| item.cycle = cycle);
        Ok(log)
    }

    /// Looks at the states up to the move `sequence` that are not in `known`. The log at the deadline is kept
    /// with the session, so that the next request continues from it; `place` is then refused.
    async fn look_on(
        &self,
        id: Uuid,
        sequence: u64,
        known: Option<Arc<CycleLog>>,
        virgin: &Contact,
        (stop, place): (&Deadline, &str),
        memory: &mut Reservation,
    ) -> Result<Arc<CycleLog>, SessionError> {
        let (log, seen) = self.read_states(id, sequence, known, virgin, stop, Some(memory)).await?;
        if let Err(interrupted) = seen {
            self.keep_log(id, &log).await?;
            return Err(Failure::interrupted(interrupted, place).into());
        }
        Ok(log)
    }

    /// Looks at the states up to the move `sequence` that are not in `known`, as far as the time lasts. The memory of
    /// the request is more meanwhile; without any, that has been reserved.
    pub(super) async fn read_states(
        &self,
        id: Uuid,
        sequence: u64,
        known: Option<Arc<CycleLog>>,
        virgin: &Contact,
        stop: &dyn Stop,
        mut memory: Option<&mut Reservation>,
    ) -> Result<(Arc<CycleLog>, Result<(), Interrupted>), SessionError> {
        let known = match known {
            Some(known) if known.sequence == sequence => return Ok((known, Ok(()))),
            known => known,
        };
        let (pool, before) = (&self.pool, memory.as_ref().map_or(0, |memory| memory.bytes()));
        let mut log = known.map_or_else(|| empty_log(virgin), Arc::unwrap_or_clone);
        while log.sequence < sequence {
            if let Err(interrupted) = stop.check() {
                return Ok((Arc::new(log), Err(interrupted)));
            }
            if let Some(memory) = &mut memory {
                pool.resize(memory, before + bytes_with(&log, PAGE)).await?;
            }
            let records = self.page(id, log.sequence, sequence).await?;
            let cost = STATE_COST * records.len() as u64;
            let look = move || {
                for record in records {
                    log.push(record.sequence, &record.state.into());
                }
                log
            };
            log = pool.run(cost, look).await?;
        }
        log.shrink();
        if let Some(memory) = memory {
            pool.resize(memory, before).await?;
        }
        Ok((Arc::new(log), Ok(())))
    }

    /// Keeps a log with the cached session, unless the log is ahead of the session.
    pub(super) async fn keep_log(&self, id: Uuid, log: &Arc<CycleLog>) -> Result<(), SessionError> {
        let mut guard = self.lock(id).await?;
        if let Some(live) = guard.live.as_mut().filter(|live| live.session.sequence >= log.sequence) {
            live.keep_log(log);
        }
        Ok(())
    }
}

/// A row of the reply; `virgin` is the contact before its first move.
fn answered(cycle: &ClosedCycle, virgin: &Contact, (stop, place): (&Deadline, &str)) -> Result<Cycle, SessionError> {
    stop.check().map_err(|interrupted| Failure::interrupted(interrupted, place))?;
    let broken = |error| SessionError::Broken(format!("no load of a cycle: {error}"));
    let Loop { force_amplitude, dissipated_energy, sliding_ratio } = cycle.loop_of(virgin).map_err(broken)?;
    Ok(Cycle {
        from: cycle.from,
        to: cycle.to,
        displacement_amplitude: cycle.displacement_amplitude,
        force_amplitude,
        dissipated_energy,
        secant_stiffness: finite(force_amplitude / cycle.displacement_amplitude),
        sliding_ratio,
    })
}

/// The log of a session before its first move, with as many cycles as a reply can have.
fn empty_log(virgin: &Contact) -> CycleLog {
    CycleLog::new(&virgin.state(), *limits::CYCLES.end())
}

/// Bytes that a log and so many records take while they are looked at.
fn bytes_with(log: &CycleLog, records: usize) -> usize {
    log.memory_bytes_after(records) + records * RECORD_BYTES
}

/// Bytes that it takes to know all cycles of a session up to a move, with the records that are read for it.
pub(super) fn bytes_to_read(known: Option<&CycleLog>, virgin: &Contact, sequence: u64) -> usize {
    let new = usize::try_from(sequence - known.map_or(0, |known| known.sequence).min(sequence)).unwrap_or(usize::MAX);
    let log = known.map_or_else(|| empty_log(virgin).memory_bytes_after(new), |known| known.memory_bytes_after(new));
    log + new.min(PAGE) * RECORD_BYTES
}
