//! Many contacts of one definition, moved together: the contact law of a program that has its own equations of motion.

use pyo3::prelude::*;
use serde_json::json;
use stickslip_compute::simulation::{self, present_warnings};
use stickslip_compute::{Refusal, Stop};
use stickslip_mechanics::range::{self, Range};
use stickslip_mechanics::{Contact, Error, Move, Normal, Tangential};
use stickslip_wire::{Code, State};

use super::interrupt::interruptible;
use super::problem::refused;
use super::stepped::{Numbers, Pair, Shares, Stepped, pair, rows, setup};

/// A displacement beyond which the part that still sticks is looked at, over that of gross slip.
const PROBE: f64 = 1e-12;
/// Contacts that are worth a thread of their own.
const LEAST_SHARE: usize = 256;

/// Contacts that are stepped together.
#[pyclass(module = "stickslip._native")]
pub struct Contacts(Stepped<Contact>);

#[pymethods]
impl Contacts {
    /// This number of contacts of the JSON text of a definition.
    #[new]
    fn new(py: Python<'_>, count: usize, body: &[u8], threads: usize) -> PyResult<Contacts> {
        let first = interruptible(py, |stop| first(body, stop))?.map_err(refused)?;
        let committed = py.detach(|| vec![first; count]);
        let shares = Shares { threads, least: LEAST_SHARE, components: 1 };
        Ok(Contacts(Stepped { committed, trial: Vec::new(), shares }))
    }

    fn __len__(&self) -> usize {
        self.0.committed.len()
    }

    /// Moves every contact straight to its indentation and displacement, m; returns normal and tangential forces, N.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        indentation: Numbers<'_>,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&indentation, &displacement).map_err(refused)?;
        self.0.step(py, &targets, move_share)
    }

    /// The forces that such a step would lead to, from the committed states; it is kept until `commit` or `revert`.
    fn trial<'py>(
        &mut self,
        py: Python<'py>,
        indentation: Numbers<'_>,
        displacement: Numbers<'_>,
    ) -> PyResult<Pair<'py>> {
        let targets = self.targets(&indentation, &displacement).map_err(refused)?;
        self.0.trial(py, &targets, move_share)
    }

    /// Makes the states of the last trial the committed ones; returns whether there was a trial.
    fn commit(&mut self) -> bool {
        self.0.commit()
    }

    /// Discards the last trial.
    fn revert(&mut self) {
        self.0.trial.clear();
    }

    /// Normal and tangential forces, N, of the committed states.
    fn forces<'py>(&self, py: Python<'py>) -> Pair<'py> {
        pair(
            py,
            self.0.committed.iter().map(|contact| (contact.normal_force(), contact.force())).collect::<(_, _)>().into(),
        )
    }

    /// Normal stiffness, and tangential stiffness of a displacement that goes on upwards or downwards, N/m, of the last
    /// trial or else of the committed states.
    fn stiffness<'py>(&self, py: Python<'py>, upwards: bool) -> PyResult<Pair<'py>> {
        let contacts = if self.0.trial.is_empty() { &self.0.committed } else { &self.0.trial };
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
        self.0.state(index, |contact| json!(State::from(contact.state())))
    }

    /// Bytes of memory that the committed states take.
    fn memory(&self) -> usize {
        self.0.committed.iter().map(Contact::memory_bytes).sum()
    }

    /// The warnings of their definition, as JSON text.
    fn warnings(&self) -> String {
        json!(self.0.committed.first().map(present_warnings).unwrap_or_default()).to_string()
    }
}

impl Contacts {
    /// The targets of a step, all within their ranges: a step that is refused has moved no contact.
    fn targets(&self, indentation: &Numbers<'_>, displacement: &Numbers<'_>) -> Result<Vec<[f64; 2]>, Refusal> {
        let count = self.0.committed.len();
        let indentation = numbers("/indentation", indentation, count, &range::INDENTATION)?;
        let displacement = numbers("/displacement", displacement, count, &range::DISPLACEMENT)?;
        // The radius grows with the indentation, so that the deepest contact alone can be beyond the profile.
        let deepest = indentation.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1));
        if let (Some((index, depth)), Some(contact)) =
            (deepest.filter(|(_, depth)| **depth > 0.0), self.0.committed.first())
        {
            let indenter = contact.indenter();
            let radius = indenter.check_radius(indenter.radius(*depth));
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
            relative: false,
        })?;
        (*normal, *tangential) = (contact.normal_force(), contact.force());
    }
    Ok(())
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
