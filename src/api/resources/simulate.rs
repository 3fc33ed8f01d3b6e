//! `/simulate`: the states and stresses of a contact along a path; nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;

use crate::api::extract::CheckedBody;
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::App;
use crate::otlp;
use crate::simulation::{self, bytes, cost};
use stickslip_wire::{ContactDefinition, SimulateReply, SimulateRequest};

/// Simulate a path
///
/// Follows a path from the preloaded contact and returns the states along it, and the stresses and their extrema at its
/// end if asked for. Nothing is stored, so that a repeated request simply runs again.
#[utoipa::path(
    post, path = "/simulate", tag = "simulation",
    request_body(content = SimulateRequest, examples(
        ("back and forth" = (summary = "Falling amplitude, with the residual stresses", value = json!({
            "contact": ContactDefinition::example(),
            "path": {"falling_amplitude": {"reversals": 20}},
            "stress": {"points": 200}, "residual": true
        }))),
        ("by force" = (summary = "A cycle of the tangential force, the last state alone", value = json!({
            "contact": {
                "profile": {"type": "sphere", "radius": 0.01},
                "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                "friction": 0.3,
                "preload": {"indentation": 1e-6}
            },
            "path": {"force": [0.5, -0.5, 0.5]}, "steps": "last", "solver": "exact"
        }))),
        ("springs" = (summary = "The same contact on the paper's spring foundation", value = json!({
            "contact": {
                "profile": {"type": "sphere", "radius": 0.01},
                "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                "friction": 0.3,
                "preload": {"contact_radius": 1e-4}
            },
            "path": {"moves": [{"displacement": 1e-7}, {"indentation": 8e-7, "displacement": 0.0}]},
            "solver": {"springs": {"count": 1000}}
        })))
    )),
    responses((status = 200, description = "States, and what else was asked for", body = SimulateReply))
)]
pub async fn simulate_path(
    State(app): State<Arc<App>>,
    request: CheckedBody<SimulateRequest>,
) -> Result<Response, Problem> {
    let (stop, _guard) = app.pool.deadline();
    let (simulation, mut held) = (request.body, request.held);
    held.resize(&app.pool, bytes::of_simulation(&simulation)).await?;
    let cost = cost::of_simulation(&simulation);
    let room = bytes::reply_length(&simulation);
    let solve = move || simulation::simulate(&simulation, &stop);
    let work = move || reply::written_in(room, &otlp::part!("solve").in_scope(solve)?);
    Ok(held.on(reply::json(app.pool.run(cost, work).await??)))
}
