//! `/materials`: elastic constants of known materials.

use stickslip_wire::materials::{KnownMaterial, MATERIALS};

use super::prelude::*;

/// Get known materials
///
/// Typical elastic constants of materials by their names, with their source and the range that such materials have.
#[utoipa::path(
    get, path = "/materials", tag = "service",
    responses((status = 200, description = "The materials", body = Vec<KnownMaterial>))
)]
pub async fn get_materials() -> Response {
    reply::json(MATERIALS.into())
}
