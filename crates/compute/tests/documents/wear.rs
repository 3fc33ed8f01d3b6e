//! What fretting wear leaves: closed forms, what is infinite, the profile that other calls take, and what
//! has no limit.

use serde_json::{Value, json};

use crate::json::{ball, changed, codes, number, of};
use crate::{assert_refused, good, post};

/// R = d = m = 1.
fn unit_ball() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0},
        "material": {"effective": {"e_star": 1e11, "g_star": 1e11}},
        "friction": 1.0,
        "preload": {"indentation": 1.0}
    })
}

fn asked(displacement: f64) -> Value {
    json!({"drive": {"displacement": displacement}, "hold": "indentation"})
}

fn close(found: &Value, expected: f64, tolerance: f64) {
    let found = number(found);
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} is not {expected:e}");
}

#[test]
fn a_ball_wears_to_the_closed_form_and_the_profile_carries_on() {
    let reply = good(post("/wear", &of(&unit_ball(), &asked(0.36))));
    close(&reply["stick_radius"], 0.8, 1e-14);
    close(&reply["worn_radius"], 1.096_897_388_221, 1e-11);
    close(&reply["indentation"], 1.0, 1e-15);
    close(&reply["normal_force"]["before"], 4e11 / 3.0, 1e-14);
    close(&reply["normal_force"]["after"], 1.258_666_666_667e11, 1e-11);
    close(&reply["force_amplitude"], 2e11 * 0.8 * 0.36, 1e-14);
    close(&reply["removed_volume"], 0.090_048_319_215_8, 1e-11);
    let (shape, pressure) = (&reply["shape"], &reply["pressure"]);
    let radii: Vec<f64> = shape["radius"].as_array().unwrap().iter().map(number).collect();
    assert_eq!((radii.len(), &shape["radius"]), (203, &pressure["radius"]));
    assert!(radii.windows(2).all(|pair| pair[0] < pair[1]) && radii[202] > 1.3, "{radii:?}");
    for (index, &r) in radii.iter().enumerate() {
        assert!((number(&shape["before"][index]) - 0.5 * r * r).abs() < 1e-14);
        let removed = number(&shape["after"][index]) - number(&shape["before"][index]);
        assert_eq!(removed > 1e-12, r > 0.8 + 1e-12 && r < 1.096_897, "{r}: {removed:e}");
        assert!(removed <= number(&reply["depth"]["largest"]) * (1.0 + 1e-12));
        let after = &pressure["after"][index];
        // Infinite at the stick radius, nothing beyond.
        assert_eq!(after.is_null(), (r - 0.8).abs() < 1e-14, "{r}: {after}");
        assert!(r <= 0.8 || after.is_null() || number(after) <= 0.0, "{r}: {after}");
    }
    // The same cycle on what is left slips in the rise of g alone, and the force is that of the limit to the stated
    // error.
    let error = number(&reply["profile_error"]["normal_force"]);
    assert!(error < 1e-3, "{error:e}");
    let worn = changed(unit_ball(), &json!({"profile": reply["profile"]}));
    let cycle = json!({"drive": {"displacement": 0.36}});
    let next = good(post("/cycle", &of(&worn, &cycle)));
    close(&next["contact"]["normal_force"], 1.258_666_666_667e11, 1.01 * error + 1e-11);
    close(&next["cycles"][0]["force_amplitude"], 2e11 * 0.8 * 0.36, 2e-3);
    let unworn = good(post("/cycle", &of(&unit_ball(), &cycle)));
    let work = |reply: &Value| number(&reply["cycles"][0]["dissipated_energy"]);
    assert!(work(&next) < 0.1 * work(&unworn), "{} {}", work(&next), work(&unworn));
    // A heavier contact takes it, too.
    let heavier = json!({"preload": {"indentation": 1.2}});
    good(post("/cycle", &of(&changed(worn, &heavier), &cycle)));
}

