//! `/profiles/fit`: a scan becomes a profile; nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_wire::{ProfileFitReply, ProfileFitRequest};

use crate::api::extract::CheckedBody;
use crate::api::formats::{Format, STRESS_ROW, plots, tables};
use crate::api::problem::Problem;
use crate::api::query::{CheckedQuery, QueryParams, QueryReader};
use crate::api::state::App;
use crate::otlp;
use crate::simulation::{self, bytes, cost};

/// How the fit is written.
#[derive(IntoParams)]
#[into_params(parameter_in = Query)]
pub struct ProfileFitFormat {
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC stream): the points,
    /// each `fitted`, `left_out` or of the `profile`; or a picture of them as `svg` or `png`. If it is left out, `Accept` decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for ProfileFitFormat {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<ProfileFitFormat> {
        Some(ProfileFitFormat { format: query.format(&Format::ALL) })
    }
}

/// Fit a profile to a scan
///
/// Finds the axis of a scan of heights, takes off its tilt, leaves out its outliers and fits the smoothest profile that its noise
/// allows and whose contact is a full circle; with `load`, says what the scan means for the contact, with standard errors. Nothing
/// is stored.
#[utoipa::path(
    post, path = "/profiles/fit", tag = "simulation", params(ProfileFitFormat),
    request_body(content = ProfileFitRequest, examples(
        ("line" = (summary = "A line over a ball, in micrometres and nanometres", value = json!({
            "scan": {"line": {
                "x": [-70.0, -60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0],
                "z": [-245.2, -179.7, -125.3, -79.6, -45.3, -20.4, -4.6, 0.3, -5.1, -19.8, -44.7, -80.2, -124.9, -180.4, null]
            }},
            "units": {"lateral": "um", "height": "nm"},
            "load": {
                "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
                "friction": 0.3, "preload": {"normal_force": 1.0}
            }
        })))
    )),
    responses((status = 200, description = "The profile, and what is left of the scan", body = ProfileFitReply))
)]
pub async fn fit_profile(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    query: Result<CheckedQuery<ProfileFitFormat>, Problem>,
    request: CheckedBody<ProfileFitRequest>,
) -> Result<Response, Problem> {
    let CheckedQuery(query) = query?;
    let format = Format::chosen(query.format, &headers, &Format::ALL)?;
    let (stop, _guard) = app.pool.deadline();
    let CheckedBody { body: task, mut held, .. } = request;
    held.resize(&app.pool, bytes::of_profile_fit(&task) + format.bytes(tables::SCAN_ROWS, STRESS_ROW)).await?;
    let cost = cost::of_profile_fit(&task);
    let work = move || {
        let reply = otlp::part!("solve").in_scope(|| simulation::fit_profile(task, &stop))?;
        format.write(&reply, || plots::profile_fit(&reply), || tables::profile_fit(&reply))
    };
    Ok(held.on(format.reply(app.pool.run(cost, work).await??)))
}
