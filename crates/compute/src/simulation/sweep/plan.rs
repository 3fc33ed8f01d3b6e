//! Checking a sweep: at its corners, where each axis is at one of its ends, its numbers are smallest and largest.

use super::Sweep;
use super::shared::{self, Shared};
use crate::prelude::*;
use crate::simulation::stated_accuracy::coupling_bound;
use stickslip_mechanics::profile::LineContact;
use stickslip_wire::check::{Faults, JsonPath};
use stickslip_wire::json_value::{Pointer, index};
use stickslip_wire::pointer_lookup::{Lookup, lookup};
use stickslip_wire::sweep::CheckedSweep;
use stickslip_wire::{
    ContactSummary, Peak, PlanarPlan, PlanarReply, PlanarState, PlanarStress, PrepareOnce, parse_value,
};

/// What planning takes besides profiles: a thread of the solver, however small the sweep is.
const PLANNING_COST: Nanoseconds = 100_000;
/// Samples by which a sweep is checked and its cost estimated.
const PROBES: usize = 8;

impl Sweep {
    /// The cost of [`Sweep::plan`]: above all of the profile, which each corner may have its own of.
    pub fn planning_cost(checked: &CheckedSweep) -> Nanoseconds {
        let corners = if checked.samples.is_some() { PROBES as u64 } else { 1_u64 << checked.axes.len() };
        PLANNING_COST.saturating_add(cost::of_profile_in(&checked.request.base.0).saturating_mul(corners))
    }

    /// Checks the corners of a sweep, with a profile that `profiles` prepares once if no axis changes it, and estimates
    /// its cost.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] if an axis leaves the range of its field, the base is at fault whatever the axes say, or
    /// an output does not exist; [`Rejection::Refused`] if the mechanics takes none of the corners.
    pub fn plan(checked: CheckedSweep, profiles: &dyn Prepare) -> Result<Sweep, Rejection> {
        let profiles = PrepareOnce::by(profiles);
        let mut document = checked.request.base.0.clone();
        let mut sweep = Sweep { checked, base: Value::Null, shared: None, cost_per_point: 0, bytes: 0 };
        let mut outputs = vec![Lookup::Nothing; sweep.checked.outputs.len()];
        let (mut faults, mut accepted, mut refused) = (Vec::new(), 0, None);
        for point in sweep.corners() {
            sweep.checked.put(&mut document, point);
            let request = parse_value::<SimulateRequest>(&document).map_err(|fault| Rejection::Invalid(vec![fault]));
            match request.and_then(|request| request.check_with(&profiles)) {
                Ok(simulation) => {
                    accepted += 1;
                    sweep.inspect(simulation, &mut outputs);
                }
                Err(Rejection::Invalid(found)) => faults.extend(found),
                Err(other) => refused = Some(other),
            }
        }
        sweep.refuse(faults, accepted, refused)?;
        if accepted > 0 {
            sweep.check_outputs(&outputs)?;
        }
        let written = document.to_string().len();
        if sweep.shared.is_some() {
            document["contact"]["profile"] = shared::placeholder();
        }
        sweep.base = document;
        sweep.bytes += written * bytes::READ;
        Ok(sweep)
    }

    /// The points where each axis is at one of its ends, or the first of the samples.
    fn corners(&self) -> Vec<usize> {
        if self.checked.samples.is_some() {
            return (0..PROBES.min(self.checked.points)).collect();
        }
        let mut corners = vec![0];
        for axis in &self.checked.axes {
            let with = |index: usize| corners.iter().map(move |corner| corner * axis.count() + index);
            let [least, most] = axis.ends();
            corners = if least == most { with(least).collect() } else { with(least).chain(with(most)).collect() };
        }
        corners
    }

