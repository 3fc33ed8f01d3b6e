//! A scan over HTTP: the profile it becomes, what follows from that, every fault with its place, and all formats.

use crate::common;

use common::{Server, ball, good, number, problem, run, with};
use serde_json::{Value, json};

/// A line over a ball of 10 mm, in micrometres and nanometres, upside down, with a little noise that is the same every
/// time.
fn line() -> Value {
    let x: Vec<f64> = (0..401).map(|index| f64::from(index - 200)).collect();
    let noise = |index: usize| ((index * 7919) % 101) as f64 / 50.0 - 1.0;
    let z: Vec<f64> = x.iter().enumerate().map(|(index, x)| noise(index) - (x - 7.0).powi(2) / 20.0).collect();
    json!({"scan": {"line": {"x": x, "z": z}}, "units": {"lateral": "um", "height": "nm"}})
}

fn loaded() -> Value {
    let ball = ball();
    let load = json!({"material": ball["material"], "friction": 0.3, "preload": {"normal_force": 10.0}});
    with(line(), "/load", load)
}

#[tokio::test]
async fn a_scan_of_a_ball_is_the_contact_of_that_ball() {
    let server = Server::start().await;
    let reply = good(server.post("/profiles/fit", &loaded()).await).await;
    let estimate = |of: &Value| (number(&of["value"]), number(&of["standard_error"]));
    let (radius, error) = estimate(&reply["radius_of_curvature"]);
    assert!((radius - 0.01).abs() < 3.0 * error + 1e-5 && error < 1e-3, "{radius} {error}");
    assert!((number(&reply["centre"]["x"]) - 7e-6).abs() < 2e-7 && reply["centre"].get("y").is_none());
    assert_eq!((&reply["orientation"], &reply["warnings"]), (&json!("peak_up"), &json!([])));
    assert!(number(&reply["residual"]["rms"]) < 1e-9 && number(&reply["g_margin"]) > 0.9);

    // What the reply says of the contact is what its profile has in /simulate and /contacts, near Hertz's.
    let mut contact = ball();
    contact["profile"] = reply["profile"].clone();
    let simulated = good(server.post("/simulate", &json!({"contact": contact, "path": {"force": [1.0]}})).await).await;
    let created = good(server.post("/contacts", &contact).await).await;
    let hertz = good(server.post("/simulate", &json!({"contact": ball(), "path": {"force": [1.0]}})).await).await;
    for name in ["indentation", "contact_radius", "max_pressure"] {
        let (value, error) = estimate(&reply["contact"][name]);
        assert_eq!(value.to_bits(), number(&simulated["contact"][name]).to_bits(), "{name}");
        assert_eq!(created["contact"][name], simulated["contact"][name]);
        let truth = number(&hertz["contact"][name]);
        assert!((value - truth).abs() < 3.0 * error + 1e-3 * truth && error < 0.01 * truth, "{name} {value} {error}");
    }
    assert_eq!(estimate(&reply["contact"]["normal_force"]), (10.0, 0.0));
}

#[tokio::test]
async fn a_map_and_points_with_missing_heights_are_scans_too() {
    let server = Server::start().await;
    let height = |x: f64, y: f64| ((x - 30.0).powi(2) + (y - 34.0).powi(2)) / 20.0;
    let row = |y: usize| -> Vec<Value> {
        let at = |x: usize| {
            if (x + y).is_multiple_of(9) { Value::Null } else { json!(height(2.0 * x as f64, 2.0 * y as f64)) }
        };
        (0..32).map(at).collect()
    };
    let rows: Vec<Vec<Value>> = (0..32).map(row).collect();
    let units = json!({"lateral": "um", "height": "nm"});
    let map = json!({"scan": {"map": {"dx": 2.0, "dy": 2.0, "z": rows}}, "units": units});
    let place = |index: usize| (f64::from((index % 32) as u32), f64::from((index / 32) as u32));
    let x: Vec<f64> = (0..1024).map(|index| 2.0 * place(index).0).collect();
    let y: Vec<f64> = (0..1024).map(|index| 2.0 * place(index).1).collect();
    let points = json!({"scan": {"points": {"x": x, "y": y, "z": rows.concat()}}, "units": units});
    let (map, points) =
        (good(server.post("/profiles/fit", &map).await).await, good(server.post("/profiles/fit", &points).await).await);
    assert_eq!(map, points);
    assert!((number(&map["centre"]["x"]) - 3e-5).abs() < 1e-9 && (number(&map["centre"]["y"]) - 3.4e-5).abs() < 1e-9);
    assert!((number(&map["radius_of_curvature"]["value"]) / 0.01 - 1.0).abs() < 1e-6);
}

