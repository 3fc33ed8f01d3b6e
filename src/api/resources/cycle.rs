//! `/contacts/{id}/cycle`: the steady cycles of a contact at its present load; nothing changes.

use stickslip_mechanics::range::{self, Range};
use stickslip_wire::cycle::{CycleOptions, CyclePlaces, CycleTask};
use stickslip_wire::limits::{self, Array};
use stickslip_wire::{Amplitudes, CycleDrive, CycleReply, JsonPath, WorkDensity};

use super::prelude::*;
use super::stress::QUERY_RADII;
use crate::api::query_parameters::{number, numbers};

parameters! {
    pub struct CycleQuery {
        /// Amplitudes of the displacement, m, separated by commas or given one by one: of the indenter or, with
        /// `machine_stiffness`, of the machine. Give this or `force`.
        displacement: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::DISPLACEMENT }));
        /// Amplitudes of the tangential force, N, separated by commas or given one by one.
        force: Vec<f64> = numbers(&Array(QUERY_RADII, Range { min: 0.0, ..range::FORCE }));
        /// Radii for the friction work per area, m, separated by commas or given one by one. Give this or `points`, or
        /// neither.
        radii: Vec<f64> = numbers(&Array(QUERY_RADII, range::CONTACT_RADIUS));
        /// Places along x for the friction work per area of a line contact, m, in place of `radii`.
        x: Vec<f64> = numbers(&Array(QUERY_RADII, range::PLACE));
        /// The stiffness of a machine in series with the contact, N/m.
        machine_stiffness: f64 = number(&range::MACHINE_STIFFNESS).unchecked();
        /// Number of harmonics, from the first on.
        harmonics: usize = count(&limits::HARMONICS).unchecked();
        /// Number of radii for the friction work per area, evenly spaced from the centre to the edge, both included.
        points: usize = count(&limits::STRESS_POINTS).unchecked();
        ..formats(&Format::ALL, "Only `columns` has the friction work per area.")
    }
}

pub struct CheckedCycle {
    task: CycleTask,
    format: Result<Format, Problem>,
}

impl QueryParams for CheckedCycle {
    fn take(query: &mut QueryReader<'_>) -> Option<CheckedCycle> {
        let CycleQuery { displacement, force, radii, x, machine_stiffness, harmonics, points, format } =
            CycleQuery::take(query)?;
        if !query.faults.is_empty() {
            return None;
        }
        // A single amplitude is no list: its place is the parameter.
        let amplitudes = |all: Vec<f64>| match all[..] {
            [one] => Amplitudes::One(one),
            _ => Amplitudes::Many(all),
        };
        let drive = match (displacement, force) {
            (Some(all), None) => CycleDrive::Displacement(amplitudes(all)),
            (None, Some(all)) => CycleDrive::Force(amplitudes(all)),
            (None, None) => {
                return query.faults.refuse(JsonPath::Root.member("displacement"), "give `displacement` or `force`");
            }
            (Some(_), Some(_)) => {
                let detail = "conflicts with `displacement`: give one of them";
                return query.faults.refuse(JsonPath::Root.member("force"), detail);
            }
        };
        let density = (points.is_some() || radii.is_some() || x.is_some()).then_some(WorkDensity { points, radii, x });
        let options = CycleOptions { drive, stiffness: machine_stiffness, harmonics, density };
        Some(CheckedCycle { task: options.check(CyclePlaces::QUERY, &mut query.faults)?, format })
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
    ContactPath { app, id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(CheckedCycle { task, format }): CheckedQuery<CheckedCycle>,
) -> Result<Response, Problem> {
    computations::get_of_contact(&app, id, &headers, format?, task).await
}
