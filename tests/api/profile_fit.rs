//! A scan over HTTP and on the command line: the profile it becomes, what follows from that, its warnings, and every
//! fault with its place. What a fit finds is tested in `crates/measured/tests/scans`.

use serde_json::{Value, json};

use crate::common::{Server, assert_refused, ball, good, number, of, problem, run, with};

/// Heights over a line of 401 places, in micrometres and nanometres.
fn scan(x: impl Fn(usize) -> f64, z: impl Fn(usize, f64) -> f64) -> Value {
    let x: Vec<f64> = (0..401).map(x).collect();
    let z: Vec<f64> = x.iter().enumerate().map(|(index, x)| z(index, *x)).collect();
    json!({"scan": {"line": {"x": x, "z": z}}, "units": {"lateral": "um", "height": "nm"}})
}

/// A line over a ball of 10 mm, upside down, with a little noise that is the same every time.
fn line() -> Value {
    let noise = |index: usize| ((index * 7919) % 101) as f64 / 50.0 - 1.0;
    scan(|index| index as f64 - 200.0, |index, x| noise(index) - (x - 7.0).powi(2) / 20.0)
}

fn loaded() -> Value {
    let load = json!({"material": ball()["material"], "friction": 0.3, "preload": {"normal_force": 10.0}});
    with(line(), "/load", load)
}

async fn fitted(server: &Server, body: &Value) -> Value {
    good(server.post("/profiles/fit", body).await).await
}

fn radius(reply: &Value) -> f64 {
    number(&reply["radius_of_curvature"]["value"])
}

#[tokio::test]
async fn a_scan_of_a_ball_is_the_contact_of_that_ball() {
    let server = Server::start().await;
    let reply = fitted(&server, &loaded()).await;
    let error = number(&reply["radius_of_curvature"]["standard_error"]);
    assert!((radius(&reply) - 0.01).abs() < 3.0 * error + 1e-5 && error < 1e-3, "{reply}");
    assert!((number(&reply["centre"]["x"]) - 7e-6).abs() < 2e-7 && reply["centre"].get("y").is_none());
    assert_eq!((&reply["orientation"], &reply["warnings"]), (&json!("peak_up"), &json!([])));
    // What the reply says of the contact is what its profile has in /simulate and /contacts, near Hertz's.
    let simulate = |contact: &Value| of(contact, &json!({"path": {"force": [1.0]}}));
    let contact = with(ball(), "/profile", reply["profile"].clone());
    let simulated = good(server.post("/simulate", &simulate(&contact)).await).await;
    let created = good(server.post("/contacts", &contact).await).await;
    let hertz = good(server.post("/simulate", &simulate(&ball())).await).await;
    for name in ["indentation", "contact_radius", "max_pressure"] {
        let [value, error] = ["value", "standard_error"].map(|part| number(&reply["contact"][name][part]));
        assert_eq!(value.to_bits(), number(&simulated["contact"][name]).to_bits(), "{name}");
        assert_eq!(created["contact"][name], simulated["contact"][name]);
        let truth = number(&hertz["contact"][name]);
        assert!((value - truth).abs() < 3.0 * error + 1e-3 * truth && error < 0.01 * truth, "{name} {value} {error}");
    }
    // Its errors belong to its table: both lists or none, as long as that, and no negative number.
    let errors = reply["profile"]["indentation_error"].as_array().unwrap().len();
    assert_eq!(errors, reply["profile"]["r"].as_array().unwrap().len());
    for (place, value) in [("/indentation_error", json!([1e-9])), ("/pressure_error/0", json!(-1e-9))] {
        let place = format!("/contact/profile{place}");
        let body = with(simulate(&contact), &place, value);
        assert_refused(&server, "/simulate", &body, ("invalid_input", &place, "")).await;
    }
    let mut half = simulate(&contact);
    half["contact"]["profile"].as_object_mut().unwrap().remove("pressure_error");
    assert!(format!("{:?}", problem(server.post("/simulate", &half).await).await).contains("pressure_error"));
    // The document and the table have the same points.
    let rows = good(server.post("/profiles/fit?format=rows", &line()).await).await;
    let columns = fitted(&server, &line()).await;
    for (part, name) in [("fitted", "raw"), ("left_out", "left_out"), ("profile", "used")] {
        let of_part = rows.as_array().unwrap().iter().filter(|row| row["part"] == part);
        let heights: Value = of_part.map(|row| row["height"].clone()).collect();
        assert_eq!(heights, columns[name]["height"], "{part}");
    }
}

#[test]
fn a_file_of_an_instrument_is_read_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let output = run(&["profile", file.to_str().unwrap(), "--json"]);
        (output.status.success(), output.stdout, String::from_utf8(output.stderr).unwrap())
    };
    // A matrix of Gwyddion with more heights than a request may have, and a hole.
    let height = |row: usize, column: usize| {
        let (x, y) = (column as f64 - 300.0, row as f64 - 280.0);
        if (row, column) == (7, 5) { "nan".to_owned() } else { format!("{:e}", -5e-11 * (x * x + y * y)) }
    };
    let rows = (0..560).map(|row| (0..600).map(|column| height(row, column)).collect::<Vec<_>>().join("\t"));
    let header = "# Channel: Height\n# Width: 600 µm\n# Height: 560 µm\n# Value units: m\n";
    let matrix = format!("{header}{}\n", rows.collect::<Vec<_>>().join("\n"));
    let (good, printed, said) = read("map.txt", matrix.as_bytes());
    assert!(good && (radius(&serde_json::from_slice(&printed).unwrap()) / 0.01 - 1.0).abs() < 0.01, "{said}");
    assert!(said.contains("600 x 560 heights in m") && said.contains("kept: 300 x 280 heights"), "{said}");
    // What a column was taken for is said.
    let scan = &line()["scan"]["line"];
    let rows = (0..401).map(|index| format!("{};{}\n", scan["x"][index], scan["z"][index])).collect::<String>();
    let (_, printed, said) = read("line.csv", format!("X [µm];Z [nm]\n{}", rows.replace('.', ",")).as_bytes());
    assert!((radius(&serde_json::from_slice(&printed).unwrap()) / 0.01 - 1.0).abs() < 0.01, "{said}");
    assert!(said.contains("x is `X [µm]`, in um") && said.contains("decimal commas"), "{said}");
}
