//! Contacts of bodies with memory: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/viscoelastic.rs`.

use serde_json::{Value, json};

use stickslip_compute::computations::entries;
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of, timeless};
use crate::{assert_refused, good, post, problem, written};

fn rubber() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 3e6, "poisson_ratio": 0.5}, "rigid"]},
        "friction": 0.8,
        "prony": [{"ratio": 0.4, "time": 0.01}, {"ratio": 0.3, "time": 1.0}],
        "preload": {"indentation": 1e-4}
    })
}

fn moves(contact: &Value, moves: Value) -> Value {
    of(contact, &json!({"path": {"moves": moves}}))
}

#[test]
fn a_path_in_time_relaxes_and_states_its_springs() {
    let body = moves(&rubber(), json!([{"duration": 1.0}, {"displacement": 2e-5, "duration": 0.01}, {"duration": 5}]));
    let reply = good(post("/simulate", &body));
    let left = |time: f64| 0.3 + 0.4 * (-time / 0.01).exp() + 0.3 * (-time).exp();
    let at_once = number(&reply["contact"]["normal_force"]);
    let held = number(&reply["steps"][0]["normal_force"]);
    let error = number(&reply["accuracy"]["force_error"]);
    assert!((held / at_once - left(1.0)).abs() < error && error < 1e-5, "{held} {error}");
    let [before, after] = [1, 2].map(|index| number(&reply["steps"][index]["force"]));
    assert!(after > 0.0 && after < 0.7 * before, "{before} {after}");
    let last = &reply["steps"][2];
    assert!((number(&last["time"]) - 6.01).abs() < 1e-12 && number(&last["viscous_work"]) > 0.0, "{last}");
    let accuracy = &reply["accuracy"];
    assert_eq!(accuracy["solver"], "springs");
    assert!(number(&accuracy["count"]) > 100.0 && number(&accuracy["steps"]) > 3.0, "{accuracy}");
    assert_eq!(reply["warnings"].as_array().unwrap().iter().filter(|one| one["code"] == "beyond_annulus").count(), 0);
}

#[test]
fn elastic_bodies_have_neither_time_nor_viscous_work() {
    let path = json!([{"displacement": 1e-7}]);
    let plain = timeless(good(post("/simulate", &moves(&ball(), path))));
    let timed = json!([{"displacement": 1e-7, "duration": 0.0}]);
    assert_eq!(plain, timeless(good(post("/simulate", &moves(&ball(), timed)))));
    assert!(plain["steps"][0].get("time").is_none() && plain["steps"][0].get("viscous_work").is_none());
}

