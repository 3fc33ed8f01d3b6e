//! The refusals that an operation can meet, and the key that it needs where the server has keys.

use serde_json::{Value, json};

use super::operations;
use crate::access::Role;
use crate::api::facts::{FactsOfRoutes, Need, Refusal};
use crate::api::problem::MEDIA_TYPE;
use crate::server::limits::HEAD;

/// Of every operation with a body.
const OF_BODIES: &[Refusal] = &[
    ("400", "The body is not JSON"),
    ("408", "The body did not arrive in time"),
    ("413", "The body is too large"),
    ("415", "The body is not declared as a media type that the operation takes"),
];

/// Adds to every operation the refusals that it can meet, and the key that it needs.
pub fn write(document: &mut Value, facts: &FactsOfRoutes) {
    let roles = Role::ALL.map(|role| format!("`{}`", role.name())).join(", ");
    document["components"]["securitySchemes"] = json!({"key": {
        "type": "http", "scheme": "bearer",
        "description": format!("A key of the server, where it has keys. Each has one role or several out of {roles}; \
            the first includes the second. A key shows the contacts of its tenant alone."),
    }});
    for (method, path, operation) in operations(document) {
        let Some(facts) = facts.get(&method.to_uppercase(), path) else { continue };
        if facts.optional_body {
            operation["requestBody"]["required"] = json!(false);
        }
        let bodies = if operation["requestBody"].is_object() { OF_BODIES } else { &[] };
        operation["security"] = json!([]);
        let responses = &mut operation["responses"];
        responses["431"] = json!({"description": format!("The head of the request has more than {HEAD} bytes")});
        if path.contains('{') {
            responses["404"] = refusal("Not found");
        }
        for (status, description) in facts.refusals.iter().copied().flatten().chain(bodies) {
            responses[status] = refusal(description);
        }
        if let Need::Key(role) = facts.need {
            responses["401"] = refusal("There is no key with the request, or it is not a key of the server");
            responses["403"] = refusal(&format!(
                "The key does not have the role `{}`, or, without keys, the request comes from another site",
                role.name()
            ));
            operation["security"] = json!([{"key": []}, {}]);
        }
    }
}

pub fn refusal(description: &str) -> Value {
    let schema = json!({"$ref": "#/components/schemas/ProblemDocument"});
    json!({"description": description, "content": {MEDIA_TYPE: {"schema": schema}}})
}
