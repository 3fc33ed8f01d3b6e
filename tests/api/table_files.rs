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

/// Whether all numbers are the same to the rounding of the files.
fn are_near(found: &[f64], expected: &[f64], to: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(one, other)| (one - other).abs() <= to)
}

/// What is wrong with a reply, if anything: with the numbers of a loop, its load and its step of time, or with a scan.
fn wrong(found: &Value, truth: &Value, entry: &Value) -> Option<String> {
    if found["loop"].is_null() {
        return wrong_scan(found, truth, &entry["truth"]);
    }
    let (measured, units, truth) = (&found["loop"], &found["units"], &truth["loop"]);
    let is = |name: &str, expected: &Value, to: f64| {
        are_near(&numbers(&measured[name], factor(&units[name])), &numbers(expected, 1.0), to)
    };
    if !is("displacement", &truth["displacement_m"], 2e-10) || !is("force", &truth["force_N"], 6e-3) {
        return Some(format!("{measured}"));
    }
    let is_load =
        |expected: f64| measured["normal_force"].as_f64().is_none_or(|load| (load / expected - 1.0).abs() < 1e-3);
    if !entry["truth"]["load"].as_f64().is_none_or(is_load) {
        return Some(format!("a load of {}", measured["normal_force"]));
    }
    let (expected, times) = (entry["truth"]["dt"].as_f64()?, measured["time"].as_array()?);
    let at = |index: usize| times[index].as_f64().unwrap();
    let step = (at(times.len() - 1) - at(0)) / (times.len() - 1) as f64;
    ((step / expected - 1.0).abs() > 0.05).then(|| format!("a step of {step} s"))
}

