//! Contacts that are twisted: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/twist.rs`.

use serde_json::{Value, json};
use stickslip_compute::Flag;
use stickslip_compute::computations::{CheckedTask, DisplayOptions, entries};
use stickslip_compute::formats::Format;
use stickslip_wire::PrepareAnew;

use crate::json::{ball, changed, cylinder, known_by_load_curves, number, of};
use crate::{assert_refused, good, post, problem};

/// A ball of the closed form: mu = p0 = a = G = 1, so that E* = pi/2 and F_N = 2 pi/3.
fn unit_ball() -> Value {
    let moduli = json!({"e_star": std::f64::consts::FRAC_PI_2, "g_star": 1.0, "shear_modulus": 1.0});
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": moduli},
        "friction": 1.0,
        "preload": {"contact_radius": 1.0}
    })
}

#[test]
fn a_simulation_has_the_torque_of_the_closed_form() {
    let path = json!({"twist": [0.472_729_809_965_6, -0.1, 8.0]});
    let asked = json!({"path": path, "stress": {"radii": [0.0, 0.4, 0.9], "fields": ["pressure", "shear", "hoop"]}});
    let reply = good(post("/simulate", &of(&unit_ball(), &asked)));
    let limit = 0.125 * std::f64::consts::PI * std::f64::consts::PI;
    assert!((number(&reply["contact"]["gross_slip_torque"]) - limit).abs() < 1e-12, "{}", reply["contact"]);
    let first = &reply["steps"][0];
    assert!((number(&first["torque"]) / limit - 0.897_338_429_005_2).abs() < 1e-11, "{first}");
    assert!((number(&first["stick_radius"]) - 0.5).abs() < 1e-11 && first["regime"] == "partial_slip");
    assert_eq!((first.get("displacement"), first.get("force")), (None, None));
    for index in 1..3 {
        let of = |field: &str| number(&reply["stress"][field][index]);
        assert!((of("hoop") - of("pressure")).abs() < 1e-7 && of("shear") == 0.0, "{index}");
    }
    assert!(number(&reply["accuracy"]["force_error"]) < 1e-11);
    // Of unlike bodies too, without the warnings of tangential motion.
    let warned = |path: Value| good(post("/simulate", &of(&ball(), &json!({"path": path}))))["warnings"].to_string();
    assert!(warned(json!({"displacement": [1e-8]})).contains("dundurs_beta"));
    let twisted = warned(json!({"twist": [1e-3]}));
    assert!(!twisted.contains("dundurs_beta") && !twisted.contains("slip_direction"), "{twisted}");
    // By moves with a load before, and by torque, the same.
    let more = json!({"torque": 0.1, "relative": true});
    let moves = json!([{"normal_force": 2.0}, {"indentation": 1.0}, {"twist": 0.4}, {"torque": 0.1}, more]);
    let reply = good(post("/simulate", &of(&unit_ball(), &json!({"path": {"moves": moves}}))));
    assert!(reply["steps"][1].get("twist").is_none() && (number(&reply["steps"][4]["torque"]) - 0.2).abs() < 1e-12);
}

#[test]
fn angle_and_torque_stand_in_place_of_displacement_and_force() {
    let moves = json!([{"displacement": 0.0}, {"twist": 0.2}, {"torque": 0.1}, {"indentation": -0.1},
        {"indentation": 0.5, "displacement": 0.1}]);
    let body = of(&unit_ball(), &json!({"path": {"moves": moves}}));
    let states = good(post("/simulate", &body))["steps"].clone();
    for (index, twisted) in [false, true, true, false, false].into_iter().enumerate() {
        for (name, expected) in
            [("displacement", !twisted), ("force", !twisted), ("twist", twisted), ("torque", twisted)]
        {
            assert_eq!(states[index].get(name).is_some(), expected, "{index} {name}: {states}");
        }
    }
    // The table has all four, and null where they do not apply.
    let options = DisplayOptions::in_format(Format::Csv);
    let entry = entries().into_iter().find(|entry| entry.about.name == "simulate").unwrap();
    let document = (entry.request.parse)(body.to_string().as_bytes()).unwrap();
    let task = document.check(&PrepareAnew).unwrap().downcast::<Box<dyn CheckedTask>>().unwrap_or_else(|_| panic!());
    let table = task.run(&Flag::default()).unwrap().write(&options, &Flag::default()).unwrap().ok().unwrap();
    let table = String::from_utf8(table).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    for name in ["displacement", "force", "twist", "torque"] {
        let column = rows[0].iter().position(|known| *known == name).unwrap();
        for (row, state) in rows[1..].iter().zip(states.as_array().unwrap()) {
            match state.get(name) {
                Some(value) => assert!((row[column].parse::<f64>().unwrap() - number(value)).abs() <= 0.0, "{name}"),
                None => assert_eq!(row[column], "", "{name}"),
            }
        }
    }
}

