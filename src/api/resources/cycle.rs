//! `/contacts/{id}/cycle`: the steady cycles of a contact at its present load; nothing changes.

use stickslip_mechanics::range::{self, Range};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::limits::{self, Array};
use stickslip_wire::{Amplitudes, CycleDrive, CycleReply, Fault, Faults, WorkDensity};

use super::prelude::*;
use super::stress::QUERY_RADII;
use crate::api::query_parameters::{number, numbers};

parameters! {
    pub struct CycleQuery {
        /// Amplitudes of the displacement, m, separated by commas or given one by one: of the indenter or, with
        /// `machine_stiffness`, of the machine. Give this, `force`, `twist` or `torque`.
        displacement: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::DISPLACEMENT }));
        /// Amplitudes of the tangential force, N, separated by commas or given one by one.
        force: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::FORCE }));
        /// Amplitudes of the angle of twist, rad, separated by commas or given one by one: of the indenter or, with
        /// `machine_stiffness`, of the machine.
        twist: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::TWIST }));
        /// Amplitudes of the torque, N·m, separated by commas or given one by one.
        torque: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::TORQUE }));
        /// Radii for the friction work per area, m, separated by commas or given one by one. Give this or `points`, or
        /// neither.
        radii: Vec<f64> = numbers(&Array(QUERY_RADII, range::CONTACT_RADIUS));
        /// Places along x for the friction work per area of a line contact, m, in place of `radii`.
        x: Vec<f64> = numbers(&Array(QUERY_RADII, range::PLACE));
        /// The stiffness of a machine in series with the contact, N/m; with `twist` or `torque` N·m/rad.
        machine_stiffness: f64 = number(&range::MACHINE_STIFFNESS);
        /// Number of harmonics, from the first on.
        harmonics: usize = count(&limits::HARMONICS);
        /// Number of radii for the friction work per area, evenly spaced from the centre to the edge, both included.
        points: usize = count(&limits::STRESS_POINTS);
        ..formats(&Format::ALL, "Only `columns` has the friction work per area.")
    }
}

/// Get the steady cycles of a contact
///
/// As `POST /cycle`, for the contact at its present load, whatever its history. Nothing changes.
#[utoipa::path(
    get, path = "/contacts/{id}/cycle", tag = "contacts", params(ContactPath, CycleQuery),
    responses((status = 200, description = "The cycles, one for each amplitude", body = CycleReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_steady_cycle(
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<CycleQuery>,
) -> Result<Response, Problem> {
    let CycleQuery { displacement, force, twist, torque, radii, x, machine_stiffness, harmonics, points, format } =
        query;
    // A single amplitude is no list: its place is the parameter.
    let amplitudes = |all: Vec<f64>| match all[..] {
        [one] => Amplitudes::One(one),
        _ => Amplitudes::Many(all),
    };
    let given = [
        displacement.map(|all| ("displacement", CycleDrive::Displacement(amplitudes(all)))),
        force.map(|all| ("force", CycleDrive::Force(amplitudes(all)))),
        twist.map(|all| ("twist", CycleDrive::Twist(amplitudes(all)))),
        torque.map(|all| ("torque", CycleDrive::Torque(amplitudes(all)))),
    ];
    let mut given = given.into_iter().flatten();
    let Some((first, drive)) = given.next() else {
        return Err(Fault::new("/displacement", "give `displacement`, `force`, `twist` or `torque`").into());
    };
    if let Some((second, _)) = given.next() {
        let detail = format!("conflicts with `{first}`: give one of them");
        return Err(Fault::new(format!("/{second}"), detail).into());
    }
    let density = (points.is_some() || radii.is_some() || x.is_some()).then_some(WorkDensity { points, radii, x });
    let mut faults = Faults::default();
    let task = CycleTask::of_query(drive, machine_stiffness, harmonics, density, &mut faults);
    computations::get_of_contact(&app, id, &headers, format?, Box::new(faults.done(task)?), &context).await
}
