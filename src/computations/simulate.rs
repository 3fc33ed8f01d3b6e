//! `simulate`: the states and stresses of a contact along a path.

use serde_json::json;

use stickslip_report::plot::Drawing;
use stickslip_wire::simulate::Simulation;
use stickslip_wire::{ContactDefinition, Fault, Sampling, SimulateReply, SimulateRequest};

use super::{About, Computation, Example, Outcome, Route, Shown, example, example_contact, simulate_table};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::Table;
use crate::simulation::{self, Failure, bytes, cost};

/// The states of a contact along a path, and the stresses at its end.
pub struct Simulate;

impl Computation for Simulate {
    const ABOUT: About = About {
        name: "simulate",
        route: Some(Route { path: "/simulate", operation: "simulate_path", tag: "simulation" }),
        title: "Simulate a path",
        description: "Follows a path from the preloaded contact and returns the states along it, and the stresses \
                      and their extrema at its end if asked for. Nothing is stored, so that a repeated request \
                      simply runs again.",
        reply: "States, and what else was asked for",
        shows: "All but `columns` show one part of the document: the residual stress if it is asked for, a row for \
                each extremum; else the stresses over the radius; else the states along the path. `show` names \
                another.",
        choice: Some(simulate_table::SHOW),
        ..About::TABLE
    };

    type Request = SimulateRequest;
    type Outcome = Simulated;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "back and forth",
                "Falling amplitude, with the residual stresses",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"falling_amplitude": {"reversals": 20}},
                    "stress": {"points": 200}, "residual": true
                }),
            ),
            example(
                "by force",
                "A cycle of the tangential force, the last state alone",
                json!({
                    "contact": example_contact(json!({"type": "sphere", "radius": 0.01}), json!({"indentation": 1e-6})),
                    "path": {"force": [0.5, -0.5, 0.5]}, "steps": "last", "solver": "exact"
                }),
            ),
            example(
                "springs",
                "The same contact on the paper's spring foundation",
                json!({
                    "contact": example_contact(json!({"type": "sphere", "radius": 0.01}), json!({"contact_radius": 1e-4})),
                    "path": {"moves": [{"displacement": 1e-7}, {"indentation": 8e-7, "displacement": 0.0}]},
                    "solver": {"springs": {"count": 1000}}
                }),
            ),
        ]
    }

    fn check_shown(task: &Simulation, shown: &Shown) -> Result<(), Fault> {
        simulate_table::check(task, shown)
    }

    fn bytes(task: &Simulation) -> usize {
        bytes::of_simulation(task)
    }

    fn rows(task: &Simulation) -> (usize, usize) {
        let radii = task.stress.as_ref().map_or(0, Sampling::length);
        ((2 * task.plan.length()).max(radii), bytes::STATE_BYTES)
    }

    fn cost(task: &Simulation) -> Nanoseconds {
        cost::of_simulation(task)
    }

    fn run(task: Simulation, stop: &Stop) -> Result<Simulated, Failure> {
        Ok(Simulated { reply: simulation::simulate(&task, stop)?, length: bytes::reply_length(&task) })
    }
}

/// The states and stresses.
pub struct Simulated {
    reply: SimulateReply,
    /// About how long it is as JSON, bytes.
    length: usize,
}

impl Outcome for Simulated {
    type Reply = SimulateReply;

    fn reply(&self) -> &SimulateReply {
        &self.reply
    }

    fn length(&self) -> usize {
        self.length
    }

    fn table(&self, shown: &Shown) -> Option<Table<'_>> {
        simulate_table::table(&self.reply, shown)
    }

    fn picture(&self, shown: &Shown) -> Option<Drawing> {
        simulate_table::plot(&self.reply, shown).map(Drawing::Plot)
    }
}
