//! Which key an operation needs, where the server has keys.

use serde_json::{Value, json};

use super::operations;
use super::refusals::refusal;
use crate::access::Role;
use crate::api::middleware::access_control::{Need, need};

/// Writes the security scheme, and with each operation the key that it needs.
pub fn write(document: &mut Value) {
    let roles = Role::ALL.map(|role| format!("`{}`", role.name())).join(", ");
    document["components"]["securitySchemes"] = json!({"key": {
        "type": "http", "scheme": "bearer",
        "description": format!("A key of the server, where it has keys. Each has one role or several out of {roles}; the first \
            includes the second. A key shows the contacts of its tenant alone."),
    }});
    for (method, path, operation) in operations(document) {
        let Need::Key(role) = need(&method.to_uppercase(), path) else { continue };
        operation["security"] = json!([{"key": []}, {}]);
        let missing = "There is no key with the request, or it is not a key of the server";
        operation["responses"]["401"] = refusal(missing);
        operation["responses"]["403"] = refusal(&format!("The key does not have the role `{}`", role.name()));
    }
}