#[test]
fn what_a_twist_does_not_allow_is_refused_at_its_place() {
    let path = json!({"path": {"twist": [0.1]}});
    let place = "/path/twist/0";
    let with = |members: Value| changed(unit_ball(), &members);
    let mut plain = unit_ball();
    plain["material"] = json!({"effective": {"e_star": 1.0, "g_star": 0.8}});
    assert_refused("/simulate", &of(&plain, &path), ("invalid_input", place, "shear_modulus"));
    for (members, said) in [
        (json!({"shear_strength": 0.1}), "not available with a shear strength"),
        (json!({"friction": 0.0}), "carries no torque"),
        (json!({"friction": 0.0, "adhesion": {"work": 0.01}}), "not available with adhesion"),
    ] {
        assert_refused("/simulate", &of(&with(members), &path), ("invalid_input", place, said));
    }
    assert_refused("/simulate", &of(&cylinder(), &path), ("invalid_input", place, "line contact"));
    for (profile, _) in known_by_load_curves() {
        let contact = changed(ball(), &json!({"profile": profile}));
        assert_refused("/simulate", &of(&contact, &path), ("no_stress_field", place, "load curve"));
    }
    let moves = |moves: Value| of(&unit_ball(), &json!({"path": {"moves": moves}}));
    for (path, refused) in [
        (json!([{"displacement": 0.1}, {"twist": 0.1}]), ("twist_with_shift", "/path/moves/1", "together")),
        (json!([{"twist": 0.1}, {"displacement": 0.1}]), ("twist_with_shift", "/path/moves/1", "together")),
        (json!([{"twist": 0.1, "displacement": 0.1}]), ("twist_with_shift", "/path/moves/0/displacement", "together")),
        (
            json!([{"twist": 0.1}, {"displacement": [0.1, 0.1]}]),
            ("twist_with_shift", "/path/moves/1/displacement", "together"),
        ),
        (json!([{"twist": 0.1, "torque": 0.1}]), ("invalid_input", "/path/moves/0/torque", "conflicts")),
        (json!([{"twist": 2e6}]), ("invalid_input", "/path/moves/0/twist", "allowed")),
    ] {
        assert_refused("/simulate", &moves(path), refused);
    }
    let too_much = problem(post("/simulate", &moves(json!([{"torque": 2.0}]))));
    assert_eq!(too_much.code, "force_exceeds_friction", "{too_much:?}");
    assert!(too_much.errors[0].exclusive_maximum.is_some_and(|limit| limit > 1.2), "{too_much:?}");
    for (rest, place) in [
        (json!({"solver": {"springs": {"count": 100}}}), "/path/twist/0"),
        (json!({"residual": true}), "/residual"),
        (json!({"stress": {"points": 5, "fields": ["slip"]}}), "/stress/fields"),
    ] {
        let body = of(&unit_ball(), &changed(path.clone(), &rest));
        assert_refused("/simulate", &body, ("invalid_input", place, "twisted"));
    }
    let hoop = json!({"path": {"displacement": [0.1]}, "stress": {"points": 5, "fields": ["hoop"]}});
    assert_refused("/simulate", &of(&unit_ball(), &hoop), ("invalid_input", "/stress/fields", "twisted"));
    let rings = changed(path.clone(), &json!({"solver": {"rings": {"count": 20}}}));
    assert_refused("/simulate", &of(&unit_ball(), &rings), ("invalid_input", "/solver", "twist"));
    assert_refused("/accuracy", &of(&unit_ball(), &path), ("invalid_input", "/path", "twist"));
    let rated = changed(path.clone(), &json!({"points": [[0.0, 0.0, 0.1]], "criteria": {"crossland": {"alpha": 0.3}}}));
    let ball = of(&ball(), &changed(rated, &json!({"body": "first"})));
    assert_refused("/fretting", &ball, ("invalid_input", "/path", "twist"));
}

