//! The body of `POST /simulate` and its reply.

use super::definition::member_of_law;
use super::limits::{SPRING_SEARCH, SPRING_STEPS};
use super::path::TimedSimulatedPath;
use super::plane::PlanarPlan;
use super::subsurface::{Subsurface, SubsurfaceRequest, SubsurfaceTask};
use crate::prelude::*;

/// The tolerance of rings, unless the request names one.
const RINGS_TOLERANCE: f64 = 1e-3;
/// The smallest tolerance that rings are asked for: they are at most 160, and the steps of a thousandth of gross slip.
pub const LEAST_RINGS_TOLERANCE: f64 = 1e-5;

requests! {
/// A contact and the path that it follows. Nothing is stored. Only what is asked for is computed.
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
    pub path: TimedSimulatedPath,
    /// Ask for stresses at the end of the path.
    pub stress: Option<StressRequest>,
    /// Ask for the extrema of the shear stress at the end of the path.
    #[serde(default)]
    pub residual: bool,
    /// Ask for the stress below the surface at the end of the path; only with the exact solver.
    pub subsurface: Option<SubsurfaceRequest>,
    /// Which states to return.
    #[serde(default)]
    pub steps: Steps,
    /// The solver to use; if left out, the cheapest that can serve the request.
    pub solver: Option<Solver>,
    /// Tolerance of results that are not exact, relative to μ F_N, a pure number. For rings it is at least 1e-5 and, if
    /// left out, 1e-3.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
}

/// Rings of constant traction, for motion in the plane.
#[schema(example = json!({"count": 40}))]
pub struct Rings: Copy, Eq {
    /// Number of rings across the radius of the largest contact.
    pub count: usize = range::RING_COUNT,
}

/// The spring foundation.
#[schema(example = json!({"count": 1000}))]
pub struct Springs: Copy, Eq {
    /// Number of springs across the diameter of the contact.
    pub count: usize = range::SPRING_COUNT,
}
}

words! {
/// Which states of a path to return.
pub enum Steps: Default {
    /// One state for each move.
    #[default]
    All = "all",
    /// Only the state after the last move.
    Last = "last",
}
}

choices! {
/// A solver: the string `"exact"`, or an object with one key.
#[schema(example = "exact")]
pub enum Solver: Copy, Eq {
    words {
        /// The exact solver, which stores turning points of the path.
        Exact = "exact",
    }
    /// The spring foundation of the paper: a reference for comparison, slower and approximate. It follows a tangential
    /// force only at constant indentation, and a normal force only without a tangential target (else
    /// `unsupported_move`).
    "springs" => Springs(Springs),
    /// Rings: the approximate solver for motion in the plane, which also follows motion along a line. Without a number,
    /// a path with pairs that leaves its first line is followed by as many rings as the tolerance needs.
    "rings" => Rings(Rings),
}
}

replies! {
/// The result of a simulation.
pub struct SimulateReply: Default omits Option {
    /// Quantities that follow from the definition at the preload.
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
}

/// A simulation that has passed all checks.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The contact as it was sent, for the warnings.
    pub definition: ContactDefinition,
    /// The contact.
    pub setup: FrictionSetup,
    /// The path.
    pub plan: Plan,
    /// The requested stresses.
    pub stress: Option<StressRequest>,
    /// Whether the extrema are requested.
    pub residual: bool,
    /// The requested stress below the surface.
    pub subsurface: Option<SubsurfaceTask>,
    /// Which states are requested.
    pub steps: Steps,
    /// The requested solver.
    pub solver: Option<Solver>,
    /// The tolerance of results that are not exact.
    pub tolerance: f64,
    /// The tolerance that the request names, to which the stated error of springs is held.
    pub asked_tolerance: Option<f64>,
}

impl Document for SimulateRequest {
    type Checked = Simulation;

