//! The steady cycles of a contact that is defined with them: at its preload, or under many loads, a fretting map.

use stickslip_mechanics::Contact;
use stickslip_wire::cycle::{CycleTask, FrettingMap};
use stickslip_wire::definition::SharedSetup;
use stickslip_wire::{Accuracy, CycleReply};

use super::Failure;
use super::cycle::cycle;
use super::run::contact;
use super::stated_accuracy::Timer;
use crate::admission::Stop;

/// The contact of a definition, and its steady cycles, under the loads of a map if one is asked for.
///
/// # Errors
/// As [`cycle()`], and [`Failure::Refused`] for a preload that cannot be reached.
pub fn cycle_of(setup: SharedSetup, task: &CycleTask, stop: &Stop) -> Result<(Contact, CycleReply), Failure> {
    if let Some(map) = task.map {
        return map_of(setup, task, map, stop);
    }
    let timer = Timer::start(stop);
    let contact = contact(setup, "/contact")?;
    let reply = cycle(&contact, task, timer, stop)?;
    Ok((contact, reply))
}

/// The contact of a definition, and its steady cycles under each load, the loads one after the other.
///
/// # Errors
/// As [`cycles_under`], and [`Failure::Refused`] for a preload that cannot be reached.
fn map_of(
    setup: SharedSetup,
    task: &CycleTask,
    map: FrettingMap,
    stop: &Stop,
) -> Result<(Contact, CycleReply), Failure> {
    let timer = Timer::start(stop);
    let contact = contact(setup, "/contact")?;
    let mut loads = map.loads();
    let first = loads.next().unwrap_or(map.normal_force.from);
    let mut reply = cycles_under(&contact, first, task, timer, stop)?;
    for load in loads {
        let CycleReply { cycles, accuracy, warnings, .. } = cycles_under(&contact, load, task, timer, stop)?;
        reply.cycles.extend(cycles);
        // The time is that of all, the warnings are those of the largest load.
        let force_error = accuracy.force_error.max(reply.accuracy.force_error);
        (reply.accuracy, reply.warnings) = (Accuracy { force_error, ..accuracy }, warnings);
    }
    reply.contact = contact.summary().into();
    Ok((contact, reply))
}

/// The steady cycles of a contact under a load, N; the rows say which.
///
/// # Errors
/// As [`cycle()`], and [`Failure::Refused`] for a load that the profile does not reach.
pub fn cycles_under(
    contact: &Contact,
    load: f64,
    task: &CycleTask,
    timer: Timer<'_>,
    stop: &Stop,
) -> Result<CycleReply, Failure> {
    let refused = |error| Failure::Refused { pointer: "/map/normal_force".to_owned(), error };
    let pressed = contact.pressed(load).map_err(refused)?;
    let mut reply = cycle(&pressed, task, timer, stop)?;
    for row in &mut reply.cycles {
        row.normal_force = Some(load);
        row.gross_slip_displacement = Some(reply.contact.gross_slip_displacement);
    }
    Ok(reply)
}
