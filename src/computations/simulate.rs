//! `simulate`: the states and stresses of a contact along a path.

use serde_json::json;

use stickslip_wire::simulate::Simulation;
use stickslip_wire::{ContactDefinition, SimulateReply, SimulateRequest};

use super::{About, Computation, Example, Plain, Route, example};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::Format;
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
        formats: &[Format::Columns],
        printed: Format::Columns,
        shows: "",
        choice: None,
    };

    type Request = SimulateRequest;
    type Outcome = Plain<SimulateReply>;

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
                    "contact": {
                        "profile": {"type": "sphere", "radius": 0.01},
                        "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                        "friction": 0.3,
                        "preload": {"indentation": 1e-6}
                    },
                    "path": {"force": [0.5, -0.5, 0.5]}, "steps": "last", "solver": "exact"
                }),
            ),
            example(
                "springs",
                "The same contact on the paper's spring foundation",
                json!({
                    "contact": {
                        "profile": {"type": "sphere", "radius": 0.01},
                        "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                        "friction": 0.3,
                        "preload": {"contact_radius": 1e-4}
                    },
                    "path": {"moves": [{"displacement": 1e-7}, {"indentation": 8e-7, "displacement": 0.0}]},
                    "solver": {"springs": {"count": 1000}}
                }),
            ),
        ]
    }

    fn bytes(task: &Simulation) -> usize {
        bytes::of_simulation(task)
    }

    fn cost(task: &Simulation) -> Nanoseconds {
        cost::of_simulation(task)
    }

    fn run(task: Simulation, stop: &Stop) -> Result<Plain<SimulateReply>, Failure> {
        Ok(Plain { reply: simulation::simulate(&task, stop)?, length: bytes::reply_length(&task) })
    }
}
