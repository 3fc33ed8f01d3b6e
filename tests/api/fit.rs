//! Measured loops on the command line, and the contact that a fit makes. What a fit replies is tested in
//! `crates/compute/tests/documents/fit.rs`, what it finds in `crates/measured/tests/loops`.

use serde_json::Value;

use crate::common::{Server, codes, good, run};

#[tokio::test]
async fn a_file_of_a_bench_is_fitted_without_a_server_and_makes_its_contact() {
    let file = |name: &str| format!("{}/examples/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let (table, contact) = (file("ball_loop.csv"), file("ball_contact.json"));
    let fit = |more: &[&str]| {
        let fixed = ["fit", &table, "--contact", &contact, "--displacement-unit", "um", "--start", "steady"];
        run(&[&fixed, more].concat())
    };
    let document = |more: &[&str]| -> Value {
        let printed = fit(more);
        assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
        serde_json::from_slice(&printed.stdout).unwrap()
    };
    // What make_ball_loop.py has made it of is found by the example in Python (`tests/docs/examples.rs`).
    let free = ["--free", "friction,g_star,machine_compliance,force_offset"];
    let found = document(&free);
    // Columns by number, and what is known.
    let by_number = [&free[..], &["--displacement", "2", "--force", "3", "--time", "time"]].concat();
    assert_eq!(document(&by_number), found);
    let known = document(&["--known", "machine_compliance=5e-8+-5e-9"]);
    assert!(known["estimates"]["machine_compliance"]["value"].is_number() && codes(&known).is_empty(), "{known}");
    // A loop that slides frees the compliance of the machine by itself.
    let decided = document(&[]);
    assert!(decided["estimates"]["machine_compliance"]["value"].is_number() && codes(&decided).is_empty(), "{decided}");
    assert_eq!(document(&[&free[..], &["--only-contact"]].concat()), found["contact"]);
    // The contact is made as it is, and keeps the constants of its bodies.
    let server = Server::start().await;
    let made = good(server.post("/contacts", &found["contact"]).await).await;
    let definition = format!("/contacts/{}/definition", made["id"].as_str().unwrap());
    assert_eq!(good(server.get(&definition).await).await["material"], found["contact"]["material"]);
    let table = fit(&[&free[..], &["--format", "csv"]].concat());
    assert_eq!(table.stdout.iter().filter(|byte| **byte == b'\n').count(), 752);
    for (wrong, said) in [
        (["--force", "load"], "no column `load` among 3 columns with time (s), displacement (um), force (n)"),
        (["--known", "mu=1"], "not one of friction"),
        (["--force-unit", "kN"], "/units/force"),
    ] {
        let refused = fit(&wrong);
        let text = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(!refused.status.success() && text.contains(said), "{text}");
    }
}
