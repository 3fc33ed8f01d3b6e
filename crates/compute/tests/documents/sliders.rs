//! Sliders and rolling as documents: what `crates/mechanics` does not see of them.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::json::{ball, changed, cylinder, cylinder_with_bulk, number, of, with};
use crate::{assert_refused, good, post, written};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

#[test]
fn sliders_carry_the_limit_of_friction_and_state_their_work() {
    let reply = good(post("/sliders", &of(&ball(), &json!({"force_error": 0.01}))));
    let [knots, stiffness, force] = ["displacement", "stiffness", "slip_force"].map(|name| numbers(&reply[name]));
    assert!(number(&reply["force_error"]) <= 0.01 && knots.len() == 5);
    assert!((force.iter().sum::<f64>() - 3.0).abs() < 1e-13);
    for ((knot, stiffness), force) in knots.iter().zip(&stiffness).zip(&force) {
        assert!((stiffness * knot / force - 1.0).abs() < 1e-14);
    }
    let gross_slip = number(&reply["contact"]["gross_slip_displacement"]);
    assert!((knots[4] / gross_slip - 1.0).abs() < 1e-14);
    // The work of a cycle by the polygon, over that of `/cycle`.
    let (amplitudes, ratios) = (numbers(&reply["work"]["amplitude"]), numbers(&reply["work"]["ratio"]));
    let cycles = good(post("/cycle", &of(&ball(), &json!({"drive": {"displacement": amplitudes}}))));
    for ((amplitude, ratio), cycle) in amplitudes.iter().zip(ratios).zip(cycles["cycles"].as_array().unwrap()) {
        let slipping = knots.iter().zip(&force).filter(|(knot, _)| *knot < amplitude);
        let work: f64 = slipping.map(|(knot, force)| 4.0 * force * (amplitude - knot)).sum();
        assert!((work / number(&cycle["dissipated_energy"]) - ratio).abs() < 1e-9, "{amplitude:e}");
    }
    // The density integrates to the stiffness at rest, 2 G* a.
    let density: f64 = numbers(&reply["density"]["density"]).iter().sum::<f64>() * gross_slip / 100.0;
    assert!((density / stiffness.iter().sum::<f64>() - 1.0).abs() < 0.2);
    let csv = written("/sliders", Format::Csv, None, &of(&ball(), &json!({"count": 7})));
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some("displacement,stiffness,slip_force"), 8));
}

#[test]
fn what_has_no_sliders_is_refused_at_its_place() {
    let asked = json!({"count": 5});
    let smooth = with(ball(), "/friction", json!(0.0));
    let free = with(ball(), "/preload", json!({"normal_force": 0.0}));
    let work = |rest: Value| changed(json!({"work_error": 0.1}), &rest);
    for (contact, rest, pointer, words) in [
        (ball(), json!({}), "", "one of"),
        (ball(), json!({"count": 5, "force_error": 0.1}), "", "one of"),
        (ball(), json!({"count": 0}), "/count", "1 to 1000"),
        (ball(), json!({"force_error": 1e-9}), "/force_error", "2e-7"),
        (ball(), json!({"count": 5, "smallest_amplitude": 1e-9}), "/smallest_amplitude", "work_error"),
        (ball(), work(json!({})), "/smallest_amplitude", "needs"),
        (ball(), work(json!({"smallest_amplitude": 1.0})), "/smallest_amplitude", "excluded"),
        (ball(), work(json!({"smallest_amplitude": 0.0})), "/smallest_amplitude", "excluded"),
        (smooth, asked.clone(), "/contact", "nothing slides"),
        (free, asked.clone(), "/contact", "nothing slides"),
        (cylinder_with_bulk(), asked, "/contact/bulk", "bulk"),
    ] {
        assert_refused("/sliders", &of(&contact, &rest), ("invalid_input", pointer, words));
    }
}

#[test]
fn a_cylinder_rolls_by_carter_and_nothing_else_does() {
    let reply = good(post("/rolling", &of(&cylinder(), &json!({"ratio": 0.5, "points": 3}))));
    let a = number(&reply["contact"]["contact_radius"]);
    assert!((number(&reply["creep"]) / (0.6 * a / 0.05) - 0.292_893_218_813).abs() < 1e-12);
    assert_eq!(numbers(&reply["x"]), [-a, 0.0, a]);
    let back = good(post("/rolling", &of(&cylinder(), &json!({"creep": reply["creep"]}))));
    assert!((number(&back["ratio"]) - 0.5).abs() < 1e-14);
    for (contact, rest, pointer, words) in [
        (ball(), json!({"ratio": 0.5}), "/contact/profile", "cylinder"),
        (cylinder(), json!({}), "", "one of"),
        (cylinder(), json!({"ratio": 1.0}), "/ratio", "between -1 and 1"),
        (cylinder(), json!({"ratio": -1.5}), "/ratio", "between"),
        (cylinder(), json!({"creep": 0.1}), "/creep", "between"),
        (cylinder_with_bulk(), json!({"ratio": 0.5}), "/contact/bulk", "bulk"),
        (with(cylinder(), "/friction", json!(0.0)), json!({"ratio": 0.5}), "/contact", "nothing slides"),
    ] {
        assert_refused("/rolling", &of(&contact, &rest), ("invalid_input", pointer, words));
    }
}
