//! Steady cycles over HTTP: the figures of closed forms, every fault with its place, and a contact that they do not
//! change.

use std::f64::consts::PI;

use crate::common;

use common::{Server, ball, good, number, of, problem, run};
use reqwest::Method;
use serde_json::{Value, json};
use stickslip_wire::{Amplitudes, CycleDrive, CycleRequest, Machine, WorkDensity};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;
/// m = mu E*/G*.
const SCALE: f64 = FRICTION * E_STAR / G_STAR;

/// g = x^2 at d = 1.
fn unit_sphere() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": E_STAR, "g_star": G_STAR}},
        "friction": FRICTION,
        "preload": {"indentation": 1.0}
    })
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} is not {expected:e}");
}

/// A reply without the time that it took.
fn timeless(mut reply: Value) -> Value {
    reply["accuracy"].as_object_mut().unwrap().remove("compute_time").unwrap();
    reply
}

#[tokio::test]
async fn work_and_describing_function_are_those_of_closed_forms() {
    let server = Server::start().await;
    let asked = json!({"drive": {"displacement": [0.9 * SCALE, 0.5 * SCALE, SCALE]}, "harmonics": 2});
    let reply = good(server.post("/cycle", &of(&unit_sphere(), &asked)).await).await;
    let cycles = reply["cycles"].as_array().unwrap();
    // oint q dW, q = F/(2 G* m).
    close(number(&cycles[0]["dissipated_energy"]) / (2.0 * G_STAR * SCALE * SCALE), 0.349_307_522_852_4, 1e-12);
    let limit = number(&reply["contact"]["gross_slip_force"]);
    for (cycle, in_phase, quadrature) in
        [(&cycles[1], 0.647_223_121_426_06, -0.046_340_957_700_298), (&cycles[2], 16.0 / (5.0 * PI), -4.0 / (5.0 * PI))]
    {
        let first = &cycle["harmonics"][0];
        assert_eq!(first["order"], 1);
        close(number(&first["in_phase"]) / limit, in_phase, 1e-12);
        close(number(&first["quadrature"]) / limit, quadrature, 1e-12);
        assert_eq!(cycle["harmonics"][1], json!({"order": 2, "in_phase": 0.0, "quadrature": 0.0}));
    }
    assert_eq!((&cycles[1]["regime"], &cycles[2]["regime"]), (&json!("partial_slip"), &json!("gross_slip")));
    assert!(number(&reply["accuracy"]["force_error"]) < 1e-13 && reply["accuracy"]["solver"] == "exact");
    assert!(cycles[0].get("machine_amplitude").is_none() && cycles[0].get("friction_work").is_none());
}

#[tokio::test]
async fn the_phase_of_an_oscillating_load_changes_the_work() {
    let server = Server::start().await;
    // d = 1 + 0.2 cos(t + phase), W = 0.3 cos t: oint q dW found by stepping. The phase is that of the load here.
    for (phase, work) in [(0.0, 0.005_446_066_3), (-45.0, 0.009_441_080_9), (-90.0, 0.019_685_344_5)] {
        let asked = json!({"drive": {"displacement": 0.3 * SCALE}, "normal": {"indentation": 0.2, "phase": phase}});
        let reply = good(server.post("/cycle", &of(&unit_sphere(), &asked)).await).await;
        close(number(&reply["cycles"][0]["dissipated_energy"]) / (2.0 * G_STAR * SCALE * SCALE), work, 1e-5);
        assert!(number(&reply["accuracy"]["force_error"]) <= 1e-6, "{reply}");
    }
}

#[tokio::test]
async fn one_amplitude_and_a_list_of_one_give_the_same_row() {
    let server = Server::start().await;
    for (name, amplitude) in [("displacement", 1e-7), ("force", 1.0)] {
        let asked = |amplitude: Value| of(&ball(), &json!({"drive": {name: amplitude}, "harmonics": 3}));
        let one = good(server.post("/cycle", &asked(json!(amplitude))).await).await;
        let list = good(server.post("/cycle", &asked(json!([amplitude]))).await).await;
        assert_eq!(timeless(one), timeless(list));
    }
}

