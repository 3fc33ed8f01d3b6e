//! The body of `POST /accuracy` and its reply.

use super::path::TimedSimulatedPath;
use super::simulate::{Rings, SPRINGS, SimulateRequest, Solver, Springs, in_plane, most_springs};
use crate::prelude::*;

/// Solvers that one comparison may name.
const SOLVERS: Items = Items(1..=16);
/// Springs that are compared unless the request names its solvers.
const SPRING_LADDER: [usize; 4] = [10, 100, 1_000, 10_000];
/// Rings that are compared on a path in the plane unless the request names its solvers.
const RING_LADDER: [usize; 4] = [10, 20, 40, 80];
/// Radii at which stresses are compared unless the request names some.
const COMPARED_RADII: usize = 200;

requests! {
/// A contact, the path that it follows, and the solvers to compare on it. Nothing is stored.
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "path": {"falling_amplitude": {"reversals": 20}}
}))]
pub struct AccuracyRequest {
    /// The contact.
    pub contact: ContactDefinition,
    /// The path, along a line or in the plane.
    pub path: TimedSimulatedPath,
    /// Where the shear stress at the end of the path is compared; if left out, at 200 radii evenly spaced from the
    /// centre to the edge. `fields`, if given, must include `shear`; only the shear stress is compared.
    pub stress: Option<StressRequest>,
    /// The solvers, in the order of the rows; if left out, the exact one and 10, 100, 1000 and 10 000 springs. In the
    /// plane only rings; if left out, 10, 20, 40 and 80.
    pub solvers: Option<Vec<Solver>> = SOLVERS,
    /// Tolerance of results that are not exact, relative to μ F_N, a pure number. The reference is computed to a
    /// sixteenth of this. In the plane it determines the steps and is at least 1e-5; if left out, 1e-3.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
}
}

replies! {
/// The time and the error of each solver.
pub struct AccuracyReply {
    /// The solution that the rows are compared with.
    pub reference: Reference,
    /// One row for each solver.
    pub rows: Vec<AccuracyRow>,
}

/// The solution that errors are measured from, with its own error.
pub struct Reference {
    /// The solver.
    pub solver: SolverKind,
    /// Why this solution serves as the reference.
    pub reason: String,
    /// Its own estimated error of the forces, relative to `force_unit`, a pure number: smaller
    /// differences have no meaning.
    pub force_error: f64,
    /// Its own estimated error of the stresses, relative to `stress_unit`, a pure number.
    pub stress_error: f64,
    /// Time spent on it, s.
    pub compute_time: f64,
    /// The unit of force errors: the largest friction limit μ F_N along the path, N.
    pub force_unit: f64,
    /// The unit of stress errors: μ times the largest pressure at the end of the path (or, where that is infinite, the
    /// mean), Pa.
    pub stress_unit: f64,
    /// How many radii are compared: those where the stress of the reference is finite.
    pub radii: usize,
}

/// One solver on the path.
pub struct AccuracyRow omits Option {
    /// The solver.
    pub solver: Solver,
    /// Largest difference of the force from that of the reference, over all moves, relative to `force_unit`, a pure
    /// number; `null` without a result, or where it is infinite.
    #[serde_with(skip_apply)]
    pub force_error: Option<f64>,
    /// Largest difference of the shear stress at the end, over the radii, relative to `stress_unit`, a pure number;
    /// `null` without a result, or where it is infinite.
    #[serde_with(skip_apply)]
    pub stress_error: Option<f64>,
    /// Error of the force over all moves as the solver estimates it, relative to the friction limit μ F_N, a pure
    /// number; `null` without a result, or where it is infinite.
    #[serde_with(skip_apply)]
    pub estimated_force_error: Option<f64>,
    /// Error of the stress at the end as the solver estimates it, relative to `stress_unit`, a pure number: the
    /// largest over the contact, for springs without the cells near a singular radius of the profile; `null` without a
    /// result, or where it is infinite.
    #[serde_with(skip_apply)]
    pub estimated_stress_error: Option<f64>,
    /// Steps of the finest discretisation, of rings in the plane.
    pub steps: Option<usize>,
    /// Difference of the friction work from that of the reference at the end of a path in the plane, over `force_unit`
    /// times the displacement of gross slip, a pure number.
    pub work_error: Option<f64>,
    /// Time spent computing, s: the median of a few runs if one takes less than a few milliseconds.
    pub compute_time: f64,
    /// Why this solver has no result: the move that it cannot follow. Left out if there is a result.
    pub refused: Option<Fault>,
}
}

