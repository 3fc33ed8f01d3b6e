//! The balance of energy at constant load, without quadrature: bounds that hold for any concave force.
//!
//! While the indenter moves one way under a constant load, the slip ring grows and the tangential stiffness 2 G* c, c
//! the stick radius, falls. So the force over the displacement lies above its chords and below its tangents, and so
//! does its work.

use stickslip_wire::simulate::Simulation;
use stickslip_wire::{Path, SimulateReply, SimulateRequest, SolverKind, State};

use super::laws::{again, largest_load};

/// How many moves are checked, from the first.
const MOVES: usize = 5;
/// Into how many parts each is split.
const PARTS: usize = 12;
/// The allowed error of the balance, relative to the friction limit times the sum of the distance and the gross-slip
/// displacement.
const BALANCE: f64 = 1e-9;

/// # Panics
/// If the work of the tangential force is not the energy stored and dissipated.
pub fn check(request: &SimulateRequest, simulation: &Simulation, reply: &SimulateReply) {
    let displaced = match &request.path {
        Path::Moves(moves) => moves
            .iter()
            .all(|step| step.displacement.is_some() && step.indentation.is_none() && step.normal_force.is_none()),
        Path::Force(_) => false,
        Path::Cycles(cycles) => cycles.force.is_none() && cycles.normal.is_none(),
        Path::Displacement(_) | Path::FallingAmplitude(_) | Path::EqualPeaks(_) => true,
    };
    if !displaced || reply.accuracy.solver == SolverKind::Springs || reply.contact.indentation <= 0.0 {
        return;
    }
    let mut targets = Vec::new();
    let mut here = 0.0;
    for state in reply.steps.iter().take(MOVES) {
        let there = state.displacement;
        targets.extend((1..PARTS).map(|part| here + (there - here) * (part as f64 / PARTS as f64)));
        targets.push(there);
        here = there;
    }
    let request =
        SimulateRequest { path: Path::Displacement(targets), stress: None, residual: false, ..request.clone() };
    let split = again(&request, "split into parts");
    let limit = simulation.setup.friction * largest_load(reply, 0);
    let full = reply.contact.gross_slip_displacement;
    let stiffness = 2.0 * reply.contact.g_star;
    let edge = reply.contact.contact_radius;
    let mut from =
        State { displacement: 0.0, force: 0.0, dissipated_energy: 0.0, elastic_energy: 0.0, ..split.steps[0] };
    for (index, parts) in split.steps.chunks(PARTS).enumerate() {
        let (mut low, mut high, mut distance) = (0.0, 0.0, 0.0);
        let mut here = from;
        let mut soft = stiffness * edge;
        for part in parts {
            let step = (part.displacement - here.displacement).abs();
            let sign = (parts[PARTS - 1].displacement - from.displacement).signum();
            let (f0, f1) = (here.force * sign, part.force * sign);
            let softer = stiffness * part.stick_radius.min(edge);
            distance += step;
            low += 0.5 * step * (f0 + f1);
            high += below_tangents(step, f0, f1, soft, softer);
            here = *part;
            soft = softer;
        }
        let stored = here.elastic_energy - from.elastic_energy;
        let lost = here.dissipated_energy - from.dissipated_energy;
        let sums = here.elastic_energy + here.dissipated_energy;
        let allowed = BALANCE * limit * (distance + full) + 8.0 * f64::EPSILON * sums + f64::MIN_POSITIVE;
        let work = stored + lost;
        assert!(
            work >= low - allowed && work <= high + allowed,
            "move {index}: stored {stored:e} and lost {lost:e}, but the work is between {low:e} and {high:e}"
        );
        let whole = &reply.steps[index];
        let off = (whole.force - here.force).abs() / (limit + f64::MIN_POSITIVE);
        assert!(off <= 1e-10, "move {index}: split into parts it ends with {here:?}, and not {whole:?}");
        let off = (whole.dissipated_energy - here.dissipated_energy).abs();
        assert!(
            off <= allowed + 1e-10 * here.dissipated_energy,
            "move {index}: split into parts it loses {here:?}, and not {whole:?}"
        );
        from = here;
    }
}

/// int F over `step` under both tangents: from `f0` with stiffness `k0`, and back from `f1` with `k1`.
fn below_tangents(step: f64, f0: f64, f1: f64, k0: f64, k1: f64) -> f64 {
    let gain = (f1 - f0).max(0.0);
    let meet = if k0 > k1 { ((gain - k1 * step) / (k0 - k1)).clamp(0.0, step) } else { 0.5 * step };
    let top = (f0 + k0 * meet).max(f1 - k1 * (step - meet));
    0.5 * meet * (f0 + top) + 0.5 * (step - meet) * (top + f1)
}
