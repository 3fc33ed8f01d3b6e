//! Many contacts of one definition, moved together: the contact law of a program that has its own equations of motion.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use stickslip_compute::simulation::{self, Failure, present_warnings};
use stickslip_compute::{Refusal, Stop};
use stickslip_mechanics::range::{self, Range};
use stickslip_mechanics::{Contact, Error, Move, Normal, Tangential};
use stickslip_wire::{Code, State};

use super::interrupt::interruptible;
use super::problem::refused;
use super::stepped::{Numbers, Pair, Shares, Stepped, copies, pair, rows, setup};

/// Contacts that are worth a thread of their own.
const LEAST_SHARE: usize = 256;

/// Contacts that are stepped together.
#[pyclass(module = "stickslip._native")]
pub struct Contacts {
    contacts: Stepped<Contact>,
    /// A virgin contact of each definition, and which of them each contact has; none where there is one for all.
    firsts: Vec<Contact>,
    kinds: Vec<u32>,
}

#[pymethods]
impl Contacts {
    /// This number of contacts of the JSON texts of definitions, of which `kinds` has one for each contact unless there
    /// is one for all; `memory` is what they may take, bytes.
    #[new]
    fn new(
        py: Python<'_>,
        count: usize,
        memory: usize,
        bodies: Vec<Vec<u8>>,
        kinds: Vec<u32>,
        threads: usize,
    ) -> PyResult<Contacts> {
        let firsts =
            interruptible(py, |stop| bodies.iter().map(|body| first(body, stop)).collect::<Result<Vec<_>, _>>())?;
        let firsts = firsts.map_err(refused)?;
        let kind_of = |index: usize| kinds.get(index).map_or(0, |kind| *kind as usize);
        let committed = py.detach(|| copies(&firsts, count, kind_of, memory)).map_err(refused)?;
        let shares = Shares { threads, least: LEAST_SHARE, components: 1 };
        Ok(Contacts { contacts: Stepped { committed, trial: Vec::new(), shares }, firsts, kinds })
    }

    fn __len__(&self) -> usize {
        self.contacts.committed.len()
    }

    /// A copy of the contacts of these numbers, without a trial.
    fn take(&self, py: Python<'_>, indices: Vec<usize>) -> Contacts {
        py.detach(|| {
            let committed = indices.iter().map(|index| self.contacts.committed[*index].clone()).collect();
            let kinds = indices.iter().filter_map(|index| self.kinds.get(*index).copied()).collect();
            let contacts = Stepped { committed, trial: Vec::new(), shares: self.contacts.shares };
            Contacts { contacts, firsts: self.firsts.clone(), kinds }
        })
    }

    /// The committed states, one after the other, each behind its length in bytes.
    fn pack<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let packed = py.detach(|| {
            let mut all = Vec::new();
            for contact in &self.contacts.committed {
                let state = contact.pack();
                all.extend_from_slice(&(state.len() as u64).to_le_bytes());
                all.extend_from_slice(&state);
            }
            all
        });
        PyBytes::new(py, &packed)
    }

    /// Makes the states that `pack` wrote the committed ones.
    fn unpack(&mut self, py: Python<'_>, bytes: &[u8]) -> PyResult<()> {
        let unpacked = py.detach(|| self.unpacked(bytes));
        let detail = "these bytes are not the states of such contacts by this version of the package";
        self.contacts.committed = unpacked.ok_or_else(|| refused(Refusal::new(Code::InvalidInput, detail)))?;
        self.contacts.trial.clear();
        Ok(())
    }

    /// Moves every contact straight to its indentation, m, or to that of its normal force, N, and to its displacement,
    /// m; returns normal and tangential forces, N.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        normal: Numbers<'_>,
        by_force: bool,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&normal, by_force, &displacement).map_err(refused)?;
        self.contacts.step(py, &targets, move_share)
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
        self.contacts.trial(py, &targets, move_share)
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
        pair(
            py,
            self.contacts
                .committed
                .iter()
                .map(|contact| (contact.normal_force(), contact.force()))
                .collect::<(_, _)>()
                .into(),
        )
    }

    /// Normal stiffness, and tangential stiffness of a displacement that goes on upwards or downwards, N/m, of the last
    /// trial or else of the committed states.
    fn stiffness<'py>(&self, py: Python<'py>, upwards: bool) -> PyResult<Pair<'py>> {
        let contacts = if self.contacts.trial.is_empty() { &self.contacts.committed } else { &self.contacts.trial };
        let direction = if upwards { 1.0 } else { -1.0 };
        let all = py.detach(|| {
            contacts.iter().map(|contact| contact.stiffness(direction)).collect::<Result<(Vec<f64>, Vec<f64>), Error>>()
        });
        let refusal = |error: Error| refused(Refusal::new(Code::InvalidInput, error.to_string()));
        Ok(pair(py, all.map_err(refusal)?.into()))
    }

    /// The committed state of one contact as JSON text.
    fn state(&self, index: usize) -> PyResult<String> {
        self.contacts.state(index, |contact| json!(State::from(contact.state())))
    }

    /// Bytes of memory that the committed states take.
    fn memory(&self) -> usize {
        self.contacts.committed.iter().map(Contact::memory_bytes).sum()
    }

    /// The warnings of their definition, as JSON text.
    fn warnings(&self) -> String {
        json!(self.contacts.committed.first().map(present_warnings).unwrap_or_default()).to_string()
    }
}

