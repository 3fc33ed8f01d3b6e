//! Files of which every line is accounted for (`tests/table_files`): each is read as what it holds, or refused with a
//! way out that works. `truth.json` beside them has what they hold and what is right for each.

use std::path::{Path, PathBuf};

use serde_json::Value;
use stickslip_measured::import::{ImportError, LoopFile, Mapping, Places, ScanFile, read_loop, read_scan};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/table_files")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|one| one.as_f64().unwrap()).collect()
}

/// Whether all are the same to the rounding of the files.
fn are_near(found: &[f64], expected: &[f64], to: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(one, other)| (one - other).abs() <= to)
}

/// What is wrong with a loop, if anything.
fn wrong_loop(found: &LoopFile, truth: &Value, more: &Value) -> Option<String> {
    let si = |values: &[f64], factor: f64| values.iter().map(|value| value * factor).collect::<Vec<f64>>();
    let u = si(&found.displacement, found.displacement_unit.unit().to_si(1.0));
    let f = si(&found.force, found.force_unit.unit().to_si(1.0));
    if !are_near(&u, &numbers(&truth["displacement_m"]), 2e-10) || !are_near(&f, &numbers(&truth["force_N"]), 6e-3) {
        return Some(format!("{} displacements {:?} .., forces {:?} ..", u.len(), u.first(), f.first()));
    }
    if let Some(load) = more["load"].as_f64()
        && found.load.is_some_and(|found| (found / load - 1.0).abs() > 1e-3)
    {
        return Some(format!("a load of {:?}", found.load));
    }
    let dt = more["dt"].as_f64()?;
    let times = found.time.as_ref()?;
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let is_right = (step / dt - 1.0).abs() < 0.05 && times.is_sorted();
    (!is_right).then(|| format!("a step of {step} s"))
}

fn wrong_scan(found: &ScanFile, truth: &Value, more: &Value) -> Option<String> {
    let (lateral, height) = (found.lateral.unit().to_si(1.0), found.height.unit().to_si(1.0));
    match &found.places {
        Places::Line { x, z } => {
            let x: Vec<f64> = x.iter().map(|place| (place - x[0]) * lateral).collect();
            let expected = numbers(&truth["x_m"]);
            let expected: Vec<f64> = expected.iter().map(|place| place - expected[0]).collect();
            let z: Option<Vec<f64>> = z.iter().map(|z| z.map(|z| z * height)).collect();
            let is_right = are_near(&x, &expected, 1e-9) && are_near(&z?, &numbers(&truth["z_m"]), 1e-11);
            (!is_right).then(|| format!("{x:?}"))
        }
        Places::Map { dx, dy, z } => {
            // The heights of a ball: the second difference is its curvature.
            let n = more["n"].as_u64().unwrap() as usize;
            let d = more["d"].as_f64().unwrap() * if more["si"].is_null() { 1e-6 } else { 1.0 };
            let is_size = z.len() == n && z.iter().all(|row| row.len() == n);
            let at = |row: usize, column: usize| z[row][column].map(|z| z * height);
            let curvature =
                (at(n / 2, 2)? - 2.0 * at(n / 2, n / 2)? + at(n / 2, n - 2)?) / ((n / 2 - 2) as f64 * d).powi(2);
            let is_right = is_size && (dx * lateral / d - 1.0).abs() < 1e-3 && (dy * lateral / d - 1.0).abs() < 1e-3;
            (!(is_right && (-curvature * 8e-3 - 1.0).abs() < 0.02)).then(|| format!("{dx} {dy} {curvature}"))
        }
        Places::Points { .. } => Some("points".to_owned()),
    }
}

