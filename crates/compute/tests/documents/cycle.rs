//! Steady cycles: what the mechanics has in closed form, and what has no value.

use serde_json::{Value, json};
use std::f64::consts::PI;
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, codes, number, of, timeless, with};
use crate::{assert_refused, good, post, problem, written};

const G_STAR: f64 = 8e10;
/// m = mu E*/G*.
const SCALE: f64 = 0.3 * 1e11 / G_STAR;

/// g = x^2 at d = 1.
fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 1e11, "g_star": G_STAR}},
        "friction": 0.3,
        "preload": {"indentation": 1.0}
    })
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} is not {expected:e}");
}

#[test]
fn work_and_describing_function_are_those_of_closed_forms() {
    let ask = |asked: Value| good(post("/cycle", &of(&unit_sphere(), &asked)));
    let reply = ask(json!({"drive": {"displacement": [0.9 * SCALE, SCALE]}, "harmonics": 2}));
    let cycles = reply["cycles"].as_array().unwrap();
    // oint q dW, q = F/(2 G* m).
    close(number(&cycles[0]["dissipated_energy"]) / (2.0 * G_STAR * SCALE * SCALE), 0.349_307_522_852_4, 1e-12);
    let (limit, first) = (number(&reply["contact"]["gross_slip_force"]), &cycles[1]["harmonics"][0]);
    close(number(&first["in_phase"]) / limit, 16.0 / (5.0 * PI), 1e-12);
    close(number(&first["quadrature"]) / limit, -4.0 / (5.0 * PI), 1e-12);
    assert_eq!(cycles[0]["harmonics"][1], json!({"order": 2, "in_phase": 0.0, "quadrature": 0.0}));
    assert_eq!((&cycles[0]["regime"], &cycles[1]["regime"]), (&json!("partial_slip"), &json!("gross_slip")));
    assert!(cycles[0].get("machine_amplitude").is_none() && cycles[0].get("friction_work").is_none());
    // d = 1 + 0.2 cos(t + phase), W = 0.3 cos t. The phase is that of the load here.
    let oscillating = json!({"indentation": 0.2, "phase": -45.0});
    let reply = ask(json!({"drive": {"displacement": 0.3 * SCALE}, "normal": oscillating}));
    let work = number(&reply["cycles"][0]["dissipated_energy"]) / (2.0 * G_STAR * SCALE * SCALE);
    close(work, 0.009_441_080_9, 1e-5);
    // What a machine moves is shared.
    let reply = ask(json!({"drive": {"displacement": SCALE}, "machine": {"stiffness": 1e11}}));
    let cycle = &reply["cycles"][0];
    let own = number(&cycle["displacement_amplitude"]) + number(&cycle["force_amplitude"]) / 1e11;
    close(number(&cycle["machine_amplitude"]), SCALE, 1e-14);
    close(own, SCALE, 1e-13);
    // So little a force sees the stiffness 2 G* a alone: U = P/|K - M w^2|.
    let natural = (2.0 * G_STAR / 5.0_f64).sqrt() / (2.0 * PI);
    let response = json!({"mass": 5.0, "drive_force": 1.0, "frequencies": [0.5 * natural, 2.0 * natural]});
    let reply = ask(json!({"drive": {"displacement": 0.0}, "frequency_response": response}));
    close(number(&reply["frequency_response"]["natural_frequency"]), natural, 1e-12);
    for (point, (share, lag)) in
        reply["frequency_response"]["points"].as_array().unwrap().iter().zip([(0.5_f64, 0.0), (2.0, 180.0)])
    {
        close(number(&point["amplitude"]), (1.0 / (2.0 * G_STAR) / (1.0 - share * share)).abs(), 1e-6);
        assert!((number(&point["phase"]) - lag).abs() < 1e-3, "{point}");
        assert!(number(&point["amplitude_error"]) <= 1e-6 * number(&point["amplitude"]), "{point}");
    }
    // So slow a drive beyond friction is not followed, and says so.
    let limit = number(&reply["contact"]["gross_slip_force"]);
    let response = json!({"mass": 5.0, "drive_force": 1.2 * limit, "frequencies": [0.001 * natural]});
    let asked = json!({"drive": {"displacement": 0.0}, "frequency_response": response, "tolerance": 1e-4});
    let reply = ask(asked);
    let point = &reply["frequency_response"]["points"][0];
    assert!(point["amplitude_error"].is_null() && point["peak_error"].is_null(), "{point}");
    assert!(codes(&reply).contains(&"tolerance_not_met"), "{reply}");
    // The curve of the best load has as many points as are asked for.
    let reply = ask(json!({"drive": {"displacement": 0.2 * SCALE}, "best_load": {"points": 30}}));
    let curve = &reply["cycles"][0]["best_load"]["curve"];
    assert!(["dissipated_energy", "normal_force"].iter().all(|name| curve[name].as_array().unwrap().len() == 30));
}

#[test]
fn one_amplitude_and_a_list_of_one_give_the_same_row_and_without_friction_ratios_have_no_value() {
    for (name, amplitude) in [("displacement", 1e-7), ("force", 1.0)] {
        let asked = |amplitude: Value| of(&ball(), &json!({"drive": {name: amplitude}, "harmonics": 3}));
        let one = good(post("/cycle", &asked(json!(amplitude))));
        let list = good(post("/cycle", &asked(json!([amplitude]))));
        assert_eq!(timeless(one), timeless(list));
    }
    let smooth = with(ball(), "/friction", json!(0.0));
    let asked = of(&smooth, &json!({"drive": {"displacement": [0.0, 1e-7]}, "harmonics": 1}));
    let reply = good(post("/cycle", &asked));
    let (still, slides) = (&reply["cycles"][0], &reply["cycles"][1]);
    assert_eq!((number(&still["loss_factor"]), number(&still["sliding_ratio"])), (0.0, 0.0));
    assert!(slides["loss_factor"].is_null() && slides["sliding_ratio"].is_null() && slides["regime"] == "gross_slip");
}

