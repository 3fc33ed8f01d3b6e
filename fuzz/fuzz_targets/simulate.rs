//! Any bytes as the body of `POST /simulate`, with the laws of `crates/compute/tests/random/harness`.

#![no_main]

#[path = "../../crates/compute/tests/random/harness/mod.rs"]
mod harness;

libfuzzer_sys::fuzz_target!(|body: &[u8]| {
    harness::examine(body);
});
