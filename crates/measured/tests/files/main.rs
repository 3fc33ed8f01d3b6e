//! Files as laboratories write them, made at random: what is read is what was written, or the refusal names the place.
//!
//! `STICKSLIP_TEST_CASES` repeats each test with so many cases.

mod bounds;
mod loop_columns;
mod made;
mod refusals;
mod scan_columns;
mod spreadsheets;
mod truth;
mod whole;
mod writer;

use fastrand::Rng;

/// Runs a test with this many seeds.
fn for_cases(usual: u64, test: impl Fn(&mut Rng)) {
    let cases = std::env::var("STICKSLIP_TEST_CASES").map_or(usual, |cases| cases.parse().expect("a number"));
    for seed in 0..cases {
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| test(&mut Rng::with_seed(seed))));
        if let Err(panic) = result {
            eprintln!("seed {seed}");
            std::panic::resume_unwind(panic);
        }
    }
}
