//! The laws on every shape: any shape under any load, after any path.
//!
//! `STICKSLIP_TEST_CASES` asks for another number of cases; the target `laws` of the folder `fuzz` has no end of them.

mod draw;
mod laws;
mod shapes;

use crate::support::{Random, cases};

/// Bytes of a case.
const BYTES: usize = 400;
/// Failures after which the search for more ends.
const ENOUGH: usize = 40;

#[test]
fn laws_hold_on_every_shape_after_every_path() {
    let (mut contacts, mut failed) = (0, Vec::new());
    for seed in 0..u64::from(cases(5000)) {
        // Each case has its own stream, so that a new shape does not change the others.
        let mut random = Random(seed.wrapping_mul(0xA24B_AED4_963E_E407));
        let bytes: Vec<u8> = (0..BYTES / 8).flat_map(|_| random.bits().to_le_bytes()).collect();
        match std::panic::catch_unwind(|| laws::examine(&bytes)) {
            Ok(examined) => contacts += u32::from(examined),
            Err(_) => failed.push(seed),
        }
        if failed.len() >= ENOUGH {
            break;
        }
    }
    assert!(failed.is_empty(), "cases {failed:?}");
    assert!(contacts > cases(5000) / 2, "{contacts} contacts");
}