#[test]
fn a_steady_cycle_by_angle_or_torque_has_the_work_of_the_closed_form() {
    let limit = 0.125 * std::f64::consts::PI * std::f64::consts::PI;
    let (angle, torque, work) = (0.472_729_809_965_6, 0.897_338_429_005_2 * limit, 0.667_564_296_946_5);
    let near = |found: &Value, expected: f64, tolerance: f64| {
        assert!((number(found) - expected).abs() < tolerance * expected, "{found} in place of {expected}");
    };
    for (drive, at) in [(json!({"twist": [angle, 0.1]}), angle), (json!({"torque": [torque, 0.1]}), torque)] {
        let reply = good(post("/cycle", &of(&unit_ball(), &json!({"drive": drive, "harmonics": 1}))));
        let cycle = &reply["cycles"][0];
        near(&cycle["twist_amplitude"], angle, 1e-8);
        near(&cycle["torque_amplitude"], torque, 1e-10);
        near(&cycle["dissipated_energy"], work, 1e-8);
        near(&cycle["tangent_stiffness"], 16.0 / 3.0, 1e-8);
        near(&cycle["secant_stiffness"], torque / angle, 1e-8);
        near(&cycle["stick_radius"], 0.5, 1e-8);
        // D = pi times the amplitude of the drive times the quadrature of the answer.
        let quadrature = number(&cycle["harmonics"][0]["quadrature"]).abs();
        assert!((std::f64::consts::PI * at * quadrature / work - 1.0).abs() < 1e-6, "{cycle}");
        assert_eq!((cycle.get("displacement_amplitude"), cycle.get("force_amplitude")), (None, None));
        near(&reply["contact"]["gross_slip_torque"], limit, 1e-10);
        assert!(!reply["warnings"].to_string().contains("dundurs_beta"));
    }
    // A machine in series takes its part of the angle.
    let machine = json!({"drive": {"twist": angle + torque / 2.0}, "machine": {"stiffness": 2.0}});
    let reply = good(post("/cycle", &of(&unit_ball(), &machine)));
    near(&reply["cycles"][0]["twist_amplitude"], angle, 1e-8);
    near(&reply["cycles"][0]["machine_amplitude"], angle + torque / 2.0, 1e-10);
    let much = json!({"drive": {"torque": 1.01 * limit}});
    assert_refused("/cycle", &of(&unit_ball(), &much), ("force_exceeds_friction", "/drive/torque", "torque"));
    for (member, value) in [
        ("normal", json!({"indentation": 0.1})),
        ("work_density", json!({"points": 5})),
        ("best_load", json!({})),
        ("frequency_response", json!({"mass": 1.0, "drive_force": 0.1})),
        ("map", json!({"normal_force": {"from": 1.0, "to": 2.0, "count": 2}})),
    ] {
        let body = json!({"drive": {"twist": 0.1}, member: value});
        assert_refused("/cycle", &of(&unit_ball(), &body), ("invalid_input", &format!("/{member}"), "twist"));
    }
    let round = json!({"drive": {"twist": 0.1}});
    assert_refused("/cycle", &of(&cylinder(), &round), ("invalid_input", "/drive/twist", "line contact"));
}

