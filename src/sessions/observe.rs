//! Observations: a contact follows a bench, and the reply has what it predicts beside what was measured.

use std::sync::Arc;

use crate::admission::Stop;
use crate::store::Record;
use stickslip_mechanics::range;
use stickslip_report::plot::in_unit;
use stickslip_wire::{Faults, JsonPath, Observation, ObservationsReply, ObservedMove, Rejection};

use super::cache::Guard;
use super::cycle_log::STATE_COST;
use super::friction::TIME;
use super::loaded::LoadedSession;
use super::{SessionError, Sessions, written};

/// Time to write one observation as JSON, ns.
const WRITING_COST: u64 = 240;

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
    /// The reply to observations that have led to `live` and are not stored yet. The guard has the state before them.
    /// If the estimate of the friction takes too long, it is the one before.
    pub(super) async fn observed(
        &self,
        guard: &mut Guard,
        live: &mut LoadedSession,
        records: &[Record],
        stop: &Stop,
    ) -> Result<Vec<u8>, SessionError> {
        let id = guard.id();
        let (virgin, before) = (live.contact.virgin(), live.session.sequence - records.len() as u64);
        let stop = stop.child_deadline(Some(TIME));
        let (mut log, seen) = self.read_states(id, before, live.cycles.take(), &virgin, &stop).await?;
        // It is not read again if these observations are overtaken.
        if let Some(live) = &mut guard.live {
            live.keep_log(&log);
        }
        if seen.is_ok() {
            let _held = self.common.pool.reserve(log.bytes_with(records.len())).await?;
            let states: Vec<_> = records.iter().map(|record| (record.sequence, record.state)).collect();
            let look = move || {
                let own = Arc::make_mut(&mut log);
                for (sequence, state) in states {
                    own.push(sequence, &state);
                }
                log
            };
            log = self.common.pool.run(STATE_COST * records.len() as u64, look).await?;
            live.estimated = self.estimate(id, &log, &virgin, live.estimated, records, &stop).await?;
        }
        live.keep_log(&log);
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
        self.common.pool.run(WRITING_COST * records.len() as u64, move || written(&reply)).await?
    }
}
