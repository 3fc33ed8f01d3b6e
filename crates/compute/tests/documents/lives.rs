//! Lives and critical distances of the computation of fretting: values against the same criterion asked for at the
//! depth, lives put into the printed formulas, every fault with its place. The mechanics is tested in
//! `crates/mechanics/tests/physics/{critical_distance,lives}.rs`.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, codes, number, of, with};
use crate::{assert_refused, good, post, written};

const STEEL: f64 = 2.1e11;
const SHEAR: f64 = STEEL / 2.6;
const LENGTH: f64 = 1e-5;

/// The ball moved back and forth in partial slip, searched for the worst places.
fn asked(changes: Value) -> Value {
    let body = json!({"path": {"displacement": [1e-7, -1e-7]}, "body": "first", "tolerance": 1e-3});
    of(&ball(), &changed(body, &changes))
}

fn strain_life(strength: f64, strength_exponent: f64, ductility: f64, ductility_exponent: f64) -> Value {
    json!({"strain_life": {"strength": strength, "strength_exponent": strength_exponent,
        "ductility": ductility, "ductility_exponent": ductility_exponent}})
}

fn s_n(reference: f64) -> Value {
    json!({"s_n": {"reference": reference, "cycles": 1e6, "exponent": 8.0}})
}

fn rated(body: &Value) -> Value {
    good(post("/fretting", body))
}

#[test]
fn lives_and_critical_distances_follow_from_the_values_by_the_printed_formulas() {
    let criteria = json!({
        "crossland": {"alpha": 0.3, "limit": 3e8, "life": s_n(2e8)},
        "swt": {"life": strain_life(9.5e8, -0.09, 0.26, -0.6)},
        "fatemi_socie": {"k": 0.5, "yield": 4e8, "life": strain_life(5.5e8, -0.1, 0.4, -0.55)}
    });
    let distance = json!({"length": LENGTH, "method": "point"});
    let reply = rated(&asked(json!({"criteria": criteria, "critical_distance": distance})));
    assert!(codes(&reply).contains(&"life_scatter"), "{reply}");
    assert!(include_str!("../../../../docs/warnings.md").contains("\n## life_scatter\n"));
    let swt = |n: f64| 9.5e8 * 9.5e8 / STEEL * (2.0 * n).powf(-0.18) + 9.5e8 * 0.26 * (2.0 * n).powf(-0.69);
    let fatemi_socie = |n: f64| 5.5e8 / SHEAR * (2.0 * n).powf(-0.1) + 0.4 * (2.0 * n).powf(-0.55);
    let crossland = |n: f64| 2e8 * (n / 1e6).powf(-1.0 / 8.0);
    let curves: [(&str, &dyn Fn(f64) -> f64); 3] =
        [("crossland", &crossland), ("swt", &swt), ("fatemi_socie", &fatemi_socie)];
    for (index, (name, of_cycles)) in curves.into_iter().enumerate() {
        let below = &reply[name]["critical_distance"];
        for (rated, life) in [(&reply[name]["largest"], &reply[name]["life"]), (below, &below["life"])] {
            let (value, error) = (number(&rated["value"]), number(&rated["error"]));
            for (of, value) in [("cycles", value), ("shortest", value + error), ("longest", value - error)] {
                let again = of_cycles(number(&life[of]));
                assert!((again / value - 1.0).abs() < 1e-9, "{name} {of}: {again:e} {rated} {life}");
            }
            assert!(life["no_life"].is_null(), "{life}");
        }
        assert_eq!(reply[name]["cycles"][index], reply[name]["life"]["cycles"], "{name}");
        // The same criterion at half the distance below that place of the surface.
        assert_eq!(below["point"], reply[name]["largest"]["point"], "{name}");
        let [x, y, z] = [0, 1, 2].map(|axis| number(&below["point"][axis]));
        assert!(z == 0.0, "{name}");
        let mut alone = criteria[name].clone();
        alone.as_object_mut().unwrap().remove("life");
        let points = json!([[x, y, 0.5 * LENGTH]]);
        let there = rated(&asked(json!({"criteria": {name: alone}, "points": points})));
        let [one, other] = [below, &there[name]["largest"]].map(|rated| number(&rated["value"]));
        let error = number(&below["error"]) + number(&there[name]["largest"]["error"]);
        assert!((one - other).abs() <= error && one < number(&reply[name]["largest"]["value"]), "{name}: {below}");
    }
    let margin = number(&reply["crossland"]["critical_distance"]["margin"]);
    let value = number(&reply["crossland"]["critical_distance"]["value"]);
    assert!((margin - 3e8 / value).abs() < 1e-12 && reply["swt"]["critical_distance"].get("margin").is_none());

    // Places of one's own: from the worst of those on the surface. A line lies between the surface and the point.
    let points = json!([[6e-5, 0.0, 0.0], [7e-5, 0.0, 0.0], [0.0, 0.0, 0.0], [7e-5, 0.0, 1e-6]]);
    let crossland = json!({"crossland": {"alpha": 0.3, "life": s_n(2e8)}});
    let mut values = Vec::new();
    for method in ["point", "line"] {
        let distance = json!({"length": LENGTH, "method": method});
        let body = asked(json!({"criteria": crossland, "points": points, "critical_distance": distance}));
        let reply = rated(&body);
        let (all, below) = (&reply["crossland"]["values"], &reply["crossland"]["critical_distance"]);
        let worst = (0..3).max_by(|one, other| number(&all[*one]).total_cmp(&number(&all[*other]))).unwrap();
        assert_eq!(below["point"], points[worst], "{reply}");
        values.push((number(&below["value"]), number(&all[worst])));
        let table = written("/fretting", Format::Csv, None, &body);
        assert!(table.starts_with("x,y,z,crossland,crossland_cycles\n"), "{table}");
        let last = table.lines().nth(1 + worst).unwrap().rsplit(',').next().unwrap().parse::<f64>().unwrap();
        assert!((last / number(&reply["crossland"]["cycles"][worst]) - 1.0).abs() < 1e-12, "{table}");
    }
    let [(point, local), (line, _)] = values[..] else { panic!() };
    assert!(line < local && point < local && (line / point - 1.0).abs() > 1e-3, "{values:?}");
}

