//! Contacts that are twisted: what a reply says of them, and what is refused. Their values are tested in
//! `crates/mechanics/tests/physics/twist.rs`.

use serde_json::{Value, json};

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
    assert_eq!((&first["displacement"], &first["force"]), (&json!(0.0), &json!(0.0)));
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
        (json!([{"twist": 0.1}, {"normal_force": 0.5}]), ("load_must_be_constant", "/path/moves/1", "constant")),
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
}
