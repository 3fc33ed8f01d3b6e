//! Requests of simulations: what excludes or needs another member, how far a move may go, and all ranges at once.

use serde_json::{Value, json};

use stickslip_compute::formats::Format;

use crate::json::{ball, of, with};
use crate::{assert_refused, post, problem, written};

fn simulation(path: Value) -> Value {
    of(&ball(), &json!({"path": path}))
}

#[test]
fn what_excludes_or_needs_another_member_is_named_at_its_place() {
    for (pointer, value, place, word) in [
        ("/contact/material/bodies", json!(["rigid", "rigid"]), "/contact/material/bodies", "elastic"),
        ("/contact/preload", json!({"weight": 1.0}), "/contact/preload", "`normal_force`"),
        ("/contact/preload", json!({"normal_force": 1.0, "indentation": 1.0}), "/contact/preload", "conflicts"),
        ("/path", json!({"displacement": vec![0.0; 100_001]}), "/path/displacement", "100000"),
        ("/path", json!({"displacement": []}), "/path/displacement", "1 to"),
        ("/path", json!({"moves": [{"force": 1.0}, {}]}), "/path/moves/1", "no target"),
        ("/path", json!({"moves": [{"force": 1.0, "displacement": 0.0}]}), "/path/moves/0/force", "at most one"),
        ("/path", json!({"falling_amplitude": {"reversals": 2.5}}), "/path/falling_amplitude/reversals", "whole"),
        ("/path", json!({"spiral": {}}), "/path", "`falling_amplitude`"),
        ("/stress", json!({}), "/stress", "`radii`"),
        ("/stress", json!({"points": 2, "radii": [0.0]}), "/stress", "conflicts"),
        ("/stress", json!({"radii": [0.0, -1.0]}), "/stress/radii/1", "0 to"),
        ("/solver", json!({"springs": {"count": 1}}), "/solver/springs/count", "2 to"),
    ] {
        let body = with(simulation(json!({"displacement": [1e-7, 0.0]})), pointer, value);
        assert_refused("/simulate", &body, ("invalid_input", place, word));
    }
    // What the mechanics cannot answer is named with its limit.
    let strong = simulation(json!({"moves": [{"force": 1.0}, {"force": -3.5}]}));
    assert_refused("/simulate", &strong, ("force_exceeds_friction", "/path/moves/1", "= 3"));
    // All ranges are reported at once.
    let mut body = with(simulation(json!({"displacement": [1e10, 0.0, -1e10]})), "/contact/friction", json!(-1.0));
    body["contact"]["profile"]["radius"] = json!(0.0);
    let refused = problem(post("/simulate", &body));
    let pointers: Vec<&str> = refused.errors.iter().map(|fault| fault.pointer.as_str()).collect();
    let expected = ["/contact/profile/radius", "/contact/friction", "/path/displacement/0", "/path/displacement/2"];
    assert_eq!(pointers, expected);
}

/// The points of the longest line of a picture.
fn longest_line(picture: &str) -> usize {
    let lines = picture.split("<polyline").skip(1);
    lines.map(|line| line.split("points=\"").nth(1).map_or(0, |points| points.matches(',').count())).max().unwrap_or(0)
}

#[test]
fn a_loop_is_drawn_through_points_on_the_way() {
    for solver in [json!("exact"), json!({"springs": {"count": 200}})] {
        let mut request = simulation(json!({"displacement": [6e-7, -6e-7, 6e-7]}));
        request["solver"] = solver;
        let picture = written("/simulate", Format::Svg, None, &request);
        assert!(longest_line(&picture) > 60, "{request}");
    }
}