#[test]
fn a_value_without_a_life_says_why() {
    let life = strain_life(9.5e8, -0.09, 0.26, -0.6);
    let deep = json!([[0.0, 0.0, 1e-5]]);
    let pressed = json!({"criteria": {"swt": {"life": life}}, "points": deep, "bulk": {"mean": -1e9}});
    let reply = rated(&asked(pressed));
    let expected = json!({"cycles": null, "shortest": 1e12, "longest": null, "no_life": "not_positive"});
    assert_eq!((&reply["swt"]["life"], &reply["swt"]["cycles"]), (&expected, &json!([null])), "{reply}");
    let crossland = |reference: f64| json!({"criteria": {"crossland": {"alpha": 0.3, "life": s_n(reference)}}});
    for (reference, why, shortest, longest) in
        [(1e12, "too_long", json!(1e12), json!(null)), (1e6, "too_short", json!(0.0), json!(0.5))]
    {
        let reply = rated(&asked(crossland(reference)));
        let expected = json!({"cycles": null, "shortest": shortest, "longest": longest, "no_life": why});
        assert_eq!(reply["crossland"]["life"], expected);
    }
    // The tip of a cone: no value and no life in the body, both at a distance.
    let distance = json!({"critical_distance": {"length": LENGTH, "method": "line"}});
    let cone =
        with(asked(changed(crossland(2e8), &distance)), "/contact/profile", json!({"type": "cone", "slope": 0.01}));
    let reply = rated(&cone);
    let expected = json!({"cycles": null, "shortest": 0.0, "longest": null, "no_life": "infinite_stress"});
    assert_eq!(reply["crossland"]["life"], expected, "{reply}");
    let below = &reply["crossland"]["critical_distance"];
    // All is compressed under the tip: the edge of the contact is worse.
    let radius = number(&reply["contact"]["contact_radius"]);
    assert!((number(&below["point"][0]).abs() / radius - 1.0).abs() < 1e-2, "{below}");
    assert!(number(&below["value"]) > 0.0 && number(&below["life"]["cycles"]) > 0.0, "{below}");
}

#[test]
fn every_fault_is_named_with_its_place() {
    let distance = |length: f64, method: &str| json!({"length": length, "method": method});
    let crossland = |life: Value| json!({"criteria": {"crossland": {"alpha": 0.3, "life": life}}});
    let swt = |life: Value| json!({"criteria": {"swt": {"life": life}}});
    let usual = json!({"criteria": {"crossland": {"alpha": 0.3}}});
    let at = |given: Value| changed(usual.clone(), &json!({"critical_distance": given}));
    let deep = changed(at(distance(LENGTH, "point")), &json!({"points": [[0.0, 0.0, 1e-6]]}));
    let slip = json!({"criteria": {"ruiz": {}}, "critical_distance": distance(LENGTH, "line")});
    for (changes, pointer, detail) in [
        (at(distance(0.0, "point")), "/critical_distance/length", "allowed is 1e-9 to 1 m"),
        (at(distance(50.0, "point")), "/critical_distance/length", "allowed is 1e-9 to 1 m"),
        (at(distance(LENGTH, "area")), "/critical_distance/method", "`point`"),
        (at(json!({"length": LENGTH})), "/critical_distance/method", ""),
        (deep, "/critical_distance", "z = 0"),
        (slip, "/criteria/ruiz", "on the surface only"),
        (crossland(json!({})), "/criteria/crossland/life/s_n", "`s_n`"),
        (crossland(strain_life(9e8, -0.1, 0.3, -0.6)), "/criteria/crossland/life/strain_life", "`s_n`"),
        (crossland(s_n(0.0)), "/criteria/crossland/life/s_n/reference", "allowed is"),
        (swt(strain_life(9e8, 0.1, 0.3, -0.6)), "/criteria/swt/life/strain_life/strength_exponent", "-10 to -1e-3"),
        (swt(strain_life(9e8, -0.1, 0.3, 0.0)), "/criteria/swt/life/strain_life/ductility_exponent", "-10 to -1e-3"),
        (swt(strain_life(0.0, -0.1, 0.3, -0.6)), "/criteria/swt/life/strain_life/strength", "Pa"),
        (swt(strain_life(9e8, -0.1, -0.3, -0.6)), "/criteria/swt/life/strain_life/ductility", "0 to 1000"),
    ] {
        assert_refused("/fretting", &asked(changes), ("invalid_input", pointer, detail));
    }
}
