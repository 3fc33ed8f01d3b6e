//! Laws that the reply for every contact and path obeys, whatever the profile.

use serde_json::Value;
use stickslip_compute::simulation::{Cause, Failure};
use stickslip_mechanics::Error;
use stickslip_wire::simulate::Simulation;
use stickslip_wire::{
    Document as _, Move, Path, Plan, Profile, Regime, SimulateReply, SimulateRequest, SolverKind, State, Steps,
    Subsurface,
};

use super::{Unanswered, run};

/// The allowed error of forces beyond their estimate, relative to mu F_N.
const FORCE: f64 = 1e-10;
/// The allowed error of stresses, relative to mu p_max: at a cusp it is the root of the rounding error of the radius.
const STRESS: f64 = 1e-6;

/// Contact radii, m, and normal forces, N, below which products of a few of them lose their digits, and then
/// themselves.
const SMALLEST: f64 = 1e-100;

/// A longer slip history is left by curved moves alone: such a request is too slow to be repeated with variations.
const LONG_HISTORY: usize = 200;

/// # Panics
/// If a law does not hold for the answer to a request.
pub fn check(request: &SimulateRequest, simulation: &Simulation, reply: &SimulateReply) {
    if reply.steps.iter().any(underflows) {
        return;
    }
    numbers(simulation, reply);
    if reply.steps.iter().any(|state| state.memory_depth > LONG_HISTORY) {
        return;
    }
    let request = &SimulateRequest { steps: Steps::All, ..request.clone() };
    let all = again(request, "with all steps");
    let last = again(&SimulateRequest { steps: Steps::Last, ..request.clone() }, "with the last step");
    assert_eq!(all.steps.len(), simulation.plan.length());
    assert_eq!(last.steps[..], all.steps[all.steps.len() - 1..], "the last step");
    assert!(same(&last, &all) && same(reply, &all), "the same request, another answer");

    numbers(simulation, &all);
    if all.steps.iter().any(underflows) || below_table(&request.contact.profile, &all) {
        return;
    }
    states(simulation, &all);
    targets(request, &all);
    stresses(simulation, &all);
    residual(simulation, &all);
    short_form(request, &all);
    repeat_last_move(request, &all);
}

/// A variation of a request that has been answered must be answered too.
pub fn again(request: &SimulateRequest, how: &str) -> SimulateReply {
    match run(request) {
        Ok(reply) => reply,
        Err(refusal) => panic!("{how}: {refusal:?}"),
    }
}

/// Whether a contact is so small that doubles run out beneath it.
fn underflows(state: &State) -> bool {
    let small = state.contact_radius < SMALLEST || state.normal_force < SMALLEST;
    (state.indentation > 0.0 || state.normal_force > 0.0) && (small || state.indentation < SMALLEST)
}

/// Whether the contact stays so far inside the first point of a table, or of a part of a sum, that its heights
/// are rounding errors alone.
fn below_table(profile: &Profile, reply: &SimulateReply) -> bool {
    let least = reply.steps.iter().map(|state| state.contact_radius).filter(|radius| *radius > 0.0).reduce(f64::min);
    match profile {
        Profile::Tabulated(table) => least.is_some_and(|radius| radius < 1e-3 * table.r[1]),
        Profile::Sum(sum) => sum.parts.iter().any(|part| below_table(part, reply)),
        _ => false,
    }
}

/// Whether two answers agree in all but the steps and the time.
fn same(one: &SimulateReply, other: &SimulateReply) -> bool {
    (&one.contact, &one.stress, &one.residual, &one.protocol, &one.warnings)
        == (&other.contact, &other.stress, &other.residual, &other.protocol, &other.warnings)
}

