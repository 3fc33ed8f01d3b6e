//! From a checked request to a reply.

use std::sync::Arc;
use std::time::Duration;

use stickslip_mechanics as mechanics;
use stickslip_mechanics::range::Quantity;
use stickslip_mechanics::{Law, Preload, Setup, Springs, protocol, springs};

use super::stress_below::subsurface;
use super::warnings::{FarMove, annulus_warning, bulk_warning, stress_warning, warnings_at};
use crate::LONGEST_WORK;
use crate::prelude::*;

/// The reason for a solver that the request names.
const AS_ASKED: &str = "as asked for";
/// The reason for springs where the bodies have memory.
const WITH_MEMORY: &str = "bodies with memory have no slip history: springs with memory step the path";
/// The reason for springs where the load has changed under a twist.
const WITH_TWIST: &str = "a load that changes under a twist changes its limit unevenly: springs of twist step the path";
/// The reason for the exact solver where rings are asked for.
const ALONG_ONE_LINE: &str =
    "in place of the rings asked for: all moves lead along one line, which has an exact solution";

/// Runs a simulation.
///
/// # Errors
/// [`Failure`] if the mechanics has no answer to it, or the client hung up.
pub fn simulate(simulation: &Simulation, stop: &dyn Stop) -> Result<SimulateReply, Failure> {
    let timer = Timer::start(stop);
    if let Some(wire::Solver::Springs(wire::Springs { count })) = simulation.solver {
        let setup = coulomb(&simulation.setup, "the spring foundation")?;
        let springs = spring_foundation(&setup, &simulation.plan, count, stop)?;
        return run(springs, simulation, timer, AS_ASKED, stop);
    }
    simulate_on(contact(simulation.setup.clone(), "/contact")?, simulation, timer, stop)
}

/// The reason for the solver that a contact has come to, or `usual`.
pub fn reason_for<'a>(contact: &Contact, usual: &'a str) -> &'a str {
    match contact.count_and_steps() {
        Some(_) if contact.has_memory() => WITH_MEMORY,
        Some(_) => WITH_TWIST,
        None => usual,
    }
}

/// Runs a simulation with the exact solver on a virgin contact, in place of the one that the simulation defines.
///
/// # Errors
/// As [`simulate`].
pub(super) fn simulate_on(
    contact: Contact,
    simulation: &Simulation,
    timer: Timer<'_>,
    stop: &dyn Stop,
) -> Result<SimulateReply, Failure> {
    let reason = match (simulation.solver, simulation.plan.curved()) {
        (Some(wire::Solver::Rings(_)), _) => ALONG_ONE_LINE,
        (Some(_), _) => AS_ASKED,
        (None, 0) => "every move of this path has an exact solution, which is also the cheapest",
        (None, _) => "only this solver follows moves straight in a force under changing load, to the tolerance",
    };
    run(contact, simulation, timer, reason, stop)
}

