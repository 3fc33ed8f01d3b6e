//! The document before the handlers add themselves: title, introduction, tags, and schemas that no handler names.

use utoipa::OpenApi;
use utoipa::openapi::security::{HttpAuthScheme, HttpBuilder, SecurityScheme};

use stickslip_wire::{EndEvent, JobEndEvent, ProblemDocument, limits, profile};

use crate::access::Role;
use crate::api::problem::MEDIA_TYPE;
use crate::api::request_limits::{BODY_LIMIT, PAGE};

#[derive(OpenApi)]
#[openapi(
    info(title = "stickslip"),
    // A document without it is of no server at all to some tools.
    servers((url = "/", description = "The server that this document comes from")),
    components(schemas(ProblemDocument, EndEvent, JobEndEvent)),
    tags(
        (name = "simulation", description = "A path from beginning to end, in one call"),
        (name = "protocols", description = "Motions that leave little shear stress"),
        (name = "contacts", description = "Stored contacts with their history"),
        (name = "jobs", description = "Background sweeps"),
        (name = "service", description = "Health, and the OpenAPI document")
    )
)]
struct Base;

pub fn base() -> utoipa::openapi::OpenApi {
    let mut base = Base::openapi();
    base.info.description = Some(introduction());
    let components = base.components.get_or_insert_default();
    components.schemas.extend(profile::schemas());
    let roles = Role::ALL.map(|role| format!("`{}`", role.name())).join(", ");
    let key = HttpBuilder::new().scheme(HttpAuthScheme::Bearer).description(Some(format!(
        "A key of the server, if it uses keys. Each key has one or more of the roles {roles}; the first includes the \
         second. A key gives access only to the contacts of its tenant."
    )));
    components.add_security_scheme("key", SecurityScheme::Http(key.build()));
    base
}

fn introduction() -> String {
    format!(
        "Frictional contact of two elastic bodies with its slip history: tangential displacement, force, slip and \
         stress along any path, exactly. All quantities are in SI units. Positive displacement gives positive force \
         and positive shear stress. Numbers that are infinite are `null`.\n\nEvery refusal is a problem document (RFC \
         9457, `{MEDIA_TYPE}`) with a JSON pointer to each fault. A refused call has changed nothing, except that \
         after `internal`, `stopping` and `storage_unavailable` a change may have been stored; a read never changes \
         anything.\n\nThe work for a request ends when its client disconnects, and at the deadline of the server (422 \
         `too_much_work`). Loading a contact counts as work for the request; what has been loaded is kept for the next \
         request.\n\nLimits: a body has at most {} bytes, a path {} moves, a stress request {} radii, the memory of a \
         contact {} pieces, a page {} items; the springs of the spring foundation times moves and stress points are at \
         most {}.",
        BODY_LIMIT,
        limits::PATH_MOVES.end(),
        limits::STRESS_POINTS.end(),
        limits::MEMORY_DEPTH,
        PAGE.end(),
        limits::SPRING_STEPS,
    )
}
