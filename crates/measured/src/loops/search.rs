//! The search for the best values of what is sought; and of what can be sought, where nobody has said.

use super::fit::{self, Fitted};
use super::intervals::Covariance;
use super::least_squares::Data;
use super::omitted::Tests;
use super::parameter::is_of;
use super::prepare::{Preliminary, prepare};
use super::quantised::Waves;
use super::{Error, Noise, Parameter, Start, Task};

/// Fits, at most, each with what the last found of drift and delay.
const MOST_ROUNDS: usize = 5;
/// A delay that moves by less than this share of a sample is known: what is left of it is linear.
const SETTLED: f64 = 0.1;
/// Parameters beyond the usual ones that a fit frees by itself, at most.
const MOST_ADDED: usize = 3;

/// The best values, with the data that they belong to.
pub(super) struct Search {
    pub(super) data: Data,
    pub(super) fitted: Fitted,
    pub(super) preliminary: Preliminary,
}

/// The search for what the task seeks. A task that names nothing seeks what the records can tell, and is returned with
/// that.
pub(super) fn fit(mut task: Task, noise: Noise, proceed: &dyn Fn() -> bool) -> Result<(Task, Search), Error> {
    if !task.free.is_empty() {
        let search = search(&task, noise, proceed)?;
        return Ok((task, search));
    }
    let profile = task.contact.profile().clone();
    let open = |task: &Task, parameter: Parameter| {
        let held = task.known.iter().any(|known| known.parameter == parameter && known.standard_error <= 0.0);
        !held && is_of(parameter, &profile) && !task.free.contains(&parameter)
    };
    let carrying = if task.contact.friction() > 0.0 { Parameter::Friction } else { Parameter::ShearStrength };
    let usual = [carrying, Parameter::GStar, Parameter::ForceOffset];
    task.free = usual.into_iter().filter(|&parameter| open(&task, parameter)).collect();
    let mut best = search(&task, noise, proceed)?;
    let bench = best.data.layout.bench(&best.fitted.values);
    let slides = best.data.records.iter().any(|record| record.slides(bench));
    let timed = task.records.iter().all(|record| record.time.is_some());
    let virgin = task.records.iter().any(|record| record.start == Some(Start::Virgin));
    let compliance = Parameter::MachineCompliance;
    let mut next = (slides && open(&task, compliance)).then_some(compliance);
    for _ in 0..=MOST_ADDED {
        if let Some(parameter) = next {
            task.free.push(parameter);
            match search(&task, noise, proceed) {
                Ok(found) => best = found,
                Err(Error::NoSolution) => {
                    task.free.pop();
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        let covariance = Covariance::new(&best.data, &best.fitted)?;
        let tests = Tests::new(&best.data, &best.fitted, &covariance, &Waves::new(&best.data, &best.fitted, &[]));
        let possible = |parameter: Parameter| match parameter {
            Parameter::DisplacementOffset => virgin,
            Parameter::MachineCompliance => false,
            parameter => timed && parameter.needs_time(),
        };
        let shown = tests.omitted.into_iter().filter(|one| one.is_significant() && possible(one.parameter));
        let size = |z: Option<f64>| z.map_or(0.0, f64::abs);
        let largest = shown.filter(|one| open(&task, one.parameter)).max_by(|a, b| size(a.z).total_cmp(&size(b.z)));
        next = largest.map(|one| one.parameter);
        if next.is_none() {
            break;
        }
    }
    Ok((task, best))
}

/// The best values of what is free. Where the machine turns is seen after the drift is known, and which force belongs
/// to which displacement after the delay is.
fn search(task: &Task, noise: Noise, proceed: &dyn Fn() -> bool) -> Result<Search, Error> {
    let mut preliminary = Preliminary::default();
    for round in 0.. {
        let mut data = prepare(task, false, preliminary)?;
        let fitted = fit::fit(&mut data, noise, proceed)?;
        let value = |parameter| data.layout.column(parameter).map(|column: usize| fitted.values[column]);
        let (drift, delay) = (value(Parameter::Drift), value(Parameter::Delay));
        let record = &data.records[0];
        let moved = delay.is_some_and(|delay| (delay - record.delay).abs() > SETTLED * record.step);
        if (round > 0 && !moved) || (drift.is_none() && delay.is_none()) || round + 1 >= MOST_ROUNDS {
            return Ok(Search { data, fitted, preliminary });
        }
        let quarter = 0.25 * record.duration() / (record.turns.len() + 1) as f64;
        preliminary = Preliminary { drift, delay: delay.map(|delay| delay.clamp(-quarter, quarter)) };
    }
    Err(Error::NoSolution)
}
