//! Many contacts of one definition, moved together: the contact law of a program that has its own equations of motion.

use std::panic::resume_unwind;
use std::thread;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use serde_json::json;
use stickslip_compute::Refusal;
use stickslip_compute::Stop;
use stickslip_compute::simulation::{self, Anew, present_warnings};
use stickslip_mechanics::range::{self, Range};
use stickslip_mechanics::{Contact, Error, Move, Normal, Tangential};
use stickslip_wire::Code;
use stickslip_wire::definition::SharedSetup;
use stickslip_wire::session::Creation;
use stickslip_wire::{self as wire, CreateRequest, State};

use super::interrupt::interruptible;
use super::problem::refused;

/// A displacement beyond which the part that still sticks is looked at, over that of gross slip.
const PROBE: f64 = 1e-12;
/// Contacts that are worth a thread of their own.
const LEAST_SHARE: usize = 256;
/// Components of a force.
const ALONG: usize = 1;

/// Two arrays in the order of the contacts.
pub type Pair<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);
/// An array of a caller: of one number for each contact, or of one for all.
pub type Numbers<'py> = PyReadonlyArray1<'py, f64>;
/// Normal and tangential numbers of the contacts.
pub type Columns = [Vec<f64>; 2];

/// Contacts that are stepped together.
#[pyclass(module = "stickslip._native")]
pub struct Contacts {
    committed: Vec<Contact>,
    trial: Vec<Contact>,
    threads: usize,
}

#[pymethods]
impl Contacts {
    /// This number of contacts of the JSON text of a definition.
    #[new]
    fn new(py: Python<'_>, count: usize, body: &[u8], threads: usize) -> PyResult<Contacts> {
        let first = interruptible(py, |stop| first(body, stop))?.map_err(refused)?;
        Ok(Contacts { committed: py.detach(|| vec![first; count]), trial: Vec::new(), threads: threads.max(1) })
    }

    fn __len__(&self) -> usize {
        self.committed.len()
    }

    /// Moves every contact straight to its indentation and displacement, m; returns normal and tangential forces, N.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        indentation: Numbers<'_>,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&indentation, &displacement).map_err(refused)?;
        self.trial.clear();
        let threads = self.threads;
        let contacts = &mut self.committed;
        let forces = py.detach(|| move_all(contacts, &targets, threads, LEAST_SHARE, ALONG, move_share));
        Ok(pair(py, forces.map_err(refused)?))
    }

    /// The forces that such a step would lead to, from the committed states; it is kept until `commit` or `revert`.
    fn trial<'py>(
        &mut self,
        py: Python<'py>,
        indentation: Numbers<'_>,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&indentation, &displacement).map_err(refused)?;
        let (committed, mut trial, threads) = (&self.committed, std::mem::take(&mut self.trial), self.threads);
        let (trial, forces) = py.detach(|| {
            trial.clone_from(committed);
            let forces = move_all(&mut trial, &targets, threads, LEAST_SHARE, ALONG, move_share);
            (trial, forces)
        });
        let forces = forces.map_err(refused)?;
        self.trial = trial;
        Ok(pair(py, forces))
    }

    /// Makes the states of the last trial the committed ones; returns whether there was a trial.
    fn commit(&mut self) -> bool {
        let tried = !self.trial.is_empty();
        if tried {
            std::mem::swap(&mut self.committed, &mut self.trial);
            self.trial.clear();
        }
        tried
    }

    /// Discards the last trial.
    fn revert(&mut self) {
        self.trial.clear();
    }

    /// Normal and tangential forces, N, of the committed states.
    fn forces<'py>(&self, py: Python<'py>) -> Pair<'py> {
        pair(
            py,
            self.committed.iter().map(|contact| (contact.normal_force(), contact.force())).collect::<(_, _)>().into(),
        )
    }

    /// Normal stiffness, and tangential stiffness of a displacement that goes on upwards or downwards, N/m, of the last
    /// trial or else of the committed states.
    fn stiffness<'py>(&self, py: Python<'py>, upwards: bool) -> PyResult<Pair<'py>> {
        let contacts = if self.trial.is_empty() { &self.committed } else { &self.trial };
        let direction = if upwards { 1.0 } else { -1.0 };
        let all = py.detach(|| {
            contacts
                .iter()
                .map(|contact| stiffness(contact, direction))
                .collect::<Result<(Vec<f64>, Vec<f64>), Error>>()
        });
        let refusal = |error: Error| refused(Refusal::new(Code::InvalidInput, error.to_string()));
        Ok(pair(py, all.map_err(refusal)?.into()))
    }

    /// The committed state of one contact as JSON text.
    fn state(&self, index: usize) -> PyResult<String> {
        let contact = self.committed.get(index);
        let contact = contact.ok_or_else(|| PyIndexError::new_err(format!("there are {}", self.committed.len())))?;
        Ok(json!(State::from(contact.state())).to_string())
    }

    /// Bytes of memory that the committed states take.
    fn memory(&self) -> usize {
        self.committed.iter().map(Contact::memory_bytes).sum()
    }

    /// The warnings of their definition, as JSON text.
    fn warnings(&self) -> String {
        json!(self.committed.first().map(present_warnings).unwrap_or_default()).to_string()
    }
}

