//! A contact that lives in this process, with the documents that the service has for it.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Map, Value, json};
use stickslip_compute::Refusal;
use stickslip_compute::computations::{
    Computation as _, ContactTask, Cycle, DisplayOptions, StressTask, Written as _, dry_run_relax, make_moves,
    shown_states,
};
use stickslip_compute::documents::Parse as _;
use stickslip_compute::formats::Format;
use stickslip_compute::simulation::{self, Anew, present_warnings};
use stickslip_compute::{Flag, Stop};
use stickslip_mechanics as mechanics;
use stickslip_mechanics::Elasticity;
use stickslip_wire::Code;
use stickslip_wire::definition::FrictionSetup;
use stickslip_wire::session::{Advance, Creation};
use stickslip_wire::{
    self as wire, ContactDefinition, CreateRequest, CycleRequest, Document as _, Faults, JsonPath, Move, MoveReply,
    MoveRequest, PathReply, PathRequest, Plan, Prepare, RelaxReply, RelaxRequest, State, Steps, StressRequest,
    SubsurfaceRequest,
};
use uuid::Uuid;

use super::history;
use super::interrupt::interruptible;
use super::problem::refused;
use super::trace::Trace;

/// The most pieces that one straight move can add to the slip history, with a margin.
const PIECES_OF_A_MOVE: usize = 8;

/// A reply, and the contact as it was before moves that are drawn.
type Followed = (Vec<u8>, Option<mechanics::Contact>);

/// A contact with its history.
#[pyclass(module = "stickslip._native")]
pub struct Contact {
    id: Uuid,
    label: Option<String>,
    definition: ContactDefinition,
    setup: FrictionSetup,
    pub(super) state: mechanics::Contact,
    /// Every move with its tolerance, and how many there were before each call that made any.
    pub(super) made: Vec<(Move, f64)>,
    calls: Vec<usize>,
}

/// The profile of a contact that exists.
struct Ready<'a>(&'a Arc<mechanics::Profile>, &'a dyn Stop);

impl Prepare for Ready<'_> {
    fn profile(
        &self,
        _: &wire::Profile,
        _: Option<&Elasticity>,
        _: &mut dyn FnMut() -> Option<mechanics::Profile>,
    ) -> Option<Arc<mechanics::Profile>> {
        Some(Arc::clone(self.0))
    }

    fn keep_going(&self) -> bool {
        self.1.check().is_ok()
    }
}

#[pymethods]
impl Contact {
    /// The contact of the JSON text of a definition.
    #[new]
    fn new(py: Python<'_>, body: &[u8]) -> PyResult<Contact> {
        interruptible(py, |stop| Contact::create(body, stop))?.map_err(refused)
    }