#[test]
fn a_table_whose_force_is_far_from_that_of_the_limit_comes_with_a_warning() {
    let mut warned = 0;
    for part in [0.1, 0.5, 0.9, 0.99, 0.999, 0.99999, 1.0 - 1e-7, 1.0 - 1e-9] {
        let reply = good(post("/wear", &of(&unit_ball(), &asked(part))));
        if reply["profile"].is_null() {
            continue;
        }
        let error = number(&reply["profile_error"]["normal_force"]);
        let worn = changed(unit_ball(), &json!({"profile": reply["profile"]}));
        let found = good(post("/simulate", &of(&worn, &json!({"path": {"displacement": [0.0]}}))));
        let force = number(&found["contact"]["normal_force"]) / number(&reply["normal_force"]["after"]);
        assert!(((force - 1.0).abs() - error).abs() <= 1e-2 * error + 1e-9, "{part}: {force} {error:e}");
        assert_eq!(codes(&reply).contains(&"worn_profile_error"), error > 1e-2, "{part}: {error:e}");
        warned += usize::from(error > 1e-2);
    }
    assert!(warned > 0, "no error is large");
    let line = json!({"profile": {"type": "cylinder", "radius": 0.01, "length": 0.01}});
    assert_refused("/wear", &of(&changed(ball(), &line), &asked(1e-8)), ("invalid_input", "/contact/profile", "line"));
}

#[test]
fn a_vertical_edge_has_a_limit_but_no_table_and_a_stuck_punch_keeps_its_profile() {
    let edge = json!({"type": "flat_punch", "radius": 1.2e-4});
    let edged = json!({"type": "sum", "parts": [{"type": "sphere", "radius": 0.01}, edge]});
    let contact =
        |profile: Value, depth: f64| changed(ball(), &json!({"profile": profile, "preload": {"indentation": depth}}));
    let reply = good(post("/wear", &of(&contact(edged, 1e-6), &asked(2e-7))));
    assert_eq!((&reply["profile"], &reply["profile_error"]), (&Value::Null, &Value::Null));
    assert!(codes(&reply).contains(&"no_worn_profile"), "{reply}");
    assert!(number(&reply["removed_volume"]) > 0.0);
    let reply = good(post("/wear", &of(&contact(edge.clone(), 1e-6), &asked(1e-7))));
    assert_eq!((&reply["profile"], &reply["removed_volume"]), (&edge, &json!(0.0)));
    assert!(!codes(&reply).contains(&"no_worn_profile"), "{reply}");
    assert_eq!(reply["stick_radius"], reply["worn_radius"]);
    // The edge is singular before and after.
    let (before, after) = (&reply["pressure"]["before"], &reply["pressure"]["after"]);
    assert!(
        before.as_array().unwrap().last().unwrap().is_null() && after.as_array().unwrap().last().unwrap().is_null()
    );
}

#[test]
fn what_has_no_limit_is_refused_at_its_place() {
    let refuse = |contact: &Value, asked, expected| assert_refused("/wear", &of(contact, &asked), expected);
    let held = json!({"drive": {"displacement": 1e-7}, "hold": "normal_force"});
    refuse(&ball(), held, ("invalid_input", "/hold", "depends on the course"));
    for amplitude in [1.0, 2.0] {
        refuse(&unit_ball(), asked(amplitude), ("invalid_input", "/drive/displacement", "gross slip, 1 m"));
    }
    refuse(&ball(), asked(-1e-7), ("invalid_input", "/drive/displacement", ""));
    let frictionless = changed(ball(), &json!({"friction": 0.0}));
    refuse(&frictionless, asked(1e-8), ("invalid_input", "/drive/displacement", "gross slip, 0 m"));
    let (drive, few) = (json!({"force": 1.0}), json!({"points": 1}));
    refuse(&ball(), changed(asked(1e-8), &json!({"drive": drive})), ("invalid_input", "/drive/force", ""));
    refuse(&ball(), changed(asked(1e-8), &few), ("invalid_input", "/points", ""));
    let radii: Vec<f64> = (0..=20).map(|index| 5.05e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02).collect();
    let short = json!({"profile": {"type": "tabulated", "r": radii, "z": heights}, "preload": {"indentation": 1e-6}});
    let named = ("beyond_profile", "/contact/profile", "give the surface further out");
    refuse(&changed(ball(), &short), asked(1e-7), named);
}