impl Contacts {
    /// The targets of a step, all within their ranges: a step that is refused has moved no contact.
    fn targets(
        &self,
        normal: &Numbers<'_>,
        by_force: bool,
        displacement: &Numbers<'_>,
    ) -> Result<Vec<[f64; 2]>, Refusal> {
        let count = self.contacts.committed.len();
        let (name, range) =
            if by_force { ("/normal_force", &range::NORMAL_FORCE) } else { ("/indentation", &range::INDENTATION) };
        let mut depths = numbers(name, normal, count, range)?;
        let displacement = numbers("/displacement", displacement, count, &range::DISPLACEMENT)?;
        if by_force {
            for (index, depth) in depths.iter_mut().enumerate() {
                let first = &self.firsts[self.kind(index)];
                *depth =
                    first.indentation_under(*depth).map_err(|error| Failure::at(format!("{name}/{index}"), error))?;
            }
        }
        // The radius grows with the indentation, so that of each kind the deepest contact alone can be beyond the
        // profile.
        let mut deepest = vec![(0, 0.0); self.firsts.len()];
        for (index, depth) in depths.iter().enumerate() {
            let most = &mut deepest[self.kind(index)];
            if *depth > most.1 {
                *most = (index, *depth);
            }
        }
        for (first, (index, depth)) in self.firsts.iter().zip(deepest).filter(|(_, (_, depth))| *depth > 0.0) {
            let indenter = first.indenter();
            let radius = indenter.check_radius(indenter.radius(depth));
            radius
                .and_then(|radius| range::CONTACT_RADIUS.check(radius))
                .map_err(|error| Refusal::at(Code::BeyondProfile, format!("{name}/{index}"), error.to_string()))?;
        }
        Ok(depths.into_iter().zip(displacement).map(|(depth, displacement)| [depth, displacement]).collect())
    }

    /// The number of the definition of a contact.
    fn kind(&self, index: usize) -> usize {
        self.kinds.get(index).map_or(0, |kind| *kind as usize)
    }

    /// The contacts of packed states.
    fn unpacked(&self, mut bytes: &[u8]) -> Option<Vec<Contact>> {
        let count = self.contacts.committed.len();
        let mut contacts = Vec::with_capacity(count);
        for index in 0..count {
            let (length, rest) = bytes.split_first_chunk()?;
            let (state, rest) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
            contacts.push(self.firsts[self.kind(index)].unpack(state)?);
            bytes = rest;
        }
        bytes.is_empty().then_some(contacts)
    }
}

/// The first of the contacts.
fn first(body: &[u8], stop: &dyn Stop) -> Result<Contact, Refusal> {
    Ok(simulation::contact(setup(body, stop)?, "")?)
}

/// The numbers of an array, one for each contact.
fn numbers(pointer: &str, given: &Numbers<'_>, count: usize, range: &Range) -> Result<Vec<f64>, Refusal> {
    let rows = rows::<1>(pointer, given, count, range)?;
    Ok(rows.into_iter().map(|[number]| number).collect())
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
            ..Move::default()
        })?;
        (*normal, *tangential) = (contact.normal_force(), contact.force());
    }
    Ok(())
}