    /// Identifier, label, summary, state and warnings, as POST /contacts replies.
    fn describe<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let document = json!({
            "id": self.id,
            "label": self.label,
            "sequence": self.made.len(),
            "contact": wire::ContactSummary::from(self.state.initial_summary()),
            "state": State::from(self.state.state()),
            "warnings": present_warnings(&self.state),
        });
        PyBytes::new(py, document.to_string().as_bytes())
    }

    /// The warnings of its definition, as JSON text.
    fn warnings(&self) -> String {
        json!(present_warnings(&self.state)).to_string()
    }

    /// The definition, as GET /contacts/{id}/definition replies.
    fn definition(&self) -> String {
        json!(self.definition).to_string()
    }

    /// The same with the present normal force as its preload.
    fn definition_now(&self) -> String {
        json!(self.loaded_definition()).to_string()
    }

    /// The moves so far, as the member `moves` of a path.
    fn moves(&self) -> String {
        json!(self.made.iter().map(|(step, _)| step).collect::<Vec<_>>()).to_string()
    }

    /// Makes a `move`, a `path` or the path of `relax`: the reply of POST /contacts/{id}/…, and the moves for a picture
    /// if they are several.
    fn advance<'py>(
        &mut self,
        py: Python<'py>,
        kind: &str,
        body: &[u8],
    ) -> PyResult<(Bound<'py, PyBytes>, Option<Trace>)> {
        let reply = match kind {
            "move" => self.make_move(py, body)?,
            "path" => interruptible(py, |stop| self.follow(&PathRequest::read(body)?, stop))?,
            _ => interruptible(py, |stop| self.relax(body, stop))?,
        };
        let (reply, before) = reply.map_err(refused)?;
        let trace = before.map(|before| Trace { before, moves: self.steps_from(self.calls.last().copied()) });
        Ok((PyBytes::new(py, &reply), trace))
    }

    /// The moves after the move `after` and up to `end`, with their states and the cycles that they closed, as the
    /// items of GET /contacts/{id}/history without times.
    fn history<'py>(&self, py: Python<'py>, after: usize, end: usize) -> PyResult<Bound<'py, PyBytes>> {
        let items = interruptible(py, |stop| history::items(self, after..end, stop))?;
        Ok(PyBytes::new(py, Value::from(items.map_err(refused)?).to_string().as_bytes()))
    }

    /// The last closed cycles, as the items of GET /contacts/{id}/cycles.
    fn cycles<'py>(&self, py: Python<'py>, last: usize) -> PyResult<Bound<'py, PyBytes>> {
        let items = interruptible(py, |stop| history::cycles(self, last, stop))?;
        Ok(PyBytes::new(py, Value::from(items.map_err(refused)?).to_string().as_bytes()))
    }

    /// The points of the loop along the moves after the move `after` and up to `end`, so many for each: as
    /// GET /contacts/{id}/loop.
    fn points<'py>(&self, py: Python<'py>, after: usize, end: usize, points: usize) -> PyResult<Bound<'py, PyBytes>> {
        let page = interruptible(py, |stop| history::points(self, after..end, points, stop))?;
        Ok(PyBytes::new(py, &json_bytes(&page.map_err(refused)?).map_err(refused)?))
    }

    /// The moves after the move `after` and up to `end`, for a picture.
    fn trace(&self, py: Python<'_>, after: usize, end: usize) -> PyResult<Trace> {
        let before = interruptible(py, |stop| replay(self.state.virgin(), &self.made[..after], stop))?;
        let moves = self.made[after..end].iter().map(|(step, tolerance)| (step.step(), *tolerance)).collect();
        Ok(Trace { before: before.map_err(refused)?, moves })
    }

    /// The `stress`, `subsurface` stress or steady `cycle` of the present state.
    fn read<'py>(&self, py: Python<'py>, kind: &str, body: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let reply = interruptible(py, |stop| match kind {
            "stress" => self.stress(body, stop),
            "subsurface" => {
                let task = SubsurfaceRequest::parse(body)?.of_contact(&self.definition)?;
                self.compute(Box::new(task), stop)
            }
            _ => self.cycle(body, stop),
        })?;
        Ok(PyBytes::new(py, &reply.map_err(refused)?))
    }

    /// Takes back the last calls that made moves; returns the number of moves that are left.
    fn undo(&mut self, py: Python<'_>, calls: usize) -> PyResult<usize> {
        let Some(kept) = self.calls.len().checked_sub(calls) else {
            let detail = format!("{} calls have moved this contact", self.calls.len());
            return Err(refused(Refusal::at(Code::InvalidInput, "/calls", detail)));
        };
        let moves = self.calls.get(kept).copied().unwrap_or(self.made.len());
        let state = interruptible(py, |stop| replay(self.state.virgin(), &self.made[..moves], stop))?;
        self.state = state.map_err(refused)?;
        self.made.truncate(moves);
        self.calls.truncate(kept);
        Ok(moves)
    }

    /// A copy of the contact, which evolves independently from here.
    fn copy(&self) -> Contact {
        Contact {
            id: Uuid::now_v7(),
            label: self.label.clone(),
            definition: self.definition.clone(),
            setup: self.setup.clone(),
            state: self.state.clone(),
            made: self.made.clone(),
            calls: self.calls.clone(),
        }
    }

    /// Definition and moves, from which the same contact is made again to the last bit.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let document = json!({
            "id": self.id, "label": self.label, "definition": self.definition, "moves": self.made, "calls": self.calls
        });
        PyBytes::new(py, document.to_string().as_bytes())
    }

    /// The contact of the bytes that `to_bytes` returned.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Contact> {
        interruptible(py, |stop| Contact::restore(bytes, stop))?.map_err(refused)
    }
}

