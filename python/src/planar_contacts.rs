//! Many contacts of one definition that are moved in the plane, step by step: the law of rings for a program that has
//! its own equations of motion.

use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use serde_json::json;
use stickslip_compute::simulation::{self, Failure, present_warnings};
use stickslip_compute::{Refusal, Stop};
use stickslip_mechanics::rings::{PlanarBuffers, PlanarContact, PlanarLaw};
use stickslip_mechanics::{Error, Normal, range};
use stickslip_wire::Code;
use stickslip_wire::plane::PlanarState;

use super::contacts::{Numbers, Pair, move_all, pair, rows, setup};
use super::interrupt::interruptible;
use super::problem::refused;

/// Contacts that are worth a thread of their own.
const LEAST_SHARE: usize = 8;
/// Components of a force.
const IN_PLANE: usize = 2;

/// The load and the displacement, m, of a step.
type Target = (Normal, [f64; IN_PLANE]);

/// Contacts that are stepped together.
#[pyclass(module = "stickslip._native")]
pub struct PlanarContacts {
    law: PlanarLaw,
    committed: Vec<PlanarContact>,
    trial: Vec<PlanarContact>,
    threads: usize,
}

#[pymethods]
impl PlanarContacts {
    /// So many contacts of the JSON text of a definition, of so many rings.
    #[new]
    fn new(py: Python<'_>, count: usize, body: &[u8], rings: i64, threads: usize) -> PyResult<PlanarContacts> {
        let law = interruptible(py, |stop| law(body, rings, stop))?.map_err(refused)?;
        let committed = py.detach(|| vec![law.start(); count]);
        Ok(PlanarContacts { law, committed, trial: Vec::new(), threads: threads.max(1) })
    }

    fn __len__(&self) -> usize {
        self.committed.len()
    }

    /// Moves every contact straight to its indentation, m, or normal force, N, and to its displacement, m; returns
    /// normal and tangential forces, N.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        normal: Numbers<'_>,
        by_force: bool,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&normal, by_force, &displacement).map_err(refused)?;
        self.trial.clear();
        let PlanarContacts { law, committed, threads, .. } = self;
        Ok(pair(py, py.detach(|| step_all(law, committed, &targets, *threads)).map_err(refused)?))
    }

    /// The forces that such a step would lead to, from the committed states; it is kept until `commit` or `revert`.
    fn trial<'py>(
        &mut self,
        py: Python<'py>,
        normal: Numbers<'_>,
        by_force: bool,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&normal, by_force, &displacement).map_err(refused)?;
        let PlanarContacts { law, committed, trial, threads } = self;
        let forces = py.detach(|| {
            trial.clone_from(committed);
            step_all(law, trial, &targets, *threads)
        });
        // What has failed half-way is no state to commit.
        Ok(pair(py, forces.inspect_err(|_| trial.clear()).map_err(refused)?))
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

    /// Forgets the last trial.
    fn revert(&mut self) {
        self.trial.clear();
    }

    /// Normal and tangential forces, N, of the committed states.
    fn forces<'py>(&self, py: Python<'py>) -> Pair<'py> {
        let normal = self.committed.iter().map(PlanarContact::normal_force).collect();
        pair(py, [normal, self.committed.iter().flat_map(PlanarContact::force).collect()])
    }

    /// The committed state of one contact as JSON text.
    fn state(&self, index: usize) -> PyResult<String> {
        let contact = self.committed.get(index);
        let contact = contact.ok_or_else(|| PyIndexError::new_err(format!("there are {}", self.committed.len())))?;
        Ok(json!(PlanarState::from(&contact.state())).to_string())
    }

    /// Bytes of memory that the committed states take.
    fn memory(&self) -> usize {
        self.committed.iter().map(PlanarContact::memory_bytes).sum()
    }

    /// The warnings of their definition, as JSON text.
    fn warnings(&self) -> String {
        json!(present_warnings(self.law.contact())).to_string()
    }
}

impl PlanarContacts {
    /// The targets of a step, all within their ranges: a step that is refused has moved no contact.
    fn targets(
        &self,
        normal: &Numbers<'_>,
        by_force: bool,
        displacement: &Numbers<'_>,
    ) -> Result<Vec<Target>, Refusal> {
        let count = self.committed.len();
        let (name, range, of): (_, _, fn(f64) -> Normal) = if by_force {
            ("/normal_force", &range::NORMAL_FORCE, Normal::NormalForce)
        } else {
            ("/indentation", &range::INDENTATION, Normal::Indentation)
        };
        let normal = rows::<1>(name, normal, count, range)?;
        let displacement = rows::<IN_PLANE>("/displacement", displacement, count, &range::DISPLACEMENT)?;
        let targets: Vec<Target> = normal.into_iter().map(|[normal]| of(normal)).zip(displacement).collect();
        for (index, (normal, _)) in targets.iter().enumerate() {
            self.law.load(*normal).map_err(|error| Failure::at(format!("{name}/{index}"), error))?;
        }
        Ok(targets)
    }
}

fn law(body: &[u8], rings: i64, stop: &dyn Stop) -> Result<PlanarLaw, Refusal> {
    let setup = setup(body, stop)?;
    let range = range::RING_COUNT;
    let count = usize::try_from(rings).ok().filter(|_| range.contains(rings as f64)).ok_or_else(|| {
        Refusal::at(Code::InvalidInput, "/rings", format!("{rings} is out of range: allowed is {range}"))
    })?;
    simulation::contact(setup.clone(), "")?;
    Ok(PlanarLaw::new(setup, count).map_err(|error| Failure::at("/profile", error))?)
}

fn step_all(
    law: &PlanarLaw,
    contacts: &mut [PlanarContact],
    targets: &[Target],
    threads: usize,
) -> Result<[Vec<f64>; 2], Refusal> {
    let step_share = |contacts: &mut [PlanarContact],
                      targets: &[Target],
                      normal: &mut [f64],
                      tangential: &mut [f64]|
     -> Result<(), Error> {
        let mut buffers = PlanarBuffers::default();
        let forces = normal.iter_mut().zip(tangential.chunks_exact_mut(IN_PLANE));
        for ((contact, (load, displacement)), (normal, tangential)) in contacts.iter_mut().zip(targets).zip(forces) {
            law.step(contact, *load, *displacement, &mut buffers)?;
            *normal = contact.normal_force();
            tangential.copy_from_slice(&contact.force());
        }
        Ok(())
    };
    move_all(contacts, targets, threads, LEAST_SHARE, IN_PLANE, step_share)
}