impl Contacts {
    /// The targets of a step, all within their ranges: a step that is refused has moved no contact.
    fn targets(&self, indentation: &Numbers<'_>, displacement: &Numbers<'_>) -> Result<Vec<[f64; 2]>, Refusal> {
        let count = self.committed.len();
        let indentation = numbers("/indentation", indentation, count, &range::INDENTATION)?;
        let displacement = numbers("/displacement", displacement, count, &range::DISPLACEMENT)?;
        // The radius grows with the indentation, so that the deepest contact alone can be beyond the profile.
        let deepest = indentation.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1));
        if let (Some((index, depth)), Some(contact)) =
            (deepest.filter(|(_, depth)| **depth > 0.0), self.committed.first())
        {
            let profile = contact.profile();
            let radius = profile.check_radius(profile.radius(*depth));
            radius.and_then(|radius| range::CONTACT_RADIUS.check(radius)).map_err(|error| {
                Refusal::at(Code::BeyondProfile, format!("/indentation/{index}"), error.to_string())
            })?;
        }
        Ok(indentation.into_iter().zip(displacement).map(|(depth, displacement)| [depth, displacement]).collect())
    }
}

/// The first of the contacts.
fn first(body: &[u8], stop: &dyn Stop) -> Result<Contact, Refusal> {
    Ok(simulation::contact(setup(body, stop)?, "")?)
}

/// What the JSON text of a definition means.
pub fn setup(body: &[u8], stop: &dyn Stop) -> Result<SharedSetup, Refusal> {
    let Creation { setup, .. } = simulation::check(wire::parse::<CreateRequest>(body)?, &Anew(stop), stop)??;
    Ok(setup)
}

/// The numbers of an array, one for each contact.
fn numbers(pointer: &str, given: &Numbers<'_>, count: usize, range: &Range) -> Result<Vec<f64>, Refusal> {
    let rows = rows::<1>(pointer, given, count, range)?;
    Ok(rows.into_iter().map(|[number]| number).collect())
}