/// The reply of one solver. Nothing is computed that the simulation does not request.
pub(super) fn run<S: Solver>(
    mut solver: S,
    simulation: &Simulation,
    timer: Timer<'_>,
    reason: &str,
    stop: &dyn Stop,
) -> Result<SimulateReply, Failure> {
    let mut summary = solver.exact().initial_summary();
    // Of a load curve this alone is known of twist.
    if simulation.plan.twists() || matches!(solver.exact().profile(), Profile::LoadCurve(_)) {
        summary.gross_slip_torque = solver.exact().gross_slip_torque();
    }
    let protocol = equal_peaks(&simulation.plan, &solver)?;
    let mut largest = summary.contact_radius;
    let all = simulation.steps == Steps::All;
    let mut steps: Vec<State> = Vec::with_capacity(if all { simulation.plan.length() } else { 1 });
    // Gross slip erases the error of a curved path, but not that of the states before it.
    let (curved, mut path_error) = (simulation.plan.curved(), 0.0f64);
    // mu F_N times the displacement of gross slip, at the largest load.
    let slip_work = |solver: &S| {
        let contact = solver.exact();
        contact.friction() * contact.normal_force() * contact.gross_slip_displacement()
    };
    let (mut most_work, mut by_springs) = (slip_work(&solver), false);
    let mut far = FarMove::from(&solver);
    follow(&mut solver, &simulation.plan, protocol.as_ref(), simulation.tolerance, stop, |_, solver| {
        largest = largest.max(solver.contact_radius());
        far.reach(solver);
        if curved > 0 {
            most_work = most_work.max(slip_work(solver));
            by_springs |= solver.exact().count_and_steps().is_some();
            path_error = if all { path_error.max(solver.path_error()) } else { path_error };
        }
        if all {
            steps.push(solver.state().into());
        }
    })?;
    if !all {
        steps.push(solver.state().into());
    }
    if simulation.residual {
        check_search(solver.exact().profile(), solver.depth(), stop)?;
    }
    let stress = simulation.stress.as_ref().map(|sampling| stresses(&solver, sampling, stop)).transpose()?;
    let residual = simulation.residual.then(|| residual(&solver, stop)).transpose()?;
    let below = simulation.subsurface.as_ref().filter(|_| S::KIND == SolverKind::Exact);
    let below = below.map(|task| subsurface(solver.exact(), task, stop)).transpose()?;
    let (subsurface, subsurface_error) = below.unzip();
    let reason = reason_for(solver.exact(), reason);
    let mut accuracy = Accuracy { subsurface_error, ..accuracy(&solver, timer, reason) };
    stop.check()?;
    let path_error = path_error.max(solver.path_error());
    accuracy.force_error += path_error - solver.path_error();
    // The work of springs has no stated error.
    let by_curves = curved > 0 && S::KIND == SolverKind::Exact && !by_springs;
    accuracy.work_error = (by_curves && most_work > 0.0).then(|| solver.exact().work_error() / most_work);
    // A table, which may have noise, has no vertical edge.
    let indentation = summary.indentation.max(solver.exact().indenter().level_at_edge(largest));
    let of_springs = excess_error_of_springs(solver.exact(), accuracy.force_error, simulation.asked_tolerance);
    let excess = excess_error(path_error, solver.exact().tolerance(simulation.tolerance), curved).or(of_springs);
    Ok(SimulateReply {
        contact: summary.into(),
        steps,
        stress,
        residual,
        subsurface,
        protocol,
        warnings: warnings_at(solver.exact(), largest, indentation, excess)
            .into_iter()
            .chain(stress_warning(simulation.stress.is_some() || simulation.residual, accuracy.stress_error))
            .chain(bulk_warning(simulation.subsurface.as_ref().is_some_and(|task| task.bulk.is_some())))
            .chain(far.warning())
            .chain(annulus_warning(false, solver.exact()))
            .collect(),
        accuracy,
    })
}

/// The exact contact of a definition, which is at the JSON pointer `base` of the body.
///
/// # Errors
/// [`Cause::Refused`] if the preload cannot be reached.
pub fn contact<F: Into<Law>>(setup: Setup<Arc<Profile>, F>, base: &str) -> Result<Contact, Failure> {
    let refused = refused_at(base, setup.preload);
    Contact::new(setup).map_err(refused)
}

/// The definition at `/contact` for what knows Coulomb's law alone; `what` names it.
///
/// # Errors
/// [`Cause::Refused`] if there is a shear strength or adhesion.
pub fn coulomb(setup: &FrictionSetup, what: &'static str) -> Result<SharedSetup, Failure> {
    setup.clone().coulomb(what).map_err(refused_at("/contact", setup.preload))
}