/// The places and heights of a line, or the curvature of a ball in a map.
fn wrong_scan(found: &Value, truth: &Value, more: &Value) -> Option<String> {
    let (lateral, height) = (factor(&found["units"]["lateral"]), factor(&found["units"]["height"]));
    let (line, map) = (&found["scan"]["line"], &found["scan"]["map"]);
    if line.is_object() {
        let from_first = |places: Vec<f64>| places.iter().map(|place| place - places[0]).collect::<Vec<f64>>();
        let (x, expected) = (numbers(&line["x"], lateral), numbers(&truth["scan"]["x_m"], 1.0));
        let is_right = are_near(&from_first(x), &from_first(expected), 1e-9)
            && are_near(&numbers(&line["z"], height), &numbers(&truth["scan"]["z_m"], 1.0), 1e-11);
        return (!is_right).then(|| format!("{line}"));
    }
    let n = more["n"].as_u64().unwrap() as usize;
    let distance = more["d"].as_f64().unwrap() * if more["si"].is_null() { 1e-6 } else { 1.0 };
    let is_distance = |name: &str| (map[name].as_f64().unwrap() * lateral / distance - 1.0).abs() < 1e-3;
    let at = |column: usize| map["z"][n / 2][column].as_f64().unwrap() * height;
    let curvature = (at(2) - 2.0 * at(n / 2) + at(n - 2)) / ((n / 2 - 2) as f64 * distance).powi(2);
    let is_right = map["z"].as_array().unwrap().len() == n
        && is_distance("dx")
        && is_distance("dy")
        && (-curvature * 8e-3 - 1.0).abs() < 0.02;
    (!is_right).then(|| format!("{map}"))
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

/// Whether a file may be refused, with a way out.
fn may_ask(entry: &Value) -> bool {
    ["ask", "ask_load", "said", "said_block", "read_or_refuse", "map_or_ask"]
        .contains(&entry["expect"].as_str().unwrap())
}

#[tokio::test]
async fn every_file_is_read_right_or_refused_with_a_mapping_that_settles_it() {
    let server = Server::start().await;
    let truth = truth();
    for entry in truth["files"].as_array().unwrap() {
        match read(&server, entry, None).await {
            Ok(found) => {
                let fault = wrong(&found, &truth, entry);
                assert!(fault.is_none() || entry["expect"] == "fit_refuses", "{entry}: {fault:?}");
                let again = read(&server, entry, found["mapping"].as_str()).await.unwrap();
                assert_eq!((&again["loop"], &again["scan"]), (&found["loop"], &found["scan"]), "{entry}");
                let lines: u64 =
                    found["lines"].as_object().unwrap().values().map(|kind| kind["count"].as_u64().unwrap()).sum();
                assert!(lines > 0 && found["unused"].is_array() && found["assumed"].is_array(), "{entry}");
                let is_asked = entry["expect"].as_str().unwrap().starts_with("ask");
                assert!(!is_asked, "{entry} is read without a question: {found}");
            }
            Err(problem) => {
                assert!(may_ask(entry), "{entry}: {problem}");
                if problem["code"] != "ambiguous_file" {
                    // Values that are not in the file: no mapping brings them.
                    assert_eq!(entry["expect"], "read_or_refuse", "{problem}");
                    assert!(problem.to_string().contains("save it, or export CSV"), "{entry}: {problem}");
                    continue;
                }
                let candidates = problem["candidates"].as_array().unwrap();
                assert_eq!(problem["mapping"], candidates[0]["mapping"], "{entry}");
                let mut is_there = false;
                for candidate in candidates {
                    let found = read(&server, entry, candidate["mapping"].as_str()).await;
                    let found = found.unwrap_or_else(|problem| panic!("{candidate}: {problem}"));
                    is_there |= wrong(&found, &truth, entry).is_none();
                }
                assert!(is_there, "{entry}: {problem}");
            }
        }
    }
}

/// The friction of 0.3 or the radius of 8 mm of a file on the command line, or its refusal.
fn on_the_command_line(entry: &Value, definition: &Path, mapping: Option<&str>) -> Result<f64, Value> {
    let file = folder().join(entry["file"].as_str().unwrap());
    let is_loop = entry["kind"] == "loop";
    let mut arguments = vec![if is_loop { "fit" } else { "profile" }, file.to_str().unwrap(), "--json"];
    if is_loop {
        arguments.extend(["--contact", definition.to_str().unwrap(), "--start", "steady"]);
        arguments.extend(["--free", "friction,g_star", "--known", "machine_compliance=0"]);
    }
    let query = entry["query"].as_str().unwrap().trim_start_matches('?');
    for (name, value) in query.split('&').filter_map(|part| part.split_once('=')) {
        arguments.push(match name {
            "spacing" => "--spacing",
            "lateral" => "--lateral",
            _ => "--height",
        });
        arguments.push(value);
    }
    if let Some(mapping) = mapping {
        arguments.extend(["--mapping", mapping]);
    }
    let output = run(&arguments);
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(serde_json::from_str(&text).unwrap_or_else(|error| panic!("{entry}: {error}: {text}")));
    }
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let value = if is_loop { &found["estimates"]["friction"]["value"] } else { &found["radius_of_curvature"]["value"] };
    Ok(value.as_f64().unwrap_or_else(|| panic!("{entry}: {found}")) / if is_loop { 0.3 } else { 8e-3 })
}

#[test]
fn the_command_line_reads_every_file_or_names_the_mapping_that_settles_it() {
    let scratch = tempfile::tempdir().unwrap();
    let definition = scratch.path().join("contact.json");
    let mut contact = ball();
    contact["friction"] = 0.25.into();
    std::fs::write(&definition, contact.to_string()).unwrap();
    let is_right = |found: f64| (found - 1.0).abs() < 0.02;
    for entry in truth()["files"].as_array().unwrap() {
        let refusal = match on_the_command_line(entry, &definition, None) {
            Ok(found) => {
                assert!(is_right(found), "{entry}: {found}");
                continue;
            }
            Err(refusal) => refusal,
        };
        if entry["expect"] == "fit_refuses" {
            assert!(refusal.to_string().contains("rectified"), "{refusal}");
            continue;
        }
        assert!(may_ask(entry), "{entry}: {refusal}");
        let candidates = refusal["candidates"].as_array().map_or(&[][..], Vec::as_slice);
        let follow = |candidate: &Value| on_the_command_line(entry, &definition, candidate["mapping"].as_str());
        let found: Vec<_> = candidates.iter().map(follow).collect();
        let is_there = found.iter().flatten().any(|found| is_right(*found));
        assert!(is_there || entry["expect"] == "read_or_refuse", "{entry}: {refusal}: {found:?}");
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
