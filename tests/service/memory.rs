//! Memory, on the real binary: contacts that are not cached are read within the bound, and a bound beyond the machine
//! is told.

use std::time::Duration;

use crate::common::create;
use crate::common::raw::{Service, get, post};
use futures::future::join_all;
use serde_json::json;
use stickslip::admission::Capacity;
use stickslip::server::{ConnectionLimits, memory_budget};
use stickslip_wire::ForkRequest;
use stickslip_wire::client::Options;

const MIB: usize = 1024 * 1024;
/// Contacts with as deep a slip history as a contact may have.
const CONTACTS: usize = 40;
const REVERSALS: usize = 99_999;

/// `cargo test --test service cold_contacts -- --nocapture` prints the figures of docs/overload.md.
#[tokio::test]
async fn cold_contacts_that_are_asked_for_at_once_stay_within_the_memory_bound() {
    // A cache that none of them fits into: each is read from the store, whenever it is asked for.
    let service = Service::with(
        "--cache-bytes 1MiB --work-bytes 256MiB --max-connections 200 --max-requests 100 --max-queue 100 \
         --max-requests-per-client 100 --max-wait 60s --log info",
    );
    let first = service.client.create(&create(), &Options::default()).await.unwrap().id;
    let path = json!({"path": {"falling_amplitude": {"reversals": REVERSALS}}, "steps": "last"}).to_string();
    let moved = service.ask("127.0.0.1", &post(&format!("/contacts/{first}/path"), &path)).await.unwrap();
    assert_eq!(moved.statuses, [200], "{}", moved.text);
    let mut ids = vec![first];
    while ids.len() < CONTACTS {
        // In this store the moves are shared, so that a fork takes nothing but its snapshot.
        let fork = service.client.fork(first, &ForkRequest::default(), &Options::default()).await.unwrap();
        assert_eq!(fork.sequence, REVERSALS as u64 + 1);
        ids.push(fork.id);
    }
    let before = service.resident();
    let requests: Vec<String> = ids.iter().map(|id| get(&format!("/contacts/{id}/stress?points=5"))).collect();
    for answer in join_all(requests.iter().map(|request| service.ask("127.0.0.1", request))).await {
        let answer = answer.unwrap();
        assert_eq!(answer.statuses, [200], "{}", answer.text);
    }
    let capacity =
        Capacity { requests: 100, queue: 100, bytes: 256 * MIB, wait: Duration::from_secs(60), ..Capacity::default() };
    let connections = ConnectionLimits { most: 200, ..ConnectionLimits::default() };
    let bound = memory_budget::memory(&connections, &capacity, MIB as u64, false) as usize;
    assert!(service.log().contains(&format!("memory_bound={bound}")), "{}", service.log());
    let peak = service.peak();
    println!(
        "{CONTACTS} cold contacts: {} MiB before, at most {} MiB, bound {} MiB",
        before / MIB,
        peak / MIB,
        bound / MIB
    );
    // What this store keeps comes on top of the bound. The program is there before the contacts are asked for, and so
    // is what the store keeps; and these requests take nothing of the bytes of work.
    let allowed = bound - memory_budget::PROGRAM as usize - capacity.reservable_bytes();
    assert!(peak - before < allowed, "{peak} after {before}: more than {allowed} beside");
}

#[tokio::test]
async fn a_memory_bound_beyond_the_machine_draws_a_warning() {
    let warning = "the memory bound is above the memory";
    let service = Service::start(&["--work-bytes", "900TiB", "--log", "warn"]);
    let log = service.log();
    let line = log.lines().find(|line| line.contains(warning)).unwrap_or_else(|| panic!("no warning: {log}"));
    for part in ["WARN", "memory_bound=1.6 PiB", "memory=", "--work-bytes"] {
        assert!(line.contains(part), "{part}: {line}");
    }
    let few = ["--work-bytes", "256MiB", "--cache-bytes", "1MiB", "--max-connections", "16", "--log", "warn"];
    let log = Service::start(&few).log();
    assert!(!log.contains(warning), "{log}");
}