/// A foundation of this many springs, as wide as the path needs.
///
/// # Errors
/// As [`contact()`], for a definition at `/contact`, and if the work was ended.
pub fn spring_foundation(setup: &SharedSetup, plan: &Plan, count: usize, stop: &dyn Stop) -> Result<Springs, Failure> {
    let start = contact(setup.clone(), "/contact")?;
    let go_on = || stop.check().is_ok();
    // Only what has a normal target reaches further, and the law of equal peaks has none.
    let moves = moves(plan, &start, None)?.take_while(|_| go_on()).map(|(_, step)| step);
    let springs = springs::largest_contact_radius(setup, moves)
        .and_then(|reach| Springs::new_while(setup.clone(), count, reach, &go_on));
    springs.map_err(|error| refused_at("/contact", setup.preload)(error).unless_interrupted(stop, ""))
}

/// What the mechanics refuses of a definition at the JSON pointer `base`, whose preload this is.
pub fn refused_at(base: &str, preload: Preload) -> impl Fn(mechanics::Error) -> Failure {
    move |error| {
        let place_of = |quantity| ContactDefinition::place_of(quantity, &preload);
        let place = match error {
            mechanics::Error::NotConvexEnough { .. } => "/profile",
            mechanics::Error::BeyondProfile { .. } => place_of(Quantity::ContactRadius),
            mechanics::Error::BeyondReferenceLength { .. } => "/profile/reference_length",
            mechanics::Error::BulkTooLarge { .. } => "/bulk/stress_per_force",
            mechanics::Error::Viscoelastic(_) => "/prony",
            mechanics::Error::ShearStrength(_)
            | mechanics::Error::LineContact(_)
            | mechanics::Error::NoStressField { .. } => "/shear_strength",
            mechanics::Error::Adhesive(_) => "/adhesion",
            mechanics::Error::FrictionWithAdhesion => "/friction",
            _ => quantity(&error).map_or("", place_of),
        };
        Failure::at(format!("{base}{place}"), error)
    }
}

/// The displacements of a plan that follows the law of equal peaks, for the contact in its present state.
///
/// # Errors
/// [`Cause::Refused`] for a cut-off radius that the contact does not allow.
pub fn equal_peaks<S: Solver>(plan: &Plan, solver: &S) -> Result<Option<Protocol>, Failure> {
    let Plan::EqualPeaks(peaks) = plan else { return Ok(None) };
    let protocol::EqualPeaks { displacements, cutoff_radius } = solver
        .equal_peaks(peaks.reversals, peaks.cutoff_radius)
        .map_err(|error| Failure::at(plan.place_of(0, quantity(&error)), error))?;
    Ok(Some(Protocol { displacement: displacements, cutoff_radius }))
}

/// The moves of a plan for this contact at their beginning; `protocol` is the result of [`equal_peaks`] for it.
///
/// # Errors
/// [`Cause::Refused`] if the load would fall below zero.
fn moves<'a>(
    plan: &'a Plan,
    contact: &Contact,
    protocol: Option<&'a Protocol>,
) -> Result<Box<dyn Iterator<Item = (Move, mechanics::Move)> + Send + 'a>, Failure> {
    let moves: Box<dyn Iterator<Item = Move> + Send + 'a> = match plan {
        Plan::Timed(plan, duration) => {
            let take = |(step, _): (Move, mechanics::Move)| {
                let step = Move { duration: Some(step.duration.unwrap_or(*duration)), ..step };
                (step, step.step())
            };
            return Ok(Box::new(moves(plan, contact, protocol)?.map(take)));
        }
        Plan::Moves(moves) => Box::new(moves.iter().copied()),
        Plan::Displacement(targets) => Box::new(targets.iter().map(|target| Move::displacement(*target))),
        Plan::Force(targets) => Box::new(targets.iter().map(|target| Move::force(*target))),
        Plan::Twist(targets) => Box::new(targets.iter().map(|target| Move::twist(*target))),
        Plan::Torque(targets) => Box::new(targets.iter().map(|target| Move::torque(*target))),
        Plan::FallingAmplitude(fall) => {
            let amplitude = fall.amplitude.unwrap_or_else(|| contact.gross_slip_displacement());
            Box::new(protocol::falling_amplitude(fall.reversals, amplitude).map(Move::displacement))
        }
        Plan::EqualPeaks(_) => {
            let displacements = protocol.into_iter().flat_map(|protocol| &protocol.displacement);
            Box::new(displacements.copied().map(Move::displacement))
        }
        Plan::Cycles(cycles) => {
            let moves = cycles.moves(contact.indentation(), contact.normal_force());
            Box::new(moves.map_err(|error| Failure::at(place(plan, 0, None, &error), error))?)
        }
        Plan::Single(step) => Box::new(std::iter::once(*step)),
        Plan::Observations(observations) => {
            Box::new(observations.iter().map(|observation| Move::displacement(observation.displacement)))
        }
        // Rings follow these.
        Plan::Plane(_) => Box::new(std::iter::empty()),
    };
    Ok(Box::new(moves.map(|step| (step, step.step()))))
}

