//! `/cycle` and `/contacts/{id}/cycle`: the steady cycles of a contact at constant load; nothing is stored or changed.

use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_mechanics::Contact;
use stickslip_wire::cycle::{CycleOptions, CyclePlaces, CycleTask};
use stickslip_wire::{Amplitudes, ContactDefinition, CycleDrive, CycleReply, CycleRequest, JsonPath, WorkDensity};

use super::stress::QUERY_RADII;
use crate::api::extract::CheckedBody;
use crate::api::formats::{Format, plots, tables};
use crate::api::params::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::{COUNT, CheckedQuery, QueryParams, QueryReader};
use crate::api::reply;
use crate::api::state::{App, TenantApp};
use crate::otlp;
use crate::simulation::{self, bytes, cost};

/// How the cycles are written.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct CycleFormat {
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
    /// stream), or a plot as `svg` or `png`. The friction work per area is in `columns` alone. If it is left out, `Accept`
    /// decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for CycleFormat {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<CycleFormat> {
        Some(CycleFormat { format: query.format(&Format::ALL) })
    }
}

/// Which cycles are wanted.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
#[expect(dead_code, reason = "describes what `Wanted` is read from")]
pub struct CycleQuery {
    /// Amplitudes of the displacement, m, separated by commas or given one by one: of the indenter or, with
    /// `machine_stiffness`, of the machine. Give this or `force`.
    #[param(nullable = false)]
    displacement: Option<String>,
    /// Amplitudes of the tangential force, N, likewise.
    #[param(nullable = false)]
    force: Option<String>,
    /// The stiffness of a machine in series with the contact, N/m.
    #[param(nullable = false)]
    machine_stiffness: Option<f64>,
    /// The number of harmonics.
    #[param(nullable = false)]
    harmonics: Option<usize>,
    /// Number of radii at which the friction work per area is wanted, evenly spaced from the centre to the edge, both
    /// included. Give this or `radii`, or neither.
    #[param(nullable = false)]
    points: Option<usize>,
    /// Radii for it, m, separated by commas or given one by one.
    #[param(nullable = false)]
    radii: Option<String>,
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC
    /// stream), or a plot as `svg` or `png`. The friction work per area is in `columns` alone. If it is left out, `Accept`
    /// decides.
    #[param(nullable = false, default = "columns")]
    format: Option<String>,
}

/// A [`CycleQuery`] that has been checked.
pub struct Wanted {
    task: CycleTask,
    format: Option<Format>,
}

impl QueryParams for Wanted {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<Wanted> {
        let mut numbers = |name: &'static str| {
            let found = query.list(name, "numbers with commas between them", |text| text.parse().ok());
            if let Some(found) = &found {
                query.faults.length(JsonPath::Root.member(name), found.len(), &QUERY_RADII);
            }
            found
        };
        let (displacement, force, radii) = (numbers("displacement"), numbers("force"), numbers("radii"));
        let (stiffness, harmonics) = (query.number("machine_stiffness", "a number"), query.number("harmonics", COUNT));
        let (points, format) = (query.number("points", COUNT), query.format(&Format::ALL));
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
                query.faults.add(JsonPath::Root.member("displacement"), "give `displacement` or `force`");
                return None;
            }
            (Some(_), Some(_)) => {
                query.faults.add(JsonPath::Root.member("force"), "conflicts with `displacement`: give one of them");
                return None;
            }
        };
        let density = (points.is_some() || radii.is_some()).then_some(WorkDensity { points, radii });
        let options = CycleOptions { drive, stiffness, harmonics, density };
        Some(Wanted { task: options.check(CyclePlaces::QUERY, &mut query.faults)?, format })
    }
}

/// Compute steady cycles
///
/// Moves a contact back and forth at constant load until every cycle is as the one before, in closed form: a displacement
/// or a force that is a cosine, directly or through a machine of finite stiffness. Returns work, stiffness, loss factor and
/// slip for each amplitude and, if asked for, the harmonics and the friction work per area, or the same cycles under many
/// loads. Nothing is stored.
#[utoipa::path(
    post, path = "/cycle", tag = "simulation", params(CycleFormat),
    request_body(content = CycleRequest, examples(
        ("amplitudes" = (summary = "Displacement amplitudes, with the describing function", value = json!({
            "contact": ContactDefinition::example(), "drive": {"displacement": [5e-8, 1e-7, 2e-7]}, "harmonics": 1
        }))),
        ("machine" = (summary = "A force through a machine, with the friction work per area", value = json!({
            "contact": ContactDefinition::example(), "drive": {"force": 2.0}, "machine": {"stiffness": 2e7},
            "work_density": {"points": 50}
        }))),
        ("map" = (summary = "A fretting map", value = json!({
            "contact": ContactDefinition::example(), "drive": {"displacement": [1e-8, 3e-8, 1e-7, 3e-7]},
            "map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 40}}
        })))
    )),
    responses((status = 200, description = "The cycles, one for each amplitude, under each load of a map", body = CycleReply))
)]
pub async fn compute_steady_cycle(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    query: Result<CheckedQuery<CycleFormat>, Problem>,
    request: CheckedBody<CycleRequest>,
) -> Result<Response, Problem> {
    let CheckedQuery(query) = query?;
    let format = Format::chosen(query.format, &headers, &Format::ALL)?;
    let (stop, _guard) = app.pool.deadline();
    let CheckedBody { body: (definition, setup, task), mut held, .. } = request;
    let bytes = bytes::of_cycle(&task) + bytes::of_shape(&definition.profile);
    held.resize(&app.pool, bytes + format.bytes(task.rows(), bytes::cycle_row(&task))).await?;
    let cost = cost::of_cycle(&setup.profile, &task).saturating_add(format.cost());
    let work = move || {
        let solve = || simulation::cycle_of(setup, &task, &stop);
        let (contact, reply) = otlp::part!("solve").in_scope(solve)?;
        written(format, &reply, &contact, &task)
    };
    Ok(held.on(format.reply(app.pool.run(cost, work).await??)))
}

/// Get the steady cycles of a contact
///
/// As `POST /cycle`, of the contact at its present load, whatever its history. Nothing changes.
#[utoipa::path(
    get, path = "/contacts/{id}/cycle", tag = "contacts", params(ContactPath, CycleQuery),
    responses((status = 200, description = "The cycles, one for each amplitude", body = CycleReply,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_steady_cycle(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(wanted): CheckedQuery<Wanted>,
) -> Result<Response, Problem> {
    let Wanted { task, format } = wanted;
    let format = Format::chosen(format, &headers, &Format::ALL)?;
    if headers.contains_key(header::IF_NONE_MATCH) {
        // Before anything is computed.
        let tag = format.tag(&app.sessions.get(id).await?.sequence.to_string());
        if reply::is_current(&headers, &tag) {
            return Ok(reply::not_modified(&tag));
        }
    }
    let extra = (format.bytes(task.rows(), bytes::cycle_row(&task)), format.cost());
    let write = move |cycles: &CycleReply, contact: &Contact, task: &CycleTask| written(format, cycles, contact, task);
    let (sequence, body, memory) = app.sessions.cycle(id, task, extra, write).await?;
    let tag = format.tag(&sequence.to_string());
    Ok(reply::holding(reply::tagged(format.reply(body?), &tag), memory))
}

/// The cycles of a contact in a format.
fn written(format: Format, cycles: &CycleReply, contact: &Contact, task: &CycleTask) -> Result<Vec<u8>, Problem> {
    format.write(cycles, || plots::cycle(contact, cycles, task), || tables::cycle(cycles, task))
}
