//! Laws of refusals: every one is a problem that names its kind and the place.

use serde_json::Value;
use stickslip_compute::Refusal;
use stickslip_wire::Code;

/// # Panics
/// If the refusal of `body` violates the API contract.
pub fn check(body: &[u8], refusal: Refusal) {
    let code = refusal.code;
    assert!(!matches!(code, Code::Internal | Code::Overloaded), "{refusal:?}");
    let document = refusal.document("fuzz");
    assert!((400..500).contains(&document.status), "{document:?}");
    assert!(!document.detail.is_empty() && !document.detail.contains("NaN"), "{document:?}");
    let parsed = serde_json::from_slice::<Value>(body);
    if code == Code::NotJson {
        assert!(parsed.is_err(), "it is JSON: {document:?}");
        return;
    }
    assert!(!document.errors.is_empty(), "no place is named: {document:?}");
    // Numbers beyond all doubles are JSON, though this parser of values does not take them.
    let Ok(value) = parsed else { return };
    // Of members of one name it keeps the last.
    let quotes = |text: &[u8]| text.iter().filter(|byte| **byte == b'"').count();
    if quotes(body) != quotes(value.to_string().as_bytes()) {
        return;
    }
    for fault in &document.errors {
        assert!(!fault.detail.is_empty(), "{document:?}");
        let missing = fault.detail.contains("missing") || fault.detail.starts_with("give ");
        assert!(
            points_somewhere(&value, &fault.pointer, missing),
            "{} is not in the body: {document:?}",
            fault.pointer
        );
    }
}

/// Whether a pointer names something that is there, or else a member that its object misses.
fn points_somewhere(body: &Value, pointer: &str, missing: bool) -> bool {
    if pointer.is_empty() {
        return !body.is_object();
    }
    // Names are quoted from the body, and cut short where they are long.
    if pointer.ends_with('…') || body.pointer(pointer).is_some() {
        return true;
    }
    let parent = pointer.rsplit_once('/').and_then(|(parent, _)| body.pointer(parent));
    parent.is_some_and(|parent| parent.is_array() || (missing && parent.is_object()))
}
