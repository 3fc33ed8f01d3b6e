//! Statistics of the stress that remains if a protocol is not followed exactly.

use stickslip_mechanics::protocol::{ExecutionErrors, trials};
use stickslip_mechanics::{Contact, Setup};
use stickslip_wire::protocol::{Robustness, RobustnessReply};
use stickslip_wire::reply::finite;

use super::Failure;
use super::protocol::Subject;
use crate::admission::Stop;

/// Tries a path, m, with errors; `unit` is that of stress, Pa.
///
/// # Errors
/// [`Failure`] if the time limit is reached.
pub(super) fn robustness(
    subject: &Subject<'_>,
    asked: &Robustness,
    path: &[f64],
    unit: f64,
    stop: &Stop,
) -> Result<RobustnessReply, Failure> {
    let Robustness { amplitude_error: amplitude, friction_error: friction, samples, seed } = *asked;
    let make = |factor: f64| match subject.setup {
        Some(setup) if friction > 0.0 => Contact::new(Setup { friction: setup.friction * factor, ..setup.clone() }),
        _ => Ok(subject.contact.clone()),
    };
    let found = trials(&make, path, &ExecutionErrors { amplitude, friction, seed }, samples, &|| stop.check().is_ok());
    let found = found.map_err(|error| match stop.check() {
        Err(interrupted) => Failure::interrupted(interrupted, "/robustness/samples"),
        Ok(()) => Failure::Refused { pointer: "/robustness".to_owned(), error },
    })?;
    let count = found.len() as f64;
    let mean = found.iter().sum::<f64>() / count;
    let variance = found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let rank = (0.95 * count).ceil() as usize;
    Ok(RobustnessReply {
        samples,
        mean: finite(mean / unit),
        standard_error: finite((variance / count).sqrt() / unit),
        percentile_95: found.get(rank.max(1) - 1).and_then(|value| finite(value / unit)),
    })
}
