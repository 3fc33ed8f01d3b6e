//! From the task to data and layout: what is sought, what is held, and which turning points are refined.

use super::least_squares::{Data, Prior, scales};
use super::model::Layout;
use super::record::Branches;
use super::{Error, MOST_REFINED_TURNS, POINTS_PER_TURN, Parameter, Start, TURN_ERROR, Task, parameter};

/// The data of a task; `with_compliance` seeks the compliance of the machine too.
///
/// # Errors
/// [`Error`], which names what the records lack.
pub(super) fn prepare(task: &Task, with_compliance: bool) -> Result<Data, Error> {
    let Task { contact, records, free, known, noise } = task;
    if contact.friction() <= 0.0 || contact.normal_force() <= 0.0 {
        return Err(Error::NoContact { record: None });
    }
    let uncertain = |parameter| known.iter().find(|known| known.parameter == parameter && known.standard_error > 0.0);
    parameter::check(free, |parameter| uncertain(parameter).is_some(), contact.profile())?;
    if let Some(record) = records.iter().position(|record| free.contains(&Parameter::Drift) && record.time.is_none()) {
        return Err(Error::NoTime { record });
    }
    // A steady loop is one about its own middle, wherever that is.
    let virgin = records.iter().any(|record| record.start == Some(Start::Virgin));
    let sought = |parameter: Parameter| {
        let wanted = free.contains(&parameter)
            || uncertain(parameter).is_some()
            || (with_compliance && parameter == Parameter::MachineCompliance);
        wanted && (virgin || parameter != Parameter::DisplacementOffset)
    };
    let parameters: Vec<Parameter> = Parameter::ALL.into_iter().filter(|&parameter| sought(parameter)).collect();
    let defined = Parameter::ALL.map(|parameter| parameter.of(contact));
    let mut held = defined;
    for known in known {
        held[known.parameter as usize] = known.value;
    }
    let stiffness_sought = parameters
        .iter()
        .any(|parameter| parameter.power_of_stiffness() != 0 || *parameter == Parameter::MachineCompliance);
    let mut prepared = Vec::with_capacity(records.len());
    for (index, record) in records.iter().enumerate() {
        let branches = Branches::new(record, index, contact, noise.displacement)?;
        branches.check(index, stiffness_sought && !with_compliance)?;
        prepared.push(branches);
    }
    let mut layout = Layout { columns: parameters.len(), parameters, held, defined };
    let mut priors: Vec<Prior> = known
        .iter()
        .filter(|known| known.standard_error > 0.0)
        .filter_map(|known| {
            let column = layout.column(known.parameter)?;
            Some(Prior { column, value: known.value, standard_error: known.standard_error })
        })
        .collect();
    let turns: usize = prepared.iter().filter(|record| record.noise > 0.0).map(|record| record.turns.len()).sum();
    let samples: usize = prepared.iter().map(|record| record.samples.len()).sum();
    if turns <= MOST_REFINED_TURNS && samples >= POINTS_PER_TURN * turns {
        for record in prepared.iter_mut().filter(|record| record.noise > 0.0) {
            refine_turns(record, &mut layout.columns, &mut priors);
        }
    }
    let scales = scales(&layout, &prepared);
    Ok(Data { records: prepared, layout, priors, scales })
}

/// Gives each turning point a column, from which it does not go far.
fn refine_turns(record: &mut Branches, columns: &mut usize, priors: &mut Vec<Prior>) {
    let Branches { turns, extremes, noise, .. } = record;
    for turn in turns {
        let place = *turn;
        turn.column = Some(*columns);
        extremes.iter_mut().filter(|extreme| **extreme == place).for_each(|extreme| extreme.column = turn.column);
        priors.push(Prior { column: *columns, value: place.displacement, standard_error: TURN_ERROR * *noise });
        *columns += 1;
    }
}