#[tokio::test]
async fn every_fault_of_a_scan_has_its_place() {
    let server = Server::start().await;
    let some = |count: usize| vec![1.0; count];
    for (body, pointer, code) in [
        (with(line(), "/scan/line/x", json!([1.0])), "/scan/line/x", "invalid_input"),
        (with(line(), "/scan/line/z", json!(some(400))), "/scan/line/z", "invalid_input"),
        (with(line(), "/scan/line/z", json!(some(401))), "/scan/line/z", "invalid_input"),
        (with(line(), "/scan/line/z", json!(vec![Value::Null; 401])), "/scan/line/z", "invalid_input"),
        (with(line(), "/scan/line/z/3", json!("NaN")), "/scan/line/z/3", "invalid_input"),
        (with(line(), "/scan/line/z/3", json!(1e13)), "/scan/line/z/3", "invalid_input"),
        (with(line(), "/scan/line/x/3", Value::Null), "/scan/line/x/3", "invalid_input"),
        (with(line(), "/scan/map", json!({})), "/scan", "invalid_input"),
        (
            with(line(), "/scan", json!({"map": {"dx": 1, "dy": 1, "z": vec![some(4), some(4), some(5), some(4)]}})),
            "/scan/map/z/2",
            "invalid_input",
        ),
        (with(line(), "/units/height", json!("inch")), "/units/height", "invalid_input"),
        (with(line(), "/orientation", json!("peak_down")), "/scan/line/z", "invalid_input"),
        (with(line(), "/centre", json!({"x": 1e-3})), "/centre", "invalid_input"),
        (with(line(), "/centre", json!("middle")), "/centre", "invalid_input"),
        (with(line(), "/smoothing", json!({"knots": 1_000})), "/smoothing/knots", "invalid_input"),
        (with(line(), "/smoothing", json!({"noise": 0.0})), "/smoothing/noise", "invalid_input"),
        (with(loaded(), "/load/friction", json!(-1.0)), "/load/friction", "invalid_input"),
        (with(loaded(), "/load/preload", json!({"normal_force": 1e4})), "/load/preload", "beyond_profile"),
    ] {
        let refused = problem(server.post("/profiles/fit", &body).await).await;
        let first = &refused.errors[0];
        assert_eq!((first.pointer.as_str(), refused.code.as_str()), (pointer, code), "{refused:?}");
    }
    let far = with(loaded(), "/load/preload", json!({"normal_force": 1e3}));
    let said = problem(server.post("/profiles/fit", &far).await).await.detail;
    assert!(said.contains("does not reach the edge of the contact: 207 um of about 3"), "{said}");
}

#[tokio::test]
async fn a_scan_in_the_wrong_units_is_warned_of() {
    let server = Server::start().await;
    // Nanometres taken for picometres, as it were: the radius of curvature comes out a thousand times too large.
    let flat =
        with(line(), "/scan/line/x", json!((0..401).map(|index| 1e3 * f64::from(index - 200)).collect::<Vec<_>>()));
    let flat = good(server.post("/profiles/fit", &flat).await).await;
    assert_eq!(flat["warnings"][0]["code"], "units", "{}", flat["warnings"]);
    let mut contact = ball();
    contact["profile"] = flat["profile"].clone();
    let reply = good(server.post("/simulate", &json!({"contact": contact, "path": {"force": [1.0]}})).await).await;
    let codes: Vec<_> = reply["warnings"].as_array().unwrap().iter().map(|warning| &warning["code"]).collect();
    assert!(codes.contains(&&json!("units")), "{codes:?}");
    // A contact that all but fills the scan, and many spikes.
    let short = with(loaded(), "/load/preload", json!({"contact_radius": 2e-4}));
    let short = good(server.post("/profiles/fit", &short).await).await;
    assert_eq!(short["warnings"][0]["code"], "short_scan");
    let mut spiked = line();
    for index in (5..400).step_by(13) {
        // Each at a height of its own: one that occurs often is a fill value.
        spiked["scan"]["line"]["z"][index] = json!(1e4 + index as f64);
    }
    let spiked = good(server.post("/profiles/fit", &spiked).await).await;
    assert_eq!(
        (&spiked["warnings"][0]["code"], &spiked["residual"]["outliers"]),
        (&json!("many_outliers"), &json!(31))
    );
}

