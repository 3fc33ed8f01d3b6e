//! Many contacts of one definition that are moved in the plane, step by step: the law of rings for a program that has
//! its own equations of motion.

use pyo3::prelude::*;
use serde_json::json;
use stickslip_compute::simulation::{self, Failure, present_warnings};
use stickslip_compute::{Refusal, Stop};
use stickslip_mechanics::rings::{PlanarBuffers, PlanarContact, PlanarLaw};
use stickslip_mechanics::{Normal, range};
use stickslip_wire::Code;
use stickslip_wire::plane::PlanarState;

use super::interrupt::interruptible;
use super::problem::refused;
use super::stepped::{MoveShare, Numbers, Pair, Shares, Stepped, copies, pair, rows, setup};

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
    contacts: Stepped<PlanarContact>,
}

#[pymethods]
impl PlanarContacts {
    /// This number of contacts of the JSON text of a definition, each of at most this number of rings.
    #[new]
    fn new(
        py: Python<'_>,
        count: usize,
        memory: usize,
        body: &[u8],
        rings: i64,
        threads: usize,
    ) -> PyResult<PlanarContacts> {
        let law = interruptible(py, |stop| law(body, rings, stop))?.map_err(refused)?;
        let committed = py.detach(|| copies(&[law.start()], count, |_| 0, memory)).map_err(refused)?;
        let shares = Shares { threads, least: LEAST_SHARE, components: IN_PLANE };
        Ok(PlanarContacts { law, contacts: Stepped { committed, trial: Vec::new(), shares } })
    }

    fn __len__(&self) -> usize {
        self.contacts.committed.len()
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
        self.contacts.step(py, &targets, share_of(&self.law))
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
        self.contacts.trial(py, &targets, share_of(&self.law))
    }

    /// Makes the states of the last trial the committed ones; returns whether there was a trial.
    fn commit(&mut self) -> bool {
        self.contacts.commit()
    }

    /// Discards the last trial.
    fn revert(&mut self) {
        self.contacts.trial.clear();
    }

    /// Normal and tangential forces, N, of the committed states.
    fn forces<'py>(&self, py: Python<'py>) -> Pair<'py> {
        let normal = self.contacts.committed.iter().map(PlanarContact::normal_force).collect();
        pair(py, [normal, self.contacts.committed.iter().flat_map(PlanarContact::force).collect()])
    }

    /// The committed state of one contact as JSON text.
    fn state(&self, index: usize) -> PyResult<String> {
        self.contacts.state(index, |contact| json!(PlanarState::from(contact.state())))
    }

    /// Bytes of memory that the committed states take.
    fn memory(&self) -> usize {
        self.contacts.committed.iter().map(PlanarContact::memory_bytes).sum()
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
        let count = self.contacts.committed.len();
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

/// The steps of a share of the contacts.
fn share_of(law: &PlanarLaw) -> impl MoveShare<PlanarContact, Target> {
    move |contacts, targets, normal, tangential| {
        let mut buffers = PlanarBuffers::default();
        let forces = normal.iter_mut().zip(tangential.chunks_exact_mut(IN_PLANE));
        for ((contact, (load, displacement)), (normal, tangential)) in contacts.iter_mut().zip(targets).zip(forces) {
            law.step(contact, *load, *displacement, &mut buffers)?;
            *normal = contact.normal_force();
            tangential.copy_from_slice(&contact.force());
        }
        Ok(())
    }
}
