//! What has become of a contact move by move, computed again from its moves.

use std::ops::Range;

use serde_json::{Value, json};
use stickslip_compute::simulation::Failure;
use stickslip_compute::{Refusal, Stop};
use stickslip_mechanics::closed_cycles::{ClosedCycle, CycleLog, Loop};
use stickslip_mechanics::{self as mechanics};
use stickslip_wire::reply::finite;
use stickslip_wire::{Code, Cycle, LoopPage, Move, State, limits};

use super::contact::Contact;

/// The moves of a range, counted from 0, with the states after them and the cycles that they closed.
pub fn items(contact: &Contact, range: Range<usize>, stop: &dyn Stop) -> Result<Vec<Value>, Refusal> {
    let virgin = contact.state.virgin();
    let (mut log, mut items) = (empty_log(&virgin), Vec::with_capacity(range.len()));
    replay(contact, range.end, stop, |sequence, step, after| {
        let state = after.state();
        let closed = log.push(sequence, &state);
        if sequence as usize > range.start {
            let mut item = json!({"sequence": sequence, "move": step, "state": State::from(state)});
            if let Some(cycle) = closed {
                item["cycle"] = json!(of_cycle(&cycle, &virgin)?);
            }
            items.push(item);
        }
        Ok(())
    })?;
    Ok(items)
}

/// The newest closed cycles, at most so many.
pub fn cycles(contact: &Contact, last: usize, stop: &dyn Stop) -> Result<Vec<Value>, Refusal> {
    let virgin = contact.state.virgin();
    let mut log = empty_log(&virgin);
    replay(contact, contact.made.len(), stop, |sequence, _, after| {
        log.push(sequence, &after.state());
        Ok(())
    })?;
    let newest = log.newest.range(log.newest.len().saturating_sub(last)..);
    newest.map(|cycle| Ok(json!(of_cycle(cycle, &virgin)?))).collect()
}

/// The loop along the moves of a range, counted from 0, with so many points for each, evenly spaced in what the move
/// prescribes.
pub fn points(contact: &Contact, range: Range<usize>, points: usize, stop: &dyn Stop) -> Result<LoopPage, Refusal> {
    let mut page = LoopPage::after(range.start as u64);
    let mut before = contact.state.virgin();
    replay(contact, range.end, stop, |sequence, step, after| {
        if sequence as usize > range.start {
            let mut copy = before.clone();
            for index in 1..points {
                let part = index as f64 / points as f64;
                stop.check().map_err(Failure::from)?;
                // A target on the way may be out of range, such as a force of 1e-300 N; then there is no point.
                if copy.apply(&before.partial_move(&step.step(), part)).is_ok() {
                    page.push(sequence, part, &copy.state().into());
                }
            }
            page.push_end(sequence, &after.state().into(), None);
        }
        before.clone_from(after);
        Ok(())
    })?;
    page.next = (range.end < contact.made.len()).then_some(range.end as u64);
    Ok(page)
}

/// Makes the moves again up to a number, and shows each with its number and the contact after it.
fn replay(
    contact: &Contact,
    end: usize,
    stop: &dyn Stop,
    mut each: impl FnMut(u64, &Move, &mechanics::Contact) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let mut replayed = contact.state.virgin();
    for (index, (step, tolerance)) in contact.made.iter().take(end).enumerate() {
        stop.check().map_err(Failure::from)?;
        let made = replayed.apply_while(&step.step(), *tolerance, &|| stop.check().is_ok());
        made.map_err(|error| Failure::at("/moves", error))?;
        each(index as u64 + 1, step, &replayed)?;
    }
    Ok(())
}

fn empty_log(virgin: &mechanics::Contact) -> CycleLog {
    CycleLog::new(&virgin.state(), *limits::CYCLES.end())
}

fn of_cycle(cycle: &ClosedCycle, virgin: &mechanics::Contact) -> Result<Cycle, Refusal> {
    let refusal = |error: mechanics::Error| Refusal::new(Code::InvalidInput, error.to_string());
    let Loop { force_amplitude, dissipated_energy, sliding_ratio } = cycle.loop_of(virgin).map_err(refusal)?;
    let ClosedCycle { from, to, displacement_amplitude, .. } = *cycle;
    let secant_stiffness = finite(force_amplitude / displacement_amplitude);
    Ok(Cycle { from, to, displacement_amplitude, force_amplitude, dissipated_energy, secant_stiffness, sliding_ratio })
}
