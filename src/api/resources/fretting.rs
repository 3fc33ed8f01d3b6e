//! `/fretting`: fatigue criteria over the steady cycle of a contact; nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_wire::{ContactDefinition, FrettingReply, FrettingRequest};

use crate::api::extract::CheckedBody;
use crate::api::formats::{Format, SUBSURFACE_ROW, plots, tables};
use crate::api::problem::{Code, Problem};
use crate::api::query::{CheckedQuery, QueryParams, QueryReader};
use crate::api::state::App;
use crate::otlp;
use crate::simulation::{self, bytes, cost};

/// How the criteria are written.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct FrettingFormat {
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC stream), or a
    /// picture as `svg` or `png`: of one criterion in a plane or on the surface. If it is left out, `Accept` decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for FrettingFormat {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<FrettingFormat> {
        Some(FrettingFormat { format: query.format(&Format::ALL) })
    }
}

/// Rate a cycle for fretting fatigue
///
/// Repeats a path until it closes, computes the stress tensor at every place over the steady cycle and rates it by fatigue
/// criteria: where would a crack start, on which plane, and how far is it from a limit. Nothing is stored.
#[utoipa::path(
    post, path = "/fretting", tag = "simulation", params(FrettingFormat),
    request_body(content = FrettingRequest, examples(
        ("section" = (summary = "Crossland's criterion under a cycle in partial slip", value = json!({
            "contact": ContactDefinition::example(),
            "path": {"cycles": {"displacement": 1e-7, "count": 1}},
            "body": "first",
            "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 25], "z": [0.0, 6e-5, 7]},
            "criteria": {"crossland": {"alpha": 0.3, "limit": 3e8}}
        }))),
        ("surface" = (summary = "Critical planes and Ruiz's parameters on the surface, with a bulk stress", value = json!({
            "contact": ContactDefinition::example(),
            "path": {"displacement": [1e-7, -1e-7]},
            "body": "first",
            "surface": {"x": [-1.2e-4, 1.2e-4, 9], "y": [-1e-5, 1e-5, 2]},
            "bulk": {"amplitude": 5e7},
            "criteria": {"findley": {"k": 0.3}, "ruiz": {}, "friction_work": {}}
        })))
    )),
    responses((status = 200, description = "The criteria, place by place", body = FrettingReply))
)]
pub async fn rate_fretting(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    query: Result<CheckedQuery<FrettingFormat>, Problem>,
    request: CheckedBody<FrettingRequest>,
) -> Result<Response, Problem> {
    let CheckedQuery(query) = query?;
    let format = Format::chosen(query.format, &headers, &Format::ALL)?;
    let (stop, _guard) = app.pool.deadline();
    let CheckedBody { body: (definition, setup, task), mut held, .. } = request;
    let bytes = bytes::of_fretting(&task) + bytes::of_shape(&definition.profile);
    held.resize(&app.pool, bytes + format.bytes(task.places.count(), SUBSURFACE_ROW)).await?;
    let cost = cost::of_fretting(&setup.profile, &task).saturating_add(format.cost());
    let work = move || {
        let reply = otlp::part!("solve").in_scope(|| simulation::fretting(setup, &task, &stop))?;
        if format.is_plot() && !task.is_section() {
            return Err(Problem::at(Code::InvalidInput, "/criteria", plots::NO_RATED_SECTION));
        }
        format.write(&reply, || plots::fretting(&reply, &task.places), || tables::fretting(&reply))
    };
    Ok(held.on(format.reply(app.pool.run(cost, work).await??)))
}
