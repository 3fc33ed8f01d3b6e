//! Requests whose replies were once wrong without a word: they are right now, or a warning names the cause.
//!
//! Loops of a ball with friction 0.3 and G* of two steels, beside what their name says; scans of shapes whose contact
//! is known.

use serde_json::Value;

use crate::json::{codes, number};
use crate::{good, post};

const FRICTION: f64 = 0.3;
const G_STAR: f64 = 1.900_452_488_687_783e11;

macro_rules! reported {
    ($name:literal) => {
        serde_json::from_str::<Value>(include_str!(concat!("reported/", $name, ".json"))).unwrap()
    };
}

fn holds(estimate: &Value, truth: f64) -> bool {
    let end = |index: usize, open: f64| estimate["interval"][index].as_f64().unwrap_or(open);
    (end(0, f64::NEG_INFINITY)..=end(1, f64::INFINITY)).contains(&truth)
}

#[test]
fn a_loop_is_right_or_its_cause_is_named() {
    for (name, body, causes) in [
        ("untared", reported!("fit_untared"), &["omitted_parameter"][..]),
        ("late", reported!("fit_lag_1_C_free"), &["omitted_parameter"]),
        ("displacement in steps", reported!("fit_qx_5"), &["quantised"]),
        ("more noise than told", reported!("fit_told_noise_exceeded"), &["noise_exceeded"]),
        ("falls at once", reported!("fit_down_at_once"), &["not_coulomb"]),
        ("gaps", reported!("fit_skip_30"), &["turn_in_gap"]),
    ] {
        let reply = good(post("/fit", &body));
        let estimates = &reply["estimates"];
        let right = holds(&estimates["friction"], FRICTION) && holds(&estimates["g_star"], G_STAR);
        let named = codes(&reply).iter().any(|code| causes.contains(code));
        println!("{name}: right {right}, {:?} {estimates}", codes(&reply));
        assert!(right || named, "{name}: {estimates} {:?}", codes(&reply));
        // The force offset is what is wrong, not only that something is.
        if name == "untared" {
            let first = &reply["omitted"].as_array().unwrap().iter().map(|one| one["name"].clone()).collect::<Vec<_>>();
            assert!(first.contains(&"force_offset".into()), "{first:?}");
        }
    }
}

#[test]
fn a_scan_is_right_or_its_cause_is_named() {
    let dusty = &["not_one_surface"][..];
    let ambiguous = &["axis_ambiguous"][..];
    for (name, body, truth, causes) in [
        ("cone beside the middle", reported!("scan_cone_60_41"), 1.099_557_428_756_381e-6, ambiguous),
        ("worn ball beside the middle", reported!("scan_wornball_60_101"), 7.887_145_257_350_014e-8, ambiguous),
        ("dust", reported!("scan_line_dust_3"), 5.005_866_914_168_133e-7, dusty),
        ("step", reported!("scan_line_step_100nm"), 5.867_298_195_119_958e-7, dusty),
        ("heights in steps", reported!("scan_fill_wornball_61"), 2.499_999_992_580_447e-7, &["quantised"]),
    ] {
        let reply = good(post("/profiles/fit", &body));
        let found = &reply["contact"]["indentation"];
        let off = (number(&found["value"]) - truth).abs() / number(&found["standard_error"]);
        let named = codes(&reply).iter().any(|code| causes.contains(code));
        println!("{name}: off {off:.1}, {:?} {found}", codes(&reply));
        assert!(off <= 3.0 || named, "{name}: {off} standard errors, {:?}", codes(&reply));
    }
}

#[test]
fn a_ball_with_grains_has_a_profile() {
    let reply = good(post("/profiles/fit", &reported!("scan_line_dust_3_ball")));
    println!("{:?} {} {}", codes(&reply), reply["radius_of_curvature"], reply["contact"]);
    assert!(codes(&reply).contains(&"not_one_surface"), "{:?}", codes(&reply));
}

#[test]
fn bodies_that_are_not_of_revolution_are_named_with_their_radii() {
    // The axes of the ellipsoid are as 1 to 1.1, its radii of curvature as 1 to 1.21.
    for (body, kind, radii) in [
        (reported!("scan_map_cylinder"), "cylinder", &[8e-3][..]),
        (reported!("scan_map_ellipsoid_1.2"), "ellipsoid", &[8e-3 / 1.21, 8e-3]),
    ] {
        let reply = good(post("/profiles/fit", &body));
        assert!(codes(&reply).contains(&"not_axisymmetric"), "{kind}: {:?}", codes(&reply));
        let suggested = &reply["suggested"];
        println!("{suggested}");
        assert_eq!(suggested["profile"]["type"], kind, "{suggested}");
        for (found, truth) in suggested["radii"].as_array().unwrap().iter().zip(radii) {
            let [value, error] = ["value", "standard_error"].map(|key| number(&found[key]));
            assert!((value - truth).abs() <= 3.0 * error, "{suggested}");
        }
    }
}
