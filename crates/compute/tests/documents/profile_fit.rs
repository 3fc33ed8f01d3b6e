//! Scans: the profile that they become, their warnings, and every fault with its place. What a fit finds is tested in
//! `crates/measured/tests/scans`.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::json::{ball, codes, number, of, with};
use crate::{assert_refused, good, post, problem, written};

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

fn fitted(body: &Value) -> Value {
    good(post("/profiles/fit", body))
}

fn radius(reply: &Value) -> f64 {
    number(&reply["radius_of_curvature"]["value"])
}

#[test]
fn a_map_and_points_with_missing_heights_are_scans_too() {
    let height = |x: usize, y: usize| match (x + y).is_multiple_of(9) {
        true => Value::Null,
        false => json!(((2.0 * x as f64 - 30.0).powi(2) + (2.0 * y as f64 - 34.0).powi(2)) / 20.0),
    };
    let rows: Vec<Vec<Value>> = (0..32).map(|y| (0..32).map(|x| height(x, y)).collect()).collect();
    let places = |place: fn(usize) -> usize| (0..1024).map(|index| 2.0 * place(index) as f64).collect::<Vec<_>>();
    let points = json!({"x": places(|index| index % 32), "y": places(|index| index / 32), "z": rows.concat()});
    let map = with(line(), "/scan", json!({"map": {"dx": 2.0, "dy": 2.0, "z": rows}}));
    let map = fitted(&map);
    assert_eq!(map, fitted(&with(line(), "/scan", json!({"points": points}))));
    assert!((number(&map["centre"]["x"]) - 3e-5).abs() < 1e-9 && (number(&map["centre"]["y"]) - 3.4e-5).abs() < 1e-9);
    assert!((radius(&map) / 0.01 - 1.0).abs() < 1e-6);
}

#[test]
fn every_fault_of_a_scan_has_its_place() {
    let some = |count: usize| vec![1.0; count];
    let ragged = json!({"map": {"dx": 1, "dy": 1, "z": [some(4), some(4), some(5), some(4)]}});
    for (body, pointer) in [
        (with(line(), "/scan/line/x", json!([1.0])), "/scan/line/x"),
        (with(line(), "/scan/line/z", json!(some(400))), "/scan/line/z"),
        (with(line(), "/scan/line/z", json!(some(401))), "/scan/line/z"),
        (with(line(), "/scan/line/z", json!(vec![Value::Null; 401])), "/scan/line/z"),
        (with(line(), "/scan/map", json!({})), "/scan"),
        (with(line(), "/scan", ragged), "/scan/map/z/2"),
        (with(line(), "/units/height", json!("inch")), "/units/height"),
        (with(line(), "/orientation", json!("peak_down")), "/scan/line/z"),
        (with(line(), "/centre", json!({"x": 1e-3})), "/centre"),
        (with(line(), "/centre", json!("middle")), "/centre"),
        (with(line(), "/smoothing", json!({"knots": 1_000})), "/smoothing/knots"),
        (with(line(), "/smoothing", json!({"noise": 0.0})), "/smoothing/noise"),
        (with(loaded(), "/load/friction", json!(-1.0)), "/load/friction"),
    ] {
        assert_refused("/profiles/fit", &body, ("invalid_input", pointer, ""));
    }
    let far = with(loaded(), "/load/preload", json!({"normal_force": 1e3}));
    let said = "does not reach the edge of the contact: 207 um of about 3";
    assert_refused("/profiles/fit", &far, ("beyond_profile", "/load/preload", said));
}