/// The moves of a path as one cycle, from the contact as it is.
///
/// # Errors
/// [`Cause::Refused`] for a cut-off radius that the contact does not allow, or a load that would fall below zero.
pub fn cycle_moves(plan: &Plan, contact: &Contact) -> Result<Vec<mechanics::Move>, Failure> {
    let protocol = equal_peaks(plan, contact)?;
    Ok(moves(plan, contact, protocol.as_ref())?.map(|(_, step)| step).collect())
}

/// The pointer to what has led to the refusal of a move of a plan: the move, or the number at fault if the plan has one
/// for it.
fn place(plan: &Plan, index: usize, step: Option<&Move>, error: &mechanics::Error) -> String {
    let named = match (plan, error) {
        (Plan::Timed(..), _) if quantity(error) == Some(Quantity::Duration) => Some(Quantity::Duration),
        (Plan::Timed(plan, _), _) => return place(plan, index, step, error),
        (Plan::Cycles(_), mechanics::Error::ForceExceedsFriction { .. }) => Some(Quantity::Force),
        (Plan::Cycles(_), mechanics::Error::BeyondProfile { .. }) => Some(Quantity::ContactRadius),
        (Plan::Cycles(_), _) => quantity(error),
        _ => quantity(error).filter(|quantity| step.is_some_and(|step| step.names(*quantity))),
    };
    plan.place_of(index, named)
}

/// Makes the moves of a plan one after the other, and shows each, and the contact after it, to `each`. `protocol` is
/// what [`equal_peaks`] has found for the plan.
///
/// # Errors
/// [`Failure`] at the first move without an answer, with a pointer to it; the moves before it have been made.
pub fn follow<S: Solver>(
    solver: &mut S,
    plan: &Plan,
    protocol: Option<&Protocol>,
    tolerance: f64,
    stop: &dyn Stop,
    mut each: impl FnMut(Move, &S),
) -> Result<(), Failure> {
    for (index, (step, made)) in moves(plan, solver.exact(), protocol)?.enumerate() {
        stop.check().map_err(|interrupted| Failure::interrupted(interrupted, &plan.place_of(index, None)))?;
        solver.apply(&made, tolerance, &|| stop.check().is_ok()).map_err(|error| {
            let refused = Failure::at(place(plan, index, Some(&step), &error), error);
            refused.unless_interrupted(stop, &plan.place_of(index, None))
        })?;
        let depth = solver.depth();
        if depth > limits::MEMORY_DEPTH {
            return Err(Failure::at(plan.place_of(index, None), Cause::MemoryFull { depth }));
        }
        each(step, solver);
    }
    Ok(())
}

