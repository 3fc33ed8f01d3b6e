//! Files of which every line is accounted for (`tests/table_files`), over HTTP and on the command line: read as what
//! they hold, or refused with a mapping that settles it.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{Server, ball, good, run};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/table_files")
}

fn truth() -> Value {
    serde_json::from_slice(&std::fs::read(folder().join("truth.json")).unwrap()).unwrap()
}

fn numbers(value: &Value, factor: f64) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|one| one.as_f64().unwrap_or(f64::NAN) * factor).collect()
}

fn factor(unit: &Value) -> f64 {
    match unit.as_str().unwrap() {
        "nm" => 1e-9,
        "um" | "uN" => 1e-6,
        "mm" | "mN" => 1e-3,
        "kN" => 1e3,
        _ => 1.0,
    }
}

/// Whether a loop is the one that all files hold; a map or a line only has to be there.
fn is_right(found: &Value, truth: &Value) -> bool {
    if found["loop"].is_null() {
        return found["scan"].is_object();
    }
    let near = |found: Vec<f64>, expected: Vec<f64>, to: f64| {
        found.len() == expected.len() && found.iter().zip(&expected).all(|(one, other)| (one - other).abs() <= to)
    };
    let (u, f) = (factor(&found["units"]["displacement"]), factor(&found["units"]["force"]));
    near(numbers(&found["loop"]["displacement"], u), numbers(&truth["loop"]["displacement_m"], 1.0), 2e-10)
        && near(numbers(&found["loop"]["force"], f), numbers(&truth["loop"]["force_N"], 1.0), 6e-3)
}

async fn read(server: &Server, entry: &Value, mapping: Option<&str>) -> Result<Value, Value> {
    let kind = if entry["kind"] == "loop" { "loop" } else { "scan" };
    let url = format!("{}/files/{kind}{}", server.base, entry["query"].as_str().unwrap());
    let bytes = std::fs::read(folder().join(entry["file"].as_str().unwrap())).unwrap();
    let mut call = server.http.post(url).header("content-type", "application/octet-stream");
    if let Some(mapping) = mapping {
        call = call.query(&[("mapping", mapping)]);
    }
    let reply = call.body(bytes).send().await.unwrap();
    let status = reply.status();
    let document: Value = reply.json().await.unwrap();
    if status == 200 {
        return Ok(document);
    }
    assert_eq!(status, 422, "{entry}: {document}");
    Err(document)
}

#[tokio::test]
async fn every_file_is_read_right_or_refused_with_a_mapping_that_settles_it() {
    let server = Server::start().await;
    let truth = truth();
    for entry in truth["files"].as_array().unwrap() {
        let found = read(&server, entry, None).await;
        match (entry["expect"].as_str().unwrap(), found) {
            ("fit_refuses", Ok(_)) => {}
            (_, Ok(found)) => {
                assert!(is_right(&found, &truth), "{entry}: {found}");
                let again = read(&server, entry, found["mapping"].as_str()).await.unwrap();
                assert_eq!((&again["loop"], &again["scan"]), (&found["loop"], &found["scan"]), "{entry}");
                let lines: u64 =
                    found["lines"].as_object().unwrap().values().map(|kind| kind["count"].as_u64().unwrap()).sum();
                assert!(lines > 0 && found["unused"].is_array() && found["assumed"].is_array(), "{entry}");
            }
            (expect, Err(problem)) => {
                assert!(
                    ["ask", "ask_load", "said", "said_block", "read_or_refuse"].contains(&expect),
                    "{entry}: {problem}"
                );
                if expect == "read_or_refuse" {
                    continue;
                }
                assert_eq!(problem["code"], "ambiguous_file", "{entry}: {problem}");
                let candidates = problem["candidates"].as_array().unwrap();
                assert_eq!(problem["mapping"], candidates[0]["mapping"], "{entry}");
                let mut is_there = false;
                for candidate in candidates {
                    let found = read(&server, entry, candidate["mapping"].as_str()).await;
                    is_there |= is_right(&found.unwrap_or_else(|problem| panic!("{candidate}: {problem}")), &truth);
                }
                assert!(is_there, "{entry}: {problem}");
            }
        }
    }
}

#[tokio::test]
async fn a_mapping_is_refused_at_its_entry() {
    let server = Server::start().await;
    let call = server.http.post(format!("{}/files/loop", server.base)).query(&[("mapping", "forc:2:N")]);
    let reply = call.header("content-type", "text/csv").body("1;2\n3;4\n").send().await.unwrap();
    assert_eq!(reply.status(), 422);
    let problem: Value = reply.json().await.unwrap();
    assert_eq!(problem["errors"][0]["pointer"], "/mapping", "{problem}");
    assert!(problem.to_string().contains("displacement, force, time, load"), "{problem}");
    // A load as a number with its unit.
    let call = server.http.post(format!("{}/files/loop", server.base)).query(&[("mapping", "load:10 N")]);
    let found = good(call.header("content-type", "text/csv").body("1;2\n3;4\n").send().await.unwrap()).await;
    assert_eq!(found["loop"]["normal_force"], 10.0);
}

#[test]
fn the_command_line_takes_the_mapping_that_a_refusal_names() {
    let scratch = tempfile::tempdir().unwrap();
    let definition = scratch.path().join("contact.json");
    let mut contact = ball();
    contact["friction"] = 0.25.into();
    std::fs::write(&definition, contact.to_string()).unwrap();
    let file = folder().join("loop_two_load_cells.csv");
    let fit = |mapping: &str| {
        let mut arguments = vec!["fit", file.to_str().unwrap(), "--json", "--contact", definition.to_str().unwrap()];
        arguments.extend(["--start", "steady", "--free", "friction,g_star", "--known", "machine_compliance=0"]);
        if !mapping.is_empty() {
            arguments.extend(["--mapping", mapping]);
        }
        run(&arguments)
    };
    let refused: Value = serde_json::from_slice(&fit("").stderr).unwrap();
    assert_eq!(refused["code"], "ambiguous_file", "{refused}");
    let none = refused["candidates"].as_array().unwrap().iter().find(|one| one["name"] == "none").unwrap();
    let output = fit(none["mapping"].as_str().unwrap());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let fitted: Value = serde_json::from_slice(&output.stdout).unwrap();
    let friction = fitted["estimates"]["friction"]["value"].as_f64().unwrap();
    assert!((friction / 0.3 - 1.0).abs() < 0.02, "{friction}");
}