#[test]
fn a_scan_that_can_hardly_be_meant_is_warned_of() {
    let heights = |places: &[usize], height: &dyn Fn(usize) -> f64| {
        let mut body = line();
        places.iter().enumerate().for_each(|(n, place)| body["scan"]["line"]["z"][*place] = json!(height(n)));
        body
    };
    let spikes: Vec<usize> = (5..400).step_by(13).collect();
    let fills = [-9999.0, 1.70141e38, 1e30, -32768.0];
    let one_sided = scan(|index| index as f64 - 20.0, |_, x| (x * 7.0).sin() / 2.0 - x * x / 20.0);
    // Nanometres taken for picometres, as it were: the radius of curvature comes out a thousand times too large.
    let wide: Vec<f64> = (0..401).map(|index| 1e3 * f64::from(index - 200)).collect();
    let wide = with(line(), "/scan/line/x", json!(wide));
    for (body, code, outliers) in [
        (wide.clone(), "units", None),
        // A contact that all but fills the scan.
        (with(loaded(), "/load/preload", json!({"contact_radius": 2e-4})), "short_scan", None),
        // Each at a height of its own: one that occurs often is a fill value.
        (heights(&spikes, &|index| 1e4 + index as f64), "many_outliers", Some(31)),
        (heights(&[50, 90, 130, 170], &|index| fills[index]), "fill_values", Some(4)),
        // The axis at a tenth of the scan from its edge.
        (with(one_sided, "/level", json!(false)), "one_sided_scan", None),
    ] {
        let reply = fitted(&body);
        assert_eq!(codes(&reply)[0], code, "{}", reply["warnings"]);
        assert!(outliers.is_none_or(|count| reply["residual"]["outliers"] == count), "{code}: {}", reply["residual"]);
    }
    let flat = with(ball(), "/profile", fitted(&wide)["profile"].clone());
    let reply = good(post("/simulate", &of(&flat, &json!({"path": {"force": [1.0]}}))));
    assert!(codes(&reply).contains(&"units"), "{:?}", codes(&reply));
}

#[test]
fn a_scan_of_a_ball_is_the_contact_of_that_ball() {
    let reply = fitted(&loaded());
    let error = number(&reply["radius_of_curvature"]["standard_error"]);
    assert!((radius(&reply) - 0.01).abs() < 3.0 * error + 1e-5 && error < 1e-3, "{reply}");
    assert!((number(&reply["centre"]["x"]) - 7e-6).abs() < 2e-7 && reply["centre"].get("y").is_none());
    assert_eq!((&reply["orientation"], &reply["warnings"]), (&json!("peak_up"), &json!([])));
    // What the reply says of the contact is what its profile has in a simulation, near Hertz's.
    let simulate = |contact: &Value| of(contact, &json!({"path": {"force": [1.0]}}));
    let contact = with(ball(), "/profile", reply["profile"].clone());
    let simulated = good(post("/simulate", &simulate(&contact)));
    let hertz = good(post("/simulate", &simulate(&ball())));
    for name in ["indentation", "contact_radius", "max_pressure"] {
        let [value, error] = ["value", "standard_error"].map(|part| number(&reply["contact"][name][part]));
        assert_eq!(value.to_bits(), number(&simulated["contact"][name]).to_bits(), "{name}");
        let truth = number(&hertz["contact"][name]);
        assert!((value - truth).abs() < 3.0 * error + 1e-3 * truth && error < 0.01 * truth, "{name} {value} {error}");
    }
    // Its errors belong to its table: both lists or none, as long as that, and no negative number.
    let errors = reply["profile"]["indentation_error"].as_array().unwrap().len();
    assert_eq!(errors, reply["profile"]["r"].as_array().unwrap().len());
    for (place, value) in [("/indentation_error", json!([1e-9])), ("/pressure_error/0", json!(-1e-9))] {
        let place = format!("/contact/profile{place}");
        let body = with(simulate(&contact), &place, value);
        assert_refused("/simulate", &body, ("invalid_input", &place, ""));
    }
    let mut half = simulate(&contact);
    half["contact"]["profile"].as_object_mut().unwrap().remove("pressure_error");
    assert!(format!("{:?}", problem(post("/simulate", &half))).contains("pressure_error"));
    // The document and the table have the same points.
    let rows: Value = serde_json::from_str(&written("/profiles/fit", Format::Rows, None, &line())).unwrap();
    let columns = fitted(&line());
    for (part, name) in [("fitted", "raw"), ("left_out", "left_out"), ("profile", "used")] {
        let of_part = rows.as_array().unwrap().iter().filter(|row| row["part"] == part);
        let heights: Value = of_part.map(|row| row["height"].clone()).collect();
        assert_eq!(heights, columns[name]["height"], "{part}");
    }
}
