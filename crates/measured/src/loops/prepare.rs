//! From the task to data and layout: what is sought, what is held, and which turning points are refined.

use super::least_squares::{Data, Prior, scales};
use super::model::Layout;
use super::record::{Branches, Clock, Turn, forms, frictional, times};
use super::reversals::reversals;
use super::{Error, FEW_TURNS, FEWEST_POINTS, MOST_REFINED_TURNS, Parameter, Record, Start, Task, parameter};
use crate::robust::median;

/// What an earlier fit has found of the parameters that move displacements in time: a drift hides where the machine
/// turns, and a delay moves the turns of the force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Preliminary {
    /// m/s; that of the turns, if there was no earlier fit.
    pub(super) drift: Option<f64>,
    /// s; that which is known, if there was no earlier fit.
    pub(super) delay: Option<f64>,
}

/// The data of a task; `with_compliance` seeks the compliance of the machine too.
///
/// # Errors
/// [`Error`], which names what the records lack.
pub(super) fn prepare(task: &Task, with_compliance: bool, preliminary: Preliminary) -> Result<Data, Error> {
    let Task { contact, records, free, known, noise } = task;
    let defined = Parameter::ALL.map(|parameter| parameter.of(contact));
    let mut held = defined;
    for known in known {
        held[known.parameter as usize] = known.value;
    }
    let [friction, strength] = [Parameter::Friction, Parameter::ShearStrength].map(|one| held[one as usize]);
    let with_strength = strength > 0.0 || free.contains(&Parameter::ShearStrength);
    if (friction <= 0.0 && !with_strength) || contact.normal_force() <= 0.0 {
        return Err(Error::NoContact { record: None });
    }
    if with_strength && !parameter::is_of(Parameter::ShearStrength, contact.profile()) {
        return Err(Error::NotOfProfile { parameter: Parameter::ShearStrength });
    }
    let base = frictional(contact)?;
    let uncertain = |parameter| known.iter().find(|known| known.parameter == parameter && known.standard_error > 0.0);
    parameter::check(free, |parameter| uncertain(parameter).is_some(), contact.profile())?;
    let timed = |parameter: &Parameter| parameter.needs_time() && *parameter != Parameter::Drift;
    let held_times = known.iter().map(|known| known.parameter).filter(timed);
    let needs_time = free.iter().copied().filter(|parameter| parameter.needs_time()).chain(held_times).next();
    if let Some(parameter) = needs_time
        && let Some(record) = records.iter().position(|record| record.time.is_none())
    {
        return Err(Error::NoTime { parameter, record });
    }
    let timeless = records.iter().all(|record| record.time.is_none());
    // A steady loop is one about its own middle, wherever that is.
    let virgin = records.iter().any(|record| record.start == Some(Start::Virgin));
    let sought = |parameter: Parameter| {
        let wanted = free.contains(&parameter)
            || uncertain(parameter).is_some()
            || (with_compliance && parameter == Parameter::MachineCompliance);
        wanted && (virgin || parameter != Parameter::DisplacementOffset)
    };
    let parameters: Vec<Parameter> = Parameter::ALL.into_iter().filter(|&parameter| sought(parameter)).collect();
    if timeless {
        // The numbers of the points are times then, and a velocity in m/s says nothing.
        held[Parameter::Drift as usize] = 0.0;
    }
    let stiffness_sought = parameters
        .iter()
        .any(|parameter| parameter.power_of_stiffness() != 0 || *parameter == Parameter::MachineCompliance);
    let mut prepared = Vec::with_capacity(records.len());
    for (index, record) in records.iter().enumerate() {
        let drift = match preliminary.drift {
            Some(drift) => drift,
            None if parameters.contains(&Parameter::Drift) => drift_of_turns(record, noise.displacement),
            None => held[Parameter::Drift as usize],
        };
        let clock =
            Clock { drift, delay: preliminary.delay.unwrap_or(held[Parameter::Delay as usize]), counts: timeless };
        let branches = Branches::new(record, index, &base, noise.displacement, (clock, with_strength))?;
        branches.check(index, stiffness_sought && !with_compliance)?;
        prepared.push(branches);
    }
    let parameters = parameters.into_iter().map(Some).collect();
    let mut layout = Layout { parameters, held, defined };
    let mut priors: Vec<Prior> = known
        .iter()
        .filter(|known| known.standard_error > 0.0)
        .filter_map(|known| {
            let column = layout.column(known.parameter)?;
            Some(Prior::new(column, known.value, known.standard_error))
        })
        .collect();
    let turns: usize = prepared.iter().map(|record| record.turns.len()).sum();
    for record in &mut prepared {
        if record.turns.len() > FEW_TURNS && record.repeats() {
            refine_turns(record, &mut layout, &mut priors, true);
        } else if turns <= MOST_REFINED_TURNS {
            refine_turns(record, &mut layout, &mut priors, false);
        }
    }
    let scales = scales(&layout, &prepared);
    Ok(Data { records: prepared, layout, priors, scales })
}

/// Gives each turning point a column, or one to all of either side, from which it does not go far; and one to the way
/// from vertex to corner that all turns of the record have in common, in units of the width of the loop.
fn refine_turns(record: &mut Branches, layout: &mut Layout, priors: &mut Vec<Prior>, shared: bool) {
    let width = record.extremes[0].displacement - record.extremes[1].displacement;
    let [share, share_error] = record.corner_share;
    let first = layout.columns();
    let of_turns = first + usize::from(record.turns.iter().any(|turn| turn.corner != 0.0));
    if of_turns > first {
        priors.push(Prior::new(first, width * share, width * share_error));
    }
    let column = |turn: usize| of_turns + if shared { turn % 2 } else { turn };
    let mut next = of_turns + if shared { 2 } else { record.turns.len() };
    let drift = layout.column(Parameter::Drift);
    let known = |turn: &Turn, column: usize| {
        let (mut terms, mut value) = (vec![(column, 1.0)], turn.displacement);
        if turn.corner != 0.0 {
            terms.push((first, -turn.corner / width));
            value -= share * turn.corner;
        }
        match drift {
            Some(drift) => terms.push((drift, turn.time)),
            None => value -= layout.held[Parameter::Drift as usize] * turn.time,
        }
        Prior { terms, value, standard_error: turn.error, time: turn.time }
    };
    for extreme in &mut record.extremes {
        let own = record.turns.iter().position(|turn| turn == extreme).map(column);
        extreme.column = own.or_else(|| {
            priors.push(known(extreme, next));
            next += 1;
            Some(next - 1)
        });
    }
    for (place, turn) in record.turns.iter_mut().enumerate() {
        priors.push(known(turn, column(place)));
        turn.column = Some(column(place));
    }
    layout.parameters.resize(next, None);
}

/// The drift that turns of the same side show, m/s; zero if there are too few.
fn drift_of_turns(record: &Record, noise: Option<f64>) -> f64 {
    let (times, mut drift) = (times(record), 0.0);
    if times.len() < FEWEST_POINTS {
        return drift;
    }
    for _ in 0..2 {
        let level: Vec<f64> = record.displacement.iter().zip(&times).map(|(u, time)| u - drift * time).collect();
        let found = reversals(&level, noise);
        let forms = forms(&times, &level, &found.at, found.noise);
        let mut slopes: Vec<f64> = forms
            .windows(3)
            .map(|of| (of[2].vertex + of[2].corner - of[0].vertex - of[0].corner) / (2.0 * (of[2].time - of[0].time)))
            .collect();
        drift += median(&mut slopes);
    }
    drift
}