/// Reads a file, and what is wrong with it; with the mapping of the reply the same is read again.
fn read(
    name: &str,
    kind: &str,
    mapping: &Mapping,
    truth: &Value,
    more: &Value,
) -> Result<(Option<String>, String), ImportError> {
    let bytes = std::fs::read(folder().join(name)).unwrap();
    if kind == "loop" {
        let found = read_loop(&bytes, mapping, &|| true)?;
        let again = Mapping::parse(&found.preview.mapping).unwrap();
        let again = read_loop(&bytes, &again, &|| true)
            .unwrap_or_else(|error| panic!("{name}: {}: {error}", found.preview.mapping));
        assert_eq!(
            (&again.displacement, &again.force, &again.time),
            (&found.displacement, &found.force, &found.time),
            "{name}"
        );
        assert_eq!((again.load, &again.preview.mapping), (found.load, &found.preview.mapping), "{name}");
        let said = format!("{:?} {:?}", found.preview.unused, found.preview.assumed);
        return Ok((wrong_loop(&found, &truth["loop"], more), said));
    }
    let found = read_scan(&bytes, mapping, 0, &|| true)?;
    let again = Mapping::parse(&found.preview.mapping).unwrap();
    let again = read_scan(&bytes, &again, 0, &|| true)
        .unwrap_or_else(|error| panic!("{name}: {}: {error}", found.preview.mapping));
    assert_eq!(again.places, found.places, "{name}: {}", found.preview.mapping);
    let said = format!("{:?} {:?}", found.preview.unused, found.preview.assumed);
    Ok((wrong_scan(&found, &truth["scan"], more), said))
}

#[test]
fn every_file_is_read_as_what_it_holds_or_has_a_way_out_that_works() {
    let truth: Value = serde_json::from_slice(&std::fs::read(folder().join("truth.json")).unwrap()).unwrap();
    let mut faults = Vec::new();
    for entry in truth["files"].as_array().unwrap() {
        let (name, kind) = (entry["file"].as_str().unwrap(), entry["kind"].as_str().unwrap());
        let (expect, more) = (entry["expect"].as_str().unwrap(), &entry["truth"]);
        let query = entry["query"].as_str().unwrap().trim_start_matches('?').replace('&', ";").replace('=', ":");
        let result = read(name, kind, &Mapping::parse(&query).unwrap(), &truth, more);
        let fault = match (expect, result) {
            ("fit_refuses", Ok(_)) => None,
            ("said_block" | "said", Ok((wrong, said))) => {
                wrong.or((!said.contains("table") && !said.contains("zeros")).then_some(said))
            }
            ("ask" | "ask_load", Ok((None, said))) => Some(format!("read without a question: {said}")),
            (_, Ok((wrong, _))) => wrong,
            ("ask" | "ask_load" | "said_block" | "said" | "map_or_ask" | "read_or_refuse", Err(error)) => {
                let mut follow = error
                    .candidates
                    .iter()
                    .map(|one| read(name, kind, &Mapping::parse(&one.mapping).unwrap(), &truth, more));
                // One of the candidates is what the file holds, and each settles the question.
                let mut faults: Vec<String> =
                    follow.by_ref().filter_map(|one| one.err().map(|error| error.to_string())).collect();
                if error.candidates.len() < 2 && expect != "read_or_refuse" {
                    faults.push(error.to_string());
                }
                faults.into_iter().next()
            }
            (_, Err(error)) => Some(error.to_string()),
        };
        faults.extend(fault.map(|fault| format!("{name} ({expect}): {fault}")));
    }
    assert!(faults.is_empty(), "{} of the files:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn files_of_other_kinds_are_named_with_the_way_to_read_them() {
    for (name, what, way) in [
        ("bin_jpk.jpk-force", "JPK", "afmformats"),
        ("bin_jsonlines.jsonl", "JSON Lines", "read_json"),
        ("bin_mat73.mat", "MATLAB 7.3", "h5py"),
        ("bin_mdf4.mf4", "MDF", "asammdf"),
        ("bin_set58.uff", "universal file", "pyuff"),
    ] {
        let bytes = std::fs::read(folder().join(name)).unwrap();
        let error = read_loop(&bytes, &Mapping::default(), &|| true).unwrap_err();
        assert!(error.fault.contains(what) && error.fault.contains(way), "{name}: {error}");
    }
}
