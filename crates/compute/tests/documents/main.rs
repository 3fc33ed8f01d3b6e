//! Documents in, documents out, without a server: what each computation replies, warns of and refuses. That the service
//! replies the same is tested in `tests/api/computations.rs`, that it refuses the same in `tests/api/faults.rs`.

mod accuracy;
mod adhesion;
mod conductance;
mod cycle;
mod cycles_path;
mod defaults;
mod fit;
mod fretting;
mod json;
mod line_contacts;
mod lives;
mod load_curves;
mod parse;
mod plane;
mod preparation;
mod profile_fit;
mod profiles;
mod protocols;
mod reported;
mod shear_strength;
mod simulate;
mod sliders;
mod subsurface;
mod sweeps;
mod tables;
mod twist;
mod uncertain_inputs;
mod viscoelastic;
mod warnings;
mod wear;
mod where_parts_meet;

use serde_json::Value;
use stickslip_compute::computations::{DisplayOptions, compute, entries};
use stickslip_compute::formats::Format;
use stickslip_compute::{Flag, Refusal};
use stickslip_wire::ProblemDocument;

type Reply<T = Value> = Result<T, Box<ProblemDocument>>;

/// What the computation at this path writes, or its refusal.
fn computed(path: &str, text: &str, options: DisplayOptions) -> Reply<Vec<u8>> {
    let entry = entries().into_iter().find(|entry| entry.about.route.is_some_and(|route| route.path == path));
    let name = entry.unwrap_or_else(|| panic!("there is no computation at {path}")).about.name;
    compute(name, text.as_bytes(), options, &Flag::default()).map_err(refusal)
}

fn refusal(refusal: Refusal) -> Box<ProblemDocument> {
    Box::new(refusal.document("test"))
}

/// The reply of the computation at this path, or its refusal; that of a sweep too.
fn post(path: &str, body: &Value) -> Reply {
    if path == "/sweep" {
        return sweeps::swept(&body.to_string());
    }
    let text = computed(path, &body.to_string(), DisplayOptions::in_format(Format::Columns))?;
    Ok(serde_json::from_slice(&text).unwrap())
}

/// What a computation writes in a format; a picture is of what is chosen.
fn written(path: &str, format: Format, choice: Option<&'static str>, body: &Value) -> String {
    let options = DisplayOptions { choice, ..DisplayOptions::in_format(format) };
    String::from_utf8(computed(path, &body.to_string(), options).unwrap()).unwrap()
}

fn good(reply: Reply) -> Value {
    reply.unwrap_or_else(|refused| panic!("{refused:?}"))
}

fn problem(reply: Reply) -> ProblemDocument {
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
