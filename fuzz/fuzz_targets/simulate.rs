//! Any bytes as the body of `POST /simulate`, with the laws of `tests/harness`.

#![no_main]

#[path = "../../tests/harness/mod.rs"]
mod harness;

libfuzzer_sys::fuzz_target!(|body: &[u8]| {
    harness::examine(body);
});
