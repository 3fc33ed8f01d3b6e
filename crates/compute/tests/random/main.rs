//! Random documents of simulations, cycles, fretting and fits, and random files of instruments: each has a reply that
//! obeys the laws, or is refused with the place of the fault. None panics.
//!
//! The number of cases is fixed, and case n is the same on every run and every machine. `STICKSLIP_LONG=1`, which
//! `./check long` sets, asks for many more, `STICKSLIP_FUZZ_CASES` for another number of each kind, and
//! `STICKSLIP_FUZZ_SEED` for other cases. `fuzz/` runs the same checks under a coverage-guided fuzzer.

mod answered;
mod cases;
mod cycle_laws;
mod cycle_requests;
mod damage;
mod depth_requests;
mod fit_laws;
mod fretting_laws;
mod harness;
mod requests;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::sample::select;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::{TestCaseError, TestError};
use stickslip_compute::computations::files;
use stickslip_measured::import::Mapping;
use stickslip_wire::LoopFileReply;
use stickslip_wire::fit::MeasuredLoop;

use cases::{case_count, runner, seed};
use cycle_requests::RandomCycle;
use damage::{WORDS, damage};
use depth_requests::RandomFretting;
use fit_laws::RandomFit;
use harness::{Outcome, examine};
use requests::random_request;

/// A case that takes longer is printed.
const NOTABLE: Duration = Duration::from_secs(2);
/// A case that takes longer is taken for an endless loop.
const HANGING: Duration = Duration::from_secs(600);

/// The body under examination, and since when.
type Running = Arc<Mutex<Option<(Instant, Vec<u8>)>>>;

/// Ends the process when one body hangs: the thread that examines it cannot be stopped.
fn watch(running: Running) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let running = running.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((since, body)) = running.as_ref()
                && since.elapsed() > HANGING
            {
                eprintln!("this hangs: {}", String::from_utf8_lossy(body));
                std::process::exit(1);
            }
        }
    });
}

/// Runs this many cases, and shrinks the first that breaks a law.
fn fuzz<S: Strategy>(
    numbers: [u64; 2],
    strategy: S,
    write: impl Fn(&S::Value) -> Vec<u8>,
    examine: impl Fn(&[u8]) -> Outcome,
) {
    let running: Running = Arc::default();
    watch(Arc::clone(&running));
    let (cases, seed, start) = (case_count(numbers), seed(), Instant::now());
    let (mut counts, mut slowest) = ([0_u64; 3], Duration::ZERO);
    for case in 0..cases {
        let mut runner = runner(seed, case);
        let tree = strategy.new_tree(&mut runner).expect("nothing is filtered out");
        let case_start = Instant::now();
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
            let TestError::Fail(reason, value) = failure else { panic!("{failure:?}") };
            panic!("seed {seed}, case {case}: {reason}\nthe body: {}", String::from_utf8_lossy(&write(&value)));
        }
        let duration = case_start.elapsed();
        if duration > slowest {
            slowest = duration;
            if duration > NOTABLE {
                println!("case {case} took {duration:?}: {}", String::from_utf8_lossy(&body));
            }
        }
        counts[outcome.into_inner().unwrap_or_else(PoisonError::into_inner) as usize] += 1;
    }
    let [answered, refused, expensive] = counts;
    println!(
        "seed {seed}: {cases} cases in {:?}, {answered} answered, {refused} refused, {expensive} too expensive to run; \
         the slowest took {slowest:?}",
        start.elapsed()
    );
    assert!(cases > 0);
}

/// The text of a request with one to three damages.
pub fn damaged() -> impl Strategy<Value = Vec<u8>> {
    (random_request(), prop::collection::vec(damage(), 1..4)).prop_map(|(request, damages)| {
        let text = request.to_json().to_string().into_bytes();
        damages.iter().fold(text, |text, damage| damage.apply(text))
    })
}

/// Random bytes, and words of JSON in random order.
pub fn raw() -> impl Strategy<Value = Vec<u8>> {
    const NAMES: &str = r#"
        { } [ ] : , "contact" "profile" "type" "sphere" "radius" "material" "effective" "friction" "preload"
        "path" "moves" "stress" "sum" "parts" "tabulated" "r" "z" "force"
    "#;
    let among = |words: &'static str| select(words.split_whitespace().collect::<Vec<_>>());
    let soup = prop_oneof![3 => among(NAMES), 1 => among(WORDS)];
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..200),
        prop::collection::vec(soup, 0..60).prop_map(|words| words.concat().into_bytes()),
    ]
}

#[test]
fn bodies_that_once_broke_a_law() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/random/regressions");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    assert!(!files.is_empty());
    for file in files {
        println!("{}", file.display());
        assert_ne!(examine(&std::fs::read(file).unwrap()), Outcome::TooExpensive);
    }
}

#[test]
fn raw_bytes() {
    fuzz([150_000, 1_200_000], raw(), Clone::clone, examine);
}

#[test]
fn damaged_requests() {
    fuzz([10_000, 35_000], damaged(), Clone::clone, examine);
}

#[test]
fn sound_requests() {
    fuzz([3_000, 9_500], random_request(), |it| it.to_json().to_string().into_bytes(), examine);
}

#[test]
fn cycles() {
    let write = |request: &RandomCycle| request.to_json().to_string().into_bytes();
    fuzz([400, 1_000], cycle_requests::random_cycle(), write, cycle_laws::examine);
}

#[test]
fn fretting() {
    let write = |request: &RandomFretting| request.to_json().to_string().into_bytes();
    fuzz([150, 800], depth_requests::random_fretting(), write, fretting_laws::examine);
}

/// A file of words that instruments write, and of others.
fn random_file() -> impl Strategy<Value = Vec<u8>> {
    const WORDS: &str = "1|-2.5e-9|0,5|1e999|nan|No Data|-|\u{2212}3|;|;|\t|,| |\n|\n|\r\n|#|\"|x|X [um]|Force (mN)|\
        Displacement|Zygo XYZ\n|Width: 3 um\n|Height: 2 nm\n|\u{feff}|\u{e9}|\0";
    let all: Vec<&str> = WORDS.split('|').collect();
    let words = proptest::collection::vec(proptest::sample::select(all), 0..80);
    let text = words.prop_map(|words| words.concat());
    (text, 0..3_u8).prop_map(|(text, coding)| match coding {
        0 => text.into_bytes(),
        1 => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        _ => text.chars().map(|letter| u8::try_from(u32::from(letter)).unwrap_or(0xff)).collect(),
    })
}

#[test]
fn files_of_instruments() {
    let examine = |bytes: &[u8]| {
        let scan = files::scan(bytes, &Mapping::parse("spacing:1").unwrap(), &|| true);
        let found = files::measured_loop(bytes, &Mapping::default(), &|| true);
        if let Ok(LoopFileReply { measured: MeasuredLoop { displacement, force, time, .. }, preview, .. }) = &found {
            assert_eq!(displacement.len(), force.len());
            assert!(time.as_ref().is_none_or(|time| time.len() == force.len()) && force.len() <= preview.rows);
            assert!(displacement.iter().chain(force).all(|value| value.is_finite()));
        }
        if scan.is_ok() || found.is_ok() { Outcome::Answered } else { Outcome::Refused }
    };
    fuzz([20_000, 200_000], random_file(), Clone::clone, examine);
    fuzz([20_000, 200_000], raw(), Clone::clone, examine);
}

#[test]
fn fits() {
    let write = |request: &RandomFit| request.to_json().to_string().into_bytes();
    fuzz([60, 150], fit_laws::random_fit(), write, fit_laws::examine);
}