#[tokio::test]
async fn what_the_machine_moves_is_shared_and_the_work_per_area_adds_up() {
    let server = Server::start().await;
    let asked =
        json!({"drive": {"displacement": 2e-7}, "machine": {"stiffness": 2e7}, "work_density": {"points": 2001}});
    let reply = good(server.post("/cycle", &of(&ball(), &asked)).await).await;
    let cycle = &reply["cycles"][0];
    let (own, force) = (number(&cycle["displacement_amplitude"]), number(&cycle["force_amplitude"]));
    close(number(&cycle["machine_amplitude"]), 2e-7, 1e-14);
    close(own + force / 2e7, 2e-7, 1e-13);
    let column =
        |name: &str| -> Vec<f64> { cycle["friction_work"][name].as_array().unwrap().iter().map(number).collect() };
    let (radii, density) = (column("radius"), column("density"));
    let rings = (1..radii.len()).map(|index| {
        let mean = radii[index] * density[index] + radii[index - 1] * density[index - 1];
        PI * mean * (radii[index] - radii[index - 1])
    });
    // The trapezoidal rule, with the root at the edge.
    close(rings.sum(), number(&cycle["dissipated_energy"]), 1e-3);
}

#[tokio::test]
async fn a_contact_with_a_history_has_the_cycles_of_its_load_and_stays_as_it_is() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let path = json!({"path": {"moves": [{"displacement": 1e-7}, {"normal_force": 14.0}, {"displacement": -3e-8}]}});
    good(server.post(&format!("{contact}/path"), &path).await).await;
    let before = good(server.get(&contact).await).await;

    let query = "displacement=5e-8,1e-7&displacement=4e-7&machine_stiffness=2e7&harmonics=3&points=4";
    let response = server.get(&format!("{contact}/cycle?{query}")).await;
    let tag = response.headers()["etag"].to_str().unwrap().to_owned();
    let found = timeless(good(response).await);
    let mut loaded = ball();
    loaded["preload"] = json!({"normal_force": 14.0});
    let asked = json!({"drive": {"displacement": [5e-8, 1e-7, 4e-7]}, "machine": {"stiffness": 2e7}, "harmonics": 3,
        "work_density": {"points": 4}});
    assert_eq!(found, timeless(good(server.post("/cycle", &of(&loaded, &asked)).await).await));
    assert_eq!(found["cycles"].as_array().unwrap().len(), 3);

    assert_eq!((tag.as_str(), good(server.get(&contact).await).await), ("\"3\"", before));
    let again = server.send(Method::GET, &format!("{contact}/cycle?{query}"), None, &[("if-none-match", &tag)]).await;
    assert_eq!(again.status(), 304);
}

