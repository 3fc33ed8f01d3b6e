//! How many random cases are run, and what makes case n the same on every run and every machine.

use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// The number of cases to run, of the usual and the long run, unless the environment asks for another.
pub fn case_count([usual, long]: [u64; 2]) -> u64 {
    let is_long = from_environment("STICKSLIP_LONG").is_some_and(|flag| flag > 0);
    from_environment("STICKSLIP_FUZZ_CASES").unwrap_or(if is_long { long } else { usual })
}

/// What all random numbers derive from.
pub fn seed() -> u64 {
    from_environment("STICKSLIP_FUZZ_SEED").unwrap_or(0)
}

fn from_environment(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|error| panic!("{name}={text}: {error}")))
}

/// What makes the values of a case.
pub fn runner(seed: u64, case: u64) -> TestRunner {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    bytes[8..16].copy_from_slice(&case.to_le_bytes());
    let config = Config { failure_persistence: None, max_shrink_iters: 2000, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
}
