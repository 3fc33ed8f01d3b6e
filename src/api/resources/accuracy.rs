//! `/accuracy`: the time and the error of each solver on a path; nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;

use crate::api::extract::CheckedBody;
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::App;
use crate::simulation::{self, bytes, cost};
use stickslip_wire::{AccuracyReply, AccuracyRequest, ContactDefinition};

/// Compare solvers
///
/// Follows a path from the preloaded contact with each of the solvers, and compares the forces along it and the shear
/// stresses at its end with a reference: the exact solver, refined where moves are curved. This shows what a coarser
/// model would do to your own numbers. A solver that cannot follow the path has the reason in its row. The springs of
/// all solvers together, times moves and stress points, have the limit of one simulation. Nothing is stored.
#[utoipa::path(
    post, path = "/accuracy", tag = "simulation",
    request_body(content = AccuracyRequest, examples(
        ("as it is" = (summary = "A contact and a path, and the usual solvers", value = json!({
            "contact": ContactDefinition::example(),
            "path": {"falling_amplitude": {"reversals": 20}}
        }))),
        ("own solvers" = (summary = "Two spring foundations, at given radii", value = json!({
            "contact": {
                "profile": {"type": "cone", "slope": 0.05},
                "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                "friction": 0.3,
                "preload": {"contact_radius": 1e-4}
            },
            "path": {"displacement": [1e-7, -1e-7, 0.0]},
            "stress": {"radii": [2e-5, 5e-5, 8e-5], "fields": ["shear"]},
            "solvers": ["exact", {"springs": {"count": 200}}, {"springs": {"count": 2000}}]
        })))
    )),
    responses((status = 200, description = "The reference, and a row a solver", body = AccuracyReply))
)]
pub async fn compare_solvers(
    State(app): State<Arc<App>>,
    request: CheckedBody<AccuracyRequest>,
) -> Result<Response, Problem> {
    let (stop, _guard) = app.pool.deadline();
    let (comparison, mut held) = (request.body, request.held);
    held.resize(&app.pool, bytes::of_comparison(&comparison)).await?;
    let cost = cost::of_comparison(&comparison);
    let work = move || reply::written(&simulation::compare_solvers(&comparison, &stop)?);
    Ok(held.on(reply::json(app.pool.run(cost, work).await??)))
}
