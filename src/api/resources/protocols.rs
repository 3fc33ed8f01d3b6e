//! `/protocols`: paths that leave little shear stress.

use axum::response::Response;

use crate::api::extract::CheckedBody;
use crate::api::problem::Problem;
use crate::api::reply;
use crate::api::state::TenantApp;
use crate::simulation::{self, bytes, cost};
use stickslip_wire::protocol::ProtocolSubject;
use stickslip_wire::{ContactDefinition, ProtocolReply, ProtocolRequest};

/// Find a protocol
///
/// Finds displacements that leave little shear stress, in a number of reversals or in as few as reach a target, and
/// says what remains, how far that may be from the optimum, and what the other laws would leave. Nothing is stored or
/// changed.
#[utoipa::path(
    post, path = "/protocols", tag = "protocols",
    request_body(content = ProtocolRequest, examples(
        ("best" = (summary = "The least that 20 reversals can leave on a sphere", value = json!({
            "contact": ContactDefinition::example(),
            "reversals": 20, "kind": "minimax", "end": "free"
        }))),
        ("target" = (summary = "The fewest reversals that leave a quarter, and how robust they are with a coarse actuator", value = json!({
            "contact": {
                "profile": {"type": "power_law", "exponent": 3.0, "coefficient": 1e4},
                "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
                "friction": 0.3,
                "preload": {"normal_force": 10.0}
            },
            "target": 0.25, "kind": "equal_peaks",
            "robustness": {"amplitude_error": 0.01, "friction_error": 0.05, "samples": 100, "seed": 1}
        })))
    )),
    responses((status = 200, description = "The path, and what remains", body = ProtocolReply))
)]
pub async fn find_protocol(
    TenantApp(app): TenantApp,
    request: CheckedBody<ProtocolRequest>,
) -> Result<Response, Problem> {
    let ((subject, task), mut held) = (request.body, request.held);
    match subject {
        ProtocolSubject::Living(id, contact) => {
            let (_, body, memory) = app.sessions.protocol(id, contact.map(|contact| *contact), task).await?;
            Ok(reply::holding(reply::json(body), memory))
        }
        ProtocolSubject::Virgin(made, first) => {
            let (stop, _guard) = app.pool.deadline();
            let (definition, setup) = *made;
            let bytes = bytes::of_protocol(&task) + bytes::of_shape(&definition.profile);
            held.resize(&app.pool, bytes).await?;
            let cost = cost::of_protocol(&setup.profile, &task, 0);
            let work = move || {
                let found = simulation::protocol_for(&setup, first, &task, &stop)?;
                reply::written(&found)
            };
            Ok(held.on(reply::json(app.pool.run(cost, work).await??)))
        }
    }
}