#[tokio::test]
async fn every_fault_has_its_place() {
    let server = Server::start().await;
    let many = vec![1e-8; 10_001];
    for (asked, code, pointer) in [
        (json!({"drive": {"force": 3.0}}), "force_exceeds_friction", "/drive/force"),
        (json!({"drive": {"force": [1.0, 3.5]}}), "force_exceeds_friction", "/drive/force/1"),
        (json!({"drive": {"displacement": -1e-8}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"displacement": [1e-8, 1e10]}}), "invalid_input", "/drive/displacement/1"),
        (json!({"drive": {"displacement": [1e-8, "x"]}}), "invalid_input", "/drive/displacement/1"),
        (json!({"drive": {"displacement": []}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"displacement": many}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"displacement": true}}), "invalid_input", "/drive/displacement"),
        (json!({"drive": {"force": 1.0, "displacement": 1e-8}}), "invalid_input", "/drive"),
        (json!({}), "invalid_input", "/drive"),
        (json!({"drive": {"force": 1.0}, "machine": {"stiffness": 0.0}}), "invalid_input", "/machine/stiffness"),
        (json!({"drive": {"force": 1.0}, "harmonics": 32}), "invalid_input", "/harmonics"),
        (json!({"drive": {"force": 1.0}, "tolerance": 1.0}), "invalid_input", "/tolerance"),
        (json!({"drive": {"force": 1.0}, "work_density": {"points": 1}}), "invalid_input", "/work_density/points"),
        (json!({"drive": {"force": 1.0}, "work_density": {}}), "invalid_input", "/work_density"),
        (
            json!({"drive": {"displacement": vec![1e-8; 101]}, "work_density": {"points": 2000}}),
            "invalid_input",
            "/work_density",
        ),
        (json!({"drive": {"force": 1.0}, "normal": {}}), "invalid_input", "/normal"),
        (json!({"drive": {"force": 1.0}, "normal": {"normal_force": 11.0}}), "invalid_input", "/normal/normal_force"),
        (json!({"drive": {"force": 1.0}, "normal": {"normal_force": 9.0}}), "force_exceeds_friction", "/drive/force"),
        (
            json!({"drive": {"force": 1.0}, "normal": {"normal_force": 1.0, "phase": 400.0}}),
            "invalid_input",
            "/normal/phase",
        ),
        (
            json!({"drive": {"force": 1.0}, "normal": {"normal_force": 1.0}, "work_density": {"points": 5}}),
            "invalid_input",
            "/work_density",
        ),
        (
            json!({"drive": {"force": 1.0}, "frequency_response": {"mass": 0.0, "drive_force": 1.0}}),
            "invalid_input",
            "/frequency_response/mass",
        ),
        (
            json!({"drive": {"force": 1.0}, "frequency_response": {"mass": 1.0, "drive_force": 1.0,
                "frequencies": [0.0]}}),
            "invalid_input",
            "/frequency_response/frequencies/0",
        ),
        (
            json!({"drive": {"force": 1.0}, "machine": {"stiffness": 1.0},
                "frequency_response": {"mass": 1.0, "drive_force": 1.0}}),
            "invalid_input",
            "/frequency_response",
        ),
        (json!({"drive": {"displacement": vec![1e-8; 101]}, "best_load": {}}), "invalid_input", "/best_load"),
        (json!({"drive": {"force": 1.0}, "best_load": {"points": 1}}), "invalid_input", "/best_load/points"),
    ] {
        let refused = problem(server.post("/cycle", &of(&ball(), &asked)).await).await;
        let place = refused.errors.first().map(|fault| fault.pointer.as_str());
        assert_eq!((refused.status, refused.code.as_str(), place), (422, code, Some(pointer)), "{refused:?}");
        assert!(code != "force_exceeds_friction" || refused.detail.contains("N was asked for"), "{refused:?}");
    }
    let contact = format!("/contacts/{}", server.contact().await);
    for (query, code, pointer) in [
        ("", "invalid_input", "/displacement"),
        ("force=1&displacement=1e-8", "invalid_input", "/force"),
        ("force=3", "force_exceeds_friction", "/force"),
        ("force=1,3", "force_exceeds_friction", "/force/1"),
        ("displacement=1e-8,-1", "invalid_input", "/displacement/1"),
        ("displacement=1e-8&machine_stiffness=-1", "invalid_input", "/machine_stiffness"),
        ("displacement=1e-8&points=1", "invalid_input", "/points"),
        ("displacement=1e-8&phase=1", "invalid_input", "/phase"),
    ] {
        let refused = problem(server.get(&format!("{contact}/cycle?{query}")).await).await;
        let place = refused.errors.first().map(|fault| fault.pointer.as_str());
        assert_eq!((refused.status, refused.code.as_str(), place), (422, code, Some(pointer)), "{query} {refused:?}");
    }
}

#[tokio::test]
async fn without_friction_nothing_is_stored_and_the_ratios_have_no_value() {
    let server = Server::start().await;
    let mut smooth = ball();
    smooth["friction"] = json!(0.0);
    let asked = json!({"drive": {"displacement": [0.0, 1e-7]}, "harmonics": 1});
    let reply = good(server.post("/cycle", &of(&smooth, &asked)).await).await;
    let (still, slides) = (&reply["cycles"][0], &reply["cycles"][1]);
    assert_eq!((number(&still["loss_factor"]), number(&still["sliding_ratio"])), (0.0, 0.0));
    assert!(slides["loss_factor"].is_null() && slides["sliding_ratio"].is_null() && slides["regime"] == "gross_slip");
}