#[test]
fn a_steady_cycle_with_a_shear_strength_has_the_work_of_the_closed_form() {
    // tau_0 = a = G* = 1, c = 0.6.
    let strong = changed(unit_ball(), &json!({"friction": 0.0, "shear_strength": 1.0}));
    let reply = good(post("/cycle", &of(&strong, &json!({"drive": {"displacement": 1.6}}))));
    let cycle = &reply["cycles"][0];
    assert!((number(&cycle["force_amplitude"]) / std::f64::consts::PI - 0.895_911_961_338).abs() < 1e-10, "{cycle}");
    assert!((number(&cycle["dissipated_energy"]) - 1.288_045_457_087).abs() < 1e-9, "{cycle}");
    assert!((number(&cycle["stick_radius"]) - 0.6).abs() < 1e-10, "{cycle}");
    let study = json!({"drive": {"displacement": 1.6}, "work_density": {"points": 5}});
    let refused = ("invalid_input", "/contact/shear_strength", "not available with a shear strength");
    assert_refused("/cycle", &of(&strong, &study), refused);
}

#[test]
fn a_sweep_has_angles_and_torques_where_the_contact_is_twisted() {
    let path = json!({"path": {"moves": [{"displacement": 0.0}, {"twist": 0.2}, {"torque": 0.1}]}});
    let sweep = |output: &str| {
        let axes = json!([{"pointer": "/path/moves/2/torque", "values": [0.1, 0.2]}]);
        json!({"base": of(&unit_ball(), &path), "axes": axes, "outputs": [output]})
    };
    let reply = good(post("/sweep", &sweep("/steps/2/torque")));
    assert_eq!(reply["points"], 2, "{reply}");
    good(post("/sweep", &sweep("/steps/0/force")));
    for output in ["/steps/2/force", "/steps/0/torque"] {
        assert_refused("/sweep", &sweep(output), ("invalid_input", "/outputs/0", "no such member"));
    }
}

#[test]
fn the_error_of_the_friction_work_is_stated_of_curves_and_not_of_springs() {
    let of_path = |moves: Value| good(post("/simulate", &of(&unit_ball(), &json!({"path": {"moves": moves}}))));
    let pressed = of_path(json!([{"displacement": 0.3, "normal_force": 2.5}, {"displacement": -0.3}]));
    assert!((1e-16..1e-8).contains(&number(&pressed["accuracy"]["work_error"])), "{}", pressed["accuracy"]);
    let twisted = of_path(json!([{"twist": 0.3, "normal_force": 2.5}, {"twist": -0.3}]));
    assert_eq!(
        (twisted["accuracy"]["solver"].as_str(), twisted["accuracy"].get("work_error")),
        (Some("springs"), None)
    );
    let straight = of_path(json!([{"displacement": 0.3}, {"normal_force": 2.5}]));
    assert_eq!(straight["accuracy"].get("work_error"), None);
}

/// The number of springs is not chosen by the tolerance: an error beyond one that the request names is said.
#[test]
fn springs_that_do_not_meet_the_tolerance_of_the_request_say_so() {
    let path =
        json!({"moves": [{"twist": 0.4}, {"twist": -0.2, "indentation": 0.8}, {"twist": 0.3, "indentation": 1.0}]});
    let warned = |asked: Value| {
        let reply = good(post("/simulate", &changed(of(&unit_ball(), &json!({"path": path})), &asked)));
        let error = number(&reply["accuracy"]["force_error"]);
        let message = reply["warnings"].as_array().unwrap().iter().find(|one| one["code"] == "tolerance_not_met");
        (error, message.map(|one| one["message"].as_str().unwrap().to_owned()))
    };
    let (error, plain) = warned(json!({}));
    assert!(error > 1e-8 && plain.is_none(), "{error:e} {plain:?}");
    assert_eq!(warned(json!({"tolerance": 2.0 * error})).1, None);
    let (_, told) = warned(json!({"tolerance": 0.5 * error}));
    assert!(told.is_some_and(|message| message.starts_with("the torque may be off by")));
    // At a constant load no springs step, and nothing is left out.
    let still = json!({"path": {"twist": [0.4, -0.2]}, "tolerance": 1e-14});
    assert!(!good(post("/simulate", &of(&unit_ball(), &still)))["warnings"].to_string().contains("tolerance_not_met"));
}