    /// `{}` and a comma become a move that may have pairs, which is 35 bytes for each of theirs.
    const PARSED: usize = 48;

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let setup = self.contact.check_any(JsonPath::Root.member("contact"), profiles, faults);
        let rings = matches!(self.solver, Some(Solver::Rings(_)));
        let plan = self.path.check(rings, JsonPath::Root.member("path"), faults);
        let stress = self.stress.and_then(|stress| stress.checked(JsonPath::Root.member("stress"), faults));
        let at = JsonPath::Root.member("subsurface");
        let subsurface = self.subsurface.and_then(|asked| asked.at(&self.contact, at, faults));
        if subsurface.is_some() && matches!(self.solver, Some(Solver::Springs(_))) {
            faults.add(at, "springs have no stress below the surface: leave this or `solver` out");
        }
        let needing = [("stress", stress.is_some()), ("residual", self.residual), ("subsurface", subsurface.is_some())];
        for (name, _) in needing.into_iter().filter(|(_, asked)| *asked) {
            faults.needs_stress_field(setup.as_ref(), JsonPath::Root.member(name));
        }
        let asked_tolerance = self.tolerance;
        let mut tolerance = asked_tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let memory = setup.as_ref().is_some_and(|setup| setup.friction.memory.is_some());
        let law = match (&plan, &self.solver) {
            (Some(Plan::Plane(_)), _) | (_, Some(Solver::Rings(_))) => Some("motion in the plane"),
            (_, Some(Solver::Springs(_))) => Some("the spring foundation"),
            (Some(Plan::EqualPeaks(_)), _) => Some("`equal_peaks`"),
            _ if subsurface.is_some() => Some("`subsurface`"),
            _ if memory && stress.is_some() => Some("`stress`"),
            _ if memory && self.residual => Some("`residual`"),
            _ => None,
        };
        if let Some((what, setup)) = law.zip(setup.clone())
            && let Err(error) = setup.coulomb(what)
        {
            faults.unanswerable(JsonPath::Root.member("contact").member(member_of_law(&error)), error);
        }
        let hoop = stress.as_ref().is_some_and(|stress| stress.wants(Field::Hoop));
        if hoop && !plan.as_ref().is_some_and(Plan::twists) {
            faults.add(
                JsonPath::Root.member("stress").member("fields"),
                "`hoop` is the stress of a contact that is twisted: leave it out",
            );
        }
        if let Some(Plan::Plane(plane)) = &plan {
            faults.needs_stress_field(setup.as_ref(), JsonPath::Pointer(&plane.first_pair()));
            faults.needs_round_contact(setup.as_ref(), JsonPath::Pointer(&plane.first_pair()), "motion in the plane");
            check_in_plane(&needing[1..], stress.as_ref(), self.solver, plane, faults);
            if plane.line.is_none() {
                tolerance = in_plane(self.tolerance, faults);
            }
        }
        let no_surface = setup.as_ref().is_some_and(|setup| !setup.profile.has_stress_field());
        if matches!(self.solver, Some(Solver::Springs(_))) && no_surface {
            let detail = "springs need a profile with a stress field: leave `solver` out";
            faults.add(JsonPath::Root.member("solver"), detail);
        }
        if matches!(self.solver, Some(Solver::Springs(_))) {
            faults.needs_round_contact(setup.as_ref(), JsonPath::Root.member("solver"), SPRINGS);
        }
        if let Some(solver) = &self.solver {
            let search = if self.residual { SPRING_SEARCH } else { 0 };
            let moves = plan.as_ref().map_or(0, Plan::length);
            let radii = stress.as_ref().map_or(0, StressRequest::length);
            let passes = moves.saturating_add(radii).saturating_add(search);
            solver.check(JsonPath::Root.member("solver"), passes, faults);
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
            asked_tolerance,
        };
        setup.zip(plan).map(simulation)
    }
}

/// Notes requested results that are not defined in the plane.
fn check_in_plane(
    asked: &[(&'static str, bool)],
    stress: Option<&StressRequest>,
    solver: Option<Solver>,
    plane: &PlanarPlan,
    faults: &mut Faults,
) {
    for (name, _) in asked.iter().filter(|(_, asked)| *asked) {
        let detail = format_args!("`{name}` is not defined for motion in the plane: leave it or the pairs out");
        faults.add(JsonPath::Root.member(name), detail);
    }
    if stress.is_some_and(|stress| stress.wants(Field::Displacement)) {
        let at = JsonPath::Root.member("stress");
        faults.add(at.member("fields"), "`displacement` is not computed for motion in the plane: ask for `slip`");
    }
    let detail = match solver {
        Some(Solver::Springs(_)) => "springs do not follow motion in the plane: leave `solver` out, or ask for rings",
        Some(Solver::Exact) if plane.line.is_none() => {
            "the exact solver follows motion along one line only: leave `solver` out, or ask for rings"
        }
        _ => return,
    };
    faults.add(JsonPath::Root.member("solver"), detail);
}

/// The tolerance of rings.
pub(super) fn in_plane(asked: Option<f64>, faults: &mut Faults) -> f64 {
    let tolerance = asked.unwrap_or(RINGS_TOLERANCE);
    if tolerance < LEAST_RINGS_TOLERANCE {
        let at = JsonPath::Root.member("tolerance");
        faults.add(at, format_args!("{tolerance:e} is out of range for motion in the plane: allowed is 1e-5 to 1e-2"));
    }
    tolerance
}

impl Solver {
    /// Notes the faults of the solver at `at`, each of whose springs is evaluated `passes` times.
    pub(super) fn check(&self, at: JsonPath<'_>, passes: usize, faults: &mut Faults) {
        let (Solver::Springs(Springs { count }), most) = (self, most_springs(passes)) else { return };
        if *count > most {
            let detail = format_args!("{count} springs over {passes} moves and radii: allowed are {most}");
            faults.add(at.member("springs").member("count"), detail);
        }
    }
}

/// The name of springs in refusals.
pub(super) const SPRINGS: &str = "the spring foundation";

/// How many springs may be evaluated `passes` times each.
pub(super) fn most_springs(passes: usize) -> usize {
    SPRING_STEPS.checked_div(passes).unwrap_or(SPRING_STEPS)
}
