//! What contacts that are stepped together share, along a line and in the plane: arrays, threads and trials.

use std::panic::resume_unwind;
use std::thread;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use serde_json::Value;
use stickslip_compute::documents::Parse as _;
use stickslip_compute::simulation::{self, Anew};
use stickslip_compute::{Flag, Refusal, Stop};
use stickslip_mechanics::Error;
use stickslip_mechanics::range::Range;
use stickslip_wire::definition::SharedSetup;
use stickslip_wire::session::Creation;
use stickslip_wire::{Code, CreateRequest};

use super::interrupt::interruptible;
use super::problem::refused;

/// Two arrays in the order of the contacts.
pub type Pair<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);
/// An array of a caller: of one number for each contact, or of one for all.
pub type Numbers<'py> = PyReadonlyArray1<'py, f64>;
/// Normal and tangential numbers of the contacts.
type Columns = [Vec<f64>; 2];

/// How contacts are shared among threads.
#[derive(Clone, Copy)]
pub struct Shares {
    pub threads: usize,
    /// Contacts that are worth a thread of their own.
    pub least: usize,
    /// Components of a tangential force.
    pub components: usize,
}

/// The committed states of contacts, and those of a trial.
pub struct Stepped<C> {
    pub committed: Vec<C>,
    pub trial: Vec<C>,
    pub shares: Shares,
}

/// Shares worth a thread, for each thread, from which on a step can be interrupted: a shorter one ends before anybody
/// would notice.
const INTERRUPTIBLE: usize = 40;
/// Such shares that are moved between two looks whether to go on.
const AT_ONCE: usize = 4;
/// The most contacts that are stepped together, whatever the memory.
const MOST_CONTACTS: usize = 1_000_000_000;

/// So many contacts, each a copy of the first one of its kind.
///
/// # Errors
/// A refusal at `/shape` of more than the memory can hold.
pub fn copies<C: Clone>(
    firsts: &[C],
    count: usize,
    kind_of: impl Fn(usize) -> usize,
    memory: usize,
) -> Result<Vec<C>, Refusal> {
    let refusal = |bytes: usize| {
        let detail = format!(
            "{count} contacts take at least {:.3e} bytes, and there are {:.3e}: allowed are at most {}",
            bytes as f64,
            memory as f64,
            (memory / size_of::<C>().max(1)).min(MOST_CONTACTS)
        );
        Refusal::at(Code::InvalidInput, "/shape", detail)
    };
    let bytes = size_of::<C>().saturating_mul(count);
    let mut all = Vec::new();
    if bytes > memory || count > MOST_CONTACTS || all.try_reserve_exact(count).is_err() {
        return Err(refusal(bytes));
    }
    all.extend((0..count).map(|index| firsts[kind_of(index)].clone()));
    Ok(all)
}

impl<C: Clone + Send + Sync> Stepped<C> {
    /// Moves every contact to its target; returns normal and tangential forces, N. A step that is refused or
    /// interrupted has moved no contact.
    pub fn step<'py, T: Sync>(
        &mut self,
        py: Python<'py>,
        targets: &[T],
        move_share: impl MoveShare<C, T>,
    ) -> PyResult<Pair<'py>> {
        if self.is_long() {
            let forces = self.trial(py, targets, move_share)?;
            self.commit();
            return Ok(forces);
        }
        self.trial.clear();
        let Stepped { committed, shares, .. } = self;
        let forces = py.detach(|| shares.move_all(committed, targets, move_share, &Flag::default()));
        Ok(pair(py, forces.map_err(refused)?))
    }

    /// Whether a step takes so long that it must be possible to interrupt it.
    fn is_long(&self) -> bool {
        self.committed.len() / self.shares.threads.max(1) >= INTERRUPTIBLE * self.shares.least
    }

    /// The forces that such a step would lead to, from the committed states; it is kept until `commit` or `revert`.
    pub fn trial<'py, T: Sync>(
        &mut self,
        py: Python<'py>,
        targets: &[T],
        move_share: impl MoveShare<C, T>,
    ) -> PyResult<Pair<'py>> {
        // Taken out, so that a trial that fails half-way leaves no state to commit.
        let mut trial = std::mem::take(&mut self.trial);
        let is_long = self.is_long();
        let Stepped { committed, shares, .. } = self;
        let work = |stop: &dyn Stop| {
            trial.clone_from(committed);
            let forces = shares.move_all(&mut trial, targets, move_share, stop);
            (trial, forces)
        };
        let (trial, forces) = if is_long { interruptible(py, work)? } else { py.detach(|| work(&Flag::default())) };
        let forces = forces.map_err(refused)?;
        self.trial = trial;
        Ok(pair(py, forces))
    }

    /// Makes the states of the last trial the committed ones; returns whether there was a trial.
    pub fn commit(&mut self) -> bool {
        let tried = !self.trial.is_empty();
        if tried {
            std::mem::swap(&mut self.committed, &mut self.trial);
            self.trial.clear();
        }
        tried
    }

    /// The committed state of one contact as JSON text.
    pub fn state(&self, index: usize, of: impl Fn(&C) -> Value) -> PyResult<String> {
        let contact = self.committed.get(index).map(of);
        let missing = || PyIndexError::new_err(format!("there are {}", self.committed.len()));
        Ok(contact.ok_or_else(missing)?.to_string())
    }
}