#[test]
fn what_memory_does_not_allow_is_refused_at_its_place() {
    let wait = json!([{"duration": 1.0}]);
    let place = "/contact/prony";
    let with = |members: Value| changed(rubber(), &members);
    let refused = |contact: &Value, place: &str, text: &str| {
        assert_refused("/simulate", &moves(contact, wait.clone()), ("invalid_input", place, text));
    };
    let term = |ratio: f64, time: f64| json!({"ratio": ratio, "time": time});
    refused(&with(json!({"prony": []})), place, "1");
    refused(&with(json!({"prony": vec![term(0.01, 1.0); 17]})), place, "16");
    refused(&with(json!({"prony": [term(0.7, 1.0), term(0.4, 2.0)]})), place, "at most 1");
    refused(&with(json!({"prony": [term(-0.1, 1.0)]})), "/contact/prony/0/ratio", "out of range");
    refused(&with(json!({"prony": [term(0.1, 0.0)]})), "/contact/prony/0/time", "out of range");
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let rubbers = json!({"youngs_modulus": 3e6, "poisson_ratio": 0.5});
    refused(&with(json!({"material": {"bodies": [rubbers, steel]}})), place, "alike");
    good(post("/simulate", &moves(&with(json!({"material": {"bodies": [rubbers, rubbers]}})), wait.clone())));
    refused(&with(json!({"shear_strength": 1e4})), place, "memory");
    refused(&changed(cylinder(), &json!({"prony": [term(0.1, 1.0)]})), place, "line contact");
    for (profile, _) in known_by_load_curves() {
        let contact = changed(ball(), &json!({"profile": profile, "prony": [term(0.1, 1.0)]}));
        assert_refused("/simulate", &moves(&contact, wait.clone()), ("no_stress_field", place, "load curve"));
    }
    refused(&ball(), "/path/moves/0/duration", "memory");
    let fluid = with(json!({"prony": [term(1.0, 1.0)]}));
    let held = json!([{"normal_force": 0.1, "duration": 1.0}]);
    assert_refused("/simulate", &moves(&fluid, held), ("invalid_input", "/path/moves/0/duration", "flows"));
    good(post("/simulate", &moves(&fluid, wait.clone())));

    let path = json!({"path": {"displacement": [1e-5]}});
    let asked = |rest: Value| of(&rubber(), &changed(path.clone(), &rest));
    for rest in [
        json!({"stress": {"points": 5}}),
        json!({"residual": true}),
        json!({"solver": {"springs": {"count": 100}}}),
        json!({"path": {"equal_peaks": {"reversals": 4}}}),
        json!({"path": {"moves": [{"displacement": [1e-5, 0.0]}, {"displacement": [1e-5, 1e-5]}]}}),
    ] {
        assert_refused("/simulate", &asked(rest), ("invalid_input", place, "not available for bodies with memory"));
    }
    let pairs = json!([{"displacement": [1e-7, 1e-7], "duration": 1.0}]);
    assert_refused("/simulate", &moves(&ball(), pairs), ("invalid_input", "/path/moves/0/duration", "in the plane"));
}

#[test]
fn every_computation_that_knows_elastic_bodies_alone_refuses_the_others_by_name() {
    let mut refused = Vec::new();
    for entry in entries() {
        let Some(route) = entry.about.route else { continue };
        for example in (entry.examples)() {
            let Some(contact) = example.value.get("contact") else { continue };
            // What bodies with memory have.
            if ["by force", "frequencies"].contains(&example.name) {
                continue;
            }
            let mut body = example.value.clone();
            let round = if contact["profile"]["type"] == "cylinder" { contact } else { &rubber() };
            body["contact"] = changed(round.clone(), &json!({"prony": [{"ratio": 0.5, "time": 1.0}]}));
            let name = format!("{} {}", route.path, example.name);
            let refusal = problem(post(route.path, &body));
            let (fault, text) = (&refusal.errors[0], format!("{name}: {refusal:?}"));
            assert_eq!(refusal.code.as_str(), "invalid_input", "{text}");
            let named = ["memory", "prony"].iter().any(|word| fault.detail.contains(word));
            assert!(named && ["/contact/prony", "/frequency"].contains(&fault.pointer.as_str()), "{text}");
            refused.push(route.path);
        }
    }
    for route in ["/accuracy", "/cycle", "/fit", "/fretting", "/protocols", "/rolling", "/sliders", "/wear"] {
        assert!(refused.contains(&route), "{route}: {refused:?}");
    }
}