#[tokio::test]
async fn fill_values_are_missing_heights_and_a_scan_of_one_side_is_warned_of() {
    let server = Server::start().await;
    let expected = good(server.post("/profiles/fit", &line()).await).await;
    let mut dropped = line();
    for (index, value) in [-9999.0, 1.70141e38, 1e30, -32768.0].into_iter().enumerate() {
        dropped["scan"]["line"]["z"][50 + 40 * index] = json!(value);
    }
    let fitted = good(server.post("/profiles/fit", &dropped).await).await;
    let warning = &fitted["warnings"][0];
    assert_eq!((&warning["code"], &fitted["residual"]["outliers"]), (&json!("fill_values"), &json!(4)));
    assert!(warning["message"].as_str().unwrap().starts_with("4 heights were read as missing"), "{warning}");
    let radius = |reply: &Value| number(&reply["radius_of_curvature"]["value"]);
    assert!((radius(&fitted) / radius(&expected) - 1.0).abs() < 1e-3);
    // The axis at a tenth of the scan from its edge.
    let shifted: Vec<f64> = (0..401).map(|index| f64::from(index - 20)).collect();
    let z: Vec<f64> = shifted.iter().map(|x| (x * 7.0).sin() / 2.0 - x * x / 20.0).collect();
    let one_sided = json!({"scan": {"line": {"x": shifted, "z": z}}, "level": false,
        "units": {"lateral": "um", "height": "nm"}});
    let fitted = good(server.post("/profiles/fit", &one_sided).await).await;
    assert_eq!(fitted["warnings"][0]["code"], "one_sided_scan", "{}", fitted["warnings"]);
}

#[tokio::test]
async fn all_formats_have_the_points_of_the_reply() {
    let server = Server::start().await;
    let columns = good(server.post("/profiles/fit", &line()).await).await;
    let rows = good(server.post("/profiles/fit?format=rows", &line()).await).await;
    let rows = rows.as_array().unwrap();
    for (part, name) in [("fitted", "raw"), ("left_out", "left_out"), ("profile", "used")] {
        let of_part: Vec<&Value> = rows.iter().filter(|row| row["part"] == part).collect();
        for column in ["radius", "height"] {
            let values: Vec<&Value> = of_part.iter().map(|row| &row[column]).collect();
            assert_eq!(values, columns[name][column].as_array().unwrap().iter().collect::<Vec<_>>(), "{part} {column}");
        }
    }
    for (format, begins) in [
        ("csv", "part,radius,height\n"),
        ("ndjson", "{\"part\":"),
        ("svg", "<svg"),
        ("arrow", ""),
        ("png", "\u{89}PNG"),
    ] {
        let written = server.post(&format!("/profiles/fit?format={format}"), &line()).await;
        assert_eq!(written.status(), 200, "{format}");
        let bytes = written.bytes().await.unwrap();
        let text: String = bytes.iter().take(40).map(|byte| char::from(*byte)).collect();
        assert!(text.starts_with(begins), "{format}: {text}");
    }
}

