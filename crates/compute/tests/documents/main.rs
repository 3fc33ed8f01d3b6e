//! Documents in, documents out, without a server: what each computation replies, warns of and refuses. That the service
//! replies the same is tested in `tests/api/computations.rs`, that it refuses the same in `tests/api/faults.rs`.

mod accuracy;
mod cycle;
mod cycles_path;
mod fretting;
mod json;
mod load_curves;
mod parse;
mod profile_fit;
mod profiles;
mod protocols;
mod subsurface;
mod warnings;

use serde_json::Value;
use stickslip_compute::computations::{DisplayOptions, compute, entries};
use stickslip_compute::formats::Format;
use stickslip_compute::{Flag, Refusal};
use stickslip_wire::ProblemDocument;

/// The reply of the computation at this path, or its refusal.
fn post(path: &str, body: &Value) -> Result<Value, Box<ProblemDocument>> {
    let entry = entries().into_iter().find(|entry| entry.about.route.is_some_and(|route| route.path == path));
    let name = entry.unwrap_or_else(|| panic!("there is no computation at {path}")).about.name;
    let options = DisplayOptions::in_format(Format::Columns);
    let reply = compute(name, body.to_string().as_bytes(), options, &Flag::default());
    match reply {
        Ok(text) => Ok(serde_json::from_slice(&text).unwrap()),
        Err(error) => Err(Box::new(Refusal::from(error).document("test"))),
    }
}

fn good(reply: Result<Value, Box<ProblemDocument>>) -> Value {
    reply.unwrap_or_else(|refused| panic!("{refused:?}"))
}

fn problem(reply: Result<Value, Box<ProblemDocument>>) -> ProblemDocument {
    *reply.unwrap_err()
}

/// Asserts that a body is refused with a code, at a place, by a text with these words.
fn assert_refused(path: &str, body: &Value, (code, pointer, words): (&str, &str, &str)) {
    let refused = problem(post(path, body));
    let text = body.to_string();
    let shown = format!("{path} {:.300}..{}: {refused:?}", text, &text[text.len().saturating_sub(200)..]);
    assert_eq!((refused.status, refused.code.as_str()), (422, code), "{shown}");
    assert_eq!(refused.errors[0].pointer, pointer, "{shown}");
    assert!(refused.errors[0].detail.contains(words), "{shown}");
}