/// All numbers are finite, but for those that the contract has as `null` where they are infinite.
fn numbers(simulation: &Simulation, reply: &SimulateReply) {
    let indenter = simulation.setup.profile.indenter();
    let edge = reply.steps[reply.steps.len() - 1].contact_radius;
    let spikes = indenter.singular_radii();
    let rim = indenter.rim_radius();
    let spike = |radius: f64, edge: f64| {
        // A radius whose square is zero is the centre.
        let radius = if radius * radius > 0.0 { radius } else { 0.0 };
        radius <= edge && spikes.iter().chain(&rim).any(|spike| same_number(*spike, radius))
    };
    // A contact whose ring around a flat is thinner than the last digit of its radius is one of a flat punch.
    let flat = indenter.radius(0.0);
    let spiked = |edge: f64| spikes.iter().chain(&rim).any(|spike| *spike <= edge) || flat > 0.0 && edge <= flat;
    let value = serde_json::to_value(reply).expect("a reply is JSON");
    let mut nulls = Vec::new();
    find_nulls(&value, String::new(), &mut nulls);
    for null in nulls {
        let place: Vec<&str> = null.split('/').skip(1).collect();
        let allowed = match place[..] {
            // What is known by its load curve alone has no pressures.
            // No bound is known of lines and load curves.
            ["accuracy", "coupling_bound"] => true,
            ["contact", "max_pressure"] => {
                spiked(reply.contact.contact_radius) || !simulation.setup.profile.has_stress_field()
            }
            ["residual", "min" | "mean"] => reply.residual.as_ref().is_some_and(|residual| residual.peaks.is_empty()),
            ["residual", "centre"] => spike(0.0, edge),
            ["residual", "max"] => spiked(edge),
            // The largest pressure is zero where the ring around a flat is too thin for twice the digits of a double.
            ["residual", "relative"] => {
                let unpressed = reply.contact.max_pressure.is_some_and(|pressure| pressure <= 0.0);
                spiked(edge) || untouched(reply) || unpressed || simulation.setup.friction.limit.coefficient <= 0.0
            }
            ["stress", "slip", index] => radius(reply, index) > edge || untouched(reply),
            ["subsurface", _, index] => {
                spiked(edge) && below(reply).z[index.parse::<usize>().expect("an index")] <= 0.0
            }
            ["stress", "pressure" | "shear", index] => spike(radius(reply, index), edge),
            _ => false,
        };
        assert!(allowed, "{null} is null");
    }
    for warning in &reply.warnings {
        assert!(!warning.message.contains("NaN") && !warning.message.contains("inf "), "{warning:?}");
    }
}

fn below(reply: &SimulateReply) -> &Subsurface {
    reply.subsurface.as_ref().expect("there are stresses below the surface")
}

fn radius(reply: &SimulateReply, index: &str) -> f64 {
    let stress = reply.stress.as_ref().expect("there are stresses");
    stress.places()[index.parse::<usize>().expect("an index")]
}

/// Whether the bodies end up apart or just touching.
fn untouched(reply: &SimulateReply) -> bool {
    reply.steps[reply.steps.len() - 1].indentation <= 0.0
}

fn find_nulls(value: &Value, place: String, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(place),
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(index, element)| {
                find_nulls(element, format!("{place}/{index}"), found);
            });
        }
        Value::Object(members) => {
            members.iter().for_each(|(name, member)| find_nulls(member, format!("{place}/{name}"), found));
        }
        _ => {}
    }
}

/// The bounds of each state; the friction work never decreases.
fn states(simulation: &Simulation, reply: &SimulateReply) {
    let friction = simulation.setup.friction.limit.coefficient;
    let mut dissipated = 0.0;
    for (index, state) in reply.steps.iter().enumerate() {
        let limit = friction * state.normal_force;
        let beyond = state.force.unwrap().abs() - limit;
        let size = friction * largest_load(reply, index);
        assert!(
            beyond <= (FORCE + 4.0 * reply.accuracy.force_error) * size,
            "step {index}: force beyond mu F_N: {state:?}"
        );
        // What adheres may be pulled, and be held beyond zero gap.
        let adheres = state.surface_energy.is_some();
        assert!((adheres || state.normal_force >= 0.0) && state.contact_radius >= 0.0, "step {index}: {state:?}");
        assert!((0.0..=state.contact_radius).contains(&state.stick_radius), "step {index}: {state:?}");
        assert!(state.dissipated_energy >= dissipated, "step {index}: the friction work decreases: {state:?}");
        assert!(state.elastic_energy >= 0.0, "step {index}: {state:?}");
        dissipated = state.dissipated_energy;
        let known = match state.regime {
            Regime::Stick => same_number(state.stick_radius, state.contact_radius),
            Regime::PartialSlip => state.stick_radius < state.contact_radius || springs(reply),
            Regime::GrossSlip => same_number(state.stick_radius, 0.0),
            Regime::Separated => state.indentation < 0.0,
            Regime::PulledOff => adheres && state.indentation < 0.0,
        };
        assert!(known, "step {index}: {state:?}");
        if adheres {
            continue;
        }
        assert_eq!(state.indentation < 0.0, state.regime == Regime::Separated, "step {index}: {state:?}");
        if state.indentation <= 0.0 {
            let carried = [state.force.unwrap(), state.normal_force, state.elastic_energy];
            assert!(carried.iter().all(|value| same_number(*value, 0.0)), "step {index}: {state:?}");
            assert_eq!(state.memory_depth, 0, "step {index}: {state:?}");
        }
    }
}