impl Contact {
    fn create(body: &[u8], stop: &dyn Stop) -> Result<Contact, Refusal> {
        let checked = simulation::check(CreateRequest::parse(body)?, &Anew(stop), stop)?;
        let Creation { label, definition, setup } = checked?;
        let state = simulation::contact(setup.clone(), "")?;
        Ok(Contact { id: Uuid::now_v7(), label, definition, setup, state, made: Vec::new(), calls: Vec::new() })
    }

    fn restore(bytes: &[u8], stop: &dyn Stop) -> Result<Contact, Refusal> {
        let broken = |error: serde_json::Error| {
            Refusal::new(Code::InvalidInput, format!("these bytes are not those of a contact: {error}"))
        };
        let mut document: Map<String, Value> = serde_json::from_slice(bytes).map_err(broken)?;
        let mut part = |name: &str| document.remove(name).unwrap_or_default();
        let mut contact = Contact::create(part("definition").to_string().as_bytes(), stop)?;
        contact.id = serde_json::from_value(part("id")).map_err(broken)?;
        contact.label = serde_json::from_value(part("label")).map_err(broken)?;
        contact.made = serde_json::from_value(part("moves")).map_err(broken)?;
        contact.calls = serde_json::from_value(part("calls")).map_err(broken)?;
        contact.state = replay(contact.state, &contact.made, stop)?;
        Ok(contact)
    }

    fn loaded_definition(&self) -> ContactDefinition {
        let preload = wire::Preload::NormalForce(self.state.normal_force());
        ContactDefinition { preload, ..self.definition.clone() }
    }

    /// A single straight move takes microseconds, less than a thread for it would.
    fn make_move(&mut self, py: Python<'_>, body: &[u8]) -> PyResult<Result<Followed, Refusal>> {
        let advance = match MoveRequest::read(body) {
            Ok(advance) => advance,
            Err(rejection) => return Ok(Err(rejection.into())),
        };
        let is_short = self.is_straight(&advance);
        if is_short {
            return Ok(py.detach(|| self.follow(&advance, &Flag::default())));
        }
        interruptible(py, |stop| self.follow(&advance, stop))
    }

    /// Whether the moves are one that changes nothing if it is refused.
    fn is_straight(&self, advance: &Advance) -> bool {
        matches!(advance.plan, Plan::Single(step) if !step.is_curved())
            && advance.stress.is_none()
            && self.state.memory_depth() + PIECES_OF_A_MOVE <= wire::limits::MEMORY_DEPTH
    }

    fn follow(&mut self, advance: &Advance, stop: &dyn Stop) -> Result<Followed, Refusal> {
        let before = (!self.is_straight(advance)).then(|| self.state.clone());
        let (mut states, made) = (Vec::new(), self.made.len());
        let moved = make_moves(&mut self.state, advance, stop, |step, state| {
            self.made.push((step, advance.tolerance));
            states.push(state);
        });
        let moved = match moved {
            Ok(moved) => moved,
            Err(failure) => {
                self.made.truncate(made);
                if let Some(before) = before {
                    self.state = before;
                }
                return Err(failure.into());
            }
        };
        self.calls.push(made);
        let (id, sequence, state) = (self.id, self.made.len() as u64, State::from(self.state.state()));
        let shown = |steps: Steps| shown_states(steps, states.into_iter(), state);
        let (stress, accuracy, warnings) = (moved.stress, moved.accuracy, moved.warnings);
        let reply = match (&advance.plan, advance.relax, moved.relaxed) {
            (_, Some(relax), Some(protocol)) => {
                json_bytes(&RelaxReply { id, sequence, dry_run: false, steps: relax.steps.map(shown), protocol })
            }
            (Plan::Single(_), ..) => json_bytes(&MoveReply { id, sequence, state, stress, accuracy, warnings }),
            _ => {
                let (steps, protocol) = (shown(advance.steps), moved.protocol);
                json_bytes(&PathReply { id, sequence, steps, stress, protocol, accuracy, warnings })
            }
        };
        Ok((reply?, before))
    }