/// A comparison that has passed all checks.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The contact as it was sent.
    pub definition: ContactDefinition,
    /// The contact.
    pub setup: SharedSetup,
    /// The path.
    pub plan: Plan,
    /// Where the shear stress is compared; no other field is.
    pub sampling: StressRequest,
    /// The solvers.
    pub solvers: Vec<Solver>,
    /// The tolerance of results that are not exact.
    pub tolerance: f64,
}

impl Comparison {
    /// Moves and radii: how often each spring is evaluated.
    pub fn passes(&self) -> usize {
        self.plan.length().saturating_add(self.sampling.length())
    }

    /// The rings of each solver that has any.
    pub fn rings(&self) -> impl Iterator<Item = usize> + '_ {
        self.solvers.iter().filter_map(|solver| match solver {
            Solver::Rings(rings) => Some(rings.count),
            Solver::Exact | Solver::Springs(_) => None,
        })
    }

    /// The springs of each solver that has any.
    pub fn springs(&self) -> impl Iterator<Item = usize> + '_ {
        self.solvers.iter().filter_map(|solver| match solver {
            Solver::Springs(springs) => Some(springs.count),
            Solver::Exact | Solver::Rings(_) => None,
        })
    }
}

/// The exact solver, and springs in powers of ten; in the plane rings.
fn ladder(in_plane: bool) -> Vec<Solver> {
    if in_plane {
        return RING_LADDER.map(|count| Solver::Rings(Rings { count })).into();
    }
    let springs = SPRING_LADDER.map(|count| Solver::Springs(Springs { count }));
    std::iter::once(Solver::Exact).chain(springs).collect()
}

/// A path in the plane that leads along one line as moves along it, which all solvers follow.
fn along_its_line(plan: Plan) -> Plan {
    match &plan {
        Plan::Plane(plane) => plane.line.map(|direction| Plan::Moves(plane.along(direction))).unwrap_or(plan),
        _ => plan,
    }
}

impl Document for AccuracyRequest {
    type Checked = Comparison;

    /// As of a simulation.
    const PARSED: usize = SimulateRequest::PARSED;

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let setup = self.contact.check(JsonPath::Root.member("contact"), profiles, faults);
        // Stresses are always compared.
        faults.needs_stress_field(setup.as_ref(), JsonPath::Root.member("contact").member("profile"));
        faults.needs_round_contact(setup.as_ref(), JsonPath::Root.member("contact").member("profile"), SPRINGS);
        let plan = self.path.check(false, JsonPath::Root.member("path"), faults).map(along_its_line);
        let plane = if let Some(Plan::Plane(plane)) = &plan { Some(plane) } else { None };
        if let Some(Plan::Timed(..)) = &plan {
            faults.unanswerable(JsonPath::Root.member("path").member("duration"), Error::NoMemory);
        }
        if plan.as_ref().is_some_and(Plan::twists) {
            faults
                .add(JsonPath::Root.member("path"), "solvers are compared on paths along the surface, without a twist");
        }
        let stress = self.stress.unwrap_or_else(|| StressRequest {
            points: Some(COMPARED_RADII),
            fields: Some(vec![Field::Shear]),
            ..StressRequest::default()
        });
        let at = JsonPath::Root.member("stress");
        let sampling = stress.checked(at, faults);
        if sampling.as_ref().is_some_and(|sampling| !sampling.wants(Field::Shear)) {
            faults.add(at.member("fields"), "only the shear stress is compared: include `shear`");
        }
        let mut tolerance = self.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let at = JsonPath::Root.member("solvers");
        let solvers = self.solvers.unwrap_or_else(|| ladder(plane.is_some()));
        if plane.is_some() {
            tolerance = in_plane(self.tolerance, faults);
            let others = solvers.iter().enumerate().filter(|(_, solver)| !matches!(solver, Solver::Rings(_)));
            others.for_each(|(index, _)| {
                faults.add(at.index(index), "follows no motion in the plane: name rings, or leave `solvers` out");
            });
        }
        let radii = sampling.as_ref().map_or(0, StressRequest::length);
        let passes = plan.as_ref().map_or(0, Plan::length).saturating_add(radii);
        solvers.iter().enumerate().for_each(|(index, solver)| solver.check(at.index(index), passes, faults));
        let comparison = setup.zip(plan).zip(sampling).map(|((setup, plan), sampling)| {
            let definition = self.contact;
            Comparison { definition, setup, plan, sampling, solvers, tolerance }
        });
        if let Some(comparison) = &comparison {
            let (all, most) = (comparison.springs().fold(0, usize::saturating_add), most_springs(passes));
            if faults.is_empty() && all > most {
                faults.add(at, format_args!("{all} springs in all over {passes} moves and radii: allowed are {most}"));
            }
        }
        comparison
    }
}
