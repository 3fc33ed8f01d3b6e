//! The body of `POST /simulate` and its reply.

use serde::{Deserialize, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;

use stickslip_mechanics::{DEFAULT_TOLERANCE, range};

use super::check::{Faults, JsonPath, Rejection};
use super::definition::{ContactDefinition, DefinedProfile, SharedSetup};
use super::document::Document;
use super::limits::{SPRING_SEARCH, SPRING_STEPS, Tolerance, Whole, limits};
use super::path::{Path, Plan};
use super::prepare::Prepare;
use super::reply::{Accuracy, ContactSummary, Protocol, Residual, State, Warning};
use super::single_key::{not_null, single_key};
use super::stress::{Sampling, Stress, StressRequest};
use super::subsurface::{Subsurface, SubsurfaceRequest, SubsurfaceTask};

/// A contact and the path that it follows; the server keeps nothing of it. Only what is asked for is computed.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "path": {"falling_amplitude": {"reversals": 20}},
    "stress": {"points": 200},
    "residual": true
}))]
pub struct SimulateRequest {
    /// The contact.
    pub contact: ContactDefinition,
    /// The path.
    pub path: Path,
    /// Ask for stresses at the end of the path.
    pub stress: Option<StressRequest>,
    /// Ask for the extrema of the shear stress at the end of the path.
    #[serde(default)]
    pub residual: bool,
    /// Ask for the stress below the surface at the end of the path; by the exact solver.
    pub subsurface: Option<SubsurfaceRequest>,
    /// Which states to return.
    #[serde(default)]
    pub steps: Steps,
    /// Which solver to use; left out, the cheapest that serves the request.
    pub solver: Option<Solver>,
    /// Tolerance for what is not exact, relative to μ F_N, a pure number.
    pub tolerance: Option<f64>,
}
limits!(SimulateRequest { tolerance: Tolerance(DEFAULT_TOLERANCE) });

/// Which states of a path to return.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Steps {
    /// One state a move.
    #[default]
    All,
    /// The state after the last move alone.
    Last,
}

/// A solver: the string `"exact"`, or an object with one key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[schema(example = "exact")]
pub enum Solver {
    /// The exact solver, which stores turning points of the path.
    Exact,
    /// The spring foundation of the paper: a reference for comparison, slower and approximate. It follows a tangential
    /// force only at constant indentation, and a normal force only without a tangential target (else
    /// `unsupported_move`).
    Springs(Springs),
}
single_key!(Solver { "springs" => Springs } or { "exact" => Exact });

/// The spring foundation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({"count": 1000}))]
pub struct Springs {
    /// Number of springs across the diameter of the contact.
    pub count: usize,
}
limits!(Springs { count: Whole(range::SPRING_COUNT) });

/// The result of a simulation.
#[apply(Option => #[serde(skip_serializing_if = "Option::is_none")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SimulateReply {
    /// What follows from the definition at the preload.
    pub contact: ContactSummary,
    /// The states along the path: all of them, or the last.
    pub steps: Vec<State>,
    /// The stresses at the end, if asked for.
    pub stress: Option<Stress>,
    /// The extrema of the shear stress at the end, if asked for.
    pub residual: Option<Residual>,
    /// The stress below the surface at the end, if asked for.
    pub subsurface: Option<Subsurface>,
    /// The path, if it follows the law of equal peaks.
    pub protocol: Option<Protocol>,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// A simulation that has passed all checks.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The contact as it was sent, for the warnings.
    pub definition: ContactDefinition,
    /// The contact.
    pub setup: SharedSetup,
    /// The path.
    pub plan: Plan,
    /// The requested stresses.
    pub stress: Option<Sampling>,
    /// Whether the extrema are requested.
    pub residual: bool,
    /// The requested stress below the surface.
    pub subsurface: Option<SubsurfaceTask>,
    /// Which states are requested.
    pub steps: Steps,
    /// The requested solver.
    pub solver: Option<Solver>,
    /// The tolerance for what is not exact.
    pub tolerance: f64,
}

impl Document for SimulateRequest {
    type Checked = Simulation;

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn check_with(self, profiles: &dyn Prepare) -> Result<Simulation, Rejection> {
        let mut faults = Faults::default();
        let setup = self.contact.check(JsonPath::Root.member("contact"), profiles, &mut faults);
        let plan = self.path.check(JsonPath::Root.member("path"), &mut faults);
        let stress = self.stress.and_then(|stress| stress.check(JsonPath::Root.member("stress"), &mut faults));
        let at = JsonPath::Root.member("subsurface");
        let subsurface = self.subsurface.and_then(|asked| asked.at(&self.contact, at, &mut faults));
        if subsurface.is_some() && matches!(self.solver, Some(Solver::Springs(_))) {
            faults.add(at, "springs have no stress below the surface: leave this or `solver` out");
        }
        let needing = [("stress", stress.is_some()), ("residual", self.residual), ("subsurface", subsurface.is_some())];
        for (name, _) in needing.into_iter().filter(|(_, asked)| *asked) {
            faults.needs_stress_field(setup.as_ref(), JsonPath::Root.member(name));
        }
        let tolerance = Tolerance(DEFAULT_TOLERANCE).of(self.tolerance, &mut faults);
        let no_surface = setup.as_ref().is_some_and(|setup| !setup.profile.has_stress_field());
        if matches!(self.solver, Some(Solver::Springs(_))) && no_surface {
            let detail = "springs stand under a surface, which this profile has not: leave `solver` out";
            faults.add(JsonPath::Root.member("solver"), detail);
        }
        if let Some(solver) = &self.solver {
            let search = if self.residual { SPRING_SEARCH } else { 0 };
            let moves = plan.as_ref().map_or(0, Plan::length);
            let radii = stress.as_ref().map_or(0, Sampling::length);
            let passes = moves.saturating_add(radii).saturating_add(search);
            solver.check(JsonPath::Root.member("solver"), passes, &mut faults);
        }
        let (definition, residual, steps, solver) = (self.contact, self.residual, self.steps, self.solver);
        let simulation = |(setup, plan)| Simulation {
            definition,
            setup,
            plan,
            stress,
            residual,
            subsurface,
            steps,
            solver,
            tolerance,
        };
        faults.done(setup.zip(plan).map(simulation))
    }
}

impl Solver {
    /// Notes the faults of the solver at `at`, each of whose springs is evaluated `passes` times.
    pub(super) fn check(&self, at: JsonPath<'_>, passes: usize, faults: &mut Faults) {
        let Solver::Springs(springs) = self else { return };
        let at = at.member("springs");
        springs.check_members(at, faults);
        let (count, most) = (springs.count, most_springs(passes));
        if count > most {
            faults.add(
                at.member("count"),
                format_args!("{count} springs over {passes} moves and radii: allowed are {most}"),
            );
        }
    }
}

/// How many springs may be evaluated `passes` times each.
pub(super) fn most_springs(passes: usize) -> usize {
    SPRING_STEPS.checked_div(passes).unwrap_or(SPRING_STEPS)
}