/// The largest normal force up to a step, N.
pub fn largest_load(reply: &SimulateReply, index: usize) -> f64 {
    reply.steps[..=index].iter().fold(reply.contact.normal_force, |load, state| load.max(state.normal_force))
}

fn springs(reply: &SimulateReply) -> bool {
    reply.accuracy.solver == SolverKind::Springs
}

fn same_number(one: f64, other: f64) -> bool {
    (one - other).abs() <= 0.0
}

/// The moves of a path that lists them.
fn listed(path: &Path) -> Option<Vec<Move>> {
    match path {
        Path::Moves(moves) => Some(moves.clone()),
        Path::Displacement(targets) => Some(targets.iter().copied().map(Move::displacement).collect()),
        Path::Force(targets) => Some(targets.iter().copied().map(Move::force).collect()),
        Path::Twist(targets) => Some(targets.iter().copied().map(Move::twist).collect()),
        Path::Torque(targets) => Some(targets.iter().copied().map(Move::torque).collect()),
        Path::FallingAmplitude(_) | Path::EqualPeaks(_) | Path::Cycles(_) => None,
    }
}

fn along_a_line(request: &SimulateRequest) -> Path {
    request.path.path.clone().along_a_line().expect("these requests have no pairs")
}

/// The same path as a list of moves.
fn moves(request: &SimulateRequest, reply: &SimulateReply) -> Vec<Move> {
    if let Path::Cycles(_) = along_a_line(request) {
        // Their targets may be forces, which the states have to the tolerance alone.
        let Ok(Simulation { plan: Plan::Cycles(cycles), .. }) = request.clone().check() else {
            panic!("the path of an answered request is sound");
        };
        let moves = cycles.moves(reply.contact.indentation, reply.contact.normal_force);
        return moves.expect("the load presses").collect();
    }
    let taken = || reply.steps.iter().map(|state| Move::displacement(state.displacement.unwrap())).collect();
    listed(&along_a_line(request)).unwrap_or_else(taken)
}

/// Absolute targets are reached: to the bit, a tangential force to the tolerance.
fn targets(request: &SimulateRequest, reply: &SimulateReply) {
    if springs(reply) {
        return;
    }
    let tolerance = request.tolerance.unwrap_or(1e-10);
    for (index, (step, state)) in moves(request, reply).iter().zip(&reply.steps).enumerate() {
        if step.relative {
            continue;
        }
        let met = |target: Option<f64>, found: f64| target.is_none_or(|target| same_number(target, found));
        assert!(met(step.displacement, state.displacement.unwrap()), "step {index}: {step:?} gave {state:?}");
        assert!(met(step.indentation, state.indentation), "step {index}: {step:?} gave {state:?}");
        assert!(met(step.normal_force, state.normal_force), "step {index}: {step:?} gave {state:?}");
        let unit = request.contact.friction * largest_load(reply, index);
        let missed = step.force.map_or(0.0, |target| (state.force.unwrap() - target).abs());
        assert!(
            missed <= (FORCE + tolerance + 4.0 * reply.accuracy.force_error) * unit,
            "step {index}: {step:?} gave {state:?}"
        );
    }
}

/// The unit of stresses: mu p_max or, where that is infinite, mu times the mean pressure, Pa.
fn stress_unit(simulation: &Simulation, reply: &SimulateReply) -> f64 {
    let end = &reply.steps[reply.steps.len() - 1];
    let mean = end.normal_force / (std::f64::consts::PI * end.contact_radius * end.contact_radius);
    if end.normal_force > 0.0 { simulation.setup.friction.limit.coefficient * mean } else { 0.0 }
}

