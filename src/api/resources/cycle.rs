//! `/contacts/{id}/cycle`: the steady cycles of a contact at its present load; nothing changes.

use stickslip_mechanics::range::{self, Range};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::limits::{self, Array};
use stickslip_wire::{Amplitudes, CycleDrive, CycleReply, JsonPath, WorkDensity};

use super::prelude::*;
use super::stress::QUERY_RADII;
use crate::api::query_parameters::{List, number};

parameters! {
    pub struct CycleQuery {
        /// Amplitudes of the displacement, m, separated by commas or given one by one: of the indenter or, with
        /// `machine_stiffness`, of the machine. Give this or `force`.
        displacement: Option<Vec<f64>> = List(Array(QUERY_RADII, Range { min: 0.0, ..range::DISPLACEMENT }));
        /// Amplitudes of the tangential force, N, separated by commas or given one by one.
        force: Option<Vec<f64>> = List(Array(QUERY_RADII, Range { min: 0.0, ..range::FORCE }));
        /// Radii for the friction work per area, m, separated by commas or given one by one. Give this or `points`, or
        /// neither.
        radii: Option<Vec<f64>> = List(Array(QUERY_RADII, range::CONTACT_RADIUS));
        /// Places along x for the friction work per area of a line contact, m, in place of `radii`.
        x: Option<Vec<f64>> = List(Array(QUERY_RADII, range::PLACE));
        /// The stiffness of a machine in series with the contact, N/m.
        machine_stiffness: Option<f64> = number(&range::MACHINE_STIFFNESS);
        /// Number of harmonics, from the first on.
        harmonics: Option<usize> = Number { is_checked: false, ..count(&limits::HARMONICS) };
        /// Number of radii for the friction work per area, evenly spaced from the centre to the edge, both included.
        points: Option<usize> = Number { is_checked: false, ..count(&limits::STRESS_POINTS) };
        /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
        /// stream), or a plot as `svg` or `png`. Only `columns` has the friction work per area. If it is left out,
        /// `Accept` decides.
        format: Option<Format> = formats(&Format::ALL);
    }
}

pub struct CheckedCycle {
    task: CycleTask,
    format: Option<Format>,
}

impl QueryParams for CheckedCycle {
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<CheckedCycle> {
        let CycleQuery { displacement, force, radii, x, machine_stiffness, harmonics, points, format } =
            CycleQuery::take(query, headers)?;
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
        let task = CycleTask::of_query(drive, machine_stiffness, harmonics, density, &mut query.faults)?;
        Some(CheckedCycle { task, format })
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
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(CheckedCycle { task, format }): CheckedQuery<CheckedCycle>,
) -> Result<Response, Problem> {
    computations::get_of_contact(&app, id, &headers, format, task).await
}
