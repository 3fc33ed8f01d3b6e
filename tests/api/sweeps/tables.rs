//! The numbers in the table of a sweep.

use arrow_ipc::reader::StreamReader;
use reqwest::Method;
use serde_json::{Value, json};
use stickslip_wire::SweepRequest;
use stickslip_wire::client::{Options, Swept};

use super::{base, small_job};
use crate::common::tables::same_numbers;
use crate::common::{Server, ball, problem, run, with};

/// Sends each row's point to `/simulate` by itself, and compares to the last bit. Says how many numbers there were.
async fn compare(server: &Server, sweep: &Value) -> (usize, usize) {
    let response = server.post("/sweep", sweep).await;
    assert_eq!(response.status(), 200, "{sweep}: {}", response.text().await.unwrap());
    let table: Value = response.json().await.unwrap();
    let axes: Vec<&str> =
        sweep["axes"].as_array().unwrap().iter().map(|axis| axis["pointer"].as_str().unwrap()).collect();
    let (mut numbers, mut nulls) = (0, 0);
    for row in 0..table["points"].as_u64().unwrap() as usize {
        let mut point = sweep["base"].clone();
        for axis in &axes {
            point = with(point, axis, table["columns"][axis][row].clone());
        }
        let reply = server.post("/simulate", &point).await;
        assert_eq!(reply.status(), 200, "{point}");
        let reply: Value = reply.json().await.unwrap();
        for output in sweep["outputs"].as_array().unwrap() {
            let output = output.as_str().unwrap();
            let expected = reply.pointer(output).and_then(Value::as_f64);
            let found = &table["columns"][output][row];
            assert_eq!(found.as_f64().map(f64::to_bits), expected.map(f64::to_bits), "{output} of row {row}");
            *if expected.is_some() { &mut numbers } else { &mut nulls } += 1;
        }
    }
    (numbers, nulls)
}

fn base_of_springs() -> Value {
    let mut base = base();
    base["path"] = json!({"equal_peaks": {"reversals": 4}});
    base["solver"] = json!({"springs": {"count": 100}});
    base
}