/// The numbers of an array, so many for each contact, or the same for all; they are read once, so that a caller who
/// goes on writing to the array changes no number that has been checked.
pub fn rows<const WIDTH: usize>(
    pointer: &str,
    given: &Numbers<'_>,
    count: usize,
    range: &Range,
) -> Result<Vec<[f64; WIDTH]>, Refusal> {
    let given = given.as_array();
    let row = |index: usize| std::array::from_fn(|column| given[WIDTH * index + column]);
    let rows: Vec<[f64; WIDTH]> = match given.len() {
        length if length == WIDTH => vec![row(0); count],
        length if length == WIDTH * count => (0..count).map(row).collect(),
        length => {
            let detail = format!("{length} elements: allowed are {WIDTH} and {}", WIDTH * count);
            return Err(Refusal::at(Code::InvalidInput, pointer, detail));
        }
    };
    for (index, row) in rows.iter().enumerate() {
        if let Some(column) = row.iter().position(|number| !range.contains(*number)) {
            let detail = format!("{:?} is out of range: allowed is {range}", row[column]);
            let at = if WIDTH > 1 { format!("{pointer}/{index}/{column}") } else { format!("{pointer}/{index}") };
            return Err(Refusal::at(Code::InvalidInput, at, detail));
        }
    }
    Ok(rows)
}

/// Moves the contacts to their targets on so many threads, each with `least` contacts or more; forces have so many
/// components.
pub fn move_all<C: Send, T: Sync>(
    contacts: &mut [C],
    targets: &[T],
    threads: usize,
    least: usize,
    components: usize,
    move_share: impl Fn(&mut [C], &[T], &mut [f64], &mut [f64]) -> Result<(), Error> + Copy + Send,
) -> Result<Columns, Refusal> {
    let [mut normal, mut tangential] = [vec![0.0; contacts.len()], vec![0.0; components * contacts.len()]];
    let share = contacts.len().div_ceil(threads).max(least);
    if contacts.len() <= share {
        return move_share(contacts, targets, &mut normal, &mut tangential)
            .map(|()| [normal, tangential])
            .map_err(unexpected);
    }
    let forces = normal.chunks_mut(share).zip(tangential.chunks_mut(components * share));
    let parts = contacts.chunks_mut(share).zip(targets.chunks(share)).zip(forces);
    thread::scope(|scope| {
        let threads: Vec<_> = parts
            .map(|((contacts, targets), (normal, tangential))| {
                scope.spawn(move || move_share(contacts, targets, normal, tangential))
            })
            .collect();
        threads.into_iter().try_for_each(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
    .map_err(unexpected)?;
    Ok([normal, tangential])
}

fn move_share(
    contacts: &mut [Contact],
    targets: &[[f64; 2]],
    normal: &mut [f64],
    tangential: &mut [f64],
) -> Result<(), Error> {
    let forces = normal.iter_mut().zip(tangential);
    for ((contact, [depth, displacement]), (normal, tangential)) in contacts.iter_mut().zip(targets).zip(forces) {
        contact.apply(&Move {
            tangential: Some(Tangential::Displacement(*displacement)),
            normal: Some(Normal::Indentation(*depth)),
            relative: false,
        })?;
        (*normal, *tangential) = (contact.normal_force(), contact.force());
    }
    Ok(())
}

/// What the mechanics refuses although every target is in its range.
fn unexpected(error: Error) -> Refusal {
    Refusal::internal(error.to_string())
}

/// Normal and tangential stiffness, N/m: each spring that does not slip adds its own, so that the tangential one is
/// that of a punch as large as the part that sticks.
fn stiffness(contact: &Contact, direction: f64) -> Result<(f64, f64), Error> {
    let elasticity = contact.elasticity();
    let normal = 2.0 * elasticity.e_star() * contact.contact_radius();
    let probe = direction * PROBE * contact.gross_slip_displacement();
    if probe == 0.0 {
        return Ok((normal, 0.0));
    }
    let mut moved = contact.clone();
    let tangential = Some(Tangential::Displacement(probe));
    moved.apply(&Move { tangential, normal: None, relative: true })?;
    Ok((normal, 2.0 * elasticity.g_star() * moved.state().stick_radius))
}

/// Two columns as arrays, which own the numbers without a copy.
pub fn pair<'py>(py: Python<'py>, [normal, tangential]: Columns) -> Pair<'py> {
    (PyArray1::from_vec(py, normal), PyArray1::from_vec(py, tangential))
}