/// The requested stresses.
///
/// # Errors
/// [`Cause::Refused`] without a stress field, [`Cause::Interrupted`] if the client hung up.
pub fn stresses<S: Solver>(solver: &S, sampling: &StressRequest, stop: &dyn Stop) -> Result<Stress, Failure> {
    needs_stress_field(solver.exact(), "/stress")?;
    solver.exact().check_elastic("`stress`").map_err(|error| Failure::at("/stress", error))?;
    if [Field::Slip, Field::Displacement].into_iter().any(|field| sampling.wants(field)) && solver.exact().is_twisted()
    {
        return Err(Failure::at("/stress/fields", mechanics::Error::Twisted("`slip` or `displacement`")));
    }
    let (places, line) = sampled(solver.exact(), sampling, solver.state().contact_radius, "/stress")?;
    let at_once = solver.radii_at_once();
    let along = |field: Field| -> Result<Option<Vec<Option<f64>>>, Failure> {
        if !sampling.wants(field) {
            return Ok(None);
        }
        let mut all = Vec::with_capacity(places.len());
        for radii in places.chunks(at_once) {
            stop.check()?;
            all.extend(solver.field(field, radii).into_iter().map(finite));
        }
        Ok(Some(all))
    };
    let (pressure, shear) = (along(Field::Pressure)?, along(Field::Shear)?);
    let (slip, displacement) = (along(Field::Slip)?, along(Field::Displacement)?);
    let hoop = along(Field::Hoop)?;
    let (radius, x) = if line { (None, Some(places)) } else { (Some(places), None) };
    Ok(Stress { radius, x, pressure, shear, slip, displacement, hoop })
}

/// The places of a request in a contact of this radius or half-width, m, and whether they are x of a line contact.
///
/// # Errors
/// [`Cause::Refused`] for radii of a line contact, and x of a round one, at the member of `pointer`.
pub fn sampled(
    contact: &Contact,
    sampling: &StressRequest,
    contact_radius: f64,
    pointer: &str,
) -> Result<(Vec<f64>, bool), Failure> {
    let refused = |member: &str, error| Err(Failure::at(format!("{pointer}/{member}"), error));
    let line = contact.profile().line().is_some();
    if line && sampling.radii.is_some() {
        return refused("radii", mechanics::Error::LineContact("`radii`"));
    }
    if !line && sampling.x.is_some() {
        return refused("x", mechanics::Error::RoundContact("`x`"));
    }
    Ok((sampling.places(line, contact_radius), line))
}

/// Refuses a search for extrema that cannot end in time.
///
/// # Errors
/// [`Cause::Search`] with the estimate, and the most pieces that are possible.
fn check_search(profile: &Profile, depth: usize, stop: &dyn Stop) -> Result<(), Failure> {
    let (estimate, allowed) =
        (Duration::from_nanos(cost::of_search(profile, depth)), stop.flag().time_limit().unwrap_or(LONGEST_WORK));
    if estimate <= allowed.saturating_mul(cost::MARGIN) {
        return Ok(());
    }
    let (estimate, fits) = (estimate.as_secs(), cost::longest_search(profile, allowed));
    Err(Failure::at("/residual", Cause::Search { estimate, depth, fits, allowed }))
}

/// The extrema of the shear stress.
///
/// # Errors
/// [`Failure`] if the slip history is so deep that the search would exceed the time limit, or the client hung up.
pub fn residual<S: Solver>(solver: &S, stop: &dyn Stop) -> Result<Residual, Failure> {
    needs_stress_field(solver.exact(), "/residual")?;
    solver.exact().check_elastic("`residual`").map_err(|error| Failure::at("/residual", error))?;
    if solver.exact().is_twisted() {
        return Err(Failure::at("/residual", mechanics::Error::Twisted("`residual`")));
    }
    check_search(solver.exact().profile(), solver.depth(), stop)?;
    match solver.residual(&|| stop.check().is_ok()) {
        Some(residual) => {
            let exact = solver.exact();
            Ok(Residual::new(residual, exact.unit_shear(), exact.profile()))
        }
        None => Err(Failure::from(Interrupted::Abandoned).unless_interrupted(stop, "")),
    }
}
