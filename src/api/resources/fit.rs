//! `/fit`: measured loops become the friction and the stiffness of their contact; nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use utoipa::IntoParams;

use stickslip_wire::{FitReply, FitRequest};

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
pub struct FitFormat {
    /// `columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC stream): the points of
    /// the loops, measured and fitted; or a picture of them and of the residual as `svg` or `png`. If it is left out, `Accept` decides.
    #[param(value_type = Option<String>, nullable = false, default = "columns")]
    format: Option<Format>,
}

impl QueryParams for FitFormat {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<FitFormat> {
        Some(FitFormat { format: query.format(&Format::ALL) })
    }
}

/// Fit friction and stiffness to measured loops
///
/// Finds the turning points of force over displacement as a bench has measured them, and the coefficient of friction, the moduli,
/// the compliance of the machine, the offsets and the drift that fit best. Says what the loops determine, what only in combination,
/// and within which intervals. Nothing is stored.
#[utoipa::path(
    post, path = "/fit", tag = "simulation", params(FitFormat),
    request_body(content = FitRequest, examples(
        ("steady" = (summary = "A steady loop that reaches gross slip, in micrometres", value = json!({
            "contact": {
                "profile": {"type": "sphere", "radius": 0.01},
                "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
                "friction": 0.2, "preload": {"normal_force": 10.0}
            },
            "loops": [{
                "displacement": [0.2583, 0.2152, 0.1722, 0.1291, 0.0861, 0.043, 0.0, -0.043, -0.0861, -0.1291, -0.1722, -0.2152, -0.2583, -0.2152, -0.1722, -0.1291, -0.0861, -0.043, 0.0, 0.043, 0.0861, 0.1291, 0.1722, 0.2152, 0.2583], "force": [3.001, 1.923, 0.888, -0.025, -0.881, -1.625, -2.231, -2.733, -3.0, -2.993, -2.989, -3.0, -2.994, -1.921, -0.901, 0.031, 0.865, 1.607, 2.234, 2.732, 2.998, 2.997, 3.001, 2.987, 2.999], "start": "steady"
            }],
            "units": {"displacement": "um", "force": "N"},
            "free": ["friction", "g_star"],
            "known": {"machine_compliance": {"value": 0.0}}
        })))
    )),
    responses((status = 200, description = "What the loops say, and what they leave open", body = FitReply))
)]
pub async fn fit_loops(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    query: Result<CheckedQuery<FitFormat>, Problem>,
    request: CheckedBody<FitRequest>,
) -> Result<Response, Problem> {
    let CheckedQuery(query) = query?;
    let format = Format::chosen(query.format, &headers, &Format::ALL)?;
    let (stop, _guard) = app.pool.deadline();
    let CheckedBody { body: task, mut held, .. } = request;
    held.resize(&app.pool, bytes::of_fit(&task) + format.bytes(task.points(), STRESS_ROW)).await?;
    let cost = cost::of_fit(&task);
    let work = move || {
        let reply = otlp::part!("solve").in_scope(|| simulation::fit_loops(task, &stop))?;
        format.write(&reply, || plots::loop_fit(&reply), || tables::loop_fit(&reply))
    };
    Ok(held.on(format.reply(app.pool.run(cost, work).await??)))
}