#[test]
fn a_duration_beside_a_path_is_that_of_each_of_its_moves() {
    let with = |path: Value| of(&rubber(), &json!({"path": path}));
    let long = good(post("/simulate", &with(json!({"displacement": [1e-5, -1e-5, 0.0], "duration": 0.01}))));
    let moves = [1e-5, -1e-5, 0.0].map(|to| json!({"displacement": to, "duration": 0.01}));
    assert_eq!(timeless(long.clone()), timeless(good(post("/simulate", &with(json!({"moves": moves}))))));
    assert!((number(&long["steps"][2]["time"]) - 0.03).abs() < 1e-15);
    // In any order of the members, and a move that says so itself keeps its own.
    let own = json!({"duration": 0.02, "moves": [{"force": 1e-3}, {"indentation": 1.1e-4, "duration": 0.5}]});
    let own = good(post("/simulate", &with(own)));
    assert!((number(&own["steps"][1]["time"]) - 0.52).abs() < 1e-15);
    for (path, end) in [
        (json!({"force": [1e-3, 0.0], "duration": 0.1}), 0.2),
        (json!({"falling_amplitude": {"reversals": 4, "amplitude": 1e-5}, "duration": 0.1}), 0.5),
        (json!({"cycles": {"displacement": 1e-5, "count": 2, "points_per_cycle": 4}, "duration": 0.1}), 0.9),
    ] {
        let reply = good(post("/simulate", &with(path)));
        let last = reply["steps"].as_array().unwrap().last().unwrap();
        assert!((number(&last["time"]) - end).abs() < 1e-12, "{last}");
    }
    let place = "/path/duration";
    let path = |members: Value| json!({"path": changed(json!({"duration": 0.1}), &members)});
    let refused = |contact: &Value, path: Value, text| {
        assert_refused("/simulate", &of(contact, &path), ("invalid_input", place, text));
    };
    refused(&ball(), path(json!({"displacement": [1e-7]})), "memory");
    refused(&rubber(), path(json!({"displacement": [1e-7], "duration": -1.0})), "out of range");
    let fluid = changed(rubber(), &json!({"prony": [{"ratio": 1.0, "time": 1.0}]}));
    refused(&fluid, path(json!({"moves": [{"normal_force": 0.1}]})), "flows");
    for members in [
        json!({"ellipse": {"radii": [1e-7, 5e-8], "turns": 1}}),
        json!({"equal_peaks": {"reversals": 4}}),
        json!({"twist": [1e-3]}),
        json!({"torque": [1e-3]}),
    ] {
        refused(&ball(), path(members), "memory");
    }
    let accuracy = of(&ball(), &path(json!({"displacement": [1e-7]})));
    assert_refused("/accuracy", &accuracy, ("invalid_input", place, "memory"));
    let (mut cracks, timed) = (fretting(), json!({"cycles": {"displacement": 1e-7, "count": 1}, "duration": 0.1}));
    cracks["path"] = timed;
    assert_refused("/fretting", &cracks, ("invalid_input", place, "memory"));
    // A path alone is none, and two keys are still too many.
    for path in [json!({"duration": 0.1}), json!({"displacement": [1e-7], "duration": 0.1, "force": [1.0]})] {
        let refused = problem(post("/simulate", &with(path)));
        assert_eq!(refused.errors[0].pointer, "/path", "{refused:?}");
    }
}

/// The first example of a search for cracks.
fn fretting() -> Value {
    let entry = entries().into_iter().find(|entry| entry.about.name == "fretting").unwrap();
    (entry.examples)().swap_remove(0).value
}