#[tokio::test]
async fn a_sweep_equals_its_points_one_by_one_bit_for_bit() {
    let server = Server::start().await;
    let three = json!({"base": base(), "axes": [
        {"pointer": "/path/falling_amplitude/reversals", "values": [1, 2, 20]},
        {"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.7, "count": 3}},
        {"pointer": "/contact/preload/normal_force", "logarithmic": {"from": 0.001, "to": 3000, "count": 4}}
    ], "outputs": ["/residual/max", "/residual/peaks/3/radius", "/residual/peaks/3/shear", "/steps/0/elastic_energy",
        "/steps/0/memory_depth", "/contact/contact_radius", "/accuracy/stress_error"]});
    let (numbers, nulls) = compare(&server, &three).await;
    assert_eq!(numbers + nulls, 36 * 7);
    assert!(nulls > 0 && nulls < 72, "a peak that some points do not reach: {nulls}");

    // A member that the base leaves out, a curved path, stresses, and states along it.
    let moves = json!([{"normal_force": 12, "force": 2}, {"displacement": 1e-8, "normal_force": 11}]);
    let curved = json!({"base": {"contact": ball(), "path": {"moves": moves}, "stress": {"points": 3}}, "axes": [
        {"pointer": "/tolerance", "logarithmic": {"from": 1e-10, "to": 1e-4, "count": 3}},
        {"pointer": "/path/moves/0/force", "linear": {"from": -2, "to": 2, "count": 3}}
    ], "outputs": ["/steps/0/displacement", "/steps/1/force", "/stress/shear/1", "/accuracy/force_error"]});
    assert_eq!(compare(&server, &curved).await, (36, 0));

    // A table that no axis changes is read once; the other solver; the other law.
    let table = json!({"type": "tabulated", "r": [0.0, 1e-4, 2e-4, 3e-4], "z": [0.0, 5e-7, 2e-6, 4.5e-6]});
    let mut tabulated = json!({"contact": ball(), "path": {"displacement": [1e-8, 0.0]}});
    tabulated["contact"]["profile"] = table;
    tabulated["contact"]["preload"] = json!({"indentation": 1e-6});
    let tabulated = json!({"base": tabulated, "axes": [{"pointer": "/path/displacement/0", "linear":
        {"from": -1e-7, "to": 1e-7, "count": 5}}], "outputs": ["/steps/0/force", "/contact/max_pressure"]});
    assert_eq!(compare(&server, &tabulated).await, (10, 0));
    let springs = json!({"base": base_of_springs(),
        "axes": [{"pointer": "/solver/springs/count", "values": [200, 101, 150]}],
        "outputs": ["/residual/max", "/protocol/displacement/1"]});
    assert_eq!(compare(&server, &springs).await, (6, 0));
}

/// A profile that no axis changes is made once; a load curve is made anew for other bodies.
#[tokio::test]
async fn points_that_share_a_profile_equal_those_that_do_not() {
    let server = Server::start().await;
    let indentation: Vec<f64> = (0..=20).map(|index| 2e-7 * f64::from(index)).collect();
    let force: Vec<f64> = indentation.iter().map(|d| 3e10 * d.powf(1.5)).collect();
    let radii: Vec<f64> = (0..100).map(|index| 4e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r).collect();
    let profiles = [
        json!({"type": "tabulated", "r": radii, "z": heights}),
        json!({"type": "truncated_cone", "slope": 0.05, "flat_radius": 3e-5}),
        json!({"type": "load_curve", "indentation": indentation, "normal_force": force}),
        json!({"type": "ellipsoid", "radii": [0.01, 0.004], "direction": "y"}),
    ];
    let axes = json!([
        {"pointer": "/contact/material/bodies/0/youngs_modulus", "values": [1e11, 2.1e11]},
        {"pointer": "/contact/preload/normal_force", "values": [1, 10]},
        {"pointer": "/contact/friction", "values": [0.0, 0.3]}
    ]);
    let path = json!({"moves": [{"displacement": 1e-7}, {"normal_force": 11}, {"displacement": -5e-8}]});
    let outputs = ["/steps/2/force", "/steps/2/contact_radius", "/steps/2/dissipated_energy", "/contact/indentation"];
    for profile in profiles {
        let mut contact = ball();
        contact["profile"] = profile;
        let sweep = json!({"base": {"contact": contact, "path": path}, "axes": axes, "outputs": outputs});
        assert_eq!(compare(&server, &sweep).await, (32, 0));
    }

    // What the rest of the request says of the bodies, and springs under a shared profile.
    let below = json!({"body": "first", "points": [[0.0, 0.0, 1e-5]], "bulk": {"xx": 1e6}});
    let base = json!({"contact": ball(), "path": path, "subsurface": below});
    let sweep = json!({"base": base, "axes": [{"pointer": "/path/moves/0/displacement", "values": [1e-8, 2e-8]}],
        "outputs": ["/steps/0/force"]});
    assert_eq!(compare(&server, &sweep).await, (2, 0));
    let mut base = base_of_springs();
    base["contact"]["profile"] = json!({"type": "tabulated", "r": radii, "z": heights});
    let sweep = json!({"base": base, "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
        "outputs": ["/residual/max"]});
    assert_eq!(compare(&server, &sweep).await, (2, 0));
}

#[tokio::test]
async fn figure_5_is_one_call() {
    let server = Server::start().await;
    let sweep = json!({"base": base(), "axes": [{"pointer": "/path/falling_amplitude/reversals",
        "linear": {"from": 1, "to": 100, "count": 100}}], "outputs": ["/residual/max", "/contact/max_pressure"]});
    let table: Value = server.post("/sweep", &sweep).await.json().await.unwrap();
    assert_eq!((&table["points"], &table["failed"], &table["failures"]), (&json!(100), &json!(0), &json!([])));
    for row in 0..100 {
        let number = |column: &str| table["columns"][column][row].as_f64().unwrap();
        assert_eq!(table["columns"]["/path/falling_amplitude/reversals"][row], json!(row + 1), "a whole number");
        let reversals = (row + 1) as f64;
        // In closed form: one reversal leaves the root of a half, more of them the cusp next to the edge.
        let expected = if row == 0 { 0.5_f64.sqrt() } else { (2.0 - 1.5_f64.sqrt()) / reversals.sqrt() };
        let found = number("/residual/max") / (0.3 * number("/contact/max_pressure"));
        assert!((found - expected).abs() < 1e-12, "{reversals}: {found} instead of {expected}");
    }
}

#[tokio::test]
async fn a_point_without_an_answer_is_a_row_without_numbers_and_is_listed_as_a_failure() {
    let server = Server::start().await;
    let mut base = base();
    base["contact"]["profile"] = json!({"type": "exact_sphere", "radius": 0.01});
    base["contact"]["preload"] = json!({"indentation": 1e-6});
    let sweep = json!({"base": base, "axes": [{"pointer": "/contact/preload/indentation", "linear":
        {"from": 1e-3, "to": 1.0, "count": 250}}], "outputs": ["/residual/max", "/contact/normal_force"]});
    let table: Value = server.post("/sweep", &sweep).await.json().await.unwrap();
    let column = |name: &str| table["columns"][name].as_array().unwrap().clone();
    let forces = column("/contact/normal_force");
    let failed: Vec<usize> = (0..250).filter(|row| forces[*row].is_null()).collect();
    assert!(failed.len() > 100 && failed.len() < 250, "{}", failed.len());
    assert!(failed.iter().all(|row| column("/residual/max")[*row].is_null()));
    assert_eq!(table["failed"], failed.len());
    let failures = table["failures"].as_array().unwrap();
    assert_eq!(failures.len(), 100, "listed up to a bound");
    for (failure, row) in failures.iter().zip(&failed) {
        assert_eq!((&failure["index"], &failure["code"]), (&json!(row), &json!("beyond_profile")));
    }
    // As the point is refused by itself.
    let mut point = sweep["base"].clone();
    point["contact"]["preload"]["indentation"] = table["columns"]["/contact/preload/indentation"][failed[0]].clone();
    let refusal = problem(server.post("/simulate", &point).await).await;
    assert_eq!(failures[0]["code"], refusal.code);
    assert_eq!(failures[0]["pointer"], refusal.errors[0].pointer);
    assert_eq!(failures[0]["detail"], refusal.errors[0].detail);
}

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
    for format in ["columns", "rows", "csv", "ndjson"] {
        let served = server.post(&format!("/sweep?format={format}"), &sweep).await.text().await.unwrap();
        for threads in ["1", "3"] {
            let printed = run(&["sweep", file.to_str().unwrap(), "--format", format, "--threads", threads]);
            assert!(printed.status.success());
            assert_eq!(String::from_utf8(printed.stdout).unwrap(), served, "{format}");
        }
    }
    let mut wrong = sweep.clone();
    wrong["axes"][0]["pointer"] = json!("/contact/colour");
    std::fs::write(&file, wrong.to_string()).unwrap();
    let refused = run(&["sweep", file.to_str().unwrap()]);
    assert!(!refused.status.success() && refused.stdout.is_empty());
    let refusal: Value = serde_json::from_slice(&refused.stderr).unwrap();
    assert_eq!(refusal["errors"][0]["pointer"], "/axes/0/pointer");
}