    fn inspect(&mut self, simulation: Simulation, outputs: &mut [Lookup]) {
        let preparation = cost::of_preparation(&simulation.definition.profile);
        let mut cost = cost::of_simulation(&simulation);
        self.bytes = self.bytes.max(bytes::of_simulation(&simulation));
        let reply = reply_template(&simulation);
        for (output, found) in self.checked.outputs.iter().zip(outputs) {
            if !matches!(found, Lookup::Number(_)) {
                *found = lookup(&reply, &first_peak(output));
            }
        }
        if self.shared.is_none() {
            self.shared = Shared::of(simulation, &self.checked);
        }
        if self.shared.is_none() {
            cost = cost.saturating_add(preparation);
        }
        self.cost_per_point = self.cost_per_point.max(cost);
    }

    /// Refuses faults that every point has, and values out of the range of their field.
    fn refuse(&self, found: Vec<Fault>, accepted: usize, refused: Option<Rejection>) -> Result<(), Rejection> {
        let mut faults = Faults::default();
        let mut seen = Vec::new();
        for fault in found {
            let place = self.checked.place_of(&fault.pointer);
            // A sample out of range is a point without a result.
            let every_point = accepted == 0 || place.starts_with("/axes");
            if every_point && !seen.contains(&place) {
                faults.add(JsonPath::Pointer(&place), fault.detail);
                seen.push(place);
            }
        }
        match (faults.is_empty(), refused) {
            (true, Some(Rejection::Refused { pointer, error })) if accepted == 0 => {
                Err(Rejection::Refused { pointer: self.checked.place_of(&pointer), error })
            }
            _ => faults.done(Some(())),
        }
    }

    fn check_outputs(&self, found: &[Lookup]) -> Result<(), Rejection> {
        let (mut faults, at) = (Faults::default(), JsonPath::Root.member("outputs"));
        for (index, (found, output)) in found.iter().zip(&self.checked.request.outputs).enumerate() {
            let at = at.index(index);
            let at = output.place_of_pointer(&at);
            match found {
                Lookup::Number(_) => {}
                Lookup::Nothing => faults.add(at, "the reply to the base has no such member"),
                Lookup::Other => faults.add(at, "the reply to the base has no number there"),
            }
        }
        faults.done(Some(()))
    }
}

/// The pointer to the first peak in place of one to any peak: their number is not known in advance.
fn first_peak(output: &Pointer) -> Pointer {
    match output.segments() {
        [residual, peaks, position, rest @ ..]
            if residual == "residual" && peaks == "peaks" && index(position).is_some() =>
        {
            let first = format!("/residual/peaks/0{}", rest.iter().map(|part| format!("/{part}")).collect::<String>());
            Pointer::parse(&first).unwrap_or_else(|| output.clone())
        }
        _ => output.clone(),
    }
}