/// What the JSON text of a definition means.
pub fn setup(body: &[u8], stop: &dyn Stop) -> Result<SharedSetup, Refusal> {
    let Creation { setup, .. } = simulation::check(CreateRequest::parse(body)?, &Anew(stop), stop)??;
    let refused = simulation::refused_at("", setup.preload);
    Ok(setup.coulomb("an array of contacts").map_err(refused)?)
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

/// Moves a share of the contacts to their targets, and writes their normal and tangential forces, N.
pub trait MoveShare<C, T>:
    Fn(&mut [C], &[T], &mut [f64], &mut [f64]) -> Result<(), Error> + Copy + Send + Sync
{
}

impl<C, T, F> MoveShare<C, T> for F where
    F: Fn(&mut [C], &[T], &mut [f64], &mut [f64]) -> Result<(), Error> + Copy + Send + Sync
{
}

impl Shares {
    fn move_all<C: Send, T: Sync>(
        self,
        contacts: &mut [C],
        targets: &[T],
        move_share: impl MoveShare<C, T>,
        stop: &dyn Stop,
    ) -> Result<Columns, Refusal> {
        let Shares { threads, least, components } = self;
        let [mut normal, mut tangential] = [vec![0.0; contacts.len()], vec![0.0; components * contacts.len()]];
        let share = contacts.len().div_ceil(threads.max(1)).max(least);
        let at_once = AT_ONCE * least;
        let move_some = |contacts: &mut [C], targets: &[T], normal: &mut [f64], tangential: &mut [f64]| {
            let forces = normal.chunks_mut(at_once).zip(tangential.chunks_mut(components * at_once));
            let parts = contacts.chunks_mut(at_once).zip(targets.chunks(at_once)).zip(forces);
            for ((contacts, targets), (normal, tangential)) in parts {
                if stop.check().is_err() {
                    return Ok(());
                }
                move_share(contacts, targets, normal, tangential)?;
            }
            Ok(())
        };
        if contacts.len() <= share {
            move_some(contacts, targets, &mut normal, &mut tangential).map_err(unexpected)?;
            return Ok([normal, tangential]);
        }
        let forces = normal.chunks_mut(share).zip(tangential.chunks_mut(components * share));
        let parts = contacts.chunks_mut(share).zip(targets.chunks(share)).zip(forces);
        thread::scope(|scope| {
            let threads: Vec<_> = parts
                .map(|((contacts, targets), (normal, tangential))| {
                    scope.spawn(move || move_some(contacts, targets, normal, tangential))
                })
                .collect();
            threads.into_iter().try_for_each(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
        })
        .map_err(unexpected)?;
        Ok([normal, tangential])
    }
}

/// What the mechanics refuses although every target is in its range.
fn unexpected(error: Error) -> Refusal {
    Refusal::internal(error.to_string())
}

/// Two columns as arrays, which own the numbers without a copy.
pub fn pair<'py>(py: Python<'py>, [normal, tangential]: Columns) -> Pair<'py> {
    (PyArray1::from_vec(py, normal), PyArray1::from_vec(py, tangential))
}