#[tokio::test]
async fn the_client_and_the_command_line_say_what_the_service_says() {
    let server = Server::start().await;
    let asked = of(&ball(), &json!({"drive": {"force": [0.5, 1.5]}, "harmonics": 3, "machine": {"stiffness": 1e7}}));
    let reply = timeless(good(server.post("/cycle", &asked).await).await);
    let request: CycleRequest = serde_json::from_value(asked.clone()).unwrap();
    assert_eq!(timeless(json!(server.client.cycle(&request).await.unwrap())), reply);

    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cycle.json");
    std::fs::write(&file, asked.to_string()).unwrap();
    let printed = run(&["cycle", file.to_str().unwrap()]);
    assert!(printed.status.success());
    assert_eq!(timeless(serde_json::from_slice(&printed.stdout).unwrap()), reply);

    let id = server.contact().await.parse().unwrap();
    let drive = CycleDrive::Force(Amplitudes::Many(vec![0.5, 1.5]));
    let machine = Some(Machine { stiffness: 1e7 });
    let live = server.client.contact_cycle(id, &drive, machine, Some(3), &WorkDensity::default()).await.unwrap();
    assert_eq!(timeless(json!(live)), reply);
}

#[tokio::test]
async fn a_map_has_the_cycles_of_each_load() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cycle.json");
    let asked = of(&ball(), &json!({"drive": {"displacement": [1e-8, 1e-7, 1e-6]}}));
    std::fs::write(&file, asked.to_string()).unwrap();
    let printed = run(&["cycle", file.to_str().unwrap(), "--map", "1:100:3"]);
    let text = String::from_utf8(printed.stdout).unwrap();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!((lines.len(), lines[0][0]), (10, "normal_force"));
    let column = |name: &str| lines[0].iter().position(|column| *column == name).unwrap();
    let (regime, work) = (column("regime"), column("dissipated_energy"));
    let server = Server::start().await;
    let map = json!({"normal_force": {"from": 1.0, "to": 100.0, "count": 3}});
    let body = of(&ball(), &json!({"drive": asked["drive"], "map": map}));
    let whole = good(server.post("/cycle", &body).await).await;
    close(number(&whole["contact"]["normal_force"]), 10.0, 1e-12);
    let mut cells = whole["cycles"].as_array().unwrap().iter();
    for (rows, load) in lines[1..].chunks(3).zip([1.0, 10.0, 100.0]) {
        let mut pressed = ball();
        pressed["preload"] = json!({"normal_force": load});
        let reply = good(server.post("/cycle", &of(&pressed, &json!({"drive": asked["drive"]}))).await).await;
        for (row, cycle) in rows.iter().zip(reply["cycles"].as_array().unwrap()) {
            close(row[0].parse().unwrap(), load, 1e-14);
            assert_eq!(row[regime], cycle["regime"].as_str().unwrap());
            close(row[work].parse().unwrap(), number(&cycle["dissipated_energy"]), 1e-9);
            let cell = cells.next().unwrap();
            close(number(&cell["normal_force"]), load, 1e-14);
            close(
                number(&cell["gross_slip_displacement"]),
                number(&reply["contact"]["gross_slip_displacement"]),
                1e-12,
            );
            for name in ["displacement_amplitude", "force_amplitude", "secant_stiffness", "loss_factor"] {
                close(number(&cell[name]), number(&cycle[name]), 1e-9);
            }
            assert_eq!(cell["regime"], cycle["regime"]);
        }
    }
    assert!(cells.next().is_none());
    let csv = server.post("/cycle?format=csv", &body).await.text().await.unwrap();
    assert!(csv.starts_with("normal_force,gross_slip_displacement,displacement_amplitude,force_amplitude,"), "{csv}");
    assert_eq!((csv.lines().count(), &csv), (10, &text), "the columns and numbers of the command line");
    for wrong in ["1:100", "0:1:3", "2:1:3", "1:2:1", "1:2:1001", "a:b:c"] {
        assert!(!run(&["cycle", file.to_str().unwrap(), "--map", wrong]).status.success(), "{wrong}");
    }
}

