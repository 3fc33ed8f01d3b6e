//! The refusals that an operation can meet, and the key that it needs where the server has keys.

use serde_json::{Value, json};

use super::operations;
use crate::access::Role;
use crate::api::middleware::access_control::{Need, need};
use crate::api::problem::MEDIA_TYPE;
use crate::server::limits::HEAD;

/// Adds to every operation the refusals that it can meet.
pub fn write(document: &mut Value) {
    for (method, path, operation) in operations(document) {
        let responses = &mut operation["responses"];
        responses["431"] = json!({"description": format!("The head of the request has more than {HEAD} bytes")});
        let job = path.starts_with("/jobs");
        let changes = ["/move", "/path", "/relax", "/observations"].iter().any(|end| path.ends_with(end));
        let changes_contact = changes || (["delete", "patch"].contains(&method) && !job);
        let has_body = ["post", "patch"].contains(&method);
        let computes =
            ["/simulate", "/accuracy", "/protocols", "/cycle", "/fretting", "/profiles/fit", "/fit", "/sweep"]
                .contains(&path);
        let about_contacts = path.starts_with("/contacts") || computes || job;
        let refusals = [
            (has_body, "400", "The body is not JSON"),
            (path.contains('{') || path == "/protocols", "404", "There is no such thing"),
            (path.contains("/{id}") && !job, "410", "The contact was idle for so long that it has expired"),
            (has_body, "408", "The body did not arrive in time"),
            (changes_contact || path == "/protocols", "409", "The state of the contact forbids this"),
            (changes_contact, "412", "The contact is not at the sequence given in If-Match"),
            (path.ends_with("/result"), "409", "The job has not ended, or has failed"),
            (about_contacts, "429", "The client has as much of something as it may; try again after Retry-After"),
            (has_body, "413", "The body is too large"),
            (has_body, "415", "The body is not declared as application/json"),
            (about_contacts, "422", "The request is invalid, or the mechanics has no answer to it"),
            (about_contacts || path == "/readyz", "503", "The server is busy; try again after Retry-After"),
        ];
        for (_, status, description) in refusals.into_iter().filter(|(applies, ..)| *applies) {
            responses[status] = refusal(description);
        }
    }
}

/// Writes the security scheme, and with each operation the key that it needs.
pub fn write_keys(document: &mut Value) {
    let roles = Role::ALL.map(|role| format!("`{}`", role.name())).join(", ");
    document["components"]["securitySchemes"] = json!({"key": {
        "type": "http", "scheme": "bearer",
        "description": format!("A key of the server, where it has keys. Each has one role or several out of {roles}; the first \
            includes the second. A key shows the contacts of its tenant alone."),
    }});
    for (method, path, operation) in operations(document) {
        let Need::Key(role) = need(&method.to_uppercase(), path) else {
            operation["security"] = json!([]);
            continue;
        };
        operation["security"] = json!([{"key": []}, {}]);
        let missing = "There is no key with the request, or it is not a key of the server";
        operation["responses"]["401"] = refusal(missing);
        operation["responses"]["403"] = refusal(&format!(
            "The key does not have the role `{}`, or, without keys, the request comes from another site",
            role.name()
        ));
    }
}

/// A refusal as a response.
pub fn refusal(description: &str) -> Value {
    let schema = json!({"$ref": "#/components/schemas/ProblemDocument"});
    json!({"description": description, "content": {MEDIA_TYPE: {"schema": schema}}})
}
