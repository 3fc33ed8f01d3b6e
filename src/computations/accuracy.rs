//! `accuracy`: the time and the error of each solver on a path.

use serde_json::json;

use stickslip_wire::{AccuracyReply, AccuracyRequest, Comparison, ContactDefinition, Steps};

use super::{About, Computation, Example, Plain, Route, example};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::Format;
use crate::simulation::bytes::{SPRING_BYTES, of_moves, of_shape, of_stress};
use crate::simulation::cost::{Work, of_springs};
use crate::simulation::{self, Failure};

/// The same path with several solvers, each compared with a reference.
pub struct CompareSolvers;

impl Computation for CompareSolvers {
    const ABOUT: About = About {
        name: "accuracy",
        route: Some(Route { path: "/accuracy", operation: "compare_solvers", tag: "simulation" }),
        title: "Compare solvers",
        description: "Follows a path from the preloaded contact with each of the solvers, and compares the forces \
                      along it and the shear stresses at its end with a reference: the exact solver, refined where \
                      moves are curved. This shows what a coarser model would do to your own numbers. A solver that \
                      cannot follow the path has the reason in its row. The springs of all solvers together, times \
                      moves and stress points, have the limit of one simulation. Nothing is stored.",
        reply: "The reference, and a row a solver",
        formats: &[Format::Columns],
        printed: Format::Columns,
        shows: "",
        choice: None,
    };

    type Request = AccuracyRequest;
    type Outcome = Plain<AccuracyReply>;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "as it is",
                "A contact and a path, and the usual solvers",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"falling_amplitude": {"reversals": 20}}
                }),
            ),
            example(
                "own solvers",
                "Two spring foundations, at given radii",
                json!({
                    "contact": {
                        "profile": {"type": "cone", "slope": 0.05},
                        "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                        "friction": 0.3,
                        "preload": {"contact_radius": 1e-4}
                    },
                    "path": {"displacement": [1e-7, -1e-7, 0.0]},
                    "stress": {"radii": [2e-5, 5e-5, 8e-5], "fields": ["shear"]},
                    "solvers": ["exact", {"springs": {"count": 200}}, {"springs": {"count": 2000}}]
                }),
            ),
        ]
    }

    /// One solver at a time, and a force a move of the reference and of that.
    fn bytes(task: &Comparison) -> usize {
        of_moves(&task.plan, Steps::Last)
            + 2 * size_of::<f64>() * task.plan.length()
            + 2 * of_stress(task.sampling.length())
            + of_shape(&task.definition.profile)
            + task.springs().max().unwrap_or(0) * SPRING_BYTES
    }

    /// Each solver once, and the reference.
    fn cost(task: &Comparison) -> Nanoseconds {
        let (plan, radii) = (&task.plan, task.sampling.length());
        let exact = Work { moves: plan.length(), curved: plan.curved(), radii, ..Work::default() };
        let each = exact.cost(&task.setup.profile).saturating_mul(task.solvers.len() as u64 + 1);
        let springs = task.springs().map(|springs| of_springs(springs, task.passes()));
        springs.fold(each, Nanoseconds::saturating_add)
    }

    fn run(task: Comparison, stop: &Stop) -> Result<Plain<AccuracyReply>, Failure> {
        simulation::compare_solvers(&task, stop).map(Plain)
    }
}
