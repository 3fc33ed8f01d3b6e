//! The table of a sweep: the same in every format, at once and from a job, and on the command line. Its numbers are
//! tested in `crates/compute/tests/documents/sweeps.rs`.

use arrow_ipc::reader::StreamReader;
use reqwest::Method;
use serde_json::{Value, json};
use stickslip_wire::SweepRequest;
use stickslip_wire::client::{Options, Swept};

use super::{base, small_job};
use crate::common::tables::same_numbers;
use crate::common::{Server, problem, run, with};

/// With names for some of the columns, which change nothing but the headings.
#[tokio::test]
async fn every_format_holds_the_same_numbers_at_once_and_from_a_job() {
    let server = Server::start().await;
    // More rows than are written at a time, and some without numbers.
    let pointers =
        ["/contact/friction", "/path/falling_amplitude/reversals", "/residual/max", "/residual/peaks/2/shear"];
    let names = ["mu", pointers[1], "largest_shear", pointers[3]];
    let plain = json!({"base": base(), "axes": [
        {"pointer": pointers[0], "linear": {"from": 0.1, "to": 0.5, "count": 300}},
        {"pointer": pointers[1], "values": [1, 5]}
    ], "outputs": [pointers[2], pointers[3]]});
    let sweep = with(plain.clone(), "/axes/0/name", json!(names[0]));
    let sweep = with(sweep, "/outputs/0", json!({"pointer": pointers[2], "name": names[2]}));
    let job = server.start_job(&with(sweep.clone(), "/job", json!(true))).await;
    let table: Value = serde_json::from_str(&server.job_result(&job).await).unwrap();
    let unnamed: Value = server.post("/sweep", &plain).await.json().await.unwrap();
    let mut bodies = Vec::new();
    for (format, media_type) in [
        ("columns", "application/json"),
        ("rows", "application/vnd.stickslip.rows+json"),
        ("csv", "text/csv; charset=utf-8"),
        ("ndjson", "application/x-ndjson"),
        ("arrow", "application/vnd.apache.arrow.stream"),
    ] {
        let stored = server.get(&format!("{job}/result?format={format}")).await;
        assert_eq!(stored.headers()["content-type"], media_type);
        let stored = stored.bytes().await.unwrap();
        let accept = [("accept", media_type.split(';').next().unwrap())];
        let at_once = server.send(Method::POST, "/sweep", Some(&sweep.to_string()), &accept).await;
        assert_eq!((at_once.status().as_u16(), &at_once.headers()["vary"]), (200, &"accept".parse().unwrap()));
        assert_eq!(at_once.bytes().await.unwrap(), stored, "{format}");
        bodies.push(stored);
    }
    let (found, rows) = same_numbers(&bodies[1], &bodies[2], &bodies[3], &bodies[4]);
    assert_eq!((found, rows.len()), (names.map(str::to_owned).to_vec(), 600));
    assert!(StreamReader::try_new(&bodies[4][..], None).unwrap().count() > 1);
    assert!(rows.iter().any(|row| row[3].is_null()) && rows.iter().any(|row| row[3].is_number()));
    assert_eq!(table["columns"].as_object().unwrap().len(), names.len());
    for (at, (name, pointer)) in names.into_iter().zip(pointers).enumerate() {
        assert_eq!(table["columns"][name], rows.iter().map(|row| row[at].clone()).collect::<Value>());
        assert_eq!(table["columns"][name], unnamed["columns"][pointer]);
    }
    for (method, path) in [(Method::POST, "/sweep"), (Method::GET, &*format!("{job}/result"))] {
        let body = (method == Method::POST).then(|| sweep.to_string());
        let refused = problem(server.send(method, path, body.as_deref(), &[("accept", "image/png")]).await).await;
        assert_eq!(refused.code, "not_acceptable");
    }
    let request: SweepRequest = serde_json::from_value(sweep.clone()).unwrap();
    assert_eq!(serde_json::to_value(&request).unwrap()["outputs"], sweep["outputs"]);
    let Swept::Table(typed) = server.client.sweep(&request, &Options::default()).await.unwrap() else {
        panic!("few points are no job")
    };
    assert_eq!(serde_json::to_value(&typed.columns["largest_shear"]).unwrap(), table["columns"]["largest_shear"]);
}

#[tokio::test]
async fn the_command_line_prints_what_the_service_gives() {
    let server = Server::start().await;
    let (folder, mut sweep) = (tempfile::tempdir().unwrap(), small_job());
    sweep["job"] = json!(false);
    sweep["axes"][0]["values"] = (1..=200).map(|index| json!(f64::from(index) / 400.0)).collect();
    let file = folder.path().join("sweep.json");
    std::fs::write(&file, sweep.to_string()).unwrap();
    for (format, flags) in [
        ("columns", &["--format", "columns"][..]),
        ("columns", &["--json"]),
        ("rows", &["--format", "rows"]),
        ("csv", &[]),
        ("ndjson", &["--format", "ndjson", "--threads", "1"]),
        ("ndjson", &["--format", "ndjson", "--threads", "3"]),
    ] {
        let served = server.post(&format!("/sweep?format={format}"), &sweep).await.text().await.unwrap();
        let printed = run(&[&["sweep", file.to_str().unwrap()], flags].concat());
        assert!(printed.status.success());
        assert_eq!(String::from_utf8(printed.stdout).unwrap(), served, "{flags:?}");
    }
    let mut wrong = sweep.clone();
    wrong["axes"][0]["pointer"] = json!("/contact/colour");
    std::fs::write(&file, wrong.to_string()).unwrap();
    let refused = run(&["sweep", file.to_str().unwrap()]);
    assert!(!refused.status.success() && refused.stdout.is_empty());
    let refusal: Value = serde_json::from_slice(&refused.stderr).unwrap();
    assert_eq!(refusal["errors"][0]["pointer"], "/axes/0/pointer");
}

#[tokio::test]
async fn more_work_than_a_server_takes_on_is_refused_as_such() {
    let server = Server::start().await;
    let mut huge = small_job();
    let span = json!({"from": 0.1, "to": 0.2, "count": 2_000_000});
    huge["axes"] = json!([{"pointer": "/contact/friction", "linear": span}]);
    huge["base"]["path"]["falling_amplitude"]["reversals"] = json!(16_000);
    let refusal = problem(server.post("/sweep", &huge).await).await;
    assert_eq!((refusal.status, refusal.code.as_str()), (422, "too_much_work"));
    // A job of a few of its points states the time of each that the refusal states.
    let stated = refusal.detail.split(" s a point").next().unwrap().rsplit(' ').next().unwrap();
    huge["axes"] = small_job()["axes"].clone();
    let made: Value = server.post("/sweep", &huge).await.json().await.unwrap();
    assert_eq!(made["point_time"], stated.parse::<f64>().unwrap(), "{}", refusal.detail);
    assert_eq!(refusal.errors[0].pointer, "/axes");
    let unknown = problem(server.post("/sweep?colour=1", &small_job()).await).await;
    assert_eq!(unknown.errors[0].pointer, "/colour");
}
