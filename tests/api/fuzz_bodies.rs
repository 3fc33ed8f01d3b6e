//! Anything at all as the body of `POST /simulate`: no panic, no hang, a refusal that names its place or an answer that
//! obeys the laws.
//!
//! Each kind of input is tried for [`SECONDS`], up to so many cases that a fast machine sees no others than a slow one;
//! `STICKSLIP_FUZZ_SECONDS` asks for a longer time and lifts that bound. Case n is the same on every run;
//! `STICKSLIP_FUZZ_SEED` asks for other cases. `fuzz/` has the same under a coverage-guided fuzzer.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::harness::{Outcome, examine};
use proptest::strategy::{Strategy, ValueTree as _};
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use stickslip::admission::LONGEST_WORK;

/// How long each kind of input is tried, s.
const SECONDS: u64 = 60;

/// What a case may take without being mentioned.
const NOTABLE: Duration = Duration::from_secs(2);

/// What a number in the environment says.
fn asked(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// The body under examination, and since when.
type Running = Arc<Mutex<Option<(Instant, Vec<u8>)>>>;

/// Ends the process with the body that does not end: nothing else can.
fn watch(running: Running) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let running = running.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((since, body)) = running.as_ref()
                && since.elapsed() > 4 * LONGEST_WORK
            {
                eprintln!("this hangs: {}", String::from_utf8_lossy(body));
                std::process::exit(1);
            }
        }
    });
}

/// Tries cases until the time is up or, unless a time is asked for, `most` are done, and shrinks the first that breaks a law.
fn fuzz<S: Strategy>(most: u64, strategy: S, write: impl Fn(&S::Value) -> Vec<u8>) {
    let running: Running = Arc::default();
    watch(Arc::clone(&running));
    let longer = asked("STICKSLIP_FUZZ_SECONDS");
    let time = Duration::from_secs(longer.unwrap_or(SECONDS));
    let most = if longer.is_some() { u64::MAX } else { most };
    let seed = asked("STICKSLIP_FUZZ_SEED").unwrap_or(0);
    let start = Instant::now();
    let (mut cases, mut counts, mut slowest) = (0_u64, [0_u64; 3], Duration::ZERO);
    while start.elapsed() < time && cases < most {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        bytes[8..16].copy_from_slice(&cases.to_le_bytes());
        let config = Config { failure_persistence: None, max_shrink_iters: 2000, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
        let tree = strategy.new_tree(&mut runner).expect("nothing is filtered out");
        let begun = Instant::now();
        let outcome = Mutex::new(Outcome::Refused);
        let body = write(&tree.current());
        let result = runner.run_one(tree, |value| {
            let body = write(&value);
            *running.lock().unwrap_or_else(PoisonError::into_inner) = Some((Instant::now(), body.clone()));
            *outcome.lock().unwrap_or_else(PoisonError::into_inner) = examine(&body);
            *running.lock().unwrap_or_else(PoisonError::into_inner) = None;
            Ok::<(), TestCaseError>(())
        });
        if let Err(failure) = result {
            let proptest::test_runner::TestError::Fail(reason, value) = failure else { panic!("{failure:?}") };
            panic!("seed {seed}, case {cases}: {reason}\nthe body: {}", String::from_utf8_lossy(&write(&value)));
        }
        let took = begun.elapsed();
        if took > slowest {
            slowest = took;
            if took > NOTABLE {
                println!("case {cases} took {took:?}: {}", String::from_utf8_lossy(&body));
            }
        }
        counts[outcome.into_inner().unwrap_or_else(PoisonError::into_inner) as usize] += 1;
        cases += 1;
    }
    let [answered, refused, dear] = counts;
    println!(
        "{cases} cases: {answered} answered, {refused} refused, {dear} too dear to try; the slowest took {slowest:?}"
    );
    assert!(cases > 0);
}

#[test]
fn bodies_that_once_broke_a_law() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/harness/found");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    assert!(!files.is_empty());
    for file in files {
        println!("{}", file.display());
        assert_ne!(examine(&std::fs::read(file).unwrap()), Outcome::Dear);
    }
}

#[test]
fn raw_bytes() {
    fuzz(1_200_000, crate::damage::raw(), Clone::clone);
}

#[test]
fn damaged_requests() {
    fuzz(35_000, crate::damage::damaged(), Clone::clone);
}

#[test]
fn sound_requests() {
    fuzz(10_000, crate::requests::scene(), |scene| scene.write().to_string().into_bytes());
}