/// A reply with a number or none for each number that the simulation will compute, and one peak in place of however
/// many there will be. What only some contacts have, such as a conductance, is that of the contact at its preload.
fn reply_template(simulation: &Simulation) -> SimulationReply {
    let moves = simulation.plan.length();
    let pressed = Contact::new(simulation.setup.clone()).ok();
    let start: State = pressed.as_ref().map(Contact::state).map(Into::into).unwrap_or_default();
    let mut contact: ContactSummary = pressed.as_ref().map(Contact::summary).map(Into::into).unwrap_or_default();
    let by_curve = matches!(*simulation.setup.profile, Profile::LoadCurve(_));
    contact.gross_slip_torque = (simulation.plan.twists() || by_curve).then_some(0.0);
    let (count, steps) = pressed.as_ref().and_then(Contact::count_and_steps).unzip();
    let coupling_bound = pressed.as_ref().and_then(coupling_bound);
    let accuracy = Accuracy { coupling_bound, count, steps, ..Accuracy::default() };
    if let Plan::Plane(plane) = &simulation.plan {
        let template = planar_template(simulation, plane, &start);
        let accuracy = Accuracy { coupling_bound, ..template.accuracy };
        return SimulationReply::Plane(PlanarReply { contact, accuracy, ..template });
    }
    let line = simulation.setup.profile.line();
    let along = |along_line: bool| (along_line == line.is_some()).then_some(0.0);
    let peak = Peak { radius: along(false), x: along(true), shear: None };
    let residual = || Residual { peaks: vec![peak], ..Residual::default() };
    let stick_centre = line.and_then(LineContact::bulk).map(|_| 0.0);
    let state = |twisted: bool| {
        let of = |present: bool| present.then_some(0.0);
        let (displacement, twist) = (of(!twisted), of(twisted));
        State { displacement, force: displacement, twist, torque: twist, stick_centre, ..start }
    };
    let last = twisted(&simulation.plan).last();
    let protocol = || Protocol { displacement: vec![0.0; moves], cutoff_radius: 0.0 };
    SimulationReply::Line(SimulateReply {
        contact,
        steps: match simulation.steps {
            Steps::All => twisted(&simulation.plan).map(state).collect(),
            Steps::Last => vec![state(last.unwrap_or(false))],
        },
        stress: simulation.stress.as_ref().map(|sampling| stress_template(sampling, line.is_some())),
        residual: simulation.residual.then(residual),
        protocol: matches!(simulation.plan, Plan::EqualPeaks(_)).then(protocol),
        accuracy: Accuracy { work_error: (simulation.plan.curved() > 0).then_some(0.0), ..accuracy },
        // The stress below the surface is no output of a sweep.
        ..SimulateReply::default()
    })
}

/// Whether the contact is twisted after each move.
fn twisted(plan: &Plan) -> impl Iterator<Item = bool> {
    let mut is_twisted = matches!(plan, Plan::Twist(_) | Plan::Torque(_));
    let moves = if let Plan::Moves(moves) = plan { &moves[..] } else { &[] };
    (0..plan.length()).map(move |index| {
        if let Some(step) = moves.get(index) {
            let lifts = !step.relative && step.indentation.or(step.normal_force).is_some_and(|load| load <= 0.0);
            let shifts = step.displacement.is_some() || step.force.is_some();
            is_twisted = !lifts && !shifts && (is_twisted || step.twists());
        }
        is_twisted
    })
}

fn planar_template(simulation: &Simulation, plane: &PlanarPlan, start: &State) -> PlanarReply {
    let stress = |sampling: &StressRequest| {
        let length = sampling.length();
        let column = |field: Field| sampling.wants(field).then(|| vec![None; length]);
        PlanarStress {
            radius: vec![0.0; length],
            pressure: column(Field::Pressure),
            shear_x: column(Field::Shear),
            shear_y: column(Field::Shear),
            slip_x: column(Field::Slip),
            slip_y: column(Field::Slip),
            friction_work: column(Field::Slip),
        }
    };
    let (by_rings, turn) = (plane.line.is_none(), plane.steps_per_turn());
    let moves = simulation.plan.length();
    let state = PlanarState {
        electrical_conductance: start.electrical_conductance,
        thermal_conductance: start.thermal_conductance,
        ..PlanarState::default()
    };
    PlanarReply {
        steps: vec![state; if simulation.steps == Steps::All { moves } else { 1 }],
        stress: simulation.stress.as_ref().map(stress),
        turn_losses: turn.map(|turn| vec![0.0; moves / turn]),
        accuracy: Accuracy {
            work_error: by_rings.then_some(0.0),
            count: by_rings.then_some(0),
            steps: by_rings.then_some(0),
            ..Accuracy::default()
        },
        ..PlanarReply::default()
    }
}

fn stress_template(sampling: &StressRequest, line: bool) -> Stress {
    let length = sampling.length();
    let column = |field: Field| sampling.wants(field).then(|| vec![None; length]);
    Stress {
        radius: (!line).then(|| vec![0.0; length]),
        x: line.then(|| vec![0.0; length]),
        pressure: column(Field::Pressure),
        shear: column(Field::Shear),
        slip: column(Field::Slip),
        displacement: column(Field::Displacement),
        hoop: column(Field::Hoop),
    }
}