    /// The moves after the move `first`.
    fn steps_from(&self, first: Option<usize>) -> Vec<(mechanics::Move, f64)> {
        let made = first.map_or(&[][..], |first| &self.made[first..]);
        made.iter().map(|(step, tolerance)| (step.step(), *tolerance)).collect()
    }

    fn relax(&mut self, body: &[u8], stop: &dyn Stop) -> Result<Followed, Refusal> {
        let relaxation = RelaxRequest::read(body)?;
        if !relaxation.dry_run {
            return self.follow(&relaxation.into(), stop);
        }
        let (steps, protocol) = dry_run_relax(self.state.clone(), &relaxation, stop)?;
        let (id, sequence) = (self.id, self.made.len() as u64);
        Ok((json_bytes(&RelaxReply { id, sequence, dry_run: true, steps, protocol })?, None))
    }

    /// The body is that of a stress in a request, with `residual` beside.
    fn stress(&self, body: &[u8], stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
        let mut body: Map<String, Value> =
            serde_json::from_slice(body).map_err(|error| Refusal::new(Code::NotJson, error.to_string()))?;
        let residual = body.remove("residual") == Some(Value::Bool(true));
        let request = wire::parse::<StressRequest>(Value::Object(body).to_string().as_bytes())?;
        let mut faults = Faults::default();
        let sampling = request.check(JsonPath::Root, &mut faults);
        self.compute(Box::new(StressTask { sampling: faults.done(sampling)?, residual }), stop)
    }

    /// The body is that of POST /cycle without a contact.
    fn cycle(&self, body: &[u8], stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
        let mut body: Map<String, Value> =
            serde_json::from_slice(body).map_err(|error| Refusal::new(Code::NotJson, error.to_string()))?;
        body.insert("contact".to_owned(), json!(self.loaded_definition()));
        let request = CycleRequest::parse(Value::Object(body).to_string().as_bytes())?;
        let checked = request.check_with(&Ready(&self.setup.profile, stop))?;
        if checked.2.map.is_some() {
            return Ok(Cycle::run(checked, stop)?.write(&DisplayOptions::in_format(Format::Columns), stop)??);
        }
        self.compute(Box::new(checked.2), stop)
    }

    fn compute(&self, task: Box<dyn ContactTask>, stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
        let outcome = task.run(self.state.clone(), self.made.len() as u64, stop)?;
        Ok(outcome.write(&DisplayOptions::in_format(Format::Columns), stop)??)
    }
}

/// The contact after these moves.
fn replay(
    mut contact: mechanics::Contact,
    moves: &[(Move, f64)],
    stop: &dyn Stop,
) -> Result<mechanics::Contact, Refusal> {
    for (step, tolerance) in moves {
        stop.check().map_err(simulation::Failure::from)?;
        let made = contact.apply_while(&step.step(), *tolerance, &|| stop.check().is_ok());
        made.map_err(|error| simulation::Failure::at("/moves", error))?;
    }
    Ok(contact)
}

fn json_bytes(document: &impl serde::Serialize) -> Result<Vec<u8>, Refusal> {
    serde_json::to_vec(document).map_err(|error| Refusal::internal(error.to_string()))
}
