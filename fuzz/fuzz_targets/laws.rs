//! Any bytes as a shape, a load and a path, with the laws of `crates/mechanics/tests/physics/every_shape`.

#![no_main]

#[path = "../../crates/mechanics/tests/physics/every_shape/draw.rs"]
mod draw;
#[path = "../../crates/mechanics/tests/physics/every_shape/laws.rs"]
mod laws;
#[path = "../../crates/mechanics/tests/physics/every_shape/shapes.rs"]
mod shapes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    laws::examine(bytes);
});
