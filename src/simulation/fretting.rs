//! Fatigue criteria over the steady cycle of a contact.
//!
//! The instants of the cycle are doubled until the largest value of each criterion no longer changes; only then is every place
//! rated over all of them.

use std::f64::consts::TAU;

use stickslip_mechanics::fatigue::{self, Criterion, Cycle, MAX_INSTANTS, Ruiz, Value};
use stickslip_mechanics::{Contact, Error, Setup, Stress};
use stickslip_wire::fretting::{FrettingTask, Instant};
use stickslip_wire::reply::finite;
use stickslip_wire::{Accuracy, FrettingReply, Largest, Rating, StressPath};

use super::Failure;
use super::bytes::{STATES_HELD, STRESSES_HELD};
use super::run::{Timer, accuracy, contact, cycle_moves};
use super::warnings::{bulk_warning, present_warnings};
use crate::admission::Stop;

/// Instants of each move at first.
const FEWEST: usize = 4;
/// Criteria of stress, two of Ruiz, and the friction work.
const COLUMNS: usize = 8;
/// Radii between two looks whether the work is ended: on a table, a slip takes some 14 microseconds.
const RADII_PER_CHECK: usize = 64;

const REASON: &str = "the cycle follows from the exact slip history, and the stress from that without a mesh";

/// The values of all criteria that are asked for, place by place, in the order of the reply.
type Values = [Option<Vec<Value>>; COLUMNS];

/// The criteria over the steady cycle of a contact.
///
/// # Errors
/// [`Failure::Refused`] for a preload that cannot be reached, a move without an answer, or a path that does not close;
/// [`Failure`] if the work was ended.
pub fn fretting(setup: Setup, task: &FrettingTask, stop: &Stop) -> Result<FrettingReply, Failure> {
    let timer = Timer::start();
    let contact = contact(setup, "/contact")?;
    let moves = cycle_moves(&task.plan, &contact)?;
    let go_on = || stop.check().is_ok();
    let work = Work { cycle: &Cycle::new(&contact, &moves, &go_on).map_err(|error| refused(error, stop))?, task, stop };
    let places: Vec<[f64; 3]> = (0..task.places.count()).map(|index| task.places.at(index)).collect();

    let most = most_instants(work.cycle, stop)?;
    let (mut instants, mut change) = (FEWEST, f64::INFINITY);
    let mut states = work.states(instants)?;
    let mut values = work.values(&states, &places)?;
    let critical = worst(&values);
    let critical_places: Vec<[f64; 3]> = critical.iter().map(|(_, place)| places[*place]).collect();
    let mut before: Vec<f64> = critical.iter().map(|(column, place)| value_of(&values, *column, *place)).collect();
    while change > task.tolerance && 2 * instants <= most {
        instants *= 2;
        states = work.states(instants)?;
        let finer = work.values(&states, &critical_places)?;
        change = 0.0;
        for (index, ((column, _), before)) in critical.iter().zip(&mut before).enumerate() {
            let finer = value_of(&finer, *column, index);
            let (off, size) = ((finer - *before).abs(), finer.abs().max(before.abs()));
            change = f64::max(change, if off > 0.0 { off / size } else { 0.0 });
            *before = finer;
        }
    }
    values = work.values(&states, &places)?;
    let worst = worst(&values);

    let rating = |column: usize, limit: Option<f64>| {
        values[column].as_ref().map(|found| {
            let largest = worst.iter().find(|(of, _)| *of == column).map(|(_, place)| {
                let Value { value, plane, instant } = found[*place];
                Largest { value, point: places[*place], plane, at: instant.map(|index| instant_of(index, instants)) }
            });
            // A criterion that nowhere rises above zero has no distance to its limit.
            let rated = largest.as_ref().map(|largest| largest.value).filter(|value| *value > 0.0);
            let margin = limit.zip(rated).and_then(|(limit, value)| finite(limit / value));
            Rating { values: found.iter().map(|value| finite(value.value)).collect(), largest, margin }
        })
    };
    let limit = |index: usize| task.criteria[index].as_ref().and_then(|(_, limit)| *limit);
    let surface = |asked: &Option<stickslip_wire::SurfaceCriterion>| asked.and_then(|asked| asked.limit);
    let field = states.last().map(|state| state.subsurface(task.body.0, task.body.1));
    let subsurface_error = field.transpose().map_err(|error| refused(error, stop))?.map(|field| field.error());
    Ok(FrettingReply {
        x: places.iter().map(|place| place[0]).collect(),
        y: places.iter().map(|place| place[1]).collect(),
        z: places.iter().map(|place| place[2]).collect(),
        crossland: rating(0, limit(0)),
        dang_van: rating(1, limit(1)),
        findley: rating(2, limit(2)),
        swt: rating(3, limit(3)),
        fatemi_socie: rating(4, limit(4)),
        ruiz: rating(5, surface(&task.ruiz)),
        ruiz_tension: rating(6, None),
        friction_work: rating(7, surface(&task.friction_work)),
        stress_paths: (!task.stress_paths.is_empty()).then(|| work.paths(&states, instants, &places)).transpose()?,
        instants,
        change,
        warnings: present_warnings(&contact).into_iter().chain(bulk_warning(task.bulk.is_some())).collect(),
        accuracy: Accuracy { subsurface_error, ..accuracy(&contact, timer, REASON) },
        contact: contact.summary().into(),
    })
}