#[tokio::test]
async fn a_map_has_the_lines_of_the_ball_and_refuses_what_is_wrong_at_its_place() {
    let server = Server::start().await;
    let base = json!({
        "drive": {"displacement": (0..30).map(|index| 1e-9 * 1.3_f64.powi(index)).collect::<Vec<_>>()},
        "map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 20}}
    });
    let reply = good(server.post("/cycle", &of(&ball(), &base)).await).await;
    let rows = reply["cycles"].as_array().unwrap();
    assert_eq!(rows.len(), 600);
    for row in rows {
        // Gross slip of a ball begins at a displacement that goes with the load to the power 2/3.
        let begin = number(&row["gross_slip_displacement"]);
        close(begin, number(&rows[0]["gross_slip_displacement"]) * number(&row["normal_force"]).powf(2.0 / 3.0), 1e-12);
        let slides = number(&row["displacement_amplitude"]) >= begin;
        assert_eq!(row["regime"], if slides { "gross_slip" } else { "partial_slip" });
    }
    let picture = server.post("/cycle?format=svg", &of(&ball(), &base)).await.text().await.unwrap();
    for text in [
        "Fretting map",
        "log₁₀(normal force / N)",
        "log₁₀(displacement amplitude U₀ / m)",
        "gross \
        slip above",
    ] {
        assert!(picture.contains(text), "{text}");
    }
    // The boundary, and a line for each power of ten of the work.
    let works = rows.iter().map(|row| number(&row["dissipated_energy"]).log10());
    let (least, most) = (works.clone().fold(f64::MAX, f64::min), works.fold(f64::MIN, f64::max));
    let decades = (least.ceil() as i32..=most.floor() as i32).count();
    let lines = picture.matches("<polyline").count();
    assert!(decades > 5 && lines > decades, "{decades} {lines}");

    let force = |from: Value, to: Value, count: Value| {
        let range = json!({"from": from, "to": to, "count": count});
        json!({"map": {"normal_force": range}})
    };
    for (wrong, pointer) in [
        (force(json!(0.0), json!(1.0), json!(3)), "/map/normal_force/from"),
        (force(json!(1.0), json!(1e300), json!(3)), "/map/normal_force/to"),
        (force(json!(2.0), json!(1.0), json!(3)), "/map/normal_force/to"),
        (force(json!(1.0), json!(2.0), json!(1)), "/map/normal_force/count"),
        (force(json!(1.0), json!(2.0), json!(1001)), "/map/normal_force/count"),
        (force(json!(1.0), json!(2.0), json!(1.5)), "/map/normal_force/count"),
        (json!({"map": {}}), "/map/normal_force"),
        (json!({"harmonics": 3}), "/harmonics"),
        (json!({"normal": {"normal_force": 1.0}}), "/normal"),
        (json!({"work_density": {"points": 5}}), "/work_density"),
        (json!({"best_load": {}}), "/best_load"),
        (json!({"frequency_response": {"mass": 1.0, "drive_force": 1.0}}), "/frequency_response"),
        // Too many of both together, and a force that the smallest load does not hold.
        (json!({"drive": {"displacement": vec![1e-8; 5_001]}}), "/map/normal_force/count"),
        (json!({"drive": {"force": 1.0}}), "/drive/force"),
    ] {
        let mut body = of(&ball(), &base);
        for (name, value) in wrong.as_object().unwrap() {
            body[name] = value.clone();
        }
        let refused = problem(server.post("/cycle", &body).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer), "{wrong}");
    }
    // A load beyond the end of the shape.
    let mut ended = ball();
    ended["profile"] = json!({"type": "tabulated", "r": [0.0, 1e-5, 2e-5, 3e-5], "z": [0.0, 5e-9, 2e-8, 4.5e-8]});
    ended["preload"] = json!({"normal_force": 1e-3});
    let refused = problem(server.post("/cycle", &of(&ended, &base)).await).await;
    assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/map/normal_force"));
}