#[test]
fn steady_cycles_are_given_for_each_frequency_and_amplitude() {
    // The values of `crates/mechanics/tests/physics/viscoelastic.rs`, with R = 1 + 2 e^-t of E*.
    let contact = json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 3e4, "g_star": 2.4e4}},
        "friction": 0.5, "prony": [{"ratio": 2.0 / 3.0, "time": 1.0}], "preload": {"indentation": 0.01}
    });
    let amplitude = 0.4 * 0.5 * 1.25 * 0.01;
    let turned = [0.01, 0.1, 1.0, 10.0].map(|turned| turned / std::f64::consts::TAU);
    let body = json!({"drive": {"displacement": [amplitude, 2.0 * amplitude]}, "frequency": turned, "harmonics": 1});
    let reply = good(post("/cycle", &of(&contact, &body)));
    let rows = reply["cycles"].as_array().unwrap();
    assert_eq!((rows.len(), reply["accuracy"]["solver"].as_str()), (8, Some("springs")));
    let expected = [(0.04939, 0.03595), (0.1677, 0.0366), (0.6836, 0.1780), (0.5774, 0.5060)];
    for ((row, frequency), (all, friction)) in rows.iter().step_by(2).zip(turned).zip(expected) {
        let unit = 0.5 * number(&row["normal_force"]) * number(&row["gross_slip_displacement"]);
        let [lost, viscous] = ["dissipated_energy", "viscous_work"].map(|name| number(&row[name]));
        assert!((lost / unit - friction).abs() < 5e-4 && ((lost + viscous) / unit - all).abs() < 5e-4, "{row}");
        let stored = number(&row["max_elastic_energy"]);
        let factor = (lost + viscous) / (std::f64::consts::TAU * stored);
        assert!((number(&row["loss_factor"]) / factor - 1.0).abs() < 1e-12, "{row}");
        assert_eq!((number(&row["frequency"]), number(&row["displacement_amplitude"])), (frequency, amplitude));
    }
    let relaxed = number(&reply["contact"]["normal_force"]) / 3.0;
    assert!((number(&rows[0]["normal_force"]) / relaxed - 1.0).abs() < 1e-12, "{}", rows[0]);
    // A force that is held presses deeper in the long run, and is the same at last.
    let held = changed(contact.clone(), &json!({"preload": {"normal_force": 10.0}}));
    let one = json!({"drive": {"displacement": amplitude}, "frequency": 1.0});
    assert_eq!(good(post("/cycle", &of(&held, &one)))["cycles"][0]["normal_force"], 10.0);
    for (body, title) in [(&one, "Steady cycle of"), (&body, "Steady cycles of bodies with memory")] {
        assert!(written("/cycle", Format::Svg, None, &of(&contact, body)).contains(title));
    }
    let table = written("/cycle", Format::Csv, None, &of(&contact, &body));
    assert!(table.starts_with("frequency,normal_force,gross_slip_displacement,displacement_amplitude"), "{table}");
    assert!(table.lines().next().unwrap().contains("dissipated_energy,viscous_work,"), "{table}");
    // Bodies as they stand still.
    let still = json!({"drive": {"displacement": 0.0}, "frequency": 1.0});
    let row = &good(post("/cycle", &of(&contact, &still)))["cycles"][0];
    assert_eq!((number(&row["viscous_work"]), row["regime"].as_str()), (0.0, Some("stick")), "{row}");
}

#[test]
fn a_frequency_goes_with_memory_and_with_nothing_that_it_lacks() {
    let asked = |rest: Value| changed(json!({"drive": {"displacement": 1e-5}, "frequency": 1.0}), &rest);
    let refused = |contact: &Value, rest: Value, place: &str, text: &str| {
        assert_refused("/cycle", &of(contact, &rest), ("invalid_input", place, text));
    };
    refused(&ball(), asked(json!({})), "/frequency", "prony");
    refused(&rubber(), json!({"drive": {"displacement": 1e-5}}), "/frequency", "depend");
    refused(&rubber(), asked(json!({"frequency": 0.0})), "/frequency", "out of range");
    refused(&rubber(), asked(json!({"frequency": [1.0, -2.0]})), "/frequency/1", "out of range");
    refused(&rubber(), asked(json!({"frequency": []})), "/frequency", "1000");
    refused(&rubber(), asked(json!({"drive": {"force": 1e-3}})), "/drive/force", "memory");
    for (name, value) in [
        ("machine", json!({"stiffness": 1e4})),
        ("work_density", json!({"points": 5})),
        ("normal", json!({"indentation": 1e-6})),
        ("frequency_response", json!({"mass": 0.1, "drive_force": 0.5})),
        ("best_load", json!({})),
        ("map", json!({"normal_force": {"from": 1.0, "to": 2.0, "count": 2}})),
    ] {
        refused(&rubber(), asked(json!({name: value})), &format!("/{name}"), "memory");
    }
    let fluid = changed(rubber(), &json!({"prony": [{"ratio": 1.0, "time": 1.0}]}));
    refused(&fluid, asked(json!({})), "/contact/prony", "flows");
    let many = json!({"drive": {"displacement": vec![1e-5; 1000]}, "frequency": vec![1.0; 101]});
    refused(&rubber(), many, "/frequency", "100000");
}