/// Instants of each move whose states can be held together.
fn most_instants(cycle: &Cycle, stop: &Stop) -> Result<usize, Failure> {
    let ends = cycle.states(1, &|| stop.check().is_ok()).map_err(|error| refused(error, stop))?;
    let largest = ends.iter().map(Contact::memory_bytes).max().unwrap_or(1);
    let most = (STATES_HELD / largest / ends.len()).min(MAX_INSTANTS);
    if most < 2 * FEWEST {
        return Err(Failure::CycleTooLarge { pointer: "/path".to_owned() });
    }
    Ok(most)
}

/// The column and the place of the largest finite value of each criterion.
fn worst(values: &Values) -> Vec<(usize, usize)> {
    let largest = |found: &Vec<Value>| {
        let finite = found.iter().enumerate().filter(|(_, value)| value.value.is_finite());
        finite.max_by(|one, two| one.1.value.total_cmp(&two.1.value)).map(|(place, _)| place)
    };
    values.iter().enumerate().filter_map(|(column, found)| Some((column, largest(found.as_ref()?)?))).collect()
}

fn value_of(values: &Values, column: usize, place: usize) -> f64 {
    values[column].as_ref().map_or(0.0, |found| found[place].value)
}

fn instant_of(index: usize, instants: usize) -> Instant {
    Instant { step: index / instants, part: (index % instants + 1) as f64 / instants as f64 }
}

fn refused(error: Error, stop: &Stop) -> Failure {
    match stop.check() {
        Err(interrupted) => Failure::interrupted(interrupted, "/path"),
        Ok(()) => Failure::Refused { pointer: "/path".to_owned(), error },
    }
}

/// A cycle, and what is asked of it.
struct Work<'a> {
    cycle: &'a Cycle,
    task: &'a FrettingTask,
    stop: &'a Stop,
}