#[tokio::test]
async fn the_best_load_beats_every_other_and_a_mass_on_the_contact_answers_its_drive() {
    let server = Server::start().await;
    let asked = json!({"drive": {"displacement": [0.2 * SCALE, 0.8 * SCALE]}, "best_load": {"points": 30}});
    let reply = good(server.post("/cycle", &of(&unit_sphere(), &asked)).await).await;
    for cycle in reply["cycles"].as_array().unwrap() {
        let best = &cycle["best_load"];
        let most = number(&best["dissipated_energy"]);
        assert!(most >= number(&cycle["dissipated_energy"]));
        let curve = best["curve"]["dissipated_energy"].as_array().unwrap();
        assert_eq!((curve.len(), best["curve"]["normal_force"].as_array().unwrap().len()), (30, 30));
        assert!(curve.iter().all(|work| number(work) <= most * (1.0 + 1e-9)), "{best}");
        // Three times the best does less.
        assert!(number(&curve[29]) < 0.99 * most);
    }
    // So little a force sees the stiffness 2 G* a alone: U = P/|K - M w^2|.
    let stiffness = 2.0 * G_STAR;
    let natural = (stiffness / 5.0_f64).sqrt() / (2.0 * PI);
    let frequencies = [0.5 * natural, 2.0 * natural];
    let asked = json!({
        "drive": {"displacement": 0.0},
        "frequency_response": {"mass": 5.0, "drive_force": 1.0, "frequencies": frequencies}
    });
    let reply = good(server.post("/cycle", &of(&unit_sphere(), &asked)).await).await;
    let response = &reply["frequency_response"];
    close(number(&response["natural_frequency"]), natural, 1e-12);
    let points = response["points"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    for (point, share) in points.iter().zip([0.5_f64, 2.0]) {
        close(number(&point["amplitude"]), (1.0 / stiffness / (1.0 - share * share)).abs(), 1e-6);
        let lag = if share < 1.0 { 0.0 } else { 180.0 };
        assert!((number(&point["phase"]) - lag).abs() < 1e-3, "{point}");
        close(number(&point["peak"]), number(&point["amplitude"]), 1e-5);
        assert!(number(&point["amplitude_error"]) <= 1e-6 * number(&point["amplitude"]), "{point}");
    }
    let automatic = json!({"drive": {"displacement": 0.0}, "frequency_response": {"mass": 5.0, "drive_force": 1e9}});
    let reply = good(server.post("/cycle", &of(&unit_sphere(), &automatic)).await).await;
    assert!(reply["frequency_response"]["points"].as_array().unwrap().len() >= 200);
}

#[tokio::test]
async fn an_oscillation_of_a_mass_has_its_peak_its_errors_and_a_warning_where_it_was_not_found() {
    let server = Server::start().await;
    let contact = json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"effective": {"e_star": 1e11, "g_star": 8e10}},
        "friction": 0.4,
        "preload": {"indentation": 1e-6}
    });
    let base = json!({"drive": {"displacement": 0.0}, "frequency_response": {"mass": 2.0, "drive_force": 1.0}});
    let reply = good(server.post("/cycle", &of(&contact, &base)).await).await;
    let limit = number(&reply["contact"]["gross_slip_force"]);
    let unit = number(&reply["contact"]["gross_slip_displacement"]);
    let natural = number(&reply["frequency_response"]["natural_frequency"]);
    let asked = |force: f64, frequencies: &[f64], tolerance: f64| {
        let frequencies: Vec<f64> = frequencies.iter().map(|share| share * natural).collect();
        let body = json!({"mass": 2.0, "drive_force": force * limit, "frequencies": frequencies});
        of(&contact, &json!({"drive": {"displacement": 0.0}, "frequency_response": body, "tolerance": tolerance}))
    };
    // The steady oscillation of integration in time, where the first harmonic alone would have 0.6281.
    let reply = good(server.post("/cycle", &asked(0.7, &[0.29, 0.9], 1e-4)).await).await;
    let points = reply["frequency_response"]["points"].as_array().unwrap();
    close(number(&points[0]["amplitude"]), 0.65847 * unit, 1e-4);
    close(number(&points[0]["peak"]), 0.81155 * unit, 1e-4);
    for point in points {
        for error in ["amplitude_error", "peak_error"] {
            assert!(number(&point[error]) <= 1e-4 * number(&point["amplitude"]), "{point}");
        }
    }
    assert!(reply["warnings"].as_array().unwrap().iter().all(|warning| warning["code"] != "tolerance_not_met"));
    // So slow a drive beyond friction is not followed, and says so.
    let reply = good(server.post("/cycle", &asked(1.2, &[0.001], 1e-4)).await).await;
    let point = &reply["frequency_response"]["points"][0];
    assert!(point["amplitude_error"].is_null() && point["peak_error"].is_null(), "{point}");
    assert!(number(&point["amplitude"]) > unit, "{point}");
    let warned = reply["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == "tolerance_not_met");
    assert!(warned, "{reply}");
}