/// Friction bounds the shear stress everywhere, and stresses outside the contact are zero.
fn stresses(simulation: &Simulation, reply: &SimulateReply) {
    let Some(stress) = &reply.stress else { return };
    let end = &reply.steps[reply.steps.len() - 1];
    let fields = [&stress.pressure, &stress.shear, &stress.slip, &stress.displacement];
    assert!(fields.into_iter().flatten().all(|field| field.len() == stress.places().len()));
    for (index, &radius) in stress.places().iter().enumerate() {
        let at = |field: &Option<Vec<Option<f64>>>| field.as_ref().and_then(|values| values[index]);
        let (pressure, shear) = (at(&stress.pressure), at(&stress.shear));
        if radius > end.contact_radius || end.indentation <= 0.0 {
            assert!(
                [pressure, shear].into_iter().flatten().all(|value| same_number(value, 0.0)),
                "outside at {radius}"
            );
            assert!(at(&stress.slip).is_none(), "slip outside at {radius}");
        }
        assert!(pressure.is_none_or(|value| value >= 0.0), "at {radius} m: {pressure:?}");
        if let (Some(pressure), Some(shear)) = (pressure, shear)
            && !springs(reply)
        {
            let bound = simulation.setup.friction.limit.coefficient * pressure;
            let unit = stress_unit(simulation, reply) + bound;
            let allowed = (STRESS + 4.0 * reply.accuracy.stress_error) * unit;
            assert!(shear.abs() <= bound + allowed, "at {radius} m: shear {shear:e} beyond mu p = {bound:e}");
        }
    }
}

/// The extrema lie inside, in order, and none is larger than the largest.
fn residual(simulation: &Simulation, reply: &SimulateReply) {
    let Some(residual) = &reply.residual else { return };
    let end = &reply.steps[reply.steps.len() - 1];
    let radii: Vec<f64> = residual.peaks.iter().map(|peak| peak.place()).collect();
    assert!(radii.windows(2).all(|pair| pair[0] <= pair[1] * (1.0 + 4.0 * f64::EPSILON)), "{radii:?}");
    assert!(radii.iter().all(|radius| *radius > 0.0 && *radius <= end.contact_radius), "{radii:?}");
    let sizes = residual.peaks.iter().filter_map(|peak| peak.shear).map(f64::abs);
    let largest = sizes.clone().fold(residual.centre.map_or(0.0, f64::abs), f64::max);
    let unit = stress_unit(simulation, reply) + largest;
    assert!(residual.max.is_none_or(|max| max >= largest - STRESS * unit), "{residual:?}");
    assert!(residual.min.is_none_or(|min| sizes.clone().all(|size| size >= min)), "{residual:?}");
}

/// A short form of a path gives the states of the moves that it expands to, bit for bit.
fn short_form(request: &SimulateRequest, reply: &SimulateReply) {
    if listed(&along_a_line(request)).is_none() {
        let moves = Path::Moves(moves(request, reply)).into();
        assert_eq!(again(&SimulateRequest { path: moves, ..request.clone() }, "as a list").steps, reply.steps);
    }
}

/// Repeating the last move changes nothing.
fn repeat_last_move(request: &SimulateRequest, reply: &SimulateReply) {
    let mut path = moves(request, reply);
    let last = path[path.len() - 1];
    let still = |target: Option<f64>| target.map(|target| if last.relative { 0.0 } else { target });
    path.push(Move {
        displacement: still(last.displacement),
        force: still(last.force),
        indentation: still(last.indentation),
        normal_force: still(last.normal_force),
        relative: last.relative,
        ..Move::default()
    });
    let request = SimulateRequest { path: Path::Moves(path).into(), ..request.clone() };
    let longer = match run(&request) {
        Ok(longer) => longer,
        // In gross slip a force is at its limit to round-off, on either side of it.
        Err(Unanswered::Failed(Failure { cause: Cause::Refused(Error::ForceExceedsFriction { .. }), .. }))
            if last.relative && last.force.is_some() =>
        {
            return;
        }
        Err(refusal) => panic!("the last move again: {refusal:?}"),
    };
    let (before, after) = (&reply.steps[reply.steps.len() - 1], &longer.steps[reply.steps.len()]);
    if last.force.is_none() && !springs(reply) {
        let expected = State { stick_radius: after.stick_radius, regime: after.regime, ..*before };
        assert_eq!(*after, expected, "the last move again");
        return;
    }
    let unit = request.contact.friction * largest_load(reply, reply.steps.len() - 1);
    let allowed = (FORCE + 8.0 * longer.accuracy.force_error + request.tolerance.unwrap_or(1e-10)) * unit;
    assert!(
        (before.force.unwrap() - after.force.unwrap()).abs() <= allowed,
        "the last move again: {before:?} {after:?}"
    );
}