#[test]
fn what_cannot_be_asked_for_together_is_refused_at_its_place() {
    let force = json!({"drive": {"force": 1.0}});
    for (asked, code, pointer) in [
        (json!({"drive": {"force": 3.0}}), "force_exceeds_friction", "/drive/force"),
        (json!({"drive": {"force": [1.0, 3.5]}}), "force_exceeds_friction", "/drive/force/1"),
        (json!({"normal": {"normal_force": 9.0}}), "force_exceeds_friction", "/drive/force"),
        (json!({"drive": {"displacement": -1e-8}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"displacement": []}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"displacement": vec![1e-8; 10_001]}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"force": 1.0, "displacement": 1e-8}}), "invalid_input", "/drive"),
        (json!({"machine": {"stiffness": 0.0}}), "invalid_input", "/machine/stiffness"),
        (json!({"work_density": {}}), "invalid_input", "/work_density"),
        (
            json!({"drive": {"displacement": vec![1e-8; 101]}, "work_density": {"points": 2000}}),
            "invalid_input",
            "/work_density",
        ),
        (json!({"normal": {"normal_force": 1.0}, "work_density": {"points": 5}}), "invalid_input", "/work_density"),
        (json!({"normal": {}}), "invalid_input", "/normal"),
        (json!({"normal": {"normal_force": 11.0}}), "invalid_input", "/normal/normal_force"),
        (json!({"normal": {"normal_force": 1.0, "phase": 400.0}}), "invalid_input", "/normal/phase"),
        (
            json!({"frequency_response": {"mass": 1.0, "drive_force": 1.0, "frequencies": [0.0]}}),
            "invalid_input",
            "/frequency_response/frequencies/0",
        ),
        (
            json!({"machine": {"stiffness": 1.0}, "frequency_response": {"mass": 1.0, "drive_force": 1.0}}),
            "invalid_input",
            "/frequency_response",
        ),
        (json!({"drive": {"displacement": vec![1e-8; 101]}, "best_load": {}}), "invalid_input", "/best_load"),
    ] {
        assert_refused("/cycle", &of(&ball(), &changed(force.clone(), &asked)), (code, pointer, ""));
    }
}

#[test]
fn a_map_is_refused_at_its_place() {
    let drive = json!({"drive": {"displacement": [1e-8, 1e-7, 1e-6]}});
    let map = changed(drive, &json!({"map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 3}}}));
    for (wrong, pointer) in [
        (json!({"map": {"normal_force": {"from": 2.0, "to": 1.0, "count": 3}}}), "/map/normal_force/to"),
        (json!({"map": {}}), "/map/normal_force"),
        (json!({"harmonics": 3}), "/harmonics"),
        (json!({"normal": {"normal_force": 1.0}}), "/normal"),
        (json!({"work_density": {"points": 5}}), "/work_density"),
        (json!({"best_load": {}}), "/best_load"),
        (json!({"frequency_response": {"mass": 1.0, "drive_force": 1.0}}), "/frequency_response"),
        // Too many of both together, and a force that the smallest load does not hold.
        (
            json!({"drive": {"displacement": vec![1e-8; 5_001]},
                "map": {"normal_force": {"from": 1, "to": 9, "count": 20}}}),
            "/map/normal_force/count",
        ),
        (json!({"drive": {"force": 1.0}}), "/drive/force"),
    ] {
        let refused = problem(post("/cycle", &of(&ball(), &changed(map.clone(), &wrong))));
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer), "{wrong}");
    }
    // A load beyond the end of the shape.
    let table = json!({"type": "tabulated", "r": [0.0, 1e-5, 2e-5, 3e-5], "z": [0.0, 5e-9, 2e-8, 4.5e-8]});
    let ended = with(with(ball(), "/profile", table), "/preload", json!({"normal_force": 1e-3}));
    assert_refused("/cycle", &of(&ended, &map), ("beyond_profile", "/map/normal_force", ""));
}

#[test]
fn a_map_has_the_cycles_of_each_load() {
    let drive = json!({"drive": {"displacement": [1e-8, 1e-7, 1e-6]}});
    let map = changed(drive.clone(), &json!({"map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 3}}}));
    let whole = good(post("/cycle", &of(&ball(), &map)));
    close(number(&whole["contact"]["normal_force"]), 10.0, 1e-12);
    let cells = whole["cycles"].as_array().unwrap();
    assert_eq!(cells.len(), 9);
    for (cells, load) in cells.chunks(3).zip([1.0, 10.0, 100.0]) {
        let pressed = with(ball(), "/preload", json!({"normal_force": load}));
        let reply = good(post("/cycle", &of(&pressed, &drive)));
        for (cell, cycle) in cells.iter().zip(reply["cycles"].as_array().unwrap()) {
            close(number(&cell["normal_force"]), load, 1e-14);
            let begin = number(&reply["contact"]["gross_slip_displacement"]);
            close(number(&cell["gross_slip_displacement"]), begin, 1e-12);
            for name in ["displacement_amplitude", "force_amplitude", "secant_stiffness", "loss_factor"] {
                close(number(&cell[name]), number(&cycle[name]), 1e-9);
            }
            assert_eq!(cell["regime"], cycle["regime"]);
        }
    }
    let picture = written("/cycle", Format::Svg, None, &of(&ball(), &map));
    for text in ["Fretting map", "log₁₀(normal force / N)", "gross slip above"] {
        assert!(picture.contains(text), "{text}");
    }
}
