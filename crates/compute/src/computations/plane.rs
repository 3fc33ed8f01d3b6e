//! Tables and pictures of simulations in the plane.

use stickslip_wire::plane::{PlanarReply, PlanarState, PlanarStress};

use super::stress::{self, NamedField};
use crate::computations::prelude::*;

/// The columns of stresses with their names and units.
fn fields(stress: &PlanarStress) -> [NamedField<'_>; 6] {
    [
        ("pressure", "Pa", &stress.pressure),
        ("shear_x", "Pa", &stress.shear_x),
        ("shear_y", "Pa", &stress.shear_y),
        ("slip_x", "m", &stress.slip_x),
        ("slip_y", "m", &stress.slip_y),
        ("friction_work", "J/m²", &stress.friction_work),
    ]
}

/// A row for each state, or for each radius.
pub(super) fn table<'a>(reply: &'a PlanarReply, part: &str) -> Option<Table<'a>> {
    if part == "stress" {
        let stress = reply.stress.as_ref()?;
        return Some(stress::table(("radius", &stress.radius), &fields(stress)));
    }
    let floats = |name, unit, of: fn(&PlanarState) -> f64| Column::floats(name, unit, move |row| of(&reply.steps[row]));
    let columns = vec![
        floats("displacement_x", "m", |state| state.displacement[0]),
        floats("displacement_y", "m", |state| state.displacement[1]),
        floats("force_x", "N", |state| state.force[0]),
        floats("force_y", "N", |state| state.force[1]),
        floats("indentation", "m", |state| state.indentation),
        floats("normal_force", "N", |state| state.normal_force),
        floats("contact_radius", "m", |state| state.contact_radius),
        floats("stick_radius", "m", |state| state.stick_radius),
        Column::words("regime", move |row| reply.steps[row].regime.name()),
        floats("dissipated_energy", "J", |state| state.dissipated_energy),
        floats("elastic_energy", "J", |state| state.elastic_energy),
    ];
    Some(Table::flat(reply.steps.len(), columns))
}

/// The loop of the force in the plane along `curve`, with the ends of its moves, or the components of the stresses over
/// the radius.
pub(super) fn plot(reply: &PlanarReply, part: &str, curve: Vec<simulation::Point>) -> Option<Plot> {
    if part == "stress" {
        return reply.stress.as_ref().map(stresses);
    }
    let ends = reply.steps.iter().map(|state| (state.force[0], state.force[1]));
    let curves = vec![Curve::line("", Colour::Blue, curve), Curve::dots("", Colour::Blue, ends)];
    let panel = Panel { y: Axis::of("tangential force along y", "N"), curves };
    Some(Plot::new("Force along the path", Axis::of("tangential force along x", "N"), vec![panel]))
}

/// A panel for each unit.
fn stresses(stress: &PlanarStress) -> Plot {
    let colours = [Colour::Grey, Colour::Blue, Colour::Red, Colour::Blue, Colour::Red, Colour::Blue];
    let drawn: Vec<_> = fields(stress).into_iter().zip(colours).collect();
    let names = [("stress", "Pa"), ("slip", "m"), ("friction work", "J/m²")];
    let panels = stress::panels(&stress.radius, &drawn, &names);
    Plot::new("Stresses at the end of the path", Axis::of("radius r", "m"), panels)
}