impl Work<'_> {
    fn go_on(&self) -> bool {
        self.stop.check().is_ok()
    }

    /// The contact at so many instants of each move.
    fn states(&self, instants: usize) -> Result<Vec<Contact>, Failure> {
        self.cycle.states(instants, &|| self.go_on()).map_err(|error| refused(error, self.stop))
    }

    /// All values over some states.
    fn values(&self, states: &[Contact], places: &[[f64; 3]]) -> Result<Values, Failure> {
        let task = self.task;
        let mut values: Values = std::array::from_fn(|column| {
            let asked = match column {
                5 | 6 => task.ruiz.is_some(),
                7 => task.friction_work.is_some(),
                _ => task.criteria[column].is_some(),
            };
            asked.then(|| Vec::with_capacity(places.len()))
        });
        for places in places.chunks((STRESSES_HELD / states.len()).max(1)) {
            let paths = self.stresses(states, places)?;
            for path in &paths {
                self.stop.check()?;
                for (column, criterion) in task.criteria.iter().enumerate() {
                    if let (Some((criterion, _)), Some(found)) = (criterion, &mut values[column]) {
                        found.push(Criterion::of(criterion, path));
                    }
                }
            }
            if task.ruiz.is_some() || task.friction_work.is_some() {
                self.surface(states, places, &paths, &mut values)?;
            }
        }
        Ok(values)
    }

    /// The stresses at each place over the cycle, with the bulk stress.
    fn stresses(&self, states: &[Contact], places: &[[f64; 3]]) -> Result<Vec<Vec<Stress>>, Failure> {
        let paths = fatigue::stresses(states, self.task.body, places, &|| self.go_on());
        let mut paths = paths.map_err(|error| refused(error, self.stop))?;
        if let Some([mean, amplitude, phase]) = self.task.bulk {
            for path in &mut paths {
                let count = path.len() as f64;
                for (index, stress) in path.iter_mut().enumerate() {
                    stress.xx += mean + amplitude * (TAU * (index + 1) as f64 / count + phase).cos();
                }
            }
        }
        Ok(paths)
    }

    /// A field of each state in turn, at all radii (m): faster than one by one.
    fn fields<T>(
        &self,
        states: &[Contact],
        radii: &[f64],
        field: impl Fn(&Contact, &[f64]) -> Vec<T>,
    ) -> Result<Vec<Vec<T>>, Failure> {
        let of_state = |state| {
            let mut all = Vec::with_capacity(radii.len());
            for radii in radii.chunks(RADII_PER_CHECK) {
                self.stop.check()?;
                all.extend(field(state, radii));
            }
            Ok(all)
        };
        states.iter().map(of_state).collect()
    }

    /// What slips at the surface.
    fn surface(
        &self,
        states: &[Contact],
        places: &[[f64; 3]],
        paths: &[Vec<Stress>],
        values: &mut Values,
    ) -> Result<(), Failure> {
        let radii: Vec<f64> = places.iter().map(|place| place[0].hypot(place[1])).collect();
        let slips = self.fields(states, &radii, Contact::slips)?;
        let plain = |value: f64, instant| Value { value, plane: None, instant };
        if let [_, _, _, _, _, Some(damage), Some(tension), _] = values {
            let shears = self.fields(states, &radii, Contact::shears)?;
            for (place, path) in paths.iter().enumerate() {
                let along: Vec<f64> = path.iter().map(|stress| stress.xx).collect();
                let slips: Vec<f64> = slips.iter().filter_map(|state| state[place]).collect();
                let ruiz = Ruiz::of(&shears.iter().map(|state| state[place]).collect::<Vec<_>>(), &slips, &along);
                damage.push(plain(ruiz.fretting_damage, None));
                tension.push(plain(ruiz.crack_initiation, None));
            }
        }
        if let [.., Some(work)] = values {
            let pressures = self.fields(states, &radii, Contact::pressures)?;
            let bound = |index: usize, place: usize| states[index].friction() * pressures[index][place];
            let last = states.len() - 1;
            let work_at = |place: usize| -> f64 {
                // Slip goes one way within a move, so that its steps add up.
                let done = |index: usize| {
                    let from = if index == 0 { last } else { index - 1 };
                    // A ring that has just been touched has slipped nothing since.
                    let both = slips[index][place].zip(slips[from][place]);
                    let slipped = both.map_or(0.0, |(one, other)| (one - other).abs());
                    if slipped > 0.0 { 0.5 * (bound(from, place) + bound(index, place)) * slipped } else { 0.0 }
                };
                (0..states.len()).map(done).sum()
            };
            work.extend((0..places.len()).map(|place| plain(work_at(place), None)));
        }
        Ok(())
    }

    /// The stresses over the cycle at the places that ask for them, as columns.
    fn paths(&self, states: &[Contact], instants: usize, places: &[[f64; 3]]) -> Result<Vec<StressPath>, Failure> {
        let asked: Vec<[f64; 3]> = self.task.stress_paths.iter().map(|place| places[*place]).collect();
        let at = || (0..states.len()).map(|index| instant_of(index, instants));
        let path = |(place, stresses): (&usize, Vec<Stress>)| {
            let column = |of: fn(&Stress) -> f64| stresses.iter().map(|stress| finite(of(stress))).collect();
            StressPath {
                place: *place,
                step: at().map(|instant| instant.step).collect(),
                part: at().map(|instant| instant.part).collect(),
                xx: column(|stress| stress.xx),
                yy: column(|stress| stress.yy),
                zz: column(|stress| stress.zz),
                xy: column(|stress| stress.xy),
                yz: column(|stress| stress.yz),
                xz: column(|stress| stress.xz),
            }
        };
        Ok(self.task.stress_paths.iter().zip(self.stresses(states, &asked)?).map(path).collect())
    }
}