#[tokio::test]
async fn a_contact_of_a_fitted_profile_states_the_error_of_the_fit() {
    let server = Server::start().await;
    let mut task = loaded();
    // A worn ball: nothing rises over the first 40 um.
    let shape = |x: f64| if x.abs() < 40.0 { 0.0 } else { (x * x - 1600.0) / 20.0 };
    let z: Vec<f64> =
        (0..401).map(|index| ((index * 7919) % 101) as f64 / 10.0 + shape(f64::from(index - 200))).collect();
    task["scan"]["line"]["z"] = json!(z);
    let reply = good(server.post("/profiles/fit", &task).await).await;
    let errors = &reply["profile"]["indentation_error"];
    assert_eq!(errors.as_array().unwrap().len(), reply["profile"]["r"].as_array().unwrap().len());
    let mut contact = ball();
    (contact["friction"], contact["profile"]) = (json!(0.3), reply["profile"].clone());
    let simulate = |contact: &Value| json!({"contact": contact, "path": {"force": [1.0]}});
    let stated = good(server.post("/simulate", &simulate(&contact)).await).await;
    let indentation = &reply["contact"]["indentation"];
    let share = number(&indentation["standard_error"]) / number(&indentation["value"]);
    let error = number(&stated["accuracy"]["force_error"]);
    assert!((0.5..20.0).contains(&(error / share)), "{error} of {share}");
    let codes = |reply: &Value| reply["warnings"].to_string();
    assert!(!codes(&stated).contains("noisy_table"), "{stated}");
    // Both members or none, as long as the table, and no negative number.
    for (pointer, value, fault) in [
        ("/contact/profile/indentation_error", json!([1e-9]), "/contact/profile/indentation_error"),
        ("/contact/profile/pressure_error/0", json!(-1e-9), "/contact/profile/pressure_error/0"),
    ] {
        let refused = problem(server.post("/simulate", &with(simulate(&contact), pointer, value)).await).await;
        assert_eq!(refused.errors[0].pointer, fault, "{refused:?}");
    }
    contact["profile"].as_object_mut().unwrap().remove("pressure_error");
    let refused = problem(server.post("/simulate", &simulate(&contact)).await).await;
    assert!(format!("{refused:?}").contains("pressure_error"), "{refused:?}");
}

#[test]
fn a_file_of_an_instrument_is_read_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let fitted = |name: &str, bytes: &[u8]| -> (Value, String) {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let output = run(&["profile", file.to_str().unwrap(), "--json"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        (serde_json::from_slice(&output.stdout).unwrap(), said)
    };
    let radius = |reply: &Value| number(&reply["radius_of_curvature"]["value"]);
    let scan = &line()["scan"]["line"];
    let rows = (0..401).map(|index| format!("{};{}\n", scan["x"][index], scan["z"][index])).collect::<String>();
    // The units are those of the header, in whatever encoding; a header without units is in metres, which no ball is.
    let text = format!("X [µm];Z [nm]\n{}", rows.replace('.', ","));
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let latin: Vec<u8> = text.chars().map(|letter| u8::try_from(u32::from(letter)).unwrap()).collect();
    let (expected, said) = fitted("utf-8.csv", text.as_bytes());
    assert!((radius(&expected) / 0.01 - 1.0).abs() < 0.01, "{}", radius(&expected));
    assert!(said.contains("x is `X [µm]`, in um") && said.contains("decimal commas"), "{said}");
    for (name, bytes) in [("utf-16.csv", &wide), ("latin-1.csv", &latin)] {
        assert_eq!(fitted(name, bytes).0["profile"], expected["profile"], "{name}");
    }
    // A matrix of Gwyddion with more heights than a request may have, and a hole.
    let height = |row: usize, column: usize| {
        let (x, y) = (column as f64 - 300.0, row as f64 - 280.0);
        if (row, column) == (7, 5) { "nan".to_owned() } else { format!("{:e}", -5e-11 * (x * x + y * y)) }
    };
    let rows = (0..560).map(|row| (0..600).map(|column| height(row, column)).collect::<Vec<_>>().join("\t"));
    let header = "# Channel: Height\n# Width: 600 µm\n# Height: 560 µm\n# Value units: m\n";
    let matrix = format!("{header}{}\n", rows.collect::<Vec<_>>().join("\n"));
    let (found, said) = fitted("map.txt", matrix.as_bytes());
    assert!((radius(&found) / 0.01 - 1.0).abs() < 0.01, "{}", radius(&found));
    assert!(said.contains("600 x 560 heights in m") && said.contains("to 300 x 280 heights"), "{said}");
    // What is wrong is said by line and column.
    let file = folder.path().join("wrong.csv");
    std::fs::write(&file, "X [um];Z [nm]\n1;2\n3;four\n").unwrap();
    let refused = run(&["profile", file.to_str().unwrap()]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && said.contains("line 3, column 2: `four` is not a number"), "{said}");
}
